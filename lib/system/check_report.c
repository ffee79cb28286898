/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: reports on the constraints. */
#include "analysis/check.h"
#include "base/text.h"
#include "nonlinear/ranks.h"
#include "system/system_internal.h"

#include <string.h>

struct se3d_check {
    se3di_check report;
};

se3d_status se3d_check_create(se3d_system *system, se3d_check **out)
{
    if (out) {
        *out = NULL;
    }
    SE3DI_EDIT(system);
    SE3DI_TRY(se3di_check_pointer(system, "out", out));
    se3d_check *check = se3di_alloc(&system->model.allocator, 1, sizeof *check);
    if (!check) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for the report on constraints");
    }
    se3di_work_begin(system);
    se3d_status status =
        se3di_work_end(system, se3di_check_init(&check->report, &system->model, &system->found));
    if (status < 0) {
        se3di_free(&system->model.allocator, check, 1, sizeof *check);
        return status;
    }
    *out = check;
    return status;
}

void se3d_check_destroy(se3d_check *check)
{
    if (check) {
        se3d_allocator allocator = check->report.allocator;
        se3di_check_destroy(&check->report);
        se3di_free(&allocator, check, 1, sizeof *check);
    }
}

se3d_status se3d_check_get_summary(const se3d_check *check, se3d_check_summary *summary)
{
    if (!check || !summary) {
        return SE3D_ERR_NULL;
    }
    const se3di_check *report = &check->report;
    size_t size = summary->struct_size;
    if (size < sizeof size) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3d_check_summary full = {
        .struct_size = size,
        .bodies = report->bodies,
        .equations = report->equations,
        .rank = report->rank,
        .redundant = report->equations - report->rank,
        .freedoms = 6 * report->bodies - report->rank,
        .gruebler = 6 * (int64_t)report->bodies - (int64_t)report->equations,
        .inconsistent = report->inconsistent,
    };
    return se3di_sized_give(summary, size, &full, sizeof full);
}

size_t se3d_check_count_messages(const se3d_check *check)
{
    return check ? check->report.message_count : 0;
}

se3d_status se3d_check_get_message(const se3d_check *check, size_t k, const char **text)
{
    if (text) {
        *text = NULL;
    }
    if (!check || !text) {
        return SE3D_ERR_NULL;
    }
    if (k >= check->report.message_count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    *text = check->report.messages[k];
    return SE3D_OK;
}

se3d_status se3d_system_describe_left_out(const se3d_system *system, char *text, size_t size)
{
    if (!system || !text) {
        return SE3D_ERR_NULL;
    }
    if (size == 0) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3di_ranks_describe(&system->model, text, size);
    se3di_text_make_plain(text); /* a name may have been cut in a character */
    return SE3D_OK;
}
