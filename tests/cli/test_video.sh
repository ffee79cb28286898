# SPDX-License-Identifier: BSD-3-Clause
# se3d video: messages, and films that ffprobe and the pixels approve of, where the tools are there.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
mkdir "$dir/tmp"
export SE3D_VIEWER="$source/tools/viewer" SE3D_CACHE="${SE3D_BUILD_DIR:-$dir}/viewer" TMPDIR="$dir/tmp"
nothing_left() {
    holds 'an unfinished film is left' [ ! -e "$1" -a ! -e "$1.partial" ]
    holds "left in the temporary folder: $(ls "$dir/tmp")" [ -z "$(ls "$dir/tmp")" ]
}
expect 'help' 0 "$program" video --help
expect 'no folder' 2 "$program" video
expect 'a speed of 0' 2 "$program" video "$dir" --speed 0
says 'the speed is `0`, must be a number > 0'
expect 'a speed in words' 2 "$program" video "$dir" --speed 2x
expect 'a view in words' 2 "$program" video "$dir" --view above
says 'the view is `above`, must be AZIMUTH,ELEVATION in degrees'
for caption in 'words' '1,0,backwards' '0,1,' 'nan,1,a' '0,inf,a'; do
    expect "a caption $caption" 2 "$program" video "$dir" --caption "$caption"
    says 'must be FROM,TO,TEXT'
done
expect 'hidden is something else' 2 "$program" video "$dir" --hide title,clock
says 'must be of title, time, plots'
expect 'hidden at length' 2 "$program" video "$dir" --hide "$(printf 'time,%.0s' $(seq 60))plots"
says 'must be of title, time, plots'
mkdir "$dir/bin"
printf '#!/bin/sh\nexit 3\n' >"$dir/bin/chromium"
chmod +x "$dir/bin/chromium"
expect 'no Chromium' 1 env PATH="$dir/none" SE3D_CHROMIUM= "$program" video "$dir"
says 'apt-get install --no-install-recommends chromium'
expect 'no ffmpeg' 1 env PATH="$dir/bin" SE3D_CHROMIUM= "$program" video "$dir"
says 'apt-get install --no-install-recommends ffmpeg'
for tool in chromium ffmpeg ffprobe python3; do
    command -v $tool >/dev/null 2>&1 || { echo "SKIPPED: no $tool: no film was made" >&2; finish; }
done
if ! command -v npm >/dev/null 2>&1; then
    echo 'SKIPPED: no npm: no film was made' >&2
    finish
fi
expect 'no scene' 1 "$program" video "$dir"
says 'scene.glb: cannot be read'
nothing_left "$dir/motion.mp4"
# From its largest deflection on one side (t = 0) to the other (t = pi / 8), as it swings four times as fast.
sed 's/cos(2\*t)/cos(8*t)/' "$source/examples/models/pendulum.yaml" >"$dir/pendulum.yaml"
"$program" run -q "$dir/pendulum.yaml" --duration pi/8 -o "$dir/run"
film=$dir/run/motion.mp4
expect 'a film' 0 "$program" video "$dir/run"
holds "no word of it in $(cat "$dir/out")" grep -qF "wrote $film: 12 pictures" "$dir/out"
ffprobe -v error -count_frames -of default=nw=1 -show_entries \
    stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames,duration "$film" >"$dir/probe"
for wanted in codec_name=h264 width=1280 height=720 pix_fmt=yuv420p r_frame_rate=30/1 nb_read_frames=12 duration=0.400; do
    holds "no $wanted in $(cat "$dir/probe")" grep -q "^$wanted" "$dir/probe"
done
for frame in 0 11; do
    ffmpeg -v error -i "$film" -vf "select=eq(n\\,$frame)" -frames:v 1 -f rawvideo -pix_fmt rgb24 "$dir/frame$frame"
done
cat >"$dir/look.py" <<'END_OF_PYTHON'
# Where the bar is: coloured pixels, in a picture of greys, away from the plot.
import sys
centers = []
for frame in ("0", "11"):
    data = open(sys.argv[1] + "/frame" + frame, "rb").read()
    assert len(data) == 1280 * 720 * 3
    xs, ys = [], []
    for y in range(60, 680):
        row = data[y * 3840:y * 3840 + 3840]
        for x in range(1280):
            r, b = row[3 * x], row[3 * x + 2]
            if b - r > 40 and not (x > 880 and y < 205):
                xs.append(x)
                ys.append(y)
    assert len(xs) > 600, ("the bar is not seen", frame, len(xs))
    assert max(ys) - min(ys) > 150, ("the bar is too short", min(ys), max(ys))
    centers.append(sum(xs) / len(xs))
# It hangs from the middle of the picture.
assert centers[0] > 640 + 30 and centers[1] < 640 - 30 or centers[0] < 640 - 30 and centers[1] > 640 + 30, centers
END_OF_PYTHON
name='the pictures'
holds 'do not show the bar on its two sides' python3 "$dir/look.py" "$dir"
nothing_left "$dir/none.mp4"
expect 'four times as fast' 0 "$program" video "$dir/run" -q --speed 4 --view 120,-20 -o "$dir/fast.mp4"
holds 'quiet, but it speaks' [ ! -s "$dir/out" ]
holds 'not 3 pictures' [ "$(ffprobe -v error -count_frames -of csv=p=0 -show_entries stream=nb_read_frames "$dir/fast.mp4")" = 3 ]
# Title, time, plots and captions are there by choice: rows of the picture with dark letters.
letters() {
    ffmpeg -v error -i "$1" -frames:v 1 -f rawvideo -pix_fmt gray "$dir/gray" -y
    python3 -c 'import sys
d, (x, y, w, h) = open(sys.argv[1], "rb").read(), map(int, sys.argv[2].split(","))
print(sum(d[1280 * (y + j) + x + i] < 110 for j in range(h) for i in range(w)))' "$dir/gray" "$2"
}
film() {
    expect "a film with $*" 0 "$program" video "$dir/run" -q --speed 10 --view 90,10 -o "$dir/words.mp4" "$@"
}
film --hide time,time,time,time,time,time,time,time,time,time,time,time,title,plots
for place in 10,10,400,28 10,690,200,28 890,10,380,160; do
    holds "letters at $place" [ "$(letters "$dir/words.mp4" $place)" -lt 20 ]
done
film --title "Tom's \"bar\" & <b>" --hide plots --caption '0,9,it \falls'"'"'s' --caption '5,6,later'
holds 'no title' [ "$(letters "$dir/words.mp4" 10,10,400,28)" -gt 60 ]
holds 'no caption' [ "$(letters "$dir/words.mp4" 500,655,280,40)" -gt 60 ]
holds 'a plot' [ "$(letters "$dir/words.mp4" 890,10,380,160)" -lt 20 ]
for ending in gif webp; do
    expect "a loop as $ending" 0 "$program" video "$dir/run" -q --speed 4 -o "$dir/loop.$ending"
done
[ "$(ffprobe -v error -of csv=p=0 -show_entries stream=codec_name,width,height "$dir/loop.gif" | tr -d '\n')" = gif,640,360 ] || fail "the loop is $(ffprobe -v error -of csv=p=0 -show_entries stream=codec_name,width,height "$dir/loop.gif")"
holds 'no loop in the WebP' grep -qa 'ANIM' "$dir/loop.webp"
expect 'too long' 1 "$program" video "$dir/run" --speed 1e-6 -o "$dir/long.mp4"
says 'more than an hour'
nothing_left "$dir/long.mp4"
expect 'a folder that is not there' 1 "$program" video "$dir/run" -o "$dir/none/film.mp4"
says 'cannot be written: No such file'
expect 'a full disk' 1 sh -c 'trap "" XFSZ; ulimit -f 100; exec "$@"' sh "$program" video "$dir/run" -o "$dir/full.mp4"
nothing_left "$dir/full.mp4"
expect 'a Chromium that ends at once' 1 env SE3D_CHROMIUM="$dir/bin/chromium" "$program" video "$dir/run" -o "$dir/dead.mp4"
says 'Chromium does not answer'
nothing_left "$dir/dead.mp4"
mkdir "$dir/viewer"
cp "$source"/tools/viewer/* "$dir/viewer"
echo 'throw new Error("broken on purpose");' >>"$dir/viewer/viewer.js"
sed -i 's/window.se3d = {/window.other = {/' "$dir/viewer/viewer.js"
expect 'a page with a problem' 1 env SE3D_VIEWER="$dir/viewer" "$program" video "$dir/run" -o "$dir/broken.mp4"
says 'broken on purpose'
nothing_left "$dir/broken.mp4"
name='an interrupt'
"$program" video "$dir/run" --speed 0.01 -o "$dir/stopped.mp4" 2>"$dir/err" &
for k in $(seq 100); do
    [ ! -e "$dir/stopped.mp4.partial" ] || break
    sleep 0.1
done
sleep 1
kill -TERM $!
wait $!
holds 'exit code of an interrupt' [ $? -eq 1 ]
says 'interrupted'
nothing_left "$dir/stopped.mp4"
finish
