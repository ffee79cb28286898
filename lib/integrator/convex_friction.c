/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction of joints in a step of convex: contacts along a coordinate x, as stops are, whose
 * impulse against it is
 *
 *     p = y if |y| <= b, else +-b,    y = h (n_0 + s (x - z) + (s h + d) v),   plus viscous
 *     b = h (mu L + limit)            L by the multipliers of the step; mu_static if it stuck
 *
 * with the law's spring, if it sticks. In a step in which nothing touches x is that in its middle.
 * The viscous part takes the mean of the velocities at both ends, or nearer to the last one where
 * the step is longer than what it follows.                           docs/theory/convex.md */
#include "integrator/convex.h"

#include "force/friction.h"
#include "force/measure.h"
#include "math/vec3.h"

#include <math.h>

#define STALE       2.0  /* springs follow a load that grows in such factors */
#define SLIPS       1e-9 /* of the cap: less than that below it */
#define BEYOND      10.0 /* of all momentum */
#define JAMS        1e-2 /* of a cap: no solution, if it does not follow */
#define CAP_CHANGE  1e-6 /* of a cap: it needs no other iteration, */
#define CAP_BESIDE  3e-4 /* beside shapes, */
#define CAP_LEAST   1e-9 /* nor if it changes less of all momentum */
#define SHARE_LEAST 0.05 /* of what is missing of a cap: it goes on by that, */
#define SHARE_MOST  5.0  /* or by that */

static void add(se3di_convex *c, const se3di_assembly *assembly, const se3di_force *force)
{
    se3di_convex_contact *row = &c->contacts[c->contact_count];
    const int slips = !se3di_friction_sticks(force);
    se3di_measure x;
    (void)se3di_measure_force(assembly->model, force, 0, &x);
    *row = (se3di_convex_contact){
        .coupling = -1, .element = force, .way = SE3DI_CONVEX_FRICTION, .overlap = x.value};
    if (!se3di_convex_set_row(c, assembly, x.g, 1.0, row)) {
        return;
    }
    const double *state = force->state;
    const double stretch = slips ? 0.0 : x.value - state[SE3DI_FRICTION_ANCHOR];
    row->stiffness = state[SE3DI_FRICTION_STIFFNESS];
    row->rise = -c->h * (state[SE3DI_FRICTION_FORCE] + row->stiffness * stretch);
    row->friction = slips ? force->mu : force->mu_static;
    row->bound = c->h * se3di_friction_limit(force, slips);
    ++c->contact_count;
}

static int acts(const se3di_force *force)
{
    return force->type == SE3DI_FORCE_FRICTION && !force->released;
}

se3d_status se3di_convex_collect_friction(se3di_convex *c, const se3di_assembly *assembly,
                                          se3di_error *error)
{
    const se3di_model *model = assembly->model;
    size_t count = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        count += (size_t)acts(&model->forces[k]);
    }
    SE3DI_TRY(se3di_convex_reserve(c, assembly, count, error));
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (acts(&model->forces[k]) &&
            !se3di_convex_element_sleeps(c, assembly, &model->forces[k])) {
            add(c, assembly, &model->forces[k]);
        }
    }
    return SE3D_OK;
}

int se3di_convex_has_loads(const se3di_convex *c)
{
    for (size_t k = c->stop_end; k < c->contact_count; ++k) {
        if (se3di_friction_has_load(c->contacts[k].element)) {
            return 1;
        }
    }
    return 0;
}

/* The spring for a cap: another one begins where the step does if the load has grown. */
static void set_spring(const se3di_convex *c, se3di_convex_contact *row, double cap)
{
    const double fresh = cap / (c->h * row->element->presliding), h = c->h;
    row->stiffness = fresh > STALE * row->stiffness ? fresh : row->stiffness;
    const double less = 0.5 * h * row->stiffness; /* the implicit step damps */
    const double damper = se3di_friction_get_damper(row->element, row->stiffness);
    row->steepness = h * (h * row->stiffness + fmax(0.0, damper - less));
}

void se3di_convex_choose_friction(const se3di_convex *c, se3di_convex_contact *row,
                                  double inverse_mass)
{
    const se3di_force *force = row->element;
    const double h = c->h;
    const double flow = h * force->viscous, change = flow * inverse_mass;
    const double part = change > 2.0 ? 1.0 - 1.0 / change : 0.5; /* of the end */
    const double start = se3di_dot(row->before, row->normal) + se3di_dot(row->chord, row->normal);
    set_spring(c, row, row->bound);
    row->damping = part * flow;
    row->rebound = -(1.0 - part) / part * start;
    row->response[0] = inverse_mass;
}

/* The impulse of the spring, and whether the cap cuts it. */
static double pull_of(const se3di_convex_contact *row, int *slips)
{
    const double pull = row->rise - row->steepness * se3di_dot(row->v, row->normal);
    *slips = row->bound > 0.0 && fabs(pull) >= (1.0 - SLIPS) * row->bound;
    return pull;
}

static double cap_of(const se3di_convex *c, const se3di_convex_contact *row)
{
    const se3di_force *force = row->element;
    double R[SE3DI_FRICTION_PARTS], more[SE3DI_FRICTION_PARTS];
    if (c->reacts == 0 || !se3di_friction_has_load(force)) {
        return row->bound;
    }
    se3di_friction_reaction(c->model, force, c->lambda, R);
    if (c->recoils) {
        se3di_friction_reaction(c->model, force, c->recoil, more);
        for (int k = 0; k < SE3DI_FRICTION_PARTS; ++k) {
            R[k] += more[k];
        }
    }
    return row->friction * se3di_friction_load(c->model, force, R, NULL) + c->h * force->limit;
}

/* `wanted` is the next cap, `wanted_before` the one in use at the last look: the gap between both
 * looks is taken for linear in it. */
int se3di_convex_look(const se3di_convex *c, se3di_convex_contact *row, double momentum)
{
    const double cap = cap_of(c, row), gap = cap - row->bound, size = fabs(gap);
    const double change = gap - row->gap, moved = row->bound - row->wanted_before;
    int slips;
    const double pull = fabs(pull_of(row, &slips));
    double share = 1.0;
    if (c->reacts > 1 && fabs(change) > 0.0) {
        share = -moved / change;
        share = share > 0.0 ? fmax(SHARE_LEAST, fmin(share, SHARE_MOST)) : 1.0;
    }
    set_spring(c, row, cap);
    row->wanted = fmax(0.0, row->bound + share * gap);
    row->wanted_before = row->bound;
    row->gap = gap;
    const double enough = c->is_beside ? CAP_BESIDE : CAP_CHANGE;
    return pull < fmin(cap, row->bound) || !(size > enough * cap) ||
           !(size * size * row->response[0] > CAP_LEAST * CAP_LEAST * momentum);
}

/* Whether what slips would do so with another cap by far. Beside shapes, whose own caps may go
 * round, only what has grown beyond all momentum says so. */
static int jams(const se3di_convex *c, const se3di_convex_island *island,
                const se3di_convex_contact *row)
{
    const double size = row->bound * row->bound * row->response[0];
    int slips;
    (void)pull_of(row, &slips);
    return slips && fabs(cap_of(c, row) - row->bound) > JAMS * row->bound &&
           (!c->is_beside || size > BEYOND * BEYOND * island->momentum);
}

int se3di_convex_jams(const se3di_convex *c, const se3di_convex_island *island)
{
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        const se3di_convex_contact *row = se3di_convex_at(c, k);
        if (row->way == SE3DI_CONVEX_FRICTION && jams(c, island, row)) {
            return 1;
        }
    }
    return 0;
}

/* The spring of what has stuck holds n where it is now: what else it would be stretched by it has
 * slipped. */
static void yield(const se3di_model *model, se3di_force *force, double n)
{
    double *state = force->state, x;
    if (se3di_friction_sticks(force) && se3di_measure_value(model, force, &x)) {
        const double more = n - state[SE3DI_FRICTION_FORCE], s = state[SE3DI_FRICTION_STIFFNESS];
        state[SE3DI_FRICTION_ANCHOR] = x - (s > 0.0 ? more / s : 0.0);
    }
}

/* It sticks: with what the spring has at the place, from what acted if it has just stopped. */
static void stick(const se3di_model *model, se3di_force *force, double n)
{
    const double limit = se3di_friction_limit(force, 0);
    const double held = se3di_friction_sticks(force) ? se3di_friction_get(model, force) : n;
    const double most = fmax(-limit, fmin(held, limit));
    if (!se3di_friction_sticks(force) || fabs(held) > limit) {
        yield(model, force, most);
        se3di_friction_set(model, force, 0.0, most);
    }
}

static void slip(const se3di_model *model, se3di_force *force, double way)
{
    yield(model, force, way * se3di_friction_limit(force, 0));
    se3di_friction_set(model, force, way, way * se3di_friction_limit(force, 1));
}

void se3di_convex_accept_friction(const se3di_convex *c, const se3di_assembly *assembly)
{
    se3di_model *model = assembly->model;
    if (c->stop_end == c->contact_count) {
        return;
    }
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        model->lambda[k] = (c->lambda[k] + (c->recoils ? c->recoil[k] : 0.0)) / c->h;
    }
    se3di_frictions_take_loads(model, model->lambda);
    for (size_t k = c->stop_end; k < c->contact_count; ++k) {
        const se3di_convex_contact *row = &c->contacts[k];
        se3di_force *force = &model->forces[row->element - model->forces];
        int slips;
        const double pull = pull_of(row, &slips), way = copysign(1.0, -pull);
        if (row->stiffness > force->state[SE3DI_FRICTION_STIFFNESS]) {
            se3di_friction_anchor(force, row->overlap, -row->rise / c->h);
        }
        if (slips) {
            slip(model, force, way);
        } else {
            stick(model, force, -pull / c->h);
        }
    }
}

double se3di_convex_grip_energy(const se3di_convex *c, const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    double sum = 0.0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        double own;
        if (force->type == SE3DI_FORCE_FRICTION &&
            !se3di_convex_element_sleeps(c, assembly, force) &&
            se3di_force_potential(model, force, model->time, &own) >= 0) {
            sum += own;
        }
    }
    return sum;
}

double se3di_convex_rubbed(const se3di_convex *c, const se3di_assembly *assembly)
{
    double sum = c->gripped - se3di_convex_grip_energy(c, assembly);
    for (size_t k = c->stop_end; k < c->contact_count; ++k) {
        sum += se3di_convex_taken_by(&c->contacts[k]);
    }
    return sum;
}
