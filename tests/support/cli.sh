# SPDX-License-Identifier: BSD-3-Clause
# What the tests of the program share: paths, a folder that goes away, checks. Sourced.
program=${SE3D_PROGRAM:?the path of the se3d program}
case $program in /*) ;; *) program=$PWD/$program ;; esac
source=${SE3D_SOURCE_DIR:-.}
models=$source/examples/models
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
failures=0
checks=0
name=$0

fail() {
    echo "$name: $1" >&2
    failures=$((failures + 1))
}

# holds TEXT COMMAND...: the command succeeds
holds() {
    text=$1
    shift
    checks=$((checks + 1))
    "$@" || fail "$text"
}

# expect NAME CODE COMMAND...: run, keep the output in $dir/out and $dir/err
expect() {
    name=$1
    code=$2
    shift 2
    "$@" >"$dir/out" 2>"$dir/err"
    actual=$?
    holds "exit code $actual, expected $code: $(head -3 "$dir/err")" [ $actual -eq "$code" ]
}

# has FILE TEXT: the file contains the text
has() {
    holds "\`$2\` not found in $1: $(head -3 "$1")" grep -qF -e "$2" "$1"
}

says() {
    has "$dir/err" "$1"
}

is() {
    holds "\`$1\`, expected \`$2\`" [ "$1" = "$2" ]
}

# The end of a test.
finish() {
    echo "$checks checks, $failures failed"
    [ $failures -eq 0 ]
    exit
}
