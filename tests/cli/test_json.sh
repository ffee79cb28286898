# SPDX-License-Identifier: BSD-3-Clause
# --json of every command is one object, also if it fails; `-` is standard input or output; colours
# are for terminals.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
command -v python3 >/dev/null 2>&1 || exit 77

model=$models/pendulum.yaml
cd "$dir" || exit 1

# json NAME CODE EXPRESSION WORD...: the object `d` on standard output makes the expression true
json() {
    name=$1
    code=$2
    truth=$3
    shift 3
    expect "$name" "$code" "$program" "$@"
    holds "$truth is not true of: $(head -c 300 "$dir/out")" python3 -c '
import json, sys
d = json.load(open(sys.argv[1]))
sys.exit(not eval(sys.argv[2]))' "$dir/out" "$truth"
}

json run 0 'd["status"] == "done" and d["files"]' run "$model" -o results --json
json check 0 'd["freedoms"] == 0' check "$model" --json
json 'check of particles' 0 'd["particles"][0]["count"] > 10 and d["particles"][0]["step"] == d["particles"][0]["automatic_step"] > 0 and d["steps"] > 100 and d["seconds"] > 0 and d["first_steps"] == ""' \
    check "$models/chute.yaml" --json
json channels 0 'len(d["channels"]) > 10' channels "$model" --json
json evaluate 0 'd["status"] == "done" and d["equations"][0]["equation"] == "cd_x" and d["equations"][-1]["bodies"][0]["phi_pi"] is None' evaluate "$model" --json
json explain 0 'd["found"][0]["keys"][0]["key"] == "mass"' explain body.mass --json
json 'all of explain' 0 'len(d["found"]) > 20' explain --json
json 'an unknown name' 2 'd["status"] == "error" and "is called `zzz`" in d["message"]' explain --json zzz
for command in help explain; do
    json "$command --man" 2 '"for --man or for --json, not for both" in d["message"]' "$command" --man --json
done
json help 0 'd["commands"][0]["options"][-1]["name"] == "--help"' help run --json
json 'all of help' 0 'len(d["commands"]) >= 20' --json help
json new 0 'd["files"] == ["new.yaml"]' new new.yaml --json
json 'new again' 1 'd["status"] == "error" and "new.yaml: is there" in d["message"]' \
    new new.yaml --json
json fmt 0 'd["files"] == []' fmt new.yaml --json
printf 'se3d:   1\n' >wide.yaml
json 'fmt that would change' 1 '"layout would change" in d["message"]' fmt wide.yaml --check --json
json 'fmt that changes' 0 'd["files"] == ["wide.yaml"]' fmt wide.yaml --json
json write 0 'd["files"] == ["whole.yaml"]' write "$model" -o whole.yaml --json
json sketch 0 'd["files"] == ["s.svg"]' sketch "$model" -o s.svg --json
json 'two things for one output' 2 '"standard output is for one of the two" in d["message"]' \
    write "$model" --json
cat >warned.yaml <<'END'
se3d: 1
parameters: {unused: 1}
bodies: [{name: ball, mass: 1, inertia: [1, 1, 1], position: [0, 0, 0]}]
analysis: {type: dynamics, duration: 0.01}
END
json 'a warning' 0 'd["status"] == "done" and d["message"] == "" and d["warnings"]' check warned.yaml --json
json 'a strict check' 1 'd["status"] == "failed" and "--strict: 2 warnings, must be none" in d["message"]' \
    check --strict warned.yaml --json
printf 'se3d: 1\nbodys: []\n' >wrong.yaml
json 'a mistake' 2 'd["mistakes"][0]["line"] == 2' view wrong.yaml --json
json 'an option' 2 '"unknown option `--loud`" in d["message"]' plot --json --loud
json 'an option before' 2 '"unknown option `--bogus`" in d["message"]' explain --bogus --json
json 'two operands' 2 '"unexpected argument `b`" in d["message"]' run m.yaml -o a b --json
json 'two operands, lines' 2 '"unexpected argument `b`" in d["message"]' run m.yaml -o a b --json-lines
json 'no command' 2 '"which command?" in d["message"]' --json
json 'no such option' 2 '"unknown command `--bogus`" in d["message"]' --bogus --json
json completion 2 '"unknown option `--json`" in d["message"]' completion bash --json
expect 'a file of that name' 2 "$program" check -- one --json
holds 'JSON that nobody asked for' [ ! -s "$dir/out" ]
json 'a command' 2 '"did you mean `check`?" in d["message"]' chekc --json
json 'a file' 1 'd["command"] == "plot" and "missing.csv" in d["message"]' plot missing.csv --json
json study 2 '"no `study`" in d["message"]' study "$model" --json
json fmu 2 '"must be a file" in d["message"]' fmu - --json
json report 2 '"nothing to run" in d["message"]' report wide.yaml --json

# Standard input and output.
sed 's/^title:.*/title: from a pipe/' "$model" >pipe.yaml
for words in 'check -' 'channels -' 'evaluate --csv -' 'fmt -' 'write -' 'sketch -' 'run -o piped -'; do
    # shellcheck disable=SC2086
    expect "$words" 0 sh -c '"$0" "$@" <pipe.yaml' "$program" $words
done
holds 'results of a pipe' [ -s piped/pendulum.csv ]
expect 'new to a pipe' 0 sh -c '"$0" new - | "$0" check -' "$program"
has "$dir/out" '1 degree of freedom'
cat >study.yaml <<'END'
se3d: 1
parameters: {m: 1}
bodies:
  - {name: ball, mass: m, inertia: [1, 1, 1], position: [0, 0, 0]}
analysis: {type: dynamics, duration: 0.01}
study:
  parameters: {m: [1, 2, 3]}
  measures: {energy: {final: energy.total}}
END
if "$program" check study.yaml >/dev/null 2>&1; then
    expect 'a study of a pipe' 0 sh -c '"$0" study - -o studied <study.yaml' "$program"
    is "$(grep -c ',ok$' studied/study.csv)" 3
else
    fail "the model of the study is wrong: $("$program" check study.yaml 2>&1)"
fi
expect 'requests and a model' 2 "$program" study - --server
says 'standard input is for the requests'

# Colours: on a terminal, unless NO_COLOR is set; never in a file.
cat >terminal.py <<'END'
import os, pty, sys
def read(fd):
    try:
        return os.read(fd, 4096)
    except OSError:
        return b""
pty.spawn(sys.argv[1:], read)
END
escape=$(printf '\033[')
if python3 -c 'import pty; pty.openpty()' 2>/dev/null; then
    TERM=xterm NO_COLOR='' expect 'a terminal' 0 python3 terminal.py "$program" check wrong.yaml
    has "$dir/out" "${escape}1;31mwrong.yaml:2:1${escape}0m: "
    TERM=xterm NO_COLOR=1 expect 'a terminal without' 0 python3 terminal.py "$program" check wrong.yaml
    holds 'colours although NO_COLOR is set' sh -c '! grep -qF "$1" "$2"' sh "$escape" "$dir/out"
    has "$dir/out" 'wrong.yaml:2:1: '
    for kind in -uTERM TERM= TERM=dumb; do
        expect "a terminal, $kind" 0 env -uNO_COLOR "$kind" python3 terminal.py "$program" check wrong.yaml
        holds 'colours on a terminal that may have none' sh -c '! grep -qF "$1" "$2"' sh "$escape" "$dir/out"
    done
else
    echo 'SKIPPED: no terminals here: colours were not looked at' >&2
fi
TERM=xterm NO_COLOR='' expect 'a file' 2 "$program" check wrong.yaml
holds 'colours in a file' sh -c '! grep -qF "$1" "$2"' sh "$escape" "$dir/err"
finish
