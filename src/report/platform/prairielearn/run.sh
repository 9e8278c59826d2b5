#!/bin/sh
# Runs for each submission: writes its marks to /grade/results/results.json.
mkdir -p /grade/results /grade/student
sh /grade/tests/grade.sh prairielearn /grade/student /grade/results/results.json
