/* SPDX-License-Identifier: BSD-3-Clause */
/* The single-particle tests of Chung and Ooi (Granular Matter 13, 2011, 643-656), with their
 * materials and speeds, against theory: by particles at their automatic step, and by bodies.
 *
 *     1, 2  two spheres, and one on a rigid plane, elastic        Hertz: force, overlap, duration
 *     3     restitutions on a plane                               the value given
 *     4     the same speed at all angles, on a plane              rigid bodies, where it slides
 *     5     the same speed into the plane, all speeds along it    rigid bodies, where it slides
 *     6-8   spins on a plane, of two spheres, of unequal ones     rigid bodies, where it slides
 *
 * An impact slides from beginning to end if its slip s > 7/2 mu (1 + e) vn; friction then takes mu
 * times the normal impulse (Maw, Barber, Fawcett 1976 have the same limit). At e = 1 and without
 * slip it is in closed form, too (docs/theory/contact-laws.md, "Impacts without slip"). */
#include "support/scene.h"

/* Who meets: particles, by lanes or portable, or bodies, by the method that they begin with. */
enum { PARTICLES = -2, PORTABLE = -1 };

static const int32_t everyone[] = {
    PARTICLES,         PORTABLE,           SE3D_METHOD_AUTO,   SE3D_METHOD_DOP853,
    SE3D_METHOD_RADAU, SE3D_METHOD_VERLET, SE3D_METHOD_CONVEX, SE3D_METHOD_GENERALIZED_ALPHA};
#define EVERYONE 8
#define SPRINGS  6 /* of them: those that follow the springs of contacts through an impact */

typedef struct stuff {
    double young, poisson, density;
} stuff;

static const stuff glass = {48e9, 0.20, 2800.0}, limestone = {20e9, 0.25, 2500.0};
static const stuff aluminium = {70e9, 0.30, 2699.0}, magnesium = {40e9, 0.35, 1800.0};
static const stuff oxide = {380e9, 0.23, 4000.0}, steel = {208e9, 0.30, 7850.0};
static const stuff alloy = {70e9, 0.33, 2700.0}, copper = {120e9, 0.35, 8900.0};

/* The first comes down on the other, or on a rigid plane (other = 0). */
typedef struct impact {
    stuff of;
    double radius, other, friction, restitution;
    double into, along, spin, spin_other; /* into: of the two together; along: of the first */
    int hooke, who;
} impact;

/* Of a moment, or of the end: velocity along x and z, spin about y of both. */
typedef struct motion {
    double x[2], z[2], spin[2];
    double longest, deepest, hardest; /* duration, overlap, force */
} motion;

typedef struct trial {
    scene s;
    se3d_particles *set;
    se3d_body body[2];
    double step, now, gap; /* step: between two looks; gap: before, < 0 while they touch */
    size_t count;
} trial;

static double mass_of(const impact *m, double radius)
{
    return m->of.density * 4.0 / 3.0 * PI * radius * radius * radius;
}

/* 1/m* of the two, and R*. */
static void reduce(const impact *m, double *mass, double *radius)
{
    *mass =
        1.0 / (1.0 / mass_of(m, m->radius) + (m->other > 0.0 ? 1.0 / mass_of(m, m->other) : 0.0));
    *radius = 1.0 / (1.0 / m->radius + (m->other > 0.0 ? 1.0 / m->other : 0.0));
}

/* The stiffness of hooke: as long as Hertz takes. */
static double stiffness_for(const impact *m, double duration)
{
    double mass, radius;
    reduce(m, &mass, &radius);
    return mass * pow(PI / duration, 2.0);
}

/* Hertz: overlap, force and duration of an elastic impact. */
static motion hertz(const impact *m)
{
    double mass, radius;
    const double shared = (m->other > 0.0 ? 2.0 : 1.0) * (1.0 - m->of.poisson * m->of.poisson);
    const double modulus = m->of.young / shared;
    reduce(m, &mass, &radius);
    motion out = {.deepest =
                      pow(15.0 * mass * m->into * m->into / (16.0 * sqrt(radius) * modulus), 0.4)};
    out.hardest = 4.0 / 3.0 * modulus * sqrt(radius) * pow(out.deepest, 1.5);
    out.longest = 0.8 * sqrt(PI) * tgamma(0.4) / tgamma(0.9) * out.deepest / m->into;
    return out;
}

static se3d_material material_of(const scene *s, const se3d_material_def *def)
{
    se3d_material material;
    CHECK(se3d_material_create(s->system, def, &material) == SE3D_OK);
    return material;
}

static void add_plane(scene *s, const se3d_material_def *soft_def)
{
    se3d_material_def rigid = *soft_def;
    const se3d_material soft = s->material;
    rigid.young = 1e12 * soft_def->young;
    rigid.stiffness = 1e12 * soft_def->stiffness;
    s->material = material_of(s, &rigid);
    scene_floor(s, 0.0);
    s->material = soft;
}

/* At height z, and so much above what it will meet. */
static void place(trial *t, const impact *m, double gap)
{
    const double top = m->other > 0.0 ? m->radius + m->other : m->radius;
    const double share = m->other > 0.0 ? 0.5 : 1.0; /* each of two goes half the way */
    const double time = gap / m->into;
    double r[6] = {-m->along * time, 0.0, top + share * gap, 0.0, 0.0, -(1.0 - share) * gap};
    double v[6] = {m->along, 0.0, -share * m->into, 0.0, 0.0, (1.0 - share) * m->into};
    double w[6] = {0.0, m->spin, 0.0, 0.0, m->spin_other, 0.0}, radius[2] = {m->radius, m->other};
    for (size_t k = 0; k < t->count && !t->set; ++k) {
        t->body[k] = scene_ball(&t->s, radius[k], mass_of(m, radius[k]), r + 3 * k, v + 3 * k);
        CHECK(se3d_body_set_angular_velocity(t->s.system, t->body[k], w + 3 * k) == SE3D_OK);
    }
    if (t->set) {
        CHECK(se3d_particles_add(t->set, t->s.material, t->count, r, radius, v, w, NULL) ==
              SE3D_OK);
    }
}

/* With nothing chosen that has a default but the law. */
static trial begin(const impact *m)
{
    const double duration = hertz(m).longest, gap = 0.8 * duration * m->into;
    trial t = {.step = duration / 400.0, .count = m->other > 0.0 ? 2 : 1, .gap = gap};
    se3d_material_def def = se3d_material_def_default();
    se3d_particles_def set = se3d_particles_def_default();
    def.density = m->of.density;
    def.young = m->of.young;
    def.poisson = m->of.poisson;
    def.friction = m->friction;
    def.restitution = m->restitution;
    def.stiffness = stiffness_for(m, duration) * (m->other > 0.0 ? 1.0 : 0.5); /* 2 k/(1 + 0) */
    t.s = scene_begin_with(NULL, m->hooke ? SE3D_CONTACT_LAW_HOOKE : SE3D_CONTACT_LAW_HERTZ_MINDLIN,
                           &def);
    CHECK(se3d_system_set_gravity(t.s.system, scene_zero) == SE3D_OK);
    if (!(m->other > 0.0)) {
        add_plane(&t.s, &def);
    }
    if (m->who <= PORTABLE) {
        set.portable = m->who == PORTABLE;
        CHECK(se3d_particles_create(t.s.system, &set, &t.set) == SE3D_OK);
    }
    place(&t, m, gap);
    if (t.set) {
        CHECK(se3d_particles_get_step(t.set, &t.step) == SE3D_OK);
    } else {
        scene_solve(&t.s, m->who, SE3D_FORMULATION_AUTO, 0.0, 0.0);
    }
    return t;
}

static void end(trial *t)
{
    se3d_particles_destroy(t->set);
    scene_end(&t->s);
}

/* So many looks further. */
static void advance(trial *t, size_t looks)
{
    t->now += (double)looks * t->step;
    if (t->set) {
        CHECK(se3d_particles_step(t->set, looks) == SE3D_OK);
    } else {
        (void)scene_run(&t->s, t->now);
    }
}

/* Velocities; returns the gap, writes the force on the first. */
static double look(const trial *t, const impact *m, motion *out, double *force)
{
    double r[6] = {0.0}, v[6] = {0.0}, w[6] = {0.0}, f[6] = {0.0}, torque[3];
    if (t->set) {
        CHECK(se3d_particles_get_all(t->set, t->count, r, v, w) == SE3D_OK);
        CHECK(se3d_particles_get_forces(t->set, t->count, f, NULL) == SE3D_OK);
    }
    for (size_t k = 0; k < t->count && !t->set; ++k) {
        CHECK(se3d_body_get_position(t->s.system, t->body[k], r + 3 * k) == SE3D_OK);
        CHECK(se3d_body_get_velocity(t->s.system, t->body[k], v + 3 * k) == SE3D_OK);
        CHECK(se3d_body_get_angular_velocity(t->s.system, t->body[k], w + 3 * k) == SE3D_OK);
        CHECK(se3d_body_get_contact_wrench(t->s.system, t->body[k], f + 3 * k, torque) == SE3D_OK);
    }
    for (size_t k = 0; k < 2; ++k) {
        out->x[k] = v[3 * k];
        out->z[k] = v[3 * k + 2];
        out->spin[k] = w[3 * k + 1];
    }
    *force = f[2];
    const double x = r[0] - r[3], z = r[2] - r[5];
    return m->other > 0.0 ? hypot(x, z) - m->radius - m->other : r[2] - m->radius;
}

/* Look by look until they have parted. */
static motion watch(const impact *m)
{
    motion out = {0};
    trial t = begin(m);
    double met = 0.0, parted = 0.0;
    for (int k = 0; k < 100000 && !(parted > 0.0); ++k) {
        double force, gap;
        advance(&t, 1);
        gap = look(&t, m, &out, &force);
        out.deepest = fmax(out.deepest, -gap);
        out.hardest = fmax(out.hardest, force);
        const double crossing = t.now - t.step * gap / (gap - t.gap);
        if (t.gap > 0.0 && gap <= 0.0) {
            met = crossing;
        } else if (t.gap <= 0.0 && gap > 0.0) {
            parted = crossing;
        }
        t.gap = gap;
    }
    out.longest = parted - met;
    end(&t);
    return out;
}

/* As it is when they have parted for long. */
static motion outcome(const impact *m)
{
    motion out = {0};
    trial t = begin(m);
    double force, gap = 0.0;
    const double span = 1.6 * hertz(m).longest; /* by then restitutions of 1 are through */
    advance(&t, (size_t)(span / t.step));
    for (int k = 0; k < 40 && !(gap > 0.0); ++k) {
        advance(&t, (size_t)(span / t.step));
        gap = look(&t, m, &out, &force);
    }
    CHECK(gap > 0.0);
    end(&t);
    return out;
}

/* Tests 1 and 2; the last three columns as published for the first three rows. */
static void elastic_impacts_last_and_press_as_hertz_says(void)
{
    static const double published[3][3] = {{274.113e-6, 10696.9, 40.339e-6},
                                           {368.304e-6, 7108.2, 54.201e-6},
                                           {49.717e-6, 11369.9, 731.66e-6}};
    for (int k = 0; k < 4 * SPRINGS; ++k) {
        const int row = k % 4;
        impact m = {.of = row == 0   ? glass
                          : row == 1 ? limestone
                          : row == 2 ? aluminium
                                     : magnesium,
                    .radius = row < 2 ? 0.01 : 0.1,
                    .other = row < 2 ? 0.01 : 0.0,
                    .into = row < 2 ? 20.0 : 0.2,
                    .friction = 0.35,
                    .restitution = 1.0,
                    .who = everyone[k / 4]};
        const motion expected = hertz(&m), out = watch(&m);
        if (row < 3) {
            CHECK_NEAR(expected.deepest / published[row][0], 1.0, 1e-4);
            CHECK_NEAR(expected.hardest / published[row][1], 1.0, 1e-4);
            CHECK_NEAR(expected.longest / published[row][2], 1.0, 1e-4);
        }
        CHECK_NEAR(out.deepest / expected.deepest, 1.0, 5e-4);
        CHECK_NEAR(out.hardest / expected.hardest, 1.0, 5e-4);
        CHECK_NEAR(out.longest / expected.longest, 1.0, 2e-3);
        CHECK_NEAR((out.z[0] - out.z[1]) / m.into, 1.0, 1e-4);
    }
}

/* Test 3. */
static void restitutions_on_a_rigid_plane_are_those_given(void)
{
    for (int k = 0; k < 2 * 10 * SPRINGS; ++k) {
        const impact m = {.of = oxide,
                          .radius = 0.0025,
                          .into = 3.9,
                          .friction = 0.092,
                          .restitution = 0.1 + 0.1 * (k / 2 % 10),
                          .hooke = k & 1,
                          .who = everyone[k / 20]};
        const motion out = outcome(&m);
        CHECK_NEAR(out.z[0] / m.into, m.restitution, 1e-3);
        CHECK_NEAR(out.x[0], 0.0, 1e-12);
    }
}

static double slip_of(const impact *m)
{
    return m->along - m->radius * m->spin - m->other * m->spin_other;
}

/* What rigid bodies that slide all the time do; if they do not, friction takes no more than
 * that. Returns whether it slides. */
static int check_slides(const impact *m)
{
    double mass, radius;
    const double slip = slip_of(m), change = (1.0 + m->restitution) * m->into;
    reduce(m, &mass, &radius);
    const motion out = outcome(m);
    const double press = mass * change, drag = copysign(m->friction * press, slip);
    const double m1 = mass_of(m, m->radius), taken = m1 * (m->along - out.x[0]) / drag;
    CHECK_NEAR((out.z[0] - out.z[1]) / (m->restitution * m->into), 1.0, 3e-3);
    /* the angular momentum about the point of contact; the arm is shorter by the overlap, which
     * convex knows at the ends of steps only */
    const double arm = m->who == SE3D_METHOD_CONVEX ? 2e-2 : 8e-3;
    CHECK_NEAR(0.4 * m1 * m->radius * (out.spin[0] - m->spin) / drag, taken, arm);
    if (m->other > 0.0) {
        const double m2 = mass_of(m, m->other);
        CHECK_NEAR(m2 * out.x[1] / drag, taken, 8e-3);
        CHECK_NEAR(0.4 * m2 * m->other * (out.spin[1] - m->spin_other) / drag, taken, arm);
    }
    const int slides = fabs(slip) > 3.5 * m->friction * change;
    if (slides) {
        CHECK_NEAR(taken, 1.0, 3e-3);
    } else {
        CHECK(taken > -1e-3 && taken < 1.0 + 1e-3);
    }
    return slides;
}

/* Test 4: 3.9 m/s at 2 to 88 degrees from the normal. */
static void one_speed_at_all_angles(void)
{
    int slides = 0, rows = 0;
    for (int k = 0; k < 12 * EVERYONE; ++k) {
        const double angle = (2.0 + 86.0 / 11.0 * (k % 12)) * PI / 180.0;
        const impact m = {.of = oxide,
                          .radius = 0.0025,
                          .into = 3.9 * cos(angle),
                          .along = 3.9 * sin(angle),
                          .friction = 0.092,
                          .restitution = 0.98,
                          .who = everyone[k / 12]};
        slides += check_slides(&m);
        ++rows;
    }
    CHECK(slides > rows / 3 && slides < rows);
}

/* Test 5: 5 m/s into the plane. */
static void one_speed_into_the_plane_and_all_along_it(void)
{
    static const double over[8] = {0.3, 1.0, 2.0, 4.0, 6.5, 7.5, 10.0, 20.0}; /* of mu vn */
    for (int k = 0; k < 8 * EVERYONE; ++k) {
        const impact m = {.of = steel,
                          .radius = 1e-5,
                          .into = 5.0,
                          .along = over[k % 8] * 0.3 * 5.0,
                          .friction = 0.3,
                          .restitution = 1.0,
                          .who = everyone[k / 8]};
        CHECK(check_slides(&m) == (k % 8 > 4));
    }
}

/* Tests 6 to 8: 0.2 m/s; equal spins of two spheres, against each other at the contact. */
static void spins_on_a_plane_and_of_two_spheres(void)
{
    static const double spins[8] = {0.4, 1.5, 4.0, 7.0, 12.0, 24.0, -6.0, -18.0};
    for (int k = 0; k < 3 * 2 * 8 * EVERYONE; ++k) {
        static const double others[3] = {0.0, 0.1, 0.5};
        const double spin = spins[k / 6 % 8];
        const impact m = {.of = k % 2 ? alloy : copper,
                          .radius = 0.1,
                          .other = others[k / 2 % 3],
                          .into = 0.2,
                          .spin = spin,
                          .spin_other = k / 2 % 3 ? spin : 0.0,
                          .friction = 0.4,
                          .restitution = 0.5,
                          .who = everyone[k / 48]};
        (void)check_slides(&m);
    }
}

/* Slow, so that the arm stays the radius and the normal does not turn. */
static impact gentle(int k, double poisson)
{
    static const double others[3] = {0.0, 0.02, 0.05};
    return (impact){.of = {70e9, poisson, 2700.0},
                    .radius = 0.02,
                    .other = others[k % 3],
                    .into = 1e-4,
                    .restitution = 1.0,
                    .who = everyone[k / 3 % SPRINGS]};
}

/* The slip afterwards over that before, of hertz_mindlin without slip. */
static void impacts_that_stick_are_in_closed_form(void)
{
    for (int k = 0; k < 4 * 3 * SPRINGS; ++k) {
        const double poisson = 0.15 * (k / (3 * SPRINGS)),
                     ratio = 3.0 * (1.0 - poisson) / (2.0 - poisson);
        impact m = gentle(k, poisson);
        const double slip = 0.2 * m.into;
        m.friction = 1e6;
        m.along = m.other > 0.0 ? 0.0 : 0.4 * slip;
        m.spin = (m.along - slip) / m.radius;
        const motion out = outcome(&m);
        const impact after = {.radius = m.radius,
                              .other = m.other,
                              .along = out.x[0] - out.x[1],
                              .spin = out.spin[0],
                              .spin_other = out.spin[1]};
        const double expected = cos(PI * sqrt(0.01 + 2.8 * ratio)) / cos(0.1 * PI);
        CHECK_NEAR(slip_of(&after) / slip, expected, 5e-3); /* the automatic step */
    }
}

/* Against the rings of Maw, Barber and Fawcett (tests/golden/impact_reference.py; nu = .3), from
 * where sliding ends only as the two part. Those before, see docs/theory/contact-laws.md. */
static void impacts_that_slide_almost_to_the_end_are_those_of_maw(void)
{
    static const double slips[3][2] = {{6.0, -0.994}, {7.0, -0.005}, {8.0, 0.994}}; /* /(mu vn) */
    for (int k = 0; k < 3 * 3 * SPRINGS; ++k) {
        const double *row = slips[k / (3 * SPRINGS)];
        impact m = gentle(k, 0.3);
        m.friction = 0.3;
        const double unit = m.friction * m.into;
        m.spin = -row[0] * unit / m.radius;
        const motion out = outcome(&m);
        const impact after = {.radius = m.radius,
                              .other = m.other,
                              .along = out.x[0] - out.x[1],
                              .spin = out.spin[0],
                              .spin_other = out.spin[1]};
        CHECK_NEAR(slip_of(&after) / unit, row[1], 0.02);
    }
}

/* Of hooke, whose tangential spring swings as fast as the normal one: who slips less than 7/2 mu vn
 * comes back with the opposite slip, who slips more slides to the end. */
static void linear_impacts_are_in_closed_form(void)
{
    for (int k = 0; k < 10 * 3 * SPRINGS; ++k) {
        impact m = gentle(k, 0.3);
        double mass, radius;
        m.hooke = 1;
        m.friction = 0.3;
        const double slip = (k / (3 * SPRINGS) - 4.7) * 1.3 * m.friction * m.into;
        m.spin_other = m.other > 0.0 ? -0.3 * slip / m.other : 0.0;
        m.spin = -(slip + m.other * m.spin_other) / m.radius;
        reduce(&m, &mass, &radius);
        const motion out = outcome(&m);
        const double most = 2.0 * m.friction * m.into, stuck = 4.0 / 7.0 * slip;
        const double change = fabs(stuck) < most ? stuck : copysign(most, slip);
        const double taken = -mass_of(&m, m.radius) / mass * out.x[0];
        CHECK_NEAR(taken / m.into, change / m.into, 1e-3);
    }
}

int main(void)
{
    RUN(elastic_impacts_last_and_press_as_hertz_says);
    RUN(restitutions_on_a_rigid_plane_are_those_given);
    RUN(one_speed_at_all_angles);
    RUN(one_speed_into_the_plane_and_all_along_it);
    RUN(spins_on_a_plane_and_of_two_spheres);
    RUN(impacts_that_stick_are_in_closed_form);
    RUN(impacts_that_slide_almost_to_the_end_are_those_of_maw);
    RUN(linear_impacts_are_in_closed_form);
    return check_finish();
}
