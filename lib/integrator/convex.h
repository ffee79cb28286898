/* SPDX-License-Identifier: BSD-3-Clause */
/* One step of the method convex, in parts. The velocities v at the end of a step of length h are
 * the optimum of a convex problem (Anitescu 2006, Todorov 2014, Castro et al. 2022),
 *
 *     min  1/2 (v - v*)^T M (v - v*) + sum over contacts l_n(v_n) + l_t(v_t),    C v = c
 *
 * with v* the velocities without contacts and constraints. A contact's impulse on body j is minus
 * the gradient of its cost, a function of the velocity (v_n, v_t) of j relative to i at the point:
 *
 *     p_n = h max(0, F(delta - h v_n) - d v_n)            F the law's spring at the end of the step
 *     p_t = y, or y bound/|y| if longer,   y = -h (k_t (xi + h v_t) + d_t v_t)
 *     bound = mu p_n, as it was in the iteration before: at the end of the iterations it is p_n's
 *
 * docs/theory/convex.md */
#ifndef SE3DI_INTEGRATOR_CONVEX_H
#define SE3DI_INTEGRATOR_CONVEX_H

#include "integrator/integrator.h"

/* How a contact acts in a step. */
enum {
    SE3DI_CONVEX_SPRING, /* by its law */
    SE3DI_CONVEX_IMPACT  /* an impact shorter than a few steps: p_n = max(0, d (rebound - v_n)) */
};

/* A point of contact in the step under way. */
typedef struct se3di_convex_contact {
    const se3di_body_contact *record; /* of the state that the step begins with */
    int32_t free[2];                  /* its bodies, -1: fixed */
    int32_t coupling;                 /* of the two, -1: one is fixed */
    int32_t way;                      /* SE3DI_CONVEX_ */
    double normal[3];
    double lever[2][9]; /* a turning of the body, in its frame, to the velocity of the point */
    double xi[3];       /* stretch of the spring that sticks */
    double overlap, stiffness, power; /* F = stiffness overlap^power */
    double damping, rebound;
    double tangential, drag;           /* k_t; -dy/dv_t */
    double friction, bound, wanted;    /* mu, the cap in use, that of p_n */
    double before[3], v[3], change[3]; /* velocity of the point: at the start, now, of the search */
    double impulse[3];                 /* on j */
} se3di_convex_contact;

typedef struct se3di_convex {
    se3di_convex_contact *contacts;
    size_t contact_count, contact_capacity;
    int32_t *pairs; /* couplings: free bodies i < j, increasing */
    size_t pair_count, pair_capacity;
    int32_t *kkt_pairs; /* those that the solver was made for */
    size_t kkt_pair_count, kkt_pair_capacity;
    se3di_kkt *kkt;
    double *body, *coupling; /* blocks of the matrix, 6 x 6 each */
    size_t body_capacity, coupling_capacity;
    double *work; /* vectors of unknowns and rows */
    size_t work_capacity;
    double *start;    /* velocities at the start of the step, */
    double *aim;      /* v*, */
    double *v;        /* v, */
    double *change;   /* and its change in an iteration [unknowns] */
    double *gradient; /* of the cost [unknowns] */
    double *moved;    /* M (v - v*) [unknowns] */
    double *carried;  /* M change [unknowns] */
    double *lambda;   /* impulses of constraints [rows] */
    double *aimed;    /* c [rows] */
    uint8_t *touched; /* [free bodies] a contact acts on it */
    size_t touched_capacity;
    double h;
    double momentum;           /* the larger of those of `start` and `aim`, by the mass: 2 T */
    uint64_t topology_version; /* that `kkt` was made for */
} se3di_convex;

void se3di_convex_destroy(se3di_convex *convex, const se3d_allocator *allocator);

/* convex_contacts.c: the contacts of the state that the step begins with; `start` and `aim` are
 * known. @return OK, NO_MEMORY, UNSUPPORTED */
se3d_status se3di_convex_collect(se3di_convex *c, const se3di_assembly *assembly,
                                 se3di_error *error);
/* The velocity of a point for velocities `v` [unknowns] of the bodies. */
void se3di_convex_velocity(const se3di_convex_contact *contact, const double *v, double out[3]);
/* The impulse at a velocity of the point, and minus its derivative [3 x 3]; `slope` may be NULL. */
void se3di_convex_impulse(const se3di_convex_contact *contact, double h, const double v[3],
                          double impulse[3], double *slope);
/* p_n. */
double se3di_convex_normal(const se3di_convex_contact *contact, double h, const double v[3]);
/* The impulse along contact->change, and minus its derivative that way. */
double se3di_convex_along(const se3di_convex_contact *contact, double h, const double v[3],
                          double *bend);
/* What the contacts that were found at the end of the step remember of it. */
void se3di_convex_record(const se3di_convex *c, se3di_model *model);
/* The work of all impulses on the bodies [J]. */
double se3di_convex_work(const se3di_convex *c);

/* convex_solve.c: v, lambda and the impulses. */
se3d_status se3di_convex_solve(se3di_convex *c, se3di_equations *equations);

#endif
