/* SPDX-License-Identifier: BSD-3-Clause */
/* User-defined constraints, and drivers whose values are functions of signals, in both
 * formulations, against central differences along a motion with known velocities and accelerations:
 * the rate of Phi is Phi_q qdot - nu, its second derivative Phi_q qddot - gamma; the error must
 * fall with the square of the step. */
#include "check.h"

#include "assembly/assembly.h"
#include "force/driver_rate.h"
#include "force/signal.h"
#include "joint/equation.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/user.h"
#include "support/two_points.h"
#include "system/system_internal.h"

enum { BODIES = TWO_POINTS_BODIES, EQUATIONS = TWO_POINTS_EQUATIONS };
enum { BODIES_MAX = 4, ROWS_MAX = 16 };

typedef struct motion {
    double r[3], p[4], v[3], w[3], a[3], wdot[3]; /* at time 0 of the motion */
} motion;

/* r = r0 + s v + s^2/2 a, p = p0 exp(s w + s^2/2 wdot): at s = 0 the derivatives are v, w, a, wdot.
 */
static void place(const motion *m, double s, se3di_frame *frame)
{
    double turn[3] = {0.0, 0.0, 0.0};
    se3di_copy(m->r, frame->r);
    se3di_add_scaled(s, m->v, frame->r);
    se3di_add_scaled(0.5 * s * s, m->a, frame->r);
    se3di_add_scaled(s, m->w, turn);
    se3di_add_scaled(0.5 * s * s, m->wdot, turn);
    se3di_quat_rotate(m->p, turn, frame->p);
    se3di_copy(m->v, frame->v);
    se3di_copy(m->w, frame->w);
    se3di_frame_update(frame);
}

typedef struct world {
    se3d_system *system;
    se3d_body bodies[BODIES_MAX];
    motion motions[BODIES_MAX];
    int count;           /* of bodies */
    uint32_t first, end; /* equations that are looked at */
    se3di_error error;
} world;

static void build_bodies(world *w, int count, uint64_t *seed)
{
    CHECK(!se3d_system_create(NULL, &w->system));
    w->count = count;
    for (int k = 0; k < count; ++k) {
        se3d_body_def body = se3d_body_def_default();
        double *all = (double *)&w->motions[k];
        body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
        for (size_t c = 0; c < sizeof(motion) / sizeof(double); ++c) {
            all[c] = check_random(seed);
        }
        w->motions[k].p[0] += count == BODIES ? 1.5 : 4.0; /* angles are far from singular */
        (void)se3di_quat_normalize(w->motions[k].p, w->motions[k].p);
        CHECK(!se3d_body_create(w->system, &body, &w->bodies[k]));
    }
}

static void build_user(world *w, uint64_t *seed)
{
    se3d_constraint link;
    se3d_user_constraint_def def = se3d_user_constraint_def_default();
    build_bodies(w, BODIES, seed);
    memcpy(def.bodies, w->bodies, BODIES * sizeof *def.bodies);
    w->end = EQUATIONS;
    def.callback = two_points;
    def.body_count = BODIES;
    def.equation_count = EQUATIONS;
    CHECK(!se3d_user_constraint_create(w->system, &def, &link));
}

static void add_joint(world *w, int i, int j, uint64_t *seed, se3d_constraint *joint)
{
    se3d_joint_def def = se3d_joint_def_default();
    double at[3], axis[3];
    for (int c = 0; c < 3; ++c) {
        at[c] = check_random(seed);
        axis[c] = check_random(seed);
    }
    def.body_i = w->bodies[i];
    def.body_j = w->bodies[j];
    CHECK(!se3d_joint_def_set_frame(w->system, &def, at, axis, NULL));
    CHECK(!se3d_joint_create_cylindrical(w->system, &def, joint));
}

/* A coordinate of one joint that follows both of another, a length, a point and an orientation;
 * `coordinate` chooses the one and leaves out what may not be. */
static void build_driver(world *w, int32_t coordinate, uint64_t *seed)
{
    static const char *const names[] = {"t", "a", "d", "l", "x", "e"};
    se3d_constraint driven, other;
    se3d_signal signals[5];
    se3d_function_def law = se3d_function_def_default();
    se3d_driver_def driver = se3d_driver_def_default();
    se3d_tsda_def gauge = se3d_tsda_def_default();
    build_bodies(w, BODIES_MAX, seed);
    add_joint(w, 0, 1, seed, &driven);
    add_joint(w, 2, 3, seed, &other);
    memset(signals, 0, sizeof signals);
    signals[0] = (se3d_signal){.kind = SE3D_SIGNAL_JOINT_COORDINATE, .joint = other};
    signals[1] = signals[0];
    signals[1].component = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    gauge.body_i = w->bodies[1];
    gauge.body_j = w->bodies[2];
    gauge.point_i[0] = 3.0; /* far enough for small errors */
    gauge.point_j[1] = 4.0;
    signals[2].kind = SE3D_SIGNAL_FORCE_COORDINATE;
    CHECK(!se3d_force_create_tsda(w->system, &gauge, &signals[2].force));
    signals[3] = (se3d_signal){.kind = SE3D_SIGNAL_POINT_POSITION,
                               .component = 1,
                               .body = w->bodies[3],
                               .point = {0.3, -0.5, 0.7}};
    signals[4] =
        (se3d_signal){.kind = SE3D_SIGNAL_ORIENTATION, .component = 2, .body = w->bodies[0]};
    law.expression = "sin(t)*a + 0.3*d^2*l + x*e*cos(a) + 0.2*x^2 + t^2*e";
    law.variables = names;
    law.variable_count = 6;
    law.signals = signals;
    law.signal_count = 5;
    CHECK(!se3d_function_create(w->system, &law, &driver.function));
    driver.joint = driven;
    driver.coordinate = coordinate;
    CHECK(!se3d_driver_create(w->system, &driver, &other));
    w->end = (uint32_t)w->system->model.row_count;
    w->first = w->end - 1;
}

static void build_angle_driver(world *w, uint64_t *seed)
{
    build_driver(w, SE3D_JOINT_COORDINATE_ANGLE, seed);
}

static void build_displacement_driver(world *w, uint64_t *seed)
{
    build_driver(w, SE3D_JOINT_COORDINATE_DISPLACEMENT, seed);
}

static void eval_phi(world *w, se3di_assembly *assembly, double t, double s, double *phi)
{
    for (int k = 0; k < w->count; ++k) {
        place(&w->motions[k], s, &w->system->model.frames[k + 1]);
    }
    CHECK(!se3di_assembly_eval_functions(assembly, t + s, &w->error));
    se3di_assembly_eval_phi(assembly, phi);
}

/* Largest errors of the first and second derivative with step h. */
static void measure(world *w, se3di_assembly *assembly, double t, double h, double worst[2])
{
    double before[ROWS_MAX], after[ROWS_MAX], phi[ROWS_MAX], rate[ROWS_MAX], second[ROWS_MAX];
    double gamma[ROWS_MAX], q[8 * BODIES_MAX] = {0.0};
    eval_phi(w, assembly, t, -h, before);
    eval_phi(w, assembly, t, h, after);
    eval_phi(w, assembly, t, 0.0, phi);
    for (int k = 0; k < w->count; ++k) {
        double *acceleration = w->system->model.acceleration + 6 * (k + 1);
        se3di_copy(w->motions[k].a, acceleration);
        se3di_copy(w->motions[k].wdot, acceleration + 3);
    }
    se3di_assembly_eval_jacobian(assembly);
    se3di_assembly_eval_gamma(assembly, gamma);
    se3di_assembly_get_velocity(assembly, q);
    se3di_assembly_mul(assembly, q, rate);
    se3di_assembly_get_acceleration(assembly, q);
    se3di_assembly_mul(assembly, q, second);
    double violation[3], most[3] = {0.0, 0.0, 0.0};
    worst[0] = worst[1] = 0.0;
    for (uint32_t e = w->first; e < w->end; ++e) {
        const double rates = rate[e] - assembly->f[3 * e + 1];
        most[0] = fmax(most[0], fabs(phi[e]));
        most[1] = fmax(most[1], fabs(rates));
        most[2] = fmax(most[2], fabs(second[e] - gamma[e]));
        double first = 0.5 * (after[e] - before[e]) / h;
        double twice = (after[e] - 2.0 * phi[e] + before[e]) / (h * h);
        worst[0] = fmax(worst[0], fabs(first - rates));
        worst[1] = fmax(worst[1], fabs(twice - (second[e] - gamma[e])));
    }
    if (w->first > 0) { /* the other rows are as far from zero as they like */
        return;
    }
    w->system->model.time = t;
    CHECK(!se3di_violation_measure(&w->system->model, violation));
    for (int level = 0; level < 3; ++level) { /* in both formulations the same numbers */
        CHECK_NEAR(violation[level], most[level], 1e-12 * fmax(1.0, most[level]));
    }
}

static void check_formulation(const se3di_formulation *formulation,
                              void (*build)(world *w, uint64_t *seed))
{
    uint64_t seed = 88172645463325252u;
    for (int trial = 0; trial < 20; ++trial) {
        world w = {0};
        se3di_assembly assembly;
        double t = 1.0 + check_random(&seed), coarse[2], fine[2];
        build(&w, &seed);
        CHECK(!se3di_assembly_init(&assembly, &w.system->model, formulation, 1, &w.error));
        measure(&w, &assembly, t, 2e-2, coarse);
        measure(&w, &assembly, t, 1e-2, fine);
        for (int k = 0; k < 2; ++k) {
            CHECK(fine[k] < 1e-2 && fine[k] > 1e-9); /* not compared with itself */
            CHECK_NEAR(coarse[k] / fine[k], 4.0, 0.2);
        }
        se3di_assembly_destroy(&assembly);
        se3d_system_destroy(w.system);
    }
}

static void values_fit_in_romega(void)
{
    check_formulation(&se3di_formulation_romega, build_user);
    check_formulation(&se3di_formulation_romega, build_angle_driver);
    check_formulation(&se3di_formulation_romega, build_displacement_driver);
}

static void values_fit_in_rp(void)
{
    check_formulation(&se3di_formulation_rp, build_user);
    check_formulation(&se3di_formulation_rp, build_angle_driver);
    check_formulation(&se3di_formulation_rp, build_displacement_driver);
}

/* Jacobian of the driver with body b displaced along or about axis c. */
static void eval_displaced(world *w, int b, int c, double by, double *row)
{
    se3di_model *model = &w->system->model;
    const se3di_constraint *driver = &model->constraints[model->constraint_slots.count - 1];
    se3di_frame *frame = &model->frames[driver->bodies[b]];
    const se3di_frame kept = *frame;
    se3di_user_values values;
    if (c < 3) {
        frame->r[c] += by;
    } else {
        double turn[3] = {0.0, 0.0, 0.0};
        turn[c - 3] = by;
        se3di_quat_rotate(kept.p, turn, frame->p);
    }
    se3di_frame_update(frame);
    CHECK(!se3di_user_eval(model, driver, 0.7, SE3DI_USER_JACOBIAN, &values));
    memcpy(row, values.jacobian, 6 * driver->body_count * sizeof *row);
    *frame = kept;
}

/* Curvature against differences of Jacobians, whose error falls by the square of the step. */
static void check_curvature(world *w)
{
    enum { N = 6 * BODIES_MAX };
    static const double steps[2] = {2e-3, 1e-3};
    double H[N * N], g[N], worst[2] = {0.0, 0.0}, lambda = 1.7;
    se3di_model *model = &w->system->model;
    const se3di_constraint *driver = &model->constraints[model->constraint_slots.count - 1];
    CHECK(!se3di_user_curvature(model, driver, 0.7, &lambda, H, g));
    for (int k = 0; k < 2 * N; ++k) {
        double before[N], after[N];
        const double h = steps[k / N];
        eval_displaced(w, k % N / 6, k % 6, -h, before);
        eval_displaced(w, k % N / 6, k % 6, h, after);
        for (int r = 0; r < N; ++r) {
            const double slope = 0.5 * lambda * (after[r] - before[r]) / h;
            worst[k / N] = fmax(worst[k / N], fabs(slope - H[N * r + k % N]));
        }
    }
    CHECK(worst[1] < 1e-4 && worst[1] > 1e-10);
    CHECK_NEAR(worst[0] / worst[1], 4.0, 0.1);
}

/* The curvature of a driver is the derivative of its Jacobian: no differences of its own. */
static void curvatures_of_drivers_fit(void)
{
    uint64_t seed = 1234567u;
    for (int trial = 0; trial < 6; ++trial) {
        world w = {0};
        build_driver(&w, trial % 2, &seed);
        se3di_model *model = &w.system->model;
        const se3di_constraint *driver = &model->constraints[model->constraint_slots.count - 1];
        CHECK(driver->body_count == BODIES_MAX);
        check_curvature(&w);
        se3d_system_destroy(w.system);
    }
}

/* ---- rates that follow signals ---- */

/* The rate of a coordinate of one joint that follows positions, velocities of all kinds, a state
 * and an output of it that depends on a velocity. @return the carrier of the state */
static uint32_t build_rate(world *w, int32_t coordinate, uint64_t *seed)
{
    enum { SIGNALS = 8 };
    static const char *const names[] = {"t", "a", "d", "l", "x", "o", "p", "z", "y"};
    se3d_constraint driven, other;
    se3d_signal signals[SIGNALS];
    se3d_function_def law = se3d_function_def_default();
    se3d_driver_def driver = se3d_driver_def_default();
    se3d_tsda_def gauge = se3d_tsda_def_default();
    se3d_state_def def = se3d_state_def_default();
    build_bodies(w, BODIES_MAX, seed);
    add_joint(w, 0, 1, seed, &driven);
    add_joint(w, 2, 3, seed, &other);
    memset(signals, 0, sizeof signals);
    signals[0] = (se3d_signal){.kind = SE3D_SIGNAL_JOINT_RATE, .joint = other};
    signals[1] = (se3d_signal){.kind = SE3D_SIGNAL_JOINT_COORDINATE,
                               .component = SE3D_JOINT_COORDINATE_DISPLACEMENT,
                               .joint = other};
    gauge.body_i = w->bodies[1];
    gauge.body_j = w->bodies[2];
    gauge.point_i[0] = 3.0;
    gauge.point_j[1] = 4.0;
    signals[2].kind = SE3D_SIGNAL_FORCE_RATE;
    CHECK(!se3d_force_create_tsda(w->system, &gauge, &signals[2].force));
    signals[3] = (se3d_signal){.kind = SE3D_SIGNAL_POINT_VELOCITY,
                               .component = 1,
                               .body = w->bodies[3],
                               .point = {0.3, -0.5, 0.7}};
    signals[4] =
        (se3d_signal){.kind = SE3D_SIGNAL_ANGULAR_VELOCITY, .component = 2, .body = w->bodies[0]};
    signals[5] = (se3d_signal){.kind = SE3D_SIGNAL_POINT_POSITION, .body = w->bodies[2]};
    law.variables = names;
    law.expression = "0.7 + 0*t";
    law.variable_count = 1;
    CHECK(!se3d_function_create(w->system, &law, &def.rate));
    def.initial = 0.4;
    CHECK(!se3d_state_create(w->system, &def, &signals[6].state));
    signals[6].kind = SE3D_SIGNAL_STATE;
    signals[6].component = SE3D_STATE_VALUE;
    signals[7] = signals[6];
    signals[7].component = SE3D_STATE_OUTPUT;
    law.expression = "a*d + t*a^2";
    law.variable_count = 3;
    law.signals = signals;
    law.signal_count = 2;
    CHECK(!se3d_function_create(w->system, &law, &def.output));
    CHECK(!se3d_state_set_output(w->system, signals[6].state, def.output));
    law.expression = "sin(t)*a + 0.3*d*l + x*o*cos(p) + 0.2*x^2 + t^2*z + y*o*z + 0.1*y^2";
    law.variable_count = SIGNALS + 1;
    law.signal_count = SIGNALS;
    CHECK(!se3d_function_create(w->system, &law, &driver.function));
    driver.joint = driven;
    driver.coordinate = coordinate;
    driver.is_rate = 1;
    CHECK(!se3d_driver_create(w->system, &driver, &other));
    return w->system->model.forces[w->system->model.force_slots.count - 1].body_j;
}

/* The state at s of the motion, with its velocities: A u - nu; *x, *f, and A a - gamma. */
static double eval_rate(world *w, uint32_t carrier, double t, double s, double *x, double *f,
                        double *second)
{
    se3di_model *model = &w->system->model;
    const se3di_constraint *driver = &model->constraints[model->constraint_slots.count - 1];
    se3di_user_values values;
    double jet[3], time = t + s, sum = 0.0;
    *second = 0.0;
    for (int k = 0; k < w->count; ++k) {
        se3di_frame *frame = &model->frames[k + 1];
        place(&w->motions[k], s, frame);
        se3di_add_scaled(s, w->motions[k].a, frame->v);
        se3di_add_scaled(s, w->motions[k].wdot, frame->w);
    }
    model->frames[carrier].v[0] = 0.4 + 0.7 * s;
    CHECK(!se3di_user_eval(model, driver, time,
                           SE3DI_USER_JACOBIAN | SE3DI_USER_NU | SE3DI_USER_GAMMA, &values));
    CHECK(driver->body_count == BODIES_MAX);
    for (uint32_t b = 0; b < driver->body_count; ++b) {
        const double *row = se3di_user_row(driver, &values, 0, b);
        const se3di_frame *frame = &model->frames[driver->bodies[b]];
        const motion *m = &w->motions[driver->bodies[b] - 1];
        sum += se3di_dot(row, frame->v) + se3di_dot(row + 3, frame->w);
        *second += se3di_dot(row, m->a) + se3di_dot(row + 3, m->wdot);
    }
    *x = se3di_driver_rate_coordinate(model, driver);
    CHECK(!se3di_law_eval(model, &model->functions[driver->law], &time, NULL, jet, NULL));
    *f = jet[0];
    *second -= values.gamma[0];
    return sum - values.nu[0];
}

/* x' - f is A u - nu, and its rate A a - gamma, along a motion with known accelerations. */
static void rates_of_drivers_fit(void)
{
    static const double steps[2] = {2e-3, 1e-3};
    uint64_t seed = 88172645463325252u;
    for (int trial = 0; trial < 20; ++trial) {
        world w = {0};
        double worst[2][2], x[3], f[3], second[3], gap[3];
        const uint32_t carrier = build_rate(&w, trial % 2, &seed);
        for (int k = 0; k < 2; ++k) {
            for (int n = 0; n < 3; ++n) {
                gap[n] = eval_rate(&w, carrier, 0.8, (n - 1) * steps[k], &x[n], &f[n], &second[n]);
            }
            worst[k][0] = fabs((x[2] - x[0]) / (2.0 * steps[k]) - f[1] - gap[1]);
            worst[k][1] = fabs((gap[2] - gap[0]) / (2.0 * steps[k]) - second[1]);
        }
        for (int c = 0; c < 2; ++c) {
            CHECK(worst[1][c] < 1e-3 && worst[1][c] > 1e-12);
            CHECK_NEAR(worst[0][c] / worst[1][c], 4.0, 0.1);
        }
        se3d_system_destroy(w.system);
    }
}

/* The curvature is the derivative of the row to positions, and multiplied with a step of all
 * velocities nothing of it is left out. */
static void curvatures_of_rates_fit(void)
{
    uint64_t seed = 1234567u;
    for (int trial = 0; trial < 6; ++trial) {
        double x, f, second;
        world w = {0};
        const uint32_t carrier = build_rate(&w, trial % 2, &seed);
        (void)eval_rate(&w, carrier, 0.7, 0.0, &x, &f, &second);
        check_curvature(&w);
        se3d_system_destroy(w.system);
    }
}

int main(void)
{
    RUN(values_fit_in_romega);
    RUN(values_fit_in_rp);
    RUN(curvatures_of_drivers_fit);
    RUN(rates_of_drivers_fit);
    RUN(curvatures_of_rates_fit);
    return check_finish();
}
