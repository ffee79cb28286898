#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Write the constants of lib/math/elementary_fast.inc and big.c (needs mpmath):

    python3 tools/math_tables.py lib/math/elementary_tables.h lib/math/big_tables.h

Each is the constant of its definition, rounded to nearest, or cut where the comment says so."""
import argparse

from mpmath import atan, floor, frexp, ldexp, ln, mp, mpf, nint, pi, sin

mp.prec = 2000

HEAD = "/* SPDX-License-Identifier: BSD-3-Clause */\n/* Written by tools/math_tables.py. %s */\n"


def cut(x, bits):
    """x to so many bits."""
    if x == 0:
        return mpf(0)
    mantissa, exponent = frexp(x)
    return ldexp(nint(ldexp(mantissa, bits)), exponent - bits)


def number(x):
    return float(x).hex() if x else "0.0"


def pair(x):
    high = cut(x, 53)
    low = cut(x - high, 53)
    return "{%s, %s}" % (number(high), number(low))


def table(name, comment, values):
    rows = ",\n    ".join(pair(v) for v in values)
    return "/* %s */\nstatic const double %s[%d][2] = {\n    %s};\n" % (comment, name, len(values), rows)


def parts(name, comment, x, bits):
    """Parts of so many bits, the last of 53."""
    out = []
    for b in bits + [53]:
        out.append(cut(x, b))
        x -= out[-1]
    return "/* %s */\nstatic const double %s[%d] = {%s};\n" % (
        comment, name, len(out), ", ".join(number(v) for v in out))


def inverse(j):
    """About 1 / m in the middle of [1 + j/128, 1 + (j + 1)/128), of 9 bits; exact at both ends."""
    if j in (0, 127):
        return mpf(1) if j == 0 else mpf(1) / 2
    return nint(512 / (1 + (mpf(j) + mpf(1) / 2) / 128)) / 512


def fast_tables():
    inverses = [inverse(j) for j in range(128)]
    # from sqrt(2) on m counts as half of it, with the exponent one higher
    logs = [-ln(r) - (ln(2) if j >= 53 else 0) for j, r in enumerate(inverses)]
    return "\n".join([
        HEAD % "Pairs are high and low part.",
        table("exp_table", "2^(i/128)", [mpf(2)**(mpf(i) / 128) for i in range(128)]),
        parts("ln2_128", "ln 2 / 128: the first two exact times 18 bits", ln(2) / 128, [33, 33]),
        "static const double rate_exp = %s; /* 128 / ln 2 */\n" % number(cut(128 / ln(2), 53)),
        "/* about 1/m, m = 1 + (j + 1/2)/128 */\nstatic const double log_inverse[128] = {\n    %s};\n"
        % ",\n    ".join(number(r) for r in inverses),
        table("log_table", "-log of it; from j = 53 on of twice it", logs),
        parts("ln2", "the first exact times 11 bits", ln(2), [42]),
        "static const double rate_log10[2] = %s; /* 1 / ln 10 */\n" % pair(1 / ln(10)),
        table("sin_table", "sin(i pi / 128)", [sin(pi * i / 128) for i in range(65)]),
        parts("pi_128", "pi / 128: the first two exact times 23 bits", pi / 128, [30, 30, 53]),
        "static const double rate_sin = %s; /* 128 / pi */\n" % number(cut(128 / pi, 53)),
        table("atan_table", "atan(j/64)", [atan(mpf(j) / 64) for j in range(65)]),
        "static const double pi_pair[2] = %s;\n" % pair(pi),
        "static const double half_pi_pair[2] = %s;\n" % pair(pi / 2),
        "static const double third[2] = %s;\n" % pair(mpf(1) / 3),
        "static const double sixth[2] = %s;\n" % pair(mpf(1) / 6),
    ])


def limbs(x, count):
    """The first 32 count bits behind the point, most significant first."""
    whole = int(floor(ldexp(x, 32 * count)))
    return [(whole >> (32 * (count - 1 - k))) & 0xFFFFFFFF for k in range(count)]


def limb_array(name, comment, x, count):
    words = ["UINT32_C(0x%08x)" % v for v in limbs(x, count)]
    rows = ",\n    ".join(", ".join(words[k:k + 4]) for k in range(0, count, 4))
    return "/* %s */\nstatic const uint32_t %s[%d] = {\n    %s};\n" % (comment, name, count, rows)


def big_tables():
    return "\n".join([
        HEAD % "Most significant word first.",
        "#include <stdint.h>\n",
        limb_array("ln2_words", "ln 2", ln(2), 12),
        limb_array("quarter_pi_words", "pi / 4", pi / 4, 12),
        limb_array("two_over_pi", "2 / pi: its first 1664 bits", 2 / pi, 52),
    ])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("fast", help="lib/math/elementary_tables.h")
    parser.add_argument("big", help="lib/math/big_tables.h")
    o = parser.parse_args()
    with open(o.fast, "w", encoding="ascii") as out:
        out.write(fast_tables())
    with open(o.big, "w", encoding="ascii") as out:
        out.write(big_tables())


if __name__ == "__main__":
    main()
