/* SPDX-License-Identifier: BSD-3-Clause */
/* Tyres that are computed side by side have the bits that each of them has alone. */
#include "check.h"
#include "force/tyre.h"
#include "golden/tyre_reference.h"
#include "se3d/se3d.h"
#include "system/system_internal.h"

#include <math.h>
#include <string.h>

enum { WHEELS = 5, STATES = 4000 };

static double between(uint64_t *seed, double low, double high)
{
    return low + 0.5 * (high - low) * (1.0 + check_random(seed));
}

/* Near those of the set; some without which formulas are shorter may be 0. */
static void vary(uint64_t *seed, int has_lengths, double c[SE3D_TYRE_COEFFICIENTS])
{
    static const int shorter[] = {SE3D_TYRE_RHX1,  SE3D_TYRE_REX1, SE3D_TYRE_REX2, SE3D_TYRE_RHY1,
                                  SE3D_TYRE_RHY2,  SE3D_TYRE_REY1, SE3D_TYRE_REY2, SE3D_TYRE_RVY1,
                                  SE3D_TYRE_RVY2,  SE3D_TYRE_RVY3, SE3D_TYRE_QSX4, SE3D_TYRE_QEZ4,
                                  SE3D_TYRE_QSX10, SE3D_TYRE_QEZ5, SE3D_TYRE_FZMIN};
    se3d_tyre_coefficients_init(c, SE3D_TYRE_COEFFICIENTS);
    for (size_t k = 0; k < sizeof tyre_coefficients / sizeof *tyre_coefficients; ++k) {
        c[tyre_coefficients[k].at] = tyre_coefficients[k].value * between(seed, 0.9, 1.1);
    }
    c[SE3D_TYRE_PTX1] = c[SE3D_TYRE_PTY1] = has_lengths ? 1.5 : 0.0;
    c[SE3D_TYRE_PTX3] = 0.1;
    c[SE3D_TYRE_PTY2] = 1.7;
    c[SE3D_TYRE_LONGITUDINAL_STIFFNESS] = c[SE3D_TYRE_LATERAL_STIFFNESS] = 2e5;
    c[SE3D_TYRE_FZMIN] = 700.0;
    for (size_t k = 0; k < sizeof shorter / sizeof *shorter; ++k) {
        if (between(seed, 0.0, 1.0) < 0.3) {
            c[shorter[k]] = 0.0;
        }
    }
}

static void add_wheel(uint64_t *seed, se3d_system *system, const se3d_tyre_def *given)
{
    se3d_tyre_def def = *given;
    se3d_body_def body = se3d_body_def_default();
    se3d_force tyre;
    const double lean = between(seed, -0.6, 0.6), fast = between(seed, 0.0, 40.0);
    const int is_left = between(seed, 0.0, 1.0) < 0.5;
    body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    body.position[2] = def.radius * cos(lean) - between(seed, -0.001, 0.05);
    body.orientation[0] = cos(0.5 * lean);
    body.orientation[1] = sin(0.5 * lean);
    body.velocity[0] = between(seed, -0.3, 1.0) * fast;
    body.velocity[1] = between(seed, -0.5, 0.5) * fast * between(seed, 0.0, 1.0);
    body.velocity[2] = between(seed, -0.5, 0.5);
    body.angular_velocity[1] = between(seed, -0.3, 1.5) * fast / def.radius;
    body.angular_velocity[2] = between(seed, -2.0, 2.0);
    def.side = is_left ? SE3D_TYRE_LEFT : SE3D_TYRE_RIGHT;
    def.axis[1] = is_left ? 1.0 : -1.0;
    CHECK(!se3d_body_create(system, &body, &def.wheel));
    CHECK(!se3d_force_create_tyre(system, &def, &tyre));
}

static se3d_system *make(uint64_t *seed, int number)
{
    se3d_system *system;
    double c[SE3D_TYRE_COEFFICIENTS];
    se3d_tyre_def def = se3d_tyre_def_default();
    vary(seed, number / 16 % 2, c);
    def.law = number % 2 ? SE3D_TYRE_MF52 : SE3D_TYRE_MF61;
    def.has_turn_slip = number / 2 % 2;
    def.is_transient = number / 4 % 2;
    def.relaxation_x = number / 32 % 2 ? 0.2 : 0.0; /* one slip alone may lag, too */
    def.relaxation_y = number / 8 % 2 ? 0.3 : 0.0;
    def.radius = 0.31;
    def.k = 1.8e5;
    def.c = 400.0;
    def.mu = number % 50 == 49 ? 0.0 : 1.1;
    def.measured_side = SE3D_TYRE_LEFT;
    def.coefficients = c;
    def.coefficient_count = SE3D_TYRE_COEFFICIENTS;
    CHECK(!se3d_system_create(NULL, &system));
    CHECK(!se3d_system_get_ground(system, &def.road));
    for (int k = 0; k < WHEELS; ++k) {
        if (number % 7 == 6 && k == 3) { /* another kind of tyre among them */
            def.k = number % 2 ? def.k : 1.7e5;
            c[SE3D_TYRE_PKY1] *= number % 2 ? 1.1 : 1.0;
        }
        add_wheel(seed, system, &def);
    }
    return system;
}

/* Slips that lag are somewhere. */
static void set_slips(uint64_t *seed, se3di_model *model)
{
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        for (int d = 0; force->type == SE3DI_FORCE_TYRE && d < 2; ++d) {
            if (force->tyre->lags[d]) {
                model->frames[force->tyre->carrier[d]].v[0] = between(seed, -1.2, 1.2);
            }
        }
    }
}

static void compare(const se3di_model *model, const se3di_tyre_load *load, uint32_t index)
{
    const se3di_force *force = &model->forces[index];
    se3di_effect effect;
    effect.wants_derivative = 0;
    CHECK(!se3di_force_eval(model, force, 0.0, &effect));
    CHECK(load->status == SE3D_OK);
    CHECK(memcmp(load->wrench, effect.wrench, sizeof load->wrench) == 0);
    CHECK(memcmp(load->power, effect.power, sizeof load->power) == 0);
    for (int d = 0; d < 2; ++d) {
        se3di_tyre_lag lag = {.wants_derivative = 0};
        if (force->tyre->lags[d]) {
            CHECK(!se3di_tyre_lag_eval(model, force, 0.0, d, &lag));
        }
        CHECK(memcmp(&load->rate[d], &lag.rate, sizeof lag.rate) == 0);
    }
}

/* Of each tyre; @return how many groups there were */
static int compare_all(const se3di_model *model)
{
    int groups = 0;
    for (uint32_t k = 0; k < model->force_slots.count; ++k) {
        se3di_tyre_loads loads;
        if (model->forces[k].type != SE3DI_FORCE_TYRE) {
            continue;
        }
        se3di_tyre_eval_alike(model, k, 0.0, &loads);
        CHECK(loads.count >= 1 && loads.count <= 4 && loads.index[0] == k);
        groups += loads.count > 1;
        for (int m = 0; m < loads.count; ++m) {
            compare(model, &loads.of[m], loads.index[m]);
        }
    }
    return groups;
}

/* What all tyres tell is what each of them tells. */
static void compare_told(const se3d_system *system, uint32_t which)
{
    se3d_force tyres[WHEELS];
    double values[WHEELS][SE3D_TYRE_VALUES], alone[SE3D_TYRE_VALUES];
    size_t count = 0;
    for (size_t k = 0; count < WHEELS; ++k) {
        CHECK(!se3d_system_get_force(system, k, &tyres[count]));
        count += system->model.forces[tyres[count].index1 - 1].type == SE3DI_FORCE_TYRE;
    }
    CHECK(!se3d_tyre_get_several(system, WHEELS, tyres, which, values[0]));
    for (size_t k = 0; k < WHEELS; ++k) {
        CHECK(!se3d_tyre_get_some(system, tyres[k], which, alone));
        CHECK(memcmp(values[k], alone, sizeof alone) == 0);
    }
}

static void tyres_side_by_side_have_the_bits_of_one_alone(void)
{
    uint64_t seed = 20261130;
    int groups = 0;
    for (int number = 0; number < STATES; ++number) {
        se3d_system *system = make(&seed, number);
        set_slips(&seed, &system->model);
        groups += compare_all(&system->model);
        compare_told(system, (UINT32_C(1) << SE3D_TYRE_VALUES) - 1);
        compare_told(system, 1 + (uint32_t)number % ((UINT32_C(1) << 8) - 1));
        se3d_system_destroy(system);
    }
    CHECK(groups >= 3 * STATES);
}

/* Three of one kind, two of another. */
static void check_kinds(int number)
{
    uint64_t seed = 7;
    se3d_system *system = make(&seed, number);
    se3di_model *model = &system->model;
    se3di_tyre_loads loads;
    uint32_t tyres[WHEELS], count = 0;
    for (uint32_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].type == SE3DI_FORCE_TYRE) {
            tyres[count++] = k;
        }
    }
    CHECK(count == WHEELS);
    se3di_tyre_eval_alike(model, tyres[0], 0.0, &loads);
    CHECK(loads.count == 3 && loads.index[2] == tyres[2]);
    model->forces[tyres[1]].released = 1; /* is passed over */
    se3di_tyre_eval_alike(model, tyres[0], 0.0, &loads);
    CHECK(loads.count == 2 && loads.index[1] == tyres[2]);
    se3d_system_destroy(system);
}

static void a_tyre_that_is_another_stands_alone(void)
{
    check_kinds(6);  /* by its stiffness */
    check_kinds(13); /* by a coefficient */
}

static void a_tyre_that_is_given_again_may_become_another(void)
{
    double c[SE3D_TYRE_COEFFICIENTS];
    se3d_system *system;
    se3d_tyre_def def = se3d_tyre_def_default();
    se3d_body_def body = se3d_body_def_default();
    se3d_force tyre;
    se3di_tyre_loads loads;
    uint64_t seed = 11;
    vary(&seed, 0, c);
    const double own = c[SE3D_TYRE_PKY1];
    def.law = SE3D_TYRE_MF52;
    def.radius = 0.31;
    def.k = 1.8e5;
    def.mu = 1.0;
    def.coefficients = c;
    def.coefficient_count = SE3D_TYRE_COEFFICIENTS;
    body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    body.position[2] = 0.3;
    CHECK(!se3d_system_create(NULL, &system));
    CHECK(!se3d_system_get_ground(system, &def.road));
    CHECK(!se3d_body_create(system, &body, &def.wheel));
    def.name = "first";
    CHECK(!se3d_force_create_tyre(system, &def, &tyre));
    def.name = "second";
    CHECK(!se3d_force_create_tyre(system, &def, &tyre));
    se3di_tyre_eval_alike(&system->model, 0, 0.0, &loads);
    CHECK(loads.count == 2);
    for (int again = 0; again < 2; ++again) { /* another, and the same again */
        c[SE3D_TYRE_PKY1] = again ? own : own + 1.0;
        CHECK(!se3d_system_set_replacing(system, 1));
        CHECK(!se3d_force_create_tyre(system, &def, &tyre));
        CHECK(!se3d_system_set_replacing(system, 0));
        se3di_tyre_eval_alike(&system->model, 0, 0.0, &loads);
        CHECK(loads.count == 1 + again);
    }
    se3d_system_destroy(system);
}

/* Its plane's angle to the road has no cosine to divide by, which hosts may trap. */
static void wheels_may_lie_on_their_sides(void)
{
    static const int32_t laws[] = {SE3D_TYRE_MF52, SE3D_TYRE_MF61, SE3D_TYRE_FIALA,
                                   SE3D_TYRE_BRUSH};
    static const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RADAU};
    double c[SE3D_TYRE_COEFFICIENTS];
    uint64_t seed = 3;
    vary(&seed, 1, c);
    for (int k = 0; k < 8; ++k) {
        se3d_system *system;
        se3d_tyre_def def = se3d_tyre_def_default();
        se3d_body_def body = se3d_body_def_default();
        se3d_solver_def how = se3d_solver_def_default();
        se3d_solver *solver = NULL;
        se3d_force tyre;
        CHECK(!se3d_system_create(NULL, &system));
        CHECK(!se3d_system_get_ground(system, &def.road));
        body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
        body.position[2] = 0.5;
        CHECK(!se3d_body_create(system, &body, &def.wheel));
        def.law = laws[k / 2];
        def.radius = 0.31;
        def.k = 1.8e5;
        def.mu = 1.0;
        def.relaxation_x = 0.2;
        def.relaxation_y = 0.3;
        def.axis[1] = 0.0;
        def.axis[2] = 1.0;
        if (k < 4) {
            def.coefficients = c;
            def.coefficient_count = SE3D_TYRE_COEFFICIENTS;
        } else {
            def.slip_stiffness = def.cornering_stiffness = 1e5;
        }
        CHECK(!se3d_force_create_tyre(system, &def, &tyre));
        how.method = methods[k % 2];
        CHECK(!se3d_solver_create(system, &how, &solver));
        CHECK(!SE3D_FAILED(se3d_solver_run(solver, 0.02)));
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

int main(void)
{
    RUN(tyres_side_by_side_have_the_bits_of_one_alone);
    RUN(wheels_may_lie_on_their_sides);
    RUN(a_tyre_that_is_another_stands_alone);
    RUN(a_tyre_that_is_given_again_may_become_another);
    return check_finish();
}
