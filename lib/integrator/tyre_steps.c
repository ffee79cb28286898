/* SPDX-License-Identifier: BSD-3-Clause */
/* With the deflection d and its rate at both ends of a step, d within it is a cubic. A tyre touches
 * the road where d > 0, and carries the load (k d + c (d' + e)) / cos g where that is > 0 besides:
 * e is what the damper's rate is off d', 0 on a plane, and between both ends, as cos g, a straight
 * line. The Magic Formula has kinks where the load is the least or the most that it is for. */
#include "integrator/tyre_steps.h"

#include "force/tyre.h"

#include <math.h>

#define LOOKS    32   /* places that are looked at in a step, */
#define HALVINGS 40   /* and from there */
#define NEAR     3e-3 /* of a step: a change so near its beginning is crossed */
#define BEFORE   1e-4 /* of the part: steps end so far before a change, */
#define BEYOND   0.1  /* and so far beyond one that they cross; */
#define LEAST    1e-7 /* that is this part of the step at least */

static int is_tyre(const se3di_force *force)
{
    return force->type == SE3DI_FORCE_TYRE && !force->released;
}

int se3di_tyres_are_there(const se3di_model *model)
{
    int are = 0;
    for (size_t k = 0; k < model->force_slots.count && !are; ++k) {
        are = is_tyre(&model->forces[k]);
    }
    return are;
}

se3d_status se3di_tyres_note(const se3di_model *model, double t, double *notes)
{
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (is_tyre(&model->forces[k])) {
            SE3DI_TRY(se3di_tyre_find_deflection(model, &model->forces[k], t,
                                                 notes + SE3DI_TYRE_NOTES * k));
        }
    }
    return SE3D_OK;
}

/* Deflection and rate of a tyre at both ends of a step of h. */
typedef struct way {
    const se3di_force *force;
    const double *begin, *end;
    double h;
} way;

static way way_of(const se3di_model *model, size_t k, double h, const double *begin,
                  const double *end)
{
    return (way){.force = &model->forces[k],
                 .begin = begin + SE3DI_TYRE_NOTES * k,
                 .end = end + SE3DI_TYRE_NOTES * k,
                 .h = h};
}

/* How many limits of its formula a load is beyond. */
static int count_limits(const se3di_force *force, double load)
{
    if (!force->tyre || !se3di_tyre_is_magic(force)) {
        return 0;
    }
    const double least = force->tyre->coefficients[SE3D_TYRE_FZMIN];
    const double most = force->tyre->coefficients[SE3D_TYRE_FZMAX];
    return (least > 0.0 && load > least) + (most > 0.0 && load > most);
}

/* 0: it is above the road; 1: it touches, 2: and carries load; more: beyond limits. */
static int look(const way *w, double s)
{
    const double rise = w->end[0] - w->begin[0], a = w->h * w->begin[1] - rise;
    const double b = rise - w->h * w->end[1], r = 1.0 - s;
    const double d = r * w->begin[0] + s * w->end[0] + s * r * (r * a + s * b);
    const double slope = rise + (r - s) * (r * a + s * b) + s * r * (b - a);
    const double off = r * (w->begin[2] - w->begin[1]) + s * (w->end[2] - w->end[1]);
    const double radial = w->force->k * d + w->force->c * (slope / w->h + off);
    const double cosine = r * w->begin[3] + s * w->end[3];
    if (!(d > 0.0) || !(radial > 0.0)) {
        return d > 0.0;
    }
    return 2 + count_limits(w->force, radial / cosine);
}

/* The place of its first change: between low, where it has not, and high; 0: nowhere. */
static double find_change(const way *w)
{
    const int before = look(w, 0.0);
    double low = 0.0, high = 0.0;
    int k = 0;
    do {
        low = high;
        high = (double)++k / LOOKS;
    } while (k < LOOKS && look(w, high) == before);
    if (look(w, high) == before) {
        return 0.0;
    }
    for (int j = 0; j < HALVINGS; ++j) {
        const double middle = 0.5 * (low + high);
        if (look(w, middle) == before) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return high;
}

int se3di_tyres_miss(const se3di_model *model, double part, double h, const double *begin,
                     const double *end)
{
    int changes = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const way w = way_of(model, k, h, begin, end);
        changes |= is_tyre(w.force) && look(&w, 0.0) != look(&w, 1.0);
    }
    return part < NEAR && !changes;
}

double se3di_tyres_find_part(const se3di_model *model, double h, const double *begin,
                             const double *end)
{
    double first = 1.0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const way w = way_of(model, k, h, begin, end);
        const double change = is_tyre(w.force) ? find_change(&w) : 0.0;
        first = change > 0.0 && change < first ? change : first;
    }
    if (!(first < 1.0)) {
        return 0.0;
    }
    return first < NEAR ? fmax(LEAST, (1.0 + BEYOND) * first) : (1.0 - BEFORE) * first;
}
