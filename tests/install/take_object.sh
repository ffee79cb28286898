# SPDX-License-Identifier: BSD-3-Clause
# take_object.sh COMPILER ARGUMENTS...: in place of a compiler. An object of the libraries that the build
# in $SE3D_BUILD_DIR has made of the same source, by the same words but for warnings, optimisation and
# debug information, is taken from there. What differs is compiled. Says which in $SE3D_TAKEN.
set -eu

# words COMMAND...: those that decide what a source means, sorted.
words() {
    skip=
    for word; do
        if [ -n "$skip" ]; then
            skip=
            continue
        fi
        case $word in
        -o | -c | -MT | -MF | -MQ) skip=yes ;;
        -MD | -W* | -O* | -g*) ;;
        *) echo "$word" ;;
        esac
    done | sort
}

object= from= file=
for word; do
    case $from in
    -o) object=$word ;;
    -c) file=$word ;;
    -MF) : >"$word" ;;
    esac
    from=$word
done
case $object in
*CMakeFiles/se3d*_objects.dir/*)
    case " $* " in
    *" -O0 "*) ;;
    *) echo "the project asked for -O0: $*" >&2 && exit 1 ;;
    esac
    made=$SE3D_BUILD_DIR/CMakeFiles/${object##*CMakeFiles/}
    theirs=$(grep -m 1 -F -- " -c $file\"" "$SE3D_BUILD_DIR/compile_commands.json") || theirs=
    theirs=${theirs#*\": \"*cc }
    theirs=${theirs%% -o *}
    if [ -f "$made" ] && [ "$(shift && words "$@")" = "$(eval "words $theirs")" ]; then
        cp "$made" "$object"
        echo "taken $file" >>"$SE3D_TAKEN"
        exit
    fi
    ;;
esac
echo "compiled $file" >>"$SE3D_TAKEN"
exec "$@"
