/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls from within callbacks: what is refused while a system is at work. */
#include "system/system_internal.h"

/* Callbacks of several threads may be refused at once: one of them writes the message. */
static void say_refused(se3d_system *system, const char *function)
{
    static const char *const where[] = {"code that a query of it calls", "the callback of an event",
                                        "the value of an event",
                                        "a callback of the call that works on it"};
    se3di_busy *busy = &system->busy;
    const int level = atomic_load(&busy->level);
    if (!atomic_flag_test_and_set(&busy->messaging)) {
        (void)se3di_error_set(
            &system->error, SE3D_ERR_STATE,
            "%s is not allowed in %s: the system is at work until that call returns", function,
            where[level]);
        se3di_log_write(&system->error, SE3D_LOG_ERROR, SE3D_LOG_FAILURE, "%s",
                        system->error.message);
        atomic_flag_clear(&busy->messaging);
    }
}

se3d_status se3di_enter(se3d_system *system, se3di_busy_level most, const char *function)
{
    SE3DI_TRY(se3di_enter_past(system, most, function));
    se3di_pending_complete(&system->pending);
    return SE3D_OK;
}

se3d_status se3di_enter_past(se3d_system *system, se3di_busy_level most, const char *function)
{
    if (!system) {
        return SE3D_ERR_NULL;
    }
    if (!se3di_busy_allows(&system->busy, most)) {
        say_refused(system, function);
        return SE3D_ERR_STATE;
    }
    return SE3D_OK;
}

void se3di_work_begin(se3d_system *system)
{
    (void)se3di_busy_raise(&system->busy, SE3DI_BUSY_CALL);
    system->host = se3di_floats_set();
    se3di_error_clear(&system->found);
}

se3d_status se3di_work_end(se3d_system *system, se3d_status status)
{
    se3di_floats_restore(system->host);
    se3di_busy_restore(&system->busy, SE3DI_BUSY_FREE);
    if (status < 0 && system->found.status == status) {
        system->error = system->found;
    } else if (status < 0 && system->error.status != status) {
        return SE3DI_FAIL(system, status, "%s", se3d_status_get_text(status));
    }
    return status < 0 ? se3di_log_error(&system->error, status) : status;
}

se3d_status se3di_read_begin(const se3d_system *system, se3di_reading *reading)
{
    return se3di_busy_read(system->model.busy, reading) ? SE3D_OK : SE3D_ERR_STATE;
}

se3d_status se3di_read_end(se3di_reading *reading, se3d_status status)
{
    se3di_busy_unread(reading);
    return status;
}

int se3di_is_settled(const se3d_system *system)
{
    return atomic_load(&system->busy.level) < (int)SE3DI_BUSY_CALL;
}

int32_t se3d_system_is_busy(const se3d_system *system)
{
    return system && !se3di_busy_allows(system->model.busy, SE3DI_BUSY_FREE);
}
