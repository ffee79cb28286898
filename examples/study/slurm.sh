#!/bin/sh
#SBATCH --array=1-3
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --output=study-%a.log
# A study as a job array of Slurm: sbatch slurm.sh. Each task runs its part; one that was ended goes on when it is
# submitted again. When all are done: se3d study damper.yaml -o parts --merge
# Another number of parts: sbatch --array=1-100 slurm.sh, in a folder of its own.
exec "${SE3D:-se3d}" study "${MODEL:-damper.yaml}" -o "${RESULTS:-parts}" --shard auto --resume
