/* SPDX-License-Identifier: BSD-3-Clause */
/* user-defined laws of contact: one that repeats hooke gives what hooke gives, for particles and
 * for bodies, in explicit and implicit methods; momentum is kept; failures name the two. */
#include "check.h"
#include "se3d/se3d.h"

#include <math.h>

typedef struct law {
    double k, kt, damping, drag, friction;
    double fail_beyond; /* an overlap [m]; 0: never */
    double twist;       /* moment along the normal, per overlap */
    size_t *calls;      /* counted if that is not NULL */
} law;

/* hooke as docs/theory/contact-laws.md has it. */
static se3d_status repeat_hooke(void *ctx, const se3d_contact_input *in, se3d_contact_output *out)
{
    const law *l = ctx;
    double root = sqrt(in->mass), size = 0.0;
    if (l->calls) {
        ++*l->calls;
    }
    double c = l->damping * root - 0.5 * in->lag * l->damping * l->damping;
    if (l->fail_beyond > 0.0 && in->overlap > l->fail_beyond) {
        return SE3D_ERR_CALLBACK;
    }
    out->force = fmax(0.0, l->k * in->overlap - in->onset * c * in->velocity);
    for (int a = 0; a < 3; ++a) {
        out->tangential[a] = -l->kt * in->spring[a] - l->drag * root * in->slip[a];
        out->moment[a] = l->twist * in->overlap * in->normal[a];
        size += out->tangential[a] * out->tangential[a];
    }
    size = sqrt(size);
    double cap = l->friction * out->force, stretch = 0.0;
    for (int a = 0; a < 3; ++a) {
        stretch += in->spring[a] * in->spring[a];
    }
    double held = fmin(l->kt * sqrt(stretch), size);
    for (int a = 0; a < 3 && size > cap; ++a) {
        out->tangential[a] *= cap / size;
        out->spring[a] = in->spring[a] * (held > cap ? cap / held : 1.0);
    }
    return SE3D_OK;
}

typedef struct world {
    se3d_system *system;
    se3d_material material;
    law law;
} world;

/* The law of a material with restitution .5, its own or the user's. */
static void open_world(world *w, int own, double gravity)
{
    se3d_system_def def = se3d_system_def_default();
    se3d_contact_settings contact = se3d_contact_settings_default();
    se3d_material_def stuff = se3d_material_def_default();
    const double k = 1e4;
    def.gravity[2] = -gravity;
    CHECK(se3d_system_create(&def, &w->system) == SE3D_OK);
    stuff.density = 2500.0;
    stuff.stiffness = k;
    stuff.friction = 0.3;
    CHECK(se3d_material_create(w->system, &stuff, &w->material) == SE3D_OK);
    /* zeta of e = .5 by bisection: e = exp(-(z/w)(pi - atan2(2 z w, w^2 - z^2))). */
    double low = 0.0, high = 1.0;
    const double pi = acos(-1.0);
    for (int n = 0; n < 60; ++n) {
        double z = 0.5 * (low + high), q = sqrt(1.0 - z * z);
        double e = exp(-(z / q) * (pi - atan2(2.0 * z * q, q * q - z * z)));
        low = e > 0.5 ? z : low;
        high = e > 0.5 ? high : z;
    }
    w->law =
        (law){k,   k * 2.0 / 7.0, 2.0 * low * sqrt(k), 2.0 * low * sqrt(k) * 2.0 / 7.0, 0.3, 0.0,
              0.0, NULL};
    contact.step = 1e-5;
    if (own) {
        contact.law = SE3D_CONTACT_LAW_CALLBACK;
        contact.callback = repeat_hooke;
        contact.ctx = &w->law;
    }
    CHECK(se3d_system_set_contact(w->system, &contact) == SE3D_OK);
}

static void add_shape(world *w, se3d_body body, int kind, double z)
{
    static const double v[12] = {-0.2, -0.2, 0.0, 0.2, -0.2, 0.0, 0.2, 0.2, 0.0, -0.2, 0.2, 0.0};
    static const uint32_t faces[6] = {0, 1, 2, 0, 2, 3};
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape shape;
    def.name = kind == 0 ? "floor" : kind == 1 ? "ball" : kind == 2 ? "mesh" : "brick";
    def.body = body;
    def.material = w->material;
    def.position[2] = z;
    def.radius = 0.02;
    def.size[0] = def.size[1] = 0.04;
    def.size[2] = 0.03;
    def.vertices = v;
    def.vertex_count = 4;
    def.triangles = faces;
    def.triangle_count = 2;
    CHECK(!(kind == 0   ? se3d_shape_create_plane
            : kind == 1 ? se3d_shape_create_sphere
            : kind == 2 ? se3d_shape_create_mesh
                        : se3d_shape_create_box)(w->system, &def, &shape));
}

/* Counting contacts and listing them ask the law once for each. */
static void check_lists(world *w, se3d_particles *set)
{
    static se3d_particles_contact list[1000];
    size_t calls = 0;
    w->law.calls = &calls;
    const size_t count = se3d_particles_count_contacts(set);
    const size_t once = calls;
    CHECK(count > 10 && count <= 1000);
    CHECK(se3d_particles_get_contacts(set, count, list) == SE3D_OK && calls == 2 * once);
    CHECK(se3d_particles_get_contacts(set, count - 1, list) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_contacts(set, count + 1, list) == SE3D_ERR_INVALID_ARGUMENT);
    w->law.calls = NULL;
}

/* Particles fall through each other onto a plane, a sphere and a mesh. */
static void run_particles(world *w, int threads, double *r, double *v, double *spin)
{
    se3d_particles *set;
    se3d_particles_def def = se3d_particles_def_default();
    se3d_fill_def fill = se3d_fill_def_default();
    const se3d_body ground = {0, 0};
    def.portable = 1;
    def.threads = threads;
    add_shape(w, ground, 0, 0.0);
    add_shape(w, ground, 1, 0.0);
    add_shape(w, ground, 2, 0.01);
    CHECK(se3d_particles_create(w->system, &def, &set) == SE3D_OK);
    fill.material = w->material;
    fill.radius_min = 0.004;
    fill.radius_max = 0.006;
    fill.jitter = 0.001;
    fill.lower[0] = fill.lower[1] = -0.03;
    fill.upper[0] = fill.upper[1] = 0.03;
    fill.lower[2] = 0.025;
    fill.upper[2] = 0.08;
    fill.count = 60;
    CHECK(se3d_particles_fill_lattice(set, &fill, NULL) == SE3D_OK);
    CHECK(se3d_particles_step(set, 12000) == SE3D_OK);
    check_lists(w, set);
    CHECK(se3d_particles_get_all(set, 60, r, v, spin) == SE3D_OK);
}

static void particles_with_a_copy_of_hooke_move_as_with_hooke(void)
{
    double r[2][180], v[2][180], spin[2][180];
    for (int own = 0; own < 2; ++own) {
        world w;
        open_world(&w, own, 9.81);
        run_particles(&w, 1, r[own], v[own], spin[own]);
        se3d_system_destroy(w.system);
    }
    for (int k = 0; k < 180; ++k) {
        CHECK_NEAR(r[1][k], r[0][k], 1e-8);
        CHECK_NEAR(v[1][k], v[0][k], 1e-5);
        CHECK_NEAR(spin[1][k], spin[0][k], 1e-2);
    }
}

static void threads_do_not_change_the_bits_of_a_law(void)
{
    double r[2][180], v[2][180], spin[2][180];
    for (int k = 0; k < 2; ++k) {
        world w;
        open_world(&w, 1, 9.81);
        w.law.twist = 1e-3;
        run_particles(&w, k == 0 ? 1 : 3, r[k], v[k], spin[k]);
        se3d_system_destroy(w.system);
    }
    CHECK(memcmp(r[0], r[1], sizeof r[0]) == 0 && memcmp(spin[0], spin[1], sizeof spin[0]) == 0);
}

static void momentum_is_kept_whatever_the_law(void)
{
    const double r[6] = {0.0, 0.0, 0.0, 0.0205, 0.003, 0.0}, radius[2] = {0.01, 0.012};
    const double v[6] = {0.5, 0.0, 0.1, -1.0, 0.0, 0.0}, spin[6] = {0.0, 3.0, 0.0, 1.0, 0.0, 9.0};
    double at[6], now[6], turn[6], p[2][6];
    world w;
    se3d_particles *set;
    open_world(&w, 1, 0.0);
    w.law.twist = 0.1;
    w.law.fail_beyond = 0.0;
    CHECK(se3d_particles_create(w.system, NULL, &set) == SE3D_OK);
    CHECK(!se3d_particles_add(set, w.material, 2, r, radius, v, spin, NULL));
    for (int k = 0; k < 2; ++k) {
        CHECK(se3d_particles_get_all(set, 2, at, now, turn) == SE3D_OK);
        for (int a = 0; a < 3; ++a) {
            int b = (a + 1) % 3, c = (a + 2) % 3;
            p[k][a] = p[k][3 + a] = 0.0;
            for (int i = 0; i < 2; ++i) {
                double m = pow(radius[i], 3.0);
                p[k][a] += m * now[3 * i + a];
                p[k][3 + a] +=
                    m * (at[3 * i + b] * now[3 * i + c] - at[3 * i + c] * now[3 * i + b]) +
                    0.4 * m * radius[i] * radius[i] * turn[3 * i + a];
            }
        }
        CHECK(se3d_particles_step(set, k == 0 ? 2000 : 1) == SE3D_OK);
    }
    CHECK(fabs(now[0] - v[0]) > 0.1 && fabs(turn[0]) > 1e-3);
    for (int a = 0; a < 6; ++a) {
        CHECK_NEAR(p[1][a], p[0][a], 1e-19);
    }
    se3d_system_destroy(w.system);
}

static void run_brick(world *w, int32_t method, double step, double r[3], double p[4])
{
    se3d_body_def def = se3d_body_def_default();
    se3d_body brick, ground = {0, 0};
    se3d_solver_def how = se3d_solver_def_default();
    se3d_solver *solver;
    def.mass = 0.1;
    def.inertia[0] = def.inertia[1] = def.inertia[2] = 2e-5;
    def.position[2] = 0.016;
    def.velocity[0] = 0.3;
    CHECK(se3d_body_create(w->system, &def, &brick) == SE3D_OK);
    add_shape(w, ground, 0, 0.0);
    add_shape(w, brick, 3, 0.0);
    how.analysis = SE3D_ANALYSIS_DYNAMICS;
    how.method = method;
    how.step = step;
    CHECK(!SE3D_FAILED(se3d_solver_create(w->system, &how, &solver)));
    se3d_status status = se3d_solver_run(solver, 0.15);
    if (SE3D_FAILED(status)) {
        fprintf(stderr, "%s\n", se3d_system_get_error(w->system));
    }
    CHECK(!SE3D_FAILED(status));
    CHECK(se3d_body_get_position(w->system, brick, r) == SE3D_OK);
    CHECK(se3d_body_get_orientation(w->system, brick, p) == SE3D_OK);
    se3d_solver_destroy(solver);
}

static void bodies_with_a_copy_of_hooke_move_as_with_hooke(void)
{
    static const struct {
        int32_t method;
        double step, tolerance;
    } ways[] = {{SE3D_METHOD_VERLET, 1e-5, 1e-9},
                {SE3D_METHOD_GENERALIZED_ALPHA, 1e-4, 1e-5},
                {SE3D_METHOD_HHT, 1e-4, 1e-5}};
    for (size_t k = 0; k < sizeof ways / sizeof *ways; ++k) {
        double r[2][3], p[2][4];
        for (int own = 0; own < 2; ++own) {
            world w;
            open_world(&w, own, 9.81);
            run_brick(&w, ways[k].method, ways[k].step, r[own], p[own]);
            se3d_system_destroy(w.system);
        }
        CHECK(r[0][0] > 0.005 && r[0][0] < 0.045);
        for (int a = 0; a < 4; ++a) {
            CHECK_NEAR(p[1][a], p[0][a], 10.0 * ways[k].tolerance);
            CHECK_NEAR(r[1][a % 3], r[0][a % 3], ways[k].tolerance);
        }
    }
}

static void failures_name_the_two(void)
{
    const double r[6] = {0.0, 0.0, 0.5, 0.0, 0.0, 0.521}, radius[2] = {0.01, 0.01};
    const double v[6] = {0.0, 0.0, 0.0, 0.0, 0.0, -1.0};
    world w;
    se3d_particles *set;
    double time;
    open_world(&w, 1, 0.0);
    w.law.fail_beyond = 1e-4;
    CHECK(se3d_particles_create(w.system, NULL, &set) == SE3D_OK);
    CHECK(!se3d_particles_add(set, w.material, 2, r, radius, v, NULL, NULL));
    CHECK(se3d_particles_step(set, 300) == SE3D_ERR_CALLBACK);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "particles");
    CHECK_CONTAINS(se3d_system_get_error(w.system), "0 and 1");
    CHECK(se3d_particles_get_time(set, &time) == SE3D_OK && time > 1e-3 && time < 2e-3);
    w.law.fail_beyond = 0.0;
    CHECK(se3d_particles_step(set, 300) == SE3D_OK);
    se3d_system_destroy(w.system);
    for (int bodies = 0; bodies < 2; ++bodies) {
        const double low[3] = {0.5, 0.0, 0.0105}, fall[3] = {0.0, 0.0, -1.0};
        open_world(&w, 1, 9.81);
        w.law.fail_beyond = 1e-4;
        if (bodies) {
            se3d_body_def def = se3d_body_def_default();
            se3d_body brick;
            se3d_solver_def how = se3d_solver_def_default();
            se3d_solver *solver;
            def.mass = 0.1;
            def.inertia[0] = def.inertia[1] = def.inertia[2] = 2e-5;
            def.position[2] = 0.016;
            def.velocity[2] = -1.0;
            CHECK(se3d_body_create(w.system, &def, &brick) == SE3D_OK);
            add_shape(&w, (se3d_body){0, 0}, 0, 0.0);
            add_shape(&w, brick, 3, 0.0);
            how.method = SE3D_METHOD_VERLET;
            how.step = 1e-5;
            CHECK(!SE3D_FAILED(se3d_solver_create(w.system, &how, &solver)));
            CHECK(se3d_solver_run(solver, 0.1) == SE3D_ERR_CALLBACK);
            CHECK_CONTAINS(se3d_system_get_error(w.system), "brick");
            se3d_solver_destroy(solver);
        } else {
            add_shape(&w, (se3d_body){0, 0}, 0, 0.0);
            CHECK(se3d_particles_create(w.system, NULL, &set) == SE3D_OK);
            CHECK(!se3d_particles_add(set, w.material, 1, low, radius, fall, NULL, NULL));
            CHECK(se3d_particles_step(set, 300) == SE3D_ERR_CALLBACK);
            CHECK_CONTAINS(se3d_system_get_error(w.system), "particle 0");
        }
        CHECK_CONTAINS(se3d_system_get_error(w.system), "floor");
        se3d_system_destroy(w.system);
    }
}

static void settings_of_a_law_are_checked(void)
{
    world w;
    se3d_contact_settings bad = se3d_contact_settings_default(), now = bad;
    open_world(&w, 1, 0.0);
    CHECK(se3d_system_get_contact(w.system, &now) == SE3D_OK);
    CHECK(now.law == SE3D_CONTACT_LAW_CALLBACK && now.callback == repeat_hooke &&
          now.ctx == &w.law);
    bad.law = SE3D_CONTACT_LAW_CALLBACK;
    bad.step = 1e-5;
    CHECK(se3d_system_set_contact(w.system, &bad) == SE3D_ERR_NULL);
    bad.callback = repeat_hooke;
    bad.step = 0.0;
    CHECK(se3d_system_set_contact(w.system, &bad) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "step = 0");
    se3d_system_destroy(w.system);
}

int main(void)
{
    RUN(particles_with_a_copy_of_hooke_move_as_with_hooke);
    RUN(threads_do_not_change_the_bits_of_a_law);
    RUN(momentum_is_kept_whatever_the_law);
    RUN(bodies_with_a_copy_of_hooke_move_as_with_hooke);
    RUN(failures_name_the_two);
    RUN(settings_of_a_law_are_checked);
    return check_finish();
}
