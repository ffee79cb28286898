# SPDX-License-Identifier: BSD-3-Clause
# se3d plot: pictures, units, messages. Run with SE3D_PROGRAM and SE3D_SOURCE_DIR set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"

expect 'help' 0 "$program" plot --help
expect 'no file' 2 "$program" plot
expect 'unknown option' 2 "$program" plot --wings a.csv
expect '-y without a value' 2 "$program" plot a.csv -y
expect 'missing file' 1 "$program" plot "$dir/none.csv"
has "$dir/err" "$dir/none.csv: No such file"
printf 'time,bar.position.x\n' >"$dir/empty.csv"
expect 'no rows' 1 "$program" plot "$dir/empty.csv"
has "$dir/err" 'has no rows'
: >"$dir/nothing.csv"
expect 'no header' 1 "$program" plot "$dir/nothing.csv"
has "$dir/err" 'is empty'
printf 'time,a.position\n0,1\n' >"$dir/a.csv"
expect 'missing tool' 1 env PATH="$dir" "$program" plot "$dir/a.csv"
has "$dir/err" 'apt-get install --no-install-recommends gnuplot-nox'
expect 'unknown channel' 2 "$program" plot "$dir/a.csv" -y a.velocity
has "$dir/err" 'has no channel `a.velocity`, it has: time, a.position'

if ! command -v gnuplot >/dev/null 2>&1; then
    echo "SKIPPED: gnuplot is not installed (apt-get install gnuplot-nox): no picture was tested" >&2
    finish
fi

for model in pendulum spatial_slider_crank tsda_mass; do
    "$program" run -q "$models/$model.yaml" -o "$dir" --duration 1
    expect "$model" 0 "$program" plot "$dir/$model.csv"
    has "$dir/out" "wrote $dir/$model.svg"
    has "$dir/$model.svg" '</svg>'
    has "$dir/$model.svg" 'time [s]'
    has "$dir/$model.svg" 'position [m]'
    has "$dir/$model.svg" 'velocity [m/s]'
    has "$dir/$model.svg" 'acceleration [m/s^2]'
    has "$dir/$model.png" 'PNG'
    [ ! -s "$dir/err" ] || [ $model = spatial_slider_crank ] || fail "$(cat "$dir/err")"
    (cd "$dir" && rm "$model.svg" && gnuplot "$model.gp") || fail 'the script does not run by itself'
    has "$dir/$model.svg" '</svg>'
done
has "$dir/pendulum.svg" 'force [N]' # the title of an axis, from the script as it was kept
! ls "$dir"/*.partial 2>/dev/null || fail 'something is left'

expect 'phase plot' 0 "$program" plot "$dir/tsda_mass.csv" -x block.position.x -y block.velocity.x -o "$dir/phase.png"
has "$dir/phase.svg" 'block.position.x [m]'
cp "$dir/tsda_mass.csv" "$dir/other.csv"
expect 'compare files' 0 "$program" plot "$dir/tsda_mass.csv" "$dir/other.csv" -y block.position.x -o "$dir/two.svg"
for text in other tsda_mass 'block: position [m]'; do
    has "$dir/two.svg" "$text"
done
! grep -q 'block.position.x' "$dir/two.svg" || fail 'the name of the channel is repeated'

# What two runs differ by, as far as both go; other times, other channels and other options are refused.
awk 'BEGIN { print "time,a.position.x,a.position.y"; for (k = 0; k < 9; ++k) print k / 10 "," k * k "," 5 }' >"$dir/one.csv"
awk 'BEGIN { print "time,a.position.y,a.position.x"; for (k = 0; k < 7; ++k) print k / 10 "," 5 - k "," k * k + 0.25 }' >"$dir/second.csv"
expect 'a difference' 0 "$program" plot "$dir/one.csv" "$dir/second.csv" --difference -o "$dir/apart.svg"
has "$dir/apart.svg" 'difference of position'
awk -F, 'NR == 1 { if ($0 != "time,a.position.x,a.position.y") exit 1 } NR > 1 && ($1 != (NR - 2) / 10 || $2 != 0.25 || $3 != 2 - NR) { exit 1 }
    END { if (NR != 8) exit 1 }' "$dir/apart.difference.csv" || fail 'the second less the first'
sed 's/^0.3,/0.31,/' "$dir/second.csv" >"$dir/third.csv"
expect 'rows at other times' 1 "$program" plot "$dir/one.csv" "$dir/third.csv" --difference -o "$dir/none.svg"
has "$dir/err" 'third.csv has rows at other times than'
expect 'a channel that one lacks' 1 "$program" plot "$dir/one.csv" "$dir/a.csv" --difference -o "$dir/none.svg"
has "$dir/err" 'a.csv has no channel a.position.x'
[ ! -e "$dir/none.svg" ] || fail 'it is drawn'
expect 'a difference of one' 2 "$program" plot "$dir/one.csv" --difference
expect 'a difference over something else' 2 "$program" plot "$dir/one.csv" "$dir/second.csv" --difference -x a.position.x

# Kinematics of a suspension over the travel of its wheel, with units.
awk 'BEGIN { print "time,hub.travel,hub.toe,tyre.fz"; for (k = 0; k < 9; ++k) print k "," k / 100 "," k / 1000 "," 10 * k }' >"$dir/bump.csv"
expect 'toe over travel' 0 "$program" plot "$dir/bump.csv" -x hub.travel -y hub.toe -y tyre.fz
for text in 'hub.travel [m]' 'toe [rad]' 'fz [N]'; do
    has "$dir/bump.svg" "$text"
done

# Transfer functions are drawn as Bode plots: 1 / (1 + s / 10)^3, whose phase goes on to -270 degrees.
python3 - "$dir/modes_transfer.csv" <<'END_OF_PYTHON'
import math, sys
with open(sys.argv[1], "w") as file:
    file.write("frequency,output1/input1.real,output1/input1.imag\n")
    for k in range(200):
        f = 0.01 * 10 ** (k / 40)
        g = 1 / (1 + 2j * math.pi * f / 10) ** 3
        file.write(f"{f!r},{g.real!r},{g.imag!r}\n")
END_OF_PYTHON
expect 'a Bode plot' 0 "$program" plot "$dir/modes_transfer.csv"
for text in 'gain [dB]' 'phase [degree]' 'frequency [Hz]'; do
    has "$dir/modes_transfer.svg" "$text"
done
has "$dir/modes_transfer.gp" 'set logscale x'
awk -F, 'NR == 1 { head = $0 } NR > 1 { f = $1; g = -30 * log(1 + (0.2 * 3.14159265358979 * f) ^ 2) / log(10); p = -3 * atan2(0.2 * 3.14159265358979 * f, 1) * 180 / 3.14159265358979
    if ($2 - g > 1e-5 || g - $2 > 1e-5 || $3 - p > 1e-5 || p - $3 > 1e-5) bad = bad " " f }
    END { exit head != "frequency,output1/input1.gain,output1/input1.phase" || bad != "" || NR != 201 }' "$dir/modes_transfer.bode.csv" || fail 'gains and phases'
expect 'as it is' 0 "$program" plot "$dir/modes_transfer.csv" -y output1/input1.real -o "$dir/real.svg"
! grep -q 'gain' "$dir/real.svg" || fail 'a column that was named is another one'
expect 'spectra of transfer functions' 0 "$program" plot "$dir/modes_transfer.csv" --fft -o "$dir/both.svg"
has "$dir/both.fft.csv" 'frequency,output1/input1.real'
[ ! -e "$dir/both.bode.csv" ] || fail 'gains and phases beside spectra'
! grep -q 'gain \[dB\]' "$dir/both.svg" || fail 'gains of spectra'

# Rounding is left out, with a word, but for what was named in full; short names, and one frame as wide as another.
awk 'BEGIN { print "time,a.position.x,a.position.y,a.position.z,b.position.x"; for (k = 0; k < 50; ++k) print k ",1e-22," k "," 2 * k ",3" }' >"$dir/near.csv"
expect 'rounding' 0 "$program" plot "$dir/near.csv"
has "$dir/out" 'left out, zero: a.position.x'
for text in 'a y' 'a z' 'b x' 'position [m]'; do
    has "$dir/near.svg" ">$text<"
done
! grep -qF '>a x<' "$dir/near.svg" || fail 'what is rounding is drawn'
expect 'rounding on demand' 0 "$program" plot "$dir/near.csv" -y a.position.x -y a.position.y
! grep -q 'left out' "$dir/out" || fail 'what was asked for is left out'
has "$dir/near.svg" '>a: position [m]<'
has "$dir/near.svg" '>x<'

# Figures of papers: as wide as asked for.
expect 'a width in words' 2 "$program" plot "$dir/near.csv" --width wide
has "$dir/err" 'the width is `wide`, must be 30mm to 1000mm'
expect 'a width of a mile' 2 "$program" plot "$dir/near.csv" --width 1609344mm
expect 'a style' 2 "$program" plot "$dir/near.csv" --style cubist
has "$dir/err" 'the style is `cubist`, must be screen or paper'
expect 'no style' 2 "$program" plot "$dir/near.csv" --style
expect 'paper' 0 "$program" plot "$dir/near.csv" --style paper --width 85mm -o "$dir/paper.pdf"
has "$dir/out" "wrote $dir/paper.pdf"
[ "$(head -c 5 "$dir/paper.pdf")" = '%PDF-' ] || fail 'no PDF'
has "$dir/paper.svg" 'width="321"'
[ "$(od -An -tu1 -j16 -N4 "$dir/paper.png" | awk '{ print $1 * 16777216 + $2 * 65536 + $3 * 256 + $4 }')" = 1004 ] || fail 'the PNG has no 300 points in an inch'

# A sine of amplitude 3 at 5 Hz has a peak of 3 at 5 Hz.
awk 'BEGIN { print "time,a.position"; for (k = 0; k <= 2000; ++k) printf "%.17g,%.17g\n", k / 100, 1 + 3 * sin(2 * 3.14159265358979 * 5 * k / 100) }' >"$dir/sine.csv"
expect 'spectrum' 0 "$program" plot "$dir/sine.csv" --fft -o "$dir/spectrum"
has "$dir/spectrum.svg" 'frequency [Hz]'
awk -F, 'NR > 1 && $2 > m { m = $2; f = $1 } END { exit !(f > 4.95 && f < 5.05 && m > 2.9 && m < 3.02) }' "$dir/spectrum.fft.csv" ||
    fail 'the peak of a sine is at the wrong place'
awk 'BEGIN { print "time,a.position"; for (k = 0; k < 1000000; ++k) print k / 1000 "," k % 100 }' >"$dir/long.csv"
expect 'a million rows' 0 "$program" plot "$dir/long.csv"
[ "$(wc -c <"$dir/long.svg")" -lt 1000000 ] || fail 'the picture is too large'
expect 'a folder that cannot be written' 1 "$program" plot "$dir/a.csv" -o "$dir/none/a.svg"
has "$dir/err" 'cannot be written'
expect 'a full disk' 1 sh -c 'trap "" XFSZ; ulimit -f 4; exec "$@"' sh "$program" plot "$dir/pendulum.csv" -o "$dir/full"
[ ! -e "$dir/full.svg" ] && [ ! -e "$dir/full.svg.partial" ] || fail 'a broken picture is left'

finish
