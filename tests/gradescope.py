#!/usr/bin/env python3
"""Submits to an autograder as Gradescope does, in a root folder where its setup.sh has run, and checks each results.json
against the specification: https://gradescope-autograders.readthedocs.io/en/latest/specs/

Called by tests/chroot.sh: tests/gradescope.py ROOT SOLUTION
"""

import io
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time
import zipfile

root, solution = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]).read_text()
autograder = root / "autograder"

FORMATS = {"text", "html", "simple_format", "md", "ansi"}
VISIBILITIES = {"hidden", "after_due_date", "after_published", "visible"}
NUMBER = (int, float)
# The keys of the whole and of a test, with their types or values.
WHOLE = {
    "score": NUMBER, "execution_time": NUMBER, "output": str, "output_format": FORMATS,
    "test_output_format": FORMATS, "test_name_format": FORMATS, "visibility": VISIBILITIES,
    "stdout_visibility": VISIBILITIES, "extra_data": dict, "tests": list, "leaderboard": list,
}
TEST = {
    "score": NUMBER, "max_score": NUMBER, "status": {"passed", "failed"}, "name": str, "name_format": FORMATS,
    "number": str, "output": str, "output_format": FORMATS, "tags": list, "visibility": VISIBILITIES, "extra_data": dict,
}


def check_keys(what, keys):
    """Checks that a JSON object has only these keys, with values of these types."""
    for key, value in what.items():
        allowed = keys.get(key)
        assert allowed, f"the specification has no key {key}"
        assert value in allowed if isinstance(allowed, set) else isinstance(value, allowed), f"{key}: {value}"


def edited(old, new):
    assert old in solution, old
    return solution.replace(old, new)


def archive(files):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as out:
        for name, text in files.items():
            out.writestr(name, text)
    return packed.getvalue()


main = "void mainImage(out vec4 c, in vec2 p)"
# Common has no inputs of the image, so a project's image begins with the function that first reads one.
split = solution.rindex("\n}\n", 0, solution.index("iResolution")) + 3
shared, image = solution[:split], solution[split:]
wrong = edited("if (!inShadow(hit.point, hit.normal))", "if (true)")
PROJECT = '''
[[pass]]
tab = "common"
[[pass]]
tab = "buffer-a"
[[pass]]
tab = "image"
inputs = [{ channel = 0, source = "buffer-a", sampler = { filter = "nearest" } }]
'''
# A name, the files, the points of 10, and the beginning of the output.
SUBMISSIONS = [
    ("correct", {"shader.glsl": solution}, 10, "correct: "),
    ("wrong", {"shader.glsl": wrong}, (2, 9.9), "wrong: "),
    ("does not compile", {"shader.glsl": edited("float disc =", "flaot disc =")}, 0, "invalid: "),
    ("endless loop", {"a.glsl": f"{main} {{ while (p.x > -1.0) c += vec4(p, 0, 1); }}"}, (0, 2), "timeout: "),
    ("recursion", {"a.glsl": f"float f(float x) {{ return f(x + 1.0); }}\n{main} {{ c = vec4(f(p.x)); }}"}, 0, "invalid: "),
    ("2 GB of variables", {"a.glsl": f"float a[500000000];\n{main} {{ a[int(p.x)] = 1.0; c = vec4(a[int(p.y)]); }}"}, (0, 2), ""),
    ("10,000 parentheses", {"a.glsl": f"{main} {{ c = vec4({'(' * 10000}1.0{')' * 10000}); }}"}, (0, 2), ""),
    ("empty folder", {}, 0, "missing: "),
    ("empty file", {"a.glsl": ""}, 0, ""),
    ("several files", {"common.glsl": shared, "image.glsl": image}, 10, "correct: "),
    ("Latin-1", {"shader.glsl": ("// Größe\n" + solution).encode("latin-1")}, 10, "correct: "),
    ("UTF-16", {"shader.glsl": solution.encode("utf-16")}, 10, "correct: "),
    ("wrong extension", {"homework.cpp": solution}, 10, "correct: "),
    ("project with buffers", {
        "project/common.glsl": shared,
        "project/buffer-a.glsl": image,
        "project/image.glsl": f"{main} {{ c = texelFetch(iChannel0, ivec2(p), 0); }}",
        "project/project.toml": PROJECT,
    }, 10, "correct: "),
    ("archive in it", {"homework.zip": archive({"homework/shader.glsl": solution})}, 10, "correct: "),
    ("archive that leads out", {"a.zip": archive({"../../../source/assignment/scene.toml": "x", "a.glsl": solution})}, 10, "correct: "),
    ("two shaders", {"a.glsl": solution, "b.glsl": wrong}, (2, 9.9), "2 shaders: "),
    ("names and text as HTML", {"<img src=x onerror=alert(1)>.glsl": f"#error <script>alert(1)</script>\n{main} {{}}"}, 0, "invalid: "),
    ("no shader", {"report.pdf": b"%PDF\x01\xff"}, 0, "missing: "),
]

failures = 0
for name, files, points, start in SUBMISSIONS:
    for folder in ("submission", "results"):
        shutil.rmtree(autograder / folder, ignore_errors=True)
        (autograder / folder).mkdir()
    for path, content in files.items():
        path = autograder / "submission" / path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    began = time.monotonic()
    environment = ["/usr/bin/env", "-i", "HOME=/root", "PATH=/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin"]
    run = subprocess.run(
        ["chroot", root, *environment, "/bin/sh", "-c", "cd /autograder && ./run_autograder"],
        capture_output=True, text=True,
    )
    seconds = time.monotonic() - began
    try:
        assert run.returncode == 0, run.stderr
        text = (autograder / "results/results.json").read_text()
        results = json.loads(text)
        check_keys(results, WHOLE)
        assert len(text) < 1 << 20, "over 1 MB"
        for test in results["tests"]:
            check_keys(test, TEST)
            assert {"score", "max_score", "name", "output"} <= test.keys(), test
            assert 0 <= test["score"] <= test["max_score"], test
            assert test["output_format"] == "text" or "<script" not in test["output"], "unescaped HTML"
        score = results.get("score", sum(test["score"] for test in results["tests"]))
        low, high = points if isinstance(points, tuple) else (points, points)
        assert low <= score <= high, f"{score} points"
        # With images, the output is HTML.
        output = results["output"].removeprefix("<p>")
        assert output.startswith(start), output[:110]
        print(f"{seconds:5.1f} s {score:5.1f} of 10  {name}: {output.split('<')[0].splitlines()[0][:110]}")
    except (AssertionError, OSError, ValueError) as error:
        failures += 1
        print(f"{seconds:5.1f} s FAILED       {name}: {error}\n{run.stdout}{run.stderr}")
        if (autograder / "results/results.json").exists():
            print((autograder / "results/results.json").read_text()[:2000])
print(f"gradescope: {len(SUBMISSIONS) - failures} of {len(SUBMISSIONS)} submissions as expected")
sys.exit(failures > 0)
