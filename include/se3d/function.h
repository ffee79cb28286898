/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions of time (drivers) and of a force element's variables (actuators).
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_FUNCTION_H
#define SE3D_FUNCTION_H

#include "se3d/expression.h"
#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The most variables of a function. @since 0.1 */
#define SE3D_FUNCTION_VARIABLES_MAX 16

/* Compute a function of x[0..variable_count): jet = {value, d/dx0, d2/dx0^2}; gradient (NULL or
 * [variable_count]) = first derivatives. It must be a pure function of x: methods keep and
 * interpolate what it gave. A value that changes between steps is a constant with
 * se3d_function_set_constant; if it cannot be, call se3d_system_touch after every change. Numbers
 * that are not finite end the analysis with NOT_FINITE, unless a shorter step avoids them.
 * @return OK, or a negative status: the analysis ends with CALLBACK. @since 0.1 */
typedef se3d_status (*se3d_function_callback)(void *ctx, const double *x, double jet[3],
                                              double *gradient);

/* What a number of the state may be. @since 0.1 */
typedef enum se3d_signal_kind {
    SE3D_SIGNAL_JOINT_COORDINATE = 1, /* of `joint`; `component`: se3d_joint_coordinate [rad, m] */
    SE3D_SIGNAL_JOINT_RATE = 2,       /* its rate [rad/s, m/s] */
    SE3D_SIGNAL_FORCE_COORDINATE = 3, /* of `force`: length of a tsda, angle of an rsda, what a
                                         friction, stop or effort acts along [m, rad] */
    SE3D_SIGNAL_FORCE_RATE = 4,       /* its rate [m/s, rad/s] */
    SE3D_SIGNAL_POINT_POSITION = 5,   /* of `point` of `body`, `component` 0 ... 2: x, y, z in the
                                         ground frame [m] */
    SE3D_SIGNAL_POINT_VELOCITY = 6,   /* its velocity [m/s] */
    SE3D_SIGNAL_ANGULAR_VELOCITY = 7, /* of `body`, body frame, `component` 0 ... 2 [rad/s] */
    SE3D_SIGNAL_ORIENTATION = 8,      /* of `body`, `component` 0 ... 3: Euler parameter */
    SE3D_SIGNAL_STATE = 9 /* of `state`, `component` se3d_state_part: value, output, input
                                         (se3d/state.h) */
} se3d_signal_kind;

/* What a state gives. @since 0.1 */
typedef enum se3d_state_part {
    SE3D_STATE_VALUE = 0,  /* z */
    SE3D_STATE_OUTPUT = 1, /* y, its output; z if it has none */
    SE3D_STATE_INPUT = 2   /* u, its input; 0 if it has none */
} se3d_state_part;

/* A number of the state that a function depends on: a coordinate, a position, or a rate of one.
 * Members that the kind does not name are not looked at. @since 0.1 */
typedef struct se3d_signal {
    int32_t kind;          /* se3d_signal_kind */
    int32_t component;     /* which of its numbers */
    se3d_body body;        /* of a point, an angular velocity, an orientation */
    se3d_constraint joint; /* of a coordinate, or its rate */
    se3d_force force;      /* of a coordinate, or its rate */
    double point[3];       /* body frame [m] */
    se3d_state state;      /* whose value, output or input it is */
} se3d_signal;

/* Curves through the points of a table. @since 0.1 */
typedef enum se3d_table_kind {
    SE3D_TABLE_CUBIC = 0,  /* cubic spline: two continuous derivatives; natural, or periodic */
    SE3D_TABLE_LINEAR = 1, /* straight lines: the rate jumps at the points, so that it cannot be the
                              value of a driver, constraint or coupler, but a rate of one */
    SE3D_TABLE_AKIMA = 2   /* Akima (1970): one continuous derivative, without overshoot of flat
                              parts; the second one jumps at the points */
} se3d_table_kind;

/* The definition of a function: exactly one of `expression`, `compiled`, `callback`, a table, or
 * the constant. @since 0.1 */
typedef struct se3d_function_def {
    size_t struct_size;
    const char *expression;                /* text, copied; NULL: not an expression */
    const char *const *variables;          /* [variable_count] names of x; NULL: {"t"} */
    size_t variable_count;                 /* default 1, at most SE3D_FUNCTION_VARIABLES_MAX */
    const se3d_expression_symbol *symbols; /* [symbol_count] of the expression */
    size_t symbol_count;                   /* default 0 */
    se3d_function_callback callback;       /* NULL: not a callback */
    void *ctx;                             /* of `callback` */
    const double
        *table_x; /* [table_count] of x[0], increasing; a curve through the points, copied */
    const double *table_y;           /* [table_count] values */
    size_t table_count;              /* at least 2 */
    double constant;                 /* [any unit], used if nothing else is given */
    const se3d_expression *compiled; /* copied; as `expression`, of variable_count variables */
    const se3d_signal *signals; /* [signal_count] numbers of the state, copied: the last variables
                                   of the function, which may only be the law of a force element (h,
                                   function), the rate of a state, or the value of a driver. Its
                                   elements live as long as it. */
    size_t signal_count;        /* default 0, at most variable_count */
    int32_t integrate; /* 1: what is given above is the rate f; the function is the integral F(t) =
                          start + integral of f over the time from start_time to t, with the exact
                          rate and acceleration. Of one variable, without signals; of an
                          expression or callback up to 1e6 s from start_time. */
    int32_t reserved;
    double start;           /* F(start_time) [m, rad] */
    double start_time;      /* [s], default 0 */
    int32_t table_kind;     /* se3d_table_kind, default CUBIC */
    int32_t table_periodic; /* 1: it repeats, the last point is the first one a period later; at
                               least 3 points. Default 0: straight outside */
} se3d_function_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_function_def_default. @since 0.1 */
SE3D_API void se3d_function_def_init(se3d_function_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_function_def se3d_function_def_default(void)
{
    se3d_function_def def;
    se3d_function_def_init(&def, sizeof def);
    return def;
}

/* Create a function. @return OK, NULL, INVALID_ARGUMENT, EXPRESSION (the message has the
 * column), STALE_HANDLE (of a signal), NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_function_create(se3d_system *system, const se3d_function_def *def,
                                          se3d_function *function);

/* Create a function of time.
 * @param[in] text  an expression in `t`, the time [s]
 * @return OK, NULL, INVALID_ARGUMENT, EXPRESSION (the message has the column), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_function_create_expression(se3d_system *system, const char *text,
                                                     se3d_function *function);

/* Change the value of a constant between steps. The handle stays, and the next step begins with the
 * new value. If it prescribes a coordinate, that step begins with a state that meets it, with the
 * same velocity: a jump. If the function is the integral of a constant, this is its rate from the
 * present time on; the position goes on from where it is, and the velocity jumps.
 * @param[in] value  [unit of what the function is used for]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (not finite, or the function is not a constant).
 * @since 0.1 */
SE3D_API se3d_status se3d_function_set_constant(se3d_system *system, se3d_function function,
                                                double value);

/* Get the definition of a function. An expression is given as `compiled`. Set def->struct_size
 * before the call.
 * @param[out] def  its arrays and its expression are valid until the system is edited; its
 *                  `signals` are NULL: se3d_function_get_signal gives them one by one
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_function_get_def(const se3d_system *system, se3d_function function,
                                           se3d_function_def *def);

/* Get a number of the state that a function depends on.
 * @param[in] k        from 0, below the signal_count of its definition
 * @param[out] signal  what it is
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (k).
 * @since 0.1 */
SE3D_API se3d_status se3d_function_get_signal(const se3d_system *system, se3d_function function,
                                              size_t k, se3d_signal *signal);

/* Count the functions of a system. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_system_count_functions(const se3d_system *system);

/* Get a function of a system, in the order of creation.
 * @param[in] index  from 0, below se3d_system_count_functions
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_function(const se3d_system *system, size_t index,
                                              se3d_function *function);

/* Destroy a function. @return OK, NULL, STALE_HANDLE, IN_USE. @since 0.1 */
SE3D_API se3d_status se3d_function_destroy(se3d_system *system, se3d_function function);

/* Compute a function with its first two derivatives with respect to variable 0. Outside the range
 * of a table the curve goes on as a straight line, or repeats.
 * @param[in] x     [variable_count] the variables
 * @param[out] jet  [3] value, first and second derivative [any unit]; in no frame
 * @return OK, NULL, STALE_HANDLE, NOT_FINITE, CALLBACK.
 * @since 0.1 */
SE3D_API se3d_status se3d_function_eval(const se3d_system *system, se3d_function function,
                                        const double *x, double jet[3]);

#ifdef __cplusplus
}
#endif
#endif
