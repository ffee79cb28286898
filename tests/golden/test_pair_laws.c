/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs of materials with a law of their own: who meets by a law moves to the bit as in a system
 * where all do, in lanes with those of the other law beside it. */
#include "support/scene.h"

#include <math.h>
#include <string.h>

#define RADIUS 0.01
#define PLACES 26 /* more than three blocks of lanes, the laws in turn */
#define FAR    0.5

enum { HOOKE = SE3D_CONTACT_LAW_HOOKE, HERTZ = SE3D_CONTACT_LAW_HERTZ_MINDLIN };

/* What the kernels may have beside the law. */
typedef struct kind {
    int portable, threads, audit, rolls, sticks, rated, periodic;
} kind;

static const kind kinds[] = {{0, 1, 0, 0, 0, 0, 0}, {1, 1, 0, 0, 0, 0, 0}, {0, 3, 0, 0, 0, 0, 0},
                             {0, 1, 0, 0, 0, 0, 1}, {0, 2, 1, 1, 1, 0, 0}, {0, 1, 0, 1, 1, 0, 0},
                             {1, 1, 1, 1, 1, 1, 1}, {0, 1, 0, 0, 0, 1, 0}};
#define KINDS (sizeof kinds / sizeof *kinds)

static se3d_material_def stuff(const kind *k, int which)
{
    se3d_material_def def = scene_stuff(0.4, which ? 0.8 : 0.5, which ? 3e4 : 2e4);
    def.density = which ? 4000.0 : 2500.0;
    def.young = which ? 4e7 : 2e7;
    def.rolling_friction = k->rolls ? 0.1 : 0.0;
    def.torsional_friction = k->rolls ? 0.05 : 0.0;
    def.adhesion = k->sticks ? 0.1 : 0.0;
    def.cohesion = k->sticks ? 1e3 : 0.0;
    def.damping_rate = k->rated ? 200.0 : 0.0;
    return def;
}

typedef struct trial {
    scene s;
    se3d_material other;
    se3d_particles *set;
} trial;

static void set_law(const scene *s, se3d_material a, se3d_material b, int32_t law)
{
    se3d_material_pair_def pair = se3d_material_pair_def_default();
    se3d_material_def one = se3d_material_def_default();
    CHECK(!se3d_material_get(s->system, a, &one));
    pair.law = law;
    pair.damping_rate = one.damping_rate > 0.0 ? one.damping_rate : -1.0; /* as of both */
    CHECK(se3d_material_set_pair(s->system, a, b, &pair) == SE3D_OK);
}

/* 13 places where a ball of the one material falls on the floor, of the other one, 13 where two
 * meet in the air: of one material, or of two. */
static void put_particles(const trial *g)
{
    for (int k = 0; k < PLACES; ++k) {
        const double x = FAR * k, off = 1e-4 * k, z = k % 2 ? 0.2 : RADIUS + 1e-4;
        const double r[6] = {x, 0.0, z, x + 0.5 * RADIUS, off, z - 1.8 * RADIUS};
        const double v[6] = {0.2, -0.1, -1.0, 0.0, 0.0, 0.8}, w[6] = {5.0, 30.0, 9.0, 0.0};
        const double radii[2] = {RADIUS, k % 3 ? RADIUS : 0.9 * RADIUS};
        CHECK(!se3d_particles_add(g->set, g->s.material, 1, r, radii, v, w, NULL));
        if (k % 2) {
            CHECK(!se3d_particles_add(g->set, k % 4 == 1 ? g->s.material : g->other, 1, r + 3,
                                      radii + 1, v + 3, w + 3, NULL));
        }
    }
}

static trial begin(const kind *k, int32_t law)
{
    const se3d_material_def one = stuff(k, 0), two = stuff(k, 1);
    trial g = {.s = scene_begin_with(NULL, law, &one)};
    se3d_contact_settings contact = se3d_contact_settings_default();
    se3d_particles_def set = se3d_particles_def_default();
    const se3d_material first = g.s.material;
    contact.law = law;
    contact.step = 1e-5;
    CHECK(!se3d_system_set_contact(g.s.system, &contact));
    CHECK(!se3d_system_set_gravity(g.s.system, scene_zero));
    CHECK(!se3d_material_create(g.s.system, &two, &g.other));
    g.s.material = g.other;
    scene_floor(&g.s, 0.0);
    g.s.material = first;
    set.portable = k->portable;
    set.threads = k->threads;
    set.audit = k->audit;
    if (k->periodic) {
        set.boundary[1] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
        set.lower[0] = set.lower[1] = set.lower[2] = -1.0;
        set.upper[0] = set.upper[2] = 100.0;
        set.upper[1] = 1.0;
    }
    CHECK(!se3d_particles_create(g.s.system, &set, &g.set));
    put_particles(&g);
    return g;
}

static void end(trial *g)
{
    se3d_particles_destroy(g->set);
    scene_end(&g->s);
}

/* Positions, velocities and spins of a place. */
static void look(const trial *g, int place, double state[9])
{
    double r[120], v[120], w[120];
    const size_t count = se3d_particles_count(g->set);
    const int at = 3 * (place + place / 2); /* every other place has two */
    CHECK(count == 39 && se3d_particles_get_all(g->set, count, r, v, w) == SE3D_OK);
    memcpy(state, r + at, 3 * sizeof *r);
    memcpy(state + 3, v + at, 3 * sizeof *v);
    memcpy(state + 6, w + at, 3 * sizeof *w);
}

/* By which law the two of a place meet, if the pair of both materials has the second one. */
static int is_other(int place)
{
    return place % 4 != 1; /* the floor, and two of different materials */
}

static void particles_move_by_the_law_of_their_pair(void)
{
    for (size_t k = 0; k < 2 * KINDS; ++k) {
        const int32_t law = k & 1 ? HOOKE : HERTZ, other = k & 1 ? HERTZ : HOOKE;
        const kind *of = &kinds[k / 2];
        trial g[3] = {begin(of, law), begin(of, law), begin(of, other)};
        int differ = 0;
        set_law(&g[0].s, g[0].s.material, g[0].other, other);
        for (int part = 0; part < 6; ++part) {
            for (int n = 0; n < 3; ++n) {
                CHECK(se3d_particles_run(g[n].set, 4e-4) == SE3D_OK);
            }
            for (int place = 0; place < PLACES; ++place) {
                double a[9], b[9], c[9];
                look(&g[0], place, a);
                look(&g[is_other(place) ? 2 : 1], place, b);
                look(&g[is_other(place) ? 1 : 2], place, c);
                CHECK(memcmp(a, b, sizeof a) == 0);
                differ += memcmp(a, c, sizeof a) != 0;
            }
        }
        CHECK(differ > 3 * PLACES);
        for (int n = 0; n < 3; ++n) {
            end(&g[n]);
        }
    }
}

static void hold(const trial *g, se3d_material a, se3d_material b)
{
    se3d_material_pair_def pair = se3d_material_pair_def_default();
    pair.tangential_stiffness = 3e4;
    pair.rolling_stiffness = 2e4;
    CHECK(!se3d_material_set_pair(g->s.system, a, b, &pair));
}

/* The same of pairs of hertz_mindlin whose springs along the tangent and of rolling are given. */
static void a_constant_stiffness_is_that_of_the_pair(void)
{
    double last[2][PLACES][9];
    for (size_t k = 0; k < KINDS; ++k) {
        const kind *of = &kinds[k];
        trial g[3] = {begin(of, HERTZ), begin(of, HERTZ), begin(of, HERTZ)};
        int differ = 0;
        hold(&g[0], g[0].s.material, g[0].other);
        hold(&g[2], g[2].s.material, g[2].other);
        hold(&g[2], g[2].s.material, g[2].s.material);
        hold(&g[2], g[2].other, g[2].other);
        for (int part = 0; part < 6; ++part) {
            for (int n = 0; n < 3; ++n) {
                CHECK(se3d_particles_run(g[n].set, 4e-4) == SE3D_OK);
            }
            for (int place = 0; place < PLACES; ++place) {
                double a[9], b[9], c[9];
                look(&g[0], place, a);
                look(&g[is_other(place) ? 2 : 1], place, b);
                look(&g[is_other(place) ? 1 : 2], place, c);
                CHECK(memcmp(a, b, sizeof a) == 0);
                differ += memcmp(a, c, sizeof a) != 0;
                memcpy(last[k % 2][place], a, sizeof a);
            }
        }
        CHECK(differ > 3 * PLACES);
        CHECK(k != 1 || memcmp(last[0], last[1], sizeof last[0]) == 0); /* portable or not */
        for (int n = 0; n < 3; ++n) {
            end(&g[n]);
        }
    }
}

static void stick(const trial *g, se3d_material material)
{
    se3d_material_def def = se3d_material_def_default();
    CHECK(!se3d_material_get(g->s.system, material, &def));
    def.friction = def.rolling_friction = def.torsional_friction = 1e6;
    def.restitution = 1.0;
    def.rolling_damping = -1.0;
    CHECK(!se3d_material_set(g->s.system, material, &def));
}

/* What sticks and is not damped dissipates nothing: all of it is held or in motion, at any time. */
static void energy_of_constant_springs_is_held(void)
{
    const kind of = {0, 1, 1, 0, 0, 0, 0};
    trial g = begin(&of, HERTZ);
    double first = 0.0, held = 0.0;
    stick(&g, g.s.material);
    stick(&g, g.other);
    hold(&g, g.s.material, g.other);
    hold(&g, g.s.material, g.s.material);
    for (int part = 0; part < 20; ++part) {
        se3d_particles_dissipation d;
        se3d_particles_energy e;
        CHECK(!se3d_particles_run(g.set, 1e-4));
        CHECK(!se3d_particles_get_dissipation(g.set, &d));
        CHECK(!se3d_particles_get_energy(g.set, &e));
        const double all = e.translation + e.rotation + d.elastic - d.wall_work;
        first = part == 0 ? all : first;
        held = fmax(held, d.elastic / first);
        CHECK_NEAR(all / first, 1.0, 1e-3);
        CHECK_NEAR(d.tangential / first, 0.0, 1e-3);
        CHECK_NEAR(d.rolling / first, 0.0, 1e-3);
        CHECK_NEAR(d.torsion / first, 0.0, 1e-3);
    }
    CHECK(held > 0.1);
    end(&g);
}

/* What a contact tells of itself, and what all of them hold. */
static void energy_and_forces_are_those_of_the_law_of_the_pair(void)
{
    const kind of = {0, 1, 1, 1, 1, 0, 0};
    trial g[3] = {begin(&of, HERTZ), begin(&of, HERTZ), begin(&of, HOOKE)};
    double elastic[3], first = 0.0;
    set_law(&g[0].s, g[0].s.material, g[0].other, HOOKE);
    set_law(&g[0].s, g[0].s.material, g[0].s.material, HOOKE); /* now all meet by hooke */
    for (int part = 0; part < 30; ++part) {
        se3d_particles_dissipation d;
        se3d_particles_energy e;
        for (int n = 0; n < 3; ++n) {
            CHECK(!se3d_particles_run(g[n].set, 1e-4));
            CHECK(!se3d_particles_get_dissipation(g[n].set, &d));
            elastic[n] = d.elastic;
        }
        CHECK(elastic[0] >= elastic[2] && elastic[0] <= elastic[2]);
        CHECK(!(part == 4) || fabs(elastic[0] - elastic[1]) > 1e-3 * fabs(elastic[1]));
        if (part == 9) { /* the law changes while they touch: what is held afterwards counts */
            set_law(&g[0].s, g[0].s.material, g[0].other, -1);
            set_law(&g[2].s, g[2].s.material, g[2].other, HERTZ);
        }
        CHECK(!se3d_particles_get_dissipation(g[0].set, &d));
        CHECK(!se3d_particles_get_energy(g[0].set, &e));
        const double all = e.translation + e.rotation + d.elastic + d.normal + d.tangential +
                           d.rolling + d.torsion - d.wall_work;
        first = part == 0 || part == 10 ? all : first;
        CHECK_NEAR(all / first, 1.0, 5e-3);
    }
    for (int n = 0; n < 3; ++n) {
        end(&g[n]);
    }
}

static const int32_t methods[] = {SE3D_METHOD_AUTO,   SE3D_METHOD_DOP853,
                                  SE3D_METHOD_RADAU,  SE3D_METHOD_VERLET,
                                  SE3D_METHOD_CONVEX, SE3D_METHOD_GENERALIZED_ALPHA};

/* A ball of another material meets the floor and a second ball; the system's law, that of the
 * pairs. */
static void roll_on(int32_t method, int32_t law, int32_t of_pairs, double out[12])
{
    const kind of = {0, 0, 0, method != SE3D_METHOD_GENERALIZED_ALPHA, 1, 0, 0};
    const se3d_material_def one = stuff(&of, 0), two = stuff(&of, 1);
    scene s = scene_begin_with(NULL, law, &one);
    const double r[6] = {0.0, 0.0, RADIUS + 2e-5, 0.021, 0.0, RADIUS + 1e-5};
    const double v[6] = {0.5, 0.1, -0.3, 0.0, 0.0, 0.0};
    const double mass = one.density * 4.0 / 3.0 * PI * pow(RADIUS, 3.0);
    se3d_body body[2];
    const se3d_material floor = s.material;
    scene_floor(&s, 0.0);
    CHECK(!se3d_material_create(s.system, &two, &s.material));
    body[0] = scene_ball(&s, RADIUS, mass, r, v);
    body[1] = scene_ball(&s, RADIUS, mass, r + 3, v + 3);
    set_law(&s, floor, s.material, of_pairs);
    set_law(&s, s.material, s.material, of_pairs);
    scene_solve(&s, method, SE3D_FORMULATION_AUTO,
                method == SE3D_METHOD_GENERALIZED_ALPHA ? 2e-5 : 0.0, 0.0);
    (void)scene_run(&s, 0.01);
    for (int k = 0; k < 2; ++k) {
        CHECK(!se3d_body_get_position(s.system, body[k], out + 6 * k));
        CHECK(!se3d_body_get_velocity(s.system, body[k], out + 6 * k + 3));
    }
    scene_end(&s);
}

static void bodies_move_by_the_law_of_their_pair(void)
{
    for (size_t k = 0; k < 2 * sizeof methods / sizeof *methods; ++k) {
        const int32_t law = k & 1 ? HOOKE : HERTZ, other = k & 1 ? HERTZ : HOOKE;
        double a[12], b[12], c[12];
        roll_on(methods[k / 2], law, other, a);
        roll_on(methods[k / 2], other, -1, b);
        roll_on(methods[k / 2], law, -1, c);
        CHECK(memcmp(a, b, sizeof a) == 0);
        CHECK(memcmp(a, c, sizeof a) != 0);
    }
}

/* The automatic step, too: 1/50 of a contact's time, or 1/40 of Rayleigh's. */
static void the_step_is_that_of_the_law_of_the_pair(void)
{
    double steps[4];
    for (int k = 0; k < 4; ++k) {
        trial g = begin(&kinds[0], k & 1 ? HOOKE : HERTZ);
        const int32_t law = k < 2 ? -1 : k & 1 ? HERTZ : HOOKE;
        se3d_contact_settings contact = se3d_contact_settings_default();
        contact.law = k & 1 ? HOOKE : HERTZ;
        CHECK(!se3d_system_set_contact(g.s.system, &contact));
        set_law(&g.s, g.s.material, g.s.material, law);
        set_law(&g.s, g.other, g.s.material, law);
        set_law(&g.s, g.other, g.other, law);
        CHECK(!se3d_particles_get_step(g.set, &steps[k]));
        end(&g);
    }
    CHECK(steps[2] >= steps[1] && steps[2] <= steps[1]);
    CHECK(steps[3] >= steps[0] && steps[3] <= steps[0]);
    CHECK(fabs(steps[0] - steps[1]) > 0.1 * steps[0]);
}

#define REFUSED(call, what)                                                                        \
    do {                                                                                           \
        CHECK((call) == SE3D_ERR_INVALID_ARGUMENT);                                                \
        CHECK_CONTAINS(se3d_system_get_error(s.system), what);                                     \
    } while (0)

static void materials_must_have_what_the_law_of_a_pair_needs(void)
{
    se3d_material_def def = scene_stuff(0.4, 0.5, 1e4);
    se3d_material_pair_def pair = se3d_material_pair_def_default();
    se3d_material soft;
    scene s = scene_begin_with(NULL, HOOKE, &def);
    def.young = 0.0;
    CHECK(!se3d_material_create(s.system, &def, &soft));
    pair.law = HERTZ;
    REFUSED(se3d_material_set_pair(s.system, s.material, soft, &pair), "young");
    CHECK(!se3d_material_get_pair(s.system, s.material, soft, &pair) && pair.law < 0);
    pair.law = SE3D_CONTACT_LAW_CALLBACK;
    REFUSED(se3d_material_set_pair(s.system, s.material, s.material, &pair), "law = 2");
    pair.law = HERTZ;
    pair.young = 1e6; /* of the pair: neither needs it */
    CHECK(!se3d_material_set_pair(s.system, s.material, soft, &pair));
    pair.young = -1.0;
    CHECK(!se3d_material_set_pair(s.system, s.material, s.material, &pair));
    CHECK(!se3d_material_get_pair(s.system, s.material, s.material, &pair) && pair.law == HERTZ);
    REFUSED(se3d_material_set(s.system, s.material, &def), "young");
    pair.damping_ratio = 50.0; /* of hertz_mindlin no restitution is left */
    REFUSED(se3d_material_set_pair(s.system, s.material, s.material, &pair), "damping_ratio");
    scene_end(&s);
}

/* A rate is in 1/s with hooke, in 1/(m s) with hertz_mindlin. */
static void a_rate_of_damping_is_not_taken_by_another_law(void)
{
    se3d_material_def def = scene_stuff(0.4, 0.5, 1e4);
    se3d_material_pair_def pair = se3d_material_pair_def_default();
    se3d_contact_settings contact = se3d_contact_settings_default();
    se3d_material rated;
    scene s = scene_begin_with(NULL, HOOKE, &def);
    def.damping_rate = 100.0;
    CHECK(!se3d_material_create(s.system, &def, &rated));
    pair.law = HERTZ;
    REFUSED(se3d_material_set_pair(s.system, s.material, rated, &pair), "damping_rate");
    REFUSED(se3d_material_set_pair(s.system, rated, rated, &pair), "damping_rate");
    CHECK(!se3d_material_set_pair(s.system, s.material, s.material, &pair));
    REFUSED(se3d_material_set(s.system, s.material, &def), "damping_rate");
    pair.law = HOOKE;
    CHECK(!se3d_material_set_pair(s.system, s.material, rated, &pair));
    contact.law = HERTZ; /* which is another one then */
    REFUSED(se3d_system_set_contact(s.system, &contact), "damping_rate");
    pair.law = HERTZ;
    pair.restitution = 0.5;
    CHECK(!se3d_material_set_pair(s.system, s.material, rated, &pair));
    pair.restitution = -1.0;
    pair.damping_rate = 2e4;
    CHECK(!se3d_material_set_pair(s.system, s.material, rated, &pair));
    scene_end(&s);
}

/* hooke of a stiffness that only the pair has: nothing else is asked for it. */
static void a_pair_may_say_all_that_its_law_needs(void)
{
    se3d_material_def def = scene_stuff(0.4, 0.5, 0.0);
    se3d_material_pair_def pair = se3d_material_pair_def_default();
    scene s = scene_begin_with(NULL, HERTZ, &def);
    pair.law = HOOKE;
    pair.stiffness = 1e4;
    CHECK(!se3d_material_set_pair(s.system, s.material, s.material, &pair));
    const double r[3] = {0.0, 0.0, RADIUS}, v[3] = {0.0, 0.0, -0.1};
    double out[3];
    scene_floor(&s, 0.0);
    CHECK(!se3d_system_set_gravity(s.system, scene_zero));
    const se3d_body ball = scene_ball(&s, RADIUS, 0.01, r, v);
    scene_solve(&s, SE3D_METHOD_DOP853, SE3D_FORMULATION_AUTO, 0.0, 1e-9);
    (void)scene_run(&s, 0.02);
    CHECK(!se3d_body_get_velocity(s.system, ball, out));
    CHECK_NEAR(out[2], 0.05, 1e-5);
    scene_end(&s);
}

int main(void)
{
    RUN(particles_move_by_the_law_of_their_pair);
    RUN(a_constant_stiffness_is_that_of_the_pair);
    RUN(energy_of_constant_springs_is_held);
    RUN(energy_and_forces_are_those_of_the_law_of_the_pair);
    RUN(bodies_move_by_the_law_of_their_pair);
    RUN(the_step_is_that_of_the_law_of_the_pair);
    RUN(materials_must_have_what_the_law_of_a_pair_needs);
    RUN(a_rate_of_damping_is_not_taken_by_another_law);
    RUN(a_pair_may_say_all_that_its_law_needs);
    return check_finish();
}
