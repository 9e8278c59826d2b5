#!/bin/sh
# Checks 400 shaders in a Slurm array of 8 tasks, of which two are killed and requeued, and compares the merged report with
# that of a single process. Needs a running Slurm, python3, and the program as its argument: `tests/slurm.sh target/release/toyproof`
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
program=$(realpath "${1:?usage: tests/slurm.sh PROGRAM}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/bin" "$folder/hw"
ln -s "$program" "$folder/bin/toyproof"
PATH="$folder/bin:$PATH"
export PATH
cd "$folder"
cp "$root/glsl/03-shading.toml" scene.toml
python3 - "$root/glsl/03-shading.glsl" <<'PY'
import sys

text = open(sys.argv[1]).read()
for number in range(400):
    shader = text
    if number % 7 == 6:
        shader = shader.replace("max(dot(normal, toLight), 0.0)", "dot(normal, toLight)")
    if number % 11 == 10:
        shader = shader.replace("void mainImage", "viod mainImage")
    open(f"hw/{number:03}.glsl", "w").write(f"// {number}\n{shader}")
PY
arguments="hw --scene scene.toml --device cpu --size 320x180 --search 0"

# Waits until a command succeeds.
wait_for() {
    tries=0
    until "$@"; do
        tries=$((tries + 1))
        [ "$tries" -lt 3000 ] || { echo "slurm: $* never succeeded" >&2; exit 1; }
        sleep 0.1
    done
}
has_begun() { [ -f "shards/$1/results.jsonl" ] && [ "$(wc -l <"shards/$1/results.jsonl")" -ge 3 ]; }
state() { scontrol show job "${job}_$1" | grep -o 'JobState=[A-Z]*' | head -1; }
has_ended() { case $(state "$1") in *COMPLETED | *CANCELLED | *FAILED) true ;; *) false ;; esac; }
is_over() { ! squeue -h -j "$job" -o %i | grep -q .; }
# The processes of a task of this job.
of_task() {
    pgrep -f -- "--shard $1/8 --out shards/$1" | while read -r pid; do
        [ "$(readlink "/proc/$pid/cwd")" != "$folder" ] || echo "$pid"
    done
}

# shellcheck disable=SC2086 # several arguments
job=$(sbatch --parsable --mem=200 --array=1-8 "$root/contrib/slurm-array.sh" $arguments)
echo "slurm: job $job"
wait_for has_begun 1
scancel "${job}_1"
wait_for has_begun 2
kill -9 $(of_task 2)
for task in 1 2; do
    wait_for has_ended "$task"
    echo "slurm: task $task: $(state "$task") after $(wc -l <shards/$task/results.jsonl) shaders"
done
! toyproof merge shards/* --out incomplete 2>incomplete.log || { echo "slurm: incomplete shards were merged" >&2; exit 1; }
grep -q incomplete incomplete.log
for task in 1 2; do
    scontrol requeue "${job}_$task"
done
wait_for is_over
grep -h 'reused' slurm-"${job}"_[12].out

code=0
toyproof merge shards/* --out merged -q >/dev/null || code=$?
# shellcheck disable=SC2086 # several arguments
toyproof check $arguments --out single -q >/dev/null && single=0 || single=$?
[ "$code" = "$single" ]
python3 - <<'PY'
import json
import os

def report(folder):
    report = json.load(open(f"{folder}/verdict.json"))
    for shader in report["shaders"]:
        shader["seconds"] = None
    return report, sorted(os.listdir(folder))

merged, single = report("merged"), report("single")
assert len(merged[0]["shaders"]) == 400
assert merged == single, "the merged report differs"
print("slurm: the merged report of 400 shaders is that of a single process")
PY
