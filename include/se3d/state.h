/* SPDX-License-Identifier: BSD-3-Clause */
/* User-defined states: numbers z that a run integrates with the motion,
 *
 *     z' = f(t, s_1, s_2, ...),     y = g(t, s_1, s_2, ...),     u = h(t, s_1, s_2, ...)
 *
 * where the signals s are coordinates, positions and their rates, and states (SE3D_SIGNAL_STATE):
 * controllers, filters, actuators with a lag. An input u is a number that rate and output share, an
 * output y one that others take; both may depend on the motion at once. Laws of force elements may
 * depend on states, and rates on the motion. Every method integrates them to its order and with its
 * control of errors, implicit ones with exact Jacobians. Snapshots, clones and hashes hold them.
 * They are neither bodies nor force elements: no count, energy or index of those knows them.
 * Equilibria, modes, kinematics and inverse dynamics leave states as they are; batches and joint
 * coordinates have none.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_STATE_H
#define SE3D_STATE_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The definition of a state. @since 0.1 */
typedef struct se3d_state_def {
    size_t struct_size;
    const char *name;     /* copied; unique among states and force elements; NULL: none */
    se3d_function rate;   /* f [unit of z/s], of time and of signals; null: z stays as it is */
    se3d_function output; /* y, of time and of signals; null: z */
    se3d_function input;  /* u, of time and of signals; null: 0 */
    double initial;       /* z when a run begins [unit of z], default 0 */
    double size; /* > 0; errors are measured by the largest |z| so far, and at least by this
                           [unit of z]; default 1e-3 */
} se3d_state_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_state_def_default. @since 0.1 */
SE3D_API void se3d_state_def_init(se3d_state_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_state_def se3d_state_def_default(void)
{
    se3d_state_def def;
    se3d_state_def_init(&def, sizeof def);
    return def;
}

/* Create a state. A rate that depends on the state itself is given afterwards, by
 * se3d_state_set_rate. @return OK, NULL, INVALID_ARGUMENT, STALE_HANDLE, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_state_create(se3d_system *system, const se3d_state_def *def,
                                       se3d_state *state);

/* Give a state another rate.
 * @param[in] rate  [unit of z/s], of time and of signals; null: it stays as it is
 * @return OK, NULL, INVALID_ARGUMENT, STALE_HANDLE. @since 0.1 */
SE3D_API se3d_status se3d_state_set_rate(se3d_system *system, se3d_state state, se3d_function rate);

/* Give a state another output.
 * @param[in] output  of time and of signals; null: its value
 * @return OK, NULL, INVALID_ARGUMENT (also if it depends on itself), STALE_HANDLE, IN_USE (the rate
 * of a driver depends on it). @since 0.1 */
SE3D_API se3d_status se3d_state_set_output(se3d_system *system, se3d_state state,
                                           se3d_function output);

/* Give a state another input.
 * @param[in] input  of time and of signals; null: 0
 * @return OK, NULL, INVALID_ARGUMENT (also if it depends on itself), STALE_HANDLE, IN_USE (the rate
 * of a driver depends on it). @since 0.1 */
SE3D_API se3d_status se3d_state_set_input(se3d_system *system, se3d_state state,
                                          se3d_function input);

/* Give a state another size, by which its errors are measured: see se3d_state_def.
 * @param[in] size  > 0 [unit of z]
 * @return OK, NULL, INVALID_ARGUMENT, STALE_HANDLE. @since 0.1 */
SE3D_API se3d_status se3d_state_set_size(se3d_system *system, se3d_state state, double size);

/* Destroy a state. A function with its value among the signals goes first.
 * @return OK, NULL, STALE_HANDLE, IN_USE. @since 0.1 */
SE3D_API se3d_status se3d_state_destroy(se3d_system *system, se3d_state state);

/* Find a state by its name.
 * @param[in] name  as in its definition
 * @return OK, NULL, INVALID_ARGUMENT (no such state). @since 0.1 */
SE3D_API se3d_status se3d_state_find(const se3d_system *system, const char *name,
                                     se3d_state *state);

/* Count the states. @return 0 if `system` is NULL. @since 0.1 */
SE3D_API size_t se3d_system_count_states(const se3d_system *system);

/* Get a state of a system, in the order of creation.
 * @param[in] index  from 0, below se3d_system_count_states
 * @return OK, NULL, INVALID_ARGUMENT (index). @since 0.1 */
SE3D_API se3d_status se3d_system_get_state(const se3d_system *system, size_t index,
                                           se3d_state *state);

/* Get the name of a state.
 * @param[out] name  "" if it has none; valid until the system is edited
 * @return OK, NULL, STALE_HANDLE. @since 0.1 */
SE3D_API se3d_status se3d_state_get_name(const se3d_system *system, se3d_state state,
                                         const char **name);

/* Get the definition of a state, whose initial value is the present one. Set def->struct_size
 * before the call.
 * @param[out] def  its name is valid until the system is edited; NULL: none
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (struct_size, or the slip of a tyre).
 * @since 0.1 */
SE3D_API se3d_status se3d_state_get_def(const se3d_system *system, se3d_state state,
                                        se3d_state_def *def);

/* Set the value of a state: a jump between steps, or another start.
 * @param[in] value  [unit of z]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT. @since 0.1 */
SE3D_API se3d_status se3d_state_set_value(se3d_system *system, se3d_state state, double value);

/* Get the value of a state, its output or its input in the present state of the system.
 * @param[in] part    se3d_state_part
 * @param[out] value  [unit of z, y or u]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (part), NOT_FINITE, SINGULAR, CALLBACK.
 * @since 0.1 */
SE3D_API se3d_status se3d_state_get_value(const se3d_system *system, se3d_state state, int32_t part,
                                          double *value);

/* Get the rate of a state in the present state of the system.
 * @param[out] rate  z' [unit of z/s]
 * @return OK, NULL, STALE_HANDLE, NOT_FINITE, SINGULAR, CALLBACK. @since 0.1 */
SE3D_API se3d_status se3d_state_get_rate(const se3d_system *system, se3d_state state, double *rate);

#ifdef __cplusplus
}
#endif
#endif
