/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction in a joint: its law, its memory, and the load that follows from the multipliers of the
 * same instant. docs/theory/friction.md */
#ifndef SE3DI_FORCE_FRICTION_H
#define SE3DI_FORCE_FRICTION_H

#include "force/force.h"

/* se3di_force.state */
enum {
    SE3DI_FRICTION_ANCHOR = 0,    /* x where it began to stick, or of the last accepted state */
    SE3DI_FRICTION_LOAD = 1,      /* see se3di_friction_load */
    SE3DI_FRICTION_MODE = 2,      /* -1, 0 (sticks), +1 */
    SE3DI_FRICTION_SET = 3,       /* not 0: it knows what it holds on to */
    SE3DI_FRICTION_STIFFNESS = 4, /* while it sticks; 0: rigidly */
    SE3DI_FRICTION_FORCE = 5,     /* n at the anchor */
    SE3DI_FRICTION_ENERGY = 6,    /* potential at the anchor */
    SE3DI_FRICTION_RATE = 7       /* of the last accepted state */
};

/* The reaction of the joint that loads it, on body j, ground frame: force perpendicular to the
 * axis, moment about the joint point perpendicular to the axis, force and moment along the axis.
 * Linear in the multipliers. */
#define SE3DI_FRICTION_PARTS 8
void se3di_friction_reaction(const se3di_model *model, const se3di_force *force,
                             const double *lambda, double R[SE3DI_FRICTION_PARTS]);
/* The same of a unit multiplier of each row of the joint: [row_count * SE3DI_FRICTION_PARTS]. */
void se3di_friction_reaction_rows(const se3di_model *model, const se3di_force *force, double *rows);
/* What mu multiplies: the load, on an angle times its arm. `gradient` (or NULL): to R. */
double se3di_friction_load(const se3di_model *model, const se3di_force *force,
                           const double R[SE3DI_FRICTION_PARTS],
                           double gradient[SE3DI_FRICTION_PARTS]);

static inline int se3di_friction_has_load(const se3di_force *force)
{
    return force->type == SE3DI_FORCE_FRICTION && force->mu_static > 0.0;
}

static inline int se3di_friction_sticks(const se3di_force *force)
{
    return !(force->state[SE3DI_FRICTION_MODE] > 0.0 || force->state[SE3DI_FRICTION_MODE] < 0.0);
}

/* What damps it while it sticks with a spring s [N s/m, N m s/rad], besides the viscous part. */
double se3di_friction_get_damper(const se3di_force *force, double s);
/* Hold on to x with n. */
void se3di_friction_anchor(se3di_force *force, double x, double n);
/* The loads of all elements follow from these multipliers [rows]. */
void se3di_frictions_take_loads(se3di_model *model, const double *lambda);
/* The state has moved a little since it was accepted: what slips goes with it. */
void se3di_friction_shift(const se3di_model *model, se3di_force *force);
/* It holds with n where it is, rigidly. */
void se3di_friction_hold(const se3di_model *model, se3di_force *force, double n);
/* It sticks without any force, whatever moves. */
void se3di_friction_silence(se3di_force *force);

#endif
