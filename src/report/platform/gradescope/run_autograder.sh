#!/bin/sh
# Runs for each submission: writes its marks to /autograder/results/results.json.
mkdir -p /autograder/results
sh /autograder/source/grade.sh gradescope /autograder/submission /autograder/results/results.json
