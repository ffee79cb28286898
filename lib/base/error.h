/* SPDX-License-Identifier: BSD-3-Clause */
/* The error record: one fixed-size message per owner, so that the error path never allocates. */
#ifndef SE3DI_BASE_ERROR_H
#define SE3DI_BASE_ERROR_H

#include "se3d/base.h"

#include <stdarg.h>

#define SE3DI_ERROR_SIZE 512
#define SE3DI_FIELD_SIZE 48

/* What a message is about, for code that would add to it. */
typedef enum se3di_cause {
    SE3DI_CAUSE_OTHER = 0,
    SE3DI_CAUSE_OVERLAP = 1, /* two shapes that are named */
    SE3DI_CAUSE_JUMP = 2,    /* a prescribed value that is named */
    SE3DI_CAUSE_APART = 3    /* shapes that overlap at the start: every method needs them apart */
} se3di_cause;

typedef struct se3di_error {
    se3d_status status;
    char message[SE3DI_ERROR_SIZE];
    char field[SE3DI_FIELD_SIZE]; /* the argument or member that it is about; "": of none */
    se3di_cause cause;            /* whoever sets the message may set this after it */
    struct se3di_logger *log;     /* of the owner, see base/log.h; NULL: none */
} se3di_error;

/* Record `status` with a printf-like message (cut to fit) and return `status`. `error` may be NULL.
 * Numbers are written with a decimal point in every locale. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
se3d_status
se3di_error_set(se3di_error *error, se3d_status status, const char *format, ...);

/* The same about an argument or a member of a structure, with whose name the message begins:
 * `field` "radius[3]" is recorded as "radius". */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
se3d_status
se3di_error_set_of(se3di_error *error, const char *field, se3d_status status, const char *format,
                   ...);

/* Add to the message, as far as there is room; its status and field stay. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void
se3di_error_append(se3di_error *error, const char *format, ...);

/* Put the message between two texts. If there is no room it is the message that is cut. */
void se3di_error_wrap(se3di_error *error, const char *before, const char *after);

/* What both messages and the log are written with. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 0)))
#endif
void
se3di_error_format(char *text, size_t size, const char *format, va_list arguments);

/* Forget the last error. */
void se3di_error_clear(se3di_error *error);

/* Return from the calling function if `call` failed; information (> 0) passes. */
#define SE3DI_TRY(call)                                                                            \
    do {                                                                                           \
        se3d_status se3di_try_status = (call);                                                     \
        if (se3di_try_status < 0) {                                                                \
            return se3di_try_status;                                                               \
        }                                                                                          \
    } while (0)

#endif
