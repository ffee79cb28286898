/* SPDX-License-Identifier: BSD-3-Clause */
/* The elementary functions: each the double nearest to the exact value. A table of hard arguments
 * (their values from mpmath with 2600 bits), the special cases of C11, the two phases against each
 * other on random arguments, and all against MPFR where it is installed. */
#include <stdlib.h>

#include "check.h"
#include "math/elementary.h"
#include "math/elementary_fast.h"
#include "math/quick.h"

#if defined(SE3D_HAS_MPFR)
#include <mpfr.h>
#endif

#define INF HUGE_VAL

typedef double (*unary)(double);
typedef double (*binary)(double, double);

static int same(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

static void check_same(const char *name, double x, double y, double actual, double expected)
{
    if (!same(actual, expected)) {
        fprintf(stderr, "%s(%a, %a) is %a, expected %a\n", name, x, y, actual, expected);
    }
    CHECK(same(actual, expected));
}

/* ---- hard cases ---- */

static const struct {
    const char *name;
    unary f;
    double x, value;
} hard[] = {
    {"exp", se3di_exp, 0x1.9e9cbbfd6080bp-31, 0x1.000000033d398p+0},
    {"exp", se3di_exp, -0x1.3475ac05cebf4p-12, 0x1.ffd972be214dfp-1},
    {"exp", se3di_exp, 0x1.4091aea0d4c5ap+1, 0x1.8793abd67d9f1p+3},
    {"exp", se3di_exp, 0x1.83d4bcdebb3f4p+2, 0x1.ac50b409c8aeep+8},
    {"exp", se3di_exp, 0x1.6a119d3fee829p+5, 0x1.39f1680220213p+65},
    {"exp", se3di_exp, -0x1.1ffffffffdc60p-12, 0x1.ffdc0143f8687p-1},
    {"exp", se3di_exp, 0x1.62e42fefa39efp+9, 0x1.fffffffffff2ap+1023},
    {"exp", se3di_exp, -0x1.6232bdd7abcd2p+9, 0x1.000000000007cp-1022},
    {"exp", se3di_exp, -0x1.74910d52d3051p+9, 0x0.0000000000001p-1022},
    {"log", se3di_log, 0x1.ed81fe7d2ff4ep-3, -0x1.6c4efe4e2dbc7p+0},
    {"log", se3di_log, 0x1.0ffea3878db6bp+0, 0x1.f07a0cca521efp-5},
    {"log", se3di_log, 0x1.1211bef8f68e9p+175, 0x1.e579d0b5544d5p+6},
    {"log", se3di_log, 0x1.5f402b96ebbdep-14, -0x1.2c6859397c577p+3},
    {"log", se3di_log, 0x1.fffffffffffffp-1, -0x1.0p-53},
    {"log", se3di_log, 0x1.0000000000001p+0, 0x1.fffffffffffffp-53},
    {"log", se3di_log, 0x0.0000000000001p-1022, -0x1.74385446d71c3p+9},
    {"log", se3di_log, 0x1.0p+1023, 0x1.628b76e3a7b61p+9},
    {"sin", se3di_sin, 0x1.e0000000001c2p-20, 0x1.dfffffffff02ep-20},
    {"sin", se3di_sin, 0x1.598bae9e632f6p-7, 0x1.598a0aea48996p-7},
    {"sin", se3di_sin, 0x1.9bcc3f8a7a9a9p+2, 0x1.3463d88186b6cp-3},
    {"sin", se3di_sin, 0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53},
    {"sin", se3di_sin, 0x1.6ac5b262ca1ffp+849, 0x1.0p+0},
    {"sin", se3di_sin, 0x1.fffffffffffffp+1023, 0x1.452fc98b34e97p-8},
    {"sin", se3di_sin, 0x1.0p+120, 0x1.82e34655e6fcbp-2},
    {"sin", se3di_sin, 0x1.7d3fa2d3dd7efp+16, 0x1.c4c6a184ccc5cp-3},
    {"cos", se3di_cos, 0x1.8000000000009p-23, 0x1.fffffffffff70p-1},
    {"cos", se3di_cos, 0x1.34ec2f9fc9c00p+1, -0x1.7e2a5c30e1d6dp-1},
    {"cos", se3di_cos, 0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54},
    {"cos", se3di_cos, 0x1.6ac5b262ca1ffp+849, -0x1.14ae72e6ba22fp-61},
    {"cos", se3di_cos, 0x1.fffffffffffffp+1023, -0x1.fffe62ecfab75p-1},
    {"cos", se3di_cos, 0x1.e9b3e6b5c3b0cp+9, 0x1.6f0f7063a330bp-1},
    {"tan", se3di_tan, 0x1.dffffffffff1fp-22, 0x1.e000000000151p-22},
    {"tan", se3di_tan, 0x1.921fb54442d18p+0, 0x1.d02967c31cdb5p+53},
    {"tan", se3di_tan, 0x1.6ac5b262ca1ffp+849, -0x1.d9ba9a7975636p+60},
    {"tan", se3di_tan, 0x1.0p+200, 0x1.174eaa6b7b25dp-1},
    {"tan", se3di_tan, 0x1.fa8f4d0b6f9a1p-1, 0x1.8587a878684c0p+0},
    {"asin", se3di_asin, 0x1.7fffffffffff7p-23, 0x1.800000000001bp-23},
    {"asin", se3di_asin, 0x1.fffffffffffffp-1, 0x1.921fb50442d18p+0},
    {"asin", se3di_asin, 0x1.0p-1, 0x1.0c152382d7366p-1},
    {"asin", se3di_asin, 0x1.6a09e667f3bcdp-1, 0x1.921fb54442d19p-1},
    {"asin", se3di_asin, 0x1.df27e1c764802p-2, 0x1.f2a0f0c96deefp-2},
    {"acos", se3di_acos, 0x1.fffffffffffffp-1, 0x1.0p-26},
    {"acos", se3di_acos, -0x1.fffffffffffffp-1, 0x1.921fb52442d18p+1},
    {"acos", se3di_acos, 0x1.0p-1, 0x1.0c152382d7366p+0},
    {"acos", se3di_acos, 0x1.fffff6fb3f44ap-2, 0x1.0c15261d51f7bp+0},
    {"acos", se3di_acos, 0x1.53ea6c7255e88p-4, 0x1.7cdacb6bbe707p+0},
    {"acos", se3di_acos, 0x1.0p-60, 0x1.921fb54442d18p+0},
    {"atan", se3di_atan, 0x1.607844d8a5cfcp+1, 0x1.38f2b5e47d8e5p+0},
    {"atan", se3di_atan, 0x1.9dbd12c89d1d9p+2, 0x1.6ad5da7f04a3ap+0},
    {"atan", se3di_atan, 0x1.0p+60, 0x1.921fb54442d18p+0},
    {"atan", se3di_atan, 0x1.fffffffffffffp-1, 0x1.921fb54442d18p-1},
    {"atan", se3di_atan, 0x1.6298b5896ed3cp+1, 0x1.3970e827504c7p+0},
    {"sinh", se3di_sinh, 0x1.dffffffffffe4p-20, 0x1.e000000001178p-20},
    {"sinh", se3di_sinh, 0x1.897374fe073e1p-10, 0x1.89737eac5e30fp-10},
    {"sinh", se3di_sinh, 0x1.62e42fefa39efp+9, 0x1.fffffffffff2ap+1022},
    {"sinh", se3di_sinh, 0x1.633ce8fb9f87dp+9, 0x1.ffffffffffd3bp+1023},
    {"sinh", se3di_sinh, 0x1.adc135eb544c1p-1, 0x1.e2067473cf244p-1},
    {"cosh", se3di_cosh, 0x1.6b1d3ac9c5a3fp-3, 0x1.0408cb5a22dc8p+0},
    {"cosh", se3di_cosh, 0x1.465655f122ff6p-3, 0x1.0341c30c5afb4p+0},
    {"cosh", se3di_cosh, 0x1.633ce8fb9f87dp+9, 0x1.ffffffffffd3bp+1023},
    {"cosh", se3di_cosh, 0x1.1f0da93354198p-7, 0x1.000283c052040p+0},
    {"tanh", se3di_tanh, 0x1.e1eb2a7c6e2ffp-2, 0x1.c13b60f1df478p-2},
    {"tanh", se3di_tanh, 0x1.6ec4a5a1ab2d6p+3, 0x1.fffffffe188ecp-1},
    {"tanh", se3di_tanh, 0x1.30fc1931f09c9p+4, 0x1.fffffffffffffp-1},
    {"tanh", se3di_tanh, 0x1.0p-7, 0x1.fffd55599992bp-8},
    {"log10", se3di_log10, 0x1.de02157073b31p-1, -0x1.e8cfabf160ec6p-6},
    {"log10", se3di_log10, 0x1.8000000000000p+1, 0x1.e8927964fd5fdp-2},
    {"log10", se3di_log10, 0x1.e848000000000p+19, 0x1.8000000000000p+2},
    {"log10", se3di_log10, 0x0.0000000000001p-1022, -0x1.434e6420f4374p+8},
    {"log10", se3di_log10, 0x1.fffffffffffffp-1, -0x1.bcb7b1526e50fp-55},
    {"log1p", se3di_log1p, 0x1.fffffffffffffp-30, 0x1.fffffff7fffffp-30},
    {"log1p", se3di_log1p, -0x1.fffffffffffffp-1, -0x1.25e4f7b2737fap+5},
    {"log1p", se3di_log1p, 0x1.e000000000000p-20, 0x1.dfffe3e002328p-20},
    {"log1p", se3di_log1p, -0x1.6000000000000p-40, -0x1.6000000000f20p-40},
    {"log1p", se3di_log1p, 0x1.8000000000000p+70, 0x1.8767f8ebb2e8ep+5},
    /* the first phase cannot round these */
    {"log", se3di_log, 0x1.205601a526c2ap+1, 0x1.9fcb0e76d34dap-1},
    {"log10", se3di_log10, 0x1.202f448265161p+3, 0x1.e8b6f4f37b065p-1},
    {"log1p", se3di_log1p, 0x1.d70386ea03d5cp-1, 0x1.4dfa1204f483cp-1},
    {"asin", se3di_asin, 0x1.7ff388b4728d8p-2, 0x1.8991dc625b3b5p-2},
    {"cosh", se3di_cosh, 0x1.361993f59a066p+2, 0x1.fc9a51aacd14ap+5},
};

static const struct {
    const char *name;
    binary f;
    double x, y, value;
} hard_pairs[] = {
    {"pow", se3di_pow, 0x1.0000000000001p+0, 0x1.0p+62, INF},
    {"pow", se3di_pow, 0x1.8000000000000p+1, 0x1.8000000000000p+5, 0x1.0e425c56daffbp+76},
    {"pow", se3di_pow, 0x1.fffffffffffffp-1, 0x1.4000000000000p+60, 0x1.1fc63223fac54p-231},
    {"pow", se3di_pow, 0x1.4000000000000p+3, -0x1.3400000000000p+8, 0x0.730d67819e8d2p-1022},
    {"pow", se3di_pow, 0x1.4000000000000p+3, -0x1.4400000000000p+8, 0x0.0p+0},
    {"pow", se3di_pow, 0x1.0000010000000p+0, 0x1.8000000000000p+1, 0x1.0000030000030p+0},
    {"pow", se3di_pow, 0x1.2000000000000p+3, 0x1.8000000000000p+0, 0x1.b000000000000p+4},
    {"pow", se3di_pow, 0x1.0000001000001p+0, 0x1.0p+1, 0x1.0000002000002p+0},
    {"pow", se3di_pow, 0x0.0000000000001p-1022, 0x1.0p-1, 0x1.0p-537},
    {"pow", se3di_pow, 0x1.999999999999ap-4, 0x1.8000000000000p+3, 0x1.19799812dea14p-40},
    {"atan2", se3di_atan2, 0x1.0p+0, 0x1.0p+0, 0x1.921fb54442d18p-1},
    {"atan2", se3di_atan2, 0x0.0000000000003p-1022, 0x1.8000000000000p+0, 0x0.0000000000002p-1022},
    {"atan2", se3di_atan2, 0x1.0p-1000, 0x1.8000000000000p+73, 0x0.0000000000001p-1022},
    {"atan2", se3di_atan2, 0x1.8000000000000p+1000, -0x1.0p-20, 0x1.921fb54442d18p+0},
    {"atan2", se3di_atan2, -0x1.3000000000000p+0, -0x1.0p+60, -0x1.921fb54442d18p+1},
    {"atan2", se3di_atan2, 0x0.0000000004000p-1022, -0x1.0p+0, 0x1.921fb54442d18p+1},
    {"atan2", se3di_atan2, 0x1.23456789abcdep+0, 0x1.fedcba9876543p+1, 0x1.1c60568e40f4bp-2},
    {"hypot", se3di_hypot, 0x1.8000000000000p+1, 0x1.0p+2, 0x1.4000000000000p+2},
    {"hypot", se3di_hypot, 0x1.fffffffffffffp+1022, 0x1.fffffffffffffp+1022,
     0x1.6a09e667f3bccp+1023},
    {"hypot", se3di_hypot, 0x0.0000000000003p-1022, 0x0.0000000000004p-1022,
     0x0.0000000000005p-1022},
    {"hypot", se3di_hypot, 0x1.0p+0, 0x1.6a09e667f3bcdp-27, 0x1.0p+0},
    {"hypot", se3di_hypot, 0x1.000000c000000p+0, 0x1.5000000000000p+0, 0x1.a669813809586p+0},
    {"hypot", se3di_hypot, 0x1.921fb54442d18p+500, 0x1.0p+480, 0x1.921fb54443230p+500},
};

static void hard_cases_have_the_bits_of_the_exact_value(void)
{
    for (size_t k = 0; k < sizeof hard / sizeof hard[0]; ++k) {
        check_same(hard[k].name, hard[k].x, 0.0, hard[k].f(hard[k].x), hard[k].value);
    }
    for (size_t k = 0; k < sizeof hard_pairs / sizeof hard_pairs[0]; ++k) {
        const double x = hard_pairs[k].x, y = hard_pairs[k].y;
        check_same(hard_pairs[k].name, x, y, hard_pairs[k].f(x, y), hard_pairs[k].value);
    }
}

/* ---- special cases ---- */

#define NOT ((double)NAN)
#define PI  0x1.921fb54442d18p+1

static const struct {
    const char *name;
    unary f;
    double zero, infinite, minus_infinite, one; /* at 0, inf, -inf and 1 */
} special[] = {
    {"exp", se3di_exp, 1.0, INF, 0.0, 0x1.5bf0a8b145769p+1},
    {"log", se3di_log, -INF, INF, NOT, 0.0},
    {"log10", se3di_log10, -INF, INF, NOT, 0.0},
    {"log1p", se3di_log1p, 0.0, INF, NOT, 0x1.62e42fefa39efp-1},
    {"sin", se3di_sin, 0.0, NOT, NOT, 0x1.aed548f090ceep-1},
    {"cos", se3di_cos, 1.0, NOT, NOT, 0x1.14a280fb5068cp-1},
    {"tan", se3di_tan, 0.0, NOT, NOT, 0x1.8eb245cbee3a6p+0},
    {"asin", se3di_asin, 0.0, NOT, NOT, 0.5 * PI},
    {"acos", se3di_acos, 0.5 * PI, NOT, NOT, 0.0},
    {"atan", se3di_atan, 0.0, 0.5 * PI, -0.5 * PI, 0.25 * PI},
    {"sinh", se3di_sinh, 0.0, INF, -INF, 0x1.2cd9fc44eb982p+0},
    {"cosh", se3di_cosh, 1.0, INF, INF, 0x1.8b07551d9f55p+0},
    {"tanh", se3di_tanh, 0.0, 1.0, -1.0, 0x1.85efab514f394p-1},
};

static void special_cases_are_those_of_c(void)
{
    for (size_t k = 0; k < sizeof special / sizeof special[0]; ++k) {
        const unary f = special[k].f;
        check_same(special[k].name, 0.0, 0.0, f(0.0), special[k].zero);
        check_same(special[k].name, INF, 0.0, f(INF), special[k].infinite);
        check_same(special[k].name, -INF, 0.0, f(-INF), special[k].minus_infinite);
        check_same(special[k].name, 1.0, 0.0, f(1.0), special[k].one);
        CHECK(isnan(f(NOT)));
        const double minus = f(-0.0); /* odd functions keep the sign */
        CHECK(same(minus, f(0.0)) || (signbit(minus) && minus == 0.0));
        const int odd = f != se3di_exp && f != se3di_log && f != se3di_log10 && f != se3di_cos &&
                        f != se3di_cosh && f != se3di_acos;
        CHECK(odd == (signbit(minus) && minus == 0.0));
        if (odd) {
            check_same(special[k].name, 0x1p-1074, 0.0, f(0x1p-1074), 0x1p-1074);
        }
    }
    CHECK(isnan(se3di_log(-1.0)) && isnan(se3di_log10(-1.0)) && isnan(se3di_log1p(-2.0)));
    CHECK(same(se3di_log1p(-1.0), -INF) && isnan(se3di_asin(1.5)) && isnan(se3di_acos(-1.5)));
    CHECK(same(se3di_exp(-1e9), 0.0) && same(se3di_exp(1e9), INF));
    CHECK(same(se3di_sinh(-1e9), -INF) && same(se3di_cosh(-1e9), INF));
}

static const struct {
    double x, y, power, angle, length; /* x^y, the angle atan2(x, y), hypot */
} special_pairs[] = {
    {0.0, 0.0, 1.0, 0.0, 0.0},         {-0.0, 0.0, 1.0, -0.0, 0.0},
    {0.0, -0.0, 1.0, PI, 0.0},         {-0.0, -0.0, 1.0, -PI, 0.0},
    {0.0, 3.0, 0.0, 0.0, 3.0},         {-0.0, 3.0, -0.0, -0.0, 3.0},
    {-0.0, -3.0, -INF, -PI, 3.0},      {0.0, -2.0, INF, PI, 2.0},
    {-0.0, 2.5, 0.0, -0.0, 2.5},       {INF, INF, INF, 0.25 * PI, INF},
    {INF, -INF, 0.0, 0.75 * PI, INF},  {-INF, INF, INF, -0.25 * PI, INF},
    {-INF, 3.0, -INF, -0.5 * PI, INF}, {-INF, -3.0, -0.0, -0.5 * PI, INF},
    {1.0, INF, 1.0, 0.0, INF},         {-1.0, INF, 1.0, -0.0, INF},
    {-1.0, -INF, 1.0, -PI, INF},       {0.5, INF, 0.0, 0.0, INF},
    {0.5, -INF, INF, PI, INF},         {2.0, 0.0, 4.0 / 4.0, 0.5 * PI, 2.0},
    {NOT, 0.0, 1.0, NOT, NOT},         {1.0, NOT, 1.0, NOT, NOT},
    {NOT, 1.0, NOT, NOT, NOT},         {INF, NOT, NOT, NOT, INF},
    {-8.0, 3.0, -512.0, 0, 0},         {-2.0, 0.5, NOT, 0, 0},
    {-1.0, 1e300, 1.0, 0, 0},          {-2.0, 1025.0, -INF, 0, 0},
    {2.0, -1074.0, 0x1p-1074, 0, 0},   {2.0, -1075.0, 0.0, 0, 0},
};

static void special_cases_of_two_arguments_are_those_of_c(void)
{
    for (size_t k = 0; k < sizeof special_pairs / sizeof special_pairs[0]; ++k) {
        const double x = special_pairs[k].x, y = special_pairs[k].y;
        check_same("pow", x, y, se3di_pow(x, y), special_pairs[k].power);
        if (k < 24) {
            check_same("atan2", x, y, se3di_atan2(x, y), special_pairs[k].angle);
            check_same("hypot", x, y, se3di_hypot(x, y), special_pairs[k].length);
        }
    }
}

/* ---- the phases ---- */

static const struct {
    const char *name;
    unary f, big;
    double low, high; /* of random arguments */
} ranges[] = {
    {"exp", se3di_exp, se3di_big_exp, -745.0, 709.0},
    {"log", se3di_log, se3di_big_log, 1e-3, 10.0},
    {"log10", se3di_log10, se3di_big_log10, 1e-3, 1e3},
    {"log1p", se3di_log1p, se3di_big_log1p, -0.9, 2.0},
    {"tan", se3di_tan, se3di_big_tan, -1e3, 1e3},
    {"asin", se3di_asin, se3di_big_asin, -1.0, 1.0},
    {"acos", se3di_acos, se3di_big_acos, -1.0, 1.0},
    {"sinh", se3di_sinh, se3di_big_sinh, -20.0, 20.0},
    {"cosh", se3di_cosh, se3di_big_cosh, -20.0, 20.0},
    {"tanh", se3di_tanh, se3di_big_tanh, -20.0, 20.0},
};
#define RANGES (sizeof ranges / sizeof ranges[0])

static double between(uint64_t *seed, double low, double high)
{
    return low + (0.5 + 0.5 * check_random(seed)) * (high - low);
}

static void both_phases_round_alike(void)
{
    uint64_t seed = 7;
    for (size_t k = 0; k < RANGES; ++k) {
        for (int n = 0; n < 60; ++n) {
            const double x = between(&seed, ranges[k].low, ranges[k].high);
            check_same(ranges[k].name, x, 0.0, ranges[k].f(x), ranges[k].big(x));
        }
    }
    for (int n = 0; n < 60; ++n) {
        const double x = between(&seed, n % 2 ? -10.0 : -1e18, n % 2 ? 10.0 : 1e18);
        const double y = between(&seed, -3.0, 3.0);
        double sine, cosine, exact[2];
        se3di_sincos(x, &sine, &cosine);
        se3di_big_sincos(x, exact);
        check_same("sin", x, 0.0, sine, exact[0]);
        check_same("cos", x, 0.0, cosine, exact[1]);
        CHECK(same(se3di_sin(x), sine) && same(se3di_cos(x), cosine));
        check_same("atan2", y, x, se3di_atan2(y, x), se3di_big_atan2(y, x));
        const double few = floor(8.0 * y) * se3di_pow(2.0, -50.0 - n % 8);
        const double one = 1.0 + (n % 5 - 2) * 0x1p-53; /* noise about an angle of 0 */
        check_same("atan2", few, one, se3di_atan2(few, one),
                   few == 0.0 ? few : se3di_big_atan2(few, one));
        const double small = se3di_pow(2.0, -31.0 - n % 26) * (1.0 + (n / 26) * 0.5);
        check_same("atan2", small, one, se3di_atan2(small, one), se3di_big_atan2(small, one));
        const double any = y * se3di_pow(2.0, -31.0 - n % 26), by = between(&seed, 0.5, 1e6);
        check_same("atan2", any, by, se3di_atan2(any, by), se3di_big_atan2(any, by));
        check_same("hypot", x, y, se3di_hypot(x, y), se3di_big_hypot(x, y));
        check_same("pow", fabs(x), y, se3di_pow(fabs(x), y), se3di_big_pow(fabs(x), y));
    }
}

/* Zeros and equal arguments, which have exact results or never come to it. */
static void the_second_phase_takes_what_needs_none(void)
{
    double out[2];
    se3di_big_sincos(0.0, out);
    CHECK(out[0] == 0.0 && out[1] == 1.0);
    CHECK(se3di_big_atan2(0.0, 2.0) == 0.0);
    CHECK(se3di_big_atan2(3.0, 3.0) == 0x1.921fb54442d18p-1);
    CHECK(se3di_big_asin(1.0) == 0x1.921fb54442d18p+0);
    CHECK(se3di_big_acos(1.0) == 0.0);
    CHECK(se3di_big_hypot(0.0, 0.0) == 0.0);
}

/* Ties, which a first phase cannot decide. */
static void exact_results_and_ties_are_rounded_to_even(void)
{
    uint64_t seed = 3;
    for (int n = 0; n < 200; ++n) {
        const double i = floor(between(&seed, 1.0, 0x1p27)), j = floor(between(&seed, 1.0, 2e6));
        check_same("pow", i, 2.0, se3di_pow(i, 2.0), i * i);
        check_same("pow", j, 3.0, se3di_pow(i * i, 0.5), se3di_pow(i, 1.0));
        check_same("hypot", 3.0 * i, 4.0 * i, se3di_hypot(3.0 * i, 4.0 * i), 5.0 * i);
    }
    check_same("pow", 0x1.8p26, 2.0, se3di_pow(0x1.8000001p27, 2.0),
               0x1.8000001p27 * 0x1.8000001p27);
    for (int n = -20; n <= 22; ++n) {
        const double ten = se3di_pow(10.0, n);
        CHECK(n < 0 || same(se3di_log10(ten), (double)n));
    }
}

#if defined(SE3DI_FAST_CHOICE)
/* Bits of one function of the first phase, with FMA and without. */
static void both_first_phases_give_the_same_bits(void)
{
    const se3di_fast *a = &se3di_fast_plain, *b = &se3di_fast_fused;
    int (*const f[2][9])(double, double *) = {
        {a->exp, a->log, a->log10, a->log1p, a->asin, a->acos, a->sinh, a->cosh, a->tanh},
        {b->exp, b->log, b->log10, b->log1p, b->asin, b->acos, b->sinh, b->cosh, b->tanh}};
    uint64_t seed = 5;
    if (!__builtin_cpu_supports("fma")) {
        printf("skipped: this machine has no FMA\n");
        return;
    }
    for (int n = 0; n < 20000; ++n) {
        const int k = n % 9;
        const double x = between(&seed, 1e-6, 1.0);
        const double y = between(&seed, -30.0, 30.0);
        double one[2] = {0.0, 0.0}, two[2] = {0.0, 0.0};
        CHECK(f[0][k](x, one) == f[1][k](x, two) && same(one[0], two[0]));
        CHECK(a->sincos(y, NULL, one) == b->sincos(y, NULL, two));
        CHECK(same(one[0], two[0]) && same(one[1], two[1]));
        CHECK(a->tan(y, NULL, one) == b->tan(y, NULL, two) && same(one[0], two[0]));
        CHECK(a->pow(x, y, one) == b->pow(x, y, two) && same(one[0], two[0]));
        CHECK(a->atan2(x, y, one) == b->atan2(x, y, two) && same(one[0], two[0]));
        CHECK(a->hypot(1.0, x, one) == b->hypot(1.0, x, two) && same(one[0], two[0]));
    }
}

/* Arguments at which the scale of the result, or the reduction of the argument, ends. */
static void a_first_phase_knows_its_ends(void)
{
    const se3di_fast *const both[2] = {&se3di_fast_plain, &se3di_fast_fused};
    for (int k = 0; k < (__builtin_cpu_supports("fma") ? 2 : 1); ++k) {
        double out[2];
        CHECK(!both[k]->exp(750.0, out) && !both[k]->exp(-750.0, out));
        CHECK(!both[k]->sincos(1e6, NULL, out) && !both[k]->tan(1e6, NULL, out));
        CHECK(!both[k]->pow(2.5, -750.0, out) && !both[k]->atan2(1e-300, 1.0, out));
    }
}
#else
static void a_first_phase_knows_its_ends(void)
{
}

static void both_first_phases_give_the_same_bits(void)
{
    printf("skipped: there is one first phase on this kind of machine\n");
    CHECK(1);
}
#endif

/* ---- MPFR ---- */

#if defined(SE3D_HAS_MPFR)
typedef int (*mpfr_unary)(mpfr_t, const mpfr_t, mpfr_rnd_t);
typedef int (*mpfr_binary)(mpfr_t, const mpfr_t, const mpfr_t, mpfr_rnd_t);

static double of_mpfr(mpfr_unary f, mpfr_binary g, double x, double y)
{
    mpfr_t a, b, out;
    mpfr_inits2(53, a, b, out, (mpfr_ptr)0);
    (void)mpfr_set_d(a, x, MPFR_RNDN);
    (void)mpfr_set_d(b, y, MPFR_RNDN);
    int ternary = f ? f(out, a, MPFR_RNDN) : g(out, a, b, MPFR_RNDN);
    (void)mpfr_subnormalize(out, ternary, MPFR_RNDN);
    double value = mpfr_get_d(out, MPFR_RNDN);
    mpfr_clears(a, b, out, (mpfr_ptr)0);
    return value;
}

static double any_double(uint64_t *seed)
{
    uint64_t bits = 0;
    double x;
    for (int k = 0; k < 4; ++k) {
        bits = bits << 16 | (uint64_t)(0x1p15 * (1.0 + check_random(seed)));
    }
    memcpy(&x, &bits, sizeof x);
    return x;
}

static void all_agree_with_mpfr(void)
{
    static const struct {
        const char *name;
        unary f;
        mpfr_unary exact;
        double size;
    } one[] = {
        {"exp", se3di_exp, mpfr_exp, 700.0},      {"log", se3di_log, mpfr_log, 10.0},
        {"log10", se3di_log10, mpfr_log10, 10.0}, {"log1p", se3di_log1p, mpfr_log1p, 2.0},
        {"sin", se3di_sin, mpfr_sin, 20.0},       {"cos", se3di_cos, mpfr_cos, 20.0},
        {"tan", se3di_tan, mpfr_tan, 20.0},       {"asin", se3di_asin, mpfr_asin, 1.0},
        {"acos", se3di_acos, mpfr_acos, 1.0},     {"atan", se3di_atan, mpfr_atan, 5.0},
        {"sinh", se3di_sinh, mpfr_sinh, 30.0},    {"cosh", se3di_cosh, mpfr_cosh, 30.0},
        {"tanh", se3di_tanh, mpfr_tanh, 20.0},
    };
    static const struct {
        const char *name;
        binary f;
        mpfr_binary exact;
    } two[] = {{"pow", se3di_pow, mpfr_pow},
               {"atan2", se3di_atan2, mpfr_atan2},
               {"hypot", se3di_hypot, mpfr_hypot}};
    uint64_t seed = 11;
    mpfr_set_emin(-1073);
    mpfr_set_emax(1024);
    for (int n = 0; n < 3000; ++n) {
        for (size_t k = 0; k < sizeof one / sizeof one[0]; ++k) {
            const double small = exp2(-floor(between(&seed, 0.0, 40.0)));
            const double x = n % 3 == 0
                                 ? any_double(&seed)
                                 : one[k].size * check_random(&seed) * (n % 3 == 1 ? 1.0 : small);
            check_same(one[k].name, x, 0.0, one[k].f(x), of_mpfr(one[k].exact, NULL, x, 0.0));
        }
        for (size_t k = 0; k < 3; ++k) {
            const double x = n % 3 == 0 ? any_double(&seed) : between(&seed, 0.0, 10.0);
            const double y = n % 3 == 0 ? any_double(&seed) : 20.0 * check_random(&seed);
            check_same(two[k].name, x, y, two[k].f(x, y), of_mpfr(NULL, two[k].exact, x, y));
        }
    }
    mpfr_free_cache();
}

#else
static void all_agree_with_mpfr(void)
{
    printf("skipped: MPFR is not installed (Debian: libmpfr-dev)\n");
    CHECK(1);
}
#endif

/* |a - exact| in units of the last place of the exact value, or 2^-53 if that is larger. */
static double units(double a, double exact)
{
    const double unit = fmax(nextafter(fabs(exact), 1e300) - fabs(exact), 0x1p-53);
    return fabs(a - exact) / unit;
}

static void quick_ones_are_within_a_unit(void)
{
    uint64_t seed = 5;
    for (int n = 0; n < 20000; ++n) {
        const double x = check_random(&seed) * exp2(between(&seed, -30.0, 60.0));
        const double exact = se3di_atan(x), angle = se3di_quick_atan(x);
        const double last = nextafter(fabs(exact), 4.0) - fabs(exact);
        CHECK(fabs(angle - exact) <= last);
        const double turn = (n % 2 ? 25.0 : 1.0) * check_random(&seed);
        double sine, cosine, exact_sine, exact_cosine;
        se3di_sincos(turn, &exact_sine, &exact_cosine);
        se3di_quick_sincos(turn, &sine, &cosine);
        CHECK(units(sine, exact_sine) <= 1.0);
        CHECK(units(cosine, exact_cosine) <= 1.0);
    }
}

static void quick_ones_know_special_cases(void)
{
    double sine, cosine;
    CHECK(isnan(se3di_quick_atan((double)NAN)));
    CHECK_NEAR(se3di_quick_atan(HUGE_VAL), se3di_atan(HUGE_VAL), 0.0);
    CHECK_NEAR(se3di_quick_atan(-1e300), se3di_atan(-1e300), 0.0);
    CHECK_NEAR(se3di_quick_atan(0x1p-1060), 0x1p-1060, 0.0);
    CHECK_NEAR(se3di_quick_atan(0.0), 0.0, 0.0);
    se3di_quick_sincos((double)NAN, &sine, &cosine);
    CHECK(isnan(sine) && isnan(cosine));
    se3di_quick_sincos(1e6, &sine, &cosine);
    CHECK_NEAR(sine, se3di_sin(1e6), 0.0);
    CHECK_NEAR(cosine, se3di_cos(1e6), 0.0);
    se3di_quick_sincos(0.0, &sine, &cosine);
    CHECK_NEAR(sine, 0.0, 0.0);
    CHECK_NEAR(cosine, 1.0, 0.0);
}

int main(void)
{
    RUN(hard_cases_have_the_bits_of_the_exact_value);
    RUN(special_cases_are_those_of_c);
    RUN(special_cases_of_two_arguments_are_those_of_c);
    RUN(both_phases_round_alike);
    RUN(exact_results_and_ties_are_rounded_to_even);
    RUN(both_first_phases_give_the_same_bits);
    RUN(a_first_phase_knows_its_ends);
    RUN(the_second_phase_takes_what_needs_none);
    RUN(all_agree_with_mpfr);
    RUN(quick_ones_are_within_a_unit);
    RUN(quick_ones_know_special_cases);
    return check_finish();
}
