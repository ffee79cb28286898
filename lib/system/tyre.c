/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: tyres. */
#include "se3d/tyre.h"

#include "force/tyre.h"
#include "math/vec3.h"
#include "model/state.h"
#include "system/force_internal.h"

#include <math.h>
#include <string.h>

#define LARGE       1e40
#define POSITIVE    1e-40
#define SHAPE_LEAST 0.01 /* of QDRP1, whose sine sin(QDRP1 pi/2) is divided by */
#define SHAPE_MOST  1.99
#define SLIP        0.1 /* that errors of a slip that lags are measured by, at least: tyres slide */

void se3d_tyre_def_init(se3d_tyre_def *def, size_t size)
{
    se3d_tyre_def defaults = {
        .struct_size = size, .normal = {0.0, 0.0, 1.0}, .axis = {0.0, 1.0, 0.0}, .low_speed = 1.0};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

static se3d_status check_choice(se3d_system *system, const char *what, int32_t value, int32_t last)
{
    if (value < 0 || value > last) {
        return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT, " = %d, must be 0 to %d",
                             (int)value, (int)last);
    }
    return SE3D_OK;
}

/* Of brush and Fiala. */
static se3d_status check_stiffness(se3d_system *system, const se3d_tyre_def *def)
{
    SE3DI_TRY(se3di_check_range(system, "mu", def->mu, POSITIVE, LARGE));
    SE3DI_TRY(se3di_check_range(system, "mu_min", def->mu_min, 0.0, def->mu));
    SE3DI_TRY(se3di_check_range(system, "slip_stiffness", def->slip_stiffness, POSITIVE, LARGE));
    return se3di_check_range(system, "cornering_stiffness", def->cornering_stiffness, POSITIVE,
                             LARGE);
}

static const char *const coefficient_names[SE3D_TYRE_COEFFICIENTS] = {
#define NAME(NAME, number, value) #NAME,
    SE3D_TYRE_COEFFICIENT_LIST(NAME)
#undef NAME
};

void se3d_tyre_coefficients_init(double *coefficients, size_t count)
{
    static const double values[SE3D_TYRE_COEFFICIENTS] = {
#define VALUE(NAME, number, value) (double)(value),
        SE3D_TYRE_COEFFICIENT_LIST(VALUE)
#undef VALUE
    };
    for (size_t k = 0; coefficients && k < count && k < SE3D_TYRE_COEFFICIENTS; ++k) {
        coefficients[k] = values[k];
    }
}

se3d_status se3d_tyre_coefficient_find(const char *name, size_t *index)
{
    if (index) {
        *index = 0;
    }
    if (!name || !index) {
        return SE3D_ERR_NULL;
    }
    for (size_t k = 0; k < SE3D_TYRE_COEFFICIENTS; ++k) {
        if (strcmp(coefficient_names[k], name) == 0) {
            *index = k;
            return SE3D_OK;
        }
    }
    return SE3D_ERR_INVALID_ARGUMENT;
}

static int is_zero(double x)
{
    return !(fabs(x) > 0.0);
}

/* What the formulas divide by. A tyre without PCX1, PDX1 and PKX1 has no longitudinal force. */
static se3d_status check_divisors(se3d_system *system, const double *c)
{
    static const int divisors[] = {SE3D_TYRE_PCX1, SE3D_TYRE_PDX1, SE3D_TYRE_PKX1, SE3D_TYRE_PCY1,
                                   SE3D_TYRE_PDY1, SE3D_TYRE_PKY1, SE3D_TYRE_PKY2, SE3D_TYRE_LCX,
                                   SE3D_TYRE_LCY,  SE3D_TYRE_LMUX, SE3D_TYRE_LMUY, SE3D_TYRE_LKY};
    static const int positive[] = {SE3D_TYRE_FNOMIN, SE3D_TYRE_LONGVL, SE3D_TYRE_LFZO,
                                   SE3D_TYRE_QRE0};
    const size_t ahead =
        is_zero(c[divisors[0]]) && is_zero(c[divisors[1]]) && is_zero(c[divisors[2]]) ? 3 : 0;
    for (size_t k = 0; k < sizeof positive / sizeof *positive; ++k) {
        SE3DI_TRY(se3di_check_range(system, coefficient_names[positive[k]], c[positive[k]],
                                    POSITIVE, LARGE));
    }
    for (size_t k = ahead; k < sizeof divisors / sizeof *divisors; ++k) {
        if (is_zero(c[divisors[k]])) {
            return SE3DI_FAIL_OF(system, coefficient_names[divisors[k]], SE3D_ERR_INVALID_ARGUMENT,
                                 " = 0, must not be 0");
        }
    }
    return SE3D_OK;
}

/* What turn slip needs. */
static se3d_status check_turn_slip(se3d_system *system, const se3d_tyre_def *def, const double *c)
{
    static const int positive[] = {SE3D_TYRE_PHYP1, SE3D_TYRE_QCRP1, SE3D_TYRE_LMP};
    SE3DI_TRY(check_choice(system, "has_turn_slip", def->has_turn_slip, 1));
    if (!def->has_turn_slip) {
        return SE3D_OK;
    }
    if (def->law != SE3D_TYRE_MF52 && def->law != SE3D_TYRE_MF61) {
        return SE3DI_FAIL_OF(system, "has_turn_slip", SE3D_ERR_INVALID_ARGUMENT,
                             " = 1, must be 0: only a Magic Formula knows of it");
    }
    for (size_t k = 0; k < sizeof positive / sizeof *positive; ++k) {
        SE3DI_TRY(se3di_check_range(system, coefficient_names[positive[k]], c[positive[k]],
                                    POSITIVE, LARGE));
    }
    if (!(fabs(c[SE3D_TYRE_PHYP2]) > 0.0)) {
        return SE3DI_FAIL_OF(system, "PHYP2", SE3D_ERR_INVALID_ARGUMENT,
                             " = 0, must not be 0 with has_turn_slip");
    }
    return se3di_check_range(system, "QDRP1", c[SE3D_TYRE_QDRP1], SHAPE_LEAST, SHAPE_MOST);
}

static se3d_status take_coefficients(se3d_system *system, const se3d_tyre_def *def,
                                     se3di_tyre *tyre)
{
    double *c = tyre->coefficients;
    se3d_tyre_coefficients_init(c, SE3D_TYRE_COEFFICIENTS);
    if (def->coefficient_count > SE3D_TYRE_COEFFICIENTS) {
        return SE3DI_FAIL_OF(system, "coefficient_count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be at most %d", def->coefficient_count,
                             SE3D_TYRE_COEFFICIENTS);
    }
    if (def->coefficient_count > 0) {
        SE3DI_TRY(se3di_check_pointer(system, "coefficients", def->coefficients));
        memcpy(c, def->coefficients, def->coefficient_count * sizeof *c);
    }
    for (int k = 0; k < SE3D_TYRE_COEFFICIENTS; ++k) {
        SE3DI_TRY(se3di_check_range(system, coefficient_names[k], c[k], -LARGE, LARGE));
    }
    tyre->mirrored = def->side != def->measured_side;
    return check_divisors(system, c);
}

/* The coefficients have to say the length of a direction for which none is given. */
static se3d_status check_relaxation(se3d_system *system, const se3d_tyre_def *def, const double *c,
                                    int direction)
{
    const int first = direction ? SE3D_TYRE_PTY1 : SE3D_TYRE_PTX1;
    const int carcass = direction ? SE3D_TYRE_LATERAL_STIFFNESS : SE3D_TYRE_LONGITUDINAL_STIFFNESS;
    const char *name = direction ? "relaxation_y" : "relaxation_x";
    if (def->law != SE3D_TYRE_MF52 && def->law != SE3D_TYRE_MF61) {
        return SE3DI_FAIL_OF(system, name, SE3D_ERR_INVALID_ARGUMENT,
                             " = 0, must be > 0 [m]: is_transient, and only a Magic Formula knows "
                             "its own");
    }
    if (direction && fabs(c[first]) > 0.0 && !(fabs(c[SE3D_TYRE_PTY2]) > 0.0)) {
        return SE3DI_FAIL_OF(system, "PTY2", SE3D_ERR_INVALID_ARGUMENT, " = 0, must not be 0");
    }
    if (!(fabs(c[first]) > 0.0) && !(c[carcass] > 0.0)) {
        return SE3DI_FAIL_OF(system, name, SE3D_ERR_INVALID_ARGUMENT,
                             " = 0, must be > 0 [m]: is_transient, and the coefficients have "
                             "neither %s nor %s",
                             coefficient_names[first], coefficient_names[carcass]);
    }
    return SE3D_OK;
}

static se3d_status take_relaxation(se3d_system *system, const se3d_tyre_def *def, se3di_tyre *tyre)
{
    const double given[2] = {def->relaxation_x, def->relaxation_y};
    SE3DI_TRY(check_choice(system, "is_transient", def->is_transient, 1));
    SE3DI_TRY(se3di_check_range(system, "relaxation_x", given[0], 0.0, LARGE));
    SE3DI_TRY(se3di_check_range(system, "relaxation_y", given[1], 0.0, LARGE));
    for (int k = 0; k < 2; ++k) {
        tyre->relaxation[k] = given[k];
        tyre->lags[k] = def->is_transient || given[k] > 0.0;
        if (tyre->lags[k] && !(given[k] > 0.0)) {
            SE3DI_TRY(check_relaxation(system, def, tyre->coefficients, k));
        }
    }
    return SE3D_OK;
}

/* The body and, where it is no plane, the surface of the road. */
static se3d_status take_road(se3d_system *system, const se3d_tyre_def *def, se3di_force *data)
{
    se3di_tyre *tyre = data->tyre;
    uint32_t index;
    tyre->surface = -1;
    SE3DI_TRY(se3di_check_range(system, "envelope_length", def->envelope_length, 0.0, LARGE));
    SE3DI_TRY(se3di_check_range(system, "envelope_width", def->envelope_width, 0.0, LARGE));
    if (def->surface.index1 == 0 && def->surface.generation == 0) {
        return se3di_find_body(system, "road", def->road, &data->body_i);
    }
    SE3DI_TRY(se3di_find_road(system, "surface", def->surface, &index));
    const se3di_road *road = &system->model.roads[index];
    data->body_i = road->body;
    if (def->road.index1 != 0 || def->road.generation != 0) {
        SE3DI_TRY(se3di_find_body(system, "road", def->road, &data->body_i));
    }
    if (data->body_i != road->body) {
        return SE3DI_FAIL_OF(system, "road", SE3D_ERR_INVALID_ARGUMENT,
                             " is another body than the one that the surface is on");
    }
    tyre->surface = (int32_t)index;
    tyre->envelope[0] = def->envelope_length;
    tyre->envelope[1] = def->envelope_width;
    return SE3D_OK;
}

static se3d_status take_numbers(se3d_system *system, const se3d_tyre_def *def, se3di_force *data)
{
    se3di_tyre *tyre = data->tyre;
    SE3DI_TRY(se3di_check_finites(system, "point", def->point, 3));
    SE3DI_TRY(se3di_check_finites(system, "center", def->center, 3));
    SE3DI_TRY(se3di_check_direction(system, "normal", def->normal, tyre->normal));
    SE3DI_TRY(se3di_check_direction(system, "axis", def->axis, tyre->axis));
    SE3DI_TRY(check_choice(system, "side", def->side, SE3D_TYRE_RIGHT));
    SE3DI_TRY(check_choice(system, "law", def->law, SE3D_TYRE_MF61));
    SE3DI_TRY(se3di_check_range(system, "radius", def->radius, POSITIVE, LARGE));
    SE3DI_TRY(se3di_check_range(system, "patch_length", def->patch_length, 0.0, LARGE));
    SE3DI_TRY(se3di_check_range(system, "rolling_resistance", def->rolling_resistance, 0.0, LARGE));
    SE3DI_TRY(se3di_check_range(system, "rolling_radius", def->rolling_radius, 0.0, LARGE));
    SE3DI_TRY(se3di_check_range(system, "low_speed", def->low_speed, POSITIVE, LARGE));
    SE3DI_TRY(check_choice(system, "measured_side", def->measured_side, SE3D_TYRE_RIGHT));
    const int is_magic = def->law == SE3D_TYRE_MF52 || def->law == SE3D_TYRE_MF61;
    SE3DI_TRY(is_magic ? take_coefficients(system, def, tyre) : check_stiffness(system, def));
    SE3DI_TRY(take_relaxation(system, def, tyre));
    SE3DI_TRY(check_turn_slip(system, def, tyre->coefficients));
    tyre->has_turn_slip = def->has_turn_slip;
    se3di_copy(def->point, data->s_i);
    se3di_copy(def->center, data->s_j);
    se3di_scale(def->side == SE3D_TYRE_RIGHT ? -1.0 : 1.0, tyre->axis, tyre->axis);
    data->rest = def->radius;
    data->k = def->k;
    data->c = def->c;
    data->mu = is_magic && memcmp(&def->mu, &(double){0.0}, sizeof def->mu) == 0 ? 1.0 : def->mu;
    tyre->law = def->law;
    tyre->side = def->side;
    tyre->mu_min = def->mu_min;
    tyre->slip_stiffness = def->slip_stiffness;
    tyre->cornering_stiffness = def->cornering_stiffness;
    tyre->patch_length = def->patch_length;
    tyre->rolling_resistance = def->rolling_resistance;
    tyre->rolling_radius = def->rolling_radius;
    tyre->low_speed = def->low_speed;
    return se3di_force_check_values(system, data);
}

se3d_status se3d_force_create_tyre(se3d_system *system, const se3d_tyre_def *def, se3d_force *force)
{
    SE3DI_TRY(se3di_force_begin(system, force));
    se3d_tyre_def full = se3d_tyre_def_default();
    se3di_tyre tyre = {.law = 0};
    SE3DI_TRY(se3di_check_def(system, "tyre def", def, &full, sizeof full));
    SE3DI_TRY(se3di_check_new_name(system, &system->model.force_slots, 0, "force", full.name));
    se3di_force data = se3di_force_blank(SE3DI_FORCE_TYRE, full.name);
    data.tyre = &tyre; /* copied by the model */
    SE3DI_TRY(take_road(system, &full, &data));
    SE3DI_TRY(se3di_find_body(system, "wheel", full.wheel, &data.body_j));
    if (data.body_i == data.body_j) {
        return SE3DI_FAIL_OF(system, "wheel", SE3D_ERR_INVALID_ARGUMENT,
                             " is the road's own body, must be another one");
    }
    SE3DI_TRY(take_numbers(system, &full, &data));
    se3di_force lag = se3di_force_blank(SE3DI_FORCE_STATE, NULL);
    se3di_handle handle = {0, 0};
    lag.rest = SLIP;
    const se3d_status added = se3di_model_add_tyre(&system->model, &data, &lag, &handle);
    return se3di_give_created(system, added, "a tyre", handle, force);
}

/* What is told together. */
enum { GROUP = 4 };

static se3d_status tell(const se3d_system *system, const se3di_force *const *tyres, size_t count,
                        uint32_t which, double *values)
{
    double all[GROUP][SE3D_TYRE_VALUES];
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(system, &reading));
    SE3DI_TRY(se3di_read_end(&reading, se3di_tyre_tell(&system->model, tyres, count, which, all)));
    for (size_t m = 0; m < count; ++m) {
        for (uint32_t k = 0; k < SE3D_TYRE_VALUES; ++k) {
            values[m * SE3D_TYRE_VALUES + k] = which >> k & 1 ? all[m][k] : 0.0;
        }
    }
    return SE3D_OK;
}

se3d_status se3d_tyre_get_several(const se3d_system *system, size_t count, const se3d_force *tyres,
                                  uint32_t which, double *values)
{
    if (!system || (count > 0 && (!tyres || !values))) {
        return SE3D_ERR_NULL;
    }
    if (which == 0 || which >> SE3D_TYRE_VALUES != 0) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    for (size_t begin = 0; begin < count; begin += GROUP) {
        const size_t size = count - begin < GROUP ? count - begin : GROUP;
        const se3di_force *data[GROUP];
        for (size_t k = 0; k < size; ++k) {
            SE3DI_TRY(se3di_force_find_reader(system, tyres[begin + k], tyres, &data[k]));
            if (data[k]->type != SE3DI_FORCE_TYRE) {
                return SE3D_ERR_INVALID_ARGUMENT;
            }
        }
        SE3DI_TRY(tell(system, data, size, which, values + begin * SE3D_TYRE_VALUES));
    }
    return SE3D_OK;
}

se3d_status se3d_tyre_get_some(const se3d_system *system, se3d_force force, uint32_t which,
                               double *values)
{
    return se3d_tyre_get_several(system, 1, &force, which, values);
}

se3d_status se3d_tyre_get_values(const se3d_system *system, se3d_force force, size_t first,
                                 size_t count, double *values)
{
    double all[SE3D_TYRE_VALUES];
    const int is_range = first < SE3D_TYRE_VALUES && count <= SE3D_TYRE_VALUES - first;
    const uint32_t which = is_range ? ((UINT32_C(1) << count) - 1) << first : 0;
    SE3DI_TRY(se3d_tyre_get_some(system, force, which, values ? all : NULL));
    memcpy(values, all + first, count * sizeof *values);
    return SE3D_OK;
}
