"""Checks a folder of shaders in one batch, and paints the same ones with wgpu-shadertoy, one process for each.

    measure.py [--count N] [--chunk N] [--size WxH] [--timeout S] [--python PYTHON] [--limit S] TOYPROOF FOLDER

PYTHON is the interpreter of a virtual environment that has wgpu-shadertoy; without it toyproof is measured alone. The tools take turns, a chunk of
shaders each, so that whatever else the machine does slows all alike. Told of each: how many shaders came to an end, seconds on the wall, processor time of the tool and all that it
starts, and the most memory that these held at a time (proportional set size, so that what is shared counts once).
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

PAINT = pathlib.Path(__file__).with_name("paint.py")

# Between two looks at the memory.
LOOK = 0.2


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
    """The processes that `root` started, and it itself."""
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
    """Bytes of memory, what is shared in proportion."""
    try:
        lines = pathlib.Path(f"/proc/{process}/smaps_rollup").read_text().splitlines()
    except OSError:
        return 0
    return sum(1024 * int(line.split()[1]) for line in lines if line.startswith("Pss:"))


class Tool:
    """What a tool has taken."""

    def __init__(self):
        self.told = collections.Counter()
        self.wall = 0.0
        self.processor = 0.0
        self.most = 0

    def run(self, command, limit=None):
        """Its exit code; none if it had to be stopped."""
        environment = {**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"}
        quiet = subprocess.DEVNULL
        start = time.monotonic()
        running = subprocess.Popen(command, stdout=quiet, stderr=quiet, env=environment, start_new_session=True)
        done = threading.Event()

        def look():
            while not done.wait(LOOK):
                self.most = max(self.most, sum(map(held, tree(running.pid))))

        looking = threading.Thread(target=look)
        looking.start()
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
        looking.join()
        running.returncode = os.waitstatus_to_exitcode(status)
        self.processor += usage.ru_utime + usage.ru_stime
        return None if stopped.is_set() else running.returncode

    def line(self, name, count):
        told = ", ".join(f"{number} {what}" for what, number in self.told.most_common())
        return (
            f"{name:<16} {self.wall:8.1f} s {60 * count / self.wall:7.1f}/min {self.processor:8.1f} s of processor time "
            f"{self.processor / count:6.3f} s each {self.processor / self.wall:5.2f} cores {self.most / 1e6:6.0f} MB  {told}"
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
            tool.told[record["verdict"]] += 1
            if record["verdict"] == "error":
                print(f"  {device}: {record['shader']}: {record['reason']}", flush=True)


def paint(tool, python, shaders, size, limit):
    for shader in shaders:
        code = tool.run([python, PAINT, shader, *size.split("x")], limit)
        tool.told["painted" if code == 0 else "stopped" if code is None else "failed"] += 1


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
            paint(others, args.python.absolute(), chunk, args.size, args.limit)
        count = start + len(chunk)
        print(f"{count} shaders, {args.size}")
        print(lavapipe.line("check, lavapipe", count))
        print(cpu.line("check, CPU", count), flush=True)
        if args.python:
            print(others.line("wgpu-shadertoy", count))


main()
