"""Checks a folder of shaders in one batch, and renders the same ones with wgpu-shadertoy, one process for each.

    measure.py [--count N] [--chunk N] [--size WxH] [--timeout S] [--python PYTHON] [--limit S] TOYPROOF FOLDER

PYTHON is the interpreter of a virtual environment that has wgpu-shadertoy; without it, toyproof is measured alone. The tools take
turns, a chunk of shaders each, so that other load slows all alike. For each tool: how many shaders were completed, wall-clock time,
processor time of the tool and all that it starts, and the most memory that these held at once (proportional set size, so that shared
pages count once).
"""

import argparse
import collections
import json
import os
import pathlib
import random
import shutil
import subprocess
import tempfile
import threading
import time

RENDER = pathlib.Path(__file__).with_name("render.py")

# Seconds between two samples of the memory.
INTERVAL = 0.2


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("toyproof", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--chunk", type=int, default=25)
    parser.add_argument("--size", default="256x144")
    parser.add_argument("--timeout", type=float, default=5.0, help="toyproof's, in seconds")
    parser.add_argument("--python", type=pathlib.Path)
    parser.add_argument("--limit", type=float, default=30.0, help="for one process of wgpu-shadertoy, in seconds")
    return parser.parse_args()


def tree(root):
    """A process and all that it started."""
    children = collections.defaultdict(list)
    for entry in os.scandir("/proc"):
        if entry.name.isdigit():
            try:
                stat = pathlib.Path(entry.path, "stat").read_text()
            except OSError:
                continue
            children[int(stat.rpartition(")")[2].split()[1])].append(int(entry.name))
    found = [root]
    for process in found:
        found.extend(children[process])
    return found


def held(process):
    """The proportional set size of a process in bytes."""
    try:
        lines = pathlib.Path(f"/proc/{process}/smaps_rollup").read_text().splitlines()
    except OSError:
        return 0
    return sum(1024 * int(line.split()[1]) for line in lines if line.startswith("Pss:"))


class Tool:
    """The time, memory and results of a tool."""

    def __init__(self):
        self.counts = collections.Counter()
        self.wall = 0.0
        self.processor = 0.0
        self.most = 0

    def run(self, command, limit=None):
        """Runs a command. Returns its exit code; none if it was stopped."""
        environment = {**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"}
        quiet = subprocess.DEVNULL
        start = time.monotonic()
        running = subprocess.Popen(command, stdout=quiet, stderr=quiet, env=environment, start_new_session=True)
        done = threading.Event()

        def sample():
            while not done.wait(INTERVAL):
                self.most = max(self.most, sum(map(held, tree(running.pid))))

        sampling = threading.Thread(target=sample)
        sampling.start()
        stopped = threading.Event()

        def stop():
            stopped.set()
            running.kill()

        timer = threading.Timer(limit, stop) if limit else None
        if timer:
            timer.start()
        _, status, usage = os.wait4(running.pid, 0)
        self.wall += time.monotonic() - start
        if timer:
            timer.cancel()
        done.set()
        sampling.join()
        running.returncode = os.waitstatus_to_exitcode(status)
        self.processor += usage.ru_utime + usage.ru_stime
        return None if stopped.is_set() else running.returncode

    def line(self, name, count):
        counts = ", ".join(f"{number} {what}" for what, number in self.counts.most_common())
        return (
            f"{name:<16} {self.wall:8.1f} s {60 * count / self.wall:7.1f}/min {self.processor:8.1f} s of processor time "
            f"{self.processor / count:6.3f} s each {self.processor / self.wall:5.2f} cores {self.most / 1e6:6.0f} MB  {counts}"
        )


def check(tool, toyproof, shaders, size, timeout, device):
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder, "hw")
        work.mkdir()
        for shader in shaders:
            shutil.copy(shader, work)
        out = pathlib.Path(folder, "out")
        options = ["--size", size, "--timeout", f"{timeout}s", "--device", device, "--out", out]
        tool.run([toyproof, "check", work, *options])
        report = json.loads((out / "verdict.json").read_text())
        for record in report["shaders"]:
            tool.counts[record["verdict"]] += 1
            if record["verdict"] == "error":
                print(f"  {device}: {record['shader']}: {record['reason']}", flush=True)


def render(tool, python, shaders, size, limit):
    for shader in shaders:
        code = tool.run([python, RENDER, shader, *size.split("x")], limit)
        tool.counts["rendered" if code == 0 else "stopped" if code is None else "failed"] += 1


def main():
    args = arguments()
    toyproof = args.toyproof.absolute()
    shaders = sorted(args.folder.glob("*.glsl"))
    random.Random(1).shuffle(shaders)
    shaders = shaders[: args.count]
    lavapipe, cpu, others = Tool(), Tool(), Tool()
    for start in range(0, len(shaders), args.chunk):
        chunk = shaders[start : start + args.chunk]
        check(lavapipe, toyproof, chunk, args.size, args.timeout, "lavapipe")
        check(cpu, toyproof, chunk, args.size, args.timeout, "cpu")
        if args.python:
            render(others, args.python.absolute(), chunk, args.size, args.limit)
        count = start + len(chunk)
        print(f"{count} shaders, {args.size}")
        print(lavapipe.line("check, lavapipe", count))
        print(cpu.line("check, CPU", count), flush=True)
        if args.python:
            print(others.line("wgpu-shadertoy", count))


main()
