/* SPDX-License-Identifier: BSD-3-Clause */
/* What a material may say in place of what its law has: damping along the normal, stiffness and
 * damping along the tangent, of rolling and of torsion, in closed form. A ball meets a plane, or
 * rests on it, as a particle and as a body (docs/theory/contact-laws.md). */
#include <stddef.h>

#include "se3d/io.h"
#include "support/scene.h"

#define RADIUS 0.02

enum { PARTICLE = -2, PORTABLE = -1 };
static const int32_t everyone[] = {PARTICLE, PORTABLE, SE3D_METHOD_DOP853, SE3D_METHOD_RADAU};
#define EVERYONE 4

typedef struct ball {
    scene s;
    se3d_particles *set;
    se3d_body body;
    double mass, now;
} ball;

static se3d_material_def stuff(void)
{
    return scene_stuff(1e6, 1.0, 1e4); /* nothing slips */
}

/* Steps of particles: a 10th of the automatic ones. */
static void refine(ball *b, int32_t law)
{
    se3d_contact_settings contact = se3d_contact_settings_default();
    double step;
    contact.law = law;
    CHECK(se3d_particles_get_step(b->set, &step) == SE3D_OK);
    contact.step = 0.1 * step;
    CHECK(se3d_system_set_contact(b->s.system, &contact) == SE3D_OK);
}

/* The plane of another material; at height z, no gravity. */
static ball begin(int32_t who, int32_t law, const se3d_material_def *of,
                  const se3d_material_def *plane, double z, const double v[3], const double w[3])
{
    ball b = {.s = scene_begin_with(NULL, law, plane),
              .mass = of->density * 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS};
    const double r[3] = {0.0, 0.0, z}, radius = RADIUS;
    scene_floor(&b.s, 0.0);
    CHECK(se3d_material_create(b.s.system, of, &b.s.material) == SE3D_OK);
    CHECK(se3d_system_set_gravity(b.s.system, scene_zero) == SE3D_OK);
    if (who <= PORTABLE) {
        se3d_particles_def set = se3d_particles_def_default();
        set.portable = who == PORTABLE;
        CHECK(se3d_particles_create(b.s.system, &set, &b.set) == SE3D_OK);
        CHECK(se3d_particles_add(b.set, b.s.material, 1, r, &radius, v, w, NULL) == SE3D_OK);
        refine(&b, law);
    } else {
        b.body = scene_ball(&b.s, RADIUS, b.mass, r, v);
        CHECK(se3d_body_set_angular_velocity(b.s.system, b.body, w) == SE3D_OK);
        scene_solve(&b.s, who, SE3D_FORMULATION_AUTO, 0.0, 1e-8);
    }
    return b;
}

static void end(ball *b)
{
    se3d_particles_destroy(b->set);
    scene_end(&b->s);
}

static void run(ball *b, double time, double v[3], double w[3])
{
    double r[3];
    if (b->set) {
        CHECK(se3d_particles_run(b->set, time) == SE3D_OK);
        CHECK(se3d_particles_get_all(b->set, 1, r, v, w) == SE3D_OK);
    } else {
        (void)scene_run(&b->s, time);
        CHECK(se3d_body_get_velocity(b->s.system, b->body, v) == SE3D_OK);
        CHECK(se3d_body_get_angular_velocity(b->s.system, b->body, w) == SE3D_OK);
    }
}

/* After an impact of 1 mm/s, slow enough that the arm is the radius: the restitution, and the slip
 * over that before. */
static double impact(int32_t who, int32_t law, const se3d_material_def *of,
                     const se3d_material_def *plane, double *slip)
{
    const double into = 1e-3, before = 0.2 * into, gap = 1e-6;
    double v[3] = {before, 0.0, -into}, w[3] = {0.0, 0.0, 0.0};
    ball b = begin(who, law, of, plane, RADIUS + gap, v, w);
    run(&b, 1.0, v, w);
    CHECK(v[2] > 0.0);
    end(&b);
    *slip = (v[0] - RADIUS * w[1]) / before;
    return v[2] / into;
}

static void the_tangential_stiffness_of_hertz_is_that_given(void)
{
    static const double given[4] = {0.25, 0.6, 1.2, -1.0};
    for (int k = 0; k < 5 * EVERYONE; ++k) {
        se3d_material_def of = stuff(), plane = stuff();
        double slip;
        const double mindlin = 3.0 * (1.0 - 0.3) / (2.0 - 0.3);
        const double ratio = k / EVERYONE < 4 ? given[k / EVERYONE] : 0.5;
        of.tangential_ratio_hertz = ratio;
        plane.tangential_ratio_hertz = k / EVERYONE < 4 ? ratio : 0.0; /* the law's own */
        const double is = k / EVERYONE < 4 ? fmax(ratio, 0.0) : sqrt(ratio * mindlin);
        CHECK_NEAR(
            impact(everyone[k % EVERYONE], SE3D_CONTACT_LAW_HERTZ_MINDLIN, &of, &plane, &slip), 1.0,
            1e-4);
        CHECK_NEAR(slip, cos(PI * sqrt(0.01 + 2.8 * is)) / cos(0.1 * PI), 5e-3);
    }
}

/* Then the slip swings with w_t = sqrt(7/2 kt/m) for as long as Hertz lets them touch. */
static void a_tangential_stiffness_is_the_same_at_any_overlap(void)
{
    static const double given[4][2] = {{1.5, 1.5}, {2.5, 0.0}, {2.0, 6.0}, {-1.0, 3.0}};
    static const double is[4] = {1.5, 2.5, 3.0, 0.0};
    const double mass = 1e3 * 4.0 / 3.0 * PI * pow(RADIUS, 3.0), into = 1e-3;
    for (int k = 0; k < 4 * EVERYONE; ++k) {
        se3d_material_def of = stuff(), plane = stuff();
        double slip;
        const double modulus = of.young / (2.0 * (1.0 - of.poisson * of.poisson));
        const double depth = pow(15.0 * mass * into * into / (16.0 * sqrt(RADIUS) * modulus), 0.4);
        const double time = 0.8 * sqrt(PI) * tgamma(0.4) / tgamma(0.9) * depth / into;
        const double unit = mass / (time * time); /* of stiffness */
        of.tangential_stiffness = given[k / EVERYONE][0] * unit;
        plane.tangential_stiffness = given[k / EVERYONE][1] * unit;
        of.rolling_ratio = 0.3; /* which is over that of the law */
        CHECK_NEAR(
            impact(everyone[k % EVERYONE], SE3D_CONTACT_LAW_HERTZ_MINDLIN, &of, &plane, &slip), 1.0,
            1e-4);
        CHECK_NEAR(slip, cos(sqrt(3.5 * is[k / EVERYONE])), 5e-3);
    }
}

/* Of hooke it is what a ratio to the stiffness makes of it. */
static void a_tangential_stiffness_of_hooke_stands_for_a_ratio(void)
{
    for (int k = 0; k < EVERYONE; ++k) {
        se3d_material_def of = stuff(), ratio = of;
        double slip[2], left[2];
        of.restitution = ratio.restitution = 0.8;
        of.tangential_damping = ratio.tangential_damping = 0.3;
        ratio.tangential_ratio = 0.5;
        of.tangential_stiffness = 0.5 * of.stiffness;
        left[0] = impact(everyone[k], SE3D_CONTACT_LAW_HOOKE, &of, &of, &slip[0]);
        left[1] = impact(everyone[k], SE3D_CONTACT_LAW_HOOKE, &ratio, &ratio, &slip[1]);
        CHECK_NEAR(left[0], left[1], 1e-12);
        CHECK_NEAR(slip[0], slip[1], 1e-9);
    }
}

/* With hooke the slip swings with w_t = sqrt(7/2 kt/m) and the damping ratio 7/2 x zeta wn/w_t for
 * as long as the normal force pushes. */
static void tangential_damping_is_that_given(void)
{
    static const double given[3] = {0.6, 0.0, -1.0};
    for (int k = 0; k < 3 * EVERYONE; ++k) {
        se3d_material_def of = stuff();
        double slip;
        const double zeta = 0.2, wn = sqrt(1e4 / (1e3 * 4.0 / 3.0 * PI * pow(RADIUS, 3.0)));
        const double root = sqrt(1.0 - zeta * zeta);
        const double time = (PI - atan2(2.0 * zeta * root, root * root - zeta * zeta)) / root / wn;
        of.damping_ratio = zeta;
        of.tangential_ratio = 0.4;
        of.tangential_damping = given[k / EVERYONE];
        const double wt = sqrt(3.5 * 0.4) * wn;
        const double x = k / EVERYONE == 1 ? 0.4 : fmax(of.tangential_damping, 0.0); /* hooke's */
        const double ratio = 3.5 * x * zeta * wn / wt, wd = wt * sqrt(1.0 - ratio * ratio);
        const double expected =
            exp(-ratio * wt * time) * (cos(wd * time) - ratio * wt / wd * sin(wd * time));
        CHECK_NEAR(impact(everyone[k % EVERYONE], SE3D_CONTACT_LAW_HOOKE, &of, &of, &slip),
                   exp(-zeta * wn * time), 5e-4);
        CHECK_NEAR(slip, expected, 3e-3);
    }
}

/* x'' = -max(0, x^1.5 + alpha x^.25 x'), alpha = 2 ratio sqrt(3/2), from x' = 1. */
static double restitution_of_hertz(double ratio)
{
    const double alpha = 2.0 * ratio * sqrt(1.5), h = 1e-5;
    double x = 0.0, v = 1.0, force = 0.0;
    for (int k = 0; k < 1000000 && (force > 0.0 || v > 0.0); ++k) {
        x += 0.5 * h * v;
        force = pow(fmax(x, 0.0), 1.5) + alpha * pow(fmax(x, 0.0), 0.25) * v;
        v -= h * fmax(force, 0.0);
        x += 0.5 * h * v;
    }
    return -v;
}

static void a_damping_ratio_stands_for_a_restitution(void)
{
    static const double ratios[4] = {-1.0, 0.05, 0.3, 0.9};
    for (int k = 0; k < 4 * EVERYONE; ++k) {
        se3d_material_def of = stuff();
        double slip;
        const double ratio = ratios[k / EVERYONE];
        of.restitution = 0.77; /* not looked at */
        of.damping_ratio = ratio;
        CHECK_NEAR(impact(everyone[k % EVERYONE], SE3D_CONTACT_LAW_HERTZ_MINDLIN, &of, &of, &slip),
                   ratio > 0.0 ? restitution_of_hertz(ratio) : 1.0, 1e-3);
    }
}

/* Of two materials the mean, or the one that says so; 0 of a model file, here < 0, is none. */
static void a_damping_rate_holds_for_the_pair(void)
{
    static const double rates[4][2] = {{200.0, 0.0}, {0.0, 200.0}, {100.0, 400.0}, {-1.0, 400.0}};
    for (int k = 0; k < 8; ++k) {
        se3d_material_def of = stuff(), plane = stuff();
        double slip;
        const double wn = sqrt(1e4 / (1e3 * 4.0 / 3.0 * PI * pow(RADIUS, 3.0)));
        const double zeta = k / 2 < 3 ? 0.5 * 200.0 / wn : 0.0, root = sqrt(1.0 - zeta * zeta);
        const double angle = PI - atan2(2.0 * zeta * root, root * root - zeta * zeta);
        of.restitution = plane.restitution = 0.3; /* not looked at */
        of.damping_rate = rates[k / 2][0];
        plane.damping_rate = rates[k / 2][1];
        CHECK_NEAR(impact(everyone[k % 2], SE3D_CONTACT_LAW_HOOKE, &of, &plane, &slip),
                   exp(-zeta / root * angle), 5e-4);
    }
}

/* Of two that meet with the damping that they have, not with that of a restitution. */
static void steps_follow_a_damping_rate(void)
{
    static const double rates[3] = {1e-6, 200.0, 1000.0};
    const double mass = 1e3 * 4.0 / 3.0 * PI * pow(RADIUS, 3.0);
    for (int k = 0; k < 3; ++k) {
        const double zero[3] = {0.0, 0.0, 0.0};
        se3d_material_def of = stuff();
        se3d_contact_settings contact = se3d_contact_settings_default();
        double step;
        of.restitution = 0.2; /* not looked at */
        of.damping_rate = rates[k];
        ball b = begin(PARTICLE, SE3D_CONTACT_LAW_HOOKE, &of, &of, 2.0 * RADIUS, zero, zero);
        CHECK(se3d_system_set_contact(b.s.system, &contact) == SE3D_OK); /* the automatic step */
        CHECK(se3d_particles_get_step(b.set, &step) == SE3D_OK);
        CHECK_NEAR(0.02 * PI / step, sqrt(2.0 * 1e4 / mass) + rates[k], 1e-9 / step);
        end(&b);
    }
}

/* A ball that is pressed on the plane and spins about the vertical: R^2 (kr theta + dr sqrt(m) w) =
 * -I w'. */
static void torsion_swings_as_given(void)
{
    static const double given[3][2] = {{0.5, 0.1}, {2.0, -1.0}, {0.0, 0.3}};
    for (int k = 0; k < 3 * EVERYONE; ++k) {
        se3d_material_def of = stuff();
        const double *choice = given[k / EVERYONE];
        of.damping_ratio = 0.5; /* hooke: no swing of its own */
        of.torsional_friction = 1e6;
        of.rolling_ratio = choice[0];
        of.rolling_damping = choice[1];
        const double kr = (choice[0] > 0.0 ? choice[0] : 1.0) * 2.0 / 7.0 * 1e4, spin = 1e-2;
        const double g[3] = {0.0, 0.0, -G};
        double v[3] = {0.0, 0.0, 0.0}, w[3] = {0.0, 0.0, spin};
        ball b = begin(everyone[k % EVERYONE], SE3D_CONTACT_LAW_HOOKE, &of, &of,
                       RADIUS - 1e3 * 4.0 / 3.0 * PI * pow(RADIUS, 3.0) * G / 1e4, v, w);
        CHECK(se3d_system_set_gravity(b.s.system, g) == SE3D_OK);
        const double w0 = sqrt(2.5 * kr / b.mass);
        const double ratio = 1.25 * fmax(choice[1], 0.0) * sqrt(kr / b.mass) / w0;
        const double wd = w0 * sqrt(1.0 - ratio * ratio);
        for (int n = 1; n < 8; ++n) {
            const double t = 0.37 * n * 2.0 * PI / w0;
            run(&b, t, v, w);
            CHECK_NEAR(w[2] / spin,
                       exp(-ratio * w0 * t) * (cos(wd * t) - ratio * w0 / wd * sin(wd * t)), 5e-3);
        }
        end(&b);
    }
}

/* The same of hertz_mindlin with a stiffness that is given, whatever the load. */
static void torsion_of_hertz_swings_at_any_overlap(void)
{
    static const double given[4][2] = {{600.0, 600.0}, {900.0, 0.0}, {400.0, 1200.0}, {-1.0, 5.0}};
    static const double is[4] = {600.0, 900.0, 600.0, 0.0}, damping = 0.2;
    const double mass = 1e3 * 4.0 / 3.0 * PI * pow(RADIUS, 3.0);
    for (int k = 0; k < 8 * EVERYONE; ++k) {
        se3d_material_def of = stuff(), plane = stuff();
        const double kr = is[k / EVERYONE % 4], load = (k < 4 * EVERYONE ? 1.0 : 8.0) * G;
        const double modulus = of.young / (2.0 * (1.0 - of.poisson * of.poisson));
        const double depth = pow(mass * load / (4.0 / 3.0 * modulus * sqrt(RADIUS)), 2.0 / 3.0);
        const double g[3] = {0.0, 0.0, -load}, spin = 1e-2;
        double v[3] = {0.0, 0.0, 0.0}, w[3] = {0.0, 0.0, spin};
        of.damping_ratio = plane.damping_ratio = 0.5;
        of.torsional_friction = plane.torsional_friction = 1e6;
        of.rolling_stiffness = given[k / EVERYONE % 4][0];
        plane.rolling_stiffness = given[k / EVERYONE % 4][1];
        of.rolling_damping = plane.rolling_damping = damping;
        ball b = begin(everyone[k % EVERYONE], SE3D_CONTACT_LAW_HERTZ_MINDLIN, &of, &plane,
                       RADIUS - depth, v, w);
        CHECK(se3d_system_set_gravity(b.s.system, g) == SE3D_OK);
        const double w0 = sqrt(2.5 * fmax(kr, 600.0) / b.mass);
        const double ratio = 1.25 * damping * sqrt(kr / b.mass) / w0;
        const double wd = w0 * sqrt(1.0 - ratio * ratio);
        for (int n = 1; n < 6; ++n) {
            const double t = 0.37 * n * 2.0 * PI / w0;
            const double swings =
                exp(-ratio * w0 * t) * (cos(wd * t) - ratio * w0 / wd * sin(wd * t));
            run(&b, t, v, w);
            CHECK_NEAR(w[2] / spin, kr > 0.0 ? swings : 1.0, 5e-3);
        }
        end(&b);
    }
}

static void what_no_contact_could_be_is_refused(void)
{
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.5, 1e4);
    se3d_material_def def = stuff();
    se3d_material made;
    def.damping_ratio = 60.0;
    CHECK(se3d_material_create(s.system, &def, &made) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(s.system), "damping_ratio = 60, a restitution of ");
    def.damping_ratio = 0.0;
    def.rolling_ratio = 101.0;
    CHECK(se3d_material_create(s.system, &def, &made) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(s.system), "rolling_ratio = 101");
    def.rolling_ratio = 3.0;
    def.rolling_stiffness = 2.0;
    CHECK(se3d_material_create(s.system, &def, &made) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(s.system), "rolling_stiffness = 2, in place of");
    def.rolling_stiffness = 0.0;
    CHECK(se3d_material_create(s.system, &def, &made) == SE3D_OK);
    se3d_material_pair_def pair = se3d_material_pair_def_default();
    pair.rolling_ratio = pair.rolling_stiffness = 1.0;
    CHECK(se3d_material_set_pair(s.system, made, made, &pair) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(s.system), "rolling_stiffness = 1, in place of");
    CHECK(se3d_material_get(s.system, made, &def) == SE3D_OK);
    CHECK_NEAR(def.rolling_ratio, 3.0, 0.0);
    scene_end(&s);
}

/* Read a model; NULL, with the message in `error`, if that fails. */
static se3d_model *read_model(const char *text, se3d_model_error *error)
{
    se3d_model *model = NULL;
    (void)se3d_model_read_text(text, strlen(text), "choices.yaml", NULL, &model, error);
    return model;
}

static se3d_material_def get_material(const se3d_model *model)
{
    se3d_material material;
    se3d_material_def def = se3d_material_def_default();
    se3d_system *system = se3d_model_get_system(model);
    CHECK(se3d_system_get_material(system, 0, &material) == SE3D_OK);
    CHECK(se3d_material_get(system, material, &def) == SE3D_OK);
    return def;
}

/* 0 of a model file is none. */
static void model_files_say_so_too(void)
{
    static const struct {
        const char *law, *keys;
        double damping, linear, hertz, tangential, rolling, rolled, rate;
    } rows[] = {{"hooke", "restitution: 0.7", 0.0, 2.0 / 7.0, 0.0, 0.0, 0.0, 0.0, 0.0},
                {"hooke", "damping_ratio: 0.1, tangential_ratio: 0, rolling_damping: 0", 0.1, 0.0,
                 0.0, 0.0, 0.0, -1.0, 0.0},
                {"hertz_mindlin", "damping_ratio: 0, tangential_ratio: 0.8, tangential_damping: 0",
                 -1.0, 2.0 / 7.0, 0.8, -1.0, 0.0, 0.0, 0.0},
                {"hertz_mindlin", "tangential_ratio: 0, rolling_ratio: 0, tangential_damping: 2",
                 0.0, 2.0 / 7.0, -1.0, 2.0, -1.0, 0.0, 0.0},
                {"hooke", "damping_rate: 0", 0.0, 2.0 / 7.0, 0.0, 0.0, 0.0, 0.0, -1.0},
                {"hertz_mindlin", "damping_rate: 50, restitution: 0.9", 0.0, 2.0 / 7.0, 0.0, 0.0,
                 0.0, 0.0, 50.0}};
    for (size_t k = 0; k < 2 * sizeof rows / sizeof *rows; ++k) {
        char text[600], written[4000];
        size_t length;
        se3d_model_error error;
        snprintf(text, sizeof text,
                 "se3d: 1\ncontact: {law: %s}\nmaterials: [{name: m, density: 1, young: 1, "
                 "stiffness: 1, %s}]\nparticles: [{material: m, radius: 1, lower: [0, 0, 0], "
                 "upper: [9, 9, 9]}]\n",
                 rows[k / 2].law, rows[k / 2].keys);
        se3d_model *model = read_model(text, &error);
        CHECK(model != NULL);
        if (model && k % 2) { /* as it is written and read again */
            CHECK(se3d_model_write_text(model, NULL, written, sizeof written, &length, &error) ==
                  SE3D_OK);
            se3d_model_destroy(model);
            model = read_model(written, &error);
            CHECK(model != NULL);
        }
        if (model) {
            const se3d_material_def def = get_material(model);
            CHECK_NEAR(def.damping_ratio, rows[k / 2].damping, 0.0);
            CHECK_NEAR(def.tangential_ratio, rows[k / 2].linear, 0.0);
            CHECK_NEAR(def.tangential_ratio_hertz, rows[k / 2].hertz, 0.0);
            CHECK_NEAR(def.tangential_damping, rows[k / 2].tangential, 0.0);
            CHECK_NEAR(def.rolling_ratio, rows[k / 2].rolling, 0.0);
            CHECK_NEAR(def.rolling_damping, rows[k / 2].rolled, 0.0);
            CHECK_NEAR(def.damping_rate, rows[k / 2].rate, 0.0);
        }
        se3d_model_destroy(model);
    }
}

/* Of a material and of a pair; 0 is none. */
static void model_files_say_a_constant_stiffness(void)
{
    const char *const texts[4] = {
        "law: hertz_mindlin, pairs: [{material_1: m, material_2: m, tangential_stiffness: 0, "
        "rolling_stiffness: 3}]",
        "law: hooke, pairs: [{material_1: m, material_2: m, tangential_stiffness: 4, "
        "rolling_stiffness: 0}]",
        "law: hertz_mindlin", "law: hooke"};
    char text[600], written[4000];
    size_t length;
    se3d_model_error error;
    for (int k = 0; k < 8; ++k) {
        se3d_material_pair_def pair = se3d_material_pair_def_default();
        se3d_material material;
        snprintf(text, sizeof text,
                 "se3d: 1\ncontact: {%s}\nmaterials: [{name: m, density: 1, young: 1, stiffness: "
                 "1, tangential_stiffness: %d, rolling_stiffness: %d}]\nparticles: [{material: m, "
                 "radius: 1, lower: [0, 0, 0], upper: [9, 9, 9]}]\n",
                 texts[k / 2], k / 2 % 2 ? 7 : 0, k / 2 % 2 ? 0 : 6);
        se3d_model *model = read_model(k % 2 ? written : text, &error);
        CHECK(model != NULL);
        if (model) {
            se3d_system *system = se3d_model_get_system(model);
            CHECK_NEAR(get_material(model).tangential_stiffness, k / 2 % 2 ? 7.0 : -1.0, 0.0);
            CHECK(se3d_system_get_material(system, 0, &material) == SE3D_OK);
            CHECK(se3d_material_get_pair(system, material, material, &pair) == SE3D_OK);
            CHECK_NEAR(pair.tangential_stiffness, k / 2 == 0 ? 0.0 : k / 2 == 1 ? 4.0 : -1.0, 0.0);
            CHECK_NEAR(get_material(model).rolling_stiffness, k / 2 % 2 ? -1.0 : 6.0, 0.0);
            CHECK_NEAR(pair.rolling_stiffness, k / 2 == 0 ? 3.0 : k / 2 == 1 ? 0.0 : -1.0, 0.0);
            CHECK(se3d_model_write_text(model, NULL, written, sizeof written, &length, &error) ==
                  SE3D_OK);
        }
        se3d_model_destroy(model);
    }
    CHECK(!read_model("se3d: 1\nmaterials: [{name: m, density: 1, stiffness: 1, tangential_ratio: "
                      "0.5, tangential_stiffness: 1}]\nparticles: [{material: m, radius: 1, lower: "
                      "[0, 0, 0], upper: [9, 9, 9]}]\n",
                      &error));
    CHECK_CONTAINS(error.message, "tangential_stiffness: stands beside `tangential_ratio`");
    CHECK(!read_model("se3d: 1\nmaterials: [{name: m, density: 1, stiffness: 1, rolling_ratio: "
                      "0.5, rolling_stiffness: 1}]\nparticles: [{material: m, radius: 1, lower: "
                      "[0, 0, 0], upper: [9, 9, 9]}]\n",
                      &error));
    CHECK_CONTAINS(error.message, "rolling_stiffness: stands beside `rolling_ratio`");
}

static void model_files_say_one_damping(void)
{
    se3d_model_error error;
    CHECK(!read_model("se3d: 1\nmaterials: [{name: m, density: 1, stiffness: 1, restitution: 0.5, "
                      "damping_ratio: 0.1}]\nparticles: [{material: m, radius: 1, lower: [0, 0, "
                      "0], upper: [9, 9, 9]}]\n",
                      &error));
    CHECK_CONTAINS(error.message, "damping_ratio: stands beside `restitution`");
}

/* A ball that spins hits the plane; what both say, or the pair of them, or nobody. */
static void hit(int32_t law, const se3d_material_def *of, const se3d_material_pair_def *pair,
                double out[6])
{
    const double v[3] = {2e-4, 1e-4, -1e-3}, w[3] = {0.03, -0.02, 0.05};
    ball b = begin(PARTICLE, law, of, of, RADIUS + 1e-6, v, w);
    se3d_material plane;
    CHECK(se3d_system_get_material(b.s.system, 0, &plane) == SE3D_OK);
    CHECK(se3d_material_set_pair(b.s.system, plane, b.s.material, pair) == SE3D_OK);
    CHECK(se3d_particles_set_step(b.set, 2e-5) == SE3D_OK);
    run(&b, 0.05, out, out + 3);
    end(&b);
}

static double apart(const double a[6], const double b[6])
{
    double most = 0.0;
    for (int k = 0; k < 6; ++k) {
        most = fmax(most, fabs(a[k] - b[k]));
    }
    return most;
}

static void a_pair_may_say_what_both_could(void)
{
#define AT(of, in) offsetof(se3d_material_def, of), offsetof(se3d_material_pair_def, in)
    static const struct {
        size_t of, in;
        double hooke, hertz;
    } keys[] = {{AT(damping_ratio, damping_ratio), 0.1, 0.1},
                {AT(damping_rate, damping_rate), 300.0, 1e6},
                {AT(tangential_ratio, tangential_ratio), 0.5, 0.0},
                {AT(tangential_ratio_hertz, tangential_ratio), 0.0, 0.5},
                {AT(tangential_damping, tangential_damping), 0.3, 0.3},
                {AT(tangential_stiffness, tangential_stiffness), 30.0, 30.0},
                {AT(rolling_ratio, rolling_ratio), 0.2, 0.2},
                {AT(rolling_damping, rolling_damping), 0.1, 0.1},
                {AT(young, young), 0.0, 3e5},
                {AT(poisson, poisson), 0.0, 0.1}};
#undef AT
    for (size_t k = 0; k < 2 * sizeof keys / sizeof *keys; ++k) {
        const int32_t law = k % 2 ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE;
        const double value = k % 2 ? keys[k / 2].hertz : keys[k / 2].hooke;
        se3d_material_def one = stuff();
        se3d_material_pair_def none = se3d_material_pair_def_default(), pair = none;
        double nobody[6], both[6], of_pair[6];
        if (!(value > 0.0)) {
            continue;
        }
        one.rolling_friction = one.torsional_friction = 10.0;
        one.restitution = 0.8;
        one.young = 1e6;
        se3d_material_def other = one;
        memcpy((char *)&other + keys[k / 2].of, &value, sizeof value);
        memcpy((char *)&pair + keys[k / 2].in, &value, sizeof value);
        hit(law, &one, &none, nobody);
        hit(law, &other, &none, both);
        hit(law, &one, &pair, of_pair);
        CHECK_NEAR(apart(both, of_pair), 0.0, 1e-15);
        CHECK(apart(both, nobody) > 1e-6);
    }
}

/* Those of pairs are written and read again; 0 is none, and comes before what materials say. */
static void pairs_of_model_files_say_so_too(void)
{
    const char *const text =
        "se3d: 1\ncontact: {pairs: [{material_1: m, material_2: m, law: hertz_mindlin, "
        "damping_rate: 0, "
        "tangential_ratio: 0.3, tangential_damping: 0, rolling_ratio: 2, rolling_damping: 0.4, "
        "young: 7, poisson: 0.2}]}\nmaterials: [{name: m, density: 1, stiffness: 1, damping_rate: "
        "5}]\nparticles: [{material: m, radius: 1, lower: [0, 0, 0], upper: [9, 9, 9]}]\n";
    char written[4000];
    size_t length;
    se3d_model_error error;
    for (int again = 0; again < 2; ++again) {
        se3d_material material;
        se3d_material_pair_def pair = se3d_material_pair_def_default();
        se3d_model *model = read_model(again ? written : text, &error);
        CHECK(model != NULL);
        if (!model) {
            break;
        }
        se3d_system *system = se3d_model_get_system(model);
        CHECK(se3d_system_get_material(system, 0, &material) == SE3D_OK);
        CHECK(se3d_material_get_pair(system, material, material, &pair) == SE3D_OK);
        CHECK(pair.law == SE3D_CONTACT_LAW_HERTZ_MINDLIN);
        CHECK_NEAR(pair.damping_ratio, -1.0, 0.0);
        CHECK_NEAR(pair.damping_rate, 0.0, 0.0);
        CHECK_NEAR(pair.tangential_ratio, 0.3, 0.0);
        CHECK_NEAR(pair.tangential_damping, 0.0, 0.0);
        CHECK_NEAR(pair.rolling_ratio, 2.0, 0.0);
        CHECK_NEAR(pair.rolling_damping, 0.4, 0.0);
        CHECK_NEAR(pair.young, 7.0, 0.0);
        CHECK_NEAR(pair.poisson, 0.2, 0.0);
        CHECK(se3d_model_write_text(model, NULL, written, sizeof written, &length, &error) ==
              SE3D_OK);
        pair.tangential_stiffness = 9.0;
        CHECK(se3d_material_set_pair(system, material, material, &pair) ==
              SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(system), "tangential_stiffness = 9, in place of");
        pair.tangential_stiffness = -1.0;
        pair.damping_ratio = 0.1;
        pair.restitution = 0.5;
        CHECK(se3d_material_set_pair(system, material, material, &pair) ==
              SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(system), "damping_ratio = 0.1, in place of");
        pair.restitution = -1.0;
        pair.damping_ratio = 50.0;
        CHECK(se3d_material_set_pair(system, material, material, &pair) ==
              SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(system), "damping_ratio = 50, a restitution of ");
        se3d_model_destroy(model);
    }
}

/* A pair that is harder than its materials is followed in its own steps: nothing is lost or won. */
static void steps_follow_the_pair(void)
{
    const char *const text =
        "se3d: 1\ngravity: [0, 0, 0]\ncontact: {law: hertz_mindlin, pairs: [{material_1: a, "
        "material_2: b, young: 1.0e+12}]}\nmaterials: [{name: a, density: 2500, young: 1.0e+8, "
        "friction: 0, restitution: 1}, {name: b, density: 2500, young: 1.0e+8, friction: 0, "
        "restitution: 1}]\nparticles: [{material: a, radius: 0.01, position: [0, 0, 0], velocity: "
        "[9, 0, 0]}, {material: b, radius: 0.01, position: [0.0201, 0, 0]}]\nanalysis: {type: "
        "dynamics, duration: 1}\noutput: [{file: r.csv, channels: [particles.kinetic]}]\n";
    se3d_model_error error;
    se3d_model *model = read_model(text, &error);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    double before[4] = {0.0}, after[4] = {0.0};
    size_t width = 0;
    CHECK(model != NULL);
    if (model) {
        CHECK(se3d_model_get_solver(model, 0, &def) == SE3D_OK);
        CHECK(se3d_solver_create(se3d_model_get_system(model), &def, &solver) == SE3D_OK);
        CHECK(!SE3D_FAILED(se3d_solver_run(solver, 1e-6)));
        CHECK(!se3d_model_get_channel_value(model, 0, 0, NULL, before, &width));
        CHECK(!SE3D_FAILED(se3d_solver_run(solver, 1e-3)));
        CHECK(!se3d_model_get_channel_value(model, 0, 0, NULL, after, &width));
        CHECK(before[0] > 0.1);
        CHECK_NEAR(after[0], before[0], 1e-2 * before[0]);
        se3d_solver_destroy(solver);
        se3d_model_destroy(model);
    }
}

int main(void)
{
    RUN(steps_follow_the_pair);
    RUN(the_tangential_stiffness_of_hertz_is_that_given);
    RUN(a_tangential_stiffness_is_the_same_at_any_overlap);
    RUN(a_tangential_stiffness_of_hooke_stands_for_a_ratio);
    RUN(tangential_damping_is_that_given);
    RUN(a_damping_ratio_stands_for_a_restitution);
    RUN(a_damping_rate_holds_for_the_pair);
    RUN(steps_follow_a_damping_rate);
    RUN(torsion_swings_as_given);
    RUN(torsion_of_hertz_swings_at_any_overlap);
    RUN(model_files_say_so_too);
    RUN(model_files_say_a_constant_stiffness);
    RUN(model_files_say_one_damping);
    RUN(a_pair_may_say_what_both_could);
    RUN(pairs_of_model_files_say_so_too);
    RUN(what_no_contact_could_be_is_refused);
    return check_finish();
}
