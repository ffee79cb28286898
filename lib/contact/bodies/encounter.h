/* SPDX-License-Identifier: BSD-3-Clause */
/* One point where two bodies touch: velocities, forces and their derivatives.
 * docs/theory/body-contact.md */
#ifndef SE3DI_CONTACT_ENCOUNTER_H
#define SE3DI_CONTACT_ENCOUNTER_H

#include "contact/narrow/narrow.h"
#include "model/model.h"

#include <math.h>

typedef struct se3di_encounter {
    const se3di_model *model;
    const se3di_contact_point *at;
    const se3di_body_contact *memory; /* NULL: they did not touch at the last accepted state */
    uint32_t shape_i, shape_j, body[2];
    int32_t law;
    se3di_pair pair;
    double radius;              /* R* */
    double arm[2][3];           /* from the bodies' centres to the point */
    double w[2][3];             /* of the bodies, ground frame */
    double v[3], vn, vt[3];     /* of surface j relative to i at the point */
    double drift[3];            /* of that what surfaces move on their bodies, */
    double surface_w[2][3];     /* and how they turn there, ground frame */
    double elapsed;             /* since the state of what is remembered [s] */
    double lever[2][3];         /* arm x normal */
    double turned[2][3];        /* J^-1 lever, ground frame */
    double alone;               /* 1/m* of this point alone */
    double shared;              /* 1/m* among the points of its pair of shapes */
    double inverse_mass;        /* 1/m*: shared; with given steps, of the last accepted state */
    double root_mass;           /* sqrt(m*) */
    double s, root;             /* 1 or sqrt(R* overlap); sqrt(s) */
    double onset;               /* factor of the damping of a new contact */
    double xi[3];               /* stretch, in the tangent plane */
    double turn[3];             /* of j relative to i since the last accepted state, ground frame */
    double rho[3], twist;       /* rolling and torsion, lengths */
    double elastic, normal;     /* repulsive force without and with damping, >= 0 */
    double stick;               /* attraction of adhesion: 2 sqrt(Fc elastic) */
    double attraction;          /* that and cohesion, against the normal force */
    double pull[3];             /* -k xi - c vt */
    double bend[3], wring;      /* the same for rolling and torsion */
    double give, yield, slack;  /* factors <= 1 of Coulomb's caps on these */
    double force[3], moment[3]; /* on j */
    double spring[3];           /* a user-defined law: what it remembers */
    int32_t failed;             /* that law failed: there is no force */
    int32_t reserved;
} se3di_encounter;

/* A change of the poses or velocities of the two bodies, ground frame. */
typedef struct se3di_encounter_change {
    double r[2][3], turn[2][3]; /* displacements of the centres, rotations */
    double v[2][3], w[2][3];
} se3di_encounter_change;

/* R* of two round shapes in series; of two flat ones the smaller size. */
double se3di_shapes_contact_radius(const se3di_shape *i, const se3di_shape *j);

/* Begin an encounter of which model, at, memory, shape_i and shape_j are set: all but the forces.
 */
void se3di_encounter_place(se3di_encounter *e);
/* How much a point with the overlap `other` shares the load of one with the overlap `own`; of R* as
 * much is an overlap that shares nothing yet, nor its rounding; */
static inline double se3di_encounter_weight(double own, double other, double radius)
{
    const double faint = 1e-9;
    return fmin(other, own) / (own + faint * radius);
}
/* what 1/m* at least is of that of the point alone. */
#define SE3DI_SHARE_MIN 0.25
/* The effective masses of the points of one pair of shapes, which share the load. */
void se3di_encounter_share(se3di_encounter *points, uint32_t count);
/* The forces. */
void se3di_encounter_eval(se3di_encounter *e);
/* The stretch that is kept if the force was capped: if the damper pulls along with the spring, what
 * the cap holds of it, which so never pulls along the slip; if it pulls against the spring, that
 * with which both together are at the cap. Shortened by the factor of the force, it would be too
 * short by a part of what a step exceeds, another one in two halves of the step. */
void se3di_encounter_settle(double k, double cap, double factor, const double pull[3],
                            const double x[3], double out[3]);
/* Forces at the centres (ground frame) and torques (body frames) on i and j. */
void se3di_encounter_wrench(const se3di_encounter *e, double wrench[12]);
/* Of the tangential, rolling and torsional springs alone, as they would be remembered. */
void se3di_encounter_spring(const se3di_encounter *e, double wrench[12]);
/* d wrench / d (dr, dtheta) and / d (v, w), as those of force elements. */
void se3di_encounter_derivative(const se3di_encounter *e, double K[144], double D[144]);
/* encounter_callback.c: the same for a user-defined law. */
void se3di_encounter_call(se3di_encounter *e);
/* d force and d moment, by differences, along changes of what the law sees. */
typedef struct se3di_encounter_rates {
    double n[3], delta, vn, vt[3], spin[3], xi[3], inverse_mass, onset;
} se3di_encounter_rates;
void se3di_encounter_call_rate(const se3di_encounter *e, const se3di_encounter_rates *d,
                               double force[3], double moment[3]);
/* Energy in its springs; power that goes into it, to springs and lost; of that the part that what
 * moves the surfaces gives. */
double se3di_encounter_energy(const se3di_encounter *e);
double se3di_encounter_power(const se3di_encounter *e);
double se3di_encounter_fed(const se3di_encounter *e);
/* The place of a remembered mark from the centre of its body, ground frame. */
void se3di_encounter_anchor(const se3di_encounter *e, int k, double out[3]);
/* How surface j turns relative to i. */
void se3di_encounter_spin(const se3di_encounter *e, double spin[3]);
/* encounter_surface.c: the place to which one of a surface is carried in a time, body frame. */
void se3di_surface_carry(const se3di_shape *shape, double time, const double from[3], double to[3]);
/* Set e->drift and surface_w; d e->drift, tangential, and of the relative turning, along a change
 * of the point by `dp` and the normal by `dn`. */
void se3di_encounter_drift(se3di_encounter *e);
void se3di_encounter_drift_rate(const se3di_encounter *e, const se3di_encounter_change *change,
                                const double dp[3], const double dn[3], double drift[3],
                                double spin[3]);
/* encounter_unroll.c: move a mark of body k from where it is seen to where it were if the surface
 * that bends were unrolled into the tangent plane; d mark along a change, with the rotation `turn`
 * of the body and d of the normal, the point and the overlap; move a mark that is `way` off the
 * point in that plane onto the surface. */
void se3di_encounter_unroll(const se3di_encounter *e, int k, double mark[3]);
void se3di_encounter_unroll_rate(const se3di_encounter *e, int k, const double turn[3],
                                 const double dn[3], const double dp[3], double ddelta,
                                 const double mark[3], double dmark[3]);
void se3di_encounter_roll_up(const se3di_encounter *e, int k, const double way[3], double mark[3]);
/* How the two surfaces spin about the normal [rad/s]. */
void se3di_encounter_spins(const se3di_encounter *e, double spin[2]);
/* Add to the stretch what the spin makes of marks with this middle; add to dxi the derivative, with
 * d of the overlap, the normal, the point less the middle and the rotations, j less i. */
void se3di_encounter_wander(se3di_encounter *e, const double middle[3]);
void se3di_encounter_wander_rate(const se3di_encounter *e, const double middle[3], double ddelta,
                                 const double dn[3], const double dway[3], const double dturn[3],
                                 double dxi[3]);
/* J^-1 a of a body, ground frame; zero if it has no inertia. */
void se3di_encounter_turn_by(const se3di_body *body, const se3di_frame *frame, const double a[3],
                             double out[3]);
/* What is remembered of it; of one that has no forces yet, where it is alone. */
void se3di_encounter_record(const se3di_encounter *e, se3di_body_contact *record);
void se3di_encounter_record_place(const se3di_encounter *e, se3di_body_contact *record);

#endif
