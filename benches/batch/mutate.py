#!/usr/bin/env python3
"""Writes mutations of exercises, each beside the scene of its exercise: `mutate.py COUNT COURSE FOLDER EXERCISE…`.

COURSE is what `toyproof scenes --write COURSE` wrote. A mutation changes one number by a factor, or one `+` into `-`; half of them append a comment, which
changes nothing. The same arguments always write the same files.
"""

import pathlib
import random
import re
import shutil
import sys

NUMBER = re.compile(r"(?<![\w.])\d+\.\d*(?![\w.])")
SUM = re.compile(r" \+ ")


def mutation(text, dice):
    kind = dice.choice(["number", "number", "sum", "comment", "comment", "comment"])
    start = text.index("{")
    places = [*{"number": NUMBER, "sum": SUM}.get(kind, NUMBER).finditer(text, start)]
    if kind == "comment" or not places:
        return f"{text}\n// {dice.random()}\n"
    place = dice.choice(places)
    new = " - " if kind == "sum" else f"{float(place.group()) * dice.choice([0.5, 0.9, 1.1, 2.0]):.6f}"
    return text[: place.start()] + new + text[place.end() :]


def main():
    count, course, folder, exercises = int(sys.argv[1]), pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]), sys.argv[4:]
    dice = random.Random(1)
    texts = {name: (course / f"{name}.glsl").read_text() for name in exercises}
    for number in range(count):
        exercise = dice.choice(exercises)
        own = folder / f"{number // 100:03}"
        own.mkdir(parents=True, exist_ok=True)
        (own / f"{number:05}-{exercise}.glsl").write_text(mutation(texts[exercise], dice))
        shutil.copyfile(course / f"{exercise}.toml", own / f"{number:05}-{exercise}.toml")


if __name__ == "__main__":
    main()
