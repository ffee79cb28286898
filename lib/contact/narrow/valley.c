/* SPDX-License-Identifier: BSD-3-Clause */
/* A ball in a valley of a mesh. Its distance to the surface has a least value on each face, and
 * between two of them a pass: the nearest point of the line in which their planes meet. Two faces
 * and their pass hold the energy of what the ball covers once:
 *
 *     U = k/2 (delta_i^2 + delta_j^2 - delta_e^2),   delta = R - d,   0 for a pass out of reach
 *
 * As the ball reaches a second face its place is on the pass, with the same depth: U and its
 * slope are continuous. With the way w = a n_i + b n_j from the pass to the centre,
 *
 *     a = (d_i - c d_j) / s^2,   b = (d_j - c d_i) / s^2,   c = n_i . n_j,   s^2 = 1 - c^2
 *
 * the slope is that of the depths delta_i - a delta_e / |w| and delta_j - b delta_e / |w|. Of more
 * faces those passes count, the deepest first, that join parts of the list that are apart yet.
 *                                                              docs/theory/body-contact.md */
#include "contact/narrow/mesh.h"
#include "math/vec3.h"

#include <math.h>

typedef struct pass {
    double depth;
    double part[2]; /* of the depth that is taken from each side */
    uint32_t side[2];
} pass;

/* How deep the pass is; one side's own place if it is behind the plane of the other. */
static pass find_pass(const se3di_touch *touch, uint32_t i, uint32_t j, double radius)
{
    const double d[2] = {touch[i].distance, touch[j].distance};
    const double c = se3di_dot(touch[i].normal, touch[j].normal);
    const double square = 1.0 - c * c;
    const double a = d[0] - c * d[1], b = d[1] - c * d[0]; /* times square */
    pass p = {.side = {i, j}};
    if (!(a > 0.0) || !(b > 0.0)) {
        const int hidden = a > 0.0 ? 0 : 1;
        p.depth = radius - d[hidden];
        p.part[hidden] = 1.0;
        return p;
    }
    const double away = sqrt((d[0] * a + d[1] * b) / square);
    p.depth = radius - away;
    p.part[0] = a / (square * away);
    p.part[1] = b / (square * away);
    return p;
}

static uint32_t find_group(const uint32_t *group, uint32_t k)
{
    while (group[k] != k) {
        k = group[k];
    }
    return k;
}

/* The deepest pass between groups; 0: none is reached. */
static int find_deepest(const se3di_touch *touch, const uint32_t *group, uint32_t count,
                        double radius, pass *best)
{
    best->depth = 0.0;
    for (uint32_t j = 1; j < count; ++j) {
        for (uint32_t i = 0; i < j; ++i) {
            if (find_group(group, i) == find_group(group, j)) {
                continue;
            }
            const pass p = find_pass(touch, i, j, radius);
            *best = p.depth > best->depth ? p : *best;
        }
    }
    return best->depth > 0.0;
}

void se3di_mesh_share_valley(const se3di_touch *touch, uint32_t count, double radius, double *depth)
{
    uint32_t group[SE3DI_MESH_TOUCHES];
    pass p;
    for (uint32_t k = 0; k < count; ++k) {
        group[k] = k;
        depth[k] = radius - touch[k].distance;
    }
    while (find_deepest(touch, group, count, radius, &p)) {
        group[find_group(group, p.side[1])] = find_group(group, p.side[0]);
        for (int k = 0; k < 2; ++k) {
            depth[p.side[k]] -= p.part[k] * p.depth;
        }
    }
}

#define SIDES    SE3DI_MESH_SIDES
#define SINGULAR 1e-14
#define ROUNDING 1e-12

/* ---- a corner: min |e|^2/2 with n_k . e >= depth_k, whose multipliers are the overlaps ---- */

/* n_i . n_j, 0 for faces that enclose less than a right angle. */
typedef double products[SIDES][SIDES];

/* Those of some sides if they alone count: G x = depth, by elimination. Returns whether all are
 * positive. */
static int solve_sides(products all, const double *depth, const uint32_t *side, uint32_t count,
                       double x[SIDES])
{
    products G;
    for (uint32_t i = 0; i < count; ++i) {
        x[i] = depth[side[i]];
        for (uint32_t j = 0; j < count; ++j) {
            G[i][j] = all[side[i]][side[j]];
        }
    }
    for (uint32_t k = 0; k < count; ++k) {
        if (!(G[k][k] > SINGULAR)) {
            return 0; /* normals in one plane, of which two will do */
        }
        for (uint32_t i = k + 1; i < count; ++i) {
            const double f = G[i][k] / G[k][k];
            for (uint32_t j = k; j < count; ++j) {
                G[i][j] -= f * G[k][j];
            }
            x[i] -= f * x[k];
        }
    }
    int positive = 1;
    for (uint32_t k = count; k-- > 0;) {
        for (uint32_t j = k + 1; j < count; ++j) {
            x[k] -= G[k][j] * x[j];
        }
        x[k] /= G[k][k];
        positive = positive && x[k] > 0.0;
    }
    return positive;
}

/* Whether the way off these sides leads off all others, too. */
static int leads_off(products G, const double *depth, uint32_t count, uint32_t set,
                     const double way[SIDES])
{
    for (uint32_t k = 0; k < count; ++k) {
        double left = depth[k];
        for (uint32_t j = 0; j < count; ++j) {
            left -= way[j] * G[k][j];
        }
        if (!(set >> k & 1u) && left > ROUNDING * depth[k]) {
            return 0;
        }
    }
    return 1;
}

void se3di_mesh_share_corner(const double (*n)[3], uint32_t count, double *depth)
{
    products G;
    for (uint32_t k = 0; k < count * count; ++k) {
        const uint32_t i = k / count, j = k % count;
        G[i][j] = fmax(0.0, se3di_dot(n[i], n[j]));
    }
    for (uint32_t set = (1u << count) - 1u; set > 0 && count > 1; --set) {
        uint32_t side[SIDES], sides = 0;
        double x[SIDES], way[SIDES] = {0.0, 0.0, 0.0, 0.0};
        for (uint32_t k = 0; k < count; ++k) {
            if (set >> k & 1u) {
                side[sides++] = k;
            }
        }
        if (!solve_sides(G, depth, side, sides, x)) {
            continue;
        }
        for (uint32_t k = 0; k < sides; ++k) {
            way[side[k]] = x[k];
        }
        if (leads_off(G, depth, count, set, way)) {
            for (uint32_t k = 0; k < count; ++k) {
                depth[k] = way[k];
            }
            return;
        }
    }
}
