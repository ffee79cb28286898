/* SPDX-License-Identifier: BSD-3-Clause */
/* Gears as discs with teeth, racks as bars with teeth.
 *
 * Pitch radii follow from the ratio and from where the axes are: of parallel axes from their
 * distance (a ring with teeth inside where both turn in one sense), of axes that meet from the
 * angle between them (bevel gears, whose pitch cones have their tips there). Other pairs, and gears
 * on one axis, have no radii of their own and are not drawn. Teeth mesh at the first pose: one is
 * where the two circles touch, and a gap of the other. */
#include <math.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/base/pool.h"
#include "io/base/rotation.h"
#include "io/document/document.h"
#include "io/model/mesh.h"
#include "io/write/drawing_part.h"

enum { TEETH_LEAST = 14, TEETH_USUAL = 30, TEETH_MOST = 240, CORNERS = 4 };

static const double pi = 3.14159265358979323846;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int i = 0; i < 3; ++i) {
        c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

/* @return the length that it had. */
static double normalise(double v[3])
{
    const double length = sqrt(dot(v, v));
    for (int i = 0; i < 3 && length > 0.0; ++i) {
        v[i] /= length;
    }
    return length;
}

/* One of the two joints of a pair, at the first pose. */
typedef struct half {
    size_t body;    /* that has the wheel or rack */
    double r[3];    /* point of the joint, ground frame */
    double axis[3]; /* unit, ground frame */
    double sense;   /* -1: the coordinate counts its motion the other way round */
    double ratio;   /* its factor in the equation of the pair */
    int32_t coordinate;
} half;

/* Teeth of one wheel: local z along its axis, x to where it touches the other. */
typedef struct wheel {
    size_t body;
    double center[3], x[3], z[3]; /* ground frame, first pose */
    double radius;                /* of the pitch circle */
    double module;                /* 2 radius / teeth */
    int teeth;
    bool has_gap; /* where it touches, not a tooth */
    bool is_ring;
    double width; /* along z */
    double taper; /* how large the end at -z is, of that at z */
} wheel;

static const double *first_pose(const se3di_lister *l, size_t body)
{
    return l->poses->values + SE3DI_POSE * body;
}

/* The joint of a term of the pair. @return false: it has no point or no axis. */
static bool find_half(const se3di_lister *l, const se3d_coupler_def *def, size_t term, half *h)
{
    const se3d_model *model = l->model;
    const se3di_element_entry *joint = NULL;
    double A[9];
    for (size_t e = 0; e < model->element_count && !joint; ++e) {
        const se3di_element_entry *entry = &model->elements[e];
        if (entry->kind == SE3DI_ELEMENT_JOINT && entry->drawn == 2 &&
            entry->constraint.index1 == def->joint[term].index1) {
            joint = entry;
        }
    }
    if (!joint) {
        return false;
    }
    /* A wheel is on the body that turns, not on the ground. */
    const bool is_j = !se3di_drawing_is_body(model, 0, joint->body_j);
    const double *axis = is_j ? joint->axis_j : joint->axis_i;
    h->body = se3di_drawing_find_body(model, is_j ? joint->body_j : joint->body_i);
    h->sense = (is_j ? 1.0 : -1.0) * (joint->is_turned ? -1.0 : 1.0);
    h->ratio = def->ratio[term];
    h->coordinate = def->coordinate[term];
    se3di_drawing_to_ground(first_pose(l, h->body), is_j ? joint->point_j : joint->point_i, h->r);
    se3di_rotation_to_matrix(first_pose(l, h->body) + 3, A);
    for (int i = 0; i < 3; ++i) {
        h->axis[i] = dot(A + (size_t)(3 * i), axis);
    }
    return normalise(h->axis) > 0.0;
}

/* How many teeth two wheels have whose radii are as 1 to `ratio` >= 1. */
static void count_teeth(double ratio, int *few, int *many)
{
    double best = HUGE_VAL;
    for (int z = TEETH_LEAST; z <= TEETH_USUAL; ++z) {
        const double other = fmin(TEETH_MOST, z * ratio);
        const double off = fabs(other - floor(other + 0.5)) / other;
        if (off < best - 1e-9) {
            best = off;
            *few = z;
            *many = (int)floor(other + 0.5);
        }
    }
}

static void set_teeth(wheel w[2])
{
    const int large = w[0].radius > w[1].radius ? 0 : 1;
    count_teeth(w[large].radius / w[1 - large].radius, &w[1 - large].teeth, &w[large].teeth);
    for (int k = 0; k < 2; ++k) {
        w[k].module = 2.0 * w[1 - large].radius / w[1 - large].teeth;
    }
    w[1].has_gap = true;
}

/* Axes that are parallel. q: radius of the first over that of the second, < 0: one is a ring. */
static bool set_parallel(const half h[2], double q, double pin, wheel w[2])
{
    double way[3];
    for (int i = 0; i < 3; ++i) {
        way[i] = h[1].r[i] - h[0].r[i];
    }
    const double along = dot(way, h[0].axis);
    for (int i = 0; i < 3; ++i) {
        way[i] -= along * h[0].axis[i];
    }
    const double distance = normalise(way);
    const double over = q > 0.0 ? 1.0 + q : fabs(1.0 + q);
    if (!(distance > pin) || over < 0.02) {
        return false;
    }
    w[0].radius = distance * fabs(q) / over;
    w[1].radius = distance / over;
    const double narrow = fmin(w[0].radius, w[1].radius);
    for (int k = 0; k < 2; ++k) {
        w[k].width = fmin(3.0 * pin, 0.6 * narrow);
        w[k].taper = 1.0;
        w[k].is_ring = q < 0.0 && w[k].radius > w[1 - k].radius;
        /* The circles touch between the centres, or beyond that of the smaller one. */
        const double to = q > 0.0 ? (k == 0 ? 1.0 : -1.0) : w[0].radius > w[1].radius ? 1.0 : -1.0;
        for (int i = 0; i < 3; ++i) {
            w[k].center[i] = h[k].r[i] - (k == 1 ? along * h[0].axis[i] : 0.0);
            w[k].x[i] = to * way[i];
            w[k].z[i] = h[0].axis[i];
        }
    }
    return true;
}

/* The point where two axes meet. @return false: they do not. */
static bool find_meeting(const half h[2], double pin, double at[3])
{
    const double c = dot(h[0].axis, h[1].axis);
    double way[3];
    double square = 0.0;
    for (int i = 0; i < 3; ++i) {
        way[i] = h[1].r[i] - h[0].r[i];
    }
    const double s = (dot(way, h[0].axis) - c * dot(way, h[1].axis)) / (1.0 - c * c);
    const double t = (c * dot(way, h[0].axis) - dot(way, h[1].axis)) / (1.0 - c * c);
    for (int i = 0; i < 3; ++i) {
        const double a = h[0].r[i] + s * h[0].axis[i];
        const double b = h[1].r[i] + t * h[1].axis[i];
        at[i] = 0.5 * (a + b);
        square += (a - b) * (a - b);
    }
    return sqrt(square) < 0.5 * pin;
}

/* Axes that meet; sense: > 0 if the first drives as the joints say, < 0: from behind the tip. */
static bool set_bevel(const half h[2], double q, double pin, wheel w[2])
{
    double tip[3], u[2][3], far[2], away[2];
    if (!find_meeting(h, pin, tip)) {
        return false;
    }
    for (int k = 0; k < 2; ++k) {
        for (int i = 0; i < 3; ++i) {
            u[k][i] = h[k].r[i] - tip[i];
        }
        far[k] = fabs(dot(u[k], h[k].axis));
        const double to = dot(u[k], h[k].axis) < 0.0 ? -1.0 : 1.0;
        for (int i = 0; i < 3; ++i) {
            u[k][i] = to * h[k].axis[i];
        }
    }
    const double c = dot(u[0], u[1]);
    away[0] = io_atan2(sqrt(1.0 - c * c), 1.0 / fabs(q) + c); /* half angles of the cones */
    away[1] = io_atan2(sqrt(1.0 - c * c), fabs(q) + c);
    double length = HUGE_VAL;
    for (int k = 0; k < 2; ++k) {
        if (far[k] > pin && io_cos(away[k]) > 0.05) {
            length = fmin(length, far[k] / io_cos(away[k]));
        }
    }
    if (!(length < HUGE_VAL)) {
        return false;
    }
    for (int k = 0; k < 2; ++k) {
        /* Beyond a right angle the narrow end is the upper one; a flat crown has some height. */
        const double high = length * io_cos(away[k]);
        w[k].radius = length * io_sin(away[k]);
        w[k].taper = 0.75;
        w[k].width = copysign(fmax((1.0 - w[k].taper) * fabs(high), 0.06 * length), high);
        for (int i = 0; i < 3; ++i) {
            w[k].center[i] = tip[i] + (high - 0.5 * w[k].width) * u[k][i];
            w[k].x[i] = u[1 - k][i] - c * u[k][i];
            w[k].z[i] = u[k][i];
        }
        normalise(w[k].x);
    }
    return true;
}

/* Place and pitch circles of a pair of gears. @return false: they cannot be drawn. */
static bool set_gears(const se3di_lister *l, const half h[2], wheel w[2])
{
    const double c = dot(h[0].axis, h[1].axis);
    const bool parallel = fabs(c) > 0.999;
    const double ratio = h[0].ratio / h[1].ratio;
    const double q = parallel ? ratio * h[0].sense * h[1].sense * (c < 0.0 ? -1.0 : 1.0) : ratio;
    if (!(fabs(q) > 1e-3 && fabs(q) < 1e3)) {
        return false;
    }
    w[0].body = h[0].body;
    w[1].body = h[1].body;
    const double pin = l->sizes->radius;
    if (!(parallel ? set_parallel(h, q, pin, w) : set_bevel(h, q, pin, w))) {
        return false;
    }
    set_teeth(w);
    return true;
}

/* The outline of teeth: corner `k` of CORNERS of every tooth, about its middle, in parts of the
 * distance to the next one; and whether it is at the tip. */
static const double corner_at[CORNERS] = {-0.30, -0.12, 0.12, 0.30};

static bool is_tip(size_t k)
{
    return k % CORNERS == 1 || k % CORNERS == 2;
}

static se3di_mesh *make_mesh(se3di_lister *l, size_t points, size_t triangles)
{
    se3di_mesh *mesh = se3di_iopool_alloc(l->pool, sizeof *mesh);
    if (mesh) {
        mesh->points = se3di_iopool_array(l->pool, points, 3 * sizeof *mesh->points);
        mesh->triangles = se3di_iopool_array(l->pool, triangles, 3 * sizeof *mesh->triangles);
    }
    if (!mesh || !mesh->points || !mesh->triangles) {
        l->failed = true;
        return NULL;
    }
    return mesh;
}

static void put_point(se3di_mesh *mesh, double x, double y, double z)
{
    double *p = mesh->points + 3 * mesh->point_count++;
    p[0] = x;
    p[1] = y;
    p[2] = z;
}

static void put_quad(se3di_mesh *mesh, size_t a, size_t b, size_t c, size_t d)
{
    const uint32_t corners[6] = {(uint32_t)a, (uint32_t)b, (uint32_t)c,
                                 (uint32_t)a, (uint32_t)c, (uint32_t)d};
    memcpy(mesh->triangles + 3 * mesh->triangle_count, corners, sizeof corners);
    mesh->triangle_count += 2;
}

/* Four rows of `n` points, the outline and what is behind it, above and below, closed to a ring or
 * not: what lies between them. */
static void put_walls(se3di_mesh *mesh, size_t n, bool closed)
{
    for (size_t k = 0; k + (closed ? 0 : 1) < n; ++k) {
        const size_t next = (k + 1) % n;
        put_quad(mesh, k, next, n + next, n + k);                         /* above */
        put_quad(mesh, 2 * n + next, 2 * n + k, 3 * n + k, 3 * n + next); /* below */
        put_quad(mesh, next, k, 2 * n + k, 2 * n + next);                 /* teeth */
        put_quad(mesh, n + k, n + next, 3 * n + next, 3 * n + k);         /* behind them */
    }
}

/* A disc with a hole where its pin is, or a ring, with teeth outside or inside. */
static const se3di_mesh *make_disc(se3di_lister *l, const wheel *w)
{
    const size_t n = (size_t)w->teeth * CORNERS;
    const double step = 2.0 * pi / w->teeth;
    const double out = w->is_ring ? -1.0 : 1.0;
    const double behind = w->is_ring ? w->radius + 3.5 * w->module : 0.3 * w->radius;
    se3di_mesh *mesh = make_mesh(l, 4 * n, 8 * n);
    for (size_t k = 0; mesh && k < 4 * n; ++k) {
        const size_t place = k % n;
        const bool below = k >= 2 * n;
        const double size = below ? w->taper : 1.0;
        const size_t tooth = place / CORNERS;
        const double angle =
            step * ((double)tooth + corner_at[place % CORNERS] + (w->has_gap ? 0.5 : 0.0));
        const double teeth = w->radius + out * (is_tip(place) ? 1.0 : -1.2) * w->module;
        const double r = size * (k / n % 2 == 0 ? teeth : behind);
        put_point(mesh, r * io_cos(angle), r * io_sin(angle), (below ? -0.5 : 0.5) * w->width);
    }
    if (mesh) {
        put_walls(mesh, n, true);
    }
    const bool is_inside_out = w->is_ring != (w->width < 0.0);
    for (size_t k = 0; is_inside_out && mesh && k < mesh->triangle_count; ++k) {
        uint32_t *t = mesh->triangles + 3 * k;
        const uint32_t held = t[1];
        t[1] = t[2];
        t[2] = held;
    }
    return mesh;
}

/* A bar along x with teeth towards -y, its pitch line y = 0. A very long one has every second,
 * third ... tooth. */
static const se3di_mesh *make_rack(se3di_lister *l, const wheel *w, const double range[2])
{
    const double pitch = pi * w->module;
    const double step = pitch * fmax(1.0, ceil((range[1] - range[0]) / (pitch * (TEETH_MOST - 1))));
    const double first = floor(range[0] / step), last = ceil(range[1] / step);
    const size_t n = (size_t)(last - first) * CORNERS;
    se3di_mesh *mesh = make_mesh(l, 4 * n, 8 * n);
    for (size_t k = 0; mesh && k < 4 * n; ++k) {
        const size_t place = k % n;
        const size_t tooth = place / CORNERS;
        const double teeth = (is_tip(place) ? -1.0 : 1.2) * w->module;
        put_point(mesh, step * (first + (double)tooth) + pitch * (corner_at[place % CORNERS] + 0.5),
                  k / n % 2 == 0 ? teeth : 3.0 * w->module, (k >= 2 * n ? -0.5 : 0.5) * w->width);
    }
    if (mesh) {
        put_walls(mesh, n, false);
    }
    return mesh;
}

/* A part on l->body with local x and z as given in the ground frame at the first pose. */
static void add_mesh(se3di_lister *l, size_t element, const se3di_mesh *mesh, const wheel *w,
                     const char *name)
{
    const double *pose = first_pose(l, w->body);
    double y[3], A[9], d[3], p[3][3];
    se3di_part part = se3di_part_make(name, SE3DI_UNIT_BOX, l->usual);
    const double *axes[3] = {w->x, y, w->z};
    if (!mesh) {
        return;
    }
    cross(w->z, w->x, y);
    for (int i = 0; i < 3; ++i) {
        d[i] = w->center[i] - pose[i];
        se3di_rotation_apply_inverse(pose + 3, axes[i], p[i]);
    }
    for (int i = 0; i < 9; ++i) {
        A[i] = p[i % 3][i / 3];
    }
    se3di_rotation_apply_inverse(pose + 3, d, part.position);
    se3di_rotation_from_matrix(A, part.orientation);
    part.mesh = mesh;
    part.element1 = element + 1;
    se3di_lister_add(l, &part);
}

/* How far along the rack the pinion comes, from where it is at the first pose. */
static void find_travel(const se3di_lister *l, const wheel *pinion, const wheel *rack,
                        double range[2])
{
    const se3di_poses *poses = l->poses;
    double local[3], d[3], still = 0.0;
    for (int i = 0; i < 3; ++i) {
        d[i] = pinion->center[i] - first_pose(l, pinion->body)[i];
    }
    se3di_rotation_apply_inverse(first_pose(l, pinion->body) + 3, d, local);
    double along[3];
    se3di_rotation_apply_inverse(first_pose(l, rack->body) + 3, rack->x, along);
    range[0] = range[1] = 0.0;
    for (size_t k = 0; k < poses->count; k += 1 + poses->count / 256) {
        const double *at = poses->values + k * poses->bodies * SE3DI_POSE;
        double point[3], in_rack[3];
        se3di_drawing_to_ground(at + SE3DI_POSE * pinion->body, local, point);
        for (int i = 0; i < 3; ++i) {
            point[i] -= at[SE3DI_POSE * rack->body + (size_t)i];
        }
        se3di_rotation_apply_inverse(at + SE3DI_POSE * rack->body + 3, point, in_rack);
        still = k == 0 ? dot(in_rack, along) : still;
        range[0] = fmin(range[0], dot(in_rack, along) - still);
        range[1] = fmax(range[1], dot(in_rack, along) - still);
    }
    const double beside = poses->count > 1 ? 2.0 : 8.0; /* how far it goes is not known */
    range[0] -= beside * pinion->radius;
    range[1] += beside * pinion->radius;
}

static void add_rack(se3di_lister *l, size_t element, const half h[2])
{
    const int turning = h[0].coordinate == SE3D_JOINT_COORDINATE_ANGLE ? 0 : 1;
    const half *pinion = &h[turning], *rack = &h[1 - turning];
    const double radius = -pinion->ratio / rack->ratio * pinion->sense * rack->sense;
    double out[3], range[2];
    wheel w[2] = {{.body = pinion->body}, {.body = rack->body}};
    cross(rack->axis, pinion->axis, out);
    if (fabs(dot(rack->axis, pinion->axis)) > 0.2 || !(fabs(radius) > 0.0)) {
        return; /* it is no pinion on a rack that one could see */
    }
    normalise(out);
    for (int k = 0; k < 2; ++k) {
        w[k].radius = fabs(radius);
        w[k].teeth = TEETH_LEAST + 4;
        w[k].module = 2.0 * w[k].radius / w[k].teeth;
        w[k].width = fmin(4.0 * l->sizes->radius, 1.2 * w[k].radius);
        w[k].taper = 1.0;
        for (int i = 0; i < 3; ++i) {
            const double to = radius < 0.0 ? -out[i] : out[i];
            w[k].center[i] = pinion->r[i] + k * w[k].radius * to;
            w[k].x[i] = k == 0 ? to : rack->axis[i];
            w[k].z[i] = pinion->axis[i];
        }
    }
    /* y of the rack is away from the pinion: z x x. */
    double y[3], away[3];
    cross(w[1].z, w[1].x, y);
    for (int i = 0; i < 3; ++i) {
        away[i] = w[1].center[i] - pinion->r[i];
    }
    for (int i = 0; i < 3 && dot(y, away) < 0.0; ++i) {
        w[1].z[i] = -pinion->axis[i];
    }
    const double along = dot(w[1].z, w[1].x);
    for (int i = 0; i < 3; ++i) {
        w[1].z[i] -= along * w[1].x[i];
    }
    normalise(w[1].z);
    if (pinion->body == l->body) {
        add_mesh(l, element, make_disc(l, &w[0]), &w[0], "gear");
    }
    if (rack->body == l->body) {
        find_travel(l, &w[0], &w[1], range);
        add_mesh(l, element, make_rack(l, &w[1], range), &w[1], l->model->elements[element].name);
    }
}

static void add_gears(se3di_lister *l, size_t element, const half h[2])
{
    wheel w[2] = {{0}, {0}};
    if (!set_gears(l, h, w)) {
        return;
    }
    for (int k = 0; k < 2; ++k) {
        if (h[k].body == l->body) {
            add_mesh(l, element, make_disc(l, &w[k]), &w[k],
                     k == 0 ? "gear" : l->model->elements[element].name);
        }
    }
}

void se3di_lister_add_gears(se3di_lister *l)
{
    const se3d_model *model = l->model;
    for (size_t e = 0; e < model->element_count && !l->failed; ++e) {
        const se3di_element_entry *entry = &model->elements[e];
        const se3di_node *type = entry->kind == SE3DI_ELEMENT_JOINT && entry->node
                                     ? se3di_node_get(entry->node, "type")
                                     : NULL;
        const bool is_gear = type && type->text && strcmp(type->text, "gear") == 0;
        const bool is_rack = type && type->text && strcmp(type->text, "rack_pinion") == 0;
        se3d_coupler_def def = {.struct_size = sizeof def};
        half h[2];
        if ((!is_gear && !is_rack) ||
            SE3D_FAILED(se3d_coupler_get_def(model->system, entry->constraint, &def)) ||
            def.count != 2 || !find_half(l, &def, 0, &h[0]) || !find_half(l, &def, 1, &h[1])) {
            continue;
        }
        if (is_gear) {
            add_gears(l, e, h);
        } else {
            add_rack(l, e, h);
        }
    }
}
