/* SPDX-License-Identifier: BSD-3-Clause */
/* The Jacobians of every force element against central differences at random states with every term
 * active: the error must fall with the square of the step, and be small. The wrench of a
 * conservative element is minus the derivative of its potential, its power that of its wrench. */
#include "check.h"

#include "force/force.h"
#include "force/friction.h"
#include "force/tyre.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "misuse/element_defs.h"
#include "se3d/se3d.h"
#include "system/system_internal.h"

#include "golden/tyre_reference.h"

static uint64_t seed = 88172645463325252u;

typedef struct world {
    se3d_system *system;
    se3d_body i, j;
    se3d_constraint joint; /* cylindrical: an angle and a displacement */
    const se3di_force *force;
    se3di_model *model;
} world;

static void random_vector(double *v, int count, double scale)
{
    for (int k = 0; k < count; ++k) {
        v[k] = scale * check_random(&seed);
    }
}

static se3d_body add_body(world *w, const double *r, const double *p)
{
    se3d_body body;
    se3d_body_def def = se3d_body_def_default();
    def.mass = 1.0;
    def.inertia[0] = def.inertia[1] = def.inertia[2] = 1.0;
    memcpy(def.position, r, sizeof def.position);
    memcpy(def.orientation, p, sizeof def.orientation);
    random_vector(def.velocity, 3, 2.0);
    random_vector(def.angular_velocity, 3, 2.0);
    CHECK(se3d_body_create(w->system, &def, &body) == SE3D_OK);
    return body;
}

static void build(world *w)
{
    double r[3], p[4], turn[3];
    CHECK(se3d_system_create(NULL, &w->system) == SE3D_OK);
    random_vector(r, 3, 1.0);
    random_vector(p, 4, 1.0);
    p[0] += 1.5;
    (void)se3di_quat_normalize(p, p);
    w->i = add_body(w, r, p);
    r[0] += 1.5;
    random_vector(turn, 3, 0.5);
    se3di_quat_rotate(p, turn, p);
    w->j = add_body(w, r, p);
    se3d_joint_def def = se3d_joint_def_default();
    double at[3] = {r[0] - 0.7, r[1] + 0.2, r[2] - 0.1};
    double axis[3] = {0.3, 0.4, 0.8};
    def.body_i = w->i;
    def.body_j = w->j;
    def.angle0 = 0.3;
    CHECK(se3d_joint_def_set_frame(w->system, &def, at, axis, NULL) == SE3D_OK);
    CHECK(se3d_joint_create_cylindrical(w->system, &def, &w->joint) == SE3D_OK);
    w->model = &w->system->model;
    /* leave the assembled pose: every derivative counts */
    se3di_frame *frame = &w->model->frames[2];
    random_vector(turn, 3, 0.3);
    se3di_quat_rotate(frame->p, turn, frame->p);
    random_vector(turn, 3, 0.2);
    se3di_add(frame->r, turn, frame->r);
    se3di_frame_update(frame);
}

static void finish(world *w, se3d_status status)
{
    CHECK(status == SE3D_OK);
    if (status != SE3D_OK) {
        fprintf(stderr, "%s\n", se3d_system_get_error(w->system));
    }
    w->force = &w->model->forces[0];
}

static se3d_function make(world *w, const char *text, const char *x1, const char *x2)
{
    const char *const three[3] = {"t", x1, x2};
    const char *const one[1] = {"t"};
    se3d_function function;
    se3d_function_def def = se3d_function_def_default();
    def.expression = text;
    def.variables = x1 ? three : one;
    def.variable_count = x1 ? 3 : 1;
    CHECK(se3d_function_create(w->system, &def, &function) == SE3D_OK);
    return function;
}

static void create_tsda(world *w)
{
    se3d_force force;
    se3d_tsda_def def = se3d_tsda_def_default();
    def.body_i = w->i;
    def.body_j = w->j;
    random_vector(def.point_i, 3, 0.5);
    random_vector(def.point_j, 3, 0.5);
    def.k = 30.0;
    def.c = 2.0;
    def.l0 = 0.7;
    def.preload = 3.0;
    def.h = make(w, "sin(3*t) + 2*l^2 + l*ldot + 0.3*ldot^2", "l", "ldot");
    def.spring = make(w, "5*t^3", NULL, NULL);
    def.damper = make(w, "0.7*t^3", NULL, NULL);
    finish(w, se3d_force_create_tsda(w->system, &def, &force));
}

static void create_rsda(world *w)
{
    se3d_force force;
    se3d_rsda_def def = se3d_rsda_def_default();
    def.joint = w->joint;
    def.k = 30.0;
    def.c = 2.0;
    def.theta0 = 0.7;
    def.preload = 3.0;
    def.h = make(w, "sin(3*t) + 2*a^2 + a*adot + 0.3*adot^2", "a", "adot");
    def.spring = make(w, "5*t^3", NULL, NULL);
    def.damper = make(w, "0.7*t^3", NULL, NULL);
    finish(w, se3d_force_create_rsda(w->system, &def, &force));
}

static void create_rsda_on_axes(world *w)
{
    se3d_force force;
    se3d_rsda_def def = se3d_rsda_def_default();
    def.body_i = w->i;
    def.body_j = w->j;
    def.axis_i[0] = 0.6;
    def.axis_i[1] = 0.8;
    def.angle0 = 0.4;
    def.k = 11.0;
    def.c = 2.0;
    finish(w, se3d_force_create_rsda(w->system, &def, &force));
}

static void create_load(world *w, int torque, int in_body)
{
    se3d_force force;
    se3d_load_def def = se3d_load_def_default();
    def.body = w->j;
    random_vector(def.point, 3, 0.5);
    random_vector(def.value, 3, 10.0);
    def.function[1] = make(w, "3*cos(t)", NULL, NULL);
    def.in_body_frame = in_body;
    finish(w, torque ? se3d_force_create_torque(w->system, &def, &force)
                     : se3d_force_create_load(w->system, &def, &force));
}

static void create_ground_load(world *w)
{
    create_load(w, 0, 0);
}

static void create_follower_load(world *w)
{
    create_load(w, 0, 1);
}

static void create_ground_torque(world *w)
{
    create_load(w, 1, 0);
}

static void create_follower_torque(world *w)
{
    create_load(w, 1, 1);
}

static void create_bushing(world *w)
{
    se3d_force force;
    se3d_bushing_def def = se3d_bushing_def_default();
    def.body_i = w->i;
    def.body_j = w->j;
    random_vector(def.point_i, 3, 0.5);
    random_vector(def.point_j, 3, 0.5);
    random_vector(def.orientation_i, 4, 1.0);
    (void)se3di_quat_normalize(def.orientation_i, def.orientation_i);
    memcpy(def.orientation_j, def.orientation_i, sizeof def.orientation_j);
    double turn[3];
    random_vector(turn, 3, 0.4);
    se3di_quat_rotate(def.orientation_j, turn, def.orientation_j);
    for (int r = 0; r < 6; ++r) {
        for (int c = 0; c <= r; ++c) {
            def.K[6 * r + c] = def.K[6 * c + r] = 20.0 * check_random(&seed);
            def.C[6 * r + c] = 3.0 * check_random(&seed);
            def.C[6 * c + r] = 3.0 * check_random(&seed);
        }
    }
    finish(w, se3d_force_create_bushing(w->system, &def, &force));
}

/* Frames that almost coincide: the series. */
static void create_small_bushing(world *w)
{
    create_bushing(w);
    se3di_force *force = &w->model->forces[0];
    const double *p = w->model->frames[2].p;
    const double conjugate[4] = {p[0], -p[1], -p[2], -p[3]};
    double frame_i[4], turn[3];
    se3di_quat_mul(w->model->frames[1].p, force->p_i, frame_i);
    random_vector(turn, 3, 0.05);
    se3di_quat_rotate(frame_i, turn, frame_i);
    se3di_quat_mul(conjugate, frame_i, force->p_j);
}

static void create_friction(world *w, int32_t coordinate, double mode)
{
    se3d_force force;
    se3d_friction_def def = se3d_friction_def_default();
    def.joint = w->joint;
    def.coordinate = coordinate;
    def.mu = 0.3;
    def.radius = 0.2;
    def.limit = 4.0;
    def.viscous = 2.0;
    def.presliding = 0.5;
    finish(w, se3d_force_create_friction(w->system, &def, &force));
    double *state = w->model->forces[0].state;
    state[0] = 0.1;
    state[1] = 20.0;
    state[2] = mode;
    state[3] = 1.0;
}

static void create_sticking_hinge(world *w)
{
    create_friction(w, SE3D_JOINT_COORDINATE_ANGLE, 0.0);
}

static void create_slipping_slide(world *w)
{
    create_friction(w, SE3D_JOINT_COORDINATE_DISPLACEMENT, -1.0);
}

static void create_stop(world *w, double lower, double upper)
{
    se3d_force force;
    se3d_stop_def def = se3d_stop_def_default();
    def.body_i = w->i;
    def.body_j = w->j;
    random_vector(def.point_i, 3, 0.3);
    random_vector(def.point_j, 3, 0.3);
    def.lower = lower;
    def.upper = upper;
    def.k = 50.0;
    def.restitution = 0.8;
    finish(w, se3d_force_create_stop(w->system, &def, &force));
    w->model->forces[0].state[0] = 6.0;
}

static void create_upper_stop(world *w)
{
    create_stop(w, 0.1, 0.2);
}

static void create_lower_stop(world *w)
{
    create_stop(w, 9.0, 10.0);
}

static void create_effort(world *w, int32_t coordinate, const char *text)
{
    se3d_force force;
    se3d_effort_def def = se3d_effort_def_default();
    def.joint = w->joint;
    def.coordinate = coordinate;
    def.value = 3.0;
    if (text) {
        def.function = make(w, text, "q", "qdot");
    }
    finish(w, se3d_force_create_effort(w->system, &def, &force));
}

static void create_torque_effort(world *w)
{
    create_effort(w, SE3D_JOINT_COORDINATE_ANGLE, NULL);
}

static void create_push_effort(world *w)
{
    create_effort(w, SE3D_JOINT_COORDINATE_DISPLACEMENT, NULL);
}

static void create_law_of_effort(world *w)
{
    create_effort(w, SE3D_JOINT_COORDINATE_DISPLACEMENT, "5*sin(q) - 2*qdot*(1 + q^2) + t");
}

/* How the slip of the tyres that follow lags: 0 not at all, 1 by given lengths, 2 by PTX1 ..., 3 by
 * the carcass. */
static int lag_kind;

static void lag_tyre(const world *w, se3d_tyre_def *def, double *c)
{
    (void)w;
    def->is_transient = lag_kind > 0;
    def->relaxation_x = lag_kind == 1 ? 0.3 : 0.0;
    def->relaxation_y = lag_kind == 1 ? 0.5 : 0.0;
    c[SE3D_TYRE_PTX1] = lag_kind == 2 ? 1.8 : 0.0;
    c[SE3D_TYRE_PTX2] = -0.1;
    c[SE3D_TYRE_PTX3] = 0.3;
    c[SE3D_TYRE_PTY1] = lag_kind == 2 ? 1.9 : 0.0;
    c[SE3D_TYRE_PTY2] = 1.6;
    c[SE3D_TYRE_LONGITUDINAL_STIFFNESS] = 300.0;
    c[SE3D_TYRE_LATERAL_STIFFNESS] = 200.0;
    c[SE3D_TYRE_PCFX1] = 0.2;
    c[SE3D_TYRE_PCFX2] = -0.05;
    c[SE3D_TYRE_PCFY1] = -0.1;
}

/* The road of the tyres that follow: 0 a plane of their own, 1 hills that move, 2 the same rolled
 * over but standing still, 3 a grid, 4 a mesh, 5 a callback, 6 a steep slope rolled over. */
static int road_kind;

/* 0.03 sin(5 x + 7 t) cos(4 y) */
static se3d_status hill(void *ctx, const double *x, double jet[3], double *gradient)
{
    const double u = 5.0 * x[1] + 7.0 * x[0], v = 4.0 * x[2];
    (void)ctx;
    jet[0] = 0.03 * sin(u) * cos(v);
    jet[1] = 0.21 * cos(u) * cos(v);
    jet[2] = -1.47 * sin(u) * cos(v);
    if (gradient) {
        gradient[0] = jet[1];
        gradient[1] = 0.15 * cos(u) * cos(v);
        gradient[2] = -0.12 * sin(u) * sin(v);
    }
    return SE3D_OK;
}

static void lay_road(world *w, se3d_tyre_def *def)
{
    static const uint32_t triangles[12] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    static const double points[15] = {-9.0, -8.0, 0.1, 9.0, -8.0, -0.2, 9.0, 8.0,
                                      0.3,  -9.0, 8.0, 0.0, -7.0, -6.0, 0.2};
    double heights[48];
    se3d_road_def road = se3d_road_def_default();
    se3d_function_def callback = se3d_function_def_default();
    road.body = def->road;
    memcpy(road.point, def->point, sizeof road.point);
    memcpy(road.normal, def->normal, sizeof road.normal);
    random_vector(road.forward, 3, 1.0);
    def->envelope_length = road_kind == 2 || road_kind == 6 ? 0.07 : 0.0;
    if (road_kind == 1) {
        road.height = make(w, "0.03*sin(5*x + 7*t)*cos(4*y)", "x", "y");
    } else if (road_kind == 2) {
        road.height = make(w, "0.03*sin(5*x)*cos(4*y) + 0*t", "x", "y");
    } else if (road_kind ==
               6) { /* too steep for most discs: they stand on the end of their reach */
        road.height = make(w, "6*x + 0*y + 0*t", "x", "y");
    } else if (road_kind == 5) {
        callback.callback = hill;
        callback.variable_count = 3;
        CHECK(!se3d_function_create(w->system, &callback, &road.height));
    }
    for (int k = 0; road_kind == 3 && k < 48; ++k) {
        heights[k] = 0.02 * check_random(&seed);
        road.heights = heights;
    }
    road.column_count = 8;
    road.row_count = 6;
    road.spacing[0] = road.spacing[1] = 0.3;
    road.triangles = road_kind == 4 ? triangles : NULL;
    road.vertices = points;
    road.vertex_count = 5;
    road.triangle_count = 4;
    CHECK(!se3d_road_create(w->system, &road, &def->surface));
}

/* A wheel somewhere in the road, inclined; its slip is what the random motion gives, made smaller
 * or larger by the speed below which it is regularised. */
/* 1: turn slip counts in the tyres that follow. */
static int turn_kind;

static void create_tyre(world *w, int32_t law, double low_speed, double mu)
{
    se3d_force force;
    se3d_tyre_def def = se3d_tyre_def_default();
    double n[3], across[3], center[3], arm[3];
    const se3di_frame *i = &w->model->frames[1], *j = &w->model->frames[2];
    double c[SE3D_TYRE_COEFFICIENTS];
    se3d_tyre_coefficients_init(c, SE3D_TYRE_COEFFICIENTS);
    for (size_t k = 0; k < sizeof tyre_coefficients / sizeof *tyre_coefficients; ++k) {
        c[tyre_coefficients[k].at] = tyre_coefficients[k].value;
    }
    c[SE3D_TYRE_FNOMIN] = 10.0;
    def.road = w->i;
    def.wheel = w->j;
    random_vector(def.center, 3, 0.2);
    random_vector(n, 3, 1.0);
    n[2] += 1.5;
    (void)se3di_unit(n, n);
    se3di_perpendicular(n, across);
    se3di_add_scaled(0.4 * check_random(&seed), n, across);
    se3di_mul_transposed(j->A, across, def.axis);
    se3di_mul_transposed(i->A, n, def.normal);
    se3di_mul(j->A, def.center, center);
    se3di_add(center, j->r, center);
    se3di_sub(center, i->r, arm);
    se3di_add_scaled(-0.24, n, arm);
    se3di_mul_transposed(i->A, arm, def.point);
    def.side = check_random(&seed) > 0.0 ? SE3D_TYRE_RIGHT : SE3D_TYRE_LEFT;
    def.law = law;
    def.radius = 0.3;
    def.k = 200.0;
    def.c = 0.5;
    def.mu = mu;
    def.mu_min = 0.5 * mu;
    def.slip_stiffness = 50.0;
    def.cornering_stiffness = 40.0;
    def.patch_length = 0.2;
    def.rolling_resistance = 0.02;
    def.low_speed = low_speed;
    def.coefficients = c;
    def.coefficient_count = SE3D_TYRE_COEFFICIENTS;
    def.has_turn_slip = turn_kind;
    lag_tyre(w, &def, c);
    if (road_kind > 0) {
        lay_road(w, &def);
    }
    finish(w, se3d_force_create_tyre(w->system, &def, &force));
    for (size_t k = 3; k < w->model->body_slots.count; ++k) { /* slips that lag */
        w->model->frames[k].v[0] = 0.3 * check_random(&seed);
    }
}

static void create_sticking_brush(world *w)
{
    create_tyre(w, SE3D_TYRE_BRUSH, 40.0, 3.0);
}

static void create_sliding_brush(world *w)
{
    create_tyre(w, SE3D_TYRE_BRUSH, 1e-3, 0.1);
}

static void create_rolling_fiala(world *w)
{
    create_tyre(w, SE3D_TYRE_FIALA, 40.0, 3.0);
}

static void create_sliding_fiala(world *w)
{
    create_tyre(w, SE3D_TYRE_FIALA, 12.0, 0.2);
}

static void create_mf52(world *w)
{
    create_tyre(w, SE3D_TYRE_MF52, 20.0, 1.1);
}

static void create_mf61(world *w)
{
    create_tyre(w, SE3D_TYRE_MF61, 20.0, 1.1);
}

static void create_turning52(world *w)
{
    turn_kind = 1;
    create_tyre(w, SE3D_TYRE_MF52, 20.0, 1.1);
    turn_kind = 0;
}

static void create_turning61(world *w)
{
    turn_kind = 1;
    create_tyre(w, SE3D_TYRE_MF61, 20.0, 1.1);
    turn_kind = 0;
}

/* A drag that depends on everything. */
static se3d_status drag(void *ctx, double t, const se3d_body_motion motion[2], double wrench[12],
                        double *K, double *D)
{
    (void)ctx;
    (void)K;
    (void)D;
    for (int k = 0; k < 3; ++k) {
        double v = motion[1].v[k] - motion[0].v[k];
        wrench[6 + k] = -0.3 * v * (1.0 + motion[1].r[k] * motion[1].r[k]) + sin(t);
        wrench[9 + k] = -0.2 * motion[1].w[k] * motion[1].p[1] * motion[1].p[k];
        wrench[k] = -wrench[6 + k];
    }
    return SE3D_OK;
}

static void create_callback(world *w)
{
    se3d_force force;
    se3d_force_callback_def def = se3d_force_callback_def_default();
    def.body_i = w->i;
    def.body_j = w->j;
    def.callback = drag;
    finish(w, se3d_force_create_callback(w->system, &def, &force));
}

/* Displace coordinate k of 12, or velocity k - 12. */
static void displace(world *w, int k, double by)
{
    se3di_frame *frame = &w->model->frames[1 + k % 12 / 6];
    int part = k % 6;
    if (k >= 12) {
        double *velocity = part < 3 ? frame->v : frame->w;
        velocity[part % 3] += by;
    } else if (part < 3) {
        frame->r[part] += by;
    } else {
        double turn[3] = {0.0, 0.0, 0.0};
        turn[part - 3] = by;
        se3di_quat_rotate(frame->p, turn, frame->p);
    }
    se3di_frame_update(frame);
}

/* The largest error of K and D by central differences of step h. */
static double jacobian_error(world *w, const se3di_effect *exact, double h)
{
    double worst = 0.0;
    se3di_frame kept[3];
    memcpy(kept, w->model->frames, sizeof kept);
    for (int k = 0; k < 24; ++k) {
        se3di_effect plus = {.wants_derivative = 0};
        se3di_effect minus = {.wants_derivative = 0};
        displace(w, k, h);
        CHECK(se3di_force_eval(w->model, w->force, 0.3, &plus) == SE3D_OK);
        memcpy(w->model->frames, kept, sizeof kept);
        displace(w, k, -h);
        CHECK(se3di_force_eval(w->model, w->force, 0.3, &minus) == SE3D_OK);
        memcpy(w->model->frames, kept, sizeof kept);
        for (int r = 0; r < 12; ++r) {
            double slope = (plus.wrench[r] - minus.wrench[r]) / (2.0 * h);
            double given = (k < 12 ? exact->K : exact->D)[12 * r + k % 12];
            worst = fmax(worst, fabs(slope - given));
        }
    }
    return worst;
}

static double largest(const se3di_effect *effect)
{
    double size = 0.0;
    for (int k = 0; k < 144; ++k) {
        size = fmax(size, fmax(fabs(effect->K[k]), fabs(effect->D[k])));
    }
    return size;
}

/* What is computed without derivatives is the same to the bit. */
static void check_values(const world *w, const se3di_effect *exact)
{
    static se3di_effect plain;
    memset(&plain, 0, sizeof plain);
    CHECK(se3di_force_eval(w->model, w->force, 0.3, &plain) == SE3D_OK);
    for (int k = 0; k < 12; ++k) {
        CHECK(!(fabs(plain.wrench[k] - exact->wrench[k]) > 0.0));
    }
    CHECK(!(fabs(plain.potential - exact->potential) > 0.0));
    CHECK(!(fabs(plain.power[0] - exact->power[0]) > 0.0));
    CHECK(!(fabs(plain.power[1] - exact->power[1]) > 0.0));
}

static void jacobians_agree_with_differences(void (*create)(world *), double floor_error)
{
    for (int trial = 0; trial < 20; ++trial) {
        world w = {0};
        static se3di_effect exact;
        build(&w);
        create(&w);
        exact.wants_derivative = 1;
        CHECK(se3di_force_eval(w.model, w.force, 0.3, &exact) == SE3D_OK);
        check_values(&w, &exact);
        double size = fmax(1.0, largest(&exact));
        double coarse = jacobian_error(&w, &exact, 1e-3);
        double fine = jacobian_error(&w, &exact, 2.5e-4);
        CHECK(coarse <= 2e-3 * size);
        CHECK(fine <= coarse / 12.0 || fine <= floor_error * size);
        se3d_system_destroy(w.system);
    }
}

static void jacobians_of_every_element(void)
{
    void (*const create[])(world *) = {
        create_tsda,           create_rsda,           create_rsda_on_axes,    create_ground_load,
        create_follower_load,  create_ground_torque,  create_follower_torque, create_bushing,
        create_small_bushing,  create_sticking_hinge, create_slipping_slide,  create_upper_stop,
        create_lower_stop,     create_torque_effort,  create_push_effort,     create_law_of_effort,
        create_sticking_brush, create_sliding_brush,  create_rolling_fiala,   create_sliding_fiala,
        create_mf52,           create_mf61,
    };
    for (size_t k = 0; k < sizeof create / sizeof create[0]; ++k) {
        jacobians_agree_with_differences(create[k], 1e-10);
    }
}

static double lag_rate(const world *w, int direction)
{
    se3di_tyre_lag lag = {.wants_derivative = 0};
    CHECK(!se3di_tyre_lag_eval(w->model, w->force, 0.3, direction, &lag));
    return lag.rate;
}

/* The largest errors of the derivatives of a slip that lags, [0], and of what the wrench has of it,
 * [1], by central differences of step h. */
static void lag_errors(world *w, int direction, const se3di_tyre_lag *exact, double h,
                       double worst[2])
{
    se3di_frame kept[5];
    double *z = &w->model->frames[w->force->tyre->carrier[direction]].v[0];
    double plus, minus;
    se3di_effect far = {.wants_derivative = 0}, near = {.wants_derivative = 0};
    worst[0] = worst[1] = 0.0;
    for (size_t k = 0; k < w->model->force_slots.count; ++k) { /* states, too */
        double alone = (double)NAN;
        CHECK(!se3di_force_eval(w->model, &w->model->forces[k], 0.3, &far));
        CHECK(!se3di_force_potential(w->model, &w->model->forces[k], 0.3, &alone));
        CHECK(alone == far.potential);
    }
    memcpy(kept, w->model->frames, sizeof kept);
    for (int k = 0; k < 24; ++k) {
        displace(w, k, h);
        plus = lag_rate(w, direction);
        memcpy(w->model->frames, kept, sizeof kept);
        displace(w, k, -h);
        minus = lag_rate(w, direction);
        memcpy(w->model->frames, kept, sizeof kept);
        const double given = (k < 12 ? exact->K : exact->D)[k % 12];
        worst[0] = fmax(worst[0], fabs((plus - minus) / (2.0 * h) - given));
    }
    *z += h;
    plus = lag_rate(w, direction);
    CHECK(!se3di_force_eval(w->model, w->force, 0.3, &far));
    *z -= 2.0 * h;
    minus = lag_rate(w, direction);
    CHECK(!se3di_force_eval(w->model, w->force, 0.3, &near));
    *z += h;
    worst[0] = fmax(worst[0], fabs((plus - minus) / (2.0 * h) - exact->own));
    for (int k = 0; k < 12; ++k) {
        const double slope = (far.wrench[k] - near.wrench[k]) / (2.0 * h);
        worst[1] = fmax(worst[1], fabs(slope - exact->gain[k]));
    }
}

static void tyres_on_roads_agree_with_differences(void)
{
    static void (*const create[])(world *) = {create_sticking_brush, create_rolling_fiala,
                                              create_mf61};
    for (road_kind = 1; road_kind < 7; ++road_kind) {
        jacobians_agree_with_differences(create[(road_kind + 1) % 3], road_kind == 5 ? 1e-6 : 1e-8);
    }
    road_kind = 0;
}

/* On a plane, and on hills that move. */
static void turn_slip_agrees_with_differences(void)
{
    for (road_kind = 0; road_kind < 2; ++road_kind) {
        jacobians_agree_with_differences(create_turning52, 1e-8);
        jacobians_agree_with_differences(create_turning61, 1e-8);
    }
    road_kind = 0;
}

static void slips_that_lag_agree_with_differences(void)
{
    static void (*const create[])(world *) = {create_sticking_brush, create_rolling_fiala,
                                              create_mf52, create_mf61};
    for (int trial = 0; trial < 40; ++trial) {
        lag_kind = trial % 4 < 2 ? 1 : 2 + trial / 4 % 2;
        road_kind = trial % 5 == 0; /* some on hills that move */
        world w = {0};
        build(&w);
        create[trial % 4](&w);
        CHECK(w.model->state_count == 2);
        for (int direction = 0; direction < 2; ++direction) {
            se3di_tyre_lag exact = {.wants_derivative = 1};
            double coarse[2], fine[2];
            CHECK(!se3di_tyre_lag_eval(w.model, w.force, 0.3, direction, &exact));
            CHECK(!(fabs(lag_rate(&w, direction) - exact.rate) > 0.0));
            lag_errors(&w, direction, &exact, 1e-3, coarse);
            lag_errors(&w, direction, &exact, 2.5e-4, fine);
            for (int k = 0; k < 2; ++k) {
                CHECK(fine[k] <= coarse[k] / 12.0 || fine[k] <= 1e-7);
                CHECK(coarse[k] < 2.0);
            }
        }
        se3d_system_destroy(w.system);
    }
    road_kind = 0;
    for (size_t k = 0; k < 4; ++k) { /* the wrench by everything else */
        lag_kind = k < 2 ? 1 : 2;
        jacobians_agree_with_differences(create[k], 1e-8);
    }
    lag_kind = 0;
}

/* The definitions that other tests try too: a new element needs no row here, but states of its own
 * for terms that these leave zero. Those with a memory are in states that their rows above set. */
#define LISTED(name, def)                                                                          \
    static void create_listed_##name(world *w)                                                     \
    {                                                                                              \
        const site at = {.ground = w->i, .body = w->j, .pin = w->joint};                           \
        double storage[200];                                                                       \
        se3d_force force;                                                                          \
        fill_##name(&at, storage);                                                                 \
        finish(w, se3d_force_create_##name(w->system, (const void *)storage, &force));             \
    }
FORCE_LIST(LISTED)
#undef LISTED

static void jacobians_of_every_element_of_the_list(void)
{
#define LISTED(name, def) create_listed_##name,
    void (*const create[])(world *) = {FORCE_LIST(LISTED)};
#undef LISTED
    int tried = 0;
    for (size_t k = 0; k < sizeof create / sizeof create[0]; ++k) {
        world w = {0};
        build(&w);
        create[k](&w);
        const int has_memory = se3di_force_class_of(w.force)->accept != NULL;
        se3d_system_destroy(w.system);
        if (!has_memory) {
            jacobians_agree_with_differences(create[k], 1e-8);
            ++tried;
        }
    }
    CHECK(tried >= 7);
}

static void a_callback_without_jacobian_is_differenced(void)
{
    jacobians_agree_with_differences(create_callback, 1e-8);
}

/* Conservative elements: wrench = -dV/dq, at rest. */
static void the_wrench_is_minus_the_gradient_of_the_potential(void)
{
    void (*const create[])(world *) = {create_rsda_on_axes, create_bushing, create_sticking_hinge};
    for (size_t k = 0; k < sizeof create / sizeof create[0]; ++k) {
        for (int trial = 0; trial < 20; ++trial) {
            world w = {0};
            build(&w);
            create[k](&w);
            for (int b = 1; b < 3; ++b) {
                memset(w.model->frames[b].v, 0, sizeof w.model->frames[b].v);
                memset(w.model->frames[b].w, 0, sizeof w.model->frames[b].w);
            }
            se3di_effect effect = {.wants_derivative = 0};
            CHECK(se3di_force_eval(w.model, w.force, 0.3, &effect) == SE3D_OK);
            for (int c = 0; c < 12; ++c) {
                const double h = 1e-5;
                se3di_effect plus = {.wants_derivative = 0};
                se3di_effect minus = {.wants_derivative = 0};
                displace(&w, c, h);
                CHECK(se3di_force_eval(w.model, w.force, 0.3, &plus) == SE3D_OK);
                displace(&w, c, -2.0 * h);
                CHECK(se3di_force_eval(w.model, w.force, 0.3, &minus) == SE3D_OK);
                displace(&w, c, h);
                double slope = (plus.potential - minus.potential) / (2.0 * h);
                CHECK_NEAR(effect.wrench[c], -slope, 1e-7 * (1.0 + fabs(slope)));
            }
            se3d_system_destroy(w.system);
        }
    }
}

static void create_tyre_on_hills(world *w)
{
    road_kind = 1;
    create_mf61(w);
    road_kind = 0;
}

static void create_tyre_over_hills(world *w)
{
    road_kind = 2;
    create_sticking_brush(w);
    road_kind = 0;
}

/* wrench . u = -dV/dt - dissipated + actuator, for every element. */
static void power_balances_for_every_element(void)
{
    void (*const create[])(world *) = {create_tsda,
                                       create_rsda,
                                       create_rsda_on_axes,
                                       create_ground_load,
                                       create_follower_torque,
                                       create_bushing,
                                       create_sticking_hinge,
                                       create_slipping_slide,
                                       create_upper_stop,
                                       create_lower_stop,
                                       create_torque_effort,
                                       create_law_of_effort,
                                       create_sticking_brush,
                                       create_sliding_brush,
                                       create_rolling_fiala,
                                       create_sliding_fiala,
                                       create_mf52,
                                       create_mf61,
                                       create_tyre_on_hills,
                                       create_tyre_over_hills,
                                       create_callback};
    for (size_t k = 0; k < sizeof create / sizeof create[0]; ++k) {
        for (int trial = 0; trial < 10; ++trial) {
            world w = {0};
            build(&w);
            create[k](&w);
            se3di_effect e = {.wants_derivative = 0};
            CHECK(se3di_force_eval(w.model, w.force, 0.3, &e) == SE3D_OK);
            double power = 0.0, alone = (double)NAN;
            double potential_rate = 0.0;
            CHECK(se3di_force_potential(w.model, w.force, 0.3, &alone) == SE3D_OK);
            CHECK(alone == e.potential);
            const double h = 1e-5;
            for (int b = 0; b < 2; ++b) {
                power += se3di_dot(e.wrench + 6 * b, w.model->frames[1 + b].v);
                power += se3di_dot(e.wrench + 6 * b + 3, w.model->frames[1 + b].w);
            }
            for (int side = 1; side >= -1; side -= 2) {
                se3di_frame kept[3];
                se3di_effect moved = {.wants_derivative = 0};
                memcpy(kept, w.model->frames, sizeof kept);
                for (int b = 1; b < 3; ++b) {
                    for (int c = 0; c < 3; ++c) {
                        displace(&w, 6 * (b - 1) + c, side * h * kept[b].v[c]);
                    }
                    double turn[3];
                    se3di_scale(side * h, kept[b].w, turn);
                    se3di_quat_rotate(w.model->frames[b].p, turn, w.model->frames[b].p);
                    se3di_frame_update(&w.model->frames[b]);
                }
                CHECK(se3di_force_eval(w.model, w.force, 0.3 + side * h, &moved) == SE3D_OK);
                potential_rate += side * moved.potential / (2.0 * h);
                memcpy(w.model->frames, kept, sizeof kept);
            }
            double expected = -potential_rate - e.power[0] + e.power[1];
            CHECK_NEAR(power, expected, 1e-6 * (1.0 + fabs(power) + fabs(potential_rate)));
            se3d_system_destroy(w.system);
        }
    }
}

/* The largest error of the load's derivative by the parts of the reaction. */
static double load_error(const world *w, double h)
{
    double R[SE3DI_FRICTION_PARTS], gradient[SE3DI_FRICTION_PARTS];
    double worst = 0.0;
    for (int k = 0; k < SE3DI_FRICTION_PARTS; ++k) {
        R[k] = (k % 2 ? -1.0 : 1.0) * (2.0 + k);
    }
    (void)se3di_friction_load(w->model, w->force, R, gradient);
    for (int k = 0; k < SE3DI_FRICTION_PARTS; ++k) {
        const double kept = R[k];
        R[k] = kept + h;
        const double plus = se3di_friction_load(w->model, w->force, R, NULL);
        R[k] = kept - h;
        const double minus = se3di_friction_load(w->model, w->force, R, NULL);
        R[k] = kept;
        worst = fmax(worst, fabs((plus - minus) / (2.0 * h) - gradient[k]));
    }
    return worst;
}

static void the_load_of_friction_changes_with_the_reaction_as_told(void)
{
    void (*const create[])(world *) = {create_sticking_hinge, create_slipping_slide};
    for (int k = 0; k < 8; ++k) {
        world w = {0};
        build(&w);
        create[k % 2](&w);
        se3di_force *force = &w.model->forces[0];
        force->length = k & 2 ? 0.4 : 0.0;
        force->width = k & 4 ? 0.3 : 0.0;
        force->thrust_radius = k & 4 ? 0.1 : 0.0;
        const double coarse = load_error(&w, 1e-2);
        CHECK(coarse < 1e-4);
        CHECK(load_error(&w, 2.5e-3) < coarse / 12.0 + 1e-11);
        se3d_system_destroy(w.system);
    }
}

int main(void)
{
    RUN(the_load_of_friction_changes_with_the_reaction_as_told);
    RUN(jacobians_of_every_element);
    RUN(tyres_on_roads_agree_with_differences);
    RUN(slips_that_lag_agree_with_differences);
    RUN(jacobians_of_every_element_of_the_list);
    RUN(a_callback_without_jacobian_is_differenced);
    RUN(the_wrench_is_minus_the_gradient_of_the_potential);
    RUN(power_balances_for_every_element);
    RUN(turn_slip_agrees_with_differences);
    return check_finish();
}
