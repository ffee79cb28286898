/* SPDX-License-Identifier: BSD-3-Clause */
/* Impacts at few points, beside which nothing rests, follow the laws of their contacts within the
 * step, on arms and normals that stay:
 *
 *     delta' = -v_n,    xi' = v_t, no longer than friction holds,    v_i' = sum W_ij F_j
 *
 * with W_ij what an impulse at point j makes of the velocity of point i, from where the first of
 * them touched until all part (leapfrog). A slip so turns round within an impact, and what a corner
 * does to another comes before or after what that does, as their laws have it. What the forces add
 * up to are the impulses of the step.                                 docs/theory/convex.md */
#include "integrator/convex.h"

#include "contact/bodies/law.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define STEPS_MOST 4000
#define GIVES      1e-6 /* of the response of a point whose bodies nothing holds */
#define GAIN_MOST  0.05 /* of what impulses take from approaches */
#define LIGHT      0.02 /* of the speed of an impact: what rests may come out with */
#define PHASE      0.15 /* of the fastest swing of all springs together, in a step */

typedef struct point {
    const se3di_convex_contact *contact;
    const se3di_pair *pair;
    double radius;    /* R* */
    double root_mass; /* sqrt(m*) of now */
    double delta, xi[3], v[3];
    double impulse[3];
    double normal;         /* force of now that presses, */
    double attraction;     /* and attracts; */
    double drawn;          /* the impulse of that */
    struct point *presser; /* of rolling: whose force caps it; NULL: it is no rolling */
} point;

typedef struct tracing {
    const se3di_convex_traced *traced;
    point points[SE3DI_CONVEX_TRACED_ROWS];
    /* what an impulse along the second normal makes of the velocity along the first one, of bodies
     * by themselves; 0 for points of other shapes */
    double alone[SE3DI_CONVEX_TRACED_ROWS][SE3DI_CONVEX_TRACED_ROWS];
    int count;
} tracing;

/* W_ij, [3 x 3]. */
static const double *block_of(const tracing *t, int i, int j)
{
    return t->traced->W[i][j];
}

/* A step that follows the stiffest swing of all springs together, of the greatest overlap that any
 * of the approaches can make. */
static double step_of(const tracing *t)
{
    double rate2 = 0.0, speed = 0.0;
    for (int k = 0; k < t->traced->points; ++k) {
        speed = fmax(speed, se3di_norm(t->points[k].v));
    }
    for (int k = 0; k < t->count; ++k) {
        const point *p = &t->points[k];
        const ptrdiff_t at = p->presser ? p->presser - t->points : k;
        const double *W = block_of(t, k, k);
        const double kn = p->pair->kn;
        const int hertz = se3di_pair_is_hertz(p->pair);
        const double s = hertz ? sqrt(p->radius * se3di_convex_hertz_depth(kn * sqrt(p->radius),
                                                                           t->alone[at][at], speed))
                               : 1.0;
        const double kt = se3di_pair_kt(p->pair, s);
        const double stiffest =
            p->presser ? se3di_pair_kr(p->pair, s) : fmax(kn * (hertz ? 1.5 : 1.0) * s, kt);
        rate2 += stiffest * (W[0] + W[4] + W[8]);
    }
    return PHASE / sqrt(rate2);
}

/* The law of rolling and torsion, whose stretch is along the normal. */
static void roll_by_law(const point *p, double xi[3], double force[3])
{
    const double *n = p->contact->normal, normal = p->presser->normal;
    const double s =
        se3di_pair_is_hertz(p->pair) ? sqrt(p->radius * fmax(0.0, p->presser->delta)) : 1.0;
    const double k = se3di_pair_kr(p->pair, s);
    const double damping = p->pair->dr * p->presser->root_mass * sqrt(se3di_pair_turn(p->pair, s));
    double stretch[2][3];
    se3di_scale(se3di_dot(xi, n), n, stretch[0]);
    se3di_sub(xi, stretch[0], stretch[1]);
    memset(force, 0, 3 * sizeof *force);
    memset(xi, 0, 3 * sizeof *xi);
    for (int part = 0; part < 2 && normal > 0.0; ++part) {
        const double cap = (part ? p->pair->rolling : p->pair->torsion) * normal;
        const double along = se3di_dot(p->v, n);
        double pull[3], settled[3];
        se3di_scale(-k, stretch[part], pull);
        se3di_add_scaled(part ? -damping : 0.0, p->v, pull);
        se3di_add_scaled(part ? damping * along : -damping * along, n, pull);
        const double size = se3di_norm(pull), factor = size > cap ? cap / size : 1.0;
        se3di_encounter_settle(k, cap, factor, pull, stretch[part], settled);
        se3di_add(xi, settled, xi);
        se3di_add_scaled(factor, pull, force);
    }
}

/* The law: the force on j, and what friction leaves of a stretch xi. Returns whether they press. */
static int press_by_law(point *p, double xi[3], double force[3])
{
    if (p->presser) {
        roll_by_law(p, xi, force);
        return 0;
    }
    const double *n = p->contact->normal, vn = se3di_dot(p->v, n);
    const double s = se3di_pair_is_hertz(p->pair) ? sqrt(p->radius * fmax(0.0, p->delta)) : 1.0;
    const double root = p->root_mass * sqrt(s), kt = se3di_pair_kt(p->pair, s);
    const double normal = p->pair->kn * s * p->delta - p->pair->dn * root * vn;
    double pull[3];
    memset(force, 0, 3 * sizeof *force);
    p->attraction = se3di_convex_attraction(p->pair, p->radius, p->delta);
    p->normal = p->delta > 0.0 ? fmax(0.0, normal) : 0.0;
    if (!(p->normal > 0.0)) {
        memset(xi, 0, 3 * sizeof *xi);
        se3di_scale(-p->attraction, n, force);
        return p->attraction > 0.0;
    }
    for (int k = 0; k < 3; ++k) {
        pull[k] = -kt * xi[k] - p->pair->dt * root * (p->v[k] - vn * n[k]);
    }
    const double size = se3di_norm(pull), cap = p->pair->friction * normal;
    const double factor = size > cap ? cap / size : 1.0;
    se3di_encounter_settle(kt, cap, factor, pull, xi, xi);
    se3di_scale(factor, pull, force);
    se3di_add_scaled(normal - p->attraction, n, force);
    return 1;
}

/* Points by a time with the velocities that they have. */
static void approach(tracing *t, double time)
{
    for (int k = 0; k < t->count; ++k) {
        point *p = &t->points[k];
        const double *n = p->contact->normal, vn = se3di_dot(p->v, n);
        p->delta -= time * vn;
        se3di_add_scaled(time, p->v, p->xi);
        se3di_add_scaled(p->presser ? 0.0 : -time * vn, n, p->xi);
    }
}

/* Points of the same shapes share the load; joints do not count in the law. */
static void share(tracing *t)
{
    for (int i = 0; i < t->traced->points; ++i) {
        point *p = &t->points[i];
        double sum = t->alone[i][i];
        for (int j = 0; j < t->traced->points && p->delta > 0.0; ++j) {
            const double other = fmax(0.0, t->points[j].delta);
            sum +=
                i == j ? 0.0 : t->alone[i][j] * se3di_encounter_weight(p->delta, other, p->radius);
        }
        p->root_mass = 1.0 / sqrt(fmax(sum, SE3DI_SHARE_MIN * t->alone[i][i]));
    }
}

/* Impulses of the forces of now in a time. Returns whether any press. */
static int find_impulses(tracing *t, double time, double impulse[][3], int is_expected)
{
    int presses = 0;
    for (int k = 0; k < t->count; ++k) {
        point *p = &t->points[k];
        double xi[3];
        se3di_copy(p->xi, xi);
        presses |= press_by_law(p, xi, impulse[k]);
        se3di_scale(time, impulse[k], impulse[k]);
        if (!is_expected) {
            p->drawn += time * p->attraction;
            se3di_copy(xi, p->xi);
        }
    }
    return presses;
}

/* v += scale W p */
static void push(tracing *t, double scale, double impulse[][3])
{
    for (int i = 0; i < t->count; ++i) {
        for (int j = 0; j < t->count; ++j) {
            double change[3];
            se3di_mul(block_of(t, i, j), impulse[j], change);
            se3di_add_scaled(scale, change, t->points[i].v);
        }
    }
}

/* A step of the leapfrog, whose forces take the velocities to be expected in its middle. Returns
 * whether any press there. */
static int advance(tracing *t, double h)
{
    double impulse[SE3DI_CONVEX_TRACED_ROWS][3];
    double before[SE3DI_CONVEX_TRACED_ROWS][3];
    approach(t, 0.5 * h);
    share(t);
    for (int k = 0; k < t->count; ++k) {
        se3di_copy(t->points[k].v, before[k]);
    }
    (void)find_impulses(t, 0.5 * h, impulse, 1);
    push(t, 1.0, impulse);
    const int presses = find_impulses(t, h, impulse, 0);
    for (int k = 0; k < t->count; ++k) {
        se3di_copy(before[k], t->points[k].v);
        se3di_add(t->points[k].impulse, impulse[k], t->points[k].impulse);
    }
    push(t, 1.0, impulse);
    approach(t, 0.5 * h);
    return presses;
}

/* The time until the next two touch that do not yet, HUGE_VAL if none come nearer. */
static double time_to_touch(const tracing *t)
{
    double time = HUGE_VAL;
    for (int k = 0; k < t->traced->points; ++k) {
        const point *p = &t->points[k];
        const double speed = -se3di_dot(p->v, p->contact->normal);
        if (speed > 0.0) {
            time = fmin(time, fmax(0.0, -p->delta) / speed);
        }
    }
    return time;
}

/* To where all part. Returns whether they do. */
static int trace(tracing *t)
{
    const double h = step_of(t);
    for (int k = 0; k < STEPS_MOST; ++k) {
        if (!advance(t, h)) {
            const double time = time_to_touch(t);
            if (!(time < HUGE_VAL)) {
                return 1;
            }
            approach(t, time);
        }
    }
    return 0;
}

/* Points that attraction did not let go rest. */
static void let_stick(const tracing *t, const se3di_convex *c)
{
    for (int k = 0; k < t->traced->points; ++k) {
        if (t->points[k].attraction > 0.0) {
            se3di_convex_let_rest(c, t->traced->contacts[k]);
        }
    }
}

/* Whether it begins now; what parts from an impact before may only touch again. */
static int meets(const se3di_convex_contact *contact)
{
    return contact->way == SE3DI_CONVEX_IMPACT && contact->rebound > 0.0;
}

/* The speed at which it would come out of the overlap that it rests in. */
static double speed_of_rest(const se3di_convex_contact *contact)
{
    const double delta = contact->record->overlap;
    const double k = contact->stiffness * (contact->power > 1.0 ? sqrt(delta) : 1.0);
    return delta * sqrt(k * contact->record->inverse_mass);
}

int se3di_convex_may_trace(se3di_convex *c, const se3di_convex_island *island,
                           se3di_convex_traced *traced)
{
    double speed = 0.0, rest = 0.0;
    traced->count = traced->points = 0;
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        se3di_convex_contact *contact = se3di_convex_at(c, k);
        if (contact->way == SE3DI_CONVEX_ROLL) { /* of a point before */
            traced->contacts[traced->count++] = contact;
            continue;
        }
        if (contact->way == SE3DI_CONVEX_FRICTION ||
            (!contact->record && !se3di_convex_stop_is_near(contact, c->h))) {
            continue;
        }
        if (!contact->record || traced->points == SE3DI_CONVEX_TRACED_MOST) {
            return 0;
        }
        if (meets(contact)) {
            speed = fmax(speed, -se3di_dot(contact->before, contact->normal));
        } else if (contact->way == SE3DI_CONVEX_SPRING) {
            rest = fmax(rest, speed_of_rest(contact));
        }
        traced->contacts[traced->count++] = contact;
        ++traced->points;
    }
    return speed > 0.0 && rest <= LIGHT * speed;
}

/* The point that presses where something rolls; NULL: it is no rolling. */
static point *presser_of(tracing *t, const se3di_convex *c, const se3di_convex_contact *row)
{
    for (int k = 0; k < t->traced->points && row->way == SE3DI_CONVEX_ROLL; ++k) {
        if (t->traced->contacts[k] == &c->contacts[row->partner]) {
            return &t->points[k];
        }
    }
    return NULL;
}

/* The state in which the first of them touched. */
static void begin(tracing *t, const se3di_convex *c, const se3di_model *model)
{
    double since = 0.0;
    for (int k = 0; k < t->count; ++k) {
        const se3di_convex_contact *contact = t->traced->contacts[k];
        point *presser = presser_of(t, c, contact);
        const se3di_body_contact *record = presser ? presser->contact->record : contact->record;
        t->points[k] = (point){.contact = contact,
                               .presser = presser,
                               .pair = se3di_pair_of(model, record->shape_i, record->shape_j),
                               .radius = se3di_convex_radius(model, record)};
        se3di_copy(contact->before, t->points[k].v);
        if (meets(contact)) {
            since = fmax(since, -record->overlap / se3di_dot(contact->before, contact->normal));
        }
    }
    for (int k = 0; k < t->traced->points; ++k) {
        point *p = &t->points[k];
        const double overlap = p->contact->record->overlap;
        if (meets(p->contact)) {
            p->delta = fmin(0.0, overlap + since * se3di_dot(p->v, p->contact->normal));
        } else if (p->contact->way == SE3DI_CONVEX_SPRING) {
            p->delta = overlap;
        }
    }
}

/* Whether all points give way along their normals: what is driven there takes any impulse. */
static int give_way(const tracing *t)
{
    for (int k = 0; k < t->traced->points; ++k) {
        const double *n = t->points[k].contact->normal;
        double turned[3];
        se3di_mul(block_of(t, k, k), n, turned);
        if (!(se3di_dot(turned, n) > GIVES * t->alone[k][k])) {
            return 0;
        }
    }
    return 1;
}

/* Whether the impulses give no more energy than laws may: those of Hertz do a little. */
static int is_sound(const tracing *t)
{
    double given = 0.0, all = 0.0;
    for (int k = 0; k < t->count; ++k) {
        const point *p = &t->points[k];
        const double before = se3di_dot(p->impulse, p->contact->before);
        given += 0.5 * (before + se3di_dot(p->impulse, p->v));
        all += fabs(before);
    }
    return given <= GAIN_MOST * all; /* not if it is not a number */
}

int se3di_convex_trace(const se3di_convex *c, se3di_convex_traced *traced, const se3di_model *model)
{
    tracing t = {.traced = traced, .count = traced->count};
    begin(&t, c, model);
    for (int k = 0; k < traced->points * traced->points; ++k) {
        const int i = k / traced->points, j = k % traced->points;
        const se3di_convex_contact *one = traced->contacts[i], *two = traced->contacts[j];
        const int is_pair = one->record->shape_i == two->record->shape_i &&
                            one->record->shape_j == two->record->shape_j;
        t.alone[i][j] = is_pair ? se3di_convex_move_alone(c, one, two) : 0.0;
    }
    if (!give_way(&t)) {
        return 0;
    }
    if (!trace(&t)) {
        let_stick(&t, c);
        return 0;
    }
    if (!is_sound(&t)) {
        return 0;
    }
    for (int k = 0; k < t.count; ++k) {
        const double *impulse = t.points[k].impulse;
        const point *presser = t.points[k].presser;
        se3di_convex_contact *contact = traced->contacts[k];
        contact->way = presser ? SE3DI_CONVEX_ROLL : SE3DI_CONVEX_TRACED;
        const double along = se3di_dot(impulse, contact->normal);
        contact->attraction = t.points[k].drawn;
        contact->rise = along + contact->attraction;
        contact->drag = contact->steepness = 0.0;
        contact->tangential = 1.0 / c->h;
        se3di_scale(-1.0, impulse, contact->xi);
        se3di_add_scaled(along, contact->normal, contact->xi);
        contact->bound =
            contact->friction *
            (presser ? se3di_dot(presser->impulse, presser->contact->normal) + presser->drawn
                     : contact->rise);
    }
    return 1;
}
