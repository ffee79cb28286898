/* SPDX-License-Identifier: BSD-3-Clause */
/* Rolling and torsional friction of contacts in a step of convex: of each contact whose materials
 * have any, a contact more whose velocity is u = R* (w_j - w_i). With k and c of the law
 * (docs/theory/contact-laws.md), across the normal and along it,
 *
 *     p = y, or what its cap leaves of it,   y = -h (k (rho + h u) + d u)
 *     caps: rolling p_n, torsion p_n         p_n of the contact
 *
 * so the moment on j is R* p. What rolls and spins is damped as what slides is. An impact of one
 * step has no spring: it stops what rolls, as far as the caps let it.  docs/theory/convex.md */
#include "integrator/convex.h"

#include "contact/bodies/encounter.h"
#include "contact/bodies/law.h"
#include "math/inertia.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define SETTLING 4.0 /* steps in which what is hard comes to rest */
#define RIGID    1e3 /* an impact of one step, over what turns its bodies */

/* k and c of the law. */
static double stiffness_of(const se3di_model *model, const se3di_body_contact *r, double *damping)
{
    const se3di_pair *pair = se3di_pair_of(model, r->shape_i, r->shape_j);
    const int hertz = se3di_pair_is_hertz(pair);
    const double s = hertz ? sqrt(se3di_convex_radius(model, r) * r->overlap) : 1.0;
    *damping = pair->dr * sqrt(se3di_pair_turn(pair, s) / r->inverse_mass);
    return se3di_pair_kr(pair, s);
}

/* What an impulse does to u at most. */
static double response_of(const se3di_convex_contact *row, const se3di_assembly *assembly,
                          double radius)
{
    double sum = 0.0;
    for (int k = 0; k < 2; ++k) {
        if (row->free[k] >= 0) {
            double J[9], x[3];
            se3di_inertia_matrix(assembly->model->bodies[assembly->free_body[row->free[k]]].J, J);
            for (int e = 0; e < 3; ++e) {
                const double one[3] = {e == 0, e == 1, e == 2};
                se3di_solve3(J, one, x);
                sum += radius * radius * x[e];
            }
        }
    }
    return sum;
}

void se3di_convex_choose_rolling(se3di_convex *c, const se3di_convex_contact *contact)
{
    const se3di_body_contact *r = contact->record;
    const se3di_model *model = c->model;
    const double h = c->h, twist = r->twist;
    double damping;
    if (contact->partner < 0) {
        return;
    }
    se3di_convex_contact *row = &c->contacts[contact->partner];
    row->tangential = row->rise = 0.0;
    memset(row->xi, 0, sizeof row->xi);
    if (contact->way == SE3DI_CONVEX_IMPACT) {
        row->drag = row->steepness = RIGID / row->response[0];
        return;
    }
    const double k = stiffness_of(model, r, &damping), less = h * k;
    row->tangential = k;
    row->drag = h * (h * k + (contact->is_short ? fmax(damping, SETTLING * h * k)
                                                : fmax(0.0, damping - less)));
    row->steepness = row->drag;
    row->rise = -h * k * twist;
    se3di_copy(r->roll, row->xi);
    se3di_add_scaled(-se3di_dot(row->xi, row->normal), row->normal, row->xi);
}

/* How surfaces that turn on their bodies do so. */
static void set_drift(const se3di_model *model, double radius, const se3di_body_contact *r,
                      se3di_convex_contact *row)
{
    for (int k = 0; k < 2; ++k) {
        const se3di_shape *s = &model->shapes[k ? r->shape_j : r->shape_i];
        double spin[3];
        if (se3di_surface_moves(s)) {
            se3di_mul(model->frames[s->body].A, s->surface_spin, spin);
            se3di_add_scaled(k ? radius : -radius, spin, row->drift);
        }
    }
}

static void add(se3di_convex *c, const se3di_assembly *assembly, size_t partner)
{
    const se3di_model *model = assembly->model;
    se3di_convex_contact *contact = &c->contacts[partner];
    const se3di_body_contact *r = contact->record;
    const se3di_pair *pair = se3di_pair_of(model, r->shape_i, r->shape_j);
    const double radius = se3di_convex_radius(model, r), most = fmax(pair->rolling, pair->torsion);
    se3di_convex_contact *row = &c->contacts[c->contact_count];
    if (!(most > 0.0)) {
        return;
    }
    *row = (se3di_convex_contact){.coupling = -1,
                                  .way = SE3DI_CONVEX_ROLL,
                                  .partner = (int32_t)partner,
                                  .friction = most,
                                  .share = {pair->rolling / most, pair->torsion / most}};
    se3di_copy(contact->normal, row->normal);
    for (int k = 0; k < 2; ++k) {
        const uint32_t body = model->shapes[k ? r->shape_j : r->shape_i].body;
        row->free[k] = contact->free[k];
        for (int e = 0; e < 9; ++e) {
            row->lever[k][e] = radius * model->frames[body].A[e];
        }
    }
    set_drift(model, radius, r, row);
    se3di_convex_slip(row, c->start, row->before);
    if (assembly->row_count > 0) {
        se3di_convex_velocity(row, c->chord, row->chord);
    }
    row->bound = c->h * most * fmax(0.0, se3di_dot(r->force, r->normal));
    row->response[0] = response_of(row, assembly, radius);
    contact->partner = (int32_t)c->contact_count++;
    se3di_convex_choose_rolling(c, contact);
}

se3d_status se3di_convex_reserve(se3di_convex *c, const se3di_assembly *assembly, size_t more,
                                 se3di_error *error)
{
    const se3d_status status =
        se3di_array_reserve_at(&assembly->model->allocator, &c->contacts, &c->contact_capacity,
                               c->contact_count + more, sizeof *c->contacts);
    return status < 0 ? se3di_error_set(error, status,
                                        "t = %g s: no memory for rolling, stops and friction",
                                        assembly->model->time)
                      : status;
}

se3d_status se3di_convex_collect_rolling(se3di_convex *c, const se3di_assembly *assembly,
                                         se3di_error *error)
{
    const size_t count = c->shape_count;
    size_t rows = 0;
    for (size_t k = 0; k < count; ++k) {
        const se3di_body_contact *r = c->contacts[k].record;
        const se3di_pair *pair = se3di_pair_of(assembly->model, r->shape_i, r->shape_j);
        rows += pair->rolling > 0.0 || pair->torsion > 0.0;
    }
    if (rows > 0) {
        SE3DI_TRY(se3di_convex_reserve(c, assembly, rows, error));
        for (size_t k = 0; k < count; ++k) {
            add(c, assembly, k);
        }
    }
    return SE3D_OK;
}

/* What a cap leaves of a stretch of which the impulse is `held`: what slips pulls as friction does.
 */
static double left_of(double held, double cap, double length, double k)
{
    const double most = cap / k;
    return held >= (1.0 - 1e-9) * cap ? fmin(most, length) : length;
}

/* The stretches at the end of the step. */
static void stretch_after(const se3di_convex_contact *row, const se3di_model *model, double h,
                          int is_short, se3di_body_contact *r)
{
    const double *n = row->normal, k = h * row->tangential;
    const double vn = se3di_dot(row->v, n), along = se3di_dot(row->impulse, n);
    double held[3], xi[3];
    se3di_copy(row->impulse, held);
    se3di_add_scaled(-along, n, held);
    for (int e = 0; e < 3; ++e) {
        xi[e] = row->xi[e] + h * (row->v[e] - vn * n[e]);
    }
    const double size = se3di_norm(held), cap = row->share[0] * row->bound;
    const double length = se3di_norm(xi), left = left_of(size, cap, length, k);
    if (!is_short && size >= (1.0 - 1e-9) * cap) { /* as the law says */
        double pull[3];
        for (int e = 0; e < 3; ++e) {
            pull[e] = -k * row->xi[e] - row->drag * (row->v[e] - vn * n[e]);
        }
        se3di_encounter_settle(k, cap, size / fmax(size, se3di_norm(pull)), pull, xi, held);
        se3di_copy(held, xi);
    } else if (left < length) {
        se3di_scale(size > 0.0 ? -left / size : 0.0, held, xi);
    }
    se3di_add_scaled(-se3di_dot(xi, r->normal), r->normal, xi);
    se3di_convex_turn_stretch(model, r, h, xi);
    se3di_copy(xi, r->roll);
    const double twist = h * vn - row->rise / k, most = row->share[1] * row->bound;
    const double wrung = left_of(fabs(along), most, fabs(twist), k);
    r->twist = wrung < fabs(twist) ? copysign(wrung, -along) : twist;
}

void se3di_convex_add_moment(const se3di_convex *c, const se3di_convex_contact *contact,
                             const se3di_model *model, double torque[3])
{
    if (contact->partner >= 0) {
        const double radius = se3di_convex_radius(model, contact->record);
        se3di_add_scaled(radius / c->h, c->contacts[contact->partner].impulse, torque);
    }
}

void se3di_convex_record_rolling(const se3di_convex *c, const se3di_convex_contact *contact,
                                 se3di_body_contact *r)
{
    if (contact->partner >= 0 && c->contacts[contact->partner].tangential > 0.0) {
        stretch_after(&c->contacts[contact->partner], c->model, c->h, contact->is_short, r);
    }
}

double se3di_convex_roll_energy(const se3di_model *model, const se3di_body_contact *r)
{
    double damping;
    const double square = se3di_dot(r->roll, r->roll) + r->twist * r->twist;
    return square > 0.0 ? 0.5 * stiffness_of(model, r, &damping) * square : 0.0;
}
