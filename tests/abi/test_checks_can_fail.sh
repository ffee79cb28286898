#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The checks of the binary interface must find what they are there for: each is given a fault. All tools tell what
# they do.
set -u
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
failed=0
count=0

# reject NAME COMMAND...: the command must fail and its output name the fault.
reject() {
    word=$1
    shift
    count=$((count + 1))
    if "$@" >"$work/out" 2>&1; then
        echo "passed, but must fail on '$word': $*"
        failed=$((failed + 1))
    elif ! grep -q "$word" "$work/out"; then
        echo "'$word' is not named by: $*"
        cat "$work/out"
        failed=$((failed + 1))
    fi
}

mkdir -p "$work/include/se3d" "$work/lib/base" "$work/lib/math" "$work/lib/io" "$work/tools"
cp tools/*.py tools/*.sh "$work/tools/"
cp include/se3d/base.h "$work/include/se3d/"
baseline_suppressions=$PWD/tests/abi/growth.suppr
cd "$work" || exit 1
abi="python3 tools/check_abi.py"
cc=${CC:-cc}

# Every tool says what it does and does nothing.
touch out before
find . | sort >before
for tool in tools/*.py tools/*.sh; do
    run=sh
    [ "${tool%.py}" = "$tool" ] || run='python3 -B'
    [ "$tool" != tools/setup.sh ] || continue
    [ "$tool" != tools/math_tables.py ] || python3 -c 'import mpmath' 2>/dev/null || continue
    count=$((count + 1))
    if ! $run "$tool" --help >out 2>&1 || ! grep -q ' ' out; then
        echo "$tool --help fails:"
        cat out
        failed=$((failed + 1))
    fi
done
find . | sort | diff before - || failed=$((failed + 1))
rm before

printf '%s\n' 'static int counter;' 'int *se3di_count(void);' \
    'int *se3di_count(void) { counter++; return &counter; }' >lib/math/bad.c
printf '%s\n' '#include <stdio.h>' 'void se3di_say(void);' \
    'void se3di_say(void) { puts("x"); }' >lib/math/say.c
"$cc" -c lib/math/bad.c -o bad.o && "$cc" -c lib/math/say.c -o say.o && ar rc libse3d.a bad.o say.o
reject bss $abi globals libse3d.a
reject puts $abi calls libse3d.a
printf '%s\n' '#include <math.h>' 'double se3di_bend(double);' \
    'double se3di_bend(double x) { return sin(x); }' >lib/math/bend.c
"$cc" -c lib/math/bend.c -o bend.o && ar rc libse3d.a bend.o
reject sin $abi calls libse3d.a
printf '%s\n' 'void se3di_say(void);' 'void se3di_say(void) {}' >lib/io/say.c
"$cc" -c lib/io/say.c -o say_io.o && ar rc libse3d-io.a say_io.o
reject 'se3di_say (T) is defined by libse3d.a(say.o) and libse3d-io.a(say_io.o)' \
    $abi duplicates libse3d.a libse3d-io.a

$abi update >update.log || { cat update.log; exit 1; }
for name in se3d_status_get_text se3d_text_get_character se3d_version_get_text \
    se3d_version_number; do
    printf 'void %s(void);\nvoid %s(void) {}\n' $name $name >>public.c
done
"$cc" -shared -fPIC -Wl,-soname,libse3d.so -Wl,--version-script=lib/se3d.map public.c -o libse3d.so
count=$((count + 1))
$abi symbols libse3d.so || failed=$((failed + 1))
reject "SONAME libse3d.so," $abi soname libse3d.so
printf 'void se3d_extra(void);\nvoid se3d_extra(void) {}\n' >>public.c
"$cc" -shared -fPIC public.c -o libse3d.so
reject "se3d_extra: exported, but not declared" $abi symbols libse3d.so
printf '%s\n' '#include "se3d/base.h"' 'SE3D_API const char *' 'se3d_lost(int (*f)(int));' \
    'int se3d_plain(void);' 'typedef struct se3d_gap { char a; double b; } se3d_gap;' \
    >include/se3d/lost.h
reject "se3d_lost: declared, but not exported" $abi symbols libse3d.so
reject "se3d_lost: declared, but not in the symbol map" $abi symbols libse3d.so
reject "se3d_plain: declared without SE3D_API" $abi symbols libse3d.so
reject "padding struct" $abi padding

headers="python3 tools/check_headers.py"
reject "se3d_lost: no comment right before it" $headers
reject "lost.h:1: the head: no rule on threads" $headers
printf '%s\n' '#include "se3d/base.h"' 'se3d_status se3d_told_get(const int *o, double *v, double r[3])' \
    '{' '    r[0] = *v;' '    return o ? SE3D_ERR_STALE_HANDLE : SE3D_ERR_NULL;' '}' >lib/base/told.c
printf '%s\n' '/* Get it. Reader. @param[out] r  where. @return OK, NULL, NOT_FOUND, NO_MEMORY. */' \
    'SE3D_API se3d_status se3d_told_get(const int *o, double *v, double r[3]);' \
    'typedef struct se3d_span {' '    double width; /* of it */' '    int way;' '} se3d_span;' >include/se3d/told.h
reject 'se3d_span.width: no unit' $headers
reject 'se3d_span.way: no comment' $headers
reject 'nothing on the parameter `v`' $headers
reject 'no unit of the parameter `r`' $headers
reject 'no frame of the parameter `r`' $headers
reject 'se3d_told_get: no @since' $headers
reject 'thread word without its reason' $headers
reject 'NOT_FOUND: there is no such status' $headers
reject 'NO_MEMORY: the code never returns it' $headers
reject 'lacks STALE_HANDLE' $headers

printf '%s\n' '#include "math/vec3.h"' >lib/base/up.c
reject 'base/up.c' python3 tools/check_layers.py
mkdir -p lib/io/document lib/io/model lib/attic docs
printf '%s\n' '#include "base/alloc.h"' >lib/io/document/inner.c
reject 'io/document/inner.c' python3 tools/check_layers.py
printf '%s\n' '#include "io/model/model.h"' >lib/io/document/down.c
reject 'io/document/down.c.*comes after' python3 tools/check_layers.py
reject 'io/say.c: must stand in one of the folders' python3 tools/check_layers.py
reject 'lib/attic: in no list' python3 tools/check_layers.py
printf '%s\n' '#include "io/model/b.h"' >lib/io/model/a.h
printf '%s\n' '#include "io/model/a.h"' >lib/io/model/b.h
reject 'circle: io/model/a.h -> io/model/b.h -> io/model/a.h' python3 tools/check_layers.py
printf '%s\n' 'int se3di_to(int n)' '{' '    return se3di_fro(n);' '}' >lib/math/to.c
printf '%s\n' 'int se3di_fro(int n)' '{' '    return n > 0 ? se3di_to(n - 1) : 0;' '}' >lib/math/fro.c
printf '%s\n' 'int se3di_to(int n);' >lib/base/to.h
reject 'files call each other: math/fro math/to' python3 tools/check_layers.py
reject 'base/to.h: declares se3di_to, which math/to.c defines' python3 tools/check_layers.py
printf '%s\n' '| `math` | x |' '| `base` | y |' >docs/architecture.md
reject 'architecture.md lists math base, the tree has base math' python3 tools/check_layers.py

language="python3 tools/check_language.py"
printf '%s\n' '/* Where it is square' ' * to its axis, a = 0:' ' *' ' *     F = m (a +' ' * g)' ' */' >lib/math/prose.h
reject 'prose.h:1: `square to`' $language
reject 'prose.h:1: .*Where' $language
printf '%s\n' '/* A grain. */' 'const char *se3di_heap = "grain";' 'int se3di_grains;' >lib/math/words.h
reject 'words.h:1: `grain`: particle' $language
reject 'words.h:3: `grains`: particle' $language
reject 'prose.h:5: text right after a formula' $language
printf '%s\n' '/* The list is read; where it' ' * fails nothing has changed. Degenerate where a = b. */' >lib/math/cases.h
reject 'cases.h:1: `; where it`' $language
reject 'cases.h:2: `Degenerate where`' $language
printf '%s\n' 'int a;' "$(printf '<%.0s' 1 2 3 4 5 6 7) HEAD" >lib/math/both.h
reject 'both.h:2: the mark of a conflict' $language
printf '%0121d b\n| %0130d |\n' 0 0 >docs/wide.md
reject 'docs/wide.md:1: 123 columns' $language

{
    echo '/* SPDX-License-Identifier: BSD-3-Clause */'
    echo 'int long_one(int a)'
    echo '{'
    i=0
    while [ $i -lt 100 ]; do
        echo '    a++;'
        i=$((i + 1))
    done
    echo '    return a;'
    echo '}'
} >lib/math/long.c
reject 'long_one: lines' python3 tools/check_size.py
{
    echo '/* SPDX-License-Identifier: BSD-3-Clause */'
    echo 'int deep(int a, int b, int c, int d, int e, int f, int g, int h, int i)'
    echo '{'
    i=0
    while [ $i -lt 20 ]; do
        echo '    if (a) { b++; }'
        i=$((i + 1))
    done
    echo '    return a + b + c + d + e + f + g + h + i;'
    echo '}'
} >lib/math/deep.c
reject 'deep: complexity 21' python3 tools/check_size.py
reject 'deep: parameters 9' python3 tools/check_size.py
printf '/* SPDX-License-Identifier: BSD-3-Clause */\n/*%098d */\n' 0 >lib/math/wide.h
reject 'wide.h:2: 103 columns' python3 tools/check_size.py

{
    echo 'static int ask(int a, double *out)'
    echo '{'
    echo '    if (a < 0) { return -1; }'
    echo '    *out = *out > 1.0 ? 1.0 : 2.0;'
    echo '    return 0;'
    echo '}'
    echo 'double tell(int a);'
    echo 'double tell(int a)'
    echo '{'
    echo '    double out;'
    echo '    return ask(a, &out) < 0 ? 0.0 : out;'
    echo '}'
} >lib/math/unset.c
reject 'uninitialized' sh tools/check_uninitialised.sh lib/math/unset.c

# Growth at the end is fine for the baseline; another type, a member in between and what is gone are not.
if command -v abidiff >/dev/null; then
    mkdir -p tests/abi
    cp "$baseline_suppressions" tests/abi/growth.suppr
    mkdir -p include/se3d
    build() { # the text is a public header and the library at once
        cp growth.c include/se3d/growth.h
        echo '#include "include/se3d/growth.h"' >library.c
        $cc -g -shared -fPIC -o libgrowth.so library.c
    }
    old='typedef struct se3d_x { unsigned long struct_size; int a; } se3d_x;
int se3d_f(se3d_x *x, int k); int se3d_f(se3d_x *x, int k) { return x->a + k; }
int se3d_g(void); int se3d_g(void) { return 1; }'
    echo "$old" >growth.c
    build
    python3 tools/check_baseline.py write libgrowth.so >/dev/null
    echo "$old" | sed 's/int a;/int a; double b;/' >growth.c
    echo 'int se3d_h(void); int se3d_h(void) { return 2; }' >>growth.c
    build
    python3 tools/check_baseline.py compare libgrowth.so || failed=$((failed + 1))
    for change in 's/int k/double k/g' 's/int a;/double z; int a;/' 's/int se3d_g.*//'; do
        echo "$old" | sed "$change" >growth.c
        build
        reject 'libgrowth.so:' python3 tools/check_baseline.py compare libgrowth.so
    done
    $cc -shared -fPIC -o libplain.so library.c
    reject 'no debug information' python3 tools/check_baseline.py write libplain.so
fi

echo "$count checks, $failed failed"
[ "$failed" -eq 0 ]
