#!/bin/sh
#SBATCH --job-name=toyproof
#SBATCH --array=1-8
#SBATCH --cpus-per-task=1
#SBATCH --mem=2G
#SBATCH --time=02:00:00
#SBATCH --requeue
#SBATCH --open-mode=append
# Checks shaders in a Slurm job array, one shard per task. The arguments are those of `toyproof check`; submit it in the
# folder that they are relative to:
#
#     sbatch --array=1-8 slurm-array.sh homework --scene scene.toml
#     toyproof merge shards/* --out marks
#
# A task that was killed continues where it was when Slurm or you requeue it (`scontrol requeue JOB_TASK`). To submit
# single tasks again, name the number of all: `SHARDS=8 sbatch --array=3,5 slurm-array.sh homework --scene scene.toml`.
set -eu
shards=${SHARDS:-$SLURM_ARRAY_TASK_COUNT}
exec toyproof check "$@" \
    --shard "$SLURM_ARRAY_TASK_ID/$shards" --out "shards/$SLURM_ARRAY_TASK_ID" --resume \
    --jobs "${SLURM_CPUS_PER_TASK:-1}"
