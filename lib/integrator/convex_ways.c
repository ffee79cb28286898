/* SPDX-License-Identifier: BSD-3-Clause */
/* How contacts, stops and friction of an island act in a step, by what an impulse moves there:
 *
 *     W = J K J^T,    K the inverse of M on the constraints, with armatures
 *
 * One factorization answers for all, in steps in which it matters: what a body weighs by itself
 * says how a contact acts where nothing holds it, or where all that may move with it is too light
 * to make the contact last.                                            docs/theory/convex.md */
#include "integrator/convex.h"

#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define SLOW  0.02 /* of the force of a spring: what a damper may be that is another */
#define ROUGH 1e-4 /* what solutions by which contacts are chosen may leave */
#define STILL 1e-9 /* of the entries of a row: it does not see that all bodies move as one */

/* The matrix of masses and constraints of an island, without contacts, once a step. Returns 0 if it
 * has none. */
static int factor_alone(se3di_convex *c, se3di_equations *equations, se3di_convex_island *island)
{
    if (!island->is_factored) {
        const se3di_kkt_values values = se3di_convex_values_of(c, island, c->mass);
        se3di_convex_clear_couplings(c, island);
        ++equations->counters.factorizations;
        island->is_factored = se3di_kkt_factor(island->kkt, &values, NULL) >= 0;
    }
    return island->is_factored;
}

/* `change` and lambda by that matrix, for what is in `equations->b`, with rates `aimed` along the
 * constraints, NULL: none. */
static se3d_status solve_alone(se3di_convex *c, se3di_equations *equations,
                               const se3di_convex_island *island, const double *aimed)
{
    const se3di_kkt_values values = se3di_convex_values_of(c, island, c->mass);
    const size_t begin = 6 * island->body;
    memset(equations->c, 0, (island->row_end - island->row) * sizeof *equations->c);
    ++equations->counters.solves;
    return se3di_kkt_solve(island->kkt, &values, equations->b + begin, aimed ? aimed : equations->c,
                           c->change + begin, c->rows.lambda + island->row, NULL);
}

/* What an impulse at a point makes of the velocities of an island, in `change`. */
static se3d_status answer(se3di_convex *c, se3di_equations *equations,
                          const se3di_convex_island *island, const se3di_convex_contact *contact,
                          const double impulse[3])
{
    const size_t begin = 6 * island->body, end = 6 * island->body_end;
    double *p = equations->b;
    memset(p + begin, 0, (end - begin) * sizeof *p);
    se3di_convex_press(contact, 1.0, impulse, p);
    if (!se3di_convex_is_bound(island)) {
        for (size_t k = island->body; k < island->body_end; ++k) {
            const double *mobility = c->mobility + 10 * k;
            se3di_scale(mobility[0], p + 6 * k, c->change + 6 * k);
            se3di_mul(mobility + 1, p + 6 * k + 3, c->change + 6 * k + 3);
        }
        return SE3D_OK;
    }
    const se3d_status status = solve_alone(c, equations, island, NULL);
    return status == SE3D_ERR_NO_CONVERGENCE ? SE3D_OK : status; /* of what is driven, nothing */
}

/* Velocities that a step begins with are on the constraints, and its chord is half a step before
 * and half a step after them: what constraints take of the chord before belongs to the load of
 * friction, too. */
static void find_recoil(se3di_convex *c, se3di_equations *equations, se3di_convex_island *island)
{
    if (!factor_alone(c, equations, island)) {
        return;
    }
    for (size_t k = island->body; k < island->body_end; ++k) {
        memcpy(c->change + 6 * k, c->chord + 6 * (size_t)c->body_at[k], 6 * sizeof *c->change);
    }
    se3di_convex_mul_mass(c, island, c->change, equations->b);
    if (solve_alone(c, equations, island, NULL) >= 0) {
        se3di_convex_take_back_rows(c, &equations->assembly, island, c->recoil);
    }
}

/* What an impulse in `equations->b` makes of its own velocity. */
static double given_by(const se3di_convex *c, const se3di_equations *equations,
                       const se3di_convex_island *island)
{
    double sum = 0.0;
    for (size_t k = 6 * island->body; k < 6 * island->body_end; ++k) {
        sum += equations->b[k] * c->change[k];
    }
    return fmax(0.0, sum);
}

/* How stops and friction act: what has no solution here has none in the step, which tells it. */
static void choose_elements(se3di_convex *c, se3di_equations *equations,
                            se3di_convex_island *island)
{
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        se3di_convex_contact *stop = se3di_convex_at(c, k);
        if (!stop->element) {
            continue;
        }
        double moved = se3di_convex_move_alone(c, stop, stop);
        if (stop->way == SE3DI_CONVEX_FRICTION) {
            se3di_convex_choose_friction(c, stop, moved);
            continue;
        }
        if (se3di_convex_is_bound(island) && se3di_convex_stop_is_near(stop, c->h)) {
            if (factor_alone(c, equations, island) &&
                answer(c, equations, island, stop, stop->normal) >= 0) {
                moved = given_by(c, equations, island);
            }
        }
        se3di_convex_choose_stop(c, stop, moved);
    }
    if (c->recoils && se3di_convex_is_bound(island) && !c->drifts[c->body_at[island->body]]) {
        find_recoil(c, equations, island);
    }
}

/* Whether constraints let all bodies of an island move as one. */
static int moves_as_one(const se3di_convex *c, const se3di_convex_island *island)
{
    const se3di_convex_rows *r = &c->rows;
    const double *C = r->C + island->value;
    for (size_t j = 0; j < island->joint_end - island->joint; ++j) {
        const int32_t *begin = r->begin + island->begin + j;
        const size_t links = (size_t)(begin[1] - begin[0]);
        const size_t rows = (size_t)r->count[island->joint + j];
        for (size_t row = 0; row < rows; ++row) {
            double sum[3] = {0.0, 0.0, 0.0}, size = 0.0;
            for (size_t e = 0; e < links; ++e) {
                const double *along = C + 6 * (e * rows + row);
                se3di_add(sum, along, sum);
                size = fmax(size, se3di_norm(along));
            }
            if (se3di_norm(sum) > STILL * size) {
                return 0;
            }
        }
        C += 6 * links * rows;
    }
    return 1;
}

/* The mass of an island whose bodies may move as one, HUGE_VAL of others. */
static double mass_of(const se3di_convex *c, const se3di_convex_island *island)
{
    double sum = 0.0;
    for (size_t k = island->body; k < island->body_end; ++k) {
        sum += c->own[36 * k];
    }
    return moves_as_one(c, island) ? sum : HUGE_VAL;
}

/* Whether a contact is over soon whatever its bodies' joints move with them: one of them has none,
 * or what all weigh together is too little. */
static int is_light(const se3di_convex *c, const se3di_convex_contact *contact, double mass)
{
    double inverse = contact->free[0] < 0 || contact->free[1] < 0 ? 1.0 / mass : 0.0;
    for (int k = 0; k < 2; ++k) {
        if (contact->free[k] >= 0 && !c->linked[c->body_at[contact->free[k]]]) {
            inverse = fmax(inverse, c->mobility[10 * (size_t)contact->free[k]]);
        }
    }
    return se3di_convex_is_over_soon(contact, inverse, c->h, se3di_convex_approach(contact));
}

/* Whether it makes no difference how a contact acts: it goes on, and all that it would be damped by
 * if it is over soon is little beside its spring. */
static int is_at_rest(const se3di_convex_contact *contact)
{
    double v[3];
    se3di_add(contact->before, contact->shift, v);
    return contact->way == SE3DI_CONVEX_SPRING &&
           contact->damping * se3di_norm(v) <=
               SLOW * contact->stiffness * contact->overlap *
                   (contact->power > 1.0 ? sqrt(contact->overlap) : 1.0);
}

/* The velocities of a step without contacts, in `moved`. Returns 0 if they have no solution. */
static int move_alone(se3di_convex *c, se3di_equations *equations, se3di_convex_island *island)
{
    const double *aim = c->carried, *start = c->gradient;
    double *b = equations->b, *loads = c->moved;
    const size_t first = 6 * island->body, end = 6 * island->body_end;
    for (size_t k = first; k < end; ++k) {
        c->change[k] = aim[k] - start[k];
    }
    se3di_convex_mul_own(c, island, c->change, loads);
    se3di_convex_mul_mass(c, island, start, b);
    for (size_t k = first; k < end; ++k) {
        b[k] += loads[k];
    }
    const se3d_status status = factor_alone(c, equations, island)
                                   ? solve_alone(c, equations, island, c->rows.aimed + island->row)
                                   : SE3D_ERR_SINGULAR;
    if (status < 0 && status != SE3D_ERR_NO_CONVERGENCE) {
        return 0;
    }
    memcpy(c->moved + first, c->change + first, (end - first) * sizeof *c->moved);
    return 1;
}

/* What the impulse at a contact makes of its velocity, if those of the others of its two shapes
 * press as it does, as masses are shared by the laws. Returns 0 if it is not known. */
static int respond(se3di_convex *c, se3di_equations *equations, const se3di_convex_island *island,
                   se3di_convex_contact *contact)
{
    const se3di_body_contact *r = contact->record;
    const double radius = se3di_convex_radius(c->model, r);
    double sum = 0.0;
    if (answer(c, equations, island, contact, contact->normal) < 0) {
        return 0;
    }
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        const se3di_convex_contact *other = se3di_convex_at(c, k);
        if (other->record && other->record->shape_i == r->shape_i &&
            other->record->shape_j == r->shape_j) {
            double v[3];
            se3di_convex_velocity(other, c->change, v);
            sum += se3di_encounter_weight(r->overlap, other->record->overlap, radius) *
                   se3di_dot(v, other->normal);
        }
    }
    contact->response[0] = fmax(sum, SE3DI_SHARE_MIN * given_by(c, equations, island));
    return 1;
}

/* How contacts of shapes act. */
static void choose_contacts(se3di_convex *c, se3di_equations *equations,
                            se3di_convex_island *island)
{
    const double mass = mass_of(c, island);
    const se3di_kkt_settings settings = se3di_kkt_get_settings(island->kkt);
    se3di_kkt_settings rough = settings;
    int is_known = 0;
    rough.tolerance = ROUGH;
    se3di_kkt_set_settings(island->kkt, &rough);
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        se3di_convex_contact *contact = se3di_convex_at(c, k);
        if (!contact->record || !contact->is_short) {
            continue;
        }
        const int goes_on = contact->record->kind == SE3DI_CONTACT_STEPPED;
        contact->is_held = goes_on || contact->record->kind == SE3DI_CONTACT_PARTING;
        if (goes_on && is_at_rest(contact)) {
            continue;
        }
        if (goes_on && is_light(c, contact, mass)) {
            se3di_convex_choose_contact(c, contact, c->gradient, c->carried);
            se3di_convex_choose_rolling(c, contact);
            continue;
        }
        is_known = is_known || move_alone(c, equations, island);
        if (!is_known || !respond(c, equations, island, contact)) {
            break;
        }
        se3di_convex_choose_contact(c, contact, c->gradient, c->moved);
        se3di_convex_choose_rolling(c, contact);
    }
    se3di_kkt_set_settings(island->kkt, &settings);
}

/* Impacts beside which nothing acts: their impulses are known before. */
static void trace_impacts(se3di_convex *c, se3di_equations *equations, se3di_convex_island *island)
{
    se3di_convex_traced t;
    if (!se3di_convex_may_trace(c, island, &t) ||
        (se3di_convex_is_bound(island) && !factor_alone(c, equations, island))) {
        return;
    }
    for (int j = 0; j < 3 * t.count; ++j) {
        const double one[3] = {j % 3 == 0, j % 3 == 1, j % 3 == 2};
        if (answer(c, equations, island, t.contacts[j / 3], one) < 0) {
            return;
        }
        for (int i = 0; i < t.count; ++i) {
            double v[3];
            se3di_convex_velocity(t.contacts[i], c->change, v);
            for (int r = 0; r < 3; ++r) {
                t.W[i][j / 3][3 * r + j % 3] = v[r];
            }
        }
    }
    island->is_traced = se3di_convex_trace(c, &t, equations->assembly.model);
}

void se3di_convex_choose_ways(se3di_convex *c, se3di_equations *equations,
                              se3di_convex_island *island)
{
    if (se3di_convex_is_bound(island)) {
        choose_contacts(c, equations, island);
    }
    choose_elements(c, equations, island);
    trace_impacts(c, equations, island);
}
