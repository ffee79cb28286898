/* SPDX-License-Identifier: BSD-3-Clause */
/* Boxes that touch (bench/touch.h) by the method convex, through the public interface:
 *
 *     bench_touch SCENE N STEP DURATION STIFFNESS [REPEATS]
 *
 * CPU time of the stepping, contacts and overlaps at the end. peers/mujoco_touch.c does the same.
 */
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

static void add_box(se3d_system *system, se3d_material material, const bench_box *box)
{
    se3d_body_def body = se3d_body_def_default();
    se3d_shape_def shape = se3d_shape_def_default();
    se3d_shape made;
    const double *s = box->size;
    body.mass = BENCH_TOUCH_DENSITY * s[0] * s[1] * s[2];
    for (int c = 0; c < 3; ++c) {
        const double a = s[(c + 1) % 3], b = s[(c + 2) % 3];
        body.inertia[c] = body.mass * (a * a + b * b) / 12.0;
        body.position[c] = box->at[c];
        shape.size[c] = s[c];
    }
    memcpy(body.orientation, box->turn, sizeof body.orientation);
    body.velocity[0] = box->speed;
    need(se3d_body_create(system, &body, &shape.body), system);
    shape.material = material;
    need(se3d_shape_create_box(system, &shape, &made), system);
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
        add_box(system, shape.material, &boxes[k]);
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

int main(int argc, char **argv)
{
    static bench_box boxes[BENCH_TOUCH_MOST];
    const int n = argc > 5 ? atoi(argv[2]) : 0;
    if (n < 1 || n > BENCH_TOUCH_MOST || !bench_touch_make(argv[1], n, boxes)) {
        fprintf(stderr, "bench_touch heap|stack|dominoes N STEP DURATION STIFFNESS [REPEATS]\n");
        return 2;
    }
    double least = HUGE_VAL;
    const int repeats = argc > 6 ? atoi(argv[6]) : 1;
    for (int k = 0; k < repeats; ++k) {
        se3d_system *system = build(boxes, n, atof(argv[5]));
        se3d_solver_def def = se3d_solver_def_default();
        se3d_solver *solver;
        def.method = SE3D_METHOD_CONVEX;
        def.step = atof(argv[3]);
        need(se3d_solver_create(system, &def, &solver), system);
        const double start = bench_clock();
        need(se3d_solver_run(solver, atof(argv[4])), system);
        least = fmin(least, bench_clock() - start);
        if (k + 1 == repeats) {
            printf("se3d   %-8s %4d, step %g s: ", argv[1], n, def.step);
            show(system, solver, least);
        }
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
    return 0;
}
