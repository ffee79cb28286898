# SPDX-License-Identifier: BSD-3-Clause
# What the tests of several processes share.
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"

if [ -z "${SE3D_MPI_PROGRAM:-}" ] || ! command -v mpirun >/dev/null; then
    echo 'SKIPPED: no mpirun, or se3d-mpi was not built (apt-get install libopenmpi-dev openmpi-bin)' >&2
    exit 0
fi

# More processes than processors: those that wait give way.
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_mpi_yield_when_idle=1 OMPI_ALLOW_RUN_AS_ROOT=1 \
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_btl_vader_single_copy_mechanism=none

# share RANKS WORDS...: the program on so many processes; $status, $dir/out, $dir/err.
share() {
    ranks=$1
    shift
    timeout 300 mpirun --oversubscribe -np "$ranks" "$SE3D_MPI_PROGRAM" "$@" \
        >"$dir/out" 2>"$dir/err" </dev/null
    status=$?
}
