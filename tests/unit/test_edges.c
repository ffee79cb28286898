/* SPDX-License-Identifier: BSD-3-Clause */
/* What other tests do not reach of the lowest layers: sizes that overflow, bytes that end, handles
 * that are used up, definitions of other versions, texts at their limits. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/busy.h"
#include "base/coder.h"
#include "base/floats.h"
#include "base/guard.h"
#include "base/log.h"
#include "base/names.h"
#include "base/pending.h"
#include "base/sized.h"
#include "base/slots.h"
#include "check.h"
#include "se3d/se3d.h"

static void sizes_that_overflow_are_no_memory(void)
{
    const se3d_allocator allocator = se3di_alloc_default();
    void *data = NULL;
    size_t capacity = 0;
    CHECK(se3di_alloc(&allocator, SIZE_MAX / 8, 16) == NULL);
    CHECK(se3di_array_reserve(&allocator, &data, &capacity, SIZE_MAX / 8, 16) ==
          SE3D_ERR_NO_MEMORY);
    CHECK(data == NULL && capacity == 0);
    void *empty = se3di_alloc(&allocator, 0, 0);
    CHECK(empty != NULL);
    se3di_free(&allocator, empty, 0, 0);
}

static void bytes_that_end_too_early_are_zero(void)
{
    unsigned char bytes[20];
    double three[3] = {1.0, -2.0, 3.0};
    se3di_coder out = {.out = bytes, .size = sizeof bytes};
    se3di_code_numbers(&out, three, 3);
    CHECK(out.failed && out.at == 24 && three[2] == 3.0);
    se3di_coder in = {.in = bytes, .size = sizeof bytes};
    se3di_code_numbers(&in, three, 3);
    CHECK(in.failed && three[0] == 1.0 && three[1] == -2.0 && three[2] == 0.0);
    size_t count = 5; /* beyond the end, and of what is left too many */
    se3di_code_count(&in, &count, 1.0);
    CHECK(count == 0);
    memset(bytes, 0, sizeof bytes);
    bytes[0] = 7;
    in = (se3di_coder){.in = bytes, .size = sizeof bytes};
    se3di_code_count(&in, &count, 1.0);
    CHECK(in.failed && count == 0);
    int32_t flag = 0;
    in = (se3di_coder){.in = bytes, .size = sizeof bytes};
    se3di_code_flag(&in, &flag);
    CHECK(in.failed);
}

static void a_slot_whose_count_is_used_up_is_retired(void)
{
    const se3d_allocator allocator = se3di_alloc_default();
    se3di_slots slots;
    se3di_slots_init(&slots, 5);
    CHECK(se3di_slots_reserve(&slots, &allocator) == SE3D_OK);
    const se3di_handle first = se3di_slots_add(&slots);
    slots.slots[0].generation |= 0xfffffu; /* as after a million objects */
    const se3di_handle last = se3di_slots_handle(&slots, 0);
    se3di_slots_remove(&slots, 0);
    CHECK(se3di_slots_find(&slots, last.index1, last.generation) == SE3DI_NO_INDEX);
    CHECK(se3di_slots_reserve(&slots, &allocator) == SE3D_OK);
    const se3di_handle next = se3di_slots_add(&slots);
    CHECK(next.index1 != first.index1);
    se3di_slots_destroy(&slots, &allocator);
}

static void a_name_that_is_not_there_is_not_removed(void)
{
    const se3d_allocator allocator = se3di_alloc_default();
    se3di_names names = {0};
    se3di_names_remove(&names, 0, "none");
    CHECK(se3di_names_reserve(&names, &allocator, 1) == SE3D_OK);
    se3di_names_add(&names, 0, "one", 3);
    se3di_names_remove(&names, 0, "two");
    CHECK(se3di_names_find(&names, 0, "one") == 3);
    se3di_names_destroy(&names, &allocator);
}

static int stop(void *ctx)
{
    return ++*(int *)ctx;
}

static void nobody_that_is_there_is_asked(void)
{
    int asked = 0;
    se3di_guard guard = {.interrupt = stop, .ctx = &asked, .most = 2.0};
    se3di_guard_pace pace;
    CHECK(!se3di_guard_ask(NULL));
    se3di_guard_begin(&guard, 0.0, 1.0);
    guard.muted = 1;
    CHECK(!se3di_guard_ask(&guard) && asked == 0);
    guard.muted = 0;
    CHECK(se3di_guard_ask(&guard) && se3di_guard_ask(&guard) && asked == 1);
    CHECK(!se3di_guard_count(&guard, 0.0, &pace) && !se3di_guard_count(&guard, 0.0, &pace));
    CHECK(se3di_guard_count(&guard, 0.0, &pace)); /* the time stands still */
    CHECK(pace.foreseen > DBL_MAX && pace.length == 0.0);
}

static void a_reader_beyond_the_list_is_not_watched(void)
{
    se3di_busy busy;
    se3di_reading reading;
    se3di_busy_init(&busy);
    CHECK(se3di_busy_raise(NULL, SE3DI_BUSY_CALL) == SE3DI_BUSY_FREE);
    se3di_busy_restore(NULL, SE3DI_BUSY_FREE);
    CHECK(se3di_busy_allows(NULL, SE3DI_BUSY_FREE));
    CHECK(se3di_busy_read(NULL, &reading) && !reading.place);
    se3di_busy_unread(&reading);
    for (int k = 0; k < SE3DI_BUSY_READERS; ++k) {
        atomic_store(&busy.readers[k], 1); /* threads that are not this one */
    }
    CHECK(se3di_busy_read(&busy, &reading) && !reading.place);
    se3di_busy_unread(&reading);
}

static void complete(void *ctx)
{
    ++*(int *)ctx;
}

static void what_is_left_is_done_once(void)
{
    int done = 0;
    se3di_pending pending;
    se3di_pending_init(&pending);
    se3di_pending_complete(NULL);
    se3di_pending_drop(NULL);
    CHECK(!se3di_pending_is_of(NULL, &done) && !se3di_pending_is_of(&pending, &done));
    se3di_pending_open(&pending, complete, &done);
    CHECK(se3di_pending_is_of(&pending, &done) && !se3di_pending_is_of(&pending, &pending));
    se3di_pending_complete(&pending);
    se3di_pending_complete(&pending);
    CHECK(done == 1);
    se3di_pending_open(&pending, complete, &done);
    se3di_pending_drop(&pending);
    se3di_pending_complete(&pending);
    CHECK(done == 1);
}

static void sizes_of_no_version_are_refused(void)
{
    size_t small = 4, copy[8];
    CHECK(se3di_sized_take(&small, copy, sizeof copy) == SE3DI_SIZED_NONE);
    small = sizeof copy + SE3DI_SIZED_GROWTH + 1;
    CHECK(se3di_sized_take(&small, copy, sizeof copy) == SE3DI_SIZED_NONE);
}

static void halves_go_to_the_even_number(void)
{
    CHECK(se3di_nearest(0.5) == 0.0 && se3di_nearest(1.5) == 2.0 && se3di_nearest(2.5) == 2.0);
    CHECK(se3di_nearest(-0.5) == 0.0 && se3di_nearest(-1.5) == -2.0 && se3di_nearest(3.0) == 3.0);
    CHECK(se3di_nearest(0.49999999999999994) == 0.0); /* 0.5 is added to it as if it were a half */
}

#define EVERY_STATUS(name, value, text)                                                            \
    CHECK(strcmp(se3d_status_get_text(name), text) == 0 && (int)name == (value));

static void every_status_has_its_text(void)
{
    SE3D_STATUS_LIST(EVERY_STATUS)
    CHECK(strcmp(se3d_status_get_text((se3d_status)77), "unknown status") == 0);
}

static void ends_of_lines_and_paragraphs_are_no_characters(void)
{
    CHECK(se3d_text_get_character("\xe2\x80\xa8") == 0); /* U+2028 */
    CHECK(se3d_text_get_character("\xe2\x80\xa9") == 0); /* U+2029 */
    CHECK(se3d_text_get_character("\xe2\x80\xa7") == 3); /* U+2027 */
}

static se3d_status compile(const char *text, size_t size, const se3d_allocator *allocator,
                           se3d_expression_error *error)
{
    struct {
        se3d_expression_def def;
        char more[5000];
    } later;
    se3d_expression *made = NULL;
    memset(&later, 0, sizeof later);
    later.def = se3d_expression_def_default();
    later.def.text = text;
    later.def.allocator = allocator;
    if (size > 0) {
        later.def.struct_size = size;
        later.more[7] = size == sizeof later.def + 8;
    }
    const se3d_status status = se3d_expression_create(&later.def, &made, error);
    CHECK((status == SE3D_OK) == (made != NULL));
    se3d_expression_destroy(made);
    return status;
}

static void definitions_of_expressions_of_other_versions(void)
{
    const size_t size = sizeof(se3d_expression_def);
    se3d_expression_error error;
    CHECK(compile("1+1", size + 7, NULL, &error) == SE3D_OK);
    CHECK(compile("1+1", size + 8, NULL, &error) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(compile("1+1", size - 1, NULL, &error) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(compile("1+1", 4097, NULL, &error) == SE3D_ERR_INVALID_ARGUMENT);
    se3d_expression_def_init(NULL, size);
    size_t small = 3;
    se3d_expression_def_init((se3d_expression_def *)(void *)&small, 3);
    CHECK(small == 3);
    se3d_allocator allocator = se3di_alloc_default();
    allocator.realloc = NULL;
    CHECK(compile("1", 0, &allocator, &error) == SE3D_ERR_NULL);
    allocator = se3di_alloc_default();
    allocator.free = NULL;
    CHECK(compile("1", 0, &allocator, &error) == SE3D_ERR_NULL);
}

static void long_numbers_and_names_are_cut_in_messages(void)
{
    se3d_expression_error error;
    CHECK(compile("1234567890123456789012345678901234567890123456e+", 0, NULL, &error) ==
          SE3D_ERR_EXPRESSION);
    CHECK(strstr(error.message, "has no digits") != NULL);
    CHECK(compile("1234567890123456789012345678901234567890123456e400", 0, NULL, &error) ==
          SE3D_ERR_EXPRESSION);
    CHECK(strstr(error.message, "too large") != NULL);
    CHECK(compile("sin(1 a_name_of_which_nobody_will_ever_read_all_letters)", 0, NULL, &error) ==
          SE3D_ERR_EXPRESSION);
    CHECK(strstr(error.message, "...'") != NULL);
    CHECK(compile("a_name_of_which_nobody_will_ever_read_all_letters_and_more_of_them_than_fit", 0,
                  NULL, &error) == SE3D_ERR_EXPRESSION);
    CHECK(compile("max(1, 2, 3, 4, 5, 6, 7)", 0, NULL, &error) == SE3D_OK);
    CHECK(compile("atan2(1, 2, 3, 4, 5, 6, 7)", 0, NULL, &error) == SE3D_ERR_EXPRESSION);
}

int main(void)
{
    RUN(sizes_that_overflow_are_no_memory);
    RUN(bytes_that_end_too_early_are_zero);
    RUN(a_slot_whose_count_is_used_up_is_retired);
    RUN(a_name_that_is_not_there_is_not_removed);
    RUN(nobody_that_is_there_is_asked);
    RUN(a_reader_beyond_the_list_is_not_watched);
    RUN(what_is_left_is_done_once);
    RUN(sizes_of_no_version_are_refused);
    RUN(halves_go_to_the_even_number);
    RUN(every_status_has_its_text);
    RUN(ends_of_lines_and_paragraphs_are_no_characters);
    RUN(definitions_of_expressions_of_other_versions);
    RUN(long_numbers_and_names_are_cut_in_messages);
    return check_finish();
}
