#!/bin/sh
# Runs for each submission: writes its marks to /autograder/results/results.json. The search for a fix is short, since
# students wait for their marks on machines with half a core.
results=/autograder/results/results.json
mkdir -p /autograder/results
rm -f "$results"
work=$(mktemp -d) && cd "$work" && mkdir download && cp -R /autograder/submission download/submission &&
    /autograder/source/toyproof collect download -o shaders -q &&
    /autograder/source/toyproof check shaders --assignment /autograder/source/assignment --out marks --search 1 -q
[ -f marks/results.json ] && cp marks/results.json "$results"
[ -f "$results" ] || cat >"$results" <<'END'
{"output": "The autograder failed, so your submission was not graded. Please inform your teacher.", "tests": []}
END
