#!/usr/bin/env python3
"""The time and memory of 60 frames of a project with feedback at 640x360: the evaluator, lavapipe and Chromium.

`cargo build --release --workspace && benches/projects.py`. Runs take turns, and the middle of three is printed. Times include the
start of the program, compilation and the image file; Chromium's start, the time of its frame 0, is also printed.
"""

import json
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

import memory

ROOT = pathlib.Path(__file__).resolve().parent.parent
TARGET = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release"
PROJECT = ROOT / "benches/feedback"
TURNS = 3
LAST = 59


def measure(command):
    """Seconds of a command, and the most memory that it holds, in MB."""
    start = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    most = 0
    while process.poll() is None:
        try:
            most = max(most, sum(memory.held(child)[1] for child in memory.tree(process.pid)))
        except (OSError, KeyError):
            pass  # One ended while it was asked.
        time.sleep(0.005)
    if process.returncode != 0:
        raise SystemExit(f"{command} failed")
    return time.monotonic() - start, most / 1024


def main():
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        exported = folder / "feedback.json"
        subprocess.run([TARGET / "toyproof", "export", PROJECT, "-o", exported], check=True)

        def run(*options):
            return [TARGET / "toyproof", "run", PROJECT, "--frame", str(LAST), "-o", folder / "image.png", *options]

        def chromium(frame):
            return [TARGET / "xtask", "player", exported, "--size", "640x360", "--frames", str(frame),
                    "--out", folder / "chromium"]

        commands = {
            "--device cpu": run("--device", "cpu"),
            "--precision f64": run("--precision", "f64"),
            "lavapipe": run("--device", "lavapipe"),
            "lavapipe, --float fast": run("--device", "lavapipe", "--float", "fast"),
            "Chromium, WebGL 2 on SwiftShader": chromium(LAST),
            "Chromium, frame 0 only": chromium(0),
        }
        runs = {name: [] for name in commands}
        for _ in range(TURNS):
            for name, command in commands.items():
                runs[name].append(measure(command))
        record = json.loads((folder / "chromium/player.json").read_text())
        assert "failure" not in record and not record["errors"], record
    for name, measured in runs.items():
        seconds, megabytes = map(statistics.median, zip(*measured))
        print(f"{name:34}{seconds:6.2f} s {megabytes:6.0f} MB")


if __name__ == "__main__":
    main()
