# SPDX-License-Identifier: BSD-3-Clause
# A mock-up unit as a force on a model: a spring that is a unit of its own, against the closed form, whose error goes down
# with the communication step; and what is refused.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
. "$source/tests/support/fmi.sh"
case ${ASAN_OPTIONS:-}${UBSAN_OPTIONS:-} in ?*) exit 0 ;; esac # the object has none of the sanitizer

cat >"$dir/spring.yaml" <<'END_OF_YAML'
se3d: 1
gravity: [0, 0, 0]
parameters: {k: 50}
bodies: [{name: end, mass: 1, inertia: [1, 1, 1]}]
joints: [{name: rail, type: prismatic, body_i: ground, body_j: end, at: [0, 0, 0], axis: [1, 0, 0]}]
drivers: [{name: place, joint: rail, value: 0}]
forces: [{name: spring, type: tsda, body_i: ground, body_j: end, point_i: [-1, 0, 0], k: k, l0: 1}]
analysis: {type: dynamics, duration: 10}
output: [{file: a.csv, every: 1, channels: [{push: -1*spring.force}]}]
END_OF_YAML
for fmi in 2 3; do
    expect "the unit, FMI $fmi" 0 "$program" fmu "$dir/spring.yaml" --fmi $fmi -o "$dir/spring.$fmi.fmu"
    unpack "$dir/spring.$fmi.fmu" "$dir/spring.$fmi"
done

# host FMI STEP: a mass of 1 kg on the spring of 100 N/m
host() {
    cat <<END_OF_YAML
se3d: 1
gravity: [0, 0, 0]
bodies: [{name: block, mass: 1, inertia: [1, 1, 1], velocity: [1, 0, 0]}]
joints: [{name: rail, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], axis: [1, 0, 0]}]
forces: [{name: push, type: effort, joint: rail, value: 0}]
fmus:
  - {name: spring, file: spring.$1, step: $2, inputs: [{variable: place.input, channel: rail.displacement}],
     outputs: [{variable: push, element: push}], parameters: [{variable: parameters.k, value: 100}]}
analysis: {type: dynamics, duration: 0.5}
output: [{file: a.csv, every: 0.05, channels: [rail.displacement, push.effort, energy.balance]}]
END_OF_YAML
}

# error: the largest difference from sin(10 t) / 10, and of the audit of energy
error() {
    awk -F, 'NR > 1 { e = $2 - sin(10 * $1) / 10; e = e < 0 ? -e : e; if (e > m) m = e
        b = $4 - 0.5; if (b < -1e-9 || b > 1e-9) bad = 1 } END { printf "%.9f %d\n", m, bad }' "$dir/$1/a.csv"
}
for fmi in 2 3; do
    for step in 0.002 0.001; do
        host $fmi $step >"$dir/host.yaml"
        expect "the spring, FMI $fmi" 0 "$program" run -q "$dir/host.yaml" -o "$dir/run.$fmi.$step"
    done
    error "run.$fmi.0.002" >"$dir/coarse"
    error "run.$fmi.0.001" >"$dir/fine"
    holds "errors $(cat "$dir/coarse") and $(cat "$dir/fine")" awk '
        NR == 1 { a = $1; w = $2 } NR == 2 { exit !($1 < 2.5e-3 && $1 > 1e-5 && a / $1 > 1.8 && a / $1 < 2.2 && !w && !$2) }' \
        "$dir/coarse" "$dir/fine"
done

# A unit that leaves the processor rounding upwards and small numbers as zeros changes no bit of the host.
cat >"$dir/rude.c" <<'END_OF_C'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fenv.h>
#include <stddef.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif
__attribute__((constructor)) static void spoil(void)
{
    fesetround(FE_UPWARD);
#if defined(__SSE2__)
    _mm_setcsr(_mm_getcsr() | 0x8040u);
#endif
}
int fmi2SetReal(void *c, const unsigned *at, size_t n, const double *values)
{
    int (*call)(void *, const unsigned *, size_t, const double *);
    *(void **)&call = dlsym(RTLD_NEXT, "fmi2SetReal");
    const int status = call(c, at, n, values);
    spoil();
    return status;
}
int fmi3SetFloat64(void *c, const unsigned *at, size_t n, const double *values, size_t count)
{
    int (*call)(void *, const unsigned *, size_t, const double *, size_t);
    *(void **)&call = dlsym(RTLD_NEXT, "fmi3SetFloat64");
    const int status = call(c, at, n, values, count);
    spoil();
    return status;
}
END_OF_C
for fmi in 2 3; do
    cp -r "$dir/spring.$fmi" "$dir/rude.$fmi"
    object=$(ls "$dir/rude.$fmi/binaries/"*/*.so)
    mv "$object" "${object%/*}/polite.so"
    expect "a rude unit, FMI $fmi" 0 "${CC:-cc}" -shared -fPIC -o "$object" "$dir/rude.c" -lm -ldl \
        -Wl,--no-as-needed "${object%/*}/polite.so" "-Wl,-rpath,${object%/*}"
    host $fmi 0.002 | sed "s/file: spring/file: rude/" >"$dir/host.yaml"
    expect "a rude unit runs, FMI $fmi" 0 "$program" run -q "$dir/host.yaml" -o "$dir/rude.run.$fmi"
    holds 'the unit changed the host' cmp "$dir/rude.run.$fmi/a.csv" "$dir/run.$fmi.0.002/a.csv"
done

# The order of units does not matter: all are told before any acts.
both() {
    echo 'se3d: 1
gravity: [0, 0, 0]
bodies: [{name: block, mass: 1, inertia: [1, 1, 1], velocity: [1, 0, 0]}]
joints: [{name: rail, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], axis: [1, 0, 0]}]
forces: [{name: push, type: effort, joint: rail, value: 0}, {name: more, type: effort, joint: rail, value: 0}]
analysis: {type: dynamics, duration: 0.1}
output: [{file: a.csv, every: 0.02, channels: [rail.displacement, push.effort, more.effort]}]
fmus:'
    for each in "$@"; do
        case $each in
        a) echo "  - {name: a, file: spring.3, step: 0.02, inputs: [{variable: place.input, channel: rail.displacement}],
     outputs: [{variable: push, element: push}]}" ;;
        b) echo "  - {name: b, file: spring.3, step: 0.02, inputs: [{variable: place.input, channel: 0.1*push.effort}],
     outputs: [{variable: push, element: more}]}" ;;
        esac
    done
}
both a b >"$dir/ab.yaml"
both b a >"$dir/ba.yaml"
expect 'two units of one library' 0 "$program" run -q "$dir/ab.yaml" -o "$dir/ab"
expect 'the other way round' 0 "$program" run -q "$dir/ba.yaml" -o "$dir/ba"
holds 'the order of units matters' cmp "$dir/ab/a.csv" "$dir/ba/a.csv"

# A model that is written names them from where it stands, and a folder may have any name.
mkdir "$dir/other"
cp -r "$dir/spring.2" "$dir/spring %41 2"
host 2 0.002 | sed 's/file: spring.2/file: "spring %41 2"/' >"$dir/host.yaml"
expect 'writing' 0 "$program" write "$dir/host.yaml" -o "$dir/other/host.yaml"
expect 'what was written' 0 "$program" run -q "$dir/other/host.yaml" -o "$dir/written"
holds 'written otherwise' cmp "$dir/written/a.csv" "$dir/run.2.0.002/a.csv"

# A packed unit is unpacked into a folder that is gone afterwards.
mkdir "$dir/tmp"
export TMPDIR="$dir/tmp"
left() {
    is "left behind by $1: $(ls "$dir/tmp")" "left behind by $1: "
}
python3 - "$dir" <<'END_OF_PYTHON' || fail 'packing'
import sys, warnings, zipfile
warnings.simplefilter("ignore")  # of names that are there twice
folder = sys.argv[1]
whole = zipfile.ZipFile(folder + "/spring.2.fmu")
files = {name: whole.read(name) for name in whole.namelist()}

def pack(name, more=(), change=None, method=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(f"{folder}/{name}.fmu", "w", method) as out:
        for file, content in list(files.items()) + list(more):
            out.writestr(file, content)
    if change:
        with open(f"{folder}/{name}.fmu", "rb") as made:
            content = bytearray(made.read())
        content = change(content) or content
        with open(f"{folder}/{name}.fmu", "wb") as made:
            made.write(content)

def link(name, mode):
    info = zipfile.ZipInfo(name)
    info.create_system, info.external_attr = 3, mode << 16
    return info

def at(content, mark, offset, size, value):
    """A number in the last entry of the list, or in the end record."""
    begin = content.rindex(mark) + offset
    content[begin:begin + size] = value.to_bytes(size, "little")

ENTRY, END, LOCAL = b"PK\x01\x02", b"PK\x05\x06", b"PK\x03\x04"
pack("packed")
pack("stored", method=zipfile.ZIP_STORED)
files["resources/"] = b""
pack("folders")
files = {"modelDescription.xml": files["modelDescription.xml"]}
for name, file in (("up", "../out.txt"), ("inner", "resources/../../out.txt"), ("root", "/out.txt"),
                   ("dot", "resources/./a"), ("empty", "resources//a"), ("drive", "c:/out.txt"),
                   ("back", "resources\\..\\out.txt"), ("line", "resources/a\nb")):
    pack(name, [(file, b"x")])
pack("nul", [("resources/aXb", b"x")], lambda c: c.replace(b"resources/aXb", b"resources/a\0b"))
pack("link", [(link("resources/link", 0o120777), b"/etc")])
pack("device", [(link("resources/device", 0o020666), b"")])
pack("twice", [("resources/a", b"1"), ("resources/a", b"2")])
pack("below", [("resources/a", b"1"), ("resources/a/b", b"2")])
pack("bomb", [("resources/zeros", bytes(40 << 20))])
pack("claims", [("resources/a", b"x")], lambda c: at(c, ENTRY, 24, 4, 1 << 30))
pack("short", [("resources/a", b"x" * 100)], lambda c: at(c, ENTRY, 24, 4, 99))
pack("sum", [("resources/a", b"x" * 100)], lambda c: at(c, ENTRY, 16, 4, 1))
pack("secret", [("resources/a", b"x")], lambda c: at(c, ENTRY, 8, 2, 1))
pack("bzip", [("resources/a", b"x")], lambda c: at(c, ENTRY, 10, 2, 12))
pack("overlap", [("resources/a", b"x" * 5)],
     lambda c: at(c, ENTRY, 20, 4, len(c) - 100) or at(c, ENTRY, 24, 4, len(c) - 100))
pack("place", [("resources/a", b"x")], lambda c: at(c, ENTRY, 42, 4, 7))
pack("beyond", [("resources/a", b"x")], lambda c: at(c, ENTRY, 42, 4, 1 << 30))
pack("other", [("resources/a", b"x")], lambda c: at(c, LOCAL, 30, 1, 64))
pack("many", change=lambda c: at(c, END, 8, 2, 99) or at(c, END, 10, 2, 99))
pack("few", [("resources/a", b"x")], lambda c: at(c, END, 8, 2, 1) or at(c, END, 10, 2, 1))
pack("parts", change=lambda c: at(c, END, 4, 2, 1))
pack("moved", change=lambda c: b"before" + c)
pack("cut", change=lambda c: c[:-30])
pack("nothing", change=lambda c: b"x")
END_OF_PYTHON
for packed in packed stored folders; do
    host 2 0.002 | sed "s/file: spring.2/file: $packed.fmu/" >"$dir/host.yaml"
    expect "a unit that is $packed" 0 "$program" run -q "$dir/host.yaml" -o "$dir/$packed.run"
    holds "$packed: another motion" cmp "$dir/$packed.run/a.csv" "$dir/run.2.0.002/a.csv"
    left $packed
done

# hostile NAME TEXT: an archive that is refused, with its reason, and nothing is left of it
hostile() {
    host 2 0.01 | sed "s/file: spring.2/file: $1.fmu/" >"$dir/hostile.yaml"
    expect "the archive $1" "${3:-2}" "$program" run -q "$dir/hostile.yaml" -o "$dir/hostile.run"
    says 'fmu `spring`'
    says "$2"
    left "$1"
}
for packed in up inner root dot empty drive back line nul; do
    hostile $packed 'whose name may lead out of it'
done
hostile link '`resources/link` is a link or a device'
hostile device '`resources/device` is a link or a device'
hostile twice 'the name is there twice' 1
hostile below '`resources/a/b` cannot be unpacked' 1
hostile bomb 'would become far too large'
hostile claims '`resources/a` has sizes that cannot be'
hostile short '`resources/a` is damaged' 1
hostile sum '`resources/a` is damaged' 1
hostile secret 'is encrypted'
hostile bzip 'another method than Deflate'
hostile overlap 'its files overlap' 1
hostile place 'not where its list says' 1
hostile beyond 'not where its list says' 1
hostile other 'not where its list says' 1
hostile many 'shorter than it says' 1
hostile few 'longer than it says' 1
hostile parts 'one part of several'
hostile moved 'its list is elsewhere' 1
hostile cut 'neither a folder nor a whole zip archive' 1
hostile nothing 'neither a folder nor a whole zip archive' 1
holds 'a file was left outside' test ! -e "$dir/out.txt" -a ! -e "$dir/tmp/out.txt"
TMPDIR="$dir/none"
hostile packed 'none/se3d-' 1
unset TMPDIR

# A run that is killed and resumed ends as one that is not: the state of a unit is in the checkpoint. The folder that a
# killed run leaves is gone after the next one; one of a living program stays, and what only looks like one.
export TMPDIR="$dir/tmp"
mkdir "$dir/tmp/se3d-held-living" "$dir/tmp/se3d-held-results" "$dir/tmp/se3d-other" "$dir/far"
touch "$dir/tmp/se3d-held-a-file" "$dir/far/kept"
ln -s "$dir/far" "$dir/tmp/se3d-held-a-link"
(
    exec 9<"$dir/tmp/se3d-held-living" >/dev/null 2>&1
    flock 9 && exec sleep 60
) &
holder=$!
cat >"$dir/lag.yaml" <<'END_OF_YAML'
se3d: 1
gravity: [0, 0, 0]
bodies: [{name: end, mass: 1, inertia: [1, 1, 1]}]
joints: [{name: rail, type: prismatic, body_i: ground, body_j: end, at: [0, 0, 0], axis: [1, 0, 0]}]
forces:
  - {name: spring, type: tsda, body_i: ground, body_j: end, point_i: [-1, 0, 0], k: 400, c: 8, l0: 1}
  - {name: pull, type: effort, joint: rail, value: 0}
analysis: {type: dynamics, duration: 100}
output: [{file: a.csv, every: 1, channels: [{push: -5*rail.displacement-1*rail.rate}]}]
END_OF_YAML
for each in 2:effort 3:effort 3:rate; do
    fmi=${each%:*}
    expect "the lag, FMI $fmi" 0 "$program" fmu "$dir/lag.yaml" --fmi $fmi -o "$dir/lag.$fmi.fmu"
    host $fmi 0.002 | sed "s/spring\.$fmi/lag.$fmi.fmu/; s/place.input/pull.input/; s/, parameters:.*/}/
        s/duration: 0.5/duration: 4/; s/every: 0.05/every: 0.002/" >"$dir/kept.yaml"
    if [ "$each" = 3:rate ]; then
        sed -i 's/^forces:.*/drivers: [{name: push, joint: rail, rate: 0}]/' "$dir/kept.yaml"
    fi
    expect "the lag in peace, $each" 0 "$program" run -q "$dir/kept.yaml" -o "$dir/peace"
    rm -rf "$dir/kept"
    hits=0
    for nap in 0.3 0.4 0.5 0.7 1 1.5; do
        [ $hits -ge 2 ] && break
        "$program" run -q "$dir/kept.yaml" --checkpoint 0 --resume -o "$dir/kept" 2>"$dir/err" &
        sleep $nap
        kill -9 $! 2>/dev/null
        wait $!
        [ -e "$dir/kept/run.checkpoint" ] && hits=$((hits + 1))
    done
    holds "$each: no run was killed on its way" [ $hits -gt 0 ]
    [ "$(ls -d "$dir/tmp/se3d-held-"* | wc -l)" -gt 4 ] && lost=yes
    sed 's/name: spring, file/name: other, file/' "$dir/kept.yaml" >"$dir/else.yaml"
    expect 'another model' 1 "$program" run -q "$dir/else.yaml" --resume -o "$dir/kept"
    says 'is of another model'
    if [ "$each" = 3:effort ]; then # the unit behind the name is another one
        cp "$dir/lag.3.fmu" "$dir/lag.same"
        cp "$dir/spring.3.fmu" "$dir/lag.3.fmu"
        expect 'another unit' 1 "$program" run -q "$dir/kept.yaml" --resume -o "$dir/kept"
        says 'fmu `spring`'
        cp "$dir/lag.same" "$dir/lag.3.fmu"
    fi
    expect "the lag resumed, $each" 0 "$program" run -q "$dir/kept.yaml" --resume -o "$dir/kept"
    holds "$each: resumed otherwise" cmp "$dir/kept/a.csv" "$dir/peace/a.csv"
done
kill $holder
holds 'no folder was left by a run that was killed' [ "${lost:-no}" = yes ]
is "$(ls "$dir/tmp" | tr '\n' ' ')" 'se3d-held-a-file se3d-held-a-link se3d-held-living se3d-held-results se3d-other '
test -e "$dir/far/kept" || fail 'what a link leads to is gone'
rm -r "$dir/tmp/"se3d-*
unset TMPDIR
sed 's/canSerializeFMUState="true"/canSerializeFMUState="false"/' "$dir/spring.3/modelDescription.xml" \
    >"$dir/rows.xml"

# What is wrong is said with the name of the unit.
wrong() {
    host 2 0.01 | sed "$1" >"$dir/wrong.yaml"
    expect "$2" "$3" "$program" run -q "$dir/wrong.yaml" -o "$dir/wrong.run"
    says "$2"
}
wrong 's/place.input/nothing/' 'fmu `spring`: it has no variable `nothing`' 1
wrong 's/variable: push,/variable: place.input,/' 'must be output Real' 1
wrong 's/file: spring.2/file: nowhere/' 'nowhere/modelDescription.xml' 1
wrong 's/element: push/element: pull/' 'there is no such element' 2
wrong 's/element: push/element: rail/' 'has no such number' 2
wrong 's/channel: rail.displacement/channel: rail.length/' 'rail.length' 2
wrong 's/step: 0.01/step: 0/' 'step' 2
wrong 's/step: 0.01/step: 1e-30/' 'too short to be seen' 1
wrong 's/channel: rail.displacement/channel: 1\/(rail.displacement-rail.displacement)/' 'fmu `spring`' 1
cp -r "$dir/spring.3" "$dir/rows.3"
sed 's|<Float64 name="push"[^/]*"|&><Dimension start="3"/></Float64|; s|</Float64/>|</Float64>|' \
    "$dir/spring.3/modelDescription.xml" >"$dir/rows.3/modelDescription.xml"
wrong 's/file: spring.2/file: rows.3/' 'is output array, must be output Float64' 1
sed 's/<CoSimulation /&canBeInstantiatedOnlyOncePerProcess="true" /' "$dir/spring.3/modelDescription.xml" \
    >"$dir/rows.3/modelDescription.xml"
sed 's/spring.3/rows.3/' "$dir/ab.yaml" >"$dir/twice.yaml"
expect 'one too many' 2 "$program" run -q "$dir/twice.yaml" -o "$dir/twice.run"
says 'there can be one of this unit only'
cp "$dir/rows.xml" "$dir/rows.3/modelDescription.xml"
host 3 0.01 | sed 's/spring.3/rows.3/' >"$dir/stateless.yaml"
expect 'no states' 0 "$program" run -q "$dir/stateless.yaml" -o "$dir/stateless.run"
expect 'checkpoints' 2 "$program" run -q "$dir/stateless.yaml" --checkpoint 1 -o "$dir/kept.run"
says 'fmu `spring`: the run can have no checkpoints, since the unit cannot write its state'
expect 'a unit of it' 2 "$program" fmu "$dir/host.yaml" -o "$dir/no.fmu"
says 'units do not hold others'
mv "$dir/spring.2/binaries" "$dir/spring.2/none"
wrong 's/x/x/' 'no shared object that this machine can load' 1
finish
