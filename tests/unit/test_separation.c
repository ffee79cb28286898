/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids beside meshes, against tests that are exact (support/overlaps.h): no contact of what is
 * apart, a contact of all that overlaps. Each is asked with the solid larger and smaller by a
 * margin, so that no pose is ambiguous. */
#include "contact/narrow/internal.h"
#include "contact/shape/mesh.h"
#include "support/overlaps.h"

#define CLEAR 1e-7 /* m: less is neither apart nor overlapping */

enum { SOLIDS = 6 };
static const int kinds[SOLIDS] = {SE3DI_SHAPE_BOX,     SE3DI_SHAPE_HULL,   SE3DI_SHAPE_CYLINDER,
                                  SE3DI_SHAPE_CAPSULE, SE3DI_SHAPE_SPHERE, SE3DI_SHAPE_ELLIPSOID};
static const char *const names[SOLIDS] = {"box",     "hull",   "cylinder",
                                          "capsule", "sphere", "ellipsoid"};

typedef struct tally {
    int clear, phantom, overlapping, missed;
    double deepest;
} tally;

static void show(const pose_pair *p, const char *what, const se3di_manifold *m)
{
    if (!poses_are_many()) {
        return;
    }
    printf("%s, %s: kind %d, half %.17g %.17g %.17g radius %.17g length %.17g\n  at %.17g %.17g "
           "%.17g in the mesh's frame, %u points",
           p->mesh->name, what, p->solid->kind, p->solid->half[0], p->solid->half[1],
           p->solid->half[2], p->solid->radius, p->solid->half_length, p->body.x[0], p->body.x[1],
           p->body.x[2], m->count);
    for (uint32_t k = 0; k < m->count; ++k) {
        printf(" %.3g (%x)", m->points[k].overlap, m->points[k].feature);
    }
    printf("\n");
}

static void count_pose(pose_pair *p, tally *t)
{
    se3di_manifold m;
    double inner[3], d[3], x[3];
    bring(p);
    poses_inner(p->solid, &p->at, x);
    se3di_sub(x, p->of.x, d);
    se3di_mul_transposed(p->of.R, d, inner);
    if (surface_holds(p->mesh, inner)) {
        return;
    }
    const double shallow = -0.2 * poses_size(p->solid);
    const int far = overlaps(p, CLEAR), near = far && overlaps(p, -CLEAR);
    if (far != near || (near && overlaps(p, shallow))) {
        return;
    }
    se3di_narrow_find(p->solid, &p->at, &p->mesh->shape, &p->of, &m);
    if (!near) {
        ++t->clear;
        t->phantom += m.count > 0;
        for (uint32_t k = 0; k < m.count; ++k) {
            t->deepest = fmax(t->deepest, m.points[k].overlap);
        }
    } else {
        ++t->overlapping;
        t->missed += m.count == 0;
    }
    if ((m.count > 0) != near) {
        show(p, near ? "missed" : "phantom", &m);
    }
}

/* At random beside the mesh; and, one in four, from a random side on the way to it, just apart and
 * just overlapping. */
static void count_poses(int kind, const surface *s, int poses, tally *t)
{
    uint64_t seed = 20 + (uint64_t)kind;
    memset(t, 0, sizeof *t);
    for (int k = 0; k < poses; ++k) {
        double way[3] = {0.0, 0.0, -1.0}, local[3];
        poses_solid solid;
        pose_pair p = {.solid = &solid.shape, .mesh = s};
        poses_random_solid(kind, &seed, &solid);
        poses_turn(&seed, &p.of);
        poses_turn(&seed, &p.at);
        if (check_random(&seed) > 0.7) {
            poses_lean(&seed, &p.of, &p.at);
        }
        for (int c = 0; c < 3; ++c) {
            local[c] = (c < 2 ? 0.9 : 0.6) * check_random(&seed);
            way[c] += s->shape.closed ? 2.0 * check_random(&seed) : 0.3 * check_random(&seed);
        }
        poly_place(&p.of, local, p.at.x);
        count_pose(&p, t);
        if (k % 4 == 0) {
            const double size = se3di_norm(way);
            double turned[3];
            se3di_mul(p.of.R, way, turned);
            se3di_scale(1.0 / size, turned, way);
            se3di_add_scaled(-1.8, way, p.at.x);
            approach(&p, way, -0.002);
            count_pose(&p, t);
            const double deeper = poses_between(&seed, 0.0, 0.2) * poses_size(p.solid);
            se3di_add_scaled(0.002 + deeper, way, p.at.x);
            count_pose(&p, t);
        }
    }
}

static void solids_touch_the_triangles_that_they_overlap_and_no_others(void)
{
    static surface s;
    for (int which = 0; which < SURFACES; ++which) {
        surface_make(which, &s);
        for (int kind = 0; kind < SOLIDS; ++kind) {
            const int poses = poses_count(1000);
            tally t;
            count_poses(kinds[kind], &s, poses, &t);
            if (poses_are_many()) {
                printf("%s on %s: %d clear, %d phantom, up to %.2g m; %d overlapping, %d missed\n",
                       names[kind], s.name, t.clear, t.phantom, t.deepest, t.overlapping, t.missed);
            }
            CHECK(t.phantom == 0);
            CHECK(t.missed == 0);
            CHECK(t.clear > poses / 40 && t.overlapping > poses / 40);
        }
        surface_release(&s);
    }
}

int main(void)
{
    RUN(solids_touch_the_triangles_that_they_overlap_and_no_others);
    return check_finish();
}
