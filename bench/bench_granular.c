/* SPDX-License-Identifier: BSD-3-Clause */
/* The settled column: N^3 spheres in a box, particle-steps per CPU second, rebuilds included.
 *
 *     granular [EDGE] [hooke|hertz] [STEPS] [SETTLE] [THREADS] [FILE] [TILT]
 *
 * writes the settled state to FILE as a LAMMPS data file, so that others start from the same;
 * TILT in degrees turns gravity for the measured steps: an avalanche. See granular/README.md. */
#define _POSIX_C_SOURCE 200809L
#include "se3d/se3d.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define DIAMETER 0.01
#define SPACING  (1.1 * DIAMETER)

typedef struct bench {
    se3d_system *system;
    se3d_particles *particles;
    size_t edge, count;
    double *state; /* r, v, w [count * 3] each */
} bench;

static double clock_of(clockid_t id)
{
    struct timespec t;
    clock_gettime(id, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void must(const bench *b, se3d_status status)
{
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(b->system));
        exit(1);
    }
}

static void build(bench *b, int hertz, int32_t threads)
{
    static const double normals[5][3] = {
        {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, -1.0, 0.0}};
    double width = (double)b->edge * SPACING;
    must(b, se3d_system_create(NULL, &b->system));
    se3d_particles_def def = se3d_particles_def_default();
    def.threads = threads;
    def.step = 1e-5;
    se3d_contact_settings contact = se3d_contact_settings_default();
    contact.law = hertz ? SE3D_LAW_HERTZ_MINDLIN : SE3D_LAW_HOOKE;
    must(b, se3d_system_set_contact(b->system, &contact));
    must(b, se3d_particles_create(b->system, &def, &b->particles));
    se3d_material_def stuff = se3d_material_def_default();
    stuff.density = 2500.0;
    stuff.stiffness = 2.5e4;
    stuff.young = 1e8;
    stuff.restitution = 0.7;
    se3d_material material;
    must(b, se3d_material_create(b->system, &stuff, &material));
    for (int k = 0; k < 5; ++k) {
        se3d_shape_def wall = se3d_shape_def_default();
        se3d_shape handle;
        wall.material = material;
        memcpy(wall.normal, normals[k], sizeof wall.normal);
        wall.position[0] = k == 2 ? width : 0.0;
        wall.position[1] = k == 4 ? width : 0.0;
        must(b, se3d_shape_create_plane(b->system, &wall, &handle));
    }
    se3d_fill_def fill = se3d_fill_def_default();
    fill.material = material;
    fill.upper[0] = fill.upper[1] = fill.upper[2] = width;
    fill.radius_min = fill.radius_max = 0.5 * DIAMETER;
    fill.jitter = 0.045 * DIAMETER;
    fill.spacing = SPACING;
    fill.seed = 1;
    must(b, se3d_particles_fill_lattice(b->particles, &fill, &b->count));
    b->state = malloc(9 * b->count * sizeof *b->state);
}

/* Let it fall, with velocities that decay. */
static void settle(bench *b, size_t steps)
{
    for (size_t k = 0; k < steps; k += 50) {
        must(b, se3d_particles_step(b->particles, 50));
        must(b, se3d_particles_get_all(b->particles, b->count, NULL, b->state,
                                       b->state + 3 * b->count));
        for (size_t n = 0; n < 6 * b->count; ++n) {
            b->state[n] *= 0.995;
        }
        must(b, se3d_particles_set_all(b->particles, b->count, NULL, b->state,
                                       b->state + 3 * b->count));
    }
}

static void write_state(bench *b, const char *path)
{
    FILE *file = fopen(path, "w");
    double width = (double)b->edge * SPACING;
    if (!file) {
        return;
    }
    must(b, se3d_particles_get_all(b->particles, b->count, b->state, NULL, NULL));
    fprintf(file, "settled column\n\n%zu atoms\n1 atom types\n\n", b->count);
    fprintf(file, "0 %.17g xlo xhi\n0 %.17g ylo yhi\n", width, width);
    fprintf(file, "-0.01 %.17g zlo zhi\n\nAtoms # sphere\n\n", 1.5 * width);
    for (size_t k = 0; k < b->count; ++k) {
        fprintf(file, "%zu 1 %.17g 2500 %.17g %.17g %.17g\n", k + 1, DIAMETER, b->state[3 * k],
                b->state[3 * k + 1], b->state[3 * k + 2]);
    }
    fclose(file);
}

static void measure(bench *b, size_t steps, const char *law)
{
    se3d_particles_stats before, after;
    must(b, se3d_particles_step(b->particles, 200));
    must(b, se3d_particles_get_stats(b->particles, &before));
    double cpu = clock_of(CLOCK_PROCESS_CPUTIME_ID);
    double wall = clock_of(CLOCK_MONOTONIC);
    must(b, se3d_particles_step(b->particles, steps));
    cpu = clock_of(CLOCK_PROCESS_CPUTIME_ID) - cpu;
    wall = clock_of(CLOCK_MONOTONIC) - wall;
    must(b, se3d_particles_get_stats(b->particles, &after));
    double work = 1e-6 * (double)b->count * (double)steps;
    printf("%s %zu: %.1f M particle-steps per CPU second, %.1f per second; %.2f contacts and %.0f "
           "bytes per sphere, %llu rebuilds\n",
           law, b->count, work / cpu, work / wall, (double)after.contacts / (double)b->count,
           (double)after.bytes / (double)b->count,
           (unsigned long long)(after.rebuilds - before.rebuilds));
}

int main(int argc, char **argv)
{
    bench b = {.edge = argc > 1 ? (size_t)atoi(argv[1]) : 20};
    int hertz = argc > 2 && strcmp(argv[2], "hertz") == 0;
    size_t steps = argc > 3 ? (size_t)atol(argv[3]) : 2000;
    build(&b, hertz, argc > 5 ? atoi(argv[5]) : 1);
    settle(&b, argc > 4 ? (size_t)atol(argv[4]) : 60000);
    if (argc > 6 && argv[6][0]) {
        write_state(&b, argv[6]);
    }
    if (argc > 7) {
        double angle = atof(argv[7]) * 3.14159265358979 / 180.0;
        const double g[3] = {9.81 * sin(angle), 0.0, -9.81 * cos(angle)};
        must(&b, se3d_system_set_gravity(b.system, g));
        must(&b, se3d_particles_step(b.particles, 10000));
    }
    measure(&b, steps, hertz ? "hertz" : "hooke");
    free(b.state);
    se3d_particles_destroy(b.particles);
    se3d_system_destroy(b.system);
    return 0;
}
