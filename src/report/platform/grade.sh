#!/bin/sh
# Grades a submission: `grade.sh PLATFORM FOLDER RESULTS` checks the files of FOLDER, and writes what the platform reads to the
# file RESULTS. The search for a fix is short, since students wait for their marks on machines with half a core.
kit=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d) || exit
trap 'rm -rf "$work"' EXIT
rm -f "$3"
program=$kit/toyproof
# Not every platform keeps the permissions of files.
[ -x "$program" ] || { cp "$program" "$work" && chmod +x "$work/toyproof" && program=$work/toyproof; }
mkdir "$work/download" && cp -R "$2" "$work/download/submission" &&
    (cd "$work" && "$program" collect download -o shaders -q &&
        "$program" check shaders --assignment "$kit/assignment" --autograder "$1" --out marks --search 1 -q) >&2
[ -f "$work/marks/results.json" ] && cp "$work/marks/results.json" "$3"
[ -f "$3" ] || cp "$kit/failure" "$3"
