/* SPDX-License-Identifier: BSD-3-Clause */
/* The energy of a step of convex. What is taken from the bodies is, besides p (v_0 + v_1)/2 of the
 * impulses,
 *
 *     h m g (v_1 - v_0)/2                 they move by v_1, gravity works on the mean of both ends
 *     g (w_0 + w_1)/2                     the moment of gyration is known to 1e-9
 *
 * so that kinetic energy, potential and what was taken together stay the same to rounding. The
 * springs of a pair of shapes hold of it what they can, and what they gave back is no more than
 * that: a contact that is met when it is deep already has no energy but what it took.
 *                                                                     docs/theory/convex.md */
#include "integrator/convex.h"

#include "math/vec3.h"

#include <math.h>

/* of twice the kinetic energy: */
#define GAIN_MOST  0.01 /* what a step may give, */
#define GIVEN_MOST 1e-6 /* an impact gives and may, */
#define THROWN     1e-3 /* a spring does */
#define STIFF      1e3  /* a damper that stops its bodies, over what moves them as one */

/* What the impulse takes from the bodies, and from what moves surfaces on them: half a step before
 * and half a step on they have what they have at the start on the average. Of bodies that
 * constraints hold these are both chords: their parts across the constraints cancel, and the
 * reactions to the impulse do no work. */
double se3di_convex_taken_by(const se3di_convex_contact *c)
{
    return -0.5 * (se3di_dot(c->impulse, c->before) + se3di_dot(c->impulse, c->chord) +
                   se3di_dot(c->impulse, c->v) - se3di_dot(c->impulse, c->shift)) +
           se3di_dot(c->impulse, c->ahead);
}

/* The same of what rolls there. */
static double taken_by_rolling(const se3di_convex *convex, const se3di_convex_contact *c)
{
    return c->partner >= 0 ? se3di_convex_taken_by(&convex->contacts[c->partner]) : 0.0;
}

static int is_impact(const se3di_convex_contact *contact)
{
    return contact->record && contact->way == SE3DI_CONVEX_IMPACT;
}

/* What a contact of shapes gives that no spring of it held. */
static double gift_of(const se3di_convex_contact *contact)
{
    const int may_give = contact->record && !(contact->attraction > 0.0); /* that gives, too */
    const double given = may_give ? -se3di_convex_taken_by(contact) : 0.0;
    return is_impact(contact) ? given : fmax(0.0, given - contact->held);
}

/* A damper for a spring, so that it gives no more than it held: the impulse p and the velocity v
 * that it so leaves with, if all others stay, are
 *
 *     p (before + v)/2 = held,    v = after - W (impulse - p) */
static int hold_back(const se3di_convex *c, se3di_convex_contact *contact, double before,
                     double after)
{
    const double W = contact->record->inverse_mass, damping = contact->damping;
    const double normal = se3di_dot(contact->impulse, contact->normal);
    const double both = before + after - W * normal;
    const double p = 0.5 * (sqrt(both * both + 8.0 * W * contact->held) - both) / W;
    const double v = after - W * (normal - p);
    double slope;
    if (!(v > 0.0 && p < normal)) {
        return 0;
    }
    contact->damping = 0.0;
    const double more = (se3di_convex_normal(contact, c->h, v, &slope) - p) / (c->h * v);
    contact->damping = fmax(damping, fmin(more, STIFF / (c->h * W)));
    return contact->damping > damping;
}

/* A contact that gives, as it leaves with more than it may, or all impacts, leaves more slowly.
 * Returns whether it is to. */
static int slow_down(const se3di_convex *c, se3di_convex_contact *contact, double momentum,
                     int is_any)
{
    const double *n = contact->normal, before = se3di_dot(contact->before, n);
    const double after = se3di_dot(contact->v, n), least = fmin(0.0, -before);
    const double normal = se3di_dot(contact->impulse, n), gift = gift_of(contact);
    if (is_impact(contact) && contact->rebound > least && normal > 0.0 && (is_any || gift > 0.0)) {
        const double less = is_any ? 0.5 * contact->rebound : 2.0 * gift / normal;
        contact->rebound = fmax(least, contact->rebound - less);
        return 1;
    }
    if (!is_any && contact->way == SE3DI_CONVEX_SPRING && gift > THROWN * momentum && after > 0.0 &&
        before + after > 0.0) {
        return hold_back(c, contact, before, after);
    }
    return 0;
}

/* Contacts of an island together give no energy. If they did, those that do on the average of their
 * velocities before and after, since others have turned a slip round or have stopped what was
 * parting, or since a step has carried them deep, leave more slowly, or come as near as they were
 * parting; if that is not enough, all impacts. Returns whether any are to. */
int se3di_convex_tame(const se3di_convex *c, const se3di_convex_island *island)
{
    const double most = GIVEN_MOST * island->momentum;
    double sum = 0.0;
    int is_tamed = se3di_convex_free_jams(c, island);
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        sum += gift_of(se3di_convex_at(c, k));
    }
    for (int is_any = 0; is_any < 2 && !is_tamed && sum > most; ++is_any) {
        for (size_t k = island->contact; k < island->contact_end; ++k) {
            is_tamed |= slow_down(c, se3di_convex_at(c, k), island->momentum, is_any);
        }
    }
    return is_tamed;
}

/* What of it springs may hold: an impact lifts its bodies, too. */
static double left_by(const se3di_convex *convex, const se3di_convex_contact *c)
{
    const int lifted = (c->free[1] >= 0) - (c->free[0] >= 0);
    const int lifts = c->way != SE3DI_CONVEX_SPRING && lifted != 0;
    return se3di_convex_taken_by(c) +
           (lifts ? 0.5 * lifted * convex->h * se3di_dot(c->impulse, convex->gravity) : 0.0);
}

/* What a body that moves by v_1 sinks too far, */
static double taken_by_leap(const se3di_convex *c, const se3di_assembly *assembly, uint32_t k)
{
    const double mass = assembly->model->bodies[assembly->free_body[k]].mass;
    double dv[3];
    if (c->drifts[k]) {
        return 0.0;
    }
    se3di_sub(c->v + 6 * (size_t)k, c->start + 6 * (size_t)k, dv);
    se3di_sub(dv, c->chord + 6 * (size_t)k, dv);
    return 0.5 * c->h * mass * se3di_dot(c->gravity, dv);
}

/* and all that the step itself takes from it. */
static double taken_from(const se3di_convex *c, const se3di_assembly *assembly, uint32_t k)
{
    double sum = taken_by_leap(c, assembly, k);
    if (se3di_convex_takes_part(c, k)) {
        sum += se3di_convex_gyration_work(c, k);
    }
    return sum;
}

double se3di_convex_work(const se3di_convex *convex, const se3di_assembly *assembly)
{
    double sum = 0.0;
    for (size_t k = 0; k < convex->roll_end; ++k) {
        sum += se3di_convex_taken_by(&convex->contacts[k]);
    }
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        sum += convex->asleep[k] ? 0.0 : taken_from(convex, assembly, k);
    }
    return sum;
}

/* T_1 - T_0 - (v - v_0)^T M (v_0 + v)/2 of each island. */
static void add_momenta(const se3di_convex *c, const se3di_assembly *assembly)
{
    double *change = c->carried, *momentum = c->gradient, *pressed = c->moved;
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        const se3di_frame *frame = &assembly->model->frames[assembly->free_body[k / 6]];
        change[k] = (k % 6 < 3 ? frame->v[k % 6] : frame->w[k % 6 - 3]) - c->start[k];
    }
    se3di_assembly_mul_mass(assembly, change, momentum);
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        momentum[k] *= c->start[k] + 0.5 * change[k];
        change[k] = c->v[k] - c->start[k];
    }
    se3di_assembly_mul_mass(assembly, change, pressed);
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        if (se3di_convex_takes_part(c, k / 6)) {
            c->islands[c->number[k / 6]].gain += momentum[k] - pressed[k] * c->change[k];
        }
    }
}

/* Kinetic energy is to change by what loads and impulses do along the mean velocities:
 *
 *     T_1 - T_0 = (v - v_0)^T M (v_0 + v)/2 + lambda C (v_0 + v)/2
 *
 * of rows that do not change in time. What turns far in a step is carried off its constraints by
 * it, and may come back to them faster. */
int se3di_convex_gains(const se3di_convex *c, const se3di_assembly *assembly)
{
    int gains = 0;
    if (c->joint_count == 0) {
        return 0;
    }
    for (size_t k = 0; k < c->island_count; ++k) {
        c->islands[k].gain = 0.0;
    }
    add_momenta(c, assembly);
    for (size_t k = 0; k < c->island_count; ++k) {
        se3di_convex_island *island = &c->islands[k];
        for (size_t j = island->joint; j < island->joint_end; ++j) {
            const se3di_constraint *joint = &assembly->model->constraints[c->rows.joint[j]];
            for (uint32_t r = 0; r < joint->row_count; ++r) {
                island->gain -= c->lambda[joint->row_begin + r] * c->aimed[joint->row_begin + r];
            }
        }
        gains |= island->gain > GAIN_MOST * island->momentum;
    }
    return gains;
}

double se3di_convex_fed(const se3di_convex *convex)
{
    double sum = 0.0;
    for (size_t k = 0; k < convex->roll_end; ++k) {
        const se3di_convex_contact *c = &convex->contacts[k];
        sum -= se3di_dot(c->impulse, c->drift) - se3di_dot(c->impulse, c->ahead);
    }
    return sum;
}

/* Of the law, at a record's overlap and stretch. */
static double law_energy(const se3di_model *model, const se3di_body_contact *r)
{
    se3di_convex_contact c = {.record = r};
    double at[2][3], xi[3];
    se3di_convex_set_law(&c, model);
    for (int k = 0; k < 2; ++k) {
        const se3di_frame *frame = &model->frames[model->shapes[k ? r->shape_j : r->shape_i].body];
        se3di_mul(frame->A, k ? r->anchor_j : r->anchor_i, at[k]);
        se3di_add(at[k], frame->r, at[k]);
    }
    se3di_sub(at[1], at[0], xi);
    se3di_add_scaled(-se3di_dot(xi, r->normal), r->normal, xi);
    const double force = c.stiffness * r->overlap * (c.power > 1.0 ? sqrt(r->overlap) : 1.0);
    return force * r->overlap / (1.0 + c.power) + 0.5 * c.tangential * se3di_dot(xi, xi) +
           se3di_convex_roll_energy(model, r) - se3di_convex_stuck(model, r);
}

/* At the end of a step, when the velocities were those of the state: of what is followed half a
 * step ago, when it was as much deeper as its record says until now; `lawful` is that of now. */
static double energy_then(const se3di_model *model, const se3di_body_contact *r, double lawful)
{
    if (!(fabs(r->energy) > 0.0)) {
        return lawful;
    }
    se3di_body_contact then = *r;
    then.overlap = fmax(0.0, r->overlap + r->energy);
    return law_energy(model, &then);
}

void se3di_convex_hold(const se3di_convex *convex, const se3di_model *model)
{
    for (size_t k = 0; k < convex->shape_count; ++k) {
        const se3di_body_contact *r = convex->contacts[k].record;
        convex->contacts[k].held =
            r->kind == SE3DI_CONTACT_LAWFUL ? law_energy(model, r) : r->energy;
    }
}

/* What the springs of the pair of `r` held before the step and took in it; contacts are looked at
 * from `*first` on. */
static double gather(const se3di_convex *convex, const se3di_body_contact *r, size_t *first)
{
    double sum = 0.0;
    while (*first < convex->shape_count &&
           se3di_convex_is_before(convex->contacts[*first].record, r)) {
        ++*first;
    }
    for (; *first < convex->shape_count &&
           !se3di_convex_is_before(r, convex->contacts[*first].record);
         ++*first) {
        const se3di_convex_contact *c = &convex->contacts[*first];
        sum += c->held + left_by(convex, c) + taken_by_rolling(convex, c);
    }
    return sum;
}

/* The springs of a contact at the end, as if nothing limited them. */
static double store_one(const se3di_convex *convex, const se3di_model *model, size_t at)
{
    se3di_body_contact *r = &model->contacts.next[at];
    convex->lawful[at] = law_energy(model, r);
    r->energy = energy_then(model, r, convex->lawful[at]);
    return r->energy;
}

/* The springs of each pair. Returns what all hold. */
static double store_pairs(const se3di_convex *convex, se3di_model *model)
{
    se3di_body_contact *next = model->contacts.next;
    const size_t count = model->contacts.next_count;
    size_t first = 0, end;
    double sum = 0.0;
    for (size_t k = 0; k < count; k = end) {
        const int frozen = se3di_contact_is_frozen(model, next[k].shape_i, next[k].shape_j);
        double most = 0.0;
        for (end = k; end < count && !se3di_convex_is_before(&next[k], &next[end]); ++end) {
            most += frozen ? 0.0 : store_one(convex, model, end);
        }
        if (frozen) {
            continue;
        }
        const double held = fmin(most, fmax(0.0, gather(convex, &next[k], &first)));
        for (size_t at = k; at < end && held < most; ++at) {
            next[at].energy *= held / most;
        }
        sum += held;
    }
    return sum;
}

/* What bodies have sunk too far they will be lifted by again: springs that have less than their law
 * says hold it meanwhile. Returns how much they take of it. */
static double keep_leaps(const se3di_convex *convex, const se3di_assembly *assembly, double most)
{
    se3di_model *model = assembly->model;
    double lent = 0.0, room = 0.0;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        lent += convex->asleep[k] ? 0.0 : taken_by_leap(convex, assembly, k);
    }
    lent = fmin(lent, most);
    if (!(lent > 0.0)) {
        return 0.0;
    }
    for (int pass = 0; pass < 2; ++pass) {
        const double share = pass && room > lent ? lent / room : 1.0;
        for (size_t k = 0; k < model->contacts.next_count && (!pass || room > 0.0); ++k) {
            se3di_body_contact *r = &model->contacts.next[k];
            if (!se3di_contact_is_frozen(model, r->shape_i, r->shape_j)) {
                const double gap = fmax(0.0, convex->lawful[k] - r->energy);
                room += pass ? 0.0 : gap;
                r->energy += pass ? share * gap : 0.0;
            }
        }
    }
    return fmin(lent, room);
}

se3d_status se3di_convex_store(se3di_convex *convex, const se3di_assembly *assembly, double taken,
                               se3di_error *error)
{
    se3di_model *model = assembly->model;
    if (se3di_array_reserve_at(&model->allocator, &convex->lawful, &convex->lawful_capacity,
                               model->contacts.next_count, sizeof *convex->lawful) < 0) {
        return se3di_error_set(error, SE3D_ERR_NO_MEMORY, "t = %g s: no memory for %zu contacts",
                               model->time, model->contacts.next_count);
    }
    double sum = store_pairs(convex, model), most = taken;
    for (size_t k = 0; k < convex->shape_count; ++k) {
        most += convex->contacts[k].held;
    }
    most = fmax(0.0, most);
    sum += keep_leaps(convex, assembly, most - sum);
    for (size_t k = 0; k < model->contacts.next_count && sum > most; ++k) {
        se3di_body_contact *r = &model->contacts.next[k];
        if (!se3di_contact_is_frozen(model, r->shape_i, r->shape_j)) {
            r->energy *= most / sum;
        }
    }
    return SE3D_OK;
}
