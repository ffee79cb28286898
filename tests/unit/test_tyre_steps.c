/* SPDX-License-Identifier: BSD-3-Clause */
/* The places at which steps end for tyres, against polynomials whose zeros are known. */
#include "check.h"
#include "integrator/tyre_steps.h"
#include "se3d/se3d.h"
#include "system/system_internal.h"

#include <math.h>
#include <string.h>

/* The deflection over a step from s = 0 to 1: a cubic, its zero and its turning points anywhere. */
typedef struct cubic {
    double scale, a, b, c; /* scale (s - a)(s - b)(s - c) */
} cubic;

static void note(const cubic *p, double h, double s, double notes[SE3DI_TYRE_NOTES])
{
    const double a = s - p->a, b = s - p->b, c = s - p->c;
    notes[0] = p->scale * a * b * c;
    notes[1] = notes[2] = p->scale * (a * b + b * c + c * a) / h;
    notes[3] = 1.0;
}

static double find(const cubic *ways, size_t count, double damper, double h)
{
    se3di_force tyres[3] = {{.type = SE3DI_FORCE_TYRE}};
    double begin[3 * SE3DI_TYRE_NOTES], end[3 * SE3DI_TYRE_NOTES];
    se3di_model model = {.forces = tyres, .force_slots = {.count = (uint32_t)count}};
    for (size_t k = 0; k < count; ++k) {
        tyres[k].type = SE3DI_FORCE_TYRE;
        tyres[k].k = 2e5;
        tyres[k].c = damper;
        note(&ways[k], h, 0.0, begin + SE3DI_TYRE_NOTES * k);
        note(&ways[k], h, 1.0, end + SE3DI_TYRE_NOTES * k);
    }
    return se3di_tyres_find_part(&model, h, begin, end);
}

static double before(double place)
{
    return (1.0 - 1e-4) * place;
}

static void steps_end_before_the_first_zero(void)
{
    const cubic ways[] = {
        {0.1, 0.37, -1.3, -2.1},                            /* rises from below the road */
        {-0.1, 0.37, -1.3, -2.1}, {0.1, 0.37, 1.3, -2.1},   /* the other way */
        {0.1, 0.37, 1.3, 1.9},    {-0.1, 0.37, 0.71, -0.4}, /* touches within the step only */
        {0.1, 0.37, 0.71, -0.4},  {0.1, 0.37, 0.71, 0.93},  /* three times */
        {0.1, 0.37, 0.43, 1.4}};
    for (size_t k = 0; k < sizeof ways / sizeof ways[0]; ++k) {
        for (int m = 0; m < 3; ++m) {
            const double h = m == 0 ? 1.0 : m == 1 ? 1e-3 : 7.0;
            CHECK_NEAR(find(&ways[k], 1, 0.0, h), before(0.37), 1e-9);
        }
    }
}

static void what_stays_as_it_is_ends_no_step(void)
{
    const cubic ways[] = {{0.1, -0.3, -1.3, -2.1}, {-0.1, -0.3, -1.3, -2.1}, {0.1, 1.2, 1.5, 3.0}};
    for (size_t k = 0; k < sizeof ways / sizeof ways[0]; ++k) {
        CHECK(!(fabs(find(&ways[k], 1, 0.0, 0.1)) > 0.0));
    }
}

/* The load, k d + c d', comes to nothing before the deflection does. */
static void a_damper_lets_go_before_the_tyre_leaves(void)
{
    const cubic way = {0.01, 0.8, 1.5, -2.0};
    const double h = 1e-2, c = 500.0;
    double low = 0.0, high = 0.8;
    for (int k = 0; k < 60; ++k) {
        double at[SE3DI_TYRE_NOTES];
        const double middle = 0.5 * (low + high);
        note(&way, h, middle, at);
        *(2e5 * at[0] + c * at[1] > 0.0 ? &low : &high) = middle;
    }
    CHECK(low > 0.1 && low < 0.7);
    CHECK_NEAR(find(&way, 1, c, h), before(low), 1e-9);
    CHECK_NEAR(find(&way, 1, 0.0, h), before(0.8), 1e-9);
}

/* On an uneven road: k d + c (d' + e), e straight from one end to the other. */
static void what_the_damper_has_besides_moves_where_it_lets_go(void)
{
    const cubic way = {0.01, 0.8, 1.5, -2.0};
    const double h = 1e-2, c = 500.0, off[2] = {-0.05, -0.35};
    se3di_force tyre = {.type = SE3DI_FORCE_TYRE, .k = 2e5, .c = c};
    const se3di_model model = {.forces = &tyre, .force_slots = {.count = 1}};
    double begin[SE3DI_TYRE_NOTES], end[SE3DI_TYRE_NOTES], low = 0.0, high = 0.8;
    for (int k = 0; k < 60; ++k) {
        double at[SE3DI_TYRE_NOTES];
        const double middle = 0.5 * (low + high);
        note(&way, h, middle, at);
        const double rate = at[1] + off[0] + middle * (off[1] - off[0]);
        *(2e5 * at[0] + c * rate > 0.0 ? &low : &high) = middle;
    }
    note(&way, h, 0.0, begin);
    note(&way, h, 1.0, end);
    begin[2] += off[0];
    end[2] += off[1];
    CHECK(low > 0.01 && low < 0.7 && fabs(before(low) - find(&way, 1, c, h)) > 1e-3);
    CHECK_NEAR(se3di_tyres_find_part(&model, h, begin, end), before(low), 1e-9);
}

/* The Magic Formula has a kink at FZMIN and at FZMAX; others have not. */
static void limits_of_the_load_end_steps(void)
{
    const cubic way = {0.01, 0.9, 4.0, -2.0}; /* from 7.2 cm down */
    se3di_tyre magic = {.law = SE3D_TYRE_MF52};
    se3di_force tyre = {.type = SE3DI_FORCE_TYRE, .k = 2e5, .tyre = &magic};
    const se3di_model model = {.forces = &tyre, .force_slots = {.count = 1}};
    double begin[SE3DI_TYRE_NOTES], end[SE3DI_TYRE_NOTES];
    const double load = 2e5 * 0.01 * (0.9 - 0.4) * (4.0 - 0.4) * (2.0 + 0.4), cosine = 0.8;
    for (int most = 0; most < 2; ++most) {
        note(&way, 0.01, 0.0, begin);
        note(&way, 0.01, 1.0, end);
        begin[3] = end[3] = cosine;
        memset(magic.coefficients, 0, sizeof magic.coefficients);
        CHECK_NEAR(se3di_tyres_find_part(&model, 0.01, begin, end), before(0.9), 1e-9);
        magic.coefficients[most ? SE3D_TYRE_FZMAX : SE3D_TYRE_FZMIN] = load / cosine;
        CHECK_NEAR(se3di_tyres_find_part(&model, 0.01, begin, end), before(0.4), 1e-9);
        magic.law = SE3D_TYRE_BRUSH;
        CHECK_NEAR(se3di_tyres_find_part(&model, 0.01, begin, end), before(0.9), 1e-9);
        magic.law = SE3D_TYRE_MF52;
    }
}

static void the_first_of_several_tyres_counts(void)
{
    const cubic ways[3] = {{0.1, 0.62, 1.3, 2.1}, {-0.1, 0.41, -1.3, -2.1}, {0.1, 0.55, 1.3, 2.1}};
    CHECK_NEAR(find(ways, 3, 0.0, 0.02), before(0.41), 1e-9);
    CHECK_NEAR(find(ways, 1, 0.0, 0.02), before(0.62), 1e-9);
}

/* A change near the beginning of a step is crossed by a part of it that is not too short. */
static void what_is_near_is_crossed(void)
{
    const cubic near = {0.1, 2e-3, 1.3, 2.1}, nearer = {0.1, 1e-9, 1.3, 2.1};
    CHECK_NEAR(find(&near, 1, 0.0, 0.02), 1.1 * 2e-3, 1e-9);
    CHECK_NEAR(find(&nearer, 1, 0.0, 0.02), 1e-7, 1e-15);
}

/* Two wheels above the plane z = 0 that sink at 0.2 m/s; a force that is no tyre stands between. */
static void each_tyre_has_notes_of_its_own(void)
{
    se3d_system *system = NULL;
    se3d_body wheel;
    se3d_force tyre[2], load;
    double notes[3 * SE3DI_TYRE_NOTES];
    CHECK(!se3d_system_create(NULL, &system));
    se3d_body_def body = se3d_body_def_default();
    body.mass = 20.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    body.position[2] = 0.25;
    body.velocity[2] = -0.2;
    CHECK(!se3d_body_create(system, &body, &wheel));
    for (int k = 0; k < 2; ++k) {
        se3d_tyre_def def = se3d_tyre_def_default();
        CHECK(!se3d_system_get_ground(system, &def.road));
        def.wheel = wheel;
        def.axis[1] = 1.0;
        def.normal[2] = 1.0;
        def.center[2] = 0.1 * k;
        def.radius = 0.3;
        def.k = 2e5;
        def.mu = 1.0;
        def.slip_stiffness = def.cornering_stiffness = 1e4;
        CHECK(!se3d_force_create_tyre(system, &def, &tyre[k]));
        if (k == 0) {
            se3d_load_def push = se3d_load_def_default();
            push.body = wheel;
            CHECK(!se3d_force_create_load(system, &push, &load));
        }
    }
    CHECK(se3di_tyres_are_there(&system->model));
    CHECK(!se3di_tyres_note(&system->model, 0.0, notes));
    for (size_t k = 0; k < 2; ++k) {
        const double *own = notes + SE3DI_TYRE_NOTES * 2 * k;
        CHECK_NEAR(own[0], 0.05 - 0.1 * (double)k, 1e-15);
        CHECK_NEAR(own[1], 0.2, 1e-15);
        CHECK_NEAR(own[2], 0.2, 1e-15);
        CHECK_NEAR(own[3], 1.0, 1e-15);
    }
    se3d_system_destroy(system);
}

int main(void)
{
    RUN(steps_end_before_the_first_zero);
    RUN(what_stays_as_it_is_ends_no_step);
    RUN(a_damper_lets_go_before_the_tyre_leaves);
    RUN(what_the_damper_has_besides_moves_where_it_lets_go);
    RUN(limits_of_the_load_end_steps);
    RUN(the_first_of_several_tyres_counts);
    RUN(what_is_near_is_crossed);
    RUN(each_tyre_has_notes_of_its_own);
    return check_finish();
}
