#!/bin/sh
# A study with GNU parallel: sh parallel.sh PARTS, for several machines with --sshlogin and a folder that all of them
# see. On one machine `se3d study --jobs all` does the same.
set -eu
parts=${1:-3}
model=${MODEL:-damper.yaml}
results=${RESULTS:-parts}
se3d=${SE3D:-se3d}
seq "$parts" | parallel "$se3d" study "$model" -o "$results" --shard "{}/$parts" --resume
exec "$se3d" study "$model" -o "$results" --merge
