/* SPDX-License-Identifier: BSD-3-Clause */
/* Heaps of boxes: what falls without spin passes its first touch in every method with control of
 * the error, and a run that fails says which shapes touched. A house of cards stands. */
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

/* ---- a house of cards ---- */

enum { STOREYS = 3, CARDS = STOREYS * (STOREYS + 1), PLATES = STOREYS * (STOREYS - 1) / 2 };

typedef struct house {
    se3d_body part[CARDS + PLATES];
    int count;
} house;

static void lay(scene *s, house *h, double length, double x, double z, double lean)
{
    const double about_y[3] = {0.0, 1.0, 0.0};
    const double size[3] = {1e-3, 0.06, length}, at[3] = {x, 0.0, z};
    const se3d_body card = scene_box(s, size, 700.0 * 1e-3 * 0.06 * length, at, scene_zero);
    scene_turn(s, card, about_y, lean);
    h->part[h->count++] = card;
}

/* Storey k has pairs of cards that lean against each other, and plates on them, but the highest. */
static void build(scene *s, house *h)
{
    const double pi = 3.14159265358979323846, lean = 20.0 * pi / 180.0, length = 0.09;
    const double x = 0.5 * (length * sin(lean) + 1e-3 * cos(lean));
    const double z = 0.5 * (length * cos(lean) + 1e-3 * sin(lean));
    const double pitch = 4.0 * x + 4e-3;
    double floor = 0.0;
    h->count = 0;
    for (int k = 0; k < STOREYS; ++k) {
        for (int j = 0; j < STOREYS - k; ++j) {
            const double middle = pitch * (j + 0.5 * k);
            lay(s, h, length, middle - x, floor + z, lean);
            lay(s, h, length, middle + x, floor + z, -lean);
        }
        floor += 2.0 * z;
        for (int j = 0; j + 1 < STOREYS - k; ++j) {
            lay(s, h, 0.98 * pitch, pitch * (j + 0.5 * (k + 1)), floor + 0.5e-3, 0.5 * pi);
        }
        floor += 1e-3;
    }
}

static void a_house_of_cards_stands(void)
{
    house h;
    double before[CARDS + PLATES][3], r[3];
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.8, 0.1, 1e4);
    build(&s, &h);
    scene_floor(&s, 0.0);
    CHECK(h.count == CARDS + PLATES);
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, 1e-3, 0.0);
    for (int is_late = 0; is_late < 2; ++is_late) {
        CHECK(scene_run(&s, is_late ? 11.0 : 1.0));
        for (int k = 0; k < h.count; ++k) {
            CHECK(se3d_body_get_position(s.system, h.part[k], r) == SE3D_OK);
            for (int c = 0; c < 3 && is_late; ++c) {
                CHECK(fabs(r[c] - before[k][c]) < 1e-6);
            }
            memcpy(before[k], r, sizeof r);
        }
    }
    CHECK(before[h.count - 1][2] > 0.21); /* the highest is where it was */
    scene_end(&s);
}

int main(void)
{
    RUN(the_first_touch_is_no_singularity);
    RUN(a_run_that_fails_names_the_shapes);
    RUN(a_house_of_cards_stands);
    return check_finish();
}
