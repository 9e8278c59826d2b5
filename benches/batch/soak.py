#!/usr/bin/env python3
"""Checks many different shaders in one process and measures what it holds: `soak.py PROGRAM COUNT FOLDER [FLAG…]`.

FOLDER receives the shaders and the report; FLAGs are those of `check`, such as `--device cpu`. The shaders are mutations of exercises as in `mutate.py`;
of twenty, one is cut off in its middle, one has an unknown name, and every thousandth is endless. Memory, file descriptors and threads of the process and
the memory of its workers are sampled every second, with the number of shaders that are complete. The slopes are those of a line through the second half of
the samples, by least squares: what is taken once, such as threads and their stacks, is in the first half. The same arguments always check the same shaders.
"""

import pathlib
import random
import shutil
import subprocess
import sys
import time

from mutate import mutation

EXERCISES = ["02-sphere", "03-shading", "04-many-objects", "06-reflections", "10-quadrics", "12-whitted"]
ENDLESS = "void mainImage(out vec4 c, in vec2 p) {\n    float x = p.x;\n    while (x > -1.0) { x = abs(sin(x)); }\n    c = vec4(x);\n}\n"
FLAGS = ["--size", "32x18", "--timeout", "1s"]


def write(count, course, folder):
    dice = random.Random(2)
    texts = {name: (course / f"{name}.glsl").read_text() for name in EXERCISES}
    for number in range(count):
        exercise = dice.choice(EXERCISES)
        text = mutation(texts[exercise], dice)
        kind = dice.randrange(20)
        if number % 1000 == 999:
            text = ENDLESS
        elif kind == 0:
            text = text[: dice.randrange(len(text))]
        elif kind == 1:
            text = text.replace("normalize", f"normalise{number}")
        own = folder / f"{number // 100:03}"
        own.mkdir(parents=True, exist_ok=True)
        (own / f"{number:05}-{exercise}.glsl").write_text(text)
        shutil.copyfile(course / f"{exercise}.toml", own / f"{number:05}-{exercise}.toml")


def status(process, key):
    """A number of /proc/PID/status; 0 if the process is gone."""
    try:
        lines = pathlib.Path(f"/proc/{process}/status").read_text().splitlines()
    except OSError:
        return 0
    return next((int(line.split()[1]) for line in lines if line.startswith(key + ":")), 0)


def children(process):
    try:
        tasks = list(pathlib.Path(f"/proc/{process}/task").iterdir())
        return [child for task in tasks for child in (task / "children").read_text().split()]
    except OSError:
        return []


def descriptors(process):
    try:
        return len(list(pathlib.Path(f"/proc/{process}/fd").iterdir()))
    except OSError:
        return 0


def sample(process, results):
    workers = children(process)
    return {
        "shaders": results.read_bytes().count(b"\n") if results.exists() else 0,
        "memory of the process, MB": status(process, "VmRSS") / 1024,
        "memory of its workers, MB": sum(status(worker, "VmRSS") for worker in workers) / 1024,
        "file descriptors": descriptors(process),
        "threads": status(process, "Threads"),
        "workers": len(workers),
    }


def slope(samples, key):
    """The increase in 1,000 shaders."""
    xs, ys = [one["shaders"] / 1000 for one in samples], [one[key] for one in samples]
    x, y = sum(xs) / len(xs), sum(ys) / len(ys)
    spread = sum((one - x) ** 2 for one in xs)
    return sum((a - x) * (b - y) for a, b in zip(xs, ys)) / spread if spread else 0.0


def main():
    program, count, folder, flags = sys.argv[1], int(sys.argv[2]), pathlib.Path(sys.argv[3]), sys.argv[4:]
    course, shaders, out = (folder / name for name in ("course", "shaders", "out"))
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    subprocess.run([program, "scenes", "--write", course], check=True, stdout=subprocess.DEVNULL)
    write(count, course, shaders)
    samples = []
    with open(folder / "log", "w", encoding="utf-8") as log:
        check = subprocess.Popen([program, "check", shaders, "--out", out, *FLAGS, *flags], stdout=log, stderr=log)
        begin = time.monotonic()
        while check.poll() is None:
            samples.append(sample(check.pid, out / "results.jsonl"))
            time.sleep(1)
    seconds = time.monotonic() - begin
    # The last sample of a process that ends may be empty.
    samples = [one for one in samples if one["memory of the process, MB"] and one["shaders"]]
    print(f"{samples[-1]['shaders']} of {count} shaders in {seconds:.0f} s, exit code {check.returncode}, {len(samples)} samples")
    print(f"{'':28}{'first':>8}{'middle':>8}{'last':>8}{'most':>8}{'per 1,000 shaders':>20}")
    later = samples[len(samples) // 2 :]
    for key in [key for key in samples[0] if key != "shaders"]:
        values = [one[key] for one in samples]
        middle = values[len(values) // 2]
        print(f"{key:28}{values[0]:8.1f}{middle:8.1f}{values[-1]:8.1f}{max(values):8.1f}{slope(later, key):20.3f}")


if __name__ == "__main__":
    main()
