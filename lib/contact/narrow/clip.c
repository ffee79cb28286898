/* SPDX-License-Identifier: BSD-3-Clause */
/* What looks at a face is cut off at the face's sides, along the normal of contact, and its corners
 * behind the face are the points of contact, each with its own overlap along that normal. */
#include "contact/narrow/internal.h"

#include "math/larger.h"
#include "math/vec3.h"

#include <math.h>

#define CUT_CORNERS    (2 * SE3DI_FACE_CORNERS)
#define CROSSINGS      64u /* numbers of corners are below */
#define CROSSING_COUNT 960u
#define SLACK          1e-4 /* of the face: corners beyond a side by less stay, at the side; */
#define SAME           1e-9 /* those within it by less are at the side, too */

typedef struct cut {
    int count;
    double corner[CUT_CORNERS][3];
    uint32_t id[CUT_CORNERS];
} cut;

/* Numbers of places where sides cross are drawn from few: of equal ones the later is another. */
static void cut_add(cut *to, const double x[3], uint32_t id)
{
    for (int k = 0; k < to->count; ++k) {
        if (to->id[k] == id) {
            id = CROSSINGS + (id + 1u - CROSSINGS) % CROSSING_COUNT;
            k = -1; /* all again */
        }
    }
    if (to->count < CUT_CORNERS) {
        se3di_copy(x, to->corner[to->count]);
        to->id[to->count++] = id;
    }
}

/* What of `from` is on the inner side (n . x <= level) of one side of the face. A corner that is
 * beyond it by less than the slack is moved to it: if edges lie on each other but for little, as
 * those of equal boxes in a wall, the least turn would cut off another corner, and every corner has
 * the whole stiffness of the materials. For that a corner at the side but for rounding is no inner
 * one either: the crossing beside it would be a second point at the same place. */
static void cut_side(const cut *from, const double n[3], double level, const double slack[2],
                     uint32_t side, cut *to)
{
    to->count = 0;
    for (int k = 0; k < from->count; ++k) {
        int next = (k + 1) % from->count;
        const double *a = from->corner[k];
        const double *b = from->corner[next];
        double high_a = se3di_dot(n, a) - level;
        double high_b = se3di_dot(n, b) - level;
        double x[3];
        if (high_a <= slack[0]) {
            se3di_copy(a, x);
            se3di_add_scaled(-se3di_raised(0.0, high_a), n, x);
            cut_add(to, x, from->id[k]);
        }
        const int crosses =
            high_a > slack[0] ? high_b < -slack[1] : high_a < -slack[1] && high_b > slack[0];
        if (crosses && (from->count > 2 || k == 0)) {
            double t = high_a / (high_a - high_b);
            se3di_sub(b, a, x);
            se3di_scale(t, x, x);
            se3di_add(a, x, x);
            uint32_t low = from->id[k] < from->id[next] ? from->id[k] : from->id[next];
            uint32_t high = from->id[k] < from->id[next] ? from->id[next] : from->id[k];
            cut_add(to, x, CROSSINGS + ((low * 61u + high) * 17u + side) % CROSSING_COUNT);
        }
    }
}

static double face_size(const se3di_face *face)
{
    double most = 0.0;
    for (int k = 1; k < face->count; ++k) {
        double d[3];
        se3di_sub(face->corner[k], face->corner[0], d);
        most = fmax(most, se3di_norm(d));
    }
    return most;
}

void se3di_face_bend(const se3di_face *incident, double radius, se3di_bend *bend)
{
    double u[3];
    bend->r[0] = bend->r[1] = radius;
    if (incident->count == 2) {
        se3di_sub(incident->corner[1], incident->corner[0], u);
        double size = se3di_norm(u);
        if (size > 0.0) {
            se3di_scale(1.0 / size, u, bend->u);
        }
    }
}

void se3di_narrow_clip(const se3di_face *reference, const se3di_face *incident,
                       const double along[3], double radius, double depth, int flip,
                       se3di_manifold *manifold)
{
    cut a = {.count = 0}, b;
    cut *from = &a, *to = &b;
    const double size = face_size(reference);
    const double rounding = se3di_narrow_rounding(reference->corner[0], size);
    const double slack[2] = {SLACK * size, SAME * size + rounding};
    const double lean = se3di_dot(reference->normal, along);
    for (int k = 0; k < incident->count; ++k) {
        cut_add(from, incident->corner[k], (uint32_t)k);
    }
    for (int k = 0; k < reference->count && from->count > 0; ++k) {
        const double *p = reference->corner[k];
        double side[3], n[3];
        se3di_sub(reference->corner[(k + 1) % reference->count], p, side);
        se3di_cross(side, along, n);
        const double length = se3di_norm(n);
        if (!(length > 0.0)) {
            continue;
        }
        se3di_scale(1.0 / length, n, n);
        cut_side(from, n, se3di_dot(n, p), slack, (uint32_t)k, to);
        cut *other = from;
        from = to;
        to = other;
    }
    const uint32_t faces = (reference->id * 8191u + incident->id) * 2u + (uint32_t)(flip != 0);
    for (int k = 0; k < from->count; ++k) {
        double d[3], point[3], normal[3];
        se3di_sub(reference->corner[0], from->corner[k], d);
        double overlap = se3di_dot(d, reference->normal) / lean + radius;
        overlap = depth < rounding && overlap > -rounding ? depth : overlap;
        if (!(overlap > 0.0)) {
            continue;
        }
        se3di_copy(from->corner[k], point);
        se3di_add_scaled(0.5 * overlap - radius, along, point);
        se3di_scale(flip ? -1.0 : 1.0, along, normal);
        se3di_contact_point *p =
            se3di_manifold_add(manifold, point, normal, overlap, faces * 1024u + from->id[k]);
        se3di_face_bend(incident, radius, flip ? &p->bend_i : &p->bend_j);
    }
}
