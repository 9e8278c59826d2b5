#!/usr/bin/env python3
"""Submits to the autograders of four platforms as these do, in a root folder without anything else, and checks the results
against the documented formats. Gradescope has tests/gradescope.py.

Called by tests/chroot.sh: tests/autograders.py ROOT SOLUTION, where ROOT/root/PLATFORM is what `toyproof autograder` made.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys

root, solution = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]).read_text()


def edited(old, new):
    assert old in solution, old
    return solution.replace(old, new)


# A name, the text, the range of the share of the points.
SUBMISSIONS = [
    ("right", solution, (1, 1)),
    ("wrong", edited("if (!inShadow(hit.point, hit.normal))", "if (true)"), (0.2, 0.99)),
    ("invalid", edited("float disc =", "flaot disc ="), (0, 0)),
    ("late", solution, (1, 1)),
    ("empty", None, (0, 0)),
]


def run(command, folder, environment=()):
    """Runs a command in the root folder; returns its standard output."""
    command = ["chroot", root, "/usr/bin/env", "-i", "PATH=/usr/bin:/bin", *environment, "/bin/sh", "-c", f"cd {folder} && {command}"]
    ended = subprocess.run(command, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    return ended.stdout, ended.stderr


def submit(folder, name, text):
    """Writes a submission into a new folder; a late one is of the year 2096."""
    path = root / folder.lstrip("/")
    shutil.rmtree(path, ignore_errors=True)
    path.mkdir(parents=True)
    if text is not None:
        (path / "shader.glsl").write_text(text)
        if name == "late":
            os.utime(path / "shader.glsl", (4_000_000_000, 4_000_000_000))
    return path


def prairielearn(name, text):
    submit("/grade/student", name, text)
    shutil.copytree(root / "root/prairielearn/tests", root / "grade/tests", dirs_exist_ok=True)
    info = json.loads((root / "root/prairielearn/info.json").read_text())
    run(info["externalGradingOptions"]["entrypoint"], "/")
    results = json.loads((root / "grade/results/results.json").read_text())
    assert results["gradable"] == (name not in ("invalid", "empty")), results
    assert results["gradable"] or results["format_errors"], results
    for test in results["tests"]:
        assert {"name", "points", "max_points"} <= test.keys(), test
    return results["score"]


def autolab(name, text):
    # A handin is a file, if only an empty one.
    folder = submit("/instance", name, text or "")
    shutil.copy(root / "root/autolab/autograde-Makefile", folder / "Makefile")
    shutil.copy(root / "root/autolab/autograde.tar", folder)
    lines = run("make", "/instance")[0].splitlines()
    assert json.loads(lines[-2])["_presentation"] == "semantic", lines
    return sum(json.loads(lines[-1])["scores"].values()) / 10


def coderunner(name, text):
    folder = submit("/sandbox", name, None)
    template = (root / "root/coderunner/template.py").read_text()
    answer = (text or "").replace("\\", "\\\\").replace('"', '\\"')
    program = template.replace("{{ STUDENT_ANSWER | e('py') }}", answer).replace("{{ ATTACHMENTS | e('py') }}", "")
    (folder / "prog.py").write_text(program)
    shutil.copy(root / "root/coderunner/toyproof.zip", folder)
    output, errors = run("python3 prog.py", "/sandbox")
    assert not errors, errors
    results = json.loads(output)
    assert results.keys() <= {"fraction", "prologuehtml", "testresults", "epiloguehtml"}, results.keys()
    return results["fraction"]


def classroom50(name, text):
    folder = submit("/checkout", name, text)
    script = root / "root/classroom50/autograder/autograder.py"
    script.write_text(script.read_text().replace('PROGRAM_URL = ""', 'PROGRAM_URL = "file:///root/classroom50/toyproof"'))
    url = "https://example.org/1"
    run("python3 /root/classroom50/autograder/autograder.py", "/checkout", [
        "CLASSROOM=graphics", "ASSIGNMENT=many", "SUBMISSION_TAG=submit/1", "USERNAME=anna",
        f"COMMIT_URL={url}", f"RELEASE_URL={url}", f"REVIEW_URL={url}",
    ])
    result = json.loads((folder / "result.json").read_text())
    required = {"schema", "classroom", "assignment", "assignment_type", "owner", "submission", "commit", "release", "review",
                "datetime", "score", "max-score", "tests"}
    assert result.keys() == required, result.keys() ^ required
    assert type(result["score"]) is int and type(result["max-score"]) is int, result
    assert sum(test["score"] for test in result["tests"]) == result["score"], result
    return result["score"] / result["max-score"]


failures = 0
for platform in [prairielearn, autolab, coderunner, classroom50]:
    for name, text, (low, high) in SUBMISSIONS:
        try:
            share = platform(name, text)
            assert low <= share <= high, f"{share} of the points"
            print(f"{platform.__name__:13} {name:8} {share:5.2f}")
        except (AssertionError, OSError, ValueError, KeyError, IndexError) as error:
            failures += 1
            print(f"{platform.__name__:13} {name:8} FAILED: {error!r}")
print(f"autograders: {failures} failures")
sys.exit(failures > 0)
