# The template of a CodeRunner question, which is a combinator template grader: it prints the marks of an answer as JSON.
# toyproof.zip is a support file of the question.
import os
import subprocess
import zipfile

answer = """{{ STUDENT_ANSWER | e('py') }}"""
attachments = """{{ ATTACHMENTS | e('py') }}"""

os.mkdir("submission")
if answer.strip():
    with open("submission/shader.glsl", "w", encoding="utf-8") as file:
        file.write(answer)
for name in filter(None, attachments.split(",")):
    os.rename(name, os.path.join("submission", name))
zipfile.ZipFile("toyproof.zip").extractall("toyproof")
# CodeRunner takes any text on standard error for a failure.
command = ["sh", "toyproof/grade.sh", "coderunner", "submission", "results.json"]
subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
with open("results.json", encoding="utf-8") as file:
    print(file.read())
