/* SPDX-License-Identifier: BSD-3-Clause */
/* Heaps of boxes: what falls without spin passes its first touch in every method with control of
 * the error, and a run that fails says which shapes touched. */
#include "support/scene.h"

enum { LAYERS = 2, BOXES = 4 * LAYERS };

static void drop(scene *s, se3d_body *bodies)
{
    static char name[BOXES][16];
    for (int k = 0; k < BOXES; ++k) {
        const double size[3] = {0.1, 0.08, 0.06};
        const double r[3] = {0.12 * (k % 2) + 0.03 * (k / 4), 0.1 * (k / 2 % 2) + 0.02 * (k / 4),
                             0.05 + 0.08 * (k / 4)};
        const double J[3] = {0.5 * 1e-2 / 12.0, 0.5 * 1.36e-2 / 12.0, 0.5 * 1.64e-2 / 12.0};
        se3d_shape shape;
        bodies[k] = scene_body(s, 0.5, J, r, scene_zero);
        se3d_shape_def def = scene_shape(s, bodies[k]);
        snprintf(name[k], sizeof name[k], "box %d", k);
        def.name = name[k];
        memcpy(def.size, size, sizeof size);
        CHECK(se3d_shape_create_box(s->system, &def, &shape) == SE3D_OK);
    }
    scene_floor(s, 0.0);
}

#define METHODS 3
static const int32_t methods[METHODS] = {SE3D_METHOD_RADAU, SE3D_METHOD_DOP853, SE3D_METHOD_BDF};

static scene open_heap(double stiffness, int32_t method)
{
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.3, stiffness);
    se3d_body bodies[BOXES];
    drop(&s, bodies);
    scene_solve(&s, method, SE3D_FORMULATION_ROMEGA, 0.0, 0.0);
    return s;
}

static void the_first_touch_is_no_singularity(void)
{
    for (int k = 0; k < METHODS; ++k) {
        scene s = open_heap(1e5, methods[k]);
        scene_run(&s, 0.12);
        CHECK(se3d_system_count_contacts(s.system) > 3);
        scene_end(&s);
    }
}

/* A stiffness whose contacts are shorter than any step. */
static void a_run_that_fails_names_the_shapes(void)
{
    for (int k = 0; k < METHODS; ++k) {
        scene s = open_heap(1e30, methods[k]);
        CHECK(se3d_solver_run(s.solver, 0.12) < 0);
        CHECK_CONTAINS(se3d_system_get_error(s.system), "box ");
        scene_end(&s);
    }
}

int main(void)
{
    RUN(the_first_touch_is_no_singularity);
    RUN(a_run_that_fails_names_the_shapes);
    return check_finish();
}
