"""Grades the shaders of a submission with toyproof.

Classroom 50 runs this script in the student's files, and reads the result.json that it writes. A script that fails is an
error of the autograder, not of the student.
"""

import datetime
import hashlib
import json
import os
import subprocess
import sys
import tempfile
import urllib.request
from pathlib import Path

# Where toyproof is, unless it is beside this file: it is larger than Classroom 50 allows an autograder to be.
PROGRAM_URL = ""
PROGRAM_SHA256 = "@SHA256@"

kit = Path(__file__).resolve().parent
program = kit / "toyproof"
if not program.exists():
    if not PROGRAM_URL:
        sys.exit("autograder.py has no PROGRAM_URL: enter the address at which toyproof can be downloaded")
    with urllib.request.urlopen(PROGRAM_URL, timeout=60) as answer:
        content = answer.read()
    if hashlib.sha256(content).hexdigest() != PROGRAM_SHA256:
        sys.exit("the file at PROGRAM_URL is not the toyproof with which this autograder was made")
    program.write_bytes(content)
    program.chmod(0o755)

with tempfile.TemporaryDirectory() as folder:
    results = Path(folder) / "results.json"
    subprocess.run(["sh", kit / "grade.sh", "classroom50", ".", results], check=True)
    graded = json.loads(results.read_text(encoding="utf-8"))

env = os.environ
output = graded.pop("output")
result = {
    "schema": "classroom50/result/v1",
    "classroom": env["CLASSROOM"],
    "assignment": env["ASSIGNMENT"],
    "assignment_type": env.get("ASSIGNMENT_TYPE") or "individual",
    "owner": env.get("OWNER") or env["USERNAME"],
    "submission": env["SUBMISSION_TAG"],
    "commit": env["COMMIT_URL"],
    "release": env["RELEASE_URL"],
    "review": env.get("REVIEW_URL") or env["COMMIT_URL"],
    "datetime": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
    **graded,
}
Path("result.json").write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")

# In a block of code, no text of a submission is read as Markdown.
lines = [f"{graded['score']} of {graded['max-score']} hundredths of a point", "", output, ""]
for test in graded["tests"]:
    lines += [f"{test['test-name']}: {test['score']} of {test['max-score']}", test["output"], ""]
text = "\n".join(lines).splitlines()
Path("release-body.md").write_text("\n".join("    " + line for line in text) + "\n", encoding="utf-8")
