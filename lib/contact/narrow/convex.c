/* SPDX-License-Identifier: BSD-3-Clause */
/* Distance and least penetration of two convex cores by their difference
 *
 *     D = { a - b : a in core i, b in core j },
 *
 * which holds the origin where they overlap. Apart: the point of D nearest to the origin, by a
 * simplex that walks towards it (Gilbert, Johnson, Keerthi 1988); the nearest point of a simplex is
 * the best of those of all its parts. Overlapping: the boundary of D nearest to the origin, by a
 * polytope inside D that grows where it is nearest (van den Bergen 2001). For polyhedra both end
 * exactly, for round bodies when a step gains less than 1e-12 of their size. Of prisms side by side
 * many corners of D lie in a plane, or on a line, but for rounding, which may spoil the polytope:
 * then the search is made again with corners that are moved a little, by chance (joggled input of
 * Qhull: Barber, Dobkin, Huhdanpaa 1996), and its direction set right. */
#include "contact/narrow/internal.h"

#include "math/larger.h"
#include "math/random.h"
#include "math/vec3.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define WALKS       64
#define VERTICES    160
#define FACES       (4 * VERTICES) /* twice what lives, for a step's new ones */
#define GAIN        1e-12          /* relative; smaller ones end a search */
#define ROUND       2e-4  /* of the size: between a face and its reach, near a round body */
#define SETTLED     0.015 /* rad */
#define SLIVER      1e-4  /* sine of the angle of a face below which it is one */
#define APART       1e-9  /* of the size: cores that are */
#define PLANE_SLACK 1e-13 /* relative; a face is not seen from closer to its plane */
#define SHAKES      4     /* tries with moved corners */
#define SHAKE       1e-10 /* of the size: how far corners are moved first, then ten times as far */

typedef struct vertex {
    double p[3], a[3], b[3]; /* p = a - b */
} vertex;

typedef struct difference {
    const se3di_solid *i, *j;
    double size;
    int is_round; /* by one cylinder or what is smooth: two cylinders may have rims that meet near
                     an axis, where the overlap is known only from close by */
    double shake; /* how far its corners are moved by chance */
} difference;

/* By what its digits say: a corner that is met again moves as before. */
static void shake_place(double far, double p[3])
{
    uint64_t state = 0;
    for (int k = 0; k < 3; ++k) {
        uint64_t bits;
        memcpy(&bits, &p[k], sizeof bits);
        state = bits ^ se3di_random_mix(state);
    }
    for (int k = 0; k < 3; ++k) {
        p[k] += far * (2.0 * se3di_random_draw(&state) - 1.0);
    }
}

static void support(const difference *D, const double d[3], vertex *v)
{
    double back[3];
    se3di_scale(-1.0, d, back);
    se3di_core_support(D->i, d, v->a);
    se3di_core_support(D->j, back, v->b);
    se3di_sub(v->a, v->b, v->p);
    if (D->shake > 0.0) {
        shake_place(D->shake, v->p);
    }
}

typedef struct simplex {
    int count;
    vertex v[4];
    double weight[4];
} simplex;

/* Solve the n <= 3 symmetric equations G x = b; 0 if they are singular. */
static inline int solve_gram(int n, double G[3][3], double b[3], double x[3])
{
    for (int k = 0; k < n; ++k) {
        int pivot = k;
        for (int r = k + 1; r < n; ++r) {
            pivot = fabs(G[r][k]) > fabs(G[pivot][k]) ? r : pivot;
        }
        if (!(fabs(G[pivot][k]) > 0.0)) {
            return 0;
        }
        for (int c = 0; c < n; ++c) {
            double t = G[k][c];
            G[k][c] = G[pivot][c];
            G[pivot][c] = t;
        }
        double t = b[k];
        b[k] = b[pivot];
        b[pivot] = t;
        for (int r = k + 1; r < n; ++r) {
            double f = G[r][k] / G[k][k];
            for (int c = k; c < n; ++c) {
                G[r][c] -= f * G[k][c];
            }
            b[r] -= f * b[k];
        }
    }
    for (int k = n - 1; k >= 0; --k) {
        x[k] = b[k];
        for (int c = k + 1; c < n; ++c) {
            x[k] -= G[k][c] * x[c];
        }
        x[k] /= G[k][k];
    }
    return 1;
}

/* The point of the affine hull of some corners nearest to the origin: weights, all positive, and
 * the point; 0 if it is not between them. */
static inline int nearest_of(const simplex *s, const int *part, int count, double weight[4],
                             double point[3])
{
    double e[3][3], G[3][3], b[3], x[3] = {0.0, 0.0, 0.0};
    const double *base = s->v[part[0]].p;
    for (int k = 1; k < count; ++k) {
        se3di_sub(s->v[part[k]].p, base, e[k - 1]);
    }
    for (int r = 0; r < count - 1; ++r) {
        b[r] = -se3di_dot(e[r], base);
        for (int c = 0; c < count - 1; ++c) {
            G[r][c] = se3di_dot(e[r], e[c]);
        }
    }
    if (!solve_gram(count - 1, G, b, x)) {
        return 0;
    }
    double first = 1.0;
    se3di_copy(base, point);
    for (int k = 0; k < count - 1; ++k) {
        first -= x[k];
        se3di_add_scaled(x[k], e[k], point);
        weight[part[k + 1]] = x[k];
        if (!(x[k] > 0.0)) {
            return 0;
        }
    }
    weight[part[0]] = first;
    return first > 0.0;
}

/* The compiler makes one of it for each count. */
static int nearest_of_part(const simplex *s, const int *part, int count, double weight[4],
                           double point[3])
{
    switch (count) {
    case 1:
        weight[part[0]] = 1.0;
        se3di_copy(s->v[part[0]].p, point);
        return 1;
    case 2:
        return nearest_of(s, part, 2, weight, point);
    case 3:
        return nearest_of(s, part, 3, weight, point);
    default:
        return nearest_of(s, part, 4, weight, point);
    }
}

/* Reduce the simplex to the part whose nearest point is the nearest of all. Of the first `known`
 * corners together the point is that of `s->weight`, and no part of them has a nearer one. */
static void reduce(simplex *s, int known, double point[3])
{
    double least = HUGE_VAL, best_weight[4] = {0.0, 0.0, 0.0, 0.0};
    int best = 1;
    if (known > 0) {
        least = se3di_dot(point, point);
        best = (1 << known) - 1;
        memcpy(best_weight, s->weight, sizeof best_weight);
    }
    for (int mask = 1 << known; mask < 1 << s->count; ++mask) {
        int part[4] = {0, 0, 0, 0}, count = 0;
        double weight[4] = {0.0, 0.0, 0.0, 0.0}, here[3];
        for (int k = 0; k < s->count; ++k) {
            part[count] = k;
            count += mask >> k & 1;
        }
        if (!nearest_of_part(s, part, count, weight, here)) {
            continue;
        }
        double square = se3di_dot(here, here);
        if (square < least) {
            least = square;
            best = mask;
            se3di_copy(here, point);
            memcpy(best_weight, weight, sizeof weight);
        }
    }
    int kept = 0;
    for (int k = 0; k < s->count; ++k) {
        if (best >> k & 1) {
            s->v[kept] = s->v[k];
            s->weight[kept++] = best_weight[k];
        }
    }
    s->count = kept;
}

static int holds(const simplex *s, const vertex *v)
{
    for (int k = 0; k < s->count; ++k) {
        double d[3];
        se3di_sub(s->v[k].p, v->p, d);
        if (!(se3di_norm(d) > 0.0)) {
            return 1;
        }
    }
    return 0;
}

/* The distance; 0 if the origin is within rounding of the simplex. For one of `near` or less any
 * such may be returned, for one beyond `far` a bound beyond it: D lies behind the plane through its
 * point farthest along any direction. */
static double walk(const difference *D, simplex *s, double point[3], double near, double far)
{
    double d[3];
    se3di_sub(D->j->at->x, D->i->at->x, d);
    if (!(se3di_norm(d) > 0.0)) {
        d[0] = 1.0;
    }
    support(D, d, &s->v[0]);
    s->count = 1;
    s->weight[0] = 1.0;
    se3di_copy(s->v[0].p, point);
    const double size = se3di_norm(d);
    if (-se3di_dot(point, d) > far * size) {
        return -se3di_dot(point, d) / size;
    }
    for (int k = 0; k < WALKS; ++k) {
        vertex next;
        double square = se3di_dot(point, point);
        if (!(square > GAIN * GAIN * D->size * D->size) || s->count == 4) {
            return 0.0;
        }
        double distance = sqrt(square);
        if (distance <= near) {
            return distance;
        }
        se3di_scale(-1.0 / distance, point, d);
        support(D, d, &next);
        const double least = -se3di_dot(next.p, d);
        if (least > far) {
            return least;
        }
        if (distance - least <= GAIN * D->size || holds(s, &next)) {
            return distance;
        }
        s->v[s->count++] = next;
        reduce(s, s->count - 1, point);
        if (!(se3di_dot(point, point) < square)) {
            return sqrt(se3di_dot(point, point));
        }
    }
    return se3di_norm(point);
}

static void witness(const vertex *v, const double *weight, int count, double a[3], double b[3])
{
    memset(a, 0, 3 * sizeof *a);
    memset(b, 0, 3 * sizeof *b);
    for (int k = 0; k < count; ++k) {
        se3di_add_scaled(weight[k], v[k].a, a);
        se3di_add_scaled(weight[k], v[k].b, b);
    }
}

typedef struct polytope_face {
    int v[3];
    int alive, done;
    int is_sliver; /* rounding has turned its normal */
    double n[3];   /* outward */
    double distance;
} polytope_face;

/* The least reach so far, its direction and the nearest points of the two. */
typedef struct least_reach {
    double reach, n[3], a[3], b[3];
    int is_settled; /* no other direction near it has a lesser one */
    int is_sliver;
} least_reach;

typedef struct polytope {
    const difference *D;
    int vertex_count, face_count;
    vertex v[VERTICES];
    polytope_face face[FACES];
    int level_count, level[FACES][3]; /* faces among which the nearest points are to be found */
} polytope;

static void add_face(polytope *P, int a, int b, int c)
{
    if (P->face_count >= FACES) {
        return;
    }
    double ab[3], ac[3];
    polytope_face *f = &P->face[P->face_count++];
    *f = (polytope_face){.v = {a, b, c}, .alive = 1, .distance = HUGE_VAL};
    se3di_sub(P->v[b].p, P->v[a].p, ab);
    se3di_sub(P->v[c].p, P->v[a].p, ac);
    se3di_cross(ab, ac, f->n);
    double size = se3di_norm(f->n);
    const double edges = se3di_norm(ab) * se3di_norm(ac);
    if (size > DBL_EPSILON * edges) {
        f->is_sliver = size < SLIVER * edges;
        se3di_scale(1.0 / size, f->n, f->n);
        f->distance = se3di_dot(f->n, P->v[a].p);
    }
}

static double height_over(const polytope *P, const polytope_face *f, const double p[3])
{
    double d[3];
    se3di_sub(p, P->v[f->v[0]].p, d);
    return f->distance < HUGE_VAL ? se3di_dot(d, f->n) : 0.0;
}

/* Complete a simplex that holds the origin to a tetrahedron; 0 if D is flat. */
static int complete(const difference *D, simplex *s)
{
    static const double way[6][3] = {{1.0, 0.0, 0.0},  {-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0},
                                     {0.0, -1.0, 0.0}, {0.0, 0.0, 1.0},  {0.0, 0.0, -1.0}};
    double e[3], f[3], n[3];
    for (int k = 0; s->count == 1 && k < 6; ++k) {
        support(D, way[k], &s->v[1]);
        se3di_sub(s->v[1].p, s->v[0].p, e);
        s->count += se3di_norm(e) > 1e-9 * D->size;
    }
    for (int k = 0; s->count == 2 && k < 6; ++k) {
        se3di_sub(s->v[1].p, s->v[0].p, e);
        se3di_cross(e, way[k], f);
        support(D, f, &s->v[2]);
        se3di_sub(s->v[2].p, s->v[0].p, f);
        se3di_cross(e, f, n);
        s->count += se3di_norm(n) > 1e-9 * D->size * se3di_norm(e);
    }
    for (int k = 0; s->count == 3 && k < 2; ++k) {
        se3di_sub(s->v[1].p, s->v[0].p, e);
        se3di_sub(s->v[2].p, s->v[0].p, f);
        se3di_cross(e, f, n);
        double size = se3di_norm(n);
        se3di_scale((k ? -1.0 : 1.0) / size, n, n);
        support(D, n, &s->v[3]);
        se3di_sub(s->v[3].p, s->v[0].p, f);
        s->count += fabs(se3di_dot(f, n)) > 1e-9 * D->size;
    }
    return s->count == 4;
}

static void begin(polytope *P, const simplex *s)
{
    static const int faces[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    double e[3], f[3], g[3], n[3];
    P->vertex_count = 4;
    P->face_count = 0;
    P->level_count = 0;
    memcpy(P->v, s->v, sizeof s->v);
    se3di_sub(s->v[1].p, s->v[0].p, e);
    se3di_sub(s->v[2].p, s->v[0].p, f);
    se3di_sub(s->v[3].p, s->v[0].p, g);
    se3di_cross(e, f, n);
    int inward = se3di_dot(n, g) > 0.0; /* the fourth is above 0, 1, 2 */
    for (int k = 0; k < 4; ++k) {
        add_face(P, faces[k][0], faces[k][inward ? 2 : 1], faces[k][inward ? 1 : 2]);
    }
}

/* The edge a -> b of a dying face is on the horizon unless the face beyond it dies, too. */
static int is_horizon(const polytope *P, const int *dying, int count, int a, int b)
{
    for (int k = 0; k < count; ++k) {
        const int *v = P->face[dying[k]].v;
        if ((v[0] == b && v[1] == a) || (v[1] == b && v[2] == a) || (v[2] == b && v[0] == a)) {
            return 0;
        }
    }
    return 1;
}

/* Faces that the new vertex sees give way to a cone from it. Returns 0 if there is no room. */
static int grow(polytope *P, int vertex_index)
{
    int dying[FACES], seen = 0;
    const double *p = P->v[vertex_index].p;
    for (int k = 0; k < P->face_count; ++k) {
        polytope_face *f = &P->face[k];
        if (height_over(P, f, p) > PLANE_SLACK * P->D->size) {
            f->alive = 0;
            dying[seen++] = k;
        }
    }
    for (int k = 0; k < seen; ++k) {
        for (int e = 0; e < 3; ++e) {
            const int a = P->face[dying[k]].v[e];
            const int b = P->face[dying[k]].v[(e + 1) % 3];
            if (is_horizon(P, dying, seen, a, b)) {
                add_face(P, a, b, vertex_index);
            }
        }
    }
    int kept = seen > 0 ? dying[0] : P->face_count;
    for (int k = kept; k < P->face_count; ++k) {
        if (P->face[k].alive) {
            P->face[kept++] = P->face[k];
        }
    }
    int full = P->face_count >= FACES;
    P->face_count = kept;
    return seen > 0 && !full;
}

/* The point of a face nearest to the origin, if it is nearer than `least`. */
static void try_witness(const polytope *P, const int v[3], double *least, least_reach *best)
{
    double point[3] = {0.0, 0.0, 0.0};
    simplex s = {.count = 3, .v = {P->v[v[0]], P->v[v[1]], P->v[v[2]]}};
    reduce(&s, 0, point);
    if (se3di_norm(point) < *least) {
        *least = se3di_norm(point);
        witness(s.v, s.weight, s.count, best->a, best->b);
    }
}

/* Of the faces in the plane of the nearest one, that with the point nearest to the origin. */
static void find_witness(polytope *P, least_reach *best)
{
    double least = HUGE_VAL;
    for (int k = 0; k < P->level_count; ++k) {
        try_witness(P, P->level[k], &least, best);
    }
    P->level_count = 0;
}

/* Keep those faces, the nearest one first: another may be the one whose points are asked for. */
static void keep_level(polytope *P, const polytope_face *nearest)
{
    memcpy(P->level[0], nearest->v, sizeof nearest->v);
    P->level_count = 1;
    for (int k = 0; k < P->face_count; ++k) {
        const polytope_face *f = &P->face[k];
        if (f != nearest && !(f->distance > nearest->distance + 1e-9 * P->D->size)) {
            memcpy(P->level[P->level_count++], f->v, sizeof f->v);
        }
    }
}

/* A face that may have a lesser reach behind it: not near the direction that is settled. */
static polytope_face *next_face(polytope *P, const least_reach *best)
{
    polytope_face *next = NULL;
    for (int k = 0; k < P->face_count; ++k) {
        polytope_face *f = &P->face[k];
        double turn[3];
        if (f->done || !(f->distance < (next ? next->distance : HUGE_VAL))) {
            continue;
        }
        se3di_sub(f->n, best->n, turn);
        if (!best->is_settled || se3di_dot(turn, turn) > SETTLED * SETTLED) {
            next = f;
        }
    }
    return next;
}

/* The normal with the least reach of D that a nearest face has had; the reach is the overlap. Near
 * a face of a round body the least reach is found at once, and what is left is to know that no
 * other face has a lesser one behind it. A face that cannot grow for rounding is left there, the
 * search goes on with the next: every reach is a bound. Returns whether of polyhedra there is no
 * lesser one; rounding may have spoilt their polytope. */
static int expand(polytope *P, least_reach *best)
{
    const double same = GAIN * P->D->size;
    double bound = -HUGE_VAL;
    int is_least = 0;
    while (P->vertex_count < VERTICES) {
        polytope_face *f = next_face(P, best);
        const int is_spoilt = f && f->distance < bound - APART * P->D->size;
        is_least = !f || !(f->distance < best->reach - same);
        if (is_least || (is_spoilt && !P->D->is_round)) {
            break;
        }
        bound = f->distance;
        vertex *v = &P->v[P->vertex_count];
        support(P->D, f->n, v);
        const double reach = se3di_dot(v->p, f->n);
        if (reach < best->reach) {
            best->reach = reach;
            best->is_settled = 0;
            best->is_sliver = f->is_sliver;
            se3di_copy(f->n, best->n);
            keep_level(P, f);
            if (P->D->is_round && reach - f->distance < ROUND * P->D->size) {
                find_witness(P, best);
                best->is_settled =
                    se3di_convex_polish(P->D->i, P->D->j, best->n, best->a, best->b, &best->reach);
            }
        }
        f->done = 1;
        if (reach - f->distance > same && grow(P, P->vertex_count)) {
            ++P->vertex_count;
        } else if (!P->D->is_round) {
            is_least = !(reach - f->distance > same);
            break; /* what rounding has turned is set right at the end */
        }
    }
    find_witness(P, best);
    best->reach = best->reach < HUGE_VAL ? fmax(best->reach, 0.0) : 0.0;
    return is_least;
}

/* From a simplex that holds the origin. */
static int search(polytope *P, const difference *D, const simplex *s, least_reach *best)
{
    *best = (least_reach){.reach = HUGE_VAL};
    P->D = D;
    begin(P, s);
    return expand(P, best);
}

/* Again with corners that are moved a little; once if they are round, as what they span does not
 * close. */
static void search_shaken(polytope *P, const difference *D, const simplex *s, least_reach *best)
{
    const int are_round = se3di_solid_has_rims(D->i) || se3di_solid_has_rims(D->j);
    const int tries = are_round ? 1 : SHAKES;
    difference shaken = *D;
    int is_least = 0;
    shaken.shake = SHAKE * D->size;
    for (int k = 0; k < tries && !is_least; ++k, shaken.shake *= 10.0) {
        simplex moved = *s;
        least_reach here;
        for (int c = 0; c < moved.count; ++c) {
            shake_place(shaken.shake, moved.v[c].p);
        }
        is_least = search(P, &shaken, &moved, &here);
        vertex v;
        support(D, here.n, &v);
        here.reach = se3di_dot(v.p, here.n);
        (void)se3di_convex_polish(D->i, D->j, here.n, here.a, here.b, &here.reach);
        if (here.reach < best->reach) {
            *best = here;
        }
    }
}

/* Cores without volume in their difference (crossing lines): perpendicular to both. */
static double flat_normal(const difference *D, const simplex *s, double normal[3])
{
    double e[3], f[3];
    se3di_copy((const double[3]){0.0, 0.0, 1.0}, normal);
    if (s->count > 2) {
        se3di_sub(s->v[1].p, s->v[0].p, e);
        se3di_sub(s->v[2].p, s->v[0].p, f);
        se3di_cross(e, f, normal);
    } else if (s->count == 2) {
        se3di_sub(s->v[1].p, s->v[0].p, e);
        double size = se3di_norm(e);
        se3di_scale(size > 0.0 ? 1.0 / size : 0.0, e, e);
        se3di_perpendicular(e, normal);
    }
    se3di_sub(D->j->at->x, D->i->at->x, e);
    double size = se3di_norm(normal);
    double sign = se3di_dot(e, normal) < 0.0 ? -1.0 : 1.0;
    if (size > 0.0) {
        se3di_scale(sign / size, normal, normal);
    } else {
        se3di_copy((const double[3]){0.0, 0.0, 1.0}, normal);
    }
    return 0.0;
}

/* The overlap of a box or line and a cylinder or line, <= 0 if they are apart, and of a cylinder
 * and any other, 0 if it is not known; minus infinity: they are other shapes, or two lines. */
static double known_overlap(const se3di_solid *i, const se3di_solid *j, double normal[3],
                            double on_i[3], double on_j[3])
{
    if (se3di_solid_has_rims(i) && se3di_solid_has_rims(j)) {
        return se3di_cylinders_overlap(i, j, normal, on_i, on_j);
    }
    for (int k = 0; k < 2; ++k) {
        const se3di_solid *one = k ? j : i, *other = k ? i : j;
        const int is_box = se3di_shape_class_of(one->shape)->flats == SE3DI_AXES_ALL;
        if ((is_box && se3di_solid_is_line(other)) ||
            ((is_box || se3di_solid_is_line(one)) && se3di_solid_has_rims(other))) {
            const double overlap =
                se3di_cylinder_overlap(one, other, normal, k ? on_j : on_i, k ? on_i : on_j);
            se3di_scale(k ? -1.0 : 1.0, normal, normal);
            return overlap;
        }
    }
    const int has_rims = se3di_solid_has_rims(i) || se3di_solid_has_rims(j);
    return has_rims ? se3di_caps_overlap(i, j, normal, on_i, on_j) : -HUGE_VAL;
}

static double size_of(const se3di_solid *solid)
{
    return solid->shape->bound;
}

int se3di_convex_are_apart(const se3di_solid *i, const se3di_solid *j, double distance)
{
    difference D = {i, j, size_of(i) + size_of(j), 0, 0.0};
    simplex s;
    double point[3];
    memset(&s, 0, sizeof s);
    const double enough = fmax(distance, APART * D.size);
    return walk(&D, &s, point, enough, enough) > enough;
}

int se3di_convex_are_parted(const se3di_solid *i, const se3di_solid *j, const double n[3],
                            double distance)
{
    difference D = {i, j, size_of(i) + size_of(j), 0, 0.0};
    vertex v;
    support(&D, n, &v);
    return -se3di_dot(v.p, n) > se3di_raised(APART * D.size, distance);
}

/* The overlap of cores that meet, from a simplex that is within rounding of the origin. */
static double overlap_of(const difference *D, simplex *s, double normal[3], double on_i[3],
                         double on_j[3])
{
    const int rims_i = se3di_solid_has_rims(D->i), rims_j = se3di_solid_has_rims(D->j);
    if (!rims_i && !rims_j) {
        double n[3], a[3], b[3];
        const double overlap = known_overlap(D->i, D->j, n, a, b);
        if (overlap > 0.0) {
            se3di_copy(n, normal);
            se3di_copy(a, on_i);
            se3di_copy(b, on_j);
            return overlap;
        }
    }
    if (!complete(D, s)) {
        return flat_normal(D, s, normal);
    }
    polytope P;
    least_reach best;
    if (!search(&P, D, s, &best) && !D->is_round) {
        search_shaken(&P, D, s, &best);
    }
    const int is_smooth = se3di_solid_is_smooth(D->i) || se3di_solid_is_smooth(D->j);
    if (!best.is_settled && (best.is_sliver || is_smooth || rims_i || rims_j)) {
        (void)se3di_convex_polish(D->i, D->j, best.n, best.a, best.b, &best.reach);
    }
    se3di_copy(best.n, normal);
    se3di_copy(best.a, on_i);
    se3di_copy(best.b, on_j);
    return best.reach;
}

double se3di_convex_distance(const se3di_solid *i, const se3di_solid *j, double far,
                             double normal[3], double on_i[3], double on_j[3])
{
    const int smooth = se3di_solid_is_smooth(i) || se3di_solid_is_smooth(j);
    difference D = {i, j, size_of(i) + size_of(j),
                    smooth || se3di_solid_has_rims(i) != se3di_solid_has_rims(j), 0.0};
    simplex s;
    double point[3];
    const double least = APART * D.size;
    const double known = se3di_solid_has_rims(i) || se3di_solid_has_rims(j)
                             ? known_overlap(i, j, normal, on_i, on_j)
                             : -HUGE_VAL;
    if (known > least) {
        return known;
    }
    memset(&s, 0, sizeof s);
    double distance = walk(&D, &s, point, -1.0, fmax(far, least));
    if (distance > far && distance > least) {
        return -distance;
    }
    witness(s.v, s.weight, s.count, on_i, on_j);
    if (distance > least) {
        double overlap = smooth ? HUGE_VAL : -distance;
        se3di_scale(-1.0 / distance, point, normal); /* point = a - b, from j to i */
        return smooth && se3di_convex_polish(i, j, normal, on_i, on_j, &overlap) ? overlap
                                                                                 : -distance;
    }
    return overlap_of(&D, &s, normal, on_i, on_j);
}
