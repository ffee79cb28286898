# SPDX-License-Identifier: BSD-3-Clause
# Programs that are recorded and replayed: every status, output and hash is the same; callbacks that
# read, set and are refused; threads; models; a crash; recordings that are damaged or of which calls
# were taken away. SE3D_CORPUS: a folder of inputs of fuzz_calls beside the seeds.
# Run with SE3D_PROGRAM, SE3D_BUILD_DIR and SE3D_SOURCE_DIR set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"

programs=$SE3D_BUILD_DIR/tests/record
if [ ! -x "$programs/recorded_host" ]; then
    echo "recording: not built here"
    exit 0
fi
recorder=$SE3D_BUILD_DIR/lib/libse3d-record.so

# record NAME CODE PROGRAM WORDS...: into $dir/NAME.se3drec
record() {
    file=$dir/$1.se3drec
    code=$2
    shift 2
    where=$programs/recorded_$1
    shift
    expect "recording of $file" "$code" env SE3D_RECORD="$file" LD_PRELOAD="$recorder" "$where" "$@"
}

# replays NAME LEAST HASHES: all as recorded, with at least so many calls, and so many hashes
replays() {
    expect "replay of $1" 0 "$program" replay "$dir/$1.se3drec"
    has "$dir/out" ": all as recorded"
    has "$dir/out" "$3 hash"
    holds "$1: fewer calls than $2" [ "$(sed 's/ .*//;q' "$dir/out")" -ge "$2" ]
}

for example in contact_law impact pendulum tsda user_constraint; do
    record $example 0 $example
    replays $example 13 1
done
# shellcheck disable=SC2086
record calls 0 calls "$source/fuzz/seeds/calls" "$source/fuzz/finds/calls" ${SE3D_CORPUS:-}
replays calls 10000 ""

record swing 0 host
replays swing 10 1
record threads 0 host threads
replays threads 20 2
record model 0 host model "$models/pendulum_events.yaml" "$dir/results"
replays model 50 1
expect "a program that asks" 0 "$programs/recorded_linked" swing "$dir/linked.se3drec"
replays linked 10 1

# A program that crashes: what it did until then is there.
record crash 134 host crash
expect "replay of a crash" 1 "$program" replay "$dir/crash.se3drec"
says "se3d_solver_run: its callback"
says "did not return"

# A full disk: the program goes on, the recording ends with a whole call, and says so.
expect "recording on a full disk" 0 sh -c 'trap "" XFSZ; ulimit -f 60; SE3D_RECORD="$1" LD_PRELOAD="$2" exec "$3"' \
    sh "$dir/cut.se3drec" "$recorder" "$programs/recorded_impact"
says "se3d-record: the recording ends here"
expect "replay of what is whole, which ends within a call" 1 "$program" replay "$dir/cut.se3drec"

# What differs is named: the step of the solver is another number of the file.
python3 - "$dir/pendulum.se3drec" "$dir" <<'END' || fail "the recording could not be changed"
import struct, sys
sys.path.insert(0, "tools")
from minimise_recording import CALL, RETURN, read, write
data = open(sys.argv[1], "rb").read()
version, names, pieces = read(data)
calls = [k for k, p in enumerate(pieces) if p[1] == CALL]
at = [k for k in calls if names[struct.unpack_from("<I", pieces[k][2])[0]] == b"se3d_system_get_gravity"
      or names[struct.unpack_from("<I", pieces[k][2])[0]] == b"se3d_solver_run"][0]
thread, kind, content = pieces[at]
changed = pieces[:at] + [(thread, kind, content[:-1] + bytes([content[-1] ^ 16]))] + pieces[at + 1:]
open(sys.argv[2] + "/other.se3drec", "wb").write(write(version, names, [changed]))
for k in range(14):
    size = len(data) * k // 14
    open(f"{sys.argv[2]}/cut{k}.se3drec", "wb").write(data[:size])
    flipped = bytearray(data)
    flipped[size] ^= 1 << k % 8
    open(f"{sys.argv[2]}/flip{k}.se3drec", "wb").write(flipped)
END
expect "another time" 1 "$program" replay "$dir/other.se3drec"
says "call "
says " when recorded"
for file in "$dir"/cut*.se3drec "$dir"/flip*.se3drec; do
    timeout 20 "$program" replay "$file" >"$dir/out" 2>"$dir/err"
    code=$?
    holds "$file: exit code $code" [ $code -le 2 ]
    holds "$file: no word" [ -s "$dir/out" -o -s "$dir/err" ]
done

# A failure among many calls: few are left, and they fail in the same way.
expect "minimiser" 0 python3 tools/minimise_recording.py "$dir/swing.se3drec" "$dir/small.se3drec" \
    --program "$program" --function se3d_body_destroy
has "$dir/out" "se3d_body_destroy: -6"
holds "more than 8 calls: $(cat "$dir/out")" [ "$(sed 's/.*: \([0-9]*\) of.*/\1/' "$dir/out")" -le 8 ]
expect "what is left" 0 "$program" replay --unchecked --list "$dir/small.se3drec"
has "$dir/out" "se3d_body_destroy: -6"
finish
