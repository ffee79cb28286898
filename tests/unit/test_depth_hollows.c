/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids and meshes that are moved a little into a mesh with hollows, from where they touch first.
 *
 * What is moved back as far is apart again, so no contact is deeper than the way; and the two are
 * as deep in each other as any two of the boxes that make them up, at least. The first touch is
 * found by advancing as far as the boxes are apart along the best axis that divides them, which
 * never goes past it. */
#include "contact/narrow/internal.h"
#include "contact/shape/mesh.h"
#include "support/poses.h"
#include "support/prisms.h"
#include "support/separation.h"

#define SCALE   0.1
#define HALF    0.05
#define SAME    1e-9
#define TOUCHES 1e-12 /* m */
#define FAR     1.2   /* m: where a way begins */
#define GRID    0.05  /* m: of places where sides are flush */

enum { SOLIDS = 5 };
static const int kinds[SOLIDS] = {SE3DI_SHAPE_BOX, SE3DI_SHAPE_HULL, SE3DI_SHAPE_CYLINDER,
                                  SE3DI_SHAPE_CAPSULE, SE3DI_SHAPE_SPHERE};
static const char *const names[SOLIDS] = {"box", "hull", "cylinder", "capsule", "sphere"};

/* A shape and convex ones that make it up, at places in its frame. */
typedef struct compound {
    const char *name;
    se3di_shape shape;
    int is_mesh;
    size_t count;
    se3di_shape part[PRISM_BOXES];
    double middle[PRISM_BOXES][3];
    poses_solid solid;
} compound;

static void make_mesh(int which, compound *c)
{
    const se3d_allocator standard = se3di_alloc_default();
    const prism *p = &prisms[which];
    const prism_mesh t = prism_make(p, SCALE, HALF, (const double[2]){0.15, 0.15}, 0);
    memset(c, 0, sizeof *c);
    c->name = p->name;
    c->is_mesh = 1;
    c->shape.kind = SE3DI_SHAPE_MESH;
    CHECK(!se3di_mesh_build(&standard, t.points, t.point_count, t.faces, t.face_count, &c->shape));
    c->shape.bound = se3di_shape_bound(&c->shape);
    for (size_t k = 0; k < PRISM_BOXES && p->boxes[k][2] > 0.0; ++k) {
        const double *b = p->boxes[k];
        se3di_shape *box = &c->part[c->count];
        *box = (se3di_shape){.kind = SE3DI_SHAPE_BOX};
        for (int a = 0; a < 3; ++a) {
            const double low = a == 1 ? -HALF : SCALE * b[a / 2] - 0.15;
            const double high = a == 1 ? HALF : SCALE * b[2 + a / 2] - 0.15;
            box->half[a] = 0.5 * (high - low);
            c->middle[c->count][a] = 0.5 * (high + low);
        }
        box->bound = se3di_shape_bound(box);
        ++c->count;
    }
}

/* `round`: lengths of whole steps of the grid. */
static void make_solid(int which, int is_round, uint64_t *seed, compound *c)
{
    memset(c, 0, sizeof *c);
    poses_random_solid(kinds[which], seed, &c->solid);
    se3di_shape *s = &c->solid.shape;
    for (int a = 0; a < 3 && is_round; ++a) {
        s->half[a] = GRID * (1.0 + floor(poses_between(seed, 0.0, 3.999)));
    }
    s->radius = is_round ? GRID * (1.0 + floor(poses_between(seed, 0.0, 2.999))) : s->radius;
    s->half_length =
        is_round ? GRID * (1.0 + floor(poses_between(seed, 0.0, 3.999))) : s->half_length;
    s->bound = se3di_shape_bound(s);
    c->name = names[which];
    c->shape = c->part[0] = *s;
    c->count = 1;
}

static void place_part(const compound *c, size_t k, const se3di_shape_pose *at,
                       se3di_shape_pose *part)
{
    *part = *at;
    poly_place(at, c->middle[k], part->x);
}

/* How deep two convex shapes overlap; negative: no more than how far they are apart. */
static double depth_between(const se3di_shape *i, const se3di_shape_pose *at_i,
                            const se3di_shape *j, const se3di_shape_pose *at_j)
{
    poly a, b;
    poly_of(i, at_i, &a);
    poly_of(j, at_j, &b);
    if (a.points == 1 || a.points == 2) {
        double n[3];
        const double least = separation_of(i, at_i, j, at_j, n);
        return least > -HUGE_VAL ? least : -1.0;
    }
    return depth_of_cores(&a, &b, HUGE_VAL).least + a.radius + b.radius;
}

static double deepest_pair(const compound *i, const se3di_shape_pose *at, const compound *j,
                           const se3di_shape_pose *of)
{
    double most = -HUGE_VAL;
    for (size_t k = 0; k < i->count * j->count; ++k) {
        const size_t a = k / j->count, b = k % j->count;
        se3di_shape_pose part, other;
        double d[3];
        place_part(i, a, at, &part);
        place_part(j, b, of, &other);
        se3di_sub(part.x, other.x, d);
        const double balls = i->part[a].bound + j->part[b].bound - se3di_norm(d);
        most = fmax(most,
                    balls < -0.02 ? balls : depth_between(&i->part[a], &part, &j->part[b], &other));
    }
    return most;
}

/* Returns 0 if they never meet, or so flatly that it takes too long. */
static int advance(const compound *i, se3di_shape_pose *at, const compound *j,
                   const se3di_shape_pose *of, const double way[3])
{
    double gone = 0.0;
    for (int step = 0; step < 200 && gone < 2.0 * FAR; ++step) {
        const double apart = -deepest_pair(i, at, j, of);
        if (!(apart > TOUCHES)) {
            return 1;
        }
        se3di_add_scaled(apart, way, at->x);
        gone += apart;
    }
    return 0;
}

typedef struct tally {
    int counted, missed, deeper, less, phantom;
    double most;
} tally;

static void show(const char *what, const compound *i, const se3di_shape_pose *at, const compound *j,
                 const se3di_shape_pose *of, const double way[3], double wanted,
                 const se3di_manifold *m)
{
    double d[3], local[3];
    if (!poses_are_many()) {
        return;
    }
    se3di_sub(at->x, of->x, d);
    se3di_mul_transposed(of->R, d, local);
    se3di_mul_transposed(of->R, way, d);
    printf(
        "%s on %s, %s: half %g %g %g radius %g length %g at %.12g %.12g %.12g along %.9g %.9g %.9g"
        ", %.12g\n",
        i->name, j->name, what, i->shape.half[0], i->shape.half[1], i->shape.half[2],
        i->shape.radius, i->shape.half_length, local[0], local[1], local[2], d[0], d[1], d[2],
        wanted);
    for (uint32_t k = 0; k < m->count; ++k) {
        double n[3];
        se3di_mul_transposed(of->R, m->points[k].normal, n);
        se3di_sub(m->points[k].point, of->x, d);
        se3di_mul_transposed(of->R, d, local);
        printf("    %x: %.12g along %.9g %.9g %.9g at %.6g %.6g %.6g\n", m->points[k].feature,
               m->points[k].overlap, n[0], n[1], n[2], local[0], local[1], local[2]);
    }
}

static void check_pose(const compound *i, se3di_shape_pose *at, const compound *j,
                       const se3di_shape_pose *of, const double way[3], double deeper, tally *t)
{
    se3di_manifold m;
    double most = 0.0;
    if (!advance(i, at, j, of, way)) {
        return;
    }
    se3di_add_scaled(-10.0 * SAME, way, at->x);
    se3di_narrow_find(&i->shape, at, &j->shape, of, &m);
    if (deepest_pair(i, at, j, of) < -TOUCHES && m.count > 0) {
        ++t->phantom;
        show("phantom", i, at, j, of, way, 0.0, &m);
    }
    se3di_add_scaled(deeper + 10.0 * SAME, way, at->x);
    const double least = deepest_pair(i, at, j, of);
    if (!(least > SAME)) {
        return;
    }
    se3di_narrow_find(&i->shape, at, &j->shape, of, &m);
    for (uint32_t k = 0; k < m.count; ++k) {
        most = fmax(most, m.points[k].overlap);
    }
    ++t->counted;
    t->missed += m.count == 0;
    t->deeper += most > deeper + SAME;
    most = fmax(most, separation_shared(&i->shape, &m));
    t->less += m.count > 0 && most < least - SAME;
    t->most = fmax(t->most, most - deeper);
    if (m.count == 0 || most > deeper + SAME || most < least - SAME) {
        show(m.count == 0   ? "missed"
             : most < least ? "less"
                            : "deeper",
             i, at, j, of, way, most < least ? least : deeper, &m);
    }
}

/* Turned as the other but for its axes and a small angle, or at random. */
static void turn_pair(uint64_t *seed, se3di_shape_pose *at, se3di_shape_pose *of, int is_round)
{
    poses_turn(seed, of);
    if (!is_round) {
        poses_turn(seed, at);
    } else if (check_random(seed) > 0.0) {
        poses_turn_slightly(seed, of, -300.0, -299.0, at);
    } else {
        poses_lean(seed, of, at);
    }
}

/* To a place on the grid or anywhere, along an axis of the mesh or anyhow. */
static void try_pair(const compound *i, const compound *j, int is_round, uint64_t *seed, tally *t)
{
    se3di_shape_pose at, of;
    double local[3], way[3] = {0.0, 0.0, 0.0}, turned[3];
    turn_pair(seed, &at, &of, is_round);
    for (int c = 0; c < 3; ++c) {
        local[c] = 0.2 * check_random(seed);
        local[c] = is_round && check_random(seed) > -0.5 ? GRID * floor(local[c] / GRID) : local[c];
        way[c] = check_random(seed);
    }
    if (is_round && check_random(seed) > -0.6) {
        const int axis = (int)poses_between(seed, 0.0, 2.999);
        const double sign = way[axis] > 0.0 ? 1.0 : -1.0;
        se3di_scale(0.0, way, way);
        way[axis] = sign;
    }
    se3di_mul(of.R, way, turned);
    se3di_scale(1.0 / se3di_norm(turned), turned, way);
    poly_place(&of, local, at.x);
    se3di_add_scaled(-FAR, way, at.x);
    check_pose(i, &at, j, &of, way, pow(10.0, poses_between(seed, -6.0, -2.7)), t);
}

static void report(const char *name, const char *other, const tally *t)
{
    if (poses_are_many()) {
        printf("%s on %s: %d counted, %d missed, %d phantom, %d deeper, up to %.2g m, %d less\n",
               name, other, t->counted, t->missed, t->phantom, t->deeper, t->most, t->less);
    }
}

static void release(compound *c)
{
    const se3d_allocator standard = se3di_alloc_default();
    se3di_shape_release(&standard, &c->shape);
}

static void check_tally(const tally *t, int poses)
{
    CHECK(t->counted > poses / 8);
    CHECK(t->missed == 0);
    CHECK(t->phantom == 0);
    CHECK(t->deeper == 0);
    CHECK(t->less == 0);
}

static void solids_are_no_deeper_in_hollows_than_they_went(void)
{
    static compound mesh, solid;
    for (int which = 0; which < PRISMS; ++which) {
        make_mesh(which, &mesh);
        for (int kind = 0; kind < SOLIDS; ++kind) {
            const int poses = poses_count(100);
            uint64_t seed = 300 + (uint64_t)kind;
            tally t = {.counted = 0};
            for (int k = 0; k < poses; ++k) {
                make_solid(kind, k % 2, &seed, &solid);
                try_pair(&solid, &mesh, k % 2, &seed, &t);
            }
            report(names[kind], mesh.name, &t);
            check_tally(&t, poses);
        }
        release(&mesh);
    }
}

static void meshes_are_no_deeper_in_each_other_than_they_went(void)
{
    static compound one, two;
    for (int k = 0; k < PRISMS * PRISMS; ++k) {
        const int poses = poses_count(20);
        uint64_t seed = 500 + (uint64_t)k;
        tally t = {.counted = 0};
        make_mesh(k / PRISMS, &one);
        make_mesh(k % PRISMS, &two);
        for (int n = 0; n < poses; ++n) {
            try_pair(&one, &two, n % 2, &seed, &t);
        }
        report(one.name, two.name, &t);
        check_tally(&t, poses);
        release(&one);
        release(&two);
    }
}

int main(void)
{
    RUN(solids_are_no_deeper_in_hollows_than_they_went);
    RUN(meshes_are_no_deeper_in_each_other_than_they_went);
    return check_finish();
}
