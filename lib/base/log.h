/* SPDX-License-Identifier: BSD-3-Clause */
/* The log of a system: sentences for its user while calls work. Whoever has the error record can
 * write to it; what is written follows from results and changes none. */
#ifndef SE3DI_BASE_LOG_H
#define SE3DI_BASE_LOG_H

#include "base/busy.h"
#include "base/error.h"

typedef struct se3di_logger {
    se3d_log_callback callback; /* NULL: silent */
    void *ctx;
    se3di_busy *busy;
    atomic_int writing; /* within the callback; readers in several threads may get here */
    int32_t reserved;
} se3di_logger;

/* Write a printf-like sentence, cut to the size of an error's. `error` or its log may be NULL. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
void
se3di_log_write(se3di_error *error, se3d_log_level level, se3d_log_kind kind, const char *format,
                ...);

/* Write the message that was recorded, and return `status`. Not while a call works: what is
 * recorded then may have been overcome; its end writes what has not. */
se3d_status se3di_log_error(se3di_error *error, se3d_status status);

#endif
