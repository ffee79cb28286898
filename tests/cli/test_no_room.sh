# SPDX-License-Identifier: BSD-3-Clause
# Room that runs out and readers that go away: every command that writes files is run with less and less room for each
# of them, and with every write refused once by a quota (where strace can trace); every command that prints does so
# into a pipe that nobody reads, or no longer. What must hold: exit code 1, a message that names the file and the
# reason, files that are whole or begin as the whole ones, and nothing unfinished.
. tests/support/cli.sh
cd "$dir" || exit 1
case $source in /*) ;; *) source=$OLDPWD/$source ;; esac
models=$source/examples/models
export SE3D_CACHE="${SE3D_BUILD_DIR:-$dir}/viewer"

cat >m.yaml <<'END'
se3d: 1
title: A bar on a spring
parameters: {m: 2, k: 50}
bodies:
  - name: bar
    mass: m
    inertia: [0.1, 1, 1]
    position: [1, 0, 0]
    shapes: [{type: box, size: [2, 0.1, 0.2]}, {type: sphere, radius: 0.2, position: [1, 0, 0]}]
joints: [{name: pin, type: revolute, body_i: ground, body_j: bar, at: [0, 0, 0], axis: [0, 1, 0]}]
forces: [{name: spring, type: tsda, body_i: ground, body_j: bar, point_i: [1, 0, 1], k: k, l0: 1}]
events: [{name: low, channel: pin.angle, value: 0.1}]
analysis: {type: dynamics, method: rk4, duration: 0.4, step: 0.01}
output:
  - {file: m.csv, every: 0.02, channels: [bar.position, pin.angle, pin.force]}
  - {vtk: motion.pvd, every: 0.2}
study: {parameters: {k: [40, 50, 60]}, measures: {most: {max: pin.angle}}}
END
printf 'se3d:   1\nbodies:   [{name:  b, mass:   1,inertia: [1, 1, 1]}]\n' >ugly.yaml
"$program" run -q m.yaml -o from

# what COMMAND OUTPUT: the command, which leaves all that it makes in the folder OUTPUT
what() {
    case $1 in
    run) set -- run m.yaml -o "$2" ;;
    kept) set -- run m.yaml --checkpoint 0 -o "$2" ;;
    study) set -- study m.yaml -o "$2" ;;
    report) set -- report m.yaml -o "$2" ;;
    sketch) set -- sketch m.yaml -o "$2/m.svg" ;;
    view) set -- view from -o "$2/m.html" ;;
    import) set -- import "$source/tests/import/arm.urdf" --partial -o "$2/m.yaml" ;;
    write) set -- write m.yaml --partial -o "$2/m.yaml" ;;
    new) set -- new "$2/m.yaml" ;;
    fmt) set -- fmt "$2/m.yaml" ;;
    fmu) set -- fmu m.yaml -o "$2/m.fmu" ;;
    *) set -- fail ;;
    esac
    $before "$program" "$@" 2>&1
}

# prepare FOLDER: nothing is there but what `fmt` is told to lay out
prepare() {
    rm -rf "$1" && mkdir "$1" && [ "$command" != fmt ] || cp ugly.yaml "$1/m.yaml"
}

# begins FILE WHOLE: whole lines with which the whole file begins
begins() {
    size=$(wc -c <"$1")
    cmp -s -n "$size" "$1" "$2" && [ "$size" -gt 0 ] && [ "$(tail -c 1 "$1" | wc -l)" -eq 1 ]
}

# sound FOLDER WHOLE TEXT: no file is unfinished, or looks whole and is not
sound() {
    find "$1" -type f >names
    while read -r file; do
        short=${file#"$1"/}
        checks=$((checks + 1))
        case $short in
        *.partial*) fail "$3: $short is left over" ;;
        study.csv) cmp -s -n "$(wc -c <"$file")" "$file" "$2/$short" || fail "$3: $short is torn" ;; # for --resume
        *.csv) begins "$file" "$2/$short" || fail "$3: $short is cut" ;;
        *.pvd)
            sed -n 's/.* file="\([^"]*\)".*/\1/p' "$file" >listed
            while read -r each; do [ -f "$1/$each" ] || fail "$3: $short lists $each"; done <listed
            ;;
        *.checkpoint) ;; # cli.resume goes on from them
        *.glb) [ "$(od -An -tu4 -j8 -N4 "$file")" -eq "$(wc -c <"$file")" ] || fail "$3: $short is cut" ;; # up to the failure
        *) cmp -s "$file" "$2/$short" || [ "$(cat "$file")" = "$(cat ugly.yaml)" ] || fail "$3: $short is cut" ;;
        esac
    done <names
}

# refused COMMAND FOLDER STATUS TEXT: it ends as one that has no room, or has not noticed
refused() {
    if [ "$3" -ne 0 ]; then
        is "$3" 1
        checks=$((checks + 1))
        echo "$message" | grep -qE "$5" || fail "$4: $message"
        sound "$2" "whole/$1" "$4"
    else
        holds "$4: what is made differs" diff -r -x '*.checkpoint' "whole/$1" "$2"
    fi
}

commands='run study report sketch import write new fmt'
if [ -e "${SE3D_BUILD_DIR:-.}/fmi" ] || "$program" fmu m.yaml -o x.fmu -q 2>/dev/null; then
    commands="$commands fmu"
fi
if [ -f "$SE3D_CACHE/three.js" ] || command -v npm >/dev/null 2>&1; then
    commands="$commands view"
else
    echo 'SKIPPED: no three.js and no npm: pages were not tried' >&2
fi
mkdir whole got
for command in $commands; do
    before=
    mkdir "whole/$command"
    prepare "whole/$command"
    what "$command" "whole/$command" >out || fail "$command: $(cat out)"
    # Blocks of 512 bytes.
    for room in 0 40; do
        prepare got
        message=$(ulimit -f $room && what "$command" got) # a pipe has room
        refused "$command" got $? "$command with $room blocks" 'got/[^ ]*: cannot be written: File too large'
    done
done

# Every write refused once, as a quota does.
traced() { strace -qq -o trace -e trace=write,writev,pwrite64 "$@"; }
if traced true 2>err; then
    for command in run write fmt; do
        before=traced
        prepare got
        what "$command" got >out
        writes=$(grep -c . trace)
        holds "$command writes nothing" [ "$writes" -gt 0 ]
        number=1
        while [ $number -le "$writes" ]; do
            prepare got
            before="strace -qq -o trace -e trace=write,writev,pwrite64 -e inject=write,writev,pwrite64:error=EDQUOT:when=$number"
            message=$(what "$command" got)
            refused "$command" got $? "$command without write $number" \
                '(got/[^ ]*: |standard output )cannot be written(: Disk quota exceeded)?'
            number=$((number + 1))
        done
    done
else
    echo "SKIPPED: strace cannot trace: quotas were not tried: $(cat err)" >&2
fi
before=

# Readers that have gone before a word is said: results are whole all the same.
cat >alone.py <<'END'
import os, subprocess, sys
end, out = os.pipe()
os.close(end)
sys.exit(subprocess.run(sys.argv[1:], stdout=out, stderr=subprocess.PIPE, timeout=60).returncode % 256)
END
for command in $commands; do
    prepare got
    before="python3 alone.py"
    what "$command" got >out
    status=$?
    case $command in
    import | write) is "$command $status" "$command 0" ;; # say nothing
    sketch | new | fmt | fmu) is "$command $status" "$command 243" ;; # all is done: the signal ends them
    *) is "$command $status" "$command 1" ;;
    esac
    holds "$command without a reader: what is made differs" diff -r -x '*.checkpoint' "whole/$command" got
done
before=
finish
