/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction and the multipliers that load it, at one instant. With the solution (x_0, l_0) of the
 * KKT system without these forces, and (X_k, L_k) for a unit force against the coordinate k, of
 * which there are few,
 *
 *     slip    n_k = +-mu_k N_k(l_0 + sum_j n_j L_j)          (limits are constant)
 *     hold    a_k(x_0 + sum_j n_j X_j) = 0
 *
 * is solved by Newton from n = 0, so that of several solutions it is the one that begins at mu = 0
 * (friction_newton.c). If there is none, friction jams. Elements at rest are decided on in
 * friction_decide.c.  docs/theory/friction.md */
#ifndef SE3DI_FRICTION_SYSTEM_H
#define SE3DI_FRICTION_SYSTEM_H

#include "assembly/assembly.h"

#define SE3DI_FRICTION_PROBES 5
#define SE3DI_FRICTION_LOOKS  2 /* is_rigid, where nothing is integrated: not to the last digit */

typedef struct se3di_friction_system {
    uint32_t count;    /* friction elements of the model */
    int32_t is_rigid;  /* what sticks holds by an acceleration of zero, not by its spring: 1, or */
    uint32_t *element; /* [count]: index of the force */
    uint32_t active;   /* unknowns: slip under a load, or hold */
    uint32_t reserved;
    uint32_t *unknown; /* [active]: index into element */
    int32_t *holds;    /* [count]: not 0: its acceleration is wanted zero */
    int32_t *rests;    /* [count], of the caller: to be decided */
    double *n;         /* [count]: force against the coordinate, beyond what forces hold already */
    double *centre;    /* [count]: sharing draws n to it, */
    double *share;     /* [count]: by this, relative to the leverage */
    double *kept;      /* [count]: n to come back to */
    double *Q;         /* [count * 16]: generalised force of a unit on bodies i and j */
    double *b, *c;     /* right-hand sides [unknowns], [rows] */
    double *x, *l;     /* without them */
    double *X, *L;     /* of units: [count * unknowns], [count * rows] */
    double *R;         /* [count * (count + 1) * PARTS]: reactions of l and of every L */
    double *a, *W;     /* accelerations of coordinates: without, and of units [count * count] */
    double *J, *f;     /* Newton: [count * count], [count] */
    int32_t *stays;    /* [count]: at rest at the limit of what it holds, as others hold it */
    int32_t *slides;   /* [count]: has begun to slip while it was decided on */
    int32_t *at;       /* [active]: -1, 1: at that limit */
    int32_t *fixed;    /* [active]: its force is not in question */
    double *limit;     /* [active]: of the force of those at rest */
    double *stiff;     /* [active]: sharing, in accelerations */
    double *guess;     /* [active]: forces under loads as they are */
    double *loaded;    /* [active]: forces which these follow from */
    double *P, *work;  /* of friction_box.h */
    double *work_x, *work_l; /* [unknowns], [rows] */
    double *probes;          /* [SE3DI_FRICTION_PROBES * 4 * count], of integrator/hold_review.h, */
    int32_t *machine;        /* [bodies]: the first body that it is joined to by any others; */
    int32_t *row_machine;    /* [rows]: that of what a row acts on, -1: nothing */
    int32_t *turns;          /* [bodies]: units of a machine that were counted */
    int32_t *turn;           /* [active]: of all units of its machine the how many-th */
    int32_t has_end;         /* 1: those of the end of the step are known */
} se3di_friction_system;

struct se3di_equations;

/* For the model of the equations; on failure nothing is held. */
se3d_status se3di_friction_system_init(se3di_friction_system *s, const se3di_assembly *assembly);
void se3di_friction_system_destroy(se3di_friction_system *s, const se3di_assembly *assembly);

/* Before forces are evaluated: elements give what does not depend on multipliers. */
void se3di_friction_system_begin(struct se3di_equations *equations);
/* After equations->x, l were solved for b, c with the present factorisation: with friction. The
 * elements know their loads, and what is held its force. @return what solving returned,
 * NO_CONVERGENCE (it jams) */
se3d_status se3di_friction_system_finish(struct se3di_equations *equations, double t);
/* Elements with rests[] not 0 are at rest: decide which stick and which begin to slip to where, by
 * their limits and accelerations, at a state whose equations are factored; what sticks is brought
 * to a stand. Clears rests[], also on failure. @return OK, NO_CONVERGENCE (it jams) */
se3d_status se3di_friction_system_decide(struct se3di_equations *equations, double t);

/* What sticks rigidly stands still again, at a state near that of the last _finish: what a step has
 * made of its rate is error. @return whether velocities had to change */
int se3di_friction_system_stand(struct se3di_equations *equations);

/* Record that friction jams. */
se3d_status se3di_friction_refuse(const struct se3di_equations *equations, double t);

/* The acceleration of the coordinate of an element (index into `element`) from equations->x. */
double se3di_friction_system_acceleration(const struct se3di_equations *equations, uint32_t k);

/* The sign of that of an element beyond rounding, after _finish: -1, 0 or 1; 0 for one that neither
 * holds nor slips under a load. */
int se3di_friction_system_moves(const struct se3di_equations *equations, uint32_t k);

/* Whether it has leverage on its own coordinate, after _finish. */
int se3di_friction_system_can_hold(const struct se3di_equations *equations, uint32_t k);

/* B (as C, transposed: what multipliers do to the bodies) += what they do by loading friction that
 * slips. @return whether anything does */
int se3di_frictions_add_columns(const se3di_assembly *assembly, const double *lambda, double *B);

/* Generalised force of a unit on the coordinate of an element, on bodies i and j; zero on fixed
 * ones. */
void se3di_friction_unit(const se3di_assembly *assembly, const se3di_force *force, double Q[16]);

#endif
