# SPDX-License-Identifier: BSD-3-Clause
# Names that other programs would take for commands, options, pipes, ends of strings or of scripts: in every place from
# which they reach gnuplot, SVG, pages, glTF, JSON, VTK lists and ffmpeg. Each is refused or shown; none is obeyed.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
export SE3D_VIEWER="$source/tools/viewer" SE3D_PROGRAM="$program" TMPDIR="$dir/tmp"
mkdir "$dir/tmp" "$dir/cache"
printf '/* three.js */\n' >"$dir/cache/three.js"
printf 'three 0.187 uplot 1.6.32 %s\n' "$(cksum <"$source/tools/viewer/three_entry.js")" >"$dir/cache/three.stamp"
export SE3D_CACHE="$dir/cache"
cat >"$dir/names.py" <<'END_OF_PYTHON'
import json, os, re, shutil, struct, subprocess, sys
import xml.dom.minidom as xml
root, program = sys.argv[1], os.environ["SE3D_PROGRAM"]
names = [b"plain", b"<touch PWNED; cat x", b"| touch PWNED; cat >x", b"|touch PWNED", b"-", b"-o", b"--help", b"-esystem('touch PWNED')",
         b'nl\nsystem("touch PWNED")\n#', b'cr\rsystem("touch PWNED")\r#', b"q'; system('touch PWNED'); a='", b"q\nEND_OF_DATA\nsystem('touch PWNED')",
         b'q"; system("touch PWNED"); a="', b"`touch PWNED`", b"$(touch PWNED)", b"${IFS}@PWNED", b"tail\\", b"tail\\\n", b"{/=50 x", b"} system 'touch PWNED'",
         b"</script><script>window.PWNED=1</script>", b"</title></svg><svg onload='PWNED'>", b"<!--", b"]]>&amp;\"'", b"\xe2\x80\xa8system('touch PWNED')",
         b"\xe2\x80\xae\xc2\x9b31m", b"\x1b]0;PWNED\x07", b"\x01\x7f", b"\xff\xfe\xc3", b"\xed\xa0\x80", b"\xef\xbf\xbf", b"pipe:1", b"concat:x|y", b"tee:PWNED",
         b"~root", b"%s%n%s", b"../PWNED", b"a/../../PWNED", b"x\r", b"con", b" x ", b"=1+1", b"K\xc3\xb6rper \xe2\x98\x83"]
failed = 0
def check(good, what, name):
    global failed
    if not good:
        failed += 1
        print("%r: %s" % (name, what), file=sys.stderr)
def run(words, where, codes, name):
    done = subprocess.run([program] + words, cwd=where, stdin=subprocess.DEVNULL, capture_output=True, timeout=120)
    check(done.returncode in codes, "%r: exit code %d: %s" % (words, done.returncode, done.stderr[:300]), name)
    return done
wanted = 0
def look(where, name):
    global wanted
    for folder, folders, files in os.walk(where):
        for f in folders + files:
            path = os.path.join(folder, f)
            check(os.fsencode(f) != b"PWNED" and b".partial" not in os.fsencode(f), "made " + repr(path), name)
            if f.endswith(".svg"):
                try:
                    xml.parse(path)
                except Exception as problem:
                    check(False, "%s in %s" % (problem, open(path, "rb").read().splitlines()[202:204]), name)
                    continue
                check(not xml.parse(path).getElementsByTagName("script") and b"onload='" not in open(path, "rb").read().replace(b"&lt;svg onload='", b""), "SVG", name)
            if f.endswith(".glb"):
                data = open(path, "rb").read()
                json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]].decode("utf-8"))
            if f.endswith(".pvd"):
                xml.parse(path)
            if f.endswith(".html"):
                page = open(path, "rb").read()
                scripts = len(re.findall(rb"</?script", page, re.I))
                wanted = wanted or scripts # of the first, plain name
                check(scripts == wanted and b"<!--" not in page.split(b"id=\"results\"")[1].split(b"</script>")[0],
                      "a page of other scripts", name)
                page.decode("utf-8")
    check(not os.path.exists(os.path.join(root, "PWNED")) and not os.listdir(os.environ["TMPDIR"]), "left something", name)
def word(name):  # a YAML text
    text = name.decode("utf-8", "replace")
    return '"' + "".join("\\U%08X" % ord(c) if ord(c) < 32 or ord(c) > 126 or c in '"\\' else c for c in text) + '"'
model = """se3d: 1
title: %s
bodies: [{name: %s, mass: 1, inertia: [1, 1, 1], velocity: [0, 0, 1]}]
analysis: {type: dynamics, duration: 0.04, step: 0.01}
output:
"""
drawn = shutil.which("gnuplot") is not None
for number, name in enumerate(names):
    where = os.path.join(root, "%d" % number)
    os.mkdir(where)
    at = lambda ending: os.path.join(os.fsencode(where), name + ending)
    # As the name of the model's parts and outputs, in an entry each.
    files = b"{file: N.csv}, {vtk: N.pvd}, {scene: N.html}, {file: r.csv}" + (b", {plot: N.svg, from: r.csv}" if drawn else b"")
    for entries in (files, b"{file: r.csv, channels: [N.position]}, {plot: p.svg, channels: [N]}"):
        if not drawn and b"plot" in entries:
            continue
        entries = re.sub(rb"N([.\w]*)", lambda m: word(name + m.group(1)).encode(), entries).decode()
        with open(where + "/m.yaml", "w") as file:
            file.write(model % (word(name), word(name) if "position" in entries else "a") + "  [%s]\n" % entries)
        done = run(["run", "--json", "m.yaml", "-o", "out"], where, (0, 2), name)
        json.loads(done.stdout.decode("utf-8").splitlines()[0])
        look(where, name)
    # As the name and the header of results from anywhere, and of what is made of them.
    results = os.path.join(os.fsencode(where), b"results")
    os.mkdir(results)
    header = b"time," + name.replace(b",", b"").replace(b"\n", b"") + b".position,b\r"
    rows = b"".join(b"%d,%d,%d\n" % (k, k * k, 3 - k) for k in range(8))
    if b"/" not in name:
        with open(at(b".csv"), "wb") as file:
            file.write(header + b"\n" + rows)
        with open(results + b"/" + name + b".csv", "wb") as file:
            file.write(header + b"\n" + rows)
        with open(results + b"/grains of sets.csv", "wb") as file: # shown beside them
            file.write(b"time,id,radius,x,y,z,set\n0,0,1,0,0,0,\n0,1,1,2,0,0," + name.replace(b",", b"").replace(b"\n", b"") + b"\n")
        shutil.copy(os.fsencode(root) + b"/scene.glb", results)
        if drawn:
            run(["plot", "--", name + b".csv"], where, (0, 2), name)
            if os.path.exists(at(b".gp")):
                os.remove(at(b".svg"))
                script = open(at(b".gp"), "rb").read().replace(b"'svg png'", b"'svg'")
                done = subprocess.run(["gnuplot", "-d", "-"], input=script, cwd=where, capture_output=True)
                check(done.returncode == 0 and os.path.exists(at(b".svg")) and not done.stderr, "the kept script: %r" % done.stderr, name)
            else:
                run(["plot", "-o", "safe.svg", "--", name + b".csv"], where, (0,), name)
            if number % 8 == 0 or name.endswith(b"\r"):
                run(["plot", "--fft", "-o", "f.svg", "--", name + b".csv"], where, (0,), name)
        os.rename(results, at(b""))
        run(["view", "-o", name + b".html", "--with", name, "--", name], where, (0,), name)
        check(os.path.getsize(at(b".html")) > 1000, "no page", name)
    look(where, name)
print(len(names), "names")
sys.exit(failed > 0)
END_OF_PYTHON
cat >"$dir/any.yaml" <<'END_OF_YAML'
se3d: 1
bodies: [{name: a, mass: 1, inertia: [1, 1, 1]}]
analysis: {type: dynamics, duration: 0.1, step: 0.05}
END_OF_YAML
expect 'a model' 0 "$program" run -q "$dir/any.yaml" -o "$dir"
expect 'a table of names' 0 python3 "$dir/names.py" "$dir"
cat "$dir/err" >&2

# Links, pipes and folders that stand where a tool writes or reads.
mkdir "$dir/planted"
cd "$dir/planted" || exit 1
echo mine >kept
plant() {
    for planted in "$@"; do
        ln -sf kept "$planted.partial"
        ln -sf kept "$planted"
    done
}
untouched() {
    holds 'a link was followed' [ "$(cat kept)" = mine ]
    for planted in "$@"; do
        holds "$planted is not a file of its own" [ -f "$planted" -a ! -L "$planted" ]
        holds "$planted.partial is left" [ ! -e "$planted.partial" -a ! -L "$planted.partial" ]
    done
}
printf 'time,a.position\n0,1\n1,2\n2,4\n' >a.csv
if command -v gnuplot >/dev/null 2>&1; then
    plant a.svg a.png a.gp a.fft.csv
    expect 'planted links of plot' 0 "$program" plot a.csv
    untouched a.svg a.png a.gp
    plant a.svg a.png a.gp
    expect 'planted links of plot --fft' 0 "$program" plot --fft a.csv
    untouched a.svg a.png a.gp a.fft.csv
    printf 'system("touch PWNED")\n' >.gnuplot
    expect 'settings in the folder' 0 env HOME="$PWD" "$program" plot a.csv
    holds 'settings of others were obeyed' [ ! -e PWNED ]
    printf 'time,a\rb.position\r,x\r\n0,1,2\n1,2,2\n2,4,1\n' >cr.csv
    expect 'a name that ends in CR' 0 "$program" plot --fft cr.csv
fi
cp "$dir/scene.glb" .
plant scene.html
expect 'planted links of view' 0 "$program" view .
untouched scene.html
plant results.csv scene.glb events.csv
expect 'planted links of run' 1 "$program" run "$dir/any.yaml" -o .
says 'a symbolic link leads out'
rm results.csv scene.glb events.csv
plant scene.glb
expect 'a planted scene' 0 "$program" run "$dir/any.yaml" -o .
untouched scene.glb results.csv
mkfifo pipe.csv
mkdir pipes
mkfifo pipes/a.csv
cp "$dir/scene.glb" pipes
expect 'a pipe is no results file' 1 timeout 10 "$program" plot pipe.csv
expect 'pipes beside a scene' 0 timeout 10 "$program" view pipes
rm pipes/scene.glb
mkfifo pipes/scene.glb
expect 'a pipe in the place of a scene' 1 timeout 10 "$program" view pipes

# three.js is not taken from where others can put it.
rm -rf "$dir/cache"
mkdir "$dir/cache"
chmod 777 "$dir/cache"
printf 'PWNED\n' >"$dir/cache/three.js"
printf 'three 0.187 uplot 1.6.32 %s\n' "$(cksum <"$source/tools/viewer/three_entry.js")" >"$dir/cache/three.stamp"
expect 'a folder that all may change' 1 "$program" view . -o page.html
says 'set SE3D_CACHE to a folder of your own'
holds 'a page of others' [ ! -e page.html ]
mkdir "$dir/bin"
printf '#!/bin/sh\nexit 3\n' >"$dir/bin/npm"
chmod +x "$dir/bin/npm"
printf 'THREE\n' >"$dir/other.js"
expect 'another three.js' 1 env SE3D_CACHE="$dir/own" SE3D_THREE="$dir/other.js" "$program" view . -o page.html
says 'was not made by'
printf '/* three 0.187 uplot 1.6.32 %s\n*/ THREE\n' "$(cksum <"$source/tools/viewer/three_entry.js")" >"$dir/three.min.js"
expect 'no home' 0 env -u HOME -u XDG_CACHE_HOME -u SE3D_CACHE SE3D_THREE="$dir/three.min.js" "$program" view . -o page.html
holds 'not the three.js asked for' grep -q '^\*/ THREE$' page.html
holds "left in the temporary folder: $(ls "$dir/tmp")" [ -z "$(ls "$dir/tmp")" ]
finish
