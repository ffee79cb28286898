/* SPDX-License-Identifier: BSD-3-Clause */
/* Force elements: what they do to the bodies, one file per type, each with the same function.
 *
 * A wrench is a force at the centre of mass in the ground frame [N] and a torque in the body frame
 * [N m]: 6 numbers per body. An element acts on two bodies, i and j: its wrench has 12 numbers and
 * its Jacobians are 12 x 12 (row-major), to the virtual displacements (dr, dtheta: rotations in the
 * body frame, A -> A exp(tilde(dtheta))) and to the velocities (v ground, w body frame).
 * docs/theory/energy.md */
#ifndef SE3DI_FORCE_H
#define SE3DI_FORCE_H

#include "model/model.h"

/* Outputs and inputs of states that laws have asked for at one state of the model and time, so that
 * each is evaluated once however many laws ask; zero before. What has no room is evaluated again.
 */
#define SE3DI_LAW_NOTES 8

typedef struct se3di_law_notes {
    const se3di_function *function[SE3DI_LAW_NOTES];
    double value[SE3DI_LAW_NOTES];
    int32_t count, reserved;
} se3di_law_notes;

/* An element at the state of the model. */
typedef struct se3di_effect {
    double wrench[12];
    double potential;         /* [J] */
    double power[2];          /* dissipated, fed in by an actuator or load [W] */
    double coordinate, rate;  /* of springs, friction and stops */
    double value;             /* force against the coordinate: f [N] or n [N m] */
    double slope[2];          /* of n in wrench = -n g: to the coordinate, to its rate */
    se3di_law_notes *notes;   /* of the evaluation; NULL: none */
    int32_t wants_derivative; /* set by the caller: K and D are computed */
    double K[144];            /* d wrench / d (dr, dtheta) */
    double D[144];            /* d wrench / d (v, w) */
} se3di_effect;

/* Evaluate one element. `effect` needs no initialisation but wants_derivative. @return OK, SINGULAR
 * (the points of a tsda with a free length coincide), NOT_FINITE, CALLBACK */
se3d_status se3di_force_eval(const se3di_model *model, const se3di_force *force, double t,
                             se3di_effect *effect);

/* The same as one of several elements at a state, which share `notes`; NULL: none. */
se3d_status se3di_force_eval_with(const se3di_model *model, const se3di_force *force, double t,
                                  se3di_law_notes *notes, se3di_effect *effect);

/* Say which element has failed with `status`; `failed`: its number, or that of elements: gravity.
 * @return status */
se3d_status se3di_force_fail(const se3di_model *model, uint32_t failed, se3d_status status,
                             double t, se3di_error *error);

/* The potential of one element [J], without what else `eval` makes, if its type can. @return the
 * same */
se3d_status se3di_force_potential(const se3di_model *model, const se3di_force *force, double t,
                                  double *potential);

/* What a type of elements may be. */
enum {
    SE3DI_FORCE_IS_SCALAR = 1,  /* acts on one coordinate: effect->coordinate, rate, value */
    SE3DI_FORCE_IS_ELASTIC = 2, /* its K and D make frequencies and decay rates */
    SE3DI_FORCE_HOLDS = 4       /* may hold a body in space as a joint does */
};

#define SE3DI_FORCE_LEFT ((se3d_status)1)

/* A type of elements: one in each file of the folder. */
typedef struct se3di_force_class {
    const char *name; /* as in the model file */
    /* `effect` comes zeroed but for wants_derivative. @return as se3di_force_eval */
    se3d_status (*eval)(const se3di_model *model, const se3di_force *force, double t,
                        se3di_effect *effect);
    /* The potential alone, the same bits; NULL, or where it returns LEFT: that of `eval`. */
    se3d_status (*find_potential)(const se3di_model *model, const se3di_force *force, double t,
                                  double *potential);
    /* The state of the model is accepted; NULL: the type has no memory. */
    void (*accept)(const se3di_model *model, se3di_force *force);
    /* Compare what it assumed of a trial step with what came out, correct it. @return whether it
     * changed; NULL: it assumes nothing */
    uint32_t (*revise)(const se3di_model *model, se3di_force *force);
    uint32_t traits;
} se3di_force_class;

#define SE3DI_FORCE_DECLARE(TYPE, name) extern const se3di_force_class se3di_force_class_##name;
SE3DI_FORCE_LIST(SE3DI_FORCE_DECLARE)
#undef SE3DI_FORCE_DECLARE

/* The class of an element. */
const se3di_force_class *se3di_force_class_of(const se3di_force *force);

/* Gravity at t and its rate (NULL: not wanted). */
se3d_status se3di_gravity_eval(const se3di_model *model, double t, double g[3], double *g_t);

/* What gravity and all elements do together. An effort that is a number may act along a coordinate
 * instead of on bodies; its power is left to the caller. */
typedef struct se3di_force_sums {
    double *wrench;       /* [bodies * 6] */
    double power[2];      /* dissipated, fed in, as of an effect; gravity that changes included */
    const int32_t *along; /* [elements] the coordinate of each, -1: none; NULL: of none */
    double *effort;       /* [coordinates] takes them; zero before */
    uint32_t failed;      /* on failure: the element (the count of elements: gravity) */
    int32_t has_efforts;  /* `effort` has them already: their values are others by now */
} se3di_force_sums;

se3d_status se3di_forces_sum(const se3di_model *model, double t, se3di_force_sums *sums);

/* What the energy of a callback changes by [W], and the energies of all callbacks [J]: power[1] of
 * its effect lacks the rate, so that works lack the energy. @return OK, CALLBACK, NOT_FINITE */
se3d_status se3di_callback_energy_rate(const se3di_model *model, const se3di_force *force, double t,
                                       double *rate);
se3d_status se3di_callbacks_energy(const se3di_model *model, double t, double *potential);

/* Wrenches of gravity and all elements on all bodies, [bodies * 6]; *failed as above. */
se3d_status se3di_forces_eval(const se3di_model *model, double t, double *wrench, uint32_t *failed);
/* Whether an element is an effort that needs nothing but its number. */
int se3di_force_is_number(const se3di_force *force);
/* A stop or friction that is a contact of the step under way, no element. */
static inline int se3di_force_is_apart(const se3di_model *model, const se3di_force *force)
{
    return model->steps_apart &&
           (force->type == SE3DI_FORCE_STOP || force->type == SE3DI_FORCE_FRICTION);
}

/* Elements with a memory (friction, stops). After a trial step from the last accepted state:
 * compare what they assumed with what came out, correct it and return how many changed; the step is
 * repeated until none does. */
uint32_t se3di_forces_revise(se3di_model *model);
/* The state of the model is accepted. */
void se3di_forces_accept(se3di_model *model);
/* Whether a state before the end of the last accepted step is shown (1): what acts on it is as it
 * was on the way there. What elements remember of the end is kept, to the bit. */
void se3di_forces_show(se3di_model *model, int is_before_end);
/* What is shown is the last accepted state: of an end after it nothing is remembered. */
void se3di_forces_stay(se3di_model *model);
/* Some element has a memory. */
int se3di_forces_have_memory(const se3di_model *model);

/* The largest force while it sticks, or slips. */
double se3di_friction_limit(const se3di_force *force, int slips);
/* Slower than this [m/s, rad/s] a coordinate is at rest when a run begins. */
#define SE3DI_FRICTION_REST 1e-8
/* The force against the coordinate without its viscous part; and remember that it is n, sticking
 * (mode 0) or slipping. */
double se3di_friction_get(const se3di_model *model, const se3di_force *force);
void se3di_friction_set(const se3di_model *model, se3di_force *force, double mode, double n);
/* It holds on to where it is, unless it does so already: it slips if it moves. */
void se3di_friction_begin(const se3di_model *model, se3di_force *force);
/* All stops take the present speed for that of an impact to come. */
void se3di_stops_accept(se3di_model *model);

#endif
