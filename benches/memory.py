#!/usr/bin/env python3
"""The most memory that a command and all that it starts hold at once: `benches/memory.py COMMAND…`.

Sampled every 5 ms: the sum of the processes' resident sets (RSS), in which pages that two share count twice, and of their proportional
sets (PSS), in which shared pages are divided.
"""

import pathlib
import subprocess
import sys
import time


def tree(root):
    """A process and all that it started."""
    yield root
    for tasks in pathlib.Path(f"/proc/{root}/task").glob("*/children"):
        for child in tasks.read_text().split():
            yield from tree(int(child))


def held(process):
    """RSS and PSS of a process in kB."""
    lines = pathlib.Path(f"/proc/{process}/smaps_rollup").read_text().splitlines()
    fields = dict(line.split(":", 1) for line in lines[1:])
    return [int(fields[name].split()[0]) for name in ("Rss", "Pss")]


def main():
    most = [0, 0]
    command = subprocess.Popen(sys.argv[1:])
    while command.poll() is None:
        try:
            now = [sum(parts) for parts in zip(*map(held, tree(command.pid)))]
            most = [max(pair) for pair in zip(most, now)]
        except (OSError, KeyError):
            pass  # A process ended meanwhile.
        time.sleep(0.005)
    rss, pss = (kilobytes / 1024 for kilobytes in most)
    print(f"{rss:.0f} MB of RSS, {pss:.0f} MB of PSS", file=sys.stderr)
    return command.returncode


if __name__ == "__main__":
    sys.exit(main())
