/* SPDX-License-Identifier: BSD-3-Clause */
/* The Formula SAE car of examples/fsae: its rigs by differences, its sides, its weight on tyres. */
#include <stdlib.h>

#include "check.h"
#include "se3d/io.h"

#define G 9.81

typedef struct rig {
    se3d_model *model;
    se3d_system *system;
    se3d_solver *solver;
} rig;

/* A model of the folder with a solver for its first analysis. */
static int open_rig(const char *name, rig *r)
{
    const char *source = getenv("SE3D_SOURCE_DIR");
    char path[800];
    se3d_model_error error = {0};
    se3d_solver_def def = se3d_solver_def_default();
    *r = (rig){NULL, NULL, NULL};
    snprintf(path, sizeof path, "%s/examples/fsae/%s.yaml", source ? source : ".", name);
    const se3d_status status = se3d_model_read_file(path, NULL, &r->model, &error);
    CHECK(status >= 0);
    if (status < 0) {
        fprintf(stderr, "%s\n", error.message);
        return 0;
    }
    CHECK(se3d_model_count_pictures(r->model) == 0); /* examples run where there is no gnuplot */
    r->system = se3d_model_get_system(r->model);
    CHECK(!se3d_model_get_solver(r->model, 0, &def));
    CHECK(!se3d_solver_create(r->system, &def, &r->solver));
    return r->solver != NULL;
}

static void close_rig(rig *r)
{
    se3d_solver_destroy(r->solver);
    se3d_model_destroy(r->model);
}

static void run(rig *r, double t)
{
    const se3d_status status = se3d_solver_run(r->solver, t);
    CHECK(status >= 0);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(r->system));
    }
}

/* Wheels in the order of the includes: front left and right, rear left and right. */
static void measure(const rig *r, size_t wheel, double *values)
{
    se3d_wheel handle;
    CHECK(!se3d_system_get_wheel(r->system, wheel, &handle));
    CHECK(!se3d_wheel_get_measures(r->system, handle, 0, SE3D_WHEEL_MEASURES, values));
}

static double length_of(const rig *r, const char *spring)
{
    double length = 0.0, rate = 0.0, force = 0.0;
    se3d_force handle;
    CHECK(!se3d_force_find(r->system, spring, &handle));
    CHECK(!se3d_force_get_state(r->system, handle, &length, &rate, &force));
    return length;
}

static void gradients_are_the_slopes_of_the_travel_rig(void)
{
    static const int pairs[][2] = {{SE3D_WHEEL_CAMBER, SE3D_WHEEL_CAMBER_GRADIENT},
                                   {SE3D_WHEEL_TOE, SE3D_WHEEL_TOE_GRADIENT},
                                   {SE3D_WHEEL_TRACK_CHANGE, SE3D_WHEEL_TRACK_GRADIENT},
                                   {SE3D_WHEEL_WHEELBASE_CHANGE, SE3D_WHEEL_WHEELBASE_GRADIENT},
                                   {SE3D_WHEEL_WHEEL_LOAD, SE3D_WHEEL_WHEEL_RATE}};
    static const char *const springs[2] = {"fl_spring", "rl_spring"};
    const double h = 5e-4, at = 0.3;
    double m[2][3][SE3D_WHEEL_MEASURES], length[2][3];
    rig r;
    if (!open_rig("travel", &r)) {
        return;
    }
    for (int k = 0; k < 3; ++k) {
        run(&r, at + (k - 1) * h);
        for (size_t axle = 0; axle < 2; ++axle) {
            measure(&r, 2 * axle, m[axle][k]);
            length[axle][k] = length_of(&r, springs[axle]);
        }
    }
    for (size_t axle = 0; axle < 2; ++axle) {
        double(*of)[SE3D_WHEEL_MEASURES] = m[axle];
        const double by = of[2][SE3D_WHEEL_TRAVEL] - of[0][SE3D_WHEEL_TRAVEL];
        CHECK(by > 1e-5);
        /* all wheels rise together, so the bar turns but does not wind */
        for (size_t p = 0; p < sizeof pairs / sizeof *pairs; ++p) {
            const int is_rate = pairs[p][1] == SE3D_WHEEL_WHEEL_RATE;
            const double slope = (of[2][pairs[p][0]] - of[0][pairs[p][0]]) / by;
            const double exact = of[1][pairs[p][1]];
            if (!is_rate) {
                CHECK_NEAR(slope, exact, 1e-6 * (1.0 + fabs(exact)));
            } else { /* of one wheel alone: the bar's part comes on top */
                CHECK(exact > slope && exact < 1.5 * slope);
            }
        }
        CHECK_NEAR(-(length[axle][2] - length[axle][0]) / by, of[1][SE3D_WHEEL_MOTION_RATIO], 1e-6);
    }
    close_rig(&r);
}

/* The rig of one wheel: the others stand, and the load of the wheel over its travel is its rate. */
static void one_wheel_moves_alone(void)
{
    const double h = 5e-4, at = 0.3;
    double fl[3][SE3D_WHEEL_MEASURES], fr[3][SE3D_WHEEL_MEASURES], two[SE3D_WHEEL_MEASURES];
    rig r;
    if (!open_rig("one_wheel", &r)) {
        return;
    }
    for (int k = 0; k < 3; ++k) {
        run(&r, at + (k - 1) * h);
        measure(&r, 0, fl[k]);
        measure(&r, 1, fr[k]);
    }
    const double by = fl[2][SE3D_WHEEL_TRAVEL] - fl[0][SE3D_WHEEL_TRAVEL];
    const double load = fl[2][SE3D_WHEEL_WHEEL_LOAD] - fl[0][SE3D_WHEEL_WHEEL_LOAD];
    CHECK(by > 1e-5);
    CHECK_NEAR(load / by, fl[1][SE3D_WHEEL_WHEEL_RATE], 1e-6 * fl[1][SE3D_WHEEL_WHEEL_RATE]);
    CHECK_NEAR(fr[2][SE3D_WHEEL_TRAVEL], 0.0, 1e-12);
    CHECK(fr[2][SE3D_WHEEL_WHEEL_LOAD] < fr[0][SE3D_WHEEL_WHEEL_LOAD]); /* the bar takes it */
    close_rig(&r);
    if (!open_rig("two_wheels", &r)) {
        return;
    }
    run(&r, at); /* both up: the bar turns but does not wind, the curves are those of one wheel */
    measure(&r, 0, two);
    CHECK_NEAR(two[SE3D_WHEEL_TRAVEL], fl[1][SE3D_WHEEL_TRAVEL], 1e-9);
    CHECK_NEAR(two[SE3D_WHEEL_TOE], fl[1][SE3D_WHEEL_TOE], 1e-9);
    CHECK_NEAR(two[SE3D_WHEEL_CAMBER], fl[1][SE3D_WHEEL_CAMBER], 1e-9);
    CHECK(two[SE3D_WHEEL_WHEEL_LOAD] < fl[1][SE3D_WHEEL_WHEEL_LOAD] - 10.0);
    close_rig(&r);
}

/* One wheel alone is lifted: its load over its travel, the bar included, is the wheel rate. */
static void the_wheel_rate_is_the_slope_with_one_wheel_lifted(void)
{
    const double h = 1e-5;
    double low[SE3D_WHEEL_MEASURES], middle[SE3D_WHEEL_MEASURES], high[SE3D_WHEEL_MEASURES];
    double *const of[3] = {low, middle, high};
    for (int k = 0; k < 3; ++k) {
        se3d_constraint road;
        rig r;
        if (!open_rig("travel", &r)) {
            return;
        }
        CHECK(!se3d_constraint_find(r.system, "fl_road", &road));
        CHECK(!se3d_constraint_destroy(r.system, road));
        se3d_primitive_def def = se3d_primitive_def_default();
        def.type = SE3D_PRIMITIVE_CD;
        CHECK(!se3d_system_get_ground(r.system, &def.body_i));
        CHECK(!se3d_body_find(r.system, "fl_upright", &def.body_j));
        def.c[2] = 1.0;
        def.value = 0.235 + (k - 1) * h;
        CHECK(!se3d_primitive_create(r.system, &def, &road));
        run(&r, 0.0);
        measure(&r, 0, of[k]);
        CHECK_NEAR(of[k][SE3D_WHEEL_TRAVEL], 0.007 + (k - 1) * h, 1e-9);
        close_rig(&r);
    }
    const double slope = (high[SE3D_WHEEL_WHEEL_LOAD] - low[SE3D_WHEEL_WHEEL_LOAD]) / (2.0 * h);
    CHECK_NEAR(slope, middle[SE3D_WHEEL_WHEEL_RATE], 1e-6 * slope);
}

static void both_sides_measure_the_same(void)
{
    double left[SE3D_WHEEL_MEASURES], right[SE3D_WHEEL_MEASURES];
    rig r;
    if (!open_rig("travel", &r)) {
        return;
    }
    CHECK(se3d_system_count_bodies(r.system) - 1 >= 38);
    run(&r, 0.4);
    for (size_t axle = 0; axle < 2; ++axle) {
        measure(&r, 2 * axle, left);
        measure(&r, 2 * axle + 1, right);
        for (int k = 0; k < SE3D_WHEEL_MEASURES; ++k) {
            const int turns = k == SE3D_WHEEL_STEER || k == SE3D_WHEEL_CONTACT_Y ||
                              k == SE3D_WHEEL_ACKERMANN_ERROR;
            const double other = turns ? -right[k] : right[k];
            CHECK_NEAR(left[k], other, 1e-8 * (1.0 + fabs(other)));
        }
    }
    close_rig(&r);
}

static void the_hand_wheel_steers_to_its_side(void)
{
    double left[SE3D_WHEEL_MEASURES], right[SE3D_WHEEL_MEASURES], rear[SE3D_WHEEL_MEASURES];
    rig r;
    if (!open_rig("steer", &r)) {
        return;
    }
    run(&r, 0.5);
    measure(&r, 0, left);
    measure(&r, 1, right);
    measure(&r, 2, rear);
    CHECK(left[SE3D_WHEEL_STEER] > right[SE3D_WHEEL_STEER] && right[SE3D_WHEEL_STEER] > 0.3);
    CHECK_NEAR(rear[SE3D_WHEEL_TOE], 0.2 * 3.14159265358979 / 180.0, 1e-9);
    CHECK(left[SE3D_WHEEL_CASTER] > 0.05 && left[SE3D_WHEEL_SCRUB_RADIUS] > 0.0);
    close_rig(&r);
}

/* The bar adds to roll, not to heave; and the roll rate is the slope of the moment in roll. */
static void the_roll_rate_is_the_slope_of_the_roll_rig(void)
{
    const double h = 5e-4;
    double left[2][SE3D_WHEEL_MEASURES], right[2][SE3D_WHEEL_MEASURES], of[SE3D_WHEEL_MEASURES];
    rig r;
    if (!open_rig("roll", &r)) {
        return;
    }
    measure(&r, 0, of);
    for (int k = 0; k < 2; ++k) {
        run(&r, k * 2.0 * h); /* from level: loads are odd in the roll */
        measure(&r, 0, left[k]);
        measure(&r, 1, right[k]);
    }
    /* M = t/2 (F_left - F_right), phi = 2 z / t */
    const double track = left[0][SE3D_WHEEL_CONTACT_Y] - right[0][SE3D_WHEEL_CONTACT_Y];
    const double z = left[1][SE3D_WHEEL_TRAVEL];
    const double moment =
        0.5 * track * (left[1][SE3D_WHEEL_WHEEL_LOAD] - right[1][SE3D_WHEEL_WHEEL_LOAD]);
    CHECK_NEAR(moment / (2.0 * z / track), of[SE3D_WHEEL_ROLL_RATE],
               1e-5 * of[SE3D_WHEEL_ROLL_RATE]);
    close_rig(&r);
}

static void the_corner_weights_sum_to_the_weight(void)
{
    static const char *const tyres[4] = {"fl_tyre", "fr_tyre", "rl_tyre", "rr_tyre"};
    double force[3] = {0.0, 0.0, 0.0}, weight = 0.0, side = 0.0;
    rig r;
    if (!open_rig("car", &r)) {
        return;
    }
    run(&r, 0.0);
    for (size_t k = 0; k < 4; ++k) {
        double wrench[6];
        se3d_force tyre;
        CHECK(!se3d_force_find(r.system, tyres[k], &tyre));
        CHECK(!se3d_force_get_wrench(r.system, tyre, 1, wrench));
        CHECK(wrench[2] > 600.0 && wrench[2] < 900.0);
        side += fabs(wrench[1]);
        for (int i = 0; i < 3; ++i) {
            force[i] += wrench[i];
        }
    }
    for (size_t k = 0; k < se3d_system_count_bodies(r.system); ++k) {
        double mass = 0.0, inertia[6];
        int32_t fixed = 0;
        se3d_body body;
        CHECK(!se3d_system_get_body(r.system, k, &body));
        CHECK(!se3d_body_get_fixed(r.system, body, &fixed));
        CHECK(!se3d_body_get_mass(r.system, body, &mass, inertia));
        weight += fixed ? 0.0 : mass * G;
    }
    CHECK_NEAR(force[2], weight, 1e-8 * weight);
    CHECK_NEAR(force[0], 0.0, 1e-6);
    CHECK_NEAR(force[1], 0.0, 1e-6);
    CHECK(side > 1.0);
    close_rig(&r);
}

/* The dampers hold dop853 to its limit of stability, at steps that radau would not make longer. */
static void auto_stays_with_dop853_on_the_road(void)
{
    rig r;
    double at = 0.0;
    const char *method = "", *left = "";
    se3d_solver_def def = se3d_solver_def_default();
    if (!open_rig("car", &r)) {
        return;
    }
    run(&r, 0.0);
    se3d_solver_destroy(r.solver);
    CHECK(!se3d_model_get_solver(r.model, 2, &def));
    CHECK(!se3d_solver_create(r.system, &def, &r.solver));
    run(&r, 0.5);
    CHECK(!se3d_solver_get_method(r.solver, &method));
    CHECK(!se3d_solver_get_switch(r.solver, &at, &left));
    CHECK(strcmp(method, "dop853") == 0 && !*left);
    close_rig(&r);
}

/* The sum over the tyres of one of what they tell. */
static double sum_tyres(const rig *r, size_t which)
{
    static const char *const names[4] = {"fl_tyre", "fr_tyre", "rl_tyre", "rr_tyre"};
    double sum = 0.0, value = 0.0;
    for (int k = 0; k < 4; ++k) {
        se3d_force tyre;
        CHECK(!se3d_force_find(r->system, names[k], &tyre));
        CHECK(!se3d_tyre_get_values(r->system, tyre, which, 1, &value));
        sum += value;
    }
    return sum;
}

static double speed_of_chassis(const rig *r)
{
    double v[3] = {0.0, 0.0, 0.0};
    se3d_body chassis;
    CHECK(!se3d_body_find(r->system, "chassis", &chassis));
    CHECK(!se3d_body_get_velocity(r->system, chassis, v));
    return v[0];
}

/* The tyres' forces are the mass times the deceleration, but for the little that the wheels' spins
 * and the pitch take; at a stand the loads are the weight. */
static void the_car_brakes_in_a_straight_line(void)
{
    double mass = 0.0, position[3];
    se3d_body chassis;
    rig r;
    if (!open_rig("brake", &r)) {
        return;
    }
    for (size_t k = 1; k < se3d_system_count_bodies(r.system); ++k) {
        se3d_body body;
        double own = 0.0, inertia[6];
        CHECK(!se3d_system_get_body(r.system, k, &body));
        CHECK(!se3d_body_get_mass(r.system, body, &own, inertia));
        mass += own;
    }
    run(&r, 2.95);
    const double before = speed_of_chassis(&r);
    run(&r, 3.0);
    const double force = sum_tyres(&r, SE3D_TYRE_FX);
    run(&r, 3.05);
    const double slowing = (before - speed_of_chassis(&r)) / 0.1;
    CHECK(slowing > 8.0);
    CHECK_NEAR(-force / mass, slowing, 0.01 * slowing);
    run(&r, 4.5);
    CHECK_NEAR(speed_of_chassis(&r), 0.0, 1e-4);
    CHECK_NEAR(sum_tyres(&r, SE3D_TYRE_FZ), mass * G, 1e-3 * mass * G);
    CHECK(!se3d_body_find(r.system, "chassis", &chassis));
    CHECK(!se3d_body_get_position(r.system, chassis, position));
    CHECK(position[0] > 8.0);
    CHECK_NEAR(position[1], 0.0, 1e-3);
    close_rig(&r);
}

/* Far too long a first step, from the stand, puts the tyres anywhere: where they leave the road in
 * it is no place to go to. It was gone to again and again. */
static void dop853_starts_at_the_stand(void)
{
    rig r;
    se3d_solver_stats stats;
    se3d_solver_def def = se3d_solver_def_default();
    if (!open_rig("brake", &r)) {
        return;
    }
    run(&r, 3.41);
    se3d_solver_destroy(r.solver);
    CHECK(!se3d_model_get_solver(r.model, 0, &def));
    def.method = SE3D_METHOD_DOP853;
    def.tolerance = 1e-3;
    def.steps_max = 1000.0;
    CHECK(!se3d_solver_create(r.system, &def, &r.solver));
    run(&r, 3.42);
    CHECK(!se3d_solver_get_stats(r.solver, &stats));
    CHECK(stats.steps < 200); /* 1e-4 s, as stability has it */
    close_rig(&r);
}

/* A tyre turns about the axis of its bearing: its camber is that of the hub wherever it has turned
 * to. */
static void tyres_do_not_wobble(void)
{
    double m[SE3D_WHEEL_MEASURES], inclination = 0.0;
    se3d_force left, right;
    rig r;
    if (!open_rig("brake", &r)) {
        return;
    }
    CHECK(!se3d_force_find(r.system, "fl_tyre", &left));
    CHECK(!se3d_force_find(r.system, "rr_tyre", &right));
    for (int k = 0; k < 4; ++k) { /* a turn of the wheels takes 0.9 s at first */
        run(&r, 1.0 + 0.2 * k);
        measure(&r, 0, m);
        CHECK(!se3d_tyre_get_values(r.system, left, SE3D_TYRE_INCLINATION, 1, &inclination));
        CHECK_NEAR(inclination, -m[SE3D_WHEEL_CAMBER], 3e-5); /* of the road, of the vehicle */
        measure(&r, 3, m);
        CHECK(!se3d_tyre_get_values(r.system, right, SE3D_TYRE_INCLINATION, 1, &inclination));
        CHECK_NEAR(inclination, m[SE3D_WHEEL_CAMBER], 3e-5); /* of the road, of the vehicle */
    }
    close_rig(&r);
}

/* Straight ahead at constant speed nothing but stability limits the steps of dop853, in the turn
 * after it they are as short for the sake of accuracy. */
static void auto_comes_back_to_dop853_in_the_turn(void)
{
    static const double tolerance[2] = {1e-3, 1e-6};
    double position[2][3], at = 0.0;
    for (int k = 0; k < 2; ++k) {
        const char *method = "", *left = "";
        se3d_body chassis;
        se3d_solver_def def = se3d_solver_def_default();
        rig r;
        if (!open_rig("step_steer", &r)) {
            return;
        }
        se3d_solver_destroy(r.solver);
        CHECK(!se3d_model_get_solver(r.model, 0, &def));
        def.tolerance = tolerance[k];
        CHECK(!se3d_solver_create(r.system, &def, &r.solver));
        run(&r, 6.0);
        CHECK(!se3d_solver_get_method(r.solver, &method));
        CHECK(!se3d_solver_get_switch(r.solver, &at, &left));
        CHECK(strcmp(method, "dop853") == 0 && strcmp(left, k == 0 ? "radau" : "") == 0);
        CHECK(k == 1 || (at > 3.5 && at < 4.5));
        CHECK(!se3d_body_find(r.system, "chassis", &chassis));
        CHECK(!se3d_body_get_position(r.system, chassis, position[k]));
        close_rig(&r);
    }
    for (int c = 0; c < 3; ++c) {
        CHECK_NEAR(position[0][c], position[1][c], 1e-4);
    }
}

int main(void)
{
    RUN(gradients_are_the_slopes_of_the_travel_rig);
    RUN(one_wheel_moves_alone);
    RUN(the_wheel_rate_is_the_slope_with_one_wheel_lifted);
    RUN(both_sides_measure_the_same);
    RUN(the_hand_wheel_steers_to_its_side);
    RUN(the_roll_rate_is_the_slope_of_the_roll_rig);
    RUN(the_corner_weights_sum_to_the_weight);
    RUN(auto_stays_with_dop853_on_the_road);
    RUN(auto_comes_back_to_dop853_in_the_turn);
    RUN(dop853_starts_at_the_stand);
    RUN(tyres_do_not_wobble);
    RUN(the_car_brakes_in_a_straight_line);
    return check_finish();
}
