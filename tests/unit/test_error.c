/* SPDX-License-Identifier: BSD-3-Clause */
/* Records of errors and the log beneath the public interface, coders that run out of room, and the
 * integers that are nearest. */
#define _POSIX_C_SOURCE 200809L
#include "base/coder.h"
#include "base/error.h"
#include "base/floats.h"
#include "base/log.h"
#include "check.h"
#include "support/comma_locale.h"

#include <string.h>

static void an_error_without_a_record_keeps_its_status(void)
{
    CHECK(se3di_error_set(NULL, SE3D_ERR_NULL, "a %d", 1) == SE3D_ERR_NULL);
    CHECK(se3di_error_set_of(NULL, "mass", SE3D_ERR_NULL, " = %d", 1) == SE3D_ERR_NULL);
    se3di_error error = {0};
    CHECK(se3di_error_set_of(&error, "mass[1]", SE3D_ERR_NULL, " = %d", 1) == SE3D_ERR_NULL);
    CHECK(strcmp(error.message, "mass[1] = 1") == 0 && strcmp(error.field, "mass") == 0);
}

static void a_message_between_two_texts_is_what_is_cut(void)
{
    char tail[SE3DI_ERROR_SIZE];
    se3di_error error = {0};
    se3di_error_set_of(&error, "mass", SE3D_ERR_NULL, " = %d", 1);
    error.cause = SE3DI_CAUSE_JUMP;
    se3di_error_wrap(&error, "why (", ")");
    CHECK(strcmp(error.message, "why (mass = 1)") == 0 && strcmp(error.field, "mass") == 0);
    CHECK(error.status == SE3D_ERR_NULL && error.cause == SE3DI_CAUSE_JUMP);
    memset(tail, 'a', sizeof tail - 1);
    tail[sizeof tail - 1] = '\0';
    se3di_error_set(&error, SE3D_ERR_NULL, "%s", tail);
    CHECK(error.cause == SE3DI_CAUSE_OTHER);
    se3di_error_wrap(&error, "why (", ")");
    const size_t length = strlen(error.message);
    CHECK(length == sizeof error.message - 1 && error.message[length - 1] == ')');
    CHECK(error.message[length - 2] == 'a' && memcmp(error.message, "why (a", 6) == 0);
    for (size_t k = 0; k + 1 < sizeof tail; k += 2) { /* characters of two bytes */
        memcpy(&tail[k], "\xc3\xa9", 2);
    }
    tail[sizeof tail - 2] = '\0';
    for (int shift = 0; shift < 2; ++shift) {
        se3di_error_set(&error, SE3D_ERR_NULL, "%s", tail);
        se3di_error_wrap(&error, &"--"[shift], ")");
        CHECK(strlen(error.message) == sizeof error.message - 1);
        CHECK(strspn(error.message, "-\xc3\xa9?)") == sizeof error.message - 1);
        se3di_error_wrap(&error, tail, tail); /* no room for it at all */
        CHECK(strlen(error.message) == sizeof error.message - 1);
    }
    se3di_error_clear(&error);
    CHECK(error.cause == SE3DI_CAUSE_OTHER && error.message[0] == '\0');
}

static void count_lines(void *ctx, se3d_log_level level, se3d_log_kind kind, const char *message)
{
    (void)level;
    (void)kind;
    (void)message;
    ++*(int *)ctx;
}

static void a_log_without_a_callback_is_not_written(void)
{
    int lines = 0;
    se3di_busy busy = {0};
    se3di_logger log = {.ctx = &lines, .busy = &busy};
    se3di_error error = {0};
    se3di_log_write(NULL, SE3D_LOG_INFO, SE3D_LOG_FAILURE, "a");
    se3di_log_write(&error, SE3D_LOG_INFO, SE3D_LOG_FAILURE, "a");
    CHECK(se3di_log_error(&error, SE3D_ERR_NULL) == SE3D_ERR_NULL);
    error.log = &log;
    se3di_log_write(&error, SE3D_LOG_INFO, SE3D_LOG_FAILURE, "a");
    CHECK(se3di_log_error(&error, SE3D_ERR_NULL) == SE3D_ERR_NULL);
    CHECK(lines == 0);
    log.callback = count_lines;
    se3di_log_write(&error, SE3D_LOG_INFO, SE3D_LOG_FAILURE, "a");
    CHECK(se3di_log_error(&error, SE3D_ERR_NULL) == SE3D_ERR_NULL);
    CHECK(lines == 2);
}

static void messages_have_points_in_a_locale_with_decimal_commas(void)
{
    se3di_error error = {0};
    if (!comma_locale_set(LC_NUMERIC)) {
        printf("skipped: no locale with a decimal comma is installed, or can be made\n");
        return;
    }
    (void)se3di_error_set(&error, SE3D_ERR_NULL, "%g, [1,2], a, %.1f,5,%d", 0.5, 1e3, 7);
    CHECK(setlocale(LC_NUMERIC, "C") != NULL);
    CHECK(strcmp(error.message, "0.5, [1.2], a, 1000.0.5.7") == 0);
}

static void a_coder_without_room_says_so(void)
{
    unsigned char bytes[12] = {1};
    uint64_t word = 7;
    se3di_coder c = {.out = bytes, .size = sizeof bytes};
    se3di_code_word(&c, &word);
    CHECK(!c.failed);
    se3di_code_word(&c, &word);
    CHECK(c.failed && word == 7);
    c = (se3di_coder){.in = bytes, .size = sizeof bytes};
    se3di_code_word(&c, &word);
    CHECK(!c.failed && word == 7);
    se3di_code_word(&c, &word);
    CHECK(c.failed && word == 0);
}

static void halves_go_to_the_even_integer(void)
{
    static const double rows[][2] = {{0.5, 0.0},  {1.5, 2.0},   {2.5, 2.0},  {-0.5, 0.0},
                                     {-1.5, -2.}, {0.75, 1.0},  {0.25, 0.0}, {-2.5, -2.0},
                                     {3.0, 3.0},  {-0.75, -1.0}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        CHECK(se3di_nearest(rows[k][0]) == rows[k][1]);
    }
    volatile double below = 0x1.fffffffffffffp-2; /* its sum with a half is rounded up */
    CHECK(se3di_nearest(below) == 0.0);
    CHECK(fesetround(FE_UPWARD) == 0);
    const double up = se3di_nearest(below);
    CHECK(fesetround(FE_TONEAREST) == 0);
    CHECK(up == 0.0);
}

int main(void)
{
    RUN(an_error_without_a_record_keeps_its_status);
    RUN(a_message_between_two_texts_is_what_is_cut);
    RUN(a_log_without_a_callback_is_not_written);
    RUN(messages_have_points_in_a_locale_with_decimal_commas);
    RUN(a_coder_without_room_says_so);
    RUN(halves_go_to_the_even_integer);
    return check_finish();
}
