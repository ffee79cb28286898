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

# In place of the program: tests/test_mpi_NAME.
share_test() {
    SE3D_MPI_PROGRAM=${SE3D_BUILD_DIR:?}/tests/test_mpi_$1
    if [ ! -x "$SE3D_MPI_PROGRAM" ]; then
        echo "SKIPPED: test_mpi_$1 is not built here" >&2
        exit 0
    fi
}

# share RANKS WORDS...: the program on so many processes; $status, $dir/out, $dir/err.
share() {
    ranks=$1
    shift
    timeout 300 mpirun --oversubscribe -np "$ranks" "$SE3D_MPI_PROGRAM" "$@" \
        >"$dir/out" 2>"$dir/err" </dev/null
    status=$?
}

# own_processes WORDS: those of the program that were started with these words, which may end meanwhile.
own_processes() {
    for entry in /proc/[0-9]*; do
        [ -r "$entry/cmdline" ] || continue
        case $(tr '\0' ' ' 2>/dev/null <"$entry/cmdline") in
        "$SE3D_MPI_PROGRAM $1 "*) echo "${entry#/proc/}" ;;
        esac
    done 2>/dev/null
}

# run_killed RANKS MODEL DIR WORDS...: a run with checkpoints, one of whose processes is killed as soon as there is one.
# On a busy machine a run may be over before: it is made again.
run_killed() {
    many=$1 killed_model=$2 killed=$3
    shift 3
    for attempt in 1 2 3 4 5; do
        rm -rf "$killed"
        share "$many" run "$killed_model" -o "$killed" "$@" --checkpoint 0 &
        here=$!
        victim=
        while [ -z "$victim" ] && kill -0 $here 2>/dev/null; do
            victim=$(own_processes "run $killed_model -o $killed" | tail -n 1)
        done
        while [ ! -e "$killed/run.checkpoint" ] && kill -0 $here 2>/dev/null; do
            sleep 0.01
        done
        [ -z "$victim" ] || kill -9 "$victim" 2>/dev/null
        wait $here
        grep -q -i 'signal 9\|killed' "$dir/err" && break
    done
    holds "a killed process ends all (try $attempt)" grep -q -i 'signal 9\|killed' "$dir/err"
    holds "none is left" test -z "$(own_processes "run $killed_model -o $killed")"
}
