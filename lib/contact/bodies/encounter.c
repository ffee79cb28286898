/* SPDX-License-Identifier: BSD-3-Clause */
/* The law at one point, the same as that of particles (docs/theory/contact-laws.md): with v the
 * velocity of j relative to i at the point, n from i to j, s = 1 (hooke) or sqrt(R* delta),
 *
 *     Fn = max(0, kn s delta - dn sqrt(m* s) vn)        on j along n, less cohesion
 *     Ft = -kt s xi - dt sqrt(m* s) vt,                 |Ft| <= mu Fn
 *     xi = xj - xi of two points that were one when contact began, in the tangent plane
 *     1/m* = sum over free bodies of 1/m + (a x n) . J^-1 (a x n),
 *            over the points that share a load
 *
 * so that sticking is elastic and does not creep, whatever the method. In the step in which contact
 * begins the damping grows with the share of the step that is spent in contact: forces are
 * continuous where implicit methods look for a solution.              docs/theory/body-contact.md
 */
#include "contact/bodies/encounter.h"

#include "contact/bodies/law.h"
#include "math/elementary.h"
#include "math/inertia.h"
#include "math/over.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define MASS_STEP   2e-3 /* by which the effective mass of a contact changes */
#define LEAST_SHARE 0.01 /* of a step in contact: w does not grow further */

double se3di_shapes_contact_radius(const se3di_shape *i, const se3di_shape *j)
{
    double curvature = 1.0 / se3di_shape_contact_radius(i) + 1.0 / se3di_shape_contact_radius(j);
    return curvature > 0.0 ? 1.0 / curvature
                           : fmin(se3di_shape_contact_size(i), se3di_shape_contact_size(j));
}

void se3di_encounter_turn_by(const se3di_body *body, const se3di_frame *frame, const double a[3],
                             double out[3])
{
    double J[9], local[3], x[3];
    se3di_inertia_matrix(body->J, J);
    se3di_mul_transposed(frame->A, a, local);
    const double c0[3] = {J[0], J[3], J[6]}, c1[3] = {J[1], J[4], J[7]}, c2[3] = {J[2], J[5], J[8]};
    double c12[3], c20[3], c01[3];
    se3di_cross(c1, c2, c12);
    se3di_cross(c2, c0, c20);
    se3di_cross(c0, c1, c01);
    double det = se3di_dot(c0, c12);
    if (!(det > 0.0)) {
        memset(out, 0, 3 * sizeof *out);
        return;
    }
    x[0] = se3di_dot(c12, local) / det;
    x[1] = se3di_dot(c20, local) / det;
    x[2] = se3di_dot(c01, local) / det;
    se3di_mul(frame->A, x, out);
}

static void eval_mass(se3di_encounter *e)
{
    e->alone = 0.0;
    for (int k = 0; k < 2; ++k) {
        const se3di_body *body = &e->model->bodies[e->body[k]];
        memset(e->turned[k], 0, sizeof e->turned[k]);
        se3di_cross(e->arm[k], e->at->normal, e->lever[k]);
        if (!body->fixed) {
            se3di_encounter_turn_by(body, &e->model->frames[e->body[k]], e->lever[k], e->turned[k]);
            e->alone += 1.0 / body->mass + se3di_dot(e->lever[k], e->turned[k]);
        }
    }
}

/* The acceleration of point i along its normal by a unit force at point j along its own. */
static double response(const se3di_encounter *i, const se3di_encounter *j)
{
    double sum = 0.0;
    for (int k = 0; k < 2; ++k) {
        const se3di_body *body = &i->model->bodies[i->body[k]];
        if (!body->fixed) {
            sum += se3di_dot(i->at->normal, j->at->normal) / body->mass +
                   se3di_dot(i->lever[k], j->turned[k]);
        }
    }
    return sum;
}

void se3di_encounter_share(se3di_encounter *points, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        se3di_encounter *e = &points[i];
        e->shared = e->alone;
        for (uint32_t j = 0; j < count; ++j) {
            const double weight =
                se3di_encounter_weight(e->at->overlap, points[j].at->overlap, e->radius);
            e->shared += i == j ? 0.0 : weight * response(e, &points[j]);
        }
        e->shared = fmax(e->shared, SE3DI_SHARE_MIN * e->alone);
        e->inverse_mass =
            e->memory && e->model->contacts.step > 0.0 ? e->memory->inverse_mass : e->shared;
        e->root_mass = se3di_over(1.0, sqrt(e->inverse_mass));
    }
}

static void eval_velocity(se3di_encounter *e)
{
    const double *n = e->at->normal;
    double at[2][3];
    for (int k = 0; k < 2; ++k) {
        const se3di_frame *frame = &e->model->frames[e->body[k]];
        se3di_sub(e->at->point, frame->r, e->arm[k]);
        se3di_mul(frame->A, frame->w, e->w[k]);
        se3di_cross(e->w[k], e->arm[k], at[k]);
        se3di_add(frame->v, at[k], at[k]);
    }
    se3di_sub(at[1], at[0], e->v);
    se3di_encounter_drift(e);
    se3di_add(e->v, e->drift, e->v);
    e->vn = se3di_dot(e->v, n);
    se3di_copy(e->v, e->vt);
    se3di_add_scaled(-e->vn, n, e->vt);
}

/* Time since a new contact began, within the step; 0 if the step is not known. */
static double time_since(const se3di_encounter *e)
{
    double step = e->model->contacts.step;
    return e->vn * step < -e->at->overlap ? -e->at->overlap / e->vn : step;
}

/* What is left perpendicular to the normal. */
static void project(const double n[3], double x[3])
{
    se3di_add_scaled(-se3di_dot(n, x), n, x);
}

void se3di_encounter_anchor(const se3di_encounter *e, int k, double out[3])
{
    const se3di_shape *s = &e->model->shapes[k ? e->shape_j : e->shape_i];
    const double *anchor = k ? e->memory->anchor_j : e->memory->anchor_i;
    double carried[3];
    if (se3di_surface_moves(s)) {
        se3di_surface_carry(s, e->elapsed, anchor, carried);
        anchor = carried;
    }
    se3di_mul(e->model->frames[e->body[k]].A, anchor, out);
}

/* The rotation of surface j relative to i since the last accepted state, ground frame. */
static void eval_turn(const se3di_encounter *e, double out[3])
{
    const double *pi = e->model->frames[e->body[0]].p;
    const double back[4] = {pi[0], -pi[1], -pi[2], -pi[3]};
    const double *m = e->memory->turn;
    const double before[4] = {m[0], -m[1], -m[2], -m[3]};
    double now[4], turn[4], local[3];
    se3di_quat_mul(back, e->model->frames[e->body[1]].p, now);
    se3di_quat_mul(now, before, turn); /* in the frame of i */
    double size = sqrt(turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3]);
    double angle = 2.0 * se3di_atan2(turn[0] < 0.0 ? -size : size, fabs(turn[0]));
    se3di_scale(size > 0.0 ? angle / size : 2.0, turn + 1, local);
    se3di_mul(e->model->frames[e->body[0]].A, local, out);
    se3di_add_scaled(e->elapsed, e->surface_w[1], out);
    se3di_add_scaled(-e->elapsed, e->surface_w[0], out);
}

/* The factor of the damping force, which grows as s^a with the time since contact began (a = 0, or
 * 1/4 with hertz_mindlin), at the end of the step of which the share `phi` is spent in contact. The
 * forces at the ends of all later steps, with equal weights, make of the integral of s^a
 *
 *     h^(1+a) sum_{n>=1} (phi + n)^a = integral + h^(1+a) zeta(-a, 1 + phi),
 *
 * so that this one needs the weight w = -zeta(-a, 1 + phi) / phi^a (Euler-Maclaurin); it has
 * 1 - weight from the next step. */
static double onset(const se3di_encounter *e, double phi)
{
    double a = e->law == SE3DI_LAW_HERTZ_MINDLIN ? 0.25 : 0.0;
    double weight = e->model->contacts.weight;
    if (!(weight < 1.0)) {
        return phi;
    }
    if (!e->model->contacts.jumps) { /* continuous, and right where contact begins with the step */
        return phi * (a > 0.0 ? 0.8205 : 1.0) / weight;
    }
    double q = 1.0 + phi;
    phi = fmax(phi, LEAST_SHARE);
    double w = se3di_pow(q, a) * (q / (1.0 + a) - 0.5 + a / (12.0 * q)) * se3di_pow(phi, -a);
    return (w - 1.0 + weight) / weight;
}

static void eval_memory(se3di_encounter *e)
{
    const double *n = e->at->normal;
    double time = time_since(e);
    double step = e->model->contacts.step;
    e->onset = 1.0;
    e->twist = 0.0;
    memset(e->rho, 0, sizeof e->rho);
    if (!e->memory) {
        e->onset = step > 0.0 ? onset(e, time / step) : 1.0;
        se3di_scale(time, e->vt, e->xi);
        return;
    }
    double x[2][3];
    for (int k = 0; k < 2; ++k) {
        se3di_encounter_anchor(e, k, x[k]);
        se3di_add(e->model->frames[e->body[k]].r, x[k], x[k]);
        se3di_encounter_unroll(e, k, x[k]);
    }
    se3di_sub(x[1], x[0], e->xi);
    project(n, e->xi);
    eval_turn(e, e->turn);
    se3di_scale(0.5, x[0], x[0]);
    se3di_add_scaled(0.5, x[1], x[0]);
    se3di_encounter_wander(e, x[0]);
    if (e->pair.rolling > 0.0 || e->pair.torsion > 0.0) {
        se3di_copy(e->memory->roll, e->rho);
        se3di_add_scaled(e->radius, e->turn, e->rho);
        project(n, e->rho);
        e->twist = e->memory->twist + e->radius * se3di_dot(e->turn, n);
    }
}

/* The factor that brings a size down to its cap. */
static double cap_factor(double size, double cap)
{
    return size > cap ? cap / size : 1.0;
}

static void eval_rolling(se3di_encounter *e)
{
    const double *n = e->at->normal;
    double spin[3];
    memset(e->moment, 0, sizeof e->moment);
    memset(e->bend, 0, sizeof e->bend);
    e->wring = 0.0;
    e->yield = e->slack = 1.0;
    if (!(e->pair.rolling > 0.0 || e->pair.torsion > 0.0)) {
        return;
    }
    double k = se3di_pair_kr(&e->pair, e->s);
    double c = e->pair.dr * e->root_mass * se3di_pair_turn(&e->pair, e->root);
    se3di_encounter_spin(e, spin);
    double turn = se3di_dot(spin, n);
    project(n, spin);
    se3di_add_scaled(-k, e->rho, e->bend);
    se3di_add_scaled(-c * e->radius, spin, e->bend);
    e->wring = -k * e->twist - c * e->radius * turn;
    e->yield = cap_factor(se3di_norm(e->bend), e->pair.rolling * e->normal);
    e->slack = cap_factor(fabs(e->wring), e->pair.torsion * e->normal);
    se3di_add_scaled(e->radius * e->yield, e->bend, e->moment);
    se3di_add_scaled(e->radius * e->slack * e->wring, n, e->moment);
}

void se3di_encounter_place(se3di_encounter *e)
{
    const se3di_model *model = e->model;
    const se3di_shape *i = &model->shapes[e->shape_i];
    const se3di_shape *j = &model->shapes[e->shape_j];
    e->body[0] = i->body;
    e->body[1] = j->body;
    e->pair = *se3di_pair_of(model, e->shape_i, e->shape_j);
    e->law = e->pair.law;
    e->radius = se3di_shapes_contact_radius(i, j);
    eval_velocity(e);
    eval_mass(e);
    e->s = e->law == SE3DI_LAW_HERTZ_MINDLIN ? sqrt(e->radius * e->at->overlap) : 1.0;
    e->root = sqrt(e->s);
}

void se3di_encounter_eval(se3di_encounter *e)
{
    double delta = e->at->overlap;
    eval_memory(e);
    if (e->law == SE3DI_LAW_CALLBACK) {
        se3di_encounter_call(e);
        return;
    }
    e->elastic = e->pair.kn * e->s * delta;
    const double kt = se3di_pair_kt(&e->pair, e->s);
    e->normal = fmax(0.0, e->elastic - e->onset * e->pair.dn * e->root_mass * e->root * e->vn);
    e->stick = 2.0 * sqrt(e->pair.pull_off * e->radius * e->elastic);
    e->attraction = e->pair.cohesion * e->radius * delta + e->stick;
    for (int a = 0; a < 3; ++a) {
        e->pull[a] = -kt * e->xi[a] - e->pair.dt * e->root_mass * e->root * e->vt[a];
    }
    e->give = cap_factor(se3di_norm(e->pull), e->pair.friction * e->normal);
    se3di_scale(e->give, e->pull, e->force);
    se3di_add_scaled(e->normal - e->attraction, e->at->normal, e->force);
    eval_rolling(e);
}

void se3di_encounter_wrench(const se3di_encounter *e, double wrench[12])
{
    for (int k = 0; k < 2; ++k) {
        double torque[3];
        double sign = k ? 1.0 : -1.0;
        se3di_cross(e->arm[k], e->force, torque);
        se3di_add(torque, e->moment, torque);
        se3di_scale(sign, torque, torque);
        se3di_scale(sign, e->force, wrench + 6 * k);
        se3di_mul_transposed(e->model->frames[e->body[k]].A, torque, wrench + 6 * k + 3);
    }
}

void se3di_encounter_settle(double k, double cap, double factor, const double pull[3],
                            const double x[3], double out[3])
{
    const double held = k * se3di_norm(x);
    se3di_copy(x, out);
    if (!(factor < 1.0)) {
        return;
    }
    if (held > se3di_norm(pull)) {
        se3di_add_scaled((1.0 - factor) / k, pull, out);
    } else {
        se3di_scale(held > cap ? cap / held : 1.0, out, out);
    }
}

static void settled_xi(const se3di_encounter *e, double xi[3])
{
    if (e->law == SE3DI_LAW_CALLBACK) {
        se3di_copy(e->spring, xi);
        return;
    }
    const double kt = se3di_pair_kt(&e->pair, e->s);
    se3di_encounter_settle(kt, e->pair.friction * e->normal, e->give, e->pull, e->xi, xi);
}

/* Rolling and torsion as the caps leave them. */
static void settled_roll(const se3di_encounter *e, double rho[3], double *twist)
{
    double out[3];
    double k = se3di_pair_kr(&e->pair, e->s);
    const double wring[3] = {e->wring, 0.0, 0.0};
    const double now[3] = {e->twist, 0.0, 0.0};
    se3di_encounter_settle(k, e->pair.rolling * e->normal, e->yield, e->bend, e->rho, rho);
    se3di_encounter_settle(k, e->pair.torsion * e->normal, e->slack, wring, now, out);
    *twist = out[0];
}

void se3di_encounter_spring(const se3di_encounter *e, double wrench[12])
{
    const double kt = se3di_pair_kt(&e->pair, e->s), kr = se3di_pair_kr(&e->pair, e->s);
    se3di_encounter kept = *e;
    double xi[3], rho[3], twist;
    settled_xi(e, xi);
    settled_roll(e, rho, &twist);
    se3di_add_scaled(twist, e->at->normal, rho);
    se3di_scale(-kt, xi, kept.force);
    se3di_scale(-kr * e->radius, rho, kept.moment);
    se3di_encounter_wrench(&kept, wrench);
}

/* Not every small change of it: each is a jump of the damping. */
static double settled_mass(const se3di_encounter *e)
{
    return fabs(e->shared - e->inverse_mass) > MASS_STEP * e->inverse_mass ? e->shared
                                                                           : e->inverse_mass;
}

double se3di_encounter_energy(const se3di_encounter *e)
{
    double xi[3], rho[3], twist;
    settled_xi(e, xi);
    settled_roll(e, rho, &twist);
    double share = e->law == SE3DI_LAW_HERTZ_MINDLIN ? 0.4 : 0.5;
    const double rolled = e->pair.kr * (se3di_dot(rho, rho) + twist * twist);
    const double slid = e->pair.kt * se3di_dot(xi, xi);
    const double springs =
        (e->pair.kt_constant ? 0.0 : slid) + (e->pair.kr_constant ? 0.0 : rolled);
    const double constant =
        0.5 * ((e->pair.kt_constant ? slid : 0.0) + (e->pair.kr_constant ? rolled : 0.0));
    /* the integrals of the attractions over the overlap */
    double depth = e->law == SE3DI_LAW_HERTZ_MINDLIN ? 4.0 / 7.0 : 2.0 / 3.0;
    double stuck = (0.5 * (e->attraction - e->stick) + depth * e->stick) * e->at->overlap;
    return share * e->elastic * e->at->overlap + 0.5 * e->s * springs + constant - stuck;
}

double se3di_encounter_power(const se3di_encounter *e)
{
    double spin[3];
    se3di_encounter_spin(e, spin);
    return -se3di_dot(e->force, e->v) - se3di_dot(e->moment, spin);
}

void se3di_encounter_record_place(const se3di_encounter *e, se3di_body_contact *record)
{
    const double *pi = e->model->frames[e->body[0]].p;
    const double back[4] = {pi[0], -pi[1], -pi[2], -pi[3]};
    memset(record, 0, sizeof *record);
    record->shape_i = e->shape_i;
    record->shape_j = e->shape_j;
    record->feature = e->at->feature;
    se3di_quat_mul(back, e->model->frames[e->body[1]].p, record->turn);
    se3di_copy(e->at->point, record->point);
    se3di_copy(e->at->normal, record->normal);
    record->overlap = e->at->overlap;
    record->inverse_mass = settled_mass(e);
    se3di_encounter_spins(e, record->spin);
}

void se3di_encounter_record(const se3di_encounter *e, se3di_body_contact *record)
{
    double xi[3], at[3], half[3];
    se3di_encounter_record_place(e, record);
    settled_xi(e, xi);
    settled_roll(e, record->roll, &record->twist);
    for (int k = 0; k < 2; ++k) {
        se3di_copy(e->arm[k], at);
        se3di_scale(k ? 0.5 : -0.5, xi, half);
        se3di_add(at, half, at);
        se3di_encounter_roll_up(e, k, half, at);
        se3di_mul_transposed(e->model->frames[e->body[k]].A, at,
                             k ? record->anchor_j : record->anchor_i);
    }
    se3di_copy(e->force, record->force);
    se3di_copy(e->moment, record->torque);
}
