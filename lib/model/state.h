/* SPDX-License-Identifier: BSD-3-Clause */
/* User-defined states: numbers z with z' = f(t, signals), integrated with the motion.
 *
 * A state is the velocity of a carrier: a point of mass m that moves along x alone and that nothing
 * but m f acts on, so that every method, formulation and Newton matrix treats z as it treats
 * velocities. The carrier is a body of the model with `state` set, and f a force element of the
 * type STATE on it; both are the state's own and nobody sees them: neither counts, energies,
 * gravity, sizes that errors are measured by, modes, nor the public functions.
 * docs/theory/states.md */
#ifndef SE3DI_MODEL_STATE_H
#define SE3DI_MODEL_STATE_H

#include "model/model.h"

#include <math.h>

/* m [kg]: a power of two, so that m f / m is f to the bit, and so small that momenta of states do
 * not count where linear solvers measure residuals by the largest number. */
#define SE3DI_CARRIER_MASS 0x1p-40

/* Add a state with the value z: a carrier and its element. NO_MEMORY is the only failure. */
se3d_status se3di_model_add_state(se3di_model *model, const se3di_force *state, double z,
                                  se3di_handle *handle);
/* Remove one that has no users. */
void se3di_model_remove_state(se3di_model *model, uint32_t force);
/* Add a tyre, with a state made of `lag` for each slip that lags. NO_MEMORY is the only failure,
 * after which nothing is added. */
se3d_status se3di_model_add_tyre(se3di_model *model, const se3di_force *force,
                                 const se3di_force *lag, se3di_handle *handle);
/* Remove it, or any force element, with its states. */
void se3di_model_remove_tyre(se3di_model *model, uint32_t force);

/* Give it another function (SE3DI_FORCE_FUNCTIONS), -1: none. */
void se3di_model_set_state_function(se3di_model *model, uint32_t force, int place,
                                    int32_t function);
/* The bodies, force elements that are no states, in creation order: the dense index of number
 * `index`, SE3DI_NO_INDEX: there are not so many. */
uint32_t se3di_model_nth_body(const se3di_model *model, size_t index);
uint32_t se3di_model_nth_force(const se3di_model *model, size_t index);

/* Whether a body moves; those that carry states do if these are integrated. */
static inline int se3di_body_moves(const se3di_body *body, int moves_states)
{
    return !body->fixed && (moves_states || body->state == 0);
}

/* Its value now. */
static inline double se3di_state_value(const se3di_model *model, const se3di_force *state)
{
    return model->frames[state->body_j].v[0];
}

/* What changes of the value that a body carries are measured by: how large it has been. */
static inline double se3di_state_size(const se3di_model *model, uint32_t body)
{
    const se3di_force *state = &model->forces[model->bodies[body].state - 1];
    return fmax(fmax(state->rest, state->state[0]), fabs(model->frames[body].v[0]));
}

#endif
