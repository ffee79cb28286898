/* SPDX-License-Identifier: BSD-3-Clause */
/* One step of the method convex, in parts. The velocities v at the end of a step of length h are
 * the optimum of a convex problem (Anitescu 2006, Todorov 2014, Castro et al. 2022),
 *
 *     min  1/2 (v - v*)^T M (v - v*) + sum over contacts l_n(v_n) + l_t(v_t),    C v = c
 *
 * with v* the velocities without contacts and constraints. A contact's impulse on body j is minus
 * the gradient of its cost, a function of the velocity (v_n, v_t) of j relative to i at the point:
 *
 *     p_n = h max(0, F(delta - l v_n) - d v_n)            F the law's spring, l <= h on
 *     p_t = y, or y bound/|y| if longer,   y = -h (k_t (xi + h v_t) + d_t v_t)
 *     bound = mu p_n, as it was in the iteration before: at the end of the iterations it is p_n's
 *
 * docs/theory/convex.md */
#ifndef SE3DI_INTEGRATOR_CONVEX_H
#define SE3DI_INTEGRATOR_CONVEX_H

#include "contact/bodies/encounter.h"
#include "integrator/integrator.h"
#include "linsol/block_cg.h"
#include "math/elementary.h"
#include "math/vec3.h"

/* How a contact acts in a step. */
enum {
    SE3DI_CONVEX_SPRING,   /* by its law */
    SE3DI_CONVEX_IMPACT,   /* an impact shorter than a few steps: p_n = max(0, d (rebound - v_n)) */
    SE3DI_CONVEX_TRACED,   /* an impact whose impulse is known: p_n = rise, p_t = -xi */
    SE3DI_CONVEX_FRICTION, /* of a joint: |rise - steepness v_n| <= bound, plus d (rebound - v_n) */
    SE3DI_CONVEX_ROLL      /* rolling and torsion of a contact: the same without d along n, p_t */
};

/* A point of contact in the step under way. What the passes over all contacts of an island need
 * comes first, and what they need together stands together. */
typedef struct se3di_convex_contact {
    int32_t free[2];    /* its bodies, -1: fixed; while a step is solved their places */
    int32_t coupling;   /* of the two, -1: one is fixed */
    int32_t way;        /* SE3DI_CONVEX_ */
    int32_t upper;      /* 1: a stop at the upper end of a range */
    int32_t partner;    /* of rolling: the contact of shapes; of that: its rolling, -1: none */
    int32_t is_short;   /* it is over in too few steps to be followed */
    int32_t is_held;    /* it goes on, among what constraints hold */
    double lever[2][9]; /* of the body, in its frame, from its turning to the point's velocity */
    double reach;       /* 1; of turning 0: the body's own velocity does not count */
    double v[3], change[3];           /* velocity of the point: now, of the search */
    double normal[3], xi[3];          /* from i to j; stretch of the spring that sticks */
    double overlap, stiffness, power; /* F = stiffness overlap^power */
    double attraction;                /* impulse against the normal that caps do not see */
    double damping, rebound;
    double lead;                    /* a spring is that at the overlap so much later */
    double tangential, drag, bound; /* k_t; -dy/dv_t; the cap in use */
    double impulse[3];              /* on j */
    double slope[9];                /* minus its derivative, that which the matrix has */
    double drift[3];                /* velocity of surface j on its body less that of i, */
    double ahead[3]; /* of that what it does not have at the start, but half a step on, */
    double shift[3]; /* and what the point will have moved to half a step on */
    double friction;
    double share[2];        /* of rolling: of the cap, across n and along it */
    double rise, steepness; /* p_n = rise - steepness v_n, if it is linear */
    double response[2];     /* of the velocity to an impulse: along the normal; at most across it */
    double answer[9]; /* of a law that is linear to what is missing of its impulse, if it sticks */
    double wanted;    /* the cap of p_n, */
    double wanted_before, gap; /* at the last look; wanted - bound */
    double before[3];          /* velocity of the point at the start, */
    double chord[3];  /* and what the chord before had there more, across the constraints */
    double arm[2][3]; /* from the bodies to the point, ground frame */
    double held;      /* energy of its springs at the start of the step */
    const se3di_body_contact *record; /* of the state that the step begins with; NULL: a stop */
    const se3di_force *element;       /* or friction, this one; */
    double towards; /* a stop's coordinate was accelerated so in the step before */
} se3di_convex_contact;

/* Bodies that contacts, stops and constraints connect: a problem of its own. */
typedef struct se3di_convex_island {
    size_t body, body_end;       /* places */
    size_t contact, contact_end; /* of `order` */
    size_t pair, pair_end;
    size_t joint, joint_end; /* places of constraints; none: it is free of them */
    size_t row, row_end;     /* of theirs */
    size_t begin, link;      /* where it begins in se3di_convex_rows, */
    size_t value;            /* also in C */
    se3di_kkt *kkt;          /* of an island with constraints */
    int is_factored;         /* its matrix of masses and constraints, without contacts */
    int is_traced;           /* nothing acts but impacts whose impulses are known */
    double gain;             /* energy that the step itself gave [J] */
    double momentum;         /* the larger of those of `start` and `aim`, by the mass: 2 T */
    int32_t is_struck;       /* something in it was an impact, see convex_control.c */
    int32_t reserved;
} se3di_convex_island;

/* Constraints, island by island, see convex_rows.c. Bodies count from the first of the island. */
typedef struct se3di_convex_solver se3di_convex_solver;
typedef struct se3di_convex_rows {
    int32_t *joint;         /* [places] of the model */
    int32_t *count;         /* [places]: rows */
    int32_t *begin;         /* [places, and one more of each island]: of their bodies, from 0 */
    int32_t *body;          /* [links] */
    double *C;              /* blocks of 6 columns: of each link of a constraint */
    double *lambda, *aimed; /* as those of the assembly */
    int32_t *key;           /* the pattern of an island */
    se3di_convex_solver *solvers; /* [free bodies]: of the island that begins with it */
    size_t joint_capacity, count_capacity, begin_capacity, body_capacity, C_capacity,
        lambda_capacity, aimed_capacity, key_capacity, solver_capacity;
    uint64_t topology_version, break_version; /* that the solvers were made for */
} se3di_convex_rows;

typedef struct se3di_convex {
    se3di_convex_contact *contacts;
    size_t contact_count, contact_capacity;
    size_t shape_count; /* of these: the first ones are of shapes, */
    size_t roll_end;    /* from there to here they are rolling, */
    size_t stop_end;    /* to here stops, then friction */
    int32_t *pairs;     /* couplings: free bodies i < j, increasing */
    size_t pair_count, pair_capacity;
    se3di_convex_rows rows;
    size_t joint_count;      /* constraints that take part */
    se3di_block_cg cg;       /* of islands without constraints */
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
    double *chord;    /* of the step before, less `start` [unknowns] */
    double *lambda;   /* impulses of constraints [rows] */
    double *aimed;    /* c [rows] */
    double *recoil;   /* what they have taken of the chord of the step before [rows] */
    double *push;     /* of the impulses, less that of the records at the end [6 * bodies] */
    uint8_t *touched; /* [free bodies] a contact acts on it */
    size_t touched_capacity;
    /* Bodies have places in which each island's follow each other; vectors of the solver are in
     * that order, `start`, `aim` and, in the end, `v` are not. */
    se3di_convex_island *islands;
    size_t island_count, island_capacity;
    int32_t *place;   /* [free bodies] */
    int32_t *body_at; /* [places]: the free body */
    int32_t *root;    /* [free bodies]: the first body of its island */
    int32_t *number;  /* [free bodies]: of its island; -1: it is not solved for */
    int32_t *order;   /* [contacts]: island by island */
    int32_t *stirred; /* [free bodies], by places: the last sweep that changed its velocity */
    double *mobility; /* [10 * free bodies], by places: 1/m, J^-1 */
    double *own;      /* blocks of the mass of bodies alone, by places, 6 x 6 each; */
    double *mass;     /* of all mass: with what turns with coordinates (armatures), or `own`; */
    double *tie;      /* and what armatures couple, of `pairs` */
    double
        *spin; /* [6 * free bodies], by places: the w that the step begins with, h w x J w in use */
    size_t place_capacity, body_at_capacity, root_capacity, number_capacity, order_capacity,
        mobility_capacity, own_capacity, spin_capacity, stirred_capacity, geared_capacity,
        tie_capacity;
    double *geared; /* room of `mass` */
    /* What sleeps, see convex_sleep.c: */
    uint8_t *asleep; /* [free bodies], */
    uint8_t *linked; /* [free bodies]: a constraint or an element acts on it, */
    uint8_t *drifts; /* [free bodies]: nothing touches its machine, see convex_islands.c, */
    uint8_t *urged;  /* [free bodies]: one of these may move it though it is at rest, */
    uint8_t *frozen; /* [bodies]: asleep or fixed */
    int32_t *nest;   /* [free bodies] */
    double *reach;   /* [free bodies]: of its shapes */
    size_t sleep_capacity, nest_capacity, reach_capacity;
    size_t asleep_count;
    int is_bound; /* a constraint may act on what is awake */
    /* Contacts that are followed, see convex_follow.c: */
    double *marks; /* [6 * contacts of the list] */
    se3di_body_contact *followed;
    size_t followed_count, mark_capacity, followed_capacity;
    double *lawful; /* [contacts at the end]: the energy of their springs by their laws */
    size_t lawful_capacity;
    size_t changed;     /* slopes of contacts since the preconditioner was made */
    size_t drifting;    /* free bodies */
    int32_t sleeps;     /* it is wanted */
    int32_t controls;   /* errors are controlled, see convex_control.c: */
    se3di_frame *ended; /* [free bodies]: where the whole step has led to, */
    uint8_t *struck;    /* [free bodies], behind it: in an island with an impact */
    size_t ended_capacity;
    int32_t is_beside; /* shapes touch in this island */
    double gravity[3]; /* at the start of the step */
    double h;
    size_t reacts;    /* iterations in this island that lambda is of */
    int32_t recoils;  /* `recoil` is known */
    int32_t may_part; /* the step may be taken in halves */
    double gripped;   /* energy that friction of joints holds at the start of the step [J] */
    const se3di_model *model;
    double driven; /* in the step, by constraints that change in time [J] */
} se3di_convex;

void se3di_convex_destroy(se3di_convex *convex, const se3d_allocator *allocator);

/* convex_contacts.c: the contacts of the state that the step begins with; `start` and `aim` are
 * known. @return OK, NO_MEMORY, UNSUPPORTED */
se3d_status se3di_convex_collect(se3di_convex *c, const se3di_assembly *assembly,
                                 se3di_error *error);
/* The velocity of a point for velocities `v` [unknowns] of the bodies, */
static inline void se3di_convex_velocity(const se3di_convex_contact *contact, const double *v,
                                         double out[3])
{
    double sum[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < 2; ++k) {
        if (contact->free[k] >= 0) {
            const double *body = v + 6 * (size_t)contact->free[k];
            double turning[3];
            se3di_mul(contact->lever[k], body + 3, turning);
            se3di_add_scaled(contact->reach, body, turning);
            se3di_add_scaled(k ? 1.0 : -1.0, turning, sum);
        }
    }
    se3di_copy(sum, out);
}
/* with that of surfaces on them. */
static inline void se3di_convex_slip(const se3di_convex_contact *contact, const double *v,
                                     double out[3])
{
    se3di_convex_velocity(contact, v, out);
    se3di_add(out, contact->drift, out);
    se3di_add(out, contact->shift, out);
}
/* How fast the two surfaces approach at the start of the step, as the point wanders. */
static inline double se3di_convex_approach(const se3di_convex_contact *contact)
{
    return se3di_dot(contact->shift, contact->normal) - se3di_dot(contact->before, contact->normal);
}
/* out [unknowns] += scale J^T p, J from velocities of the bodies to that of the point. */
static inline void se3di_convex_press(const se3di_convex_contact *contact, double scale,
                                      const double p[3], double *out)
{
    for (int k = 0; k < 2; ++k) {
        if (contact->free[k] >= 0) {
            double *body = out + 6 * (size_t)contact->free[k], turning[3];
            const double sign = k ? scale : -scale;
            se3di_mul_transposed(contact->lever[k], p, turning);
            se3di_add_scaled(sign * contact->reach, p, body);
            se3di_add_scaled(sign, turning, body + 3);
        }
    }
}
/* A body without constraints, by place, less what an impulse on it [6] makes of its velocity. */
static inline void se3di_convex_let_go(const se3di_convex *c, size_t body, const double p[6])
{
    const double *mobility = c->mobility + 10 * body;
    double *v = c->v + 6 * body, turned[3];
    se3di_mul(mobility + 1, p + 3, turned);
    se3di_add_scaled(-mobility[0], p, v);
    se3di_sub(v + 3, turned, v + 3);
}
/* The impulse at a velocity of the point, and minus its derivative [3 x 3]; `slope` may be NULL. */
void se3di_convex_impulse(const se3di_convex_contact *contact, double h, const double v[3],
                          double impulse[3], double *slope);
/* p_n and -dp_n/dv_n at a velocity along the normal. */
double se3di_convex_normal(const se3di_convex_contact *contact, double h, double vn, double *slope);
/* The impulse along contact->change, and minus its derivative that way. */
double se3di_convex_along(const se3di_convex_contact *contact, double h, const double v[3],
                          double *bend);
/* Whether a contact of this stiffness is over in too few steps to be followed. */
int se3di_convex_is_short(double k, double inverse_mass, double h);
/* How much later the spring of one that is followed is taken: it is damped by `lead` times k, which
 * of what lasts n steps costs the part (lead/h) pi^2/2n of the speed. What nothing moves is at the
 * end of the step. */
double se3di_convex_lead_of(double k, double inverse_mass, double h);
/* The part of a damper that the velocity of half a step before has, where it is that of the start:
 * half of it, or so much as does not turn this velocity round. */
double se3di_convex_before(double damper, double inverse_mass, double h);
/* What an impulse along j does to the velocity along i, which have the same bodies, if nothing else
 * holds these. */
double se3di_convex_move_alone(const se3di_convex *c, const se3di_convex_contact *i,
                               const se3di_convex_contact *j);
/* What the materials of a contact make of its law, of which the stretch may be. */
void se3di_convex_set_law(se3di_convex_contact *contact, const se3di_model *model);
/* Its attraction in a step of length h for an approach u: that at the start of the step, or in its
 * middle if it is no short one. */
void se3di_convex_set_attraction(se3di_convex_contact *contact, const se3di_model *model, double h,
                                 double u);
/* How it acts by response[0] and what loads make of `start` without it; by its law, if it can be
 * followed at an approach u, which it cannot if it is over soon. */
void se3di_convex_choose_contact(const se3di_convex *c, se3di_convex_contact *contact,
                                 const double *start, const double *aim);
void se3di_convex_follow_law(se3di_convex_contact *contact, const se3di_model *model, double h,
                             double u, double inverse_mass);
int se3di_convex_is_over_soon(const se3di_convex_contact *contact, double inverse_mass, double h,
                              double u);
/* No impact of one step: it rests. */
void se3di_convex_let_rest(const se3di_convex *c, se3di_convex_contact *contact);
/* R* of a contact of shapes. */
static inline double se3di_convex_radius(const se3di_model *model, const se3di_body_contact *r)
{
    return se3di_shapes_contact_radius(&model->shapes[r->shape_i], &model->shapes[r->shape_j]);
}
/* The overlap of a Hertzian spring, k sqrt(R), that meets an approach u. */
static inline double se3di_convex_hertz_depth(double k, double inverse_mass, double u)
{
    return u > 0.0 ? se3di_pow(1.25 * u * u / (inverse_mass * k), 0.4) : 0.0;
}
/* A law's damper less what the step damps by itself, if it has as much: what nothing moves, or is
 * hardly damped, keeps it. */
static inline double se3di_convex_ease(double damper, double own)
{
    return damper < own ? damper : damper - own;
}
/* What the contacts that were found at the end of the step remember of it. */
void se3di_convex_record(const se3di_convex *c, se3di_model *model);
/* A stretch turns about the normal by the mean of what the two surfaces do in a step. */
static inline void se3di_convex_turn_stretch(const se3di_model *model, const se3di_body_contact *r,
                                             double h, double xi[3])
{
    double spin = 0.0, across[3];
    for (int k = 0; k < 2; ++k) {
        const se3di_shape *s = &model->shapes[k ? r->shape_j : r->shape_i];
        const se3di_frame *frame = &model->frames[s->body];
        double w[3];
        se3di_add(frame->w, s->surface_spin, w);
        se3di_mul(frame->A, w, w);
        spin += 0.5 * se3di_dot(w, r->normal);
    }
    se3di_cross(r->normal, xi, across);
    se3di_add_scaled(h * spin, across, xi);
}
/* Lists of contacts are in the order of their pairs of shapes. */
static inline int se3di_convex_is_before(const se3di_body_contact *a, const se3di_body_contact *b)
{
    return a->shape_i < b->shape_i || (a->shape_i == b->shape_i && a->shape_j < b->shape_j);
}

/* convex_roll.c: rolling and torsion of the contacts of shapes, behind these; @return OK, NO_MEMORY
 */
se3d_status se3di_convex_collect_rolling(se3di_convex *c, const se3di_assembly *assembly,
                                         se3di_error *error);
/* as the contact acts; */
void se3di_convex_choose_rolling(se3di_convex *c, const se3di_convex_contact *contact);
/* room for `more` contacts; */
se3d_status se3di_convex_reserve(se3di_convex *c, const se3di_assembly *assembly, size_t more,
                                 se3di_error *error);
/* of a contact of shapes: torque += the moment on j in the step; what is remembered; the energy
 * that its springs hold [J]. */
void se3di_convex_add_moment(const se3di_convex *c, const se3di_convex_contact *contact,
                             const se3di_model *model, double torque[3]);
void se3di_convex_record_rolling(const se3di_convex *c, const se3di_convex_contact *contact,
                                 se3di_body_contact *r);
double se3di_convex_roll_energy(const se3di_model *model, const se3di_body_contact *r);
/* The cap of an impulse across the normal. */
static inline double se3di_convex_cap(const se3di_convex_contact *contact)
{
    return contact->way == SE3DI_CONVEX_ROLL ? contact->share[0] * contact->bound : contact->bound;
}

/* convex_stick.c: the attraction at an overlap [N]; what it has given to get there [J]; the speed
 * of what leaves that came at u. */
double se3di_convex_attraction(const se3di_pair *pair, double radius, double delta);
double se3di_convex_stuck(const se3di_model *model, const se3di_body_contact *r);
double se3di_convex_leave(const se3di_model *model, const se3di_body_contact *r, double e,
                          double u);

/* convex_stops.c: what a stop may act on in a step from the state under way does not drift; */
void se3di_convex_mark_stops(const se3di_convex *c, const se3di_assembly *assembly);
/* stops become contacts behind those of shapes. @return OK, NO_MEMORY */
se3d_status se3di_convex_collect_stops(se3di_convex *c, const se3di_assembly *assembly,
                                       se3di_error *error);
/* a contact along a coordinate whose gradient is `g`, times `way`; 0 if both bodies are fixed; */
int se3di_convex_set_row(se3di_convex *c, const se3di_assembly *assembly, const double g[12],
                         double way, se3di_convex_contact *contact);
/* whether it is so near that it matters how it acts, and how it acts on what an impulse along it
 * moves so, g W g^T on the constraints; */
int se3di_convex_stop_is_near(const se3di_convex_contact *stop, double h);
void se3di_convex_choose_stop(const se3di_convex *c, se3di_convex_contact *stop,
                              double inverse_mass);
/* the power that the laws of stops and friction dissipate at the state; */
double se3di_convex_apart_power(const se3di_model *model);
/* what they took from the bodies in the step and do not hold at its end [J]. */
double se3di_convex_stopped(const se3di_convex *c, const se3di_model *model);

/* convex_friction.c: friction of joints at the start of a step, behind stops; @return OK, NO_MEMORY
 */
se3d_status se3di_convex_collect_friction(se3di_convex *c, const se3di_assembly *assembly,
                                          se3di_error *error);
/* how it acts on what an impulse along it moves so; */
void se3di_convex_choose_friction(const se3di_convex *c, se3di_convex_contact *contact,
                                  double inverse_mass);
/* the most that it holds or slips with, by the multipliers that are known: what is wanted next;
 * whether it needs no other iteration, all momentum being as much as `momentum`; */
int se3di_convex_look(const se3di_convex *c, se3di_convex_contact *contact, double momentum);
/* whether what slips would do so with another cap by far, though caps have followed enough; */
int se3di_convex_jams(const se3di_convex *c, const se3di_convex_island *island);
/* whether a load is to be known at all; what elements remember of the step; */
int se3di_convex_has_loads(const se3di_convex *c);
void se3di_convex_accept_friction(const se3di_convex *c, const se3di_assembly *assembly);
/* the energy that they hold; what they took from the bodies in the step and do not hold [J]. */
double se3di_convex_grip_energy(const se3di_convex *c, const se3di_assembly *assembly);
double se3di_convex_rubbed(const se3di_convex *c, const se3di_assembly *assembly);

/* convex_energy.c: what an impulse takes from the bodies in a step [J]; what all on shapes and the
 * step itself do; the work of what moves the surfaces on their bodies. */
double se3di_convex_taken_by(const se3di_convex_contact *contact);
double se3di_convex_work(const se3di_convex *c, const se3di_assembly *assembly);
double se3di_convex_fed(const se3di_convex *c);
/* Contacts of an island that give energy are slowed down. Returns whether any are; */
int se3di_convex_tame(const se3di_convex *c, const se3di_convex_island *island);
/* Whether the step itself, whose velocities are those of the state and whose mean ones and rates of
 * constraints are in `change` and `aimed`, gives what constraints join energy by far; */
int se3di_convex_gains(const se3di_convex *c, const se3di_assembly *assembly);
/* The energy that the springs of the contacts hold at the start of the step; */
void se3di_convex_hold(const se3di_convex *c, const se3di_model *model);
/* those of the contacts that were found at the end of the step, after `taken` [J] was taken
 * from the bodies: no more than they held before and that. @return OK, NO_MEMORY */
se3d_status se3di_convex_store(se3di_convex *c, const se3di_assembly *assembly, double taken,
                               se3di_error *error);

/* convex_jam.c: what is driven against something that cannot give way goes by its law. Returns
 * whether anything did not. */
int se3di_convex_free_jams(const se3di_convex *c, const se3di_convex_island *island);

/* convex_gyration.c: w that a torque [N m] makes of w0 in h, all in the frame of the body; */
void se3di_convex_turn_freely(const double J[9], const double w0[3], const double torque[3],
                              double h, double w[3]);
/* the moments for v*; */
void se3di_convex_gyrate_begin(se3di_convex *c, const se3di_assembly *assembly);
/* they follow v, if they are not near already, and M (v - v*) with them; */
void se3di_convex_gyrate(se3di_convex *c, const se3di_convex_island *island);
/* what the moment takes from a free body in the step [J]. */
double se3di_convex_gyration_work(const se3di_convex *c, uint32_t body);

/* convex_islands.c: what drifts in the step under way: machines that nothing touches, loads and
 * constraints of which act in the middle of the step; @return OK, NO_MEMORY */
se3d_status se3di_convex_find_drifting(se3di_convex *c, const se3di_assembly *assembly,
                                       se3di_error *error);
/* places of bodies, islands, couplings of their bodies. @return OK, NO_MEMORY */
se3d_status se3di_convex_group(se3di_convex *c, const se3di_assembly *assembly);
/* of what armatures couple, which of `pairs` it is; -1: it is not solved for. */
int32_t se3di_convex_find_tie(const se3di_convex *c, const se3di_assembly *assembly, uint32_t tie);

/* convex_mass.c: the masses of what takes part, with armatures; @return OK, NO_MEMORY */
se3d_status se3di_convex_place_mass(se3di_convex *c, const se3di_assembly *assembly);
/* out = M x of an island, by places; by bodies alone; */
void se3di_convex_mul_mass(const se3di_convex *c, const se3di_convex_island *island,
                           const double *x, double *out);
void se3di_convex_mul_own(const se3di_convex *c, const se3di_convex_island *island, const double *x,
                          double *out);
/* `coupling` of an island as the mass has it. */
void se3di_convex_clear_couplings(se3di_convex *c, const se3di_convex_island *island);
/* A matrix of an island, whose bodies count from 0; without any pair of bodies there are no arrays
 * of them. */
static inline se3di_block_matrix se3di_convex_matrix_of(const se3di_convex *c,
                                                        const se3di_convex_island *island,
                                                        const double *body, const double *coupling)
{
    const int has_pairs = island->pair_end > island->pair;
    return (se3di_block_matrix){.count = island->body_end - island->body,
                                .first = (int32_t)island->body,
                                .pair_count = island->pair_end - island->pair,
                                .pairs = has_pairs ? c->pairs + 2 * island->pair : NULL,
                                .diagonal = body + 36 * island->body,
                                .coupling = has_pairs ? coupling + 36 * island->pair : NULL};
}

/* The blocks of its equations, with `body` on the diagonal. */
static inline se3di_kkt_values
se3di_convex_values_of(const se3di_convex *c, const se3di_convex_island *island, const double *body)
{
    const se3di_block_matrix A = se3di_convex_matrix_of(c, island, c->body, c->coupling);
    return (se3di_kkt_values){.body = body + 36 * island->body,
                              .coupling_upper = A.coupling,
                              .joint = c->rows.C + island->value};
}

/* convex_rows.c: a body of a constraint that acts in steps; -1: it does not, or on none; */
int32_t se3di_convex_joined(const se3di_assembly *assembly, uint32_t joint);
/* the constraints of each island; @return OK, NO_MEMORY */
se3d_status se3di_convex_share_rows(se3di_convex *c, const se3di_assembly *assembly);
/* the solver of an island; @return OK, NO_MEMORY */
se3d_status se3di_convex_suit_solver(se3di_convex *c, const se3di_assembly *assembly,
                                     se3di_convex_island *island);
/* out [unknowns, by places] += C^T lambda; */
void se3di_convex_add_reactions(const se3di_convex *c, const se3di_convex_island *island,
                                double *out);
/* lambda of an island in the order of the assembly. */
void se3di_convex_take_back_rows(const se3di_convex *c, const se3di_assembly *assembly,
                                 const se3di_convex_island *island, double *out);
void se3di_convex_rows_destroy(se3di_convex_rows *rows, const se3d_allocator *allocator);

/* convex_impact.c: impacts that are followed within the step, */
#define SE3DI_CONVEX_TRACED_MOST 8                              /* points, */
#define SE3DI_CONVEX_TRACED_ROWS (2 * SE3DI_CONVEX_TRACED_MOST) /* then their rolling */
typedef struct se3di_convex_traced {
    se3di_convex_contact *contacts[SE3DI_CONVEX_TRACED_ROWS];
    int count, points;
    /* what an impulse at the second makes of the velocity of the first */
    double W[SE3DI_CONVEX_TRACED_ROWS][SE3DI_CONVEX_TRACED_ROWS][9];
} se3di_convex_traced;
/* those of an island, 1 if they are all that acts there; */
int se3di_convex_may_trace(se3di_convex *c, const se3di_convex_island *island,
                           se3di_convex_traced *traced);
/* their impulses. Returns 1 if they are known. */
int se3di_convex_trace(const se3di_convex *c, se3di_convex_traced *traced,
                       const se3di_model *model);

/* convex_sweep.c: velocities near the optimum of an island without constraints, from v*, by the
 * impulses of one contact after the other. Returns 1 if they hardly changed. */
int se3di_convex_sweep(se3di_convex *c, const se3di_convex_island *island);
/* From v and impulses of which `gradient` is not balanced. */
void se3di_convex_relax(se3di_convex *c, const se3di_convex_island *island);
/* The velocity at which a contact's law gives the impulse that it would have if all others stayed
 * as they are with `impulse` and v; the cap of its friction there. Returns how much the impulse
 * would change. */
double se3di_convex_foresee(const se3di_convex *c, se3di_convex_contact *contact, double ahead[3]);
/* Whether it is solved for: something touches it, or a constraint acts on it. */
static inline int se3di_convex_takes_part(const se3di_convex *c, size_t body)
{
    return c->number[body] >= 0;
}
static inline int se3di_convex_is_bound(const se3di_convex_island *island)
{
    return island->joint_end > island->joint;
}
/* contact by contact, as `c->order` says */
static inline se3di_convex_contact *se3di_convex_at(const se3di_convex *c, size_t k)
{
    return &c->contacts[c->order[k]];
}

/* convex_sleep.c: room, and what may sleep at all. @return OK, NO_MEMORY */
se3d_status se3di_convex_bed(se3di_convex *c, const se3di_assembly *assembly);
/* What sleeps in a step from here, after what touches it has woken it. */
void se3di_convex_wake(se3di_convex *c, const se3di_assembly *assembly);
/* What sleeps is where it was before the step; whether an element acts on it. */
void se3di_convex_stay(const se3di_convex *c, se3di_equations *equations);
int se3di_convex_element_sleeps(const se3di_convex *c, const se3di_assembly *assembly,
                                const se3di_force *force);
/* Nothing changes in a step. */
int se3di_convex_rests(const se3di_convex *c, const se3di_assembly *assembly);
/* Islands that have been at rest for long enough fall asleep at the end of a step. */
void se3di_convex_doze(se3di_convex *c, const se3di_assembly *assembly);

/* convex_control.c: doubles of the history: length of the last step; how long each body rests; what
 * constraints took from v, w at its end; if errors are controlled, the length of the next step; */
size_t se3di_convex_history_count(const se3di_assembly *assembly);
/* the smallest tolerance, if one is asked for; */
double se3di_convex_get_reach(const se3di_integration *integration, const se3di_model *model);
/* steps of at most `most` to t_end or to an event, each by `step`, to its end. */
typedef se3d_status (*se3di_convex_stepper)(se3di_integration *integration, double t1);
se3d_status se3di_convex_control(se3di_integration *integration, se3di_convex_stepper step,
                                 double t_end, double most);

/* convex_follow.c: what is to be known of contacts at the start of a step; @return OK, NO_MEMORY */
se3d_status se3di_convex_mark(se3di_convex *c, const se3di_assembly *assembly);
/* those that are known at its end. */
void se3di_convex_follow(se3di_convex *c, const se3di_model *model);

/* convex_ways.c: how all contacts of an island act, before its velocities are found. */
void se3di_convex_choose_ways(se3di_convex *c, se3di_equations *equations,
                              se3di_convex_island *island);

/* convex_solve.c: v, lambda and the impulses. */
se3d_status se3di_convex_solve(se3di_convex *c, se3di_equations *equations);

#endif
