# SPDX-License-Identifier: BSD-3-Clause
# Whoever starts the program may have closed its standard streams: files that it opens do not take
# their places, so that no message gets into results.
. tests/support/cli.sh

cp "$models/pendulum.yaml" "$dir/m.yaml"
expect "all open" 0 "$program" run "$dir/m.yaml" -o "$dir/good"

# alike NAME: the results are those of the run with all streams open
alike() {
    for file in "$dir/good"/*.csv; do
        holds "$1: $(basename "$file") differs" cmp -s "$file" "$dir/$1/$(basename "$file")"
    done
    holds "$1: a file is left over" [ -z "$(find "$dir/$1" -name '*.partial*')" ]
}

(exec <&- && exec "$program" run "$dir/m.yaml" -o "$dir/in") >"$dir/out" 2>"$dir/err"
is "$?" 0
alike in
(exec 2>&- && exec "$program" run "$dir/m.yaml" -o "$dir/err-closed") >"$dir/out"
is "$?" 0
alike err-closed
(exec >&- && exec "$program" run "$dir/m.yaml" -o "$dir/out-closed") 2>"$dir/err"
is "$?" 1
says "standard output cannot be written"
alike out-closed
(exec <&- >&- 2>&- && exec "$program" run "$dir/m.yaml" -o "$dir/none")
is "$?" 1
alike none
finish
