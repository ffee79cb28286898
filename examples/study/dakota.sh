#!/bin/sh
# Between Dakota and se3d: sh dakota.sh PARAMETERS RESULTS. Each variable of the file of parameters is a parameter of
# the model, each response a measure of its study. A run that fails tells Dakota so.
set -eu
request=$(awk '
    NF == 2 && $2 == "variables" { variables = $1; next }
    variables > 0 { list = list (list ? ", " : "") "\"" $2 "\": " $1 + 0; --variables }
    END { printf "{\"id\": 0, \"parameters\": {%s}}\n", list }' CONVFMT=%.17g OFMT=%.17g "$1")
wanted=$(sed -n 's/^ *[0-9]* ASV_[0-9]*:\([A-Za-z0-9_]*\).*/\1/p' "$1")
reply=$(printf '%s\n' "$request" | "${SE3D:-se3d}" study "${MODEL:-damper.yaml}" --server)
lines=
for name in $wanted; do
    value=$(printf '%s\n' "$reply" | sed -n "s/.*\"$name\": \([-+0-9.eE]*\)[,}].*/\1/p")
    if [ -z "$value" ]; then
        echo "$reply" >&2
        lines='FAIL
'
        break
    fi
    lines="$lines$value $name
"
done
printf '%s' "$lines" >"$2"
