/* SPDX-License-Identifier: BSD-3-Clause */
/* Status codes, allocator, log, version: what every other header needs.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_BASE_H
#define SE3D_BASE_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#if defined(SE3D_STATIC)
#define SE3D_API
#elif defined(SE3D_BUILD)
#define SE3D_API __declspec(dllexport)
#else
#define SE3D_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define SE3D_API __attribute__((visibility("default")))
#else
#define SE3D_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The version of these headers. @since 0.1 */
#define SE3D_VERSION_MAJOR 0
#define SE3D_VERSION_MINOR 1
#define SE3D_VERSION_PATCH 0

/* The same as one number that grows with the version: 1000000 major + 1000 minor + patch.
 * @since 0.1 */
#define SE3D_VERSION_NUMBER                                                                        \
    (1000000 * SE3D_VERSION_MAJOR + 1000 * SE3D_VERSION_MINOR + SE3D_VERSION_PATCH)

/* The statuses with their texts: 0 is success, < 0 failure, > 0 success with information.
 * @since 0.1 */
#define SE3D_STATUS_LIST(X)                                                                        \
    X(SE3D_OK, 0, "success")                                                                       \
    X(SE3D_INFO_EVENT, 1, "an event stopped the run")                                              \
    X(SE3D_INFO_REDUNDANT, 2, "redundant constraints: multipliers are the minimum-norm ones")      \
    X(SE3D_INFO_UNSTABLE, 3, "the equilibrium is unstable")                                        \
    X(SE3D_INFO_NEUTRAL, 4, "the equilibrium is neutral: nothing holds some freedom")              \
    X(SE3D_ERR_NO_MEMORY, -1, "out of memory")                                                     \
    X(SE3D_ERR_INVALID_ARGUMENT, -2, "an argument is outside its allowed range")                   \
    X(SE3D_ERR_NULL, -3, "a required pointer is NULL")                                             \
    X(SE3D_ERR_STALE_HANDLE, -4, "handle does not name a live object of this system")              \
    X(SE3D_ERR_IN_USE, -5, "the object is used by another one")                                    \
    X(SE3D_ERR_STATE, -6, "the call is not allowed in this state")                                 \
    X(SE3D_ERR_EXPRESSION, -7, "an expression is malformed")                                       \
    X(SE3D_ERR_NOT_FINITE, -8, "a computed value is not finite")                                   \
    X(SE3D_ERR_NO_CONVERGENCE, -9, "an iteration did not converge")                                \
    X(SE3D_ERR_INCONSISTENT, -10, "constraints contradict each other")                             \
    X(SE3D_ERR_SINGULAR, -11, "the equations do not determine the motion")                         \
    X(SE3D_ERR_STEP_SIZE, -12, "the step became too small")                                        \
    X(SE3D_ERR_IO, -13, "reading or writing failed")                                               \
    X(SE3D_ERR_MODEL, -14, "the model is malformed")                                               \
    X(SE3D_ERR_CALLBACK, -15, "a callback reported a failure")                                     \
    X(SE3D_ERR_UNSUPPORTED, -16, "not supported in this combination")                              \
    X(SE3D_ERR_INTERRUPTED, -17, "the caller interrupted the run")                                 \
    X(SE3D_ERR_STEP_COUNT, -18, "the run would take too many steps")

#define SE3D_STATUS_ENUMERATOR(name, value, text) name = value,
/* The result of every call that can fail. @since 0.1 */
typedef enum se3d_status { SE3D_STATUS_LIST(SE3D_STATUS_ENUMERATOR) } se3d_status;
#undef SE3D_STATUS_ENUMERATOR

/* True if `call` failed; positive information counts as success. @since 0.1 */
#define SE3D_FAILED(call) ((call) < 0)

/* Get the text of a status ("success", ...).
 * @param[in] status  any number
 * @return the text, static; never NULL.
 * @since 0.1 */
SE3D_API const char *se3d_status_get_text(se3d_status status);

/* Measure the character at `text`. Names and messages may not hold bytes that are not UTF-8,
 * control characters, ends of lines and paragraphs, or marks that change the direction of writing.
 * @param[in] text  UTF-8, ends with a zero byte; NULL counts as empty
 * @return the number of its bytes; 0 at the end and for a character that is not allowed.
 * @since 0.1 */
SE3D_API size_t se3d_text_get_character(const char *text);

/* Get the version of the library that is linked, e.g. "0.1.0". @return the text, static.
 * @since 0.1 */
SE3D_API const char *se3d_version_get_text(void);

/* Get the version of the library that is linked, to compare it with SE3D_VERSION_NUMBER, that of
 * the headers, which may be older. @return the number.
 * @since 0.1 */
SE3D_API int32_t se3d_version_number(void);

/* Asked during a long call whether it is to end now: before every step that is tried and in every
 * iteration of a solution, in the thread of the call. It must not touch the objects that the call
 * works on. @return 0: go on; otherwise the call ends with SE3D_ERR_INTERRUPTED and its objects in
 * the state of the last accepted step, from which another call goes on. @since 0.1 */
typedef int (*se3d_interrupt)(void *ctx);

/* Structures grow at their end in later versions. Those that a caller fills (definitions, options)
 * begin with their struct_size; those that the library fills are told the size by the caller's own
 * header: f(..., out) is f_sized(..., out, sizeof *out), which other languages call. What a smaller
 * one has no room for is left out; what this library does not know of is zero, or must be if the
 * caller fills it. se3d_solver_stats, se3d_body_motion, se3d_expression_error and se3d_model_error
 * keep their size. */

/* Memory functions of a system. `alloc` and `realloc` return NULL on failure; sizes are in bytes
 * and `free` receives the size that was asked for. Memory must be aligned as malloc's is. Clones
 * share some memory, which the last one gives back: where they are used in several threads, so are
 * these functions. @since 0.1 */
typedef struct se3d_allocator {
    void *(*alloc)(void *ctx, size_t size);                                      /* as malloc */
    void *(*realloc)(void *ctx, void *memory, size_t old_size, size_t new_size); /* as realloc */
    void (*free)(void *ctx, void *memory, size_t size);                          /* as free */
    void *ctx;                                                                   /* of the three */
} se3d_allocator;

/* Severity of a log message. @since 0.1 */
typedef enum se3d_log_level {
    SE3D_LOG_INFO = 0,
    SE3D_LOG_WARNING = 1,
    SE3D_LOG_ERROR = 2
} se3d_log_level;

/* What a log message is about, for programs: its words may change. @since 0.1 */
typedef enum se3d_log_kind {
    SE3D_LOG_FAILURE = 0,    /* the message of a failure (ERROR) */
    SE3D_LOG_START = 1,      /* the start was changed: se3d_solver_get_start_change */
    SE3D_LOG_REDUNDANT = 2,  /* constraints are redundant */
    SE3D_LOG_LEFT_OUT = 3,   /* equations were left out: se3d_system_describe_left_out */
    SE3D_LOG_TOLERANCE = 4,  /* the tolerance is not reached: se3d_solver_get_tolerance */
    SE3D_LOG_METHOD = 5,     /* another method or formulation works: se3d_solver_get_switch */
    SE3D_LOG_STEP = 6,       /* the step is one that nobody chose, or is too long */
    SE3D_LOG_KINK = 7,       /* a prescribed rate has jumped: an impulse */
    SE3D_LOG_FILE = 8,       /* a file that a model names has or lacks something */
    SE3D_LOG_CHECKPOINT = 9, /* a checkpoint could not be written: se3d_run_options */
    SE3D_LOG_MOVED = 10,     /* as START, which it replaces: a body by more than its size */
    SE3D_LOG_MODEL = 11,     /* a model file says what is probably a mistake */
    SE3D_LOG_BROKEN = 12     /* a joint broke: se3d_joint_set_break */
} se3d_log_kind;

/* Receives what happens to a system, one sentence a call: every message of a failure (ERROR);
 * starts that were projected, redundant constraints (WARNING); starts of driven motions and
 * assemblies that were moved, changes of method (INFO). It is called in the thread of the call that
 * works, never by two threads at a time; results do not depend on it. From within, the system may
 * be read as from a force callback (docs/api.md). The text is valid during the call only. @since
 * 0.1 */
typedef void (*se3d_log_callback)(void *ctx, se3d_log_level level, se3d_log_kind kind,
                                  const char *message);

#ifdef __cplusplus
}
#endif
#endif
