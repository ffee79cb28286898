#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Everything that is run before a release beside .ci/run, and its figures: replaces the table at the end
# of docs/reliability.md.
#
#     tools/release-check.sh [STAGE...]     all stages, or those: hours
#     tools/release-check.sh --smoke        each stage that needs no build of its own, on a part: 10 minutes
#                                           after a build of the preset dev; rows of their own
#
# A stage that is named replaces its own row only. SE3D_FUZZ_SECONDS: for how long all targets are fuzzed
# together (86400). Builds of other presets are taken away after their stage.
set -u
cd "$(dirname "$0")/.." || exit 1
. tools/setup.sh
se3d_help "$@"
smoke=
stages="tests long memory gcc asan tsan msan fuzz unset analyzer tidy coverage mutation kills bits playground"
if [ "${1:-}" = --smoke ]; then
    smoke=1
    shift
    stages="tests memory unset analyzer tidy mutation kills"
fi
stages=${*:-$stages}
out=build/release-check
mkdir -p "$out"
rm -f "$out"/*.row
failed=0
jobs=$(se3d_jobs)

# With --smoke the second word, else the first.
choose() { if [ -n "$smoke" ]; then echo "$2"; else echo "$1"; fi; }

# CPU seconds of all that has ended so far; a subshell would have none.
cpu() {
    times >"$out/times"
    spent=$(awk 'NR == 2 {gsub("m|s", " "); print int($1 * 60 + $2 + $3 * 60 + $4)}' "$out/times")
}

# stage NAME COMMAND_IN_TABLE FUNCTION: the last line that the function prints is the figure.
stage() {
    name=$1
    cpu
    before=$spent
    begun=$(date +%s)
    if "$3" >"$out/$name.log" 2>&1; then
        outcome=passed
    else
        outcome=FAILED
        failed=$((failed + 1))
    fi
    figure=$(tail -n 1 "$out/$name.log" | tr '|' '/')
    cpu
    seconds=$((spent - before))
    row=$name
    command=$2
    if [ -n "$smoke" ]; then
        row="$name, smoke"
        command='sh tools/release-check.sh --smoke'
    fi
    printf '| %s | `%s` | %s | %s | %d.%02d | %s |\n' "$row" "$command" "$outcome" "$figure" \
        $((seconds / 3600)) $((seconds % 3600 / 36)) "$(date +%F)" >"$out/$name.row"
    printf '%-10s %-6s %5d s  %s\n' "$name" "$outcome" $(($(date +%s) - begun)) "$figure"
}

configured() {
    [ -f "build/$1/CMakeCache.txt" ] || cmake --preset "$1" || return 1
}

# The sum of a run of ctest as one line.
ctest_sum() {
    ctest "$@" -j "$jobs"
    status=$?
    line=$(sed -n 's/^\([0-9]*% tests passed, .*\)$/\1/p' "$out/$name.log" | tail -n 1)
    echo "${line:-no test was run}"
    return $status
}

tests() {
    if [ -n "$smoke" ]; then
        ctest_sum --preset dev -R '^(misuse|out-of-memory|record|fuzz)\.' -LE 'long|numeric'
    else
        configured dev && cmake --build --preset dev -j "$jobs" && ctest_sum --preset dev
    fi
}
long() { SE3D_LONG=1 SE3D_POSES=100000 ctest_sum --preset dev; }
memory() { sh tools/check_memory.sh; }

# whole PRESET [OPTION]...: build, test, take away
whole() {
    cmake --preset "$@" && cmake --build --preset "$1" -j "$jobs" && ctest_sum --preset "$1"
    status=$?
    rm -rf "build/$1"
    return $status
}
with_gcc() { whole ci-gcc; }
# Also what runs numbers only, and calls and bytes that CI tries a third of.
asan() {
    SE3D_LONG=1
    export SE3D_LONG
    whole asan -DSE3D_LONG_TESTS=ON
    status=$?
    unset SE3D_LONG
    return $status
}
tsan() { whole tsan; }
msan() {
    sh tools/check_msan.sh
    status=$?
    line=$(sed -n 's/^\([0-9]*% tests passed, .*\)$/\1/p' "$out/msan.log" | tail -n 1)
    rm -rf build/msan
    echo "${line:-no test was run}"
    return $status
}
fuzz() { sh tools/check_fuzz.sh "${SE3D_FUZZ_SECONDS:-86400}"; }

some_files() { find lib/base lib/joint -name '*.c' | sort; }
# shellcheck disable=SC2046
unset_variables() { sh tools/check_uninitialised.sh $(choose '' "$(some_files)"); }
# shellcheck disable=SC2046
analyzer() { sh tools/check_analyzer.sh $(choose '' "$(some_files)"); }
# shellcheck disable=SC2046
tidy() { sh tools/check_tidy.sh $(choose '' "$(find lib/joint -name 'r*.c')"); }

coverage() {
    configured coverage && cmake --build --preset coverage -j "$jobs" &&
        ctest --preset coverage -j "$jobs"
    status=$? # without optimisation, tests see divisions that are made before their result is needed
    python3 tools/coverage.py || status=1
    rm -rf build/coverage
    return $status
}

# mutants COUNT TESTS FILE...: killed and all are added up
mutants() {
    count=$1
    tests=$2
    shift 2
    python3 tools/mutate.py --count "$count" --seed 1 --tests "$tests" "$@" | tee "$out/mutants"
    set -- $(sed -n 's/^\([0-9]*\) mutants of .*: \([0-9]*\) killed.*/\1 \2/p' "$out/mutants")
    all=$((all + ${1:-0}))
    killed=$((killed + ${2:-0}))
}

mutation() {
    all=0
    killed=0
    count=$(choose 100 4)
    primitives=test_finite-difference_primitives,test_unit_joints,test_unit_equations
    mutants "$count" $primitives lib/primitive/*.c
    if [ -z "$smoke" ]; then # quick tests first; what they let pass changes the hash of some run
        joints=test_property_joint_equations,test_property_joint_freedoms,test_property_joint_reactions
        joints=$joints,test_unit_joints,test_unit_equations,test_finite-difference_tangent
        forces=test_finite-difference_force_jacobians,test_unit_forces,test_property_friction,test_property_stops
        forces=$forces,test_golden_tyres,test_finite-difference_user_constraints,test_determinism_hashes
        assemblies=test_unit_assembly,test_finite-difference_tangent,test_property_armature
        assemblies=$assemblies,test_property_formulations,test_determinism_hashes
        steps=test_unit_tableaus,test_unit_tyre_steps,test_property_kinks_dynamics,test_property_between_steps
        steps=$steps,test_property_gauss,test_property_rattle,test_order-of-accuracy_methods,test_order-of-accuracy_bdf
        steps=$steps,test_order-of-accuracy_integrators,test_golden_convex,test_determinism_hashes
        shapes=test_unit_narrow,test_unit_shapes,test_unit_depth,test_unit_depth_pieces,test_unit_separation
        shapes=$shapes,test_unit_flush,test_golden_mesh_contact,test_golden_mesh_on_mesh,test_determinism_hashes
        mutants "$count" $joints lib/joint/*.c
        mutants "$count" $forces lib/force/*.c
        mutants "$count" $assemblies lib/assembly/*.c
        mutants "$count" test_unit_linsol,test_unit_linsol_rank,test_determinism_hashes lib/linsol/kkt*.c lib/linsol/rank*.c
        mutants "$count" $steps lib/integrator/*.c
        mutants "$count" $shapes lib/contact/narrow/*.c
    fi
    echo "$killed of $all mutants killed, seed 1"
}

kills() {
    SE3D_PROGRAM=$(pwd)/build/dev/bin/se3d
    SE3D_SOURCE_DIR=$(pwd)
    SE3D_SEED=${SE3D_SEED:-1}
    SE3D_KILLS=$(choose 50 3)
    export SE3D_PROGRAM SE3D_SOURCE_DIR SE3D_SEED SE3D_KILLS
    sh tests/cli/test_resume.sh >"$out/kills" 2>&1
    status=$?
    cat "$out/kills"
    echo "$(sed -n 's/^\(.*\).yaml: \([0-9]*\) kills$/\1 \2/p' "$out/kills" | tr '\n' ',' | sed 's/,$//; s/,/, /g') kills, seed $SE3D_SEED"
    return $status
}
bits() { sh tools/check_bits.sh all; }

# As readers get it; emscripten is 840 MB, too much for every change.
playground() {
    se3d_install emscripten $SE3D_PICTURE_PACKAGES && configured dev &&
        cmake --build --preset dev -j "$jobs" --target se3d_program &&
        SE3D_LONG=1 ctest_sum --preset dev -R '^cli\.(view|playground)$' || return 1
    ! grep SKIPPED build/dev/Testing/Temporary/LastTest.log
}

for each in $stages; do
    case $each in
    tests) stage tests 'ctest --preset dev' tests ;;
    long) stage long 'SE3D_LONG=1 ctest --preset dev' long ;;
    memory) stage memory 'sh tools/check_memory.sh' memory ;;
    gcc) stage gcc 'ctest --preset ci-gcc' with_gcc ;;
    asan) stage asan 'ctest --preset asan' asan ;;
    tsan) stage tsan 'ctest --preset tsan' tsan ;;
    msan) stage msan 'sh tools/check_msan.sh' msan ;;
    fuzz) stage fuzz 'sh tools/check_fuzz.sh 86400' fuzz ;;
    unset) stage unset 'sh tools/check_uninitialised.sh' unset_variables ;;
    analyzer) stage analyzer 'sh tools/check_analyzer.sh' analyzer ;;
    tidy) stage tidy 'sh tools/check_tidy.sh' tidy ;;
    coverage) stage coverage 'python3 tools/coverage.py' coverage ;;
    mutation) stage mutation 'python3 tools/mutate.py' mutation ;;
    kills) stage kills 'SE3D_KILLS=50 ctest -R cli.resume' kills ;;
    bits) stage bits 'sh tools/check_bits.sh all' bits ;;
    playground) stage playground 'SE3D_LONG=1 ctest -R cli.playground' playground ;;
    *)
        echo "release-check.sh: no stage $each; there are: $stages" >&2
        exit 2
        ;;
    esac
done

# Rows of this run take the place of those with the same name.
python3 - "$out" <<'END' || failed=$((failed + 1))
import re, sys
from pathlib import Path
page = Path("docs/reliability.md")
text = page.read_text()
head = "| stage | command | outcome | figures | CPU hours | day |\n|---|---|---|---|---|---|\n"
found = re.search(re.escape(head) + r"((?:\|.*\n)*)", text)
old = {row.split("|")[1].strip(): row for row in found.group(1).splitlines()}
for path in sorted(Path(sys.argv[1]).glob("*.row")):
    row = path.read_text().rstrip("\n")
    old[row.split("|")[1].strip()] = row
rows = "".join(row + "\n" for row in old.values())
page.write_text(text[:found.start()] + head + rows + text[found.end():])
END
echo "release-check: $failed failed"
[ "$failed" -eq 0 ]
