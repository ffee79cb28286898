/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts in a step of convex: from what is remembered of them to their impulses, and back.
 *
 * A contact that lasts a dozen steps follows its law. Its spring is that at the start of the step
 * or little later: one at its end is damped as if by h k. One that lasts fewer is an impact of one
 * step if it begins fast: its points leave with the restitution times their approach. If it is
 * slow, the contact rests: it is damped in a few steps, on the law's spring. docs/theory/convex.md
 */
#include "integrator/convex.h"

#include "contact/bodies/body_contacts.h"
#include "contact/bodies/encounter.h"
#include "contact/bodies/law.h"
#include "contact/bodies/restitution.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define PI          3.1415926535897932384626433832795
#define FEW_STEPS   12.0 /* the time of a contact that is an impact of one step */
#define SETTLING    4.0  /* steps in which a resting contact comes to rest */
#define SETTLED     1.3  /* of a radian: more damping than of a step of this phase is not needed */
#define LOSS        3e-3 /* of a swing's phase: how much later the spring is of what is followed */
#define RIGID       1e3  /* an impact of one step, over what moves its bodies as one */
#define FAST_TIMES  2.0  /* an impact approaches so much faster than loads make it in a step */
#define WANDER_MOST 0.3  /* of its arm: what a point may move in a step on its way */
#define PASSED_ON   0.1  /* of what loads do across the normal: others may make it so along it */

double se3di_convex_normal(const se3di_convex_contact *c, double h, double vn, double *slope)
{
    *slope = 0.0;
    if (c->way == SE3DI_CONVEX_TRACED) {
        return c->rise;
    }
    if (c->way != SE3DI_CONVEX_SPRING) {
        const double rest = c->damping * (c->rebound - vn);
        const double pull = c->rise - c->steepness * vn;
        const double cap = c->way == SE3DI_CONVEX_ROLL ? c->share[1] * c->bound : c->bound;
        const int slips = fabs(pull) > cap;
        if (c->way == SE3DI_CONVEX_IMPACT) {
            *slope = c->rebound > vn ? c->damping : 0.0;
            return fmax(0.0, rest);
        }
        *slope = c->damping + (slips ? 0.0 : c->steepness);
        return (slips ? copysign(cap, pull) : pull) + rest;
    }
    const double depth = c->overlap - c->lead * vn;
    double force = c->stiffness * depth, rate = c->stiffness;
    if (c->power > 1.0) {
        const double root = sqrt(fmax(0.0, depth));
        force *= root;
        rate *= 1.5 * root;
    }
    force -= c->damping * vn;
    if (!(force > 0.0)) {
        return 0.0;
    }
    *slope = h * (c->lead * rate + c->damping);
    return h * force;
}

void se3di_convex_impulse(const se3di_convex_contact *c, double h, const double v[3],
                          double impulse[3], double *slope)
{
    const double *n = c->normal;
    const double vn = se3di_dot(v, n);
    double normal_slope, pull[3];
    const double normal = se3di_convex_normal(c, h, vn, &normal_slope);
    for (int k = 0; k < 3; ++k) {
        pull[k] = -h * c->tangential * c->xi[k] - c->drag * (v[k] - vn * n[k]);
    }
    const double size = se3di_norm(pull), cap = se3di_convex_cap(c);
    const double give = size > cap ? cap / size : 1.0;
    se3di_scale(give, pull, impulse);
    se3di_add_scaled(normal - c->attraction, n, impulse);
    if (!slope) {
        return;
    }
    const double across = c->drag * give, along = give < 1.0 ? across / (size * size) : 0.0;
    for (int r = 0; r < 3; ++r) {
        for (int k = 0; k < 3; ++k) {
            slope[3 * r + k] = (normal_slope - across) * n[r] * n[k] - along * pull[r] * pull[k];
        }
        slope[3 * r + r] += across;
    }
}

double se3di_convex_along(const se3di_convex_contact *c, double h, const double v[3], double *bend)
{
    const double *n = c->normal, *d = c->change;
    const double vn = se3di_dot(v, n), dn = se3di_dot(d, n);
    double slope, pull[3], along = 0.0, size2 = 0.0, across = 0.0;
    const double normal = se3di_convex_normal(c, h, vn, &slope);
    for (int k = 0; k < 3; ++k) {
        const double dt = d[k] - dn * n[k];
        pull[k] = -h * c->tangential * c->xi[k] - c->drag * (v[k] - vn * n[k]);
        along += pull[k] * dt;
        size2 += pull[k] * pull[k];
        across += dt * dt;
    }
    const double cap = se3di_convex_cap(c);
    const int slips = size2 > cap * cap;
    const double give = slips ? cap / sqrt(size2) : 1.0;
    *bend = slope * dn * dn + c->drag * give * (across - (slips ? along * along / size2 : 0.0));
    return (normal - c->attraction) * dn + give * along;
}

/* The longest time in which a contact may be over, from its stiffness k and the mass it moves. */
int se3di_convex_is_short(double k, double inverse_mass, double h)
{
    return k * inverse_mass * (FEW_STEPS * h) * (FEW_STEPS * h) > PI * PI;
}

double se3di_convex_move_alone(const se3di_convex *c, const se3di_convex_contact *i,
                               const se3di_convex_contact *j)
{
    double sum = 0.0;
    for (int k = 0; k < 2; ++k) {
        if (i->free[k] >= 0) {
            const double *mobility = c->mobility + 10 * (size_t)i->free[k];
            double moment[2][3], turned[3];
            se3di_mul_transposed(i->lever[k], i->normal, moment[0]);
            se3di_mul_transposed(j->lever[k], j->normal, moment[1]);
            se3di_mul(mobility + 1, moment[1], turned);
            sum += i->reach * mobility[0] * se3di_dot(i->normal, j->normal);
            sum += se3di_dot(moment[0], turned);
        }
    }
    return sum;
}

/* The stiffness of a Hertzian spring that meets an approach u, or carries an overlap. */
static double hertz_stiffness(double k, double overlap, double inverse_mass, double u)
{
    return 1.5 * k * sqrt(fmax(overlap, se3di_convex_hertz_depth(k, inverse_mass, u)));
}

void se3di_convex_set_attraction(se3di_convex_contact *c, const se3di_model *model, double h,
                                 double u)
{
    const se3di_pair *pair = se3di_pair_of(model, c->record->shape_i, c->record->shape_j);
    if (pair->cohesion > 0.0 || pair->pull_off > 0.0) {
        const se3di_body_contact *r = c->record;
        const double radius = se3di_convex_radius(model, r);
        const double delta = c->overlap + (c->is_short ? 0.0 : c->lead * u);
        c->attraction = h * se3di_convex_attraction(pair, radius, delta);
    }
}

/* The dampers of the law, with its spring as stiff as it will be in the middle of the step. */
typedef struct damping {
    double along, across;
    double stiffness; /* of that spring */
} damping;

static damping damping_of(const se3di_convex_contact *c, const se3di_model *model, double h,
                          double u)
{
    const se3di_body_contact *record = c->record;
    const se3di_pair *pair = se3di_pair_of(model, record->shape_i, record->shape_j);
    const double middle = c->overlap + 0.5 * h * fmax(u, 0.0);
    const double now = c->power > 1.0
                           ? hertz_stiffness(c->stiffness, middle, record->inverse_mass, 0.0)
                           : c->stiffness;
    const double root =
        sqrt(now / (pair->kn * (c->power > 1.0 ? 1.5 : 1.0)) / record->inverse_mass);
    return (damping){.along = pair->dn * root, .across = pair->dt * root, .stiffness = now};
}

static double stiffness_of(const se3di_convex_contact *c, double inverse_mass, double u)
{
    return c->power > 1.0 ? hertz_stiffness(c->stiffness, c->overlap, inverse_mass, u)
                          : c->stiffness;
}

double se3di_convex_lead_of(double k, double inverse_mass, double h)
{
    const double rate = sqrt(k * inverse_mass);
    return LOSS < h * rate ? LOSS / rate : h;
}

double se3di_convex_before(double damper, double inverse_mass, double h)
{
    const double most = h * inverse_mass * damper;
    return (most > 1.0 ? 1.0 / most : 1.0) * 0.5 * damper;
}

/* The damper of a linear spring is that of the start of the step, as this is: it has a part of the
 * velocities of half a step before and after. It does not begin from nothing: in the step after the
 * one in which shapes have met, at the speed u, it acts from there to half a step on. */
static void set_damper(se3di_convex_contact *c, const damping *law, double inverse_mass, double h,
                       double u)
{
    double along = law->along, before = 0.0;
    if (!(c->power > 1.0)) {
        along *= c->overlap < h * u ? 0.5 + c->overlap / (h * u) : 1.0;
        before = se3di_convex_before(along, inverse_mass, h);
    }
    c->damping = se3di_convex_ease(along - before, c->lead * law->stiffness);
    c->overlap += before > 0.0 ? before * u / c->stiffness : 0.0;
}

/* What joints make heavy along the normal alone is light across it, where a spring that is that of
 * the end of the step is stable. */
void se3di_convex_follow_law(se3di_convex_contact *c, const se3di_model *model, double h, double u,
                             double inverse_mass)
{
    const damping law = damping_of(c, model, h, u);
    const int may_follow = !se3di_convex_is_short(c->tangential, c->record->inverse_mass, h);
    c->way = SE3DI_CONVEX_SPRING;
    c->is_short = 0;
    c->lead = se3di_convex_lead_of(inverse_mass > 0.0 ? stiffness_of(c, inverse_mass, u) : 0.0,
                                   inverse_mass, h);
    se3di_convex_set_attraction(c, model, h, u);
    const double yields = (may_follow ? c->lead : h) * c->tangential;
    set_damper(c, &law, inverse_mass, h, u);
    c->drag = h * (yields + se3di_convex_ease(law.across, yields));
}

int se3di_convex_is_over_soon(const se3di_convex_contact *c, double inverse_mass, double h,
                              double u)
{
    return inverse_mass > 0.0 && /* nothing moves what is driven */
           se3di_convex_is_short(stiffness_of(c, inverse_mass, u), inverse_mass, h);
}

/* Of the law, whose damper is that of the two bodies alone, where joints make them heavier. */
static double restitution_of(const se3di_convex_contact *c, const se3di_pair *pair)
{
    const double less = sqrt(c->response[0] / c->record->inverse_mass);
    const double zeta = less * pair->dn / sqrt(pair->kn);
    return !(less < 1.0)    ? pair->restitution
           : c->power > 1.0 ? se3di_restitution_hertz(zeta)
                            : se3di_restitution_hooke(0.5 * zeta);
}

/* The damper by which a spring that is over soon comes to rest. One at the end of a step is damped
 * as if by h k, the more of what is critical the stiffer it is: of what is held no more is added
 * than it needs, since what holds it may move it. */
static double settling_of(const se3di_convex_contact *c, double k, double h)
{
    const double phase = h * sqrt(k * c->response[0]);
    const int needs_less = c->is_held && SETTLED < (1.0 + SETTLING) * phase;
    return (needs_less ? fmax(0.0, SETTLED / phase - 1.0) : SETTLING) * h * k;
}

/* How it acts, and its dampers, for an approach `u` at the start of the step and what loads alone
 * add to it in the step. */
static void choose_way(se3di_convex_contact *c, const se3di_model *model, double h, double u,
                       double added)
{
    const se3di_body_contact *record = c->record;
    const se3di_pair *pair = se3di_pair_of(model, record->shape_i, record->shape_j);
    const double inverse_mass = c->response[0];
    if (!se3di_convex_is_over_soon(c, inverse_mass, h, u)) {
        se3di_convex_follow_law(c, model, h, u, inverse_mass);
        return;
    }
    const damping law = damping_of(c, model, h, u);
    c->way = SE3DI_CONVEX_SPRING;
    c->is_short = 1;
    c->lead = h;
    se3di_convex_set_attraction(c, model, h, u);
    c->damping = fmax(law.along, settling_of(c, stiffness_of(c, inverse_mass, u), h));
    c->drag = h * (h * c->tangential + fmax(law.across, settling_of(c, c->tangential, h)));
    const int parts = record->kind == SE3DI_CONTACT_PARTING && -u > FAST_TIMES * added;
    const int meets = u > FAST_TIMES * (added + c->attraction * inverse_mass) &&
                      !(c->is_held && h * u < c->overlap);
    const double leaves =
        meets ? se3di_convex_leave(model, record, restitution_of(c, pair), u) : 0.0;
    const int sticks = c->attraction > 0.0 && !(leaves > 0.0);
    if (parts || (meets && !sticks)) {
        c->way = SE3DI_CONVEX_IMPACT;
        c->damping = RIGID / inverse_mass;
        c->drag = pair->friction > 0.0 ? RIGID / inverse_mass : 0.0;
        c->tangential = 0.0;
        c->rebound = leaves;
        c->attraction = 0.0;
    }
}

void se3di_convex_let_rest(const se3di_convex *c, se3di_convex_contact *contact)
{
    const double u = -se3di_dot(contact->before, contact->normal);
    se3di_convex_set_law(contact, c->model);
    choose_way(contact, c->model, c->h, u, HUGE_VAL);
}

void se3di_convex_set_law(se3di_convex_contact *c, const se3di_model *model)
{
    const se3di_body_contact *r = c->record;
    const se3di_pair *pair = se3di_pair_of(model, r->shape_i, r->shape_j);
    const int hertz = se3di_pair_is_hertz(pair);
    const double radius = se3di_convex_radius(model, r);
    c->overlap = r->overlap;
    c->power = hertz ? 1.5 : 1.0;
    c->stiffness = pair->kn * (hertz ? sqrt(radius) : 1.0);
    c->tangential = se3di_pair_kt(pair, hertz ? sqrt(radius * r->overlap) : 1.0);
    c->friction = pair->friction;
    c->rebound = pair->restitution;
}

static void set_geometry(se3di_convex_contact *c, const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    const se3di_body_contact *r = c->record;
    double anchor[2][3];
    se3di_copy(r->normal, c->normal);
    for (int k = 0; k < 2; ++k) {
        const uint32_t body = model->shapes[k ? r->shape_j : r->shape_i].body;
        const se3di_frame *frame = &model->frames[body];
        double arm[3], tilde[9];
        c->free[k] = assembly->free_index[body];
        se3di_sub(r->point, frame->r, arm);
        se3di_copy(arm, c->arm[k]);
        se3di_tilde(arm, tilde);
        se3di_mat_mul(tilde, frame->A, c->lever[k]);
        for (int e = 0; e < 9; ++e) {
            c->lever[k][e] = -c->lever[k][e];
        }
        se3di_mul(frame->A, k ? r->anchor_j : r->anchor_i, anchor[k]);
        se3di_add(anchor[k], frame->r, anchor[k]);
    }
    se3di_sub(anchor[1], anchor[0], c->xi);
    se3di_add_scaled(-se3di_dot(c->xi, c->normal), c->normal, c->xi);
}

/* As it is half a step on, on a surface that turns: what sticks to it stays on its circle. */
static void set_drift(se3di_convex_contact *c, const se3di_model *model, double h)
{
    const se3di_body_contact *r = c->record;
    for (int k = 0; k < 2; ++k) {
        const se3di_shape *s = &model->shapes[k ? r->shape_j : r->shape_i];
        const se3di_frame *frame = &model->frames[s->body];
        double arm[3], local[3], half[3], u[3], now[3], spin[3];
        if (!se3di_surface_moves(s)) {
            continue;
        }
        se3di_sub(r->point, frame->r, arm);
        se3di_surface_velocity(s, frame->A, arm, now, spin);
        se3di_mul_transposed(frame->A, arm, local);
        se3di_surface_carry(s, 0.5 * h, local, half);
        se3di_mul(frame->A, half, arm);
        se3di_surface_velocity(s, frame->A, arm, u, spin);
        se3di_add_scaled(k ? 1.0 : -1.0, u, c->drift);
        se3di_sub(u, now, u);
        se3di_add_scaled(k ? 1.0 : -1.0, u, c->ahead);
    }
    se3di_add_scaled(-se3di_dot(c->drift, c->normal), c->normal, c->drift);
    se3di_add_scaled(-se3di_dot(c->ahead, c->normal), c->normal, c->ahead);
}

/* What loads alone make of the velocities of the two points in the step, from `start` to `aim`,
 * along the normal: of each body by itself, since what carries one of them lets the other go on;
 * and what comes through other contacts of loads across it. */
static double loads_change(const se3di_convex_contact *c, const double *start, const double *aim)
{
    double sum = 0.0, all = 0.0;
    for (int k = 0; k < 2; ++k) {
        if (c->free[k] >= 0) {
            const size_t at = 6 * (size_t)c->free[k];
            double turn[3], change[3];
            se3di_sub(aim + at + 3, start + at + 3, turn);
            se3di_mul(c->lever[k], turn, change);
            se3di_add(change, aim + at, change);
            se3di_sub(change, start + at, change);
            sum += fabs(se3di_dot(change, c->normal));
            all += se3di_norm(change);
        }
    }
    return fmax(sum, PASSED_ON * all);
}

/* The approach at the start of the step, and how far the point wanders if it is no impact. */
static double see_approach(se3di_convex_contact *c, double h)
{
    memset(c->shift, 0, sizeof c->shift);
    if (c->record->kind == SE3DI_CONTACT_STEPPED) {
        se3di_scale(0.5 * h, c->record->wander, c->shift);
    }
    return se3di_convex_approach(c);
}

void se3di_convex_choose_contact(const se3di_convex *convex, se3di_convex_contact *c,
                                 const double *start, const double *aim)
{
    se3di_convex_set_law(c, convex->model);
    const double u = see_approach(c, convex->h);
    choose_way(c, convex->model, convex->h, u, loads_change(c, start, aim));
    if (c->way == SE3DI_CONVEX_IMPACT) {
        memset(c->shift, 0, sizeof c->shift);
    }
}

static void collect_one(se3di_convex *convex, const se3di_assembly *assembly,
                        const se3di_body_contact *record)
{
    const se3di_model *model = assembly->model;
    se3di_convex_contact *c = &convex->contacts[convex->contact_count];
    *c = (se3di_convex_contact){.record = record, .coupling = -1, .partner = -1, .reach = 1.0};
    set_geometry(c, assembly);
    if (c->free[0] < 0 && c->free[1] < 0) {
        return;
    }
    set_drift(c, model, convex->h);
    se3di_convex_slip(c, convex->start, c->before);
    if (assembly->row_count > 0) {
        se3di_convex_velocity(c, convex->chord, c->chord);
    }
    c->response[0] = record->inverse_mass;
    se3di_convex_choose_contact(convex, c, convex->start, convex->aim);
    c->bound = convex->h * c->friction * fmax(0.0, se3di_dot(record->force, c->normal));
    for (int k = 0; k < 2; ++k) {
        if (c->free[k] >= 0) {
            convex->touched[c->free[k]] = 1;
        }
    }
    ++convex->contact_count;
}

se3d_status se3di_convex_collect(se3di_convex *convex, const se3di_assembly *assembly,
                                 se3di_error *error)
{
    const se3di_model *model = assembly->model;
    const size_t count = model->contacts.count;
    void *contacts = convex->contacts;
    const se3d_status status = se3di_array_reserve(
        &model->allocator, &contacts, &convex->contact_capacity, count, sizeof *convex->contacts);
    convex->contacts = contacts;
    if (status < 0 || se3di_convex_mark(convex, assembly) < 0) {
        return se3di_error_set(error, SE3D_ERR_NO_MEMORY, "t = %g s: no memory for %zu contacts",
                               model->time, count);
    }
    convex->contact_count = 0;
    memset(convex->touched, 0, assembly->body_count);
    for (size_t k = 0; k < count; ++k) {
        const se3di_body_contact *record = &model->contacts.list[k];
        if (!convex->frozen[model->shapes[record->shape_i].body] ||
            !convex->frozen[model->shapes[record->shape_j].body]) {
            collect_one(convex, assembly, record);
        }
    }
    convex->shape_count = convex->contact_count;
    return SE3D_OK;
}

/* Of spring and damper together at the end of the step [N]. */
static void pull_of(const se3di_convex_contact *c, double h, const double xi[3], double pull[3])
{
    const double damper = c->drag / h - h * c->tangential;
    for (int k = 0; k < 3; ++k) {
        pull[k] = -c->tangential * xi[k] - damper * (xi[k] - c->xi[k]) / h;
    }
}

/* The stretch at the end of the step, no longer than what friction holds. */
static void stretch_after(const se3di_convex_contact *c, double h, double xi[3])
{
    const double vn = se3di_dot(c->v, c->normal);
    double held[3], pull[3];
    xi[0] = xi[1] = xi[2] = 0.0;
    if (!(c->tangential > 0.0)) {
        return;
    }
    for (int k = 0; k < 3; ++k) {
        xi[k] = c->xi[k] + h * (c->v[k] - vn * c->normal[k]);
    }
    se3di_copy(c->impulse, held);
    se3di_add_scaled(-se3di_dot(c->impulse, c->normal), c->normal, held);
    const double cap = c->bound / (h * c->tangential);
    const double size = se3di_norm(held), length = se3di_norm(xi);
    if (size >= (1.0 - 1e-9) * c->bound && !c->is_short) { /* it slips, as the law says */
        pull_of(c, h, xi, pull);
        const double wanted = se3di_norm(pull);
        se3di_encounter_settle(c->tangential, c->bound / h, size / fmax(size, h * wanted), pull, xi,
                               held);
        se3di_copy(held, xi);
    } else if (size >= (1.0 - 1e-9) * c->bound) { /* the spring pulls as friction does */
        se3di_scale(size > 0.0 ? -fmin(cap, length) / size : 0.0, held, xi);
    } else if (length > cap && c->is_short) {
        se3di_scale(cap / length, xi, xi);
    }
}

static void set_anchors(const se3di_model *model, se3di_body_contact *r, const double xi[3])
{
    for (int k = 0; k < 2; ++k) {
        const se3di_frame *frame = &model->frames[model->shapes[k ? r->shape_j : r->shape_i].body];
        double at[3];
        se3di_sub(r->point, frame->r, at);
        se3di_add_scaled(k ? 0.5 : -0.5, xi, at);
        se3di_mul_transposed(frame->A, at, k ? r->anchor_j : r->anchor_i);
    }
}

/* What a surface that turns on its body has at the point, arm [2] before and after the step, more
 * than where the point before was carried to: a ball on a turntable rolls from place to place of
 * it. Along the normal n it does not move: a roller turns under what lies on it. */
static void surface_wander(const se3di_shape *s, const se3di_frame *frame,
                           const double *const arm[2], const double n[3], double h, double more[3])
{
    double w[3], turned[3], local[3], carried[3], u[3], spin[3];
    se3di_mul(frame->A, frame->w, w);
    se3di_cross(w, arm[0], turned);
    se3di_scale(h, turned, turned);
    se3di_add(turned, arm[0], turned);
    se3di_mul_transposed(frame->A, turned, local);
    se3di_surface_carry(s, h, local, carried);
    se3di_mul(frame->A, carried, turned);
    se3di_surface_velocity(s, frame->A, turned, u, spin);
    se3di_surface_velocity(s, frame->A, arm[1], more, spin);
    se3di_sub(more, u, more);
    se3di_add_scaled(-se3di_dot(more, n), n, more);
}

/* How the velocity of the two surfaces at the point changes as the point wanders on them, and turns
 * with them: w x d(arm)/dt, of j less that of i. A point that jumps says nothing of it. And what of
 * it becomes normal as the normal turns: on a dome, what slides recedes from the plane that it
 * touches. */
static void set_wander(const se3di_convex_contact *c, const se3di_model *model, double h,
                       se3di_body_contact *r)
{
    for (int k = 0; k < 2; ++k) {
        const se3di_shape *shape = &model->shapes[k ? r->shape_j : r->shape_i];
        const se3di_frame *frame = &model->frames[shape->body];
        double arm[3], w[3], moved[3], rate[3], more[3];
        se3di_sub(r->point, frame->r, arm);
        se3di_sub(arm, c->arm[k], moved);
        if (se3di_norm(moved) < WANDER_MOST * se3di_norm(arm)) {
            se3di_mul(frame->A, frame->w, w);
            se3di_cross(w, moved, rate);
            if (se3di_surface_moves(shape)) {
                const double *const arms[2] = {c->arm[k], arm};
                surface_wander(shape, frame, arms, r->normal, h, more);
                se3di_add(rate, more, rate);
            }
            se3di_add_scaled((k ? 1.0 : -1.0) / h, rate, r->wander);
        }
    }
    double turned[3], v[3];
    se3di_sub(r->normal, c->normal, turned);
    if (se3di_norm(turned) < WANDER_MOST) {
        se3di_sub(c->v, c->drift, v);
        se3di_add_scaled(se3di_dot(turned, v) / h, r->normal, r->wander);
    }
}

/* A contact that acted in the step, and lasts. Its `energy` is for se3di_convex_store. */
static void record_one(const se3di_convex *convex, const se3di_convex_contact *c,
                       const se3di_model *model, se3di_body_contact *r)
{
    double xi[3] = {0.0, 0.0, 0.0};
    r->kind = c->way == SE3DI_CONVEX_SPRING ? SE3DI_CONTACT_STEPPED : SE3DI_CONTACT_PARTING;
    se3di_add_scaled(1.0 / convex->h, c->impulse, r->force);
    se3di_convex_add_moment(convex, c, model, r->torque);
    if (c->way == SE3DI_CONVEX_SPRING) {
        r->energy = c->is_short ? 0.0 : 0.5 * convex->h * se3di_dot(c->v, c->normal);
        stretch_after(c, convex->h, xi);
        se3di_add_scaled(-se3di_dot(xi, r->normal), r->normal, xi);
        se3di_convex_turn_stretch(model, r, convex->h, xi);
    }
    set_anchors(model, r, xi);
    if (c->way == SE3DI_CONVEX_SPRING) {
        set_wander(c, model, convex->h, r);
        se3di_convex_record_rolling(convex, c, r);
    }
}

/* How far the point of `c` is from that of `r`, over their arms; 1 where a body says it is another
 * place. */
static double distance_of(const se3di_convex_contact *c, const se3di_model *model,
                          const se3di_body_contact *r)
{
    double most = 0.0;
    for (int k = 0; k < 2; ++k) {
        double arm[3], moved[3];
        if (c->free[k] >= 0) {
            const uint32_t body = model->shapes[k ? r->shape_j : r->shape_i].body;
            se3di_sub(r->point, model->frames[body].r, arm);
            se3di_sub(arm, c->arm[k], moved);
            const double size = se3di_norm(arm), way = se3di_norm(moved);
            most = fmax(most, way < WANDER_MOST * size ? way / size : 1.0);
        }
    }
    return most;
}

static int is_same(const se3di_body_contact *a, const se3di_body_contact *b)
{
    return a->shape_i == b->shape_i && a->shape_j == b->shape_j && a->feature == b->feature;
}

/* What acted in the step, on the contacts of its pair at the end, which begin at `next`: a point
 * that has come to the next facet presses there. */
static void record_contact(const se3di_convex *convex, const se3di_convex_contact *c,
                           const se3di_model *model, se3di_body_contact *next,
                           const se3di_body_contact *end)
{
    se3di_body_contact *nearest = NULL;
    double least = 1.0;
    for (se3di_body_contact *r = next; r < end && !se3di_convex_is_before(c->record, r); ++r) {
        if (r->kind == SE3DI_CONTACT_NEW && is_same(c->record, r)) {
            record_one(convex, c, model, r);
            return;
        }
    }
    for (; next < end && !se3di_convex_is_before(c->record, next); ++next) {
        const double distance = distance_of(c, model, next);
        if (distance < least) {
            least = distance;
            nearest = next;
        }
    }
    if (nearest) {
        se3di_add_scaled(1.0 / convex->h, c->impulse, nearest->force);
        se3di_convex_add_moment(convex, c, model, nearest->torque);
    }
}

void se3di_convex_record(const se3di_convex *convex, se3di_model *model)
{
    const double none[3] = {0.0, 0.0, 0.0};
    se3di_body_contact *next = model->contacts.next;
    if (model->contacts.next_count == 0) {
        return;
    }
    const se3di_body_contact *end = next + model->contacts.next_count;
    for (se3di_body_contact *r = next; r < end; ++r) {
        if (se3di_contact_is_frozen(model, r->shape_i, r->shape_j)) {
            continue;
        }
        r->kind = SE3DI_CONTACT_NEW;
        r->energy = 0.0;
        memset(r->force, 0, sizeof r->force);
        memset(r->torque, 0, sizeof r->torque);
        memset(r->roll, 0, sizeof r->roll);
        memset(r->wander, 0, sizeof r->wander);
        r->twist = 0.0;
    }
    for (size_t k = 0; k < convex->shape_count; ++k) {
        const se3di_convex_contact *c = &convex->contacts[k];
        while (next < end && se3di_convex_is_before(next, c->record)) {
            ++next;
        }
        record_contact(convex, c, model, next, end);
    }
    for (se3di_body_contact *r = model->contacts.next; r < end; ++r) {
        if (r->kind == SE3DI_CONTACT_NEW && /* none acted there */
            !se3di_contact_is_frozen(model, r->shape_i, r->shape_j)) {
            set_anchors(model, r, none);
        }
    }
}
