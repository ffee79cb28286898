# SPDX-License-Identifier: BSD-3-Clause
# What the program says of itself: help, guesses, `explain`, pages of the manual, completion.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"

commands='run check evaluate explain channels new plot sketch view live video study report import write fmu replay help completion'
expect 'overview' 0 "$program" help
cp "$dir/out" "$dir/overview"
expect 'the same by -h' 0 "$program" -h
is "$(cksum <"$dir/out")" "$(cksum <"$dir/overview")"
expect 'the version by -V' 0 "$program" -V
is "$(cut -d' ' -f1 "$dir/out")" se3d
for command in $commands; do
    has "$dir/overview" "  se3d $command "
    expect "help $command" 0 "$program" help "$command"
    cp "$dir/out" "$dir/help"
    has "$dir/out" 'Examples:'
    has "$dir/out" 'Exit code: 0 done'
    is "$(wc -L <"$dir/out" | awk '{ print ($1 <= 100) }')" 1
    expect "$command -h" 0 "$program" "$command" -h
    is "$(cksum <"$dir/out")" "$(cksum <"$dir/help")"
done
expect 'quiet before the command' 0 "$program" -q check "$models/pendulum.yaml"
is "$(cat "$dir/out")" ''
expect 'the version of a command' 0 "$program" plot -V
is "$(cut -d' ' -f1 "$dir/out")" se3d
expect 'help before the command' 0 "$program" --help -q run
has "$dir/out" 'se3d run MODEL'
expect 'options alone' 2 "$program" -q
says 'which command?'
expect 'an option of none' 2 "$program" --loud run
says 'unknown command `--loud`'
expect 'what options take' 0 "$program" help run
has "$dir/out" 'generalized_alpha'
has "$dir/out" 'inverse_dynamics'
expect 'a guess' 2 "$program" chekc model.yaml
says 'unknown command `chekc`; there are: run, check'
says 'did you mean `check`?'
expect 'help for a command that is not there' 2 "$program" help fly
says 'see `se3d help`'

expect 'objects' 0 "$program" explain
has "$dir/out" '  joint '
expect 'an object' 0 "$program" explain body
has "$dir/out" '  mass           number > 0'
expect 'a type' 0 "$program" explain revolute
has "$dir/out" '  axis           direction'
is "$(grep -c pitch "$dir/out")" 0
expect 'a key' 0 "$program" explain force.c
is "$(head -1 "$dir/out")" force.c
expect 'a key of several objects' 0 "$program" explain density
has "$dir/out" 'body.density'
has "$dir/out" 'material.density'
expect 'a wrong one' 2 "$program" explain revolut
says 'did you mean `revolute`?'
expect 'a wrong shell' 2 "$program" completion csh
says 'the shell is `csh`, must be bash, zsh or fish'
expect 'no shell' 2 "$program" completion
says 'which shell?'

# Every command and option stands in the page; roff finds nothing wrong with it.
expect 'se3d(1)' 0 "$program" help --man
cp "$dir/out" "$dir/se3d.1"
expect 'se3d-model(5)' 0 "$program" explain --man
cp "$dir/out" "$dir/se3d-model.5"
for command in $commands; do
    has "$dir/se3d.1" ".SS se3d $command"
done
has "$dir/se3d.1" '\-\-formulation'
has "$dir/se3d-model.5" '.SS contact'
if command -v groff >/dev/null 2>&1; then
    for page in se3d.1 se3d-model.5; do
        expect "$page in roff" 0 groff -man -Tutf8 -wall -z "$dir/$page"
        is "$(cat "$dir/err")" ''
    done
else
    echo 'SKIPPED: groff is not installed: the pages of the manual are not formatted' >&2
fi

# completes NAME EXPECTED WORD...: the words that bash offers for the last word
completes() {
    name=$1
    expected=$2
    shift 2
    is "$(bash -c '. "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _se3d; echo "${COMPREPLY[*]}"' \
        "$dir/se3d.bash" "$@")" "$expected"
}

if command -v bash >/dev/null 2>&1; then
    expect 'bash' 0 "$program" completion bash
    cp "$dir/out" "$dir/se3d.bash"
    completes 'commands' 'check' se3d che
    completes 'options' '--tolerance' se3d run --to
    completes 'methods' 'rk45 rk4' se3d run --method rk
    completes 'analyses' 'modes' se3d run --analysis mo
    completes 'commands for help' 'video' se3d help vid
    touch "$dir/car.yaml" "$dir/car.txt"
    completes 'models' "$dir/car.yaml" se3d run "$dir/ca"
fi
for shell in zsh fish; do
    expect "$shell" 0 "$program" completion "$shell"
    cp "$dir/out" "$dir/se3d.$shell"
    has "$dir/se3d.$shell" 'tolerance'
    if command -v "$shell" >/dev/null 2>&1; then
        expect "$shell reads it" 0 "$shell" -n "$dir/se3d.$shell"
        is "$(cat "$dir/err")" ''
    else
        echo "SKIPPED: $shell is not installed: it does not read its completion" >&2
    fi
done
finish
