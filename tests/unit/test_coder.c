/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers as bytes: what does not fit is counted and changes nothing, what ends too early is
 * zero. */
#include "check.h"

#include "base/coder.h"

static void what_does_not_fit_is_counted_only(void)
{
    unsigned char bytes[24];
    memset(bytes, 0xA5, sizeof bytes);
    se3di_coder c = {.out = bytes, .size = 16};
    uint64_t word = UINT64_C(0x0102030405060708);
    for (int k = 0; k < 3; ++k) {
        CHECK(!c.failed);
        se3di_code_word(&c, &word);
        CHECK(word == UINT64_C(0x0102030405060708) && c.at == 8 * ((size_t)k + 1));
    }
    CHECK(c.failed && bytes[0] == 8 && bytes[7] == 1 && bytes[15] == 1 && bytes[16] == 0xA5);
    se3di_code_word(&c, &word); /* further out than there is room */
    CHECK(c.failed && c.at == 32 && bytes[16] == 0xA5);
}

static void what_ends_too_early_is_zero(void)
{
    const unsigned char bytes[12] = {1, 0, 0, 0, 0, 0, 0, 0x80, 7, 7, 7, 7};
    se3di_coder c = {.in = bytes, .size = sizeof bytes};
    uint64_t word = 9;
    se3di_code_word(&c, &word);
    CHECK(!c.failed && word == UINT64_C(0x8000000000000001));
    se3di_code_word(&c, &word);
    CHECK(c.failed && word == 0);
    word = 9;
    se3di_code_word(&c, &word);
    CHECK(c.failed && word == 0 && c.at == 24);
}

static void what_is_measured_is_what_is_written(void)
{
    unsigned char bytes[64];
    double values[3] = {1.5, -0.0, HUGE_VAL}, back[3] = {0.0, 0.0, 0.0};
    uint64_t word = 77, again = 0;
    se3di_coder measure = {.size = SIZE_MAX};
    se3di_code_word(&measure, &word);
    se3di_code_numbers(&measure, values, 3);
    CHECK(measure.at == 32 && !measure.failed);
    se3di_coder out = {.out = bytes, .size = measure.at};
    se3di_code_word(&out, &word);
    se3di_code_numbers(&out, values, 3);
    CHECK(!out.failed && out.at == measure.at);
    se3di_coder in = {.in = bytes, .size = measure.at};
    se3di_code_word(&in, &again);
    se3di_code_numbers(&in, back, 3);
    CHECK(!in.failed && again == 77 && memcmp(back, values, sizeof back) == 0);
}

int main(void)
{
    RUN(what_does_not_fit_is_counted_only);
    RUN(what_ends_too_early_is_zero);
    RUN(what_is_measured_is_what_is_written);
    return check_finish();
}
