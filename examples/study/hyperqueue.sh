#!/bin/sh
# A study under HyperQueue: sh hyperqueue.sh PARTS. The server and its workers are running. Each task runs its part; run
# it again after a failure, and the parts go on.
set -eu
parts=${1:-3}
model=${MODEL:-damper.yaml}
results=${RESULTS:-parts}
se3d=${SE3D:-se3d}
hq submit --wait --array "1-$parts" --cpus 1 "$se3d" study "$model" -o "$results" --shard "auto/$parts" --resume
exec "$se3d" study "$model" -o "$results" --merge
