# SPDX-License-Identifier: BSD-3-Clause
# se3d report: a page of models that were run, well-formed whatever names are, with nothing from elsewhere.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
expect 'no model' 2 "$program" report
expect 'no such option' 2 "$program" report --fast "$models/fourbar.yaml"
expect 'a missing value' 2 "$program" report "$models/fourbar.yaml" -o
expect 'a wrong model' 2 "$program" report "$dir/none.yaml"
expect 'standard input' 2 "$program" report -
says 'must be a file'

cat >"$dir/swing <b>&.yaml" <<'END'
se3d: 1
title: "<script>alert('1')</script> & \"swing\""
parameters: {L: 500 mm, bent: 2*a, a: "0.1", up: [0, 0, 1]}
bodies:
  - {name: "rod<i>&", from: [0, 0, 0], to: [L, 0, 0], radius: 10 mm, density: 7850}
joints:
  - {name: pin, type: revolute, body_i: ground, body_j: "rod<i>&", at: [0, 0, 0], axis: [0, 1, 0]}
analysis: {type: dynamics, duration: 0.2, step: 0.02}
output:
  - {file: "a b#.csv", channels: [pin.angle, pin.rate, "rod<i>&.position", pin.force]}
  - {file: snap.csv, every: 0.1, channels: [energy.total]}
END
expect 'hostile names' 0 "$program" report "$dir/swing <b>&.yaml" -o "$dir/page" --set "L=700 mm"
has "$dir/out" "wrote $dir/page/report.html"
cat >"$dir/look.py" <<'END'
import base64, html.parser, sys, xml.dom.minidom as xml
tags, pictures, text, links = [], [], [], []


class Look(html.parser.HTMLParser):
    def handle_starttag(self, tag, attrs):
        tags.append(tag)
        pictures.extend(dict(attrs)["src"] for _ in [0] if tag == "img")
        links.extend(dict(attrs)["href"] for _ in [0] if tag == "a")

    def handle_data(self, data):
        text.append(data)


Look().feed(open(sys.argv[1], encoding="utf-8").read())
for p in pictures:
    head, data = p.split(",")
    assert head == "data:image/svg+xml;base64", head
    xml.parseString(base64.b64decode(data, validate=True))
assert "script" not in tags and "b" not in tags and "i" not in tags, tags
assert all("//" not in link for link in links), links
print(len(pictures), tags.count("table"), links)
print("|".join(t.strip() for t in text if t.strip()))
END
if command -v python3 >/dev/null; then
    expect 'the page' 0 python3 "$dir/look.py" "$dir/page/report.html"
    is "$(sed -n 1p "$dir/out")" "6 3 ['./a%20b%23.csv', './snap.csv']"
    has "$dir/out" "|<script>alert('1')</script> & \"swing\"|"
    has "$dir/out" '|L|500 mm|0.7|bent|2*a|0.2|a|0.1|0.1|up|'
    has "$dir/out" "|pin.rate|rad/s|"
    has "$dir/out" "|pin.force.x|N|"
fi
has "$dir/page/report.html" 'Zero all the time: '
holds 'zeros in the table' sh -c '! grep -q "<td>0</td><td>0</td><td>0</td><td>0</td><td>0</td><td>0</td></tr>" "$1"' sh "$dir/page/report.html"
holds 'results beside the page' [ -s "$dir/page/a b#.csv" ]

# Two models: their results in folders of their own; kinematics over the first channel, with slopes.
cat >"$dir/turn.yaml" <<'END'
se3d: 1
bodies: [{name: rod, mass: 1, inertia: [1, 1, 1], position: [1, 0, 0]}]
joints: [{name: pin, type: revolute, body_i: ground, body_j: rod, at: [0, 0, 0], axis: [0, 1, 0]}]
drivers: [{name: drive, joint: pin, value: 0.1*t - 0.05}]
analysis: {type: kinematics, duration: 1, step: 0.1}
output: [{file: turn.csv, channels: [pin.angle, rod.position.z]}]
END
expect 'two models' 0 "$program" report -q "$dir/turn.yaml" "$models/fourbar_kinematics.yaml" -o "$dir/two"
is "$(cat "$dir/out")" ''
has "$dir/two/report.html" 'href="./turn/turn.csv"'
has "$dir/two/report.html" '<td>-0.99'
has "$dir/two/report.html" 'slope at 0'
holds 'results in folders' [ -s "$dir/two/turn/turn.csv" ]
expect 'another axis' 0 "$program" report -q "$dir/turn.yaml" -x time -o "$dir/time"
holds 'slopes over time' sh -c "! grep -q 'slope at 0' '$dir/time/report.html'"

# Models of one name keep their results apart.
mkdir "$dir/other"
sed 's/0.1\*t/0.2*t/' "$dir/turn.yaml" >"$dir/other/turn.yaml"
cp "$dir/turn.yaml" "$dir/other/turn-2.yaml"
expect 'one name' 0 "$program" report -q "$dir/turn.yaml" "$dir/other/turn.yaml" "$dir/other/turn-2.yaml" "$dir/turn.yaml" -o "$dir/same"
for row in 'turn 0.05' 'turn-2 0.15' 'turn-2-2 0.05' 'turn-3 0.05'; do
    set -- $row
    has "$dir/same/report.html" "href=\"./$1/turn.csv\""
    holds "$1 ends at $2" awk -F, -v to="$2" 'END { exit !(($2 - to)^2 < 1e-12) }' "$dir/same/$1/turn.csv"
done
expect 'an axis that nothing has' 2 "$program" report -q "$dir/turn.yaml" -x pin.angel -o "$dir/no-axis"
says 'no file of results has the channel of -x, `pin.angel`'
holds 'a page without its axis' [ ! -e "$dir/no-axis/report.html" ]
expect 'an axis of one of two' 0 "$program" report -q "$dir/turn.yaml" "$models/fourbar_kinematics.yaml" -x pin.angle -o "$dir/axis"

# Studies: a grid has lines, other samples have spots; what is there is not run again; failures are told.
cat >"$dir/grid.yaml" <<'END'
se3d: 1
parameters: {L: 1, up: 0.5}
bodies: [{name: rod, mass: 1, inertia: [1, 1, 1], position: [L, 0, up]}]
analysis: {type: assembly}
study:
  parameters: {L: [1, 2, 3], up: {from: 0, to: 1, count: 2}}
  measures: {far: {final: rod.position.x}, high: {final: rod.position.z}, root: sqrt(2.5 - far)}
END
expect 'a study with samples that fail' 0 "$program" report -q "$dir/grid.yaml" -o "$dir/grid" --jobs 2
is "$(grep -c '<img alt="far"\|<img alt="root"' "$dir/grid/report.html")" 4
has "$dir/grid/report.html" '<tr><td>far</td><td>6</td><td>2</td><td>0.894427</td><td>1</td><td>1</td><td>2</td>'
has "$dir/grid/report.html" '<tr><td>root</td><td>4</td>'
has "$dir/grid/report.html" '<tr><td>high</td><td>0.00</td><td>1.00</td></tr>'
before=$(ls -i "$dir/grid/study.csv")
expect 'the same study' 0 "$program" report -q "$dir/grid.yaml" -o "$dir/grid" -x up
is "$(ls -i "$dir/grid/study.csv")" "$before"
is "$(grep -c '<img alt="far"' "$dir/grid/report.html")" 1
expect 'another study' 1 "$program" report -q "$dir/grid.yaml" -o "$dir/grid" --set up=3
says 'is of another model, study or version of se3d'
cat >"$dir/draw.py" <<'END'
import base64, re, sys
page = open(sys.argv[1], encoding="utf-8").read()
drawings = [base64.b64decode(d).decode() for d in re.findall(r"svg\+xml;base64,([^\"]*)", page)]
print([(d.count('class="thick'), d.count('class="spot')) for d in drawings])
END
sed 's/count: 2/count: 8/' "$dir/grid.yaml" >"$dir/spots.yaml"
expect 'many lines' 0 "$program" report -q "$dir/spots.yaml" -o "$dir/spots"
expect 'a file alone' 0 "$program" report "$dir/grid/study.csv"
has "$dir/out" "wrote $dir/grid/report.html"
has "$dir/grid/report.html" 'href="./study.csv"'
if command -v python3 >/dev/null; then
    expect 'its curves' 0 python3 "$dir/draw.py" "$dir/grid/report.html"
    is "$(cat "$dir/out")" '[(4, 0), (6, 0), (4, 0), (6, 0), (4, 0), (5, 0)]'
    expect 'its spots' 0 python3 "$dir/draw.py" "$dir/spots/report.html"
    has "$dir/out" '(1, 24)'
fi
sed 's/^  parameters: {L: .*/  sensitivities: [L]/' "$dir/grid.yaml" >"$dir/slopes.yaml"
expect 'derivatives' 0 "$program" report -q "$dir/slopes.yaml" -o "$dir/slopes"
has "$dir/slopes/report.html" '<tr><td>far</td><td>L</td><td>1</td><td>1</td><td>1</td>'
printf 'nonsense' >"$dir/none.csv"
expect 'a file without rows' 1 "$program" report "$dir/none.csv"
says 'has no rows'

# What fails leaves no page.
sed 's/duration: 1,/duration: -1,/' "$dir/turn.yaml" >"$dir/bad.yaml"
expect 'a model that is wrong' 2 "$program" report "$dir/turn.yaml" "$dir/bad.yaml" -o "$dir/bad"
holds 'a page of a part' [ ! -e "$dir/bad/report.html" ]
sed '/^analysis/d' "$dir/turn.yaml" >"$dir/still.yaml"
expect 'nothing to run' 2 "$program" report "$dir/still.yaml" -o "$dir/bad"
says 'there is nothing to run'
expect 'a file in the way' 1 "$program" report "$dir/turn.yaml" -o "$dir/turn.yaml/x"
says 'cannot be written'
finish
