#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Fuzzes every target of fuzz/ with libFuzzer, AddressSanitizer and UndefinedBehaviorSanitizer; fails if
# one is found to fail, and leaves the input in build/fuzz/found.
#
#     tools/check_fuzz.sh SECONDS [TARGET...]   for so long in all, shared by the targets
#
# What was learnt stays in build/fuzz/corpus (or the folder SE3D_FUZZ_CORPUS) for the next time, and
# fuzz/effort.tsv sums CPU seconds and inputs of each target over all runs. An input that fails goes, smaller, to
# fuzz/finds/TARGET with a name that says what it is, and so becomes part of the test
# fuzz.replay_TARGET. Without clang or its runtime nothing is run, and exit is 3:
# SE3D_FUZZ_OPTIONAL=1 makes that 0. docs/reliability.md
set -u
cd "$(dirname "$0")/.." || exit 1
. tools/setup.sh
se3d_help "$@"
all="model expression mesh table import unzip plot bytes calls functions record"
seconds=${1:-}
case $seconds in
'' | *[!0-9]*)
    echo "check_fuzz.sh SECONDS [TARGET...], targets: $all" >&2
    exit 2
    ;;
esac
shift
targets=${*:-$all}
out=build/fuzz
corpus=${SE3D_FUZZ_CORPUS:-$out/corpus}
effort=fuzz/effort.tsv

have_libfuzzer() {
    probe=$(mktemp -d) || return 1
    echo 'int LLVMFuzzerTestOneInput(const unsigned char *d, unsigned long n);
int LLVMFuzzerTestOneInput(const unsigned char *d, unsigned long n) { return (int)(d && n > 9) * 0; }' \
        >"$probe/a.c"
    clang -fsanitize=fuzzer,address,undefined "$probe/a.c" -o "$probe/a" >/dev/null 2>&1
    result=$?
    rm -rf "$probe"
    return $result
}

if ! have_libfuzzer; then
    echo "fuzz: NOT RUN: clang with libFuzzer is missing (Debian: clang libclang-rt-14-dev)" >&2
    [ -n "${SE3D_FUZZ_OPTIONAL:-}" ] && exit 0
    exit 3
fi

build() {
    cmake --preset fuzz &&
        cmake --build --preset fuzz -j "$(se3d_jobs)" --target $(printf 'fuzz_%s ' $targets)
}
mkdir -p "$out/found" "$out/tmp"
build >"$out/build.log" 2>&1 || {
    tail -n 30 "$out/build.log" >&2
    exit 1
}
python3 tools/model_words.py >"$out/model.dict" || exit 1

# The text that a log has after a word: "stat::number_of_executed_units:".
number() {
    sed -n "s/^$1 *//p" "$2" | tail -n 1
}

# CPU seconds of all that has ended so far; a subshell would have none.
cpu() {
    times >"$out/times"
    spent=$(awk 'NR == 2 {gsub("m|s", " "); print int($1 * 60 + $2 + $3 * 60 + $4)}' "$out/times")
}

# add_effort TARGET SECONDS INPUTS: to what stands there for the target
add_effort() {
    awk -v target="$1" -v seconds="$2" -v inputs="$3" -v day="$(date +%F)" 'BEGIN { OFS = "\t" }
        $1 == target { $2 += seconds; $3 += inputs; $4 = day; found = 1 }
        { print }
        END { if (!found) print target, seconds, inputs, day }' "$effort" >"$out/effort" &&
        cp "$out/effort" "$effort"
}

each=$((seconds / $(echo $targets | wc -w)))
[ "$each" -gt 0 ] || each=1
failed=0
inputs=0
TMPDIR=$(pwd)/$out/tmp
ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1
UBSAN_OPTIONS=print_stacktrace=1
export TMPDIR ASAN_OPTIONS UBSAN_OPTIONS
for target in $targets; do
    mkdir -p "$corpus/$target"
    folders="$corpus/$target fuzz/seeds/$target"
    [ -d "fuzz/finds/$target" ] && folders="$folders fuzz/finds/$target"
    [ "$target" = model ] && folders="$folders examples/models"
    dictionary=fuzz/dictionaries/$target.dict
    [ "$target" = model ] && dictionary=$out/model.dict
    [ -f "$dictionary" ] && dictionary=-dict=$dictionary || dictionary=
    longest=4096
    [ "$target" = calls ] && longest=400
    cpu
    begun=$spent
    [ "$target" = bytes ] && longest=60
    # shellcheck disable=SC2086
    "$out/fuzz/fuzz_$target" $folders $dictionary -max_total_time="$each" -max_len=$longest \
        -timeout=100 -rss_limit_mb=3000 -malloc_limit_mb=2000 -print_final_stats=1 -verbosity=0 \
        -artifact_prefix="$out/found/$target-" ${SE3D_FUZZ_SEED:+-seed=$SE3D_FUZZ_SEED} \
        >"$out/$target.log" 2>&1
    status=$?
    count=$(number 'stat::number_of_executed_units:' "$out/$target.log")
    inputs=$((inputs + ${count:-0}))
    cpu
    add_effort "$target" $((spent - begun)) "${count:-0}"
    if [ $status -ne 0 ]; then
        failed=$((failed + 1))
        grep -aE 'ERROR|does not hold|runtime error|^ *#[0-9]+ .*(lib|tools|fuzz)/|Test unit written' \
            "$out/$target.log" | head -n 20
    fi
    printf 'fuzz: %-10s %9s inputs, %s\n' "$target" "${count:-?}" \
        "$([ $status -eq 0 ] && echo "none failed" || echo "FAILED: $out/$target.log")"
done
rm -rf "$out/tmp"
total=$(awk '!/^#/ { seconds += $2; inputs += $3 }
    END { printf "%.2f CPU hours, %d inputs", seconds / 3600, inputs }' "$effort")
echo "fuzz: $inputs inputs, $failed of $(echo $targets | wc -w) targets failed; all runs so far: $total"
[ "$failed" -eq 0 ]
