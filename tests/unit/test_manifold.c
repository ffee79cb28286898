/* SPDX-License-Identifier: BSD-3-Clause */
/* Of more points than a manifold has room for those stay that the rest stands for worst. */
#include "check.h"
#include "contact/narrow/internal.h"

#include <math.h>

#define PI   3.14159265358979323846
#define RING 60

/* A rim that is deep by `lean` more on one side, as one after the other tells its points. */
static void add_ring(se3di_manifold *manifold, double lean, double side)
{
    const double up[3] = {0.0, 0.0, 1.0};
    *manifold = (se3di_manifold){.count = 0};
    for (int k = 0; k < RING; ++k) {
        const double angle = 2.0 * PI * k / RING;
        const double at[3] = {cos(angle), sin(angle), 0.0};
        const double overlap = 1e-3 * (1.0 + lean * cos(angle - side));
        se3di_contact_point *p =
            se3di_manifold_add(manifold, at, up, overlap, (uint32_t)(7 * k % RING));
        p->share = 1.0;
    }
}

static int find_feature(const se3di_manifold *manifold, uint32_t feature)
{
    int found = 0;
    for (uint32_t k = 0; k < manifold->count; ++k) {
        found += manifold->points[k].feature == feature;
    }
    return found;
}

static void a_rim_is_held_all_around(void)
{
    se3di_manifold manifold;
    add_ring(&manifold, 0.2, 0.3);
    CHECK(manifold.count == SE3DI_MANIFOLD_POINTS);
    for (int k = 0; k < RING; ++k) {
        const double angle = 2.0 * PI * k / RING;
        double near = -1.0;
        for (uint32_t i = 0; i < manifold.count; ++i) {
            const double *at = manifold.points[i].point;
            near = fmax(near, at[0] * cos(angle) + at[1] * sin(angle));
        }
        CHECK(near > cos(30.0 * PI / 180.0));
    }
}

static void leaning_changes_no_choice(void)
{
    se3di_manifold level, leaning;
    add_ring(&level, 0.0, 0.0);
    for (int k = 0; k < 12; ++k) {
        add_ring(&leaning, 0.3, 2.0 * PI * k / 12);
        for (uint32_t i = 0; i < level.count; ++i) {
            CHECK(find_feature(&leaning, level.points[i].feature) == 1);
        }
    }
}

/* But a point that is far deeper than what is about it stays. */
static void the_deepest_stays(void)
{
    const double up[3] = {0.0, 0.0, 1.0};
    for (int deep = 0; deep < 2 * SE3DI_MANIFOLD_POINTS; ++deep) {
        se3di_manifold manifold = {.count = 0};
        for (int k = 0; k < 2 * SE3DI_MANIFOLD_POINTS; ++k) {
            const double at[3] = {0.1 * k, 0.0, 0.0};
            (void)se3di_manifold_add(&manifold, at, up, k == deep ? 1e-2 : 1e-3, (uint32_t)k);
        }
        CHECK(manifold.count == SE3DI_MANIFOLD_POINTS);
        CHECK(find_feature(&manifold, (uint32_t)deep) == 1);
    }
}

int main(void)
{
    RUN(a_rim_is_held_all_around);
    RUN(leaning_changes_no_choice);
    RUN(the_deepest_stays);
    return check_finish();
}
