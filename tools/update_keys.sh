#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Write docs/se3d.schema.json and the tables of docs/model-file/reference.md anew from the tables of
# lib/io/read, with the program of a build folder (build/dev where none is named).
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
se3d_help "$@"
build=${1:-build/dev}
cmake --build "$build" --target test_docs_model_keys
"$build/tests/test_docs_model_keys" write
git diff --stat -- docs
