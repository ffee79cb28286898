/* SPDX-License-Identifier: BSD-3-Clause */
/* Impacts shorter than a step of convex beside which nothing rests: momenta after them are those of
 * the law, as dop853 follows it, whatever way slip and corners go within. */
#include "support/scene.h"
#include "support/text_model.h"

#define STEP  5e-4 /* s, of convex; contacts take 1e-4 to 2e-4 s */
#define SIZE  0.1
#define SPEED 1.5

typedef struct impact {
    uint64_t seed;
    int32_t law, method;
    int meets;  /* another body, not the plane */
    int trails; /* one behind it on a ball joint */
    double friction, restitution;
} impact;

typedef struct solid {
    se3d_body body;
    double J[3], mass;
} solid;

/* Momentum and angular momentum about the origin, which stay while nothing touches, are added. */
static void add_momenta(const scene *s, const solid *b, double out[6])
{
    double w[3], p[4], r[3], v[3], t[3];
    CHECK(se3d_body_get_position(s->system, b->body, r) == SE3D_OK);
    CHECK(se3d_body_get_velocity(s->system, b->body, v) == SE3D_OK);
    CHECK(se3d_body_get_angular_velocity(s->system, b->body, w) == SE3D_OK);
    CHECK(se3d_body_get_orientation(s->system, b->body, p) == SE3D_OK);
    const double L[3] = {b->J[0] * w[0], b->J[1] * w[1], b->J[2] * w[2]};
    for (int k = 0; k < 3; ++k) {
        const int i = 1 + (k + 1) % 3, j = 1 + (k + 2) % 3;
        t[k] = 2.0 * (p[i] * L[j - 1] - p[j] * L[i - 1]);
    }
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        out[k] += b->mass * v[k];
        out[3 + k] += L[k] + p[0] * t[k] + p[1 + i] * t[j] - p[1 + j] * t[i];
        out[3 + k] += b->mass * (r[i] * v[j] - r[j] * v[i]);
    }
}

/* A box with sides of 0.4 to 1 SIZE, turned and spinning at random. */
static solid throw_box(scene *s, uint64_t *seed, const double r[3], const double v[3])
{
    solid b = {.mass = 1.0};
    double size[3], p[4], w[3], norm = 0.0;
    for (int k = 0; k < 3; ++k) {
        size[k] = SIZE * (0.7 + 0.3 * check_random(seed));
        w[k] = 10.0 * check_random(seed);
    }
    b.body = scene_box(s, size, b.mass, r, v);
    for (int k = 0; k < 3; ++k) {
        const double x = size[(k + 1) % 3], y = size[(k + 2) % 3];
        b.J[k] = b.mass * (x * x + y * y) / 12.0;
    }
    for (int k = 0; k < 4; ++k) {
        p[k] = check_random(seed);
        norm += p[k] * p[k];
    }
    for (int k = 0; k < 4; ++k) {
        p[k] /= sqrt(norm);
    }
    CHECK(se3d_body_set_orientation(s->system, b.body, p) == SE3D_OK);
    CHECK(se3d_body_set_angular_velocity(s->system, b.body, w) == SE3D_OK);
    return b;
}

static int is_same(const double a[6], const double b[6], double within)
{
    int same = 1;
    for (int k = 0; k < 3; ++k) {
        same = same && fabs(a[k] - b[k]) <= within * SPEED &&
               fabs(a[3 + k] - b[3 + k]) <= within * SPEED * SIZE;
    }
    return same;
}

/* A second one with the same velocity, on a ball joint at a corner of the first. */
static solid trail(scene *s, uint64_t *seed, const solid *first, const double v[3])
{
    const double at[3] = {0.45 * SIZE, 0.45 * SIZE, 0.45 * SIZE};
    double r[3], p[4], end[3], w[3];
    CHECK(se3d_body_get_position(s->system, first->body, r) == SE3D_OK);
    r[2] += 2.0 * SIZE;
    const solid b = throw_box(s, seed, r, v);
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint joint;
    CHECK(se3d_body_get_angular_velocity(s->system, first->body, w) == SE3D_OK);
    CHECK(se3d_body_get_orientation(s->system, first->body, p) == SE3D_OK);
    CHECK(se3d_body_set_orientation(s->system, b.body, p) == SE3D_OK);
    CHECK(se3d_body_set_angular_velocity(s->system, b.body, w) == SE3D_OK);
    CHECK(se3d_body_get_point(s->system, first->body, at, end) == SE3D_OK);
    for (int k = 0; k < 3; ++k) {
        def.point_i[k] = at[k];
        def.point_j[k] = -at[k];
        r[k] = 2.0 * end[k];
    }
    CHECK(se3d_body_get_position(s->system, first->body, end) == SE3D_OK);
    for (int k = 0; k < 3; ++k) {
        r[k] -= end[k];
    }
    CHECK(se3d_body_set_position(s->system, b.body, r) == SE3D_OK);
    def.body_i = first->body;
    def.body_j = b.body;
    CHECK(se3d_joint_create_spherical(s->system, &def, &joint) == SE3D_OK);
    return b;
}

static void momenta(const scene *s, const solid *b, int count, double out[6])
{
    memset(out, 0, 6 * sizeof *out);
    for (int k = 0; k < count; ++k) {
        add_momenta(s, &b[k], out);
    }
}

/* What the first impact makes of momenta. Returns 0 if they miss. */
static int meet(const impact *m, double change[6])
{
    uint64_t seed = m->seed;
    se3d_material_def stuff = scene_stuff(m->friction, m->restitution, 1e8);
    stuff.young = 1e10;
    scene s = scene_begin_with(NULL, m->law, &stuff);
    const double v[3] = {check_random(&seed), check_random(&seed), -SPEED};
    const double r[3] = {0.0, 0.0, 1.2 * SIZE + (m->meets ? SIZE : m->trails ? 1.5 * SIZE : 0.0)};
    const double still[3] = {0};
    double before[6], last[6], now[6];
    int hits = 0, is_over = 0;
    CHECK(se3d_system_set_gravity(s.system, still) == SE3D_OK);
    if (m->meets) {
        (void)throw_box(&s, &seed, still, still);
    } else {
        scene_floor(&s, 0.0);
    }
    solid b[2] = {throw_box(&s, &seed, r, v)};
    if (m->trails) {
        b[1] = trail(&s, &seed, b, v);
    }
    scene_solve(&s, m->method, SE3D_FORMULATION_ROMEGA,
                m->method == SE3D_METHOD_CONVEX ? STEP : 0.0, 0.0);
    momenta(&s, b, 1 + m->trails, before);
    memcpy(last, before, sizeof last);
    for (int k = 1; k < 600 && !is_over; ++k) {
        scene_run(&s, k * STEP);
        momenta(&s, b, 1 + m->trails, now);
        hits = hits || !is_same(now, before, 1e-4);
        is_over = hits && is_same(now, last, 1e-4);
        memcpy(last, now, sizeof last);
    }
    for (int k = 0; k < 6; ++k) {
        change[k] = now[k] - before[k];
    }
    scene_end(&s);
    return is_over;
}

/* Of many, nine in ten are within 2 %: a corner more or less may touch at once. */
static void check_all(impact m, int count)
{
    int near = 0, met = 0;
    for (int k = 0; k < count; ++k) {
        double exact[6], ours[6], size = 0.0, off = 0.0;
        m.seed += 17;
        m.friction = 0.2 * (k % 4);
        m.restitution = 0.2 + 0.2 * (k % 5);
        m.method = SE3D_METHOD_DOP853;
        const int meets = meet(&m, exact);
        m.method = SE3D_METHOD_CONVEX;
        CHECK(meet(&m, ours) == meets);
        for (int e = 0; e < 6 && meets; ++e) {
            const double scale = e < 3 ? 1.0 : SIZE;
            size = fmax(size, fabs(exact[e]) / scale);
            off = fmax(off, fabs(ours[e] - exact[e]) / scale);
        }
        if (meets) {
            ++met;
            near += off <= 0.02 * size;
            CHECK(off <= 0.5 * size);
        }
    }
    CHECK(met > count / 3);
    CHECK(10 * near >= 9 * met);
}

static void boxes_on_a_plane_leave_as_their_law_says(void)
{
    check_all((impact){.seed = 1, .law = SE3D_CONTACT_LAW_HOOKE}, 30);
    check_all((impact){.seed = 2, .law = SE3D_CONTACT_LAW_HERTZ_MINDLIN}, 30);
}

static void boxes_that_meet_part_as_their_law_says(void)
{
    check_all((impact){.seed = 3, .law = SE3D_CONTACT_LAW_HOOKE, .meets = 1}, 30);
    check_all((impact){.seed = 4, .law = SE3D_CONTACT_LAW_HERTZ_MINDLIN, .meets = 1}, 30);
}

static void machines_leave_a_plane_as_their_law_says(void)
{
    check_all((impact){.seed = 5, .law = SE3D_CONTACT_LAW_HOOKE, .trails = 1}, 20);
    check_all((impact){.seed = 6, .law = SE3D_CONTACT_LAW_HERTZ_MINDLIN, .trails = 1}, 20);
}

/* Five that touch without pressing, hit by one: the speeds of all. */
static void row(int32_t method, int32_t law, double v[6])
{
    const double still[3] = {0}, to[3] = {1.0, 0.0, 0.0};
    se3d_body balls[6];
    se3d_material_def stuff = scene_stuff(0.3, 0.9, 1e8);
    stuff.young = 1e10;
    scene s = scene_begin_with(NULL, law, &stuff);
    CHECK(se3d_system_set_gravity(s.system, still) == SE3D_OK);
    for (int k = 0; k < 6; ++k) {
        const double r[3] = {SIZE * k - (k ? 1e-8 * k : 1e-6), 0.0, 0.0};
        balls[k] = scene_ball(&s, 0.5 * SIZE, 1.0, r, k ? still : to);
    }
    scene_solve(&s, method, SE3D_FORMULATION_ROMEGA, method == SE3D_METHOD_CONVEX ? STEP : 0.0,
                0.0);
    scene_run(&s, 0.02);
    for (int k = 0; k < 6; ++k) {
        double u[3];
        CHECK(se3d_body_get_velocity(s.system, balls[k], u) == SE3D_OK);
        v[k] = u[0];
    }
    scene_end(&s);
}

static void a_row_of_balls_sends_off_the_last_one(void)
{
    for (int k = 0; k < 2; ++k) {
        const int32_t law = k ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE;
        double exact[6], ours[6];
        row(SE3D_METHOD_DOP853, law, exact);
        row(SE3D_METHOD_CONVEX, law, ours);
        for (int b = 0; b < 6; ++b) {
            CHECK_NEAR(ours[b], exact[b], 0.02);
        }
        CHECK(ours[5] > 0.6);
    }
}

/* The hard one is at rest when the soft one comes: it decides how short the steps are. */
static void soft_ball_on_a_hard_one_leaves_slowly(void)
{
    static const char *const text =
        "se3d: 1\ngravity: [0, 0, -9.81]\n"
        "materials: [{name: s, density: 1000, friction: 0, restitution: 0.7, young: 5.0e+6}, "
        "{name: h, density: 1000, friction: 0, restitution: 0.7, young: 2.0e+11}]\n"
        "contact: {law: hertz_mindlin}\n"
        "bodies: [{name: f, fixed: true, shapes: [{type: plane, material: h}]}, {name: a, "
        "position: [0, 0, 0.19], velocity: [0, 0, -1], shapes: [{type: sphere, radius: 0.1, "
        "material: s}]}, {name: b, position: [0, 0, 0.019999936862093975], shapes: [{type: "
        "sphere, radius: 0.02, material: h}]}]\nanalysis: {type: dynamics, duration: 0.05}\n"
        "output: [{file: r.csv, channels: [energy.total, energy.balance]}]\n";
    text_model m = text_model_open(text, SE3D_METHOD_CONVEX, -1, 1e-3);
    const double first = text_model_get(&m, 0, 0), balance = text_model_get(&m, 1, 0);
    for (int k = 1; k <= 50 && text_model_run(&m, 1e-3 * k); ++k) {
        CHECK(text_model_get(&m, 0, 0) <= 1.001 * first);
        CHECK_NEAR(text_model_get(&m, 1, 0), balance, 1e-6 * first);
    }
    text_model_close(&m);
}

/* What is driven into a floor takes any impulse: there is nothing to follow. */
static void what_is_driven_into_a_floor_goes_on(void)
{
    static const char *const text =
        "se3d: 1\nmaterials: [{name: s, density: 1000, friction: 0.3, restitution: 0.5, "
        "stiffness: 1.0e+7}]\ncontact: {}\n"
        "bodies: [{name: f, fixed: true, shapes: [{type: plane, material: s}]}, {name: a, "
        "position: [0, 0, 0.3], shapes: [{type: sphere, radius: 0.1, material: s}]}]\n"
        "joints: [{name: j, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0.3], axis: [0, "
        "0, 1]}]\ndrivers: [{joint: j, value: \"-0.201*sin(5*t)\"}]\n"
        "analysis: {type: dynamics, duration: 0.6}\n"
        "output: [{file: r.csv, channels: [a.position, energy.dissipated]}]\n";
    text_model m = text_model_open(text, SE3D_METHOD_CONVEX, -1, 1e-3);
    for (int k = 1; k <= 60 && text_model_run(&m, 0.01 * k); ++k) {
        CHECK_NEAR(text_model_get(&m, 0, 2), 0.3 - 0.201 * sin(0.05 * k), 1e-9);
        CHECK(fabs(text_model_get(&m, 1, 0)) < 1e5);
    }
    text_model_close(&m);
}

int main(void)
{
    RUN(boxes_on_a_plane_leave_as_their_law_says);
    RUN(boxes_that_meet_part_as_their_law_says);
    RUN(machines_leave_a_plane_as_their_law_says);
    RUN(a_row_of_balls_sends_off_the_last_one);
    RUN(soft_ball_on_a_hard_one_leaves_slowly);
    RUN(what_is_driven_into_a_floor_goes_on);
    return check_finish();
}
