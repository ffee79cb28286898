/* SPDX-License-Identifier: BSD-3-Clause */
/* If dependent equations contradict each other, what is left of them at the least violation lies
 * in the combination of rows that vanishes: the rows that are off are those that contradict. */
#include "nonlinear/against.h"

#include "primitive/scale.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define TWO_PI   6.283185307179586
#define PART     0.05 /* of the largest gap, of rows that are named */
#define NAMES    3
#define SAMPLES  256  /* at most, */
#define APART    1e-3 /* and no closer than this [s] */
#define PARTED   1e-8 /* of values, relative to the scale of their row */
#define RATE_OFF 1e-6

static int is_driver(const se3di_constraint *constraint)
{
    return strcmp(constraint->type, "driver") == 0;
}

static int drive_alike(const se3di_model *model, const se3di_constraint *a,
                       const se3di_constraint *b)
{
    return a != b && a->joints[0] == b->joints[0] && is_driver(a) && is_driver(b) &&
           strcmp(model->rows[a->row_begin].name, model->rows[b->row_begin].name) == 0;
}

static const se3di_constraint *find_other(const se3di_model *model, const se3di_constraint *driver)
{
    for (size_t k = 0; is_driver(driver) && k < model->constraint_slots.count; ++k) {
        const se3di_constraint *other = &model->constraints[k];
        if (drive_alike(model, driver, other) && !model->rows[other->row_begin].left_out) {
            return other;
        }
    }
    return NULL;
}

int se3di_against_is_twice(const se3di_model *model, uint32_t row)
{
    return find_other(model, &model->constraints[se3di_row_get_owner(model, row)]) != NULL;
}

static const char *name_of(const se3di_constraint *constraint)
{
    return constraint->name ? constraint->name : "one without a name";
}

/* "drivers a and b drive the angle of pin" */
static void name_pair(const se3di_model *model, const se3di_constraint *a,
                      const se3di_constraint *b, char *text, size_t size)
{
    const int in_order = a->row_begin < b->row_begin;
    const se3di_constraint *joint = &model->constraints[a->joints[0]];
    snprintf(text, size, "drivers %.60s and %.60s drive the %s of %.60s", name_of(in_order ? a : b),
             name_of(in_order ? b : a), model->rows[a->row_begin].name, name_of(joint));
}

void se3di_against_describe(const se3di_model *model, const double *gap, uint32_t row, char *text,
                            size_t size)
{
    char name[240];
    size_t count = 0;
    text[0] = '\0';
    for (uint32_t k = 0; k < model->row_count; ++k) {
        const se3di_constraint *driver = &model->constraints[se3di_row_get_owner(model, k)];
        const se3di_constraint *other = find_other(model, driver);
        const int is_off = k == row || fabs(gap[k]) > PART * fabs(gap[row]);
        const size_t used = strlen(text);
        if (is_off && other) {
            name_pair(model, driver, other, name, sizeof name);
            snprintf(text, size, ": %s", name);
            return;
        }
        if (is_off && k != row && count < NAMES) {
            se3di_row_name(model, k, name, sizeof name);
            snprintf(text + used, size - used, "%s%.60s", count++ > 0 ? ", " : " with ", name);
        }
    }
}

/* ---- functions of time ---- */

int se3di_against_can_be(const se3di_model *model)
{
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        if (find_other(model, &model->constraints[k])) {
            return 1;
        }
    }
    return 0;
}

static int is_of_time(const se3di_model *model, const se3di_constraint *constraint)
{
    return is_driver(constraint) && !constraint->law_class &&
           !model->rows[constraint->row_begin].left_out;
}

/* 0: it has none, which is told where it is needed. */
static int value_at(const se3di_model *model, const se3di_row *row, double t, double *value)
{
    double jet[3] = {row->value, 0.0, 0.0};
    const int is_there = row->function < 0 ||
                         se3di_function_eval(&model->functions[row->function], &t, jet, NULL) >= 0;
    *value = jet[0];
    return is_there;
}

static se3d_status compare(const se3di_model *model, const se3di_constraint *a,
                           const se3di_constraint *b, double t_end, se3di_error *error)
{
    const se3di_row *rows[2] = {&model->rows[a->row_begin], &model->rows[b->row_begin]};
    const double scale = se3di_row_get_scale(model, a->row_begin, se3di_model_get_size(model));
    const double span = t_end - model->time;
    const double samples = fmin(SAMPLES, ceil(span / APART));
    for (double k = 0.0; k <= samples; k += 1.0) {
        const double t = model->time + span * k / samples;
        double f[2];
        if (!value_at(model, rows[0], t, &f[0]) || !value_at(model, rows[1], t, &f[1])) {
            return SE3D_OK;
        }
        const double off = rows[0]->wrap ? remainder(f[1] - f[0], TWO_PI) : f[1] - f[0];
        if (fabs(off) > PARTED * (scale + fabs(f[0]))) {
            char name[240];
            const char *unit = se3di_row_get_unit(model, a->row_begin);
            name_pair(model, a, b, name, sizeof name);
            return se3di_error_set(error, SE3D_ERR_INCONSISTENT,
                                   "the constraints contradict each other: %s, to %.6g%s and "
                                   "%.6g%s at t = %.6g s; only one can",
                                   name, f[0], unit, f[1], unit, t);
        }
    }
    return SE3D_OK;
}

se3d_status se3di_against_refuse(const se3di_assembly *assembly, double t_end, se3di_error *error)
{
    const se3di_model *model = assembly->model;
    for (size_t k = 0; assembly->timed_count > 0 && k < model->constraint_slots.count; ++k) {
        const se3di_constraint *b = &model->constraints[k];
        const se3di_constraint *a = is_of_time(model, b) ? find_other(model, b) : NULL;
        if (a && is_of_time(model, a)) {
            SE3DI_TRY(compare(model, a < b ? a : b, a < b ? b : a, t_end, error));
        }
    }
    return SE3D_OK;
}

/* ---- rates ---- */

se3d_status se3di_against_check_rates(se3di_equations *equations, double t, double gap, double rate,
                                      double length)
{
    const se3di_model *model = equations->assembly.model;
    uint32_t worst = 0;
    double most = 0.0;
    char name[128], with[400];
    if (gap <= RATE_OFF) {
        return SE3D_OK;
    }
    for (uint32_t k = 0; k < model->row_count; ++k) {
        const double off = fabs(equations->c[k]) / (rate * se3di_row_get_scale(model, k, length));
        if (off > most) {
            most = off;
            worst = k;
        }
    }
    se3di_row_name(model, worst, name, sizeof name);
    se3di_against_describe(model, equations->c, worst, with, sizeof with);
    return se3di_error_set(equations->error, SE3D_ERR_INCONSISTENT,
                           "t = %g s: the constraints contradict each other: the rate of %s cannot "
                           "be met (off by %.3g)%s",
                           t, name, equations->c[worst], with);
}
