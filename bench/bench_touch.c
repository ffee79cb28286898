/* SPDX-License-Identifier: BSD-3-Clause */
/* Boxes that touch (bench/touch.h) by the method convex, through the public interface:
 *
 *     bench_touch SCENE N STEP DURATION STIFFNESS [REPEATS [HOLD [METHOD]]]
 *
 * CPU time of the stepping, contacts and overlaps at the end. peers/mujoco_touch.c does the same.
 * With HOLD [s] it is run once more, HOLD longer: how far anything moves in that time, how much
 * energy grows in any step, and whether the floor carries the weight at its end. METHOD: convex, or
 * auto, which is given no step; STEP is then how often energy is looked at. */
#define _POSIX_C_SOURCE 200809L
#include "touch.h"

#include "se3d/se3d.h"

#include <stdio.h>
#include <stdlib.h>

static void need(se3d_status status, const se3d_system *system)
{
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(system));
        exit(1);
    }
}

static void add_shape(se3d_system *system, const bench_box *box, se3d_shape_def *shape)
{
    se3d_shape made;
    if (box->ball > 0.0) {
        shape->radius = box->ball;
        need(se3d_shape_create_sphere(system, shape, &made), system);
    } else {
        memcpy(shape->size, box->size, sizeof shape->size);
        need(se3d_shape_create_box(system, shape, &made), system);
    }
}

static void add_body(se3d_system *system, se3d_material material, const bench_box *box)
{
    se3d_body_def body = se3d_body_def_default();
    se3d_shape_def shape = se3d_shape_def_default();
    const double *s = box->size, r = box->ball;
    body.mass = bench_touch_mass(box);
    for (int c = 0; c < 3; ++c) {
        const double a = s[(c + 1) % 3], b = s[(c + 2) % 3];
        body.inertia[c] = body.mass * (r > 0.0 ? 0.4 * r * r : (a * a + b * b) / 12.0);
    }
    memcpy(body.position, box->at, sizeof body.position);
    memcpy(body.orientation, box->turn, sizeof body.orientation);
    body.velocity[0] = box->speed;
    need(se3d_body_create(system, &body, &shape.body), system);
    shape.material = material;
    add_shape(system, box, &shape);
}

static se3d_system *build(const bench_box *boxes, int n, double stiffness)
{
    const double gravity[3] = {0.0, 0.0, -BENCH_TOUCH_GRAVITY};
    se3d_system *system = NULL;
    se3d_material_def def = se3d_material_def_default();
    se3d_contact_settings contact = se3d_contact_settings_default();
    se3d_shape_def shape = se3d_shape_def_default();
    se3d_shape floor;
    need(se3d_system_create(NULL, &system), system);
    need(se3d_system_set_gravity(system, gravity), system);
    def.density = BENCH_TOUCH_DENSITY;
    def.friction = BENCH_TOUCH_FRICTION;
    def.restitution = 0.1;
    def.stiffness = stiffness;
    need(se3d_material_create(system, &def, &shape.material), system);
    contact.overlap_limit = 1.0;
    need(se3d_system_set_contact(system, &contact), system);
    need(se3d_shape_create_plane(system, &shape, &floor), system);
    for (int k = 0; k < n; ++k) {
        add_body(system, shape.material, &boxes[k]);
    }
    return system;
}

static void show(const se3d_system *system, se3d_solver *solver, double seconds)
{
    const size_t count = se3d_system_count_contacts(system);
    se3d_contact *contacts = calloc(count + 1, sizeof *contacts);
    se3d_solver_stats stats;
    double deepest = 0.0, mean = 0.0;
    if (!contacts) {
        exit(1);
    }
    need(se3d_system_get_contacts(system, count, contacts), system);
    need(se3d_solver_get_stats(solver, &stats), system);
    for (size_t k = 0; k < count; ++k) {
        deepest = fmax(deepest, contacts[k].overlap);
        mean += contacts[k].overlap / (double)count;
    }
    printf("CPU %8.4g s, %5zu contacts, overlap %.3g mm (deepest %.3g); %.3g iterations a "
           "step\n",
           seconds, count, 1e3 * mean, 1e3 * deepest,
           (double)stats.iterations / (double)stats.steps);
    free(contacts);
}

static se3d_solver *solve(se3d_system *system, const char *method, double step)
{
    const int is_auto = strcmp(method, "auto") == 0;
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver;
    def.method = is_auto ? SE3D_METHOD_AUTO : SE3D_METHOD_CONVEX;
    def.step = is_auto ? 0.0 : step;
    need(se3d_solver_create(system, &def, &solver), system);
    return solver;
}

/* What the floor carries, over the weight. */
static double carried(const se3d_system *system, const bench_box *boxes, int n)
{
    const size_t count = se3d_system_count_contacts(system);
    se3d_contact *contacts = calloc(count + 1, sizeof *contacts);
    double force = 0.0, weight = 0.0;
    if (!contacts) {
        exit(1);
    }
    need(se3d_system_get_contacts(system, count, contacts), system);
    for (size_t k = 0; k < count; ++k) { /* the floor is the first shape */
        force += contacts[k].shape_i.index1 == 1 ? contacts[k].force[2] : 0.0;
    }
    for (int k = 0; k < n; ++k) {
        weight += BENCH_TOUCH_GRAVITY * bench_touch_mass(&boxes[k]);
    }
    free(contacts);
    return force / weight;
}

static void hold(const bench_box *boxes, int n, const char *method, char **argv)
{
    static double before[3 * BENCH_TOUCH_MOST + 3], after[3 * BENCH_TOUCH_MOST + 3];
    const double step = atof(argv[3]), rest = atof(argv[4]), end = rest + atof(argv[7]);
    const size_t count = (size_t)n + 1;
    se3d_system *system = build(boxes, n, atof(argv[5]));
    se3d_solver *solver = solve(system, method, step);
    se3d_energy energy;
    double last = HUGE_VAL, growth = 0.0, creep = 0.0, at = 0.0;
    for (long k = 1; at < end; ++k) {
        at = fmin(end, (double)k * step);
        need(se3d_solver_run(solver, at), system);
        need(se3d_system_get_energy(system, &energy), system);
        growth = fmax(growth, energy.total - last);
        last = energy.total;
        if (at <= rest) {
            need(se3d_body_get_all(system, count, before, NULL, NULL, NULL), system);
        }
    }
    need(se3d_body_get_all(system, count, after, NULL, NULL, NULL), system);
    for (size_t k = 3; k < 3 * count; ++k) { /* balls roll on; the ground comes first */
        creep = fmax(creep, boxes[k / 3 - 1].ball > 0.0 ? 0.0 : fabs(after[k] - before[k]));
    }
    printf("    %s s longer: moved by %.2g m, energy grew by %.2g J at most, the floor carries the "
           "weight but %.2g of it\n",
           argv[7], creep, growth, carried(system, boxes, n) - 1.0);
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

int main(int argc, char **argv)
{
    static bench_box boxes[BENCH_TOUCH_MOST];
    const int n = argc > 5 ? atoi(argv[2]) : 0;
    if (n < 1 || n > BENCH_TOUCH_MOST || !bench_touch_make(argv[1], n, boxes)) {
        fprintf(stderr, "bench_touch heap|stack|dominoes|pyramid|wall|cards N STEP DURATION "
                        "STIFFNESS [REPEATS [HOLD [convex|auto]]]\n");
        return 2;
    }
    double least = HUGE_VAL;
    const int repeats = argc > 6 ? atoi(argv[6]) : 1;
    const char *method = argc > 8 ? argv[8] : "convex";
    for (int k = 0; k < repeats; ++k) {
        se3d_system *system = build(boxes, n, atof(argv[5]));
        se3d_solver *solver = solve(system, method, atof(argv[3]));
        const double start = bench_clock();
        need(se3d_solver_run(solver, atof(argv[4])), system);
        least = fmin(least, bench_clock() - start);
        if (k + 1 == repeats) {
            printf("se3d   %-8s %4d, %s, step %s s: ", argv[1], n, method, argv[3]);
            show(system, solver, least);
        }
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
    if (argc > 7) {
        hold(boxes, n, method, argv);
    }
    return 0;
}
