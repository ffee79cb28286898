/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/log.h"

#include <stdarg.h>
#include <stdio.h>

#include "base/floats.h"

/* To a log with a callback. From within, all calls on the system but readers are refused. What they
 * record there is not left behind. */
static void tell(se3di_error *error, se3d_log_level level, se3d_log_kind kind, const char *text)
{
    se3di_logger *log = error->log;
    if (atomic_exchange(&log->writing, 1) != 0) {
        return;
    }
    const se3di_error before = *error;
    const int32_t busy = se3di_busy_raise(log->busy, SE3DI_BUSY_CALL);
    const se3di_floats host = se3di_floats_set();
    log->callback(log->ctx, level, kind, text);
    se3di_floats_resume();
    se3di_floats_restore(host);
    atomic_store(&log->writing, 0);
    se3di_busy_restore(log->busy, busy);
    *error = before;
}

void se3di_log_write(se3di_error *error, se3d_log_level level, se3d_log_kind kind,
                     const char *format, ...)
{
    if (!error || !error->log || !error->log->callback) {
        return;
    }
    char text[SE3DI_ERROR_SIZE];
    va_list arguments;
    va_start(arguments, format);
    se3di_error_format(text, sizeof text, format, arguments);
    va_end(arguments);
    tell(error, level, kind, text);
}

se3d_status se3di_log_error(se3di_error *error, se3d_status status)
{
    if (error->log && error->log->callback &&
        se3di_busy_allows(error->log->busy, SE3DI_BUSY_EVENT)) {
        const se3di_error copy = *error;
        tell(error, SE3D_LOG_ERROR, SE3D_LOG_FAILURE, copy.message);
    }
    return status;
}
