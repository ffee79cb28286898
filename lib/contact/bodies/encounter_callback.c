/* SPDX-License-Identifier: BSD-3-Clause */
/* A user-defined law at one point where two bodies touch, and its derivatives by differences.
 * docs/theory/contact-laws.md */
#include "base/floats.h"
#include "contact/bodies/encounter.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define DIFFERENCE 1e-6 /* of what the law sees, relative */
#define REST       1e-3 /* m/s, a small velocity */

static se3d_material material_of(const se3di_model *model, uint32_t shape)
{
    se3di_handle handle =
        se3di_slots_handle(&model->material_slots, (uint32_t)model->shapes[shape].material);
    return (se3d_material){handle.index1, handle.generation};
}

static void input_of(const se3di_encounter *e, se3d_contact_input *in)
{
    memset(in, 0, sizeof *in);
    in->material_1 = material_of(e->model, e->shape_i);
    in->material_2 = material_of(e->model, e->shape_j);
    in->step = e->model->contacts.step;
    in->overlap = e->at->overlap;
    in->velocity = e->vn;
    in->onset = e->onset;
    in->radius = e->radius;
    in->mass = 1.0 / e->inverse_mass;
    in->friction = e->pair.friction;
    se3di_copy(e->at->normal, in->normal);
    se3di_copy(e->vt, in->slip);
    se3di_copy(e->xi, in->spring);
    se3di_encounter_spin(e, in->spin);
}

/* Force, moment and spring on j; returns 0 if the law fails. */
static int call(const se3di_model *model, const se3d_contact_input *in, double force[3],
                double moment[3], double spring[3])
{
    se3d_contact_output out;
    memset(&out, 0, sizeof out);
    se3di_copy(in->spring, out.spring);
    const se3d_status status = model->contact.callback(model->contact.ctx, in, &out);
    se3di_floats_resume();
    if (status < 0) {
        return 0;
    }
    se3di_add_scaled(-se3di_dot(out.tangential, in->normal), in->normal, out.tangential);
    se3di_copy(out.tangential, force);
    se3di_add_scaled(out.force, in->normal, force);
    se3di_copy(out.moment, moment);
    se3di_copy(out.spring, spring);
    return isfinite(se3di_dot(force, force)) && isfinite(se3di_dot(moment, moment));
}

void se3di_encounter_call(se3di_encounter *e)
{
    se3d_contact_input in;
    input_of(e, &in);
    e->failed = !call(e->model, &in, e->force, e->moment, e->spring);
    if (e->failed) {
        memset(e->force, 0, sizeof e->force);
        memset(e->moment, 0, sizeof e->moment);
        se3di_copy(e->xi, e->spring);
    }
    e->elastic = 0.0; /* what the law stores is not known: all work counts as lost */
    e->normal = se3di_dot(e->force, e->at->normal);
    e->give = e->yield = e->slack = 1.0;
}

static void shift(double by, const se3di_encounter_rates *d, se3d_contact_input *in)
{
    se3di_add_scaled(by, d->n, in->normal);
    se3di_scale(1.0 / se3di_norm(in->normal), in->normal, in->normal);
    in->overlap += by * d->delta;
    in->velocity += by * d->vn;
    in->onset += by * d->onset;
    se3di_add_scaled(by, d->vt, in->slip);
    se3di_add_scaled(by, d->spin, in->spin);
    se3di_add_scaled(by, d->xi, in->spring);
    in->mass = 1.0 / (1.0 / in->mass + by * d->inverse_mass);
}

/* How fast what the law sees changes, relative to what it is. */
static double pace_of(const se3d_contact_input *in, const se3di_encounter_rates *d)
{
    double speed = fabs(in->velocity) + se3di_norm(in->slip) + REST;
    double pace = fabs(d->delta) / in->overlap + se3di_norm(d->n);
    pace += (fabs(d->vn) + se3di_norm(d->vt)) / speed;
    pace += fabs(d->onset);
    pace += se3di_norm(d->xi) / (se3di_norm(in->spring) + in->overlap);
    pace += se3di_norm(d->spin) / (se3di_norm(in->spin) + speed / in->radius);
    return pace + fabs(d->inverse_mass) * in->mass;
}

void se3di_encounter_call_rate(const se3di_encounter *e, const se3di_encounter_rates *d,
                               double force[3], double moment[3])
{
    se3d_contact_input in;
    double f[2][3], m[2][3], spring[3];
    input_of(e, &in);
    double pace = pace_of(&in, d);
    memset(force, 0, 3 * sizeof *force);
    memset(moment, 0, 3 * sizeof *moment);
    if (!(pace > 0.0)) {
        return;
    }
    for (int side = 0; side < 2; ++side) {
        se3d_contact_input there = in;
        shift((side ? DIFFERENCE : -DIFFERENCE) / pace, d, &there);
        if (!call(e->model, &there, f[side], m[side], spring)) {
            return;
        }
    }
    for (int a = 0; a < 3; ++a) {
        force[a] = (f[1][a] - f[0][a]) * (0.5 * pace / DIFFERENCE);
        moment[a] = (m[1][a] - m[0][a]) * (0.5 * pace / DIFFERENCE);
    }
}
