/* SPDX-License-Identifier: BSD-3-Clause */
/* Misuse of modes and particles: owners beside the system, with their own cases. */
#ifndef SE3D_TESTS_MISUSE_PARTICLES_H
#define SE3D_TESTS_MISUSE_PARTICLES_H

#include "misuse/misuse_world.h"
#include "model/shape.h"

/* `call` fails with `status`, and a message says so. */
#define REJECTED(call, status)                                                                     \
    do {                                                                                           \
        CHECK((call) == (status));                                                                 \
        CHECK(se3d_system_get_error_status(a->system) == (status));                                \
        CHECK(se3d_system_get_error(a->system)[0] != 0);                                           \
    } while (0)

static se3d_status coordinates_reject_misuse(arguments *a)
{
    se3d_coordinates *c = NULL;
    double q[64] = {0.0}, x[64] = {0.0};
    static double M[4096];
    size_t n = 0;
    const double nan = (double)NAN, wrench[6] = {0.0};
    CHECK(se3d_coordinates_create(NULL, &c) == SE3D_ERR_NULL && !c);
    REJECTED(se3d_coordinates_create(a->system, NULL), SE3D_ERR_NULL);
    CHECK(se3d_coordinates_count(NULL) == 0 && se3d_coordinates_count_positions(NULL) == 0 &&
          se3d_coordinates_count_loop_rows(NULL) == 0);
    CHECK(se3d_coordinates_get_entry(NULL, 0, NULL, NULL, NULL, NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_coordinates_get(NULL, q, x) == SE3D_ERR_NULL);
    CHECK(se3d_coordinates_set(NULL, q, x) == SE3D_ERR_NULL);
    CHECK(se3d_coordinates_move(NULL, q, x, q) == SE3D_ERR_NULL);
    CHECK(se3d_coordinates_compute_accelerations(NULL, x, x) == SE3D_ERR_NULL);
    CHECK(se3d_coordinates_compute_efforts(NULL, x, x) == SE3D_ERR_NULL);
    CHECK(se3d_coordinates_compute_gravity(NULL, x) == SE3D_ERR_NULL);
    CHECK(se3d_coordinates_compute_mass_matrix(NULL, M) == SE3D_ERR_NULL);
    CHECK(se3d_coordinates_multiply_mass(NULL, x, q) == SE3D_ERR_NULL);
    CHECK(se3d_coordinates_solve_mass(NULL, x, q) == SE3D_ERR_NULL);
    CHECK(se3d_coordinates_compute_jacobian(NULL, a->use.marker, M, M) == SE3D_ERR_NULL);
    CHECK(se3d_coordinates_compute_transposed(NULL, a->use.marker, wrench, x) == SE3D_ERR_NULL);
    CHECK(se3d_coordinates_compute_momentum(NULL, x, M) == SE3D_ERR_NULL);
    CHECK(se3d_coordinates_compute_loop_jacobian(NULL, M) == SE3D_ERR_NULL);
    CHECK(se3d_coordinates_compute_null_space(NULL, M, &n) == SE3D_ERR_NULL);
    se3d_coordinates_destroy(NULL);

    CHECK(!se3d_coordinates_create(a->system, &c));
    const size_t count = se3d_coordinates_count(c);
    CHECK(count > 0 && count <= 64 && se3d_coordinates_count_positions(c) <= 64);
    REJECTED(se3d_coordinates_get_entry(c, count, NULL, NULL, NULL, NULL, NULL),
             SE3D_ERR_INVALID_ARGUMENT);
    REJECTED(se3d_coordinates_move(c, NULL, x, q), SE3D_ERR_NULL);
    REJECTED(se3d_coordinates_compute_accelerations(c, NULL, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_coordinates_compute_efforts(c, NULL, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_coordinates_compute_gravity(c, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_coordinates_compute_mass_matrix(c, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_coordinates_multiply_mass(c, NULL, x), SE3D_ERR_NULL);
    REJECTED(se3d_coordinates_multiply_mass(c, x, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_coordinates_solve_mass(c, NULL, x), SE3D_ERR_NULL);
    REJECTED(se3d_coordinates_solve_mass(c, x, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_coordinates_compute_transposed(c, a->use.marker, NULL, x), SE3D_ERR_NULL);
    REJECTED(se3d_coordinates_compute_transposed(c, a->use.marker, wrench, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_coordinates_compute_loop_jacobian(c, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_coordinates_compute_null_space(c, NULL, &n), SE3D_ERR_NULL);
    REJECTED(se3d_coordinates_compute_null_space(c, M, NULL), SE3D_ERR_NULL);
    se3d_marker stale = a->use.marker;
    stale.generation ^= 1;
    REJECTED(se3d_coordinates_compute_jacobian(c, stale, M, NULL), SE3D_ERR_STALE_HANDLE);
    REJECTED(se3d_coordinates_compute_transposed(c, stale, wrench, x), SE3D_ERR_STALE_HANDLE);
    CHECK(!se3d_coordinates_compute_momentum(c, NULL, NULL));
    CHECK(!se3d_coordinates_get(c, q, x));
    const uint64_t before = se3d_system_hash(a->system);
    x[0] = nan;
    REJECTED(se3d_coordinates_set(c, NULL, x), SE3D_ERR_NOT_FINITE);
    REJECTED(se3d_coordinates_compute_accelerations(c, x, x + 1), SE3D_ERR_NOT_FINITE);
    REJECTED(se3d_coordinates_compute_efforts(c, x, x + 1), SE3D_ERR_NOT_FINITE);
    q[0] = nan;
    REJECTED(se3d_coordinates_set(c, q, NULL), SE3D_ERR_NOT_FINITE);
    CHECK(se3d_system_hash(a->system) == before);
    se3d_body_def body = body_def("another");
    se3d_body other;
    CHECK(!se3d_body_create(a->system, &body, &other));
    REJECTED(se3d_coordinates_get(c, q, x), SE3D_ERR_STATE);
    REJECTED(se3d_coordinates_compute_mass_matrix(c, M), SE3D_ERR_STATE);
    se3d_coordinates_destroy(c);

    /* A ball that is turned by nothing. */
    se3d_system *system = NULL;
    CHECK(!se3d_system_create(NULL, &system) && !se3d_body_create(system, &body, &other));
    CHECK(!se3d_coordinates_create(system, &c));
    memset(q, 0, sizeof q);
    CHECK(se3d_coordinates_set(c, q, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    se3d_coordinates_destroy(c);
    se3d_system_destroy(system);
    return SE3D_OK;
}

static se3d_status modes_reject_misuse(arguments *a)
{
    se3d_modes *modes = NULL;
    se3d_eigenvalue s;
    double x = 0.0, y = 0.0;
    size_t rows = 0, columns = 0;
    se3d_modes_def def = se3d_modes_def_default();
    se3d_modes_input input = {.body = a->use.body, .direction = {0.0, 0.0, (double)NAN}};
    CHECK(se3d_modes_create(NULL, NULL, &modes) == SE3D_ERR_NULL && !modes);
    REJECTED(se3d_modes_create(a->system, NULL, NULL), SE3D_ERR_NULL);
    def.input_count = 1;
    REJECTED(se3d_modes_create(a->system, &def, &modes), SE3D_ERR_NULL);
    def.inputs = &input;
    REJECTED(se3d_modes_create(a->system, &def, &modes), SE3D_ERR_INVALID_ARGUMENT);
    input.direction[2] = 1.0;
    input.body.generation ^= 1;
    REJECTED(se3d_modes_create(a->system, &def, &modes), SE3D_ERR_STALE_HANDLE);
    def.struct_size = 0;
    REJECTED(se3d_modes_create(a->system, &def, &modes), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!modes);
    CHECK(se3d_modes_count(NULL) == 0 && se3d_modes_count_freedoms(NULL) == 0);
    CHECK(se3d_modes_get_eigenvalue(NULL, 0, &s) == SE3D_ERR_NULL);
    CHECK(se3d_modes_follow(NULL, a->system, 1, &x, &y) == SE3D_ERR_NULL);
    CHECK(se3d_modes_get_shape(NULL, 0, 0, NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_modes_get_matrix(NULL, SE3D_MODES_A, &rows, &columns, NULL, 0) == SE3D_ERR_NULL);
    CHECK(se3d_modes_get_transfer(NULL, 0, 0, 1.0, &x, &y) == SE3D_ERR_NULL);
    se3d_modes_destroy(NULL);
    se3d_modes_def_init(NULL, sizeof def);

    /* A pendulum that hangs. */
    se3d_system *system = NULL;
    se3d_body_def body = body_def("bob");
    se3d_joint_def pin = se3d_joint_def_default();
    se3d_constraint joint;
    CHECK(!se3d_system_create(NULL, &system));
    CHECK(!se3d_system_get_ground(system, &pin.body_i));
    CHECK(!se3d_body_create(system, &body, &pin.body_j));
    pin.axis_i[0] = pin.axis_j[0] = pin.point_j[2] = pin.point_i[2] = 1.0;
    pin.axis_i[2] = pin.axis_j[2] = 0.0;
    CHECK(!se3d_joint_create_revolute(system, &pin, &joint));
    CHECK(!se3d_modes_create(system, NULL, &modes));
    CHECK(se3d_modes_count(modes) == 1 && se3d_modes_count_freedoms(modes) == 1);
    CHECK(!se3d_modes_get_eigenvalue(modes, 0, &s) && s.imaginary > 0.0);
    CHECK(se3d_modes_get_eigenvalue(modes, 0, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_modes_get_eigenvalue(modes, 1, &s) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_modes_follow(modes, NULL, 1, &x, &y) == SE3D_ERR_NULL);
    CHECK(se3d_modes_follow(modes, system, 1, NULL, &y) == SE3D_ERR_NULL);
    CHECK(se3d_modes_follow(modes, system, 1, &x, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_modes_follow(modes, system, 1, &x, &y) == SE3D_OK && y > 0.0);
    CHECK(se3d_modes_get_shape(modes, 1, 0, NULL, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_modes_get_shape(modes, 0, 9, NULL, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_modes_get_matrix(modes, 99, &rows, &columns, NULL, 0) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_modes_get_matrix(modes, SE3D_MODES_A, &rows, &columns, &x, 1) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_modes_get_transfer(modes, 0, 0, 1.0, &x, &y) == SE3D_ERR_INVALID_ARGUMENT);
    se3d_modes_destroy(modes);
    se3d_system_destroy(system);
    return SE3D_OK;
}

static se3d_particles *particles_open(arguments *a, se3d_material *material)
{
    se3d_particles *particles = NULL;
    se3d_material_def def = se3d_material_def_default();
    const double r[6] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0}, radius[2] = {0.1, 0.1};
    def.density = 1000.0;
    def.stiffness = 1e5;
    CHECK(!se3d_particles_create(a->system, NULL, &particles));
    CHECK(!se3d_material_create(a->system, &def, material));
    CHECK(!se3d_particles_add(particles, *material, 2, r, radius, NULL, NULL, NULL));
    return particles;
}

static se3d_status particles_reject_misuse(arguments *a)
{
    se3d_material material;
    const double nan = (double)NAN;
    double r[6] = {0.0, 2.0, 0.0, nan, 0.0, 0.0}, radius[2] = {0.1, -0.1};
    const uint32_t gone = 77;
    se3d_particles *p = particles_open(a, &material), *other = p;
    uint64_t hash = se3d_particles_hash(p);
    se3d_particles_def def = se3d_particles_def_default();
    CHECK(se3d_particles_create(NULL, NULL, &other) == SE3D_ERR_NULL && !other);
    REJECTED(se3d_particles_create(a->system, NULL, NULL), SE3D_ERR_NULL);
    def.step = nan;
    REJECTED(se3d_particles_create(a->system, &def, &other), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "nan");
    def = se3d_particles_def_default();
    def.name = "a.b";
    REJECTED(se3d_particles_create(a->system, &def, &other), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_clone(NULL, &other) == SE3D_ERR_NULL);
    CHECK(se3d_particles_clone(p, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_restore(NULL, p) == SE3D_ERR_NULL);
    CHECK(se3d_particles_restore(p, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_add(NULL, material, 1, r, radius, NULL, NULL, NULL) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_add(p, material, 1, NULL, radius, NULL, NULL, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_particles_add(p, material, 1, r, NULL, NULL, NULL, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_particles_add(p, material, 2, r, radius, NULL, NULL, NULL),
             SE3D_ERR_INVALID_ARGUMENT);
    REJECTED(se3d_particles_add(p, (se3d_material){0, 0}, 1, r, radius, NULL, NULL, NULL),
             SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_particles_remove(NULL, 1, &gone) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_remove(p, 1, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_particles_remove(p, 1, &gone), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_set_all(NULL, 2, r, NULL, NULL) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_set_all(p, 3, r, NULL, NULL), SE3D_ERR_INVALID_ARGUMENT);
    REJECTED(se3d_particles_set_all(p, 2, r, NULL, NULL), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_step(NULL, 1) == SE3D_ERR_NULL);
    CHECK(se3d_particles_run(NULL, 1.0) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_run(p, nan), SE3D_ERR_INVALID_ARGUMENT);
    REJECTED(se3d_particles_run(p, -1.0), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_set_step(NULL, 1e-3) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_set_step(p, nan), SE3D_ERR_INVALID_ARGUMENT);
    REJECTED(se3d_particles_set_step(p, -1.0), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_hash(p) == hash && se3d_particles_count(p) == 2);
    CHECK(se3d_particles_hash(NULL) == 0);
    se3d_particles_destroy(NULL);
    se3d_particles_destroy(p);
    return SE3D_OK;
}

static se3d_status particle_readers_reject_misuse(arguments *a)
{
    se3d_material material;
    double x[6];
    uint32_t ids[2];
    se3d_particles_contact contact;
    se3d_particles_energy energy;
    se3d_particles_stats stats;
    se3d_particles *p = particles_open(a, &material);
    se3d_particles *found = p;
    const char *name = NULL;
    CHECK(se3d_particles_find(NULL, "x", &found) == SE3D_ERR_NULL && !found);
    CHECK(se3d_particles_find(a->system, NULL, &found) == SE3D_ERR_NULL);
    CHECK(se3d_particles_find(a->system, "x", NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_find(a->system, "x", &found) == SE3D_ERR_INVALID_ARGUMENT && !found);
    CHECK(se3d_particles_get_name(NULL, &name) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_name(p, NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_particles_get_name(p, &name) && name[0] == '\0');
    CHECK(se3d_system_count_particles(NULL) == 0 && se3d_system_count_particles(a->system) == 1);
    CHECK(se3d_system_get_particles(NULL, 0, &found) == SE3D_ERR_NULL);
    CHECK(se3d_system_get_particles(a->system, 0, NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_system_get_particles(a->system, 0, &found) && found == p);
    CHECK(se3d_system_get_particles(a->system, 1, &found) == SE3D_ERR_INVALID_ARGUMENT && !found);
    CHECK(se3d_particles_count(NULL) == 0 && se3d_particles_count_contacts(NULL) == 0);
    CHECK(se3d_particles_get_ids(NULL, 2, ids) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_ids(p, 3, ids) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_particles_get_ids(p, 2, ids) && ids[1] == 1);
    CHECK(se3d_particles_get_radii(NULL, 2, x) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_radii(p, 1, x) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_all(NULL, 2, x, NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_all(p, 1, x, NULL, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_forces(NULL, 2, x, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_forces(p, 1, x, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_contacts(NULL, 1, &contact) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_contacts(p, 1, &contact) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_step(NULL, x) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_step(p, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_time(NULL, x) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_time(p, NULL) == SE3D_ERR_NULL);
    se3d_particles_dissipation lost;
    CHECK(se3d_particles_get_dissipation(NULL, &lost) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_dissipation(p, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_dissipation(p, &lost) == SE3D_ERR_STATE);
    CHECK(se3d_particles_get_energy(NULL, &energy) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_energy(p, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_stats(NULL, &stats) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_stats(p, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_wrench(NULL, a->use.body, x, x + 3) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_wrench(p, (se3d_body){0, 0}, x, x + 3) == SE3D_ERR_STALE_HANDLE);
    se3d_particles_destroy(p);
    return SE3D_OK;
}

static se3d_status materials_reject_misuse(arguments *a)
{
    se3d_material material, other, made = {7, 7};
    se3d_particles *p = particles_open(a, &material);
    se3d_system *copy = NULL;
    const char *name = NULL;
    se3d_material_def stuff = se3d_material_def_default();
    se3d_material_pair_def pair = se3d_material_pair_def_default();
    se3d_contact_settings contact = se3d_contact_settings_default();
    CHECK(se3d_material_create(NULL, &stuff, &made) == SE3D_ERR_NULL && made.index1 == 0);
    REJECTED(se3d_material_create(a->system, NULL, &made), SE3D_ERR_NULL);
    REJECTED(se3d_material_create(a->system, &stuff, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_material_create(a->system, &stuff, &made), SE3D_ERR_INVALID_ARGUMENT);
    stuff.density = (double)NAN;
    REJECTED(se3d_material_create(a->system, &stuff, &made), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "nan");
    stuff.density = 1.0; /* hooke needs a stiffness */
    REJECTED(se3d_material_create(a->system, &stuff, &made), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "stiffness");
    CHECK(se3d_material_set(NULL, material, &stuff) == SE3D_ERR_NULL);
    REJECTED(se3d_material_set(a->system, material, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_material_set(a->system, made, &stuff), SE3D_ERR_STALE_HANDLE);
    REJECTED(se3d_material_set(a->system, material, &stuff), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_material_get(NULL, material, &stuff) == SE3D_ERR_NULL);
    CHECK(se3d_material_get(a->system, material, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_material_get(a->system, made, &stuff) == SE3D_ERR_STALE_HANDLE);
    CHECK(!se3d_material_get(a->system, material, &stuff) && stuff.stiffness > 0.0);
    stuff.friction = 0.125;
    CHECK(!se3d_material_set(a->system, material, &stuff));
    stuff.friction = 0.0;
    CHECK(!se3d_material_get(a->system, material, &stuff) && stuff.friction > 0.1);
    stuff.name = "sand";
    CHECK(!se3d_material_create(a->system, &stuff, &made));
    REJECTED(se3d_material_create(a->system, &stuff, &other), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "is taken by another material");
    stuff.name = "gravel"; /* not looked at */
    CHECK(!se3d_material_set(a->system, made, &stuff));
    CHECK(!se3d_material_find(a->system, "sand", &other) && other.index1 == made.index1);
    CHECK(se3d_material_find(a->system, "gravel", &other) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(other.index1 == 0 && se3d_material_find(NULL, "sand", &other) == SE3D_ERR_NULL);
    CHECK(se3d_material_find(a->system, NULL, &other) == SE3D_ERR_NULL);
    CHECK(se3d_material_find(a->system, "sand", NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_material_get_name(a->system, made, &name) && strcmp(name, "sand") == 0);
    CHECK(!se3d_material_get(a->system, made, &stuff) && stuff.name == name);
    CHECK(!se3d_system_clone(a->system, &copy) && !se3d_material_find(copy, "sand", &other));
    se3d_system_destroy(copy);
    CHECK(!se3d_material_destroy(a->system, made));
    CHECK(se3d_material_get_name(a->system, made, &name) == SE3D_ERR_STALE_HANDLE && !name);
    CHECK(!se3d_material_get_name(a->system, material, &name) && name[0] == '\0');
    CHECK(se3d_material_get_name(a->system, material, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_material_get_name(NULL, material, &name) == SE3D_ERR_NULL);
    stuff.struct_size = 4096;
    CHECK(se3d_material_get(a->system, material, &stuff) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_material_set_pair(NULL, material, material, &pair) == SE3D_ERR_NULL);
    REJECTED(se3d_material_set_pair(a->system, material, material, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_material_set_pair(a->system, material, made, &pair), SE3D_ERR_STALE_HANDLE);
    pair.friction = (double)NAN;
    REJECTED(se3d_material_set_pair(a->system, material, material, &pair),
             SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_material_destroy(NULL, material) == SE3D_ERR_NULL);
    REJECTED(se3d_material_destroy(a->system, made), SE3D_ERR_STALE_HANDLE);
    REJECTED(se3d_material_destroy(a->system, material), SE3D_ERR_IN_USE);
    CHECK(se3d_system_set_contact(NULL, &contact) == SE3D_ERR_NULL);
    REJECTED(se3d_system_set_contact(a->system, NULL), SE3D_ERR_NULL);
    contact.law = 7;
    REJECTED(se3d_system_set_contact(a->system, &contact), SE3D_ERR_INVALID_ARGUMENT);
    contact.law = SE3D_CONTACT_LAW_HERTZ_MINDLIN; /* the material has no modulus */
    REJECTED(se3d_system_set_contact(a->system, &contact), SE3D_ERR_INVALID_ARGUMENT);
    contact.law = SE3D_CONTACT_LAW_HOOKE;
    contact.step = (double)NAN;
    REJECTED(se3d_system_set_contact(a->system, &contact), SE3D_ERR_INVALID_ARGUMENT);
    contact.step = 0.0;
    contact.overlap_limit = 0.0;
    REJECTED(se3d_system_set_contact(a->system, &contact), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_system_get_contact(NULL, &contact) == SE3D_ERR_NULL);
    CHECK(se3d_system_get_contact(a->system, NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_system_get_contact(a->system, &contact));
    CHECK(contact.law == SE3D_CONTACT_LAW_HOOKE && contact.overlap_limit > 0.0);
    contact.struct_size = 4096;
    CHECK(se3d_system_get_contact(a->system, &contact) == SE3D_ERR_INVALID_ARGUMENT);
    se3d_particles_destroy(p);
    CHECK(!se3d_material_destroy(a->system, material));
    return SE3D_OK;
}

static se3d_status contacts_reject_misuse(arguments *a)
{
    se3d_contact contact;
    double force = 1.0;
    CHECK(se3d_system_count_contacts(NULL) == 0 && se3d_system_count_contacts(a->system) == 0);
    se3d_shape i = {1, 1}, j = {1, 1};
    CHECK(se3d_system_count_passing_meshes(NULL, &i, &j) == 0 && i.index1 == 0 && j.index1 == 0);
    CHECK(se3d_system_count_passing_meshes(a->system, NULL, NULL) == 0);
    CHECK(se3d_system_get_contacts(NULL, 0, &contact) == SE3D_ERR_NULL);
    CHECK(se3d_system_get_contacts(a->system, 1, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_system_get_contacts(a->system, 1, &contact) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_system_get_contacts(a->system, 0, NULL));
    CHECK(se3d_system_get_contact_force_max(NULL, &force) == SE3D_ERR_NULL);
    CHECK(se3d_system_get_contact_force_max(a->system, NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_system_get_contact_force_max(a->system, &force) && !(force > 0.0));
    return SE3D_OK;
}

static se3d_status shapes_reject_misuse(arguments *a)
{
    se3d_status (*const create[])(se3d_system *, const se3d_shape_def *, se3d_shape *) = {
#define CREATE_SHAPE(KIND, name, traits) se3d_shape_create_##name,
        SE3DI_SHAPE_LIST(CREATE_SHAPE)
#undef CREATE_SHAPE
    };
    const double corners[12] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const double flat[12] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0};
    const uint32_t faces[6] = {0, 1, 2, 0, 1, 3}, beyond[6] = {0, 1, 2, 0, 1, 4};
    se3d_shape shape, other;
    se3d_body body;
    const char *name;
    double x[6], distance;
    for (size_t k = 0; k < sizeof create / sizeof *create; ++k) {
        se3d_shape_def def = se3d_shape_def_default();
        def.name = "pad";
        def.body = a->use.body;
        def.radius = def.length = def.size[0] = def.size[1] = def.size[2] = 1.0;
        def.top_radius = 1.0;
        def.vertices = corners;
        def.vertex_count = 4;
        def.triangles = faces;
        def.triangle_count = 2;
        def.heights = corners;
        def.row_count = def.column_count = 3;
        def.spacing[0] = def.spacing[1] = 0.5;
        def.semi_axes[0] = def.semi_axes[1] = def.semi_axes[2] = 0.1;
        CHECK(create[k](NULL, &def, &shape) == SE3D_ERR_NULL);
        REJECTED(create[k](a->system, NULL, &shape), SE3D_ERR_NULL);
        REJECTED(create[k](a->system, &def, NULL), SE3D_ERR_NULL);
        se3d_shape_def bad = def;
        bad.position[1] = (double)NAN;
        REJECTED(create[k](a->system, &bad, &shape), SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(a->system), "nan");
        bad = def;
        bad.body.generation ^= 1;
        REJECTED(create[k](a->system, &bad, &shape), SE3D_ERR_STALE_HANDLE);
        bad = def;
        bad.material.index1 = 77;
        REJECTED(create[k](a->system, &bad, &shape), SE3D_ERR_STALE_HANDLE);
        bad = def;
        bad.radius = bad.size[2] = bad.normal[0] = bad.top_radius = (double)INFINITY;
        bad.semi_axes[1] = (double)INFINITY;
        bad.vertices = flat;
        bad.triangles = beyond;
        bad.spacing[1] = (double)NAN;
        REJECTED(create[k](a->system, &bad, &shape), SE3D_ERR_INVALID_ARGUMENT);
        CHECK(shape.index1 == 0);
        CHECK(!create[k](a->system, &def, &shape));
        REJECTED(create[k](a->system, &def, &other), SE3D_ERR_INVALID_ARGUMENT); /* name */
        CHECK(!se3d_shape_get_nearest(a->system, shape, corners, x, x + 3, &distance));
        CHECK(se3d_shape_get_nearest(a->system, shape, NULL, x, x + 3, &distance) == SE3D_ERR_NULL);
        x[0] = (double)NAN;
        CHECK(se3d_shape_get_nearest(a->system, shape, x, x, x + 3, &distance) ==
              SE3D_ERR_INVALID_ARGUMENT);
        CHECK(!se3d_shape_find(a->system, "pad", &shape));
        CHECK(!se3d_shape_get_name(a->system, shape, &name) && strcmp(name, "pad") == 0);
        CHECK(!se3d_shape_get_body(a->system, shape, &body) && body.index1 == def.body.index1);
        CHECK(!se3d_shape_get_wrench(a->system, shape, x, x + 3) && !(fabs(x[0]) > 0.0));
        CHECK(!se3d_shape_set_surface_motion(a->system, shape, corners, corners + 3));
        CHECK(!se3d_shape_get_surface_motion(a->system, shape, x + 3, x) && x[0] > 0.5);
        CHECK(se3d_shape_get_surface_motion(a->system, shape, x, NULL) == SE3D_ERR_NULL);
        REJECTED(se3d_shape_set_surface_motion(a->system, shape, corners, NULL), SE3D_ERR_NULL);
        REJECTED(se3d_shape_set_surface_motion(a->system, shape, NULL, corners), SE3D_ERR_NULL);
        x[2] = (double)NAN;
        REJECTED(se3d_shape_set_surface_motion(a->system, shape, corners, x),
                 SE3D_ERR_INVALID_ARGUMENT);
        CHECK(!se3d_shape_destroy(a->system, shape));
        REJECTED(se3d_shape_set_surface_motion(a->system, shape, corners, corners),
                 SE3D_ERR_STALE_HANDLE);
        REJECTED(se3d_shape_destroy(a->system, shape), SE3D_ERR_STALE_HANDLE);
    }
    CHECK(se3d_shape_destroy(NULL, shape) == SE3D_ERR_NULL);
    CHECK(se3d_shape_set_surface_motion(NULL, shape, corners, corners) == SE3D_ERR_NULL);
    CHECK(se3d_shape_get_surface_motion(NULL, shape, x, x + 3) == SE3D_ERR_NULL);
    CHECK(se3d_shape_get_surface_motion(a->system, shape, x, x + 3) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_shape_find(NULL, "pad", &shape) == SE3D_ERR_NULL);
    CHECK(se3d_shape_find(a->system, "pad", &shape) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_shape_get_name(NULL, shape, &name) == SE3D_ERR_NULL);
    CHECK(se3d_shape_get_name(a->system, shape, &name) == SE3D_ERR_STALE_HANDLE && !name);
    CHECK(se3d_shape_get_body(NULL, shape, &body) == SE3D_ERR_NULL);
    CHECK(se3d_shape_get_body(a->system, shape, &body) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_shape_get_wrench(NULL, shape, x, x + 3) == SE3D_ERR_NULL);
    CHECK(se3d_shape_get_wrench(a->system, shape, x, x + 3) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_shape_get_nearest(a->system, shape, corners, x, x + 3, &distance) ==
          SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_body_get_contact_wrench(NULL, a->use.body, x, x + 3) == SE3D_ERR_NULL);
    CHECK(se3d_body_get_contact_wrench(a->system, (se3d_body){0, 0}, x, x + 3) ==
          SE3D_ERR_STALE_HANDLE);
    CHECK(!se3d_body_get_contact_wrench(a->system, a->use.body, x, x + 3));
    return SE3D_OK;
}

static se3d_status fills_reject_misuse(arguments *a)
{
    se3d_material material;
    size_t added = 0;
    se3d_particles *p = particles_open(a, &material);
    se3d_fill_def def = se3d_fill_def_default();
    uint64_t hash = se3d_particles_hash(p);
    CHECK(se3d_particles_fill_lattice(NULL, &def, &added) == SE3D_ERR_NULL);
    CHECK(se3d_particles_fill_random(NULL, &def) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_fill_lattice(p, NULL, &added), SE3D_ERR_NULL);
    REJECTED(se3d_particles_fill_random(p, NULL), SE3D_ERR_NULL);
    def.upper[0] = def.upper[1] = def.upper[2] = 1.0;
    def.count = 10;
    def.radius_min = def.radius_max = 0.1;
    REJECTED(se3d_particles_fill_lattice(p, &def, &added), SE3D_ERR_STALE_HANDLE);
    def.material = material;
    def.radius_max = (double)NAN;
    REJECTED(se3d_particles_fill_lattice(p, &def, &added), SE3D_ERR_INVALID_ARGUMENT);
    REJECTED(se3d_particles_fill_random(p, &def), SE3D_ERR_INVALID_ARGUMENT);
    def.radius_max = def.radius_min = 0.3; /* no room for ten */
    REJECTED(se3d_particles_fill_random(p, &def), SE3D_ERR_NO_CONVERGENCE);
    CHECK(se3d_particles_hash(p) == hash && se3d_particles_count(p) == 2);
    se3d_particles_destroy(p);
    return SE3D_OK;
}

static se3d_status averages_reject_misuse(arguments *a)
{
    const double low[3] = {0.0, 0.0, 0.0}, high[3] = {1.0, 1.0, 1.0};
    const double bad[3] = {1.0, (double)NAN, 1.0}, vast[3] = {1.0, 1e300, 1.0};
    se3d_average average;
    se3d_material material;
    se3d_particles *p = particles_open(a, &material);
    CHECK(se3d_particles_get_average(NULL, low, high, -1, &average) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_average(p, NULL, high, -1, &average) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_average(p, low, NULL, -1, &average) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_average(p, low, high, -1, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_average(p, high, low, -1, &average) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_average(p, low, low, -1, &average) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_average(p, low, bad, -1, &average) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_average(p, low, vast, -1, &average) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_average(p, low, high, -2, &average) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_average(p, low, high, 256, &average) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_particles_get_average(p, low, high, 0, &average) && average.count == 1);
    se3d_particles_destroy(p);
    return SE3D_OK;
}

static se3d_status wall_maps_reject_misuse(arguments *a)
{
    static const double corners[9] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0};
    static const uint32_t triangle[3] = {0, 1, 2};
    double values[SE3D_WALL_VALUES], places[SE3D_WALL_CORNERS];
    size_t count = 9;
    se3d_material material;
    se3d_particles *p = particles_open(a, &material);
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape mesh, plane;
    CHECK(!se3d_shape_create_plane(a->system, &def, &plane));
    def.vertices = corners;
    def.vertex_count = 3;
    def.triangles = triangle;
    def.triangle_count = 1;
    CHECK(!se3d_shape_create_mesh(a->system, &def, &mesh));
    CHECK(se3d_particles_get_wall_map(NULL, mesh, SE3D_WALL_VALUES, values, &count) ==
          SE3D_ERR_NULL);
    CHECK(se3d_particles_get_wall_map(p, mesh, 1, NULL, &count) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_wall_map(p, mesh, SE3D_WALL_VALUES, values, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_wall_map(p, plane, 1, values, &count) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_particles_get_wall_map(p, mesh, 0, NULL, &count) && count == SE3D_WALL_VALUES);
    CHECK(!se3d_particles_get_wall_map(p, mesh, SE3D_WALL_VALUES, values, &count) &&
          values[SE3D_WALL_AREA] == 0.5);
    CHECK(se3d_particles_get_wall_corners(NULL, mesh, SE3D_WALL_CORNERS, places, &count) ==
          SE3D_ERR_NULL);
    CHECK(se3d_particles_get_wall_corners(p, mesh, 1, NULL, &count) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_wall_corners(p, mesh, 1, places, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_wall_corners(p, plane, 1, places, &count) ==
          SE3D_ERR_INVALID_ARGUMENT);
    places[0] = 7.0;
    CHECK(!se3d_particles_get_wall_corners(p, mesh, SE3D_WALL_CORNERS - 1, places, &count) &&
          count == SE3D_WALL_CORNERS && places[0] == 7.0);
    CHECK(!se3d_particles_get_wall_corners(p, mesh, SE3D_WALL_CORNERS, places, &count) &&
          places[3] == 1.0 && places[7] == 1.0 && places[10] == 1.0);
    CHECK(!se3d_shape_destroy(a->system, mesh));
    CHECK(se3d_particles_get_wall_map(p, mesh, SE3D_WALL_VALUES, values, &count) ==
          SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_particles_get_wall_corners(p, mesh, SE3D_WALL_CORNERS, places, &count) ==
          SE3D_ERR_STALE_HANDLE);
    se3d_particles_destroy(p);
    return SE3D_OK;
}

static se3d_status fields_reject_misuse(arguments *a)
{
    enum { NUMBERS_OF = 8 * SE3D_FIELD_VALUES };
    double values[NUMBERS_OF];
    se3d_material material;
    se3d_particles *p = particles_open(a, &material);
    se3d_field_grid good = se3d_field_grid_default();
    for (int k = 0; k < 3; ++k) {
        good.upper[k] = 1.0;
        good.cells[k] = 2;
    }
    good.width = 0.3;
    se3d_field_grid bad[8] = {good, good, good, good, good, good, good, good};
    bad[0].width = 0.0;
    bad[1].width = (double)NAN;
    bad[2].cells[1] = 0;
    bad[3].cells[1] = -2;
    bad[4].upper[2] = 0.0;
    bad[5].lower[0] = (double)NAN;
    bad[6].tag = 256;
    bad[7].struct_size = 4 * sizeof good;
    CHECK(se3d_particles_get_fields(NULL, &good, NUMBERS_OF, values) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_fields(p, NULL, NUMBERS_OF, values) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_fields(p, &good, NUMBERS_OF, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_fields(p, &good, 8, values) == SE3D_ERR_INVALID_ARGUMENT);
    for (int k = 0; k < 8; ++k) {
        CHECK(se3d_particles_get_fields(p, &bad[k], NUMBERS_OF, values) ==
              SE3D_ERR_INVALID_ARGUMENT);
    }
    CHECK(!se3d_particles_get_fields(p, &good, NUMBERS_OF, values) && values[0] > 0.0);
    se3d_field_grid_init(NULL, sizeof good);
    se3d_particles_destroy(p);
    return SE3D_OK;
}

static se3d_status passages_reject_misuse(arguments *a)
{
    se3d_material material;
    se3d_flow_stats stats;
    uint32_t flow = 7;
    se3d_particles *p = particles_open(a, &material);
    se3d_flow_def def = se3d_flow_def_default();
    CHECK(se3d_particles_add_flow(NULL, &def, &flow) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_add_flow(p, NULL, &flow), SE3D_ERR_NULL);
    REJECTED(se3d_particles_add_flow(p, &def, &flow), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "normal = (0, 0, 0)");
    def.normal[2] = 1.0;
    def.size[0] = 1.0;
    REJECTED(se3d_particles_add_flow(p, &def, &flow), SE3D_ERR_INVALID_ARGUMENT);
    def.size[1] = 2.0;
    def.along[2] = -4.0;
    REJECTED(se3d_particles_add_flow(p, &def, &flow), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "along = (0, 0, -4)");
    def.along[1] = 1.0;
    def.radius = 0.5;
    REJECTED(se3d_particles_add_flow(p, &def, &flow), SE3D_ERR_INVALID_ARGUMENT);
    def.radius = 0.0;
    def.window = 0.0;
    REJECTED(se3d_particles_add_flow(p, &def, &flow), SE3D_ERR_INVALID_ARGUMENT);
    def.window = 0.1;
    def.tag = -2;
    REJECTED(se3d_particles_add_flow(p, &def, &flow), SE3D_ERR_INVALID_ARGUMENT);
    def.tag = 255;
    CHECK(flow == 7);
    for (uint32_t k = 0; k < SE3D_PARTICLES_FLOWS; ++k) {
        CHECK(!se3d_particles_add_flow(p, &def, &flow) && flow == k);
    }
    REJECTED(se3d_particles_add_flow(p, &def, &flow), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_flow(NULL, 0, &stats) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_flow(p, 0, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_flow(p, 32, &stats) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_particles_get_flow(p, 31, &stats) && stats.forward == 0);
    se3d_particles_destroy(p);
    return SE3D_OK;
}

static se3d_status servos_reject_misuse(arguments *a)
{
    se3d_material material;
    se3d_servo_state state;
    se3d_shape_def plane = se3d_shape_def_default();
    uint32_t servo = 7;
    se3d_particles *p = particles_open(a, &material);
    se3d_servo_def def = se3d_servo_def_default();
    CHECK(se3d_particles_add_servo(NULL, &def, &servo) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_add_servo(p, NULL, &servo), SE3D_ERR_NULL);
    REJECTED(se3d_particles_add_servo(p, &def, &servo), SE3D_ERR_STALE_HANDLE);
    plane.material = material;
    plane.mask = 0;
    CHECK(!se3d_shape_create_plane(a->system, &plane, &def.shape));
    REJECTED(se3d_particles_add_servo(p, &def, &servo), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "do not touch it");
    CHECK(!se3d_shape_destroy(a->system, def.shape));
    plane.mask = UINT32_MAX;
    CHECK(!se3d_shape_create_plane(a->system, &plane, &def.shape));
    REJECTED(se3d_particles_add_servo(p, &def, &servo), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "speed_max = 0");
    def.speed_max = 1.0;
    REJECTED(se3d_particles_add_servo(p, &def, &servo), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "axis = (0, 0, 0)");
    def.axis[1] = 3.0;
    def.gain = -1.0;
    REJECTED(se3d_particles_add_servo(p, &def, &servo), SE3D_ERR_INVALID_ARGUMENT);
    def.gain = 0.0;
    def.load = (double)NAN;
    REJECTED(se3d_particles_add_servo(p, &def, &servo), SE3D_ERR_INVALID_ARGUMENT);
    def.load = 1.0;
    CHECK(servo == 7);
    CHECK(!se3d_particles_add_servo(p, &def, &servo) && servo == 0);
    REJECTED(se3d_particles_add_servo(p, &def, &servo), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "already");
    for (uint32_t k = 1; k < SE3D_PARTICLES_SERVOS; ++k) {
        CHECK(!se3d_shape_create_plane(a->system, &plane, &def.shape));
        CHECK(!se3d_particles_add_servo(p, &def, &servo) && servo == k);
    }
    CHECK(!se3d_shape_create_plane(a->system, &plane, &def.shape));
    REJECTED(se3d_particles_add_servo(p, &def, &servo), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_servo(NULL, 0, &state) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_servo(p, 0, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_servo(p, 32, &state) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_particles_get_servo(p, 0, &state) && state.wanted == 1.0 && state.force == 0.0);
    se3d_particles_destroy(p);
    return SE3D_OK;
}

static se3d_status cells_reject_misuse(arguments *a)
{
    se3d_material material;
    se3d_cell_state state;
    uint32_t stage = 7;
    se3d_particles *open = particles_open(a, &material), *p = NULL;
    se3d_cell_def def = se3d_cell_def_default();
    se3d_particles_def box = se3d_particles_def_default();
    for (int k = 0; k < 3; ++k) {
        box.boundary[k] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
        box.upper[k] = 1.0;
    }
    CHECK(!se3d_particles_create(a->system, &box, &p));
    CHECK(se3d_particles_add_cell_stage(NULL, &def, &stage) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_add_cell_stage(p, NULL, &stage), SE3D_ERR_NULL);
    REJECTED(se3d_particles_add_cell_stage(open, &def, &stage), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "not periodic along x");
    def.gradient = 0;
    REJECTED(se3d_particles_add_cell_stage(p, &def, &stage), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "gradient = 0");
    def.gradient = 2;
    def.flow = -1;
    REJECTED(se3d_particles_add_cell_stage(p, &def, &stage), SE3D_ERR_INVALID_ARGUMENT);
    def.flow = 0;
    def.rate[1] = (double)NAN;
    REJECTED(se3d_particles_add_cell_stage(p, &def, &stage), SE3D_ERR_INVALID_ARGUMENT);
    def.rate[1] = 1.0;
    def.servo[1] = 1;
    REJECTED(se3d_particles_add_cell_stage(p, &def, &stage), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "rate[1] = 1 1/s");
    def.rate[1] = 0.0;
    REJECTED(se3d_particles_add_cell_stage(p, &def, &stage), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "gain[1] = 0");
    def.gain[1] = 1.0;
    def.rate_max[1] = 0.0;
    REJECTED(se3d_particles_add_cell_stage(p, &def, &stage), SE3D_ERR_INVALID_ARGUMENT);
    def.servo[1] = 0;
    def.shear_rate = 1.0;
    CHECK(stage == 7);
    for (uint32_t k = 0; k < SE3D_CELL_STAGES; ++k) {
        def.start = k;
        CHECK(!se3d_particles_add_cell_stage(p, &def, &stage) && stage == k);
        REJECTED(se3d_particles_add_cell_stage(p, &def, &stage), SE3D_ERR_INVALID_ARGUMENT);
        def.start = k + 0.5;
        def.flow = 1;
        REJECTED(se3d_particles_add_cell_stage(p, &def, &stage), SE3D_ERR_INVALID_ARGUMENT);
        def.flow = 0;
    }
    REJECTED(se3d_particles_add_cell_stage(p, &def, &stage), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_cell(NULL, &state) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_cell(p, NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_particles_get_cell(p, &state) && state.stage == SE3D_CELL_STAGES);
    CHECK(!se3d_particles_get_cell(open, &state) && state.volume == 0.0);
    se3d_particles_destroy(p);
    se3d_particles_destroy(open);
    return SE3D_OK;
}

/* Lists of ids that name no two bodies, and shapes that are not there. */
static void bonds_reject_ends(arguments *a, se3d_particles *p, const se3d_bond_def *def)
{
    const uint32_t one[2] = {0, 0}, two[2] = {1, 1}, far[1] = {9};
    const se3d_shape none = {0, 0};
    se3d_shape_def ball = se3d_shape_def_default();
    se3d_shape shape;
    uint32_t group = 7;
    size_t added = 7;
    CHECK(se3d_particles_bond(NULL, def, 1, one, two, &group) == SE3D_ERR_NULL);
    CHECK(se3d_particles_bond_near(NULL, def, -1, -1, &added, &group) == SE3D_ERR_NULL);
    CHECK(se3d_particles_bond_shape(NULL, def, none, -1, &added, &group) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_bond(p, NULL, 1, one, two, &group), SE3D_ERR_NULL);
    REJECTED(se3d_particles_bond(p, def, 1, NULL, two, &group), SE3D_ERR_NULL);
    REJECTED(se3d_particles_bond(p, def, 1, one, NULL, &group), SE3D_ERR_NULL);
    REJECTED(se3d_particles_bond(p, def, 1, one, far, &group), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "particles 0 and 9");
    REJECTED(se3d_particles_bond(p, def, 1, one, one, &group), SE3D_ERR_INVALID_ARGUMENT);
    REJECTED(se3d_particles_bond(p, def, 2, one, two, &group), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "bonded twice");
    REJECTED(se3d_particles_bond_near(p, NULL, -1, -1, &added, &group), SE3D_ERR_NULL);
    REJECTED(se3d_particles_bond_near(p, def, -2, -1, &added, &group), SE3D_ERR_INVALID_ARGUMENT);
    REJECTED(se3d_particles_bond_near(p, def, 0, 256, &added, &group), SE3D_ERR_INVALID_ARGUMENT);
    REJECTED(se3d_particles_bond_shape(p, def, none, -1, &added, &group), SE3D_ERR_STALE_HANDLE);
    ball.radius = 0.1;
    ball.group = 2;
    CHECK(!se3d_shape_create_sphere(a->system, &ball, &shape));
    REJECTED(se3d_particles_bond_shape(p, NULL, shape, -1, &added, &group), SE3D_ERR_NULL);
    REJECTED(se3d_particles_bond_shape(p, def, shape, 256, &added, &group),
             SE3D_ERR_INVALID_ARGUMENT);
    REJECTED(se3d_particles_bond_shape(p, def, shape, -1, &added, &group),
             SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "do not touch it");
    CHECK(!se3d_shape_destroy(a->system, shape));
    CHECK(group == 7 && added == 7);
}

static se3d_status bonds_reject_misuse(arguments *a)
{
    const uint32_t one[1] = {0}, two[1] = {1};
    se3d_material material;
    se3d_bond_stats stats;
    se3d_particles_bond_state state;
    uint32_t group = 7;
    se3d_particles *p = particles_open(a, &material);
    se3d_bond_def def = se3d_bond_def_default();
    REJECTED(se3d_particles_bond(p, &def, 1, one, two, &group), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "young = 0");
    def.young = 1e6;
    def.poisson = 0.6;
    REJECTED(se3d_particles_bond(p, &def, 1, one, two, &group), SE3D_ERR_INVALID_ARGUMENT);
    def.poisson = 0.3;
    def.ratio = 0.0;
    REJECTED(se3d_particles_bond(p, &def, 1, one, two, &group), SE3D_ERR_INVALID_ARGUMENT);
    def.ratio = 1.0;
    def.damping = 1.5;
    REJECTED(se3d_particles_bond(p, &def, 1, one, two, &group), SE3D_ERR_INVALID_ARGUMENT);
    def.damping = 0.0;
    def.law = 3;
    REJECTED(se3d_particles_bond(p, &def, 1, one, two, &group), SE3D_ERR_INVALID_ARGUMENT);
    def.law = SE3D_BOND_LAW_PARALLEL;
    def.normal_stiffness = 1e6;
    REJECTED(se3d_particles_bond(p, &def, 1, one, two, &group), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "shear_stiffness = 0");
    def.shear_stiffness = 1e6;
    bonds_reject_ends(a, p, &def);
    CHECK(se3d_particles_count_bonds(NULL) == 0 && se3d_particles_count_bonds(p) == 0);
    CHECK(se3d_particles_count_bond_groups(NULL) == 0 && se3d_particles_count_bond_groups(p) == 0);
    CHECK(!se3d_particles_bond(p, &def, 1, one, two, &group) && group == 0);
    REJECTED(se3d_particles_bond(p, &def, 1, two, one, &group), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_count_bonds(p) == 1 && se3d_particles_count_bond_groups(p) == 1);
    CHECK(se3d_particles_get_bond_stats(NULL, 0, &stats) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_bond_stats(p, 0, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_bond_stats(p, 1, &stats) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_bond_stats(p, -2, &stats) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_bonds(NULL, 1, &state) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_bonds(p, 1, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_bonds(p, 2, &state) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_particles_get_bonds(p, 1, &state) && state.i == 0 && state.j == 1);
    se3d_particles_destroy(p);
    return SE3D_OK;
}

static se3d_status clumps_reject_misuse(arguments *a)
{
    const double nan = (double)NAN, two[6] = {0.0, 0.0, 0.0, 0.1, 0.0, 0.0}, radii[2] = {0.1, 0.1};
    const double bad[2] = {0.1, -0.1}, e[4] = {2.0, 0.0, 0.0, 0.0}, vast[2] = {1e-29, 1e-29};
    se3d_material material;
    uint32_t index = 7, ids[4];
    size_t added;
    double x[12];
    se3d_particles *p = particles_open(a, &material);
    se3d_clump_def def = se3d_clump_def_default();
    se3d_clump_template_info info;
    se3d_fill_def fill = se3d_fill_def_default();
    CHECK(se3d_particles_add_clump_template(NULL, &def, &index) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_add_clump_template(p, NULL, &index), SE3D_ERR_NULL);
    REJECTED(se3d_particles_add_clump_template(p, &def, &index), SE3D_ERR_INVALID_ARGUMENT);
    def.count = 2;
    REJECTED(se3d_particles_add_clump_template(p, &def, &index), SE3D_ERR_NULL);
    def.r = two;
    REJECTED(se3d_particles_add_clump_template(p, &def, &index), SE3D_ERR_NULL);
    def.radius = bad;
    REJECTED(se3d_particles_add_clump_template(p, &def, &index), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "-0.1");
    def.radius = vast;
    REJECTED(se3d_particles_add_clump_template(p, &def, &index), SE3D_ERR_INVALID_ARGUMENT);
    def.radius = radii;
    def.r = (double[6]){nan, 0.0, 0.0, 0.0, 0.0, 0.0};
    REJECTED(se3d_particles_add_clump_template(p, &def, &index), SE3D_ERR_INVALID_ARGUMENT);
    def.r = two;
    def.mass = -1.0;
    REJECTED(se3d_particles_add_clump_template(p, &def, &index), SE3D_ERR_INVALID_ARGUMENT);
    def.mass = 1.0;
    REJECTED(se3d_particles_add_clump_template(p, &def, &index), SE3D_ERR_INVALID_ARGUMENT);
    def.inertia[0] = def.inertia[1] = 1.0; /* a rod without a moment about its axis */
    REJECTED(se3d_particles_add_clump_template(p, &def, &index), SE3D_ERR_INVALID_ARGUMENT);
    def.inertia[2] = 3.0;
    REJECTED(se3d_particles_add_clump_template(p, &def, &index), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "3");
    def.centre[1] = nan;
    REJECTED(se3d_particles_add_clump_template(p, &def, &index), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(index == 7);
    def = se3d_clump_def_default();
    def.count = 2;
    def.r = two;
    def.radius = radii;
    CHECK(se3d_particles_get_clump_template(p, 0, &info) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_particles_add_clump_template(p, &def, &index) && index == 0);
    CHECK(se3d_particles_get_clump_template(NULL, 0, &info) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_clump_template(p, 0, NULL) == SE3D_ERR_NULL);
    const uint64_t hash = se3d_particles_hash(p);
    CHECK(se3d_particles_add_clumps(NULL, 0, material, 1, two, NULL, NULL, NULL) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_add_clumps(p, 1, material, 1, two, NULL, NULL, NULL),
             SE3D_ERR_INVALID_ARGUMENT);
    REJECTED(se3d_particles_add_clumps(p, 0, (se3d_material){0, 0}, 1, two, NULL, NULL, NULL),
             SE3D_ERR_STALE_HANDLE);
    REJECTED(se3d_particles_add_clumps(p, 0, material, 1, NULL, NULL, NULL, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_particles_add_clumps(p, 0, material, 1, two, e, NULL, NULL),
             SE3D_ERR_INVALID_ARGUMENT);
    REJECTED(se3d_particles_add_clumps(p, 0, material, 1, two, NULL, NULL, &nan),
             SE3D_ERR_INVALID_ARGUMENT);
    fill.material = material;
    fill.upper[0] = fill.upper[1] = fill.upper[2] = 1.0;
    fill.clump = 2;
    REJECTED(se3d_particles_fill_lattice(p, &fill, &added), SE3D_ERR_INVALID_ARGUMENT);
    fill.clump = 1;
    fill.orientation[1] = nan;
    REJECTED(se3d_particles_fill_random(p, &fill), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_hash(p) == hash && se3d_particles_count(p) == 2);
    const double at[6] = {5.0, 0.0, 0.0, 6.0, 0.0, 0.0};
    CHECK(!se3d_particles_add_clumps(p, 0, material, 2, at, NULL, NULL, NULL));
    CHECK(se3d_particles_count(p) == 6 && se3d_particles_count_clumps(p) == 2);
    CHECK(se3d_particles_count_clumps(NULL) == 0);
    CHECK(se3d_particles_get_clump_ids(NULL, 2, ids, NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_clump_ids(p, 1, ids, NULL, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_clump_of(NULL, 6, ids) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_clump_of(p, 6, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_clump_of(p, 2, ids) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_clumps(NULL, 2, x, NULL, NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_clumps(p, 6, x, NULL, NULL, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_set_clumps(NULL, 2, x, NULL, NULL, NULL) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_set_clumps(p, 6, x, NULL, NULL, NULL), SE3D_ERR_INVALID_ARGUMENT);
    memcpy(x, at, sizeof at);
    x[3] = nan;
    REJECTED(se3d_particles_set_clumps(p, 2, x, NULL, NULL, NULL), SE3D_ERR_INVALID_ARGUMENT);
    REJECTED(se3d_particles_set_clumps(p, 2, NULL, x, NULL, NULL), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_clump_forces(NULL, 2, x, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_clump_forces(p, 6, x, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_particles_get_clump_forces(p, 2, x, x) && !(x[0] > 0.0 || x[0] < 0.0));
    se3d_particles_destroy(p);
    return SE3D_OK;
}

static se3d_status flows_reject_misuse(arguments *a)
{
    se3d_material material;
    uint32_t number = 7, ids[2] = {0, 1}, tags[2];
    uint64_t count;
    se3d_material made[2];
    se3d_particles_source_stats stats;
    se3d_particles_tally tally;
    se3d_particles *p = particles_open(a, &material);
    se3d_particles_source_def source = se3d_particles_source_def_default();
    se3d_particles_sink_def sink = se3d_particles_sink_def_default();
    se3d_fill_def fill = se3d_fill_def_default();
    CHECK(se3d_particles_add_source(NULL, &source, &number) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_add_source(p, NULL, &number), SE3D_ERR_NULL);
    REJECTED(se3d_particles_add_source(p, &source, &number), SE3D_ERR_NULL);
    source.fill = &fill;
    REJECTED(se3d_particles_add_source(p, &source, &number), SE3D_ERR_INVALID_ARGUMENT);
    fill.upper[0] = fill.upper[1] = fill.upper[2] = 1.0;
    fill.radius_min = fill.radius_max = 0.1;
    REJECTED(se3d_particles_add_source(p, &source, &number), SE3D_ERR_STALE_HANDLE);
    fill.material = material;
    fill.tag = SE3D_PARTICLES_TAGS;
    REJECTED(se3d_particles_add_source(p, &source, &number), SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "256");
    fill.tag = 0;
    source.rate = -1.0;
    REJECTED(se3d_particles_add_source(p, &source, &number), SE3D_ERR_INVALID_ARGUMENT);
    source.rate = 1.0;
    source.stop = (double)NAN;
    REJECTED(se3d_particles_add_source(p, &source, &number), SE3D_ERR_INVALID_ARGUMENT);
    source.stop = 0.0;
    source.function.index1 = 77;
    REJECTED(se3d_particles_add_source(p, &source, &number), SE3D_ERR_STALE_HANDLE);
    CHECK(number == 7);
    CHECK(se3d_particles_get_source_stats(NULL, 0, &stats) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_source_stats(p, 0, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_source_stats(p, 0, &stats) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_remove_source(NULL, 0) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_remove_source(p, 0), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_add_sink(NULL, &sink, &number) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_add_sink(p, NULL, &number), SE3D_ERR_NULL);
    sink.normal[0] = (double)NAN;
    REJECTED(se3d_particles_add_sink(p, &sink, &number), SE3D_ERR_INVALID_ARGUMENT);
    sink.normal[0] = 0.0;
    sink.lower[0] = 1.0;
    REJECTED(se3d_particles_add_sink(p, &sink, &number), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_sink_count(NULL, 0, &count) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_sink_count(p, 0, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_sink_count(p, 0, &count) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_remove_sink(NULL, 0) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_remove_sink(p, 0), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_set_tags(NULL, 2, ids, 1) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_set_tags(p, 2, NULL, 1), SE3D_ERR_NULL);
    REJECTED(se3d_particles_set_tags(p, 2, ids, 256), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_set_fixed(NULL, 2, ids, 1) == SE3D_ERR_NULL);
    REJECTED(se3d_particles_set_fixed(p, 2, NULL, 1), SE3D_ERR_NULL);
    ids[1] = 99;
    REJECTED(se3d_particles_set_tags(p, 2, ids, 1), SE3D_ERR_INVALID_ARGUMENT);
    REJECTED(se3d_particles_set_fixed(p, 2, ids, 1), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_tags(NULL, 2, tags) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_tags(p, 2, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_tags(p, 1, tags) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_particles_get_tags(p, 2, tags) && tags[0] == 0);
    CHECK(se3d_particles_get_materials(NULL, 2, made) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_materials(p, 2, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_materials(p, 3, made) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_particles_get_materials(p, 2, made) && made[1].index1 == material.index1);
    CHECK(se3d_particles_get_tally(NULL, 0, &tally) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_tally(p, 0, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_tally(p, 256, &tally) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_particles_get_tally(p, 0, &tally) && tally.count == 2);
    se3d_particles_destroy(p);
    return SE3D_OK;
}

#endif
