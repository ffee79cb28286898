#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Quick tests under valgrind: reads of memory that was never written, in what the compiler cannot
# follow, and reads and writes past the ends. Prints what it finds and fails.
#     check_memory.sh [FOLDER]   the folder of the test programs, build/dev/tests
cd "$(dirname "$0")/.." || exit 1
. tools/setup.sh
se3d_help "$@"
folder=${1:-build/dev/tests}
tests="property_leftovers misuse_outliving misuse_functions misuse_io_functions misuse_solver_settings
finite-difference_force_jacobians finite-difference_tangent finite-difference_user_constraints
property_driven_friction property_event_sides property_joint_equations property_joint_freedoms
property_joint_reactions property_newton property_open_loops
property_user_constraints unit_assembly unit_expression unit_forces_misuse unit_functions
unit_fused_joints unit_io_bad_input unit_io_encoding unit_io_files unit_io_forces unit_io_solid
unit_io_values unit_joints unit_linsol_rank unit_math unit_null_space unit_sort"
SE3D_SOURCE_DIR=$(pwd)
SE3D_BUILD_DIR=$(dirname "$folder")
export SE3D_SOURCE_DIR SE3D_BUILD_DIR OMP_NUM_THREADS=2 OMP_WAIT_POLICY=passive
jobs=$(nproc 2>/dev/null || echo 2)
# shellcheck disable=SC2086
printf '%s\n' $tests | xargs -P "$jobs" -I NAME valgrind -q --error-exitcode=9 --leak-check=no \
    "$folder/test_NAME" >/dev/null || exit 1
echo "memory: $(printf '%s\n' $tests | wc -l) tests, 0 problems"
