/* SPDX-License-Identifier: BSD-3-Clause */
/* Roads under tyres: the part of each that the wheels come over, as a surface of triangles.
 *
 * The surface has lines along x and y only where it bends: of heights that are taken at many places
 * the lines are left out between which straight ones are near enough (D. H. Douglas and T. K.
 * Peucker, Cartographica 10, 1973, 112-122), so that a kerb keeps its faces and a plane is one
 * square. A road that rises and sinks as a whole is drawn as it is first, and moved. */
#include <math.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/base/rotation.h"
#include "io/document/document.h"
#include "io/model/mesh.h"
#include "io/write/drawing_part.h"

enum { FINE_X = 1025, FINE_Y = 257, COARSE = 33, CELLS_MOST = 6000 };

/* Of light: asphalt. */
static const double asphalt[3] = {0.13, 0.135, 0.145};

/* The frame of a road, and what the wheels need of it. */
typedef struct strip {
    se3di_lister *l;
    const se3di_element_entry *owner; /* the road, or the first tyre on a plane */
    size_t body;
    double axes[9]; /* rows: forward, left, up, in the frame of the body */
    double low[2], high[2];
    double time; /* at which its heights are taken */
} strip;

static bool is_tyre(const se3di_element_entry *entry)
{
    const se3di_node *type = entry->node ? se3di_node_get(entry->node, "type") : NULL;
    return entry->kind == SE3DI_ELEMENT_FORCE && type && type->text &&
           strcmp(type->text, "tyre") == 0;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Whether a tyre runs on the surface of `owner`. */
static bool is_on(const se3di_element_entry *owner, const se3di_element_entry *tyre)
{
    const double *n = owner->axis_i;
    const double *m = tyre->axis_i;
    double d[3];
    if (!is_tyre(tyre)) {
        return false;
    }
    if (owner->road.index1 > 0 || tyre->road.index1 > 0) {
        return owner->road.index1 == tyre->road.index1;
    }
    for (int i = 0; i < 3; ++i) {
        d[i] = tyre->point_i[i] - owner->point_i[i];
    }
    const double size = sqrt(dot(n, n) * dot(m, m));
    return owner->body_i.index1 == tyre->body_i.index1 && dot(n, m) > (1.0 - 1e-9) * size &&
           fabs(dot(d, n)) <= 1e-9 * sqrt(dot(n, n)) * (1.0 + sqrt(dot(d, d)));
}

/* x as far as it is not along z, then y. */
static void find_axes(strip *s)
{
    const double *n = s->owner->axis_i;
    const double *f = s->owner->axis_j;
    const bool is_given = s->owner->kind == SE3DI_ELEMENT_ROAD;
    const double size = sqrt(dot(n, n));
    double forward[3] = {1.0, 0.0, 0.0};
    double *x = s->axes, *y = s->axes + 3, *z = s->axes + 6;
    for (int i = 0; i < 3; ++i) {
        z[i] = size > 0.0 ? n[i] / size : (double)(i == 2);
        forward[i] = is_given ? f[i] : forward[i];
    }
    if (!is_given && fabs(z[0]) > 0.9) {
        forward[0] = 0.0;
        forward[1] = 1.0;
    }
    const double along = dot(forward, z);
    for (int i = 0; i < 3; ++i) {
        x[i] = forward[i] - along * z[i];
    }
    const double length = sqrt(dot(x, x));
    for (int i = 0; i < 3; ++i) {
        x[i] /= length;
    }
    for (int i = 0; i < 3; ++i) {
        y[i] = z[(i + 1) % 3] * x[(i + 2) % 3] - z[(i + 2) % 3] * x[(i + 1) % 3];
    }
}

/* A place of a wheel in the frame of the road. */
static void to_road(const strip *s, const double *poses, const se3di_element_entry *tyre,
                    double at[3])
{
    const double *pose = poses + SE3DI_POSE * s->body;
    const size_t wheel = se3di_drawing_find_body(s->l->model, tyre->body);
    double r[3];
    double local[3];
    se3di_drawing_to_ground(poses + SE3DI_POSE * wheel, tyre->point, r);
    for (int i = 0; i < 3; ++i) {
        r[i] -= pose[i];
    }
    se3di_rotation_apply_inverse(pose + 3, r, local);
    for (int i = 0; i < 3; ++i) {
        local[i] -= s->owner->point_i[i];
    }
    for (int i = 0; i < 3; ++i) {
        at[i] = dot(s->axes + (size_t)(3 * i), local);
    }
}

/* The rectangle around all places of the wheels, wider by what they are high; wide about a single
 * pose. @return false: no wheel is on it. */
static bool find_extent(strip *s)
{
    const se3d_model *model = s->l->model;
    const se3di_poses *poses = s->l->poses;
    const double beside = poses->count > 1 ? 2.0 : 12.0;
    bool found = false;
    for (size_t e = 0; e < model->element_count; ++e) {
        for (size_t k = 0; k < poses->count && is_on(s->owner, &model->elements[e]);
             k += 1 + poses->count / 256) {
            double at[3];
            to_road(s, poses->values + k * poses->bodies * SE3DI_POSE, &model->elements[e], at);
            const double wide = beside * fmax(fabs(at[2]), s->l->sizes->radius);
            for (int i = 0; i < 2; ++i) {
                s->low[i] = found ? fmin(s->low[i], at[i] - wide) : at[i] - wide;
                s->high[i] = found ? fmax(s->high[i], at[i] + wide) : at[i] + wide;
            }
            found = true;
        }
    }
    return found;
}

/* A height that is a function; NaN: there is none. */
static double eval_height(const se3d_model *model, se3d_function f, double time, const double at[2])
{
    const double txy[3] = {time, at[0], at[1]};
    double height[4] = {0.0, 0.0, 0.0, 0.0};
    return se3d_function_eval(model->system, f, txy, height) < 0 ? (double)NAN : height[0];
}

/* z at the time of the strip; NaN: there is no road. */
static double get_height(const strip *s, const double at[2])
{
    double height[4]; /* and its derivatives */
    if (s->owner->road.index1 == 0) {
        return 0.0;
    }
    if (s->owner->height.index1 > 0) {
        return eval_height(s->l->model, s->owner->height, s->time, at);
    }
    return se3d_road_get_height(s->l->model->system, s->owner->road, at[0], at[1], height) < 0
               ? (double)NAN
               : height[0];
}

/* Heights along axis `a` at `fine` places, each at COARSE places across; and how they differ:
 * negative if there are none. */
static double *take_heights(const strip *s, int a, size_t fine, double *spread)
{
    double *z = se3di_iopool_array(s->l->pool, fine * COARSE, sizeof *z);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (size_t k = 0; z && k < fine * COARSE; ++k) {
        const size_t along = k / COARSE, across = k % COARSE;
        const double part[2] = {(double)along / (double)(fine - 1),
                                (double)across / (double)(COARSE - 1)};
        double at[2];
        for (int i = 0; i < 2; ++i) {
            at[i] = s->low[i] + part[i == a ? 0 : 1] * (s->high[i] - s->low[i]);
        }
        z[k] = get_height(s, at);
        low = fmin(low, z[k]);
        high = fmax(high, z[k]);
    }
    *spread = high >= low ? fmax(*spread, high - low) : *spread;
    return z;
}

/* The place between two lines that is farthest from a straight one; an end of the road is as far as
 * `most`. */
static size_t find_farthest(const double *z, size_t from, size_t to, double most, double *distance)
{
    size_t best = from;
    *distance = 0.0;
    for (size_t k = from + 1; k < to; ++k) {
        const double part = (double)(k - from) / (double)(to - from);
        for (size_t c = 0; c < COARSE; ++c) {
            const bool is_end = isnan(z[k * COARSE + c]) != isnan(z[(k - 1) * COARSE + c]);
            if (is_end && most > *distance) { /* just before it and just behind it */
                *distance = most;
                best = k - 1 > from ? k - 1 : k;
            }
            const double first = z[from * COARSE + c];
            const double off =
                fabs(z[k * COARSE + c] - first - part * (z[to * COARSE + c] - first));
            if (off > *distance) {
                *distance = off;
                best = k;
            }
        }
    }
    return best;
}

/* Mark the lines that are needed for a tolerance. @return their number. */
static size_t choose_lines(const double *z, size_t fine, double tolerance, double most,
                           unsigned char *chosen)
{
    size_t count = 2;
    size_t from = 0;
    memset(chosen, 0, fine);
    chosen[0] = chosen[fine - 1] = 1;
    while (from + 1 < fine) { /* halve what comes next until it is straight */
        double distance = 0.0;
        size_t to = from + 1;
        while (!chosen[to]) {
            ++to;
        }
        const size_t best = find_farthest(z, from, to, most, &distance);
        if (distance > tolerance && best > from) {
            chosen[best] = 1;
            ++count;
        } else {
            from = to;
        }
    }
    return count;
}

typedef struct lines {
    unsigned char chosen[2][FINE_X];
    size_t fine[2], count[2];
} lines;

/* @return false: it has no heights at all, or out of memory. */
static bool find_lines(const strip *s, lines *w)
{
    double spread = -1.0;
    double *z[2];
    w->fine[0] = FINE_X;
    w->fine[1] = FINE_Y;
    for (int a = 0; a < 2; ++a) {
        z[a] = take_heights(s, a, w->fine[a], &spread);
        if (!z[a]) {
            s->l->failed = true;
            return false;
        }
    }
    if (spread < 0.0) {
        return false;
    }
    double tolerance = fmax(0.003 * spread, 1e-9 * s->l->sizes->extent);
    const double most = 300.0 * tolerance;
    do {
        for (int a = 0; a < 2; ++a) {
            w->count[a] = choose_lines(z[a], w->fine[a], tolerance, most, w->chosen[a]);
        }
        tolerance *= 1.5;
    } while (w->count[0] * w->count[1] > CELLS_MOST);
    return true;
}

static void list_lines(const strip *s, const lines *w, int a, double *at)
{
    size_t n = 0;
    for (size_t k = 0; k < w->fine[a]; ++k) {
        if (w->chosen[a][k]) {
            const double part = (double)k / (double)(w->fine[a] - 1);
            at[n++] = s->low[a] + part * (s->high[a] - s->low[a]);
        }
    }
}

/* Between points that all have heights; the others become some that have. */
static void put_triangles(se3di_mesh *mesh, size_t columns, size_t rows)
{
    double height = 0.0;
    for (size_t i = 0; i + 1 < rows; ++i) {
        for (size_t j = 0; j + 1 < columns; ++j) {
            const uint32_t a = (uint32_t)(i * columns + j);
            const uint32_t b = a + (uint32_t)columns;
            const uint32_t corners[6] = {a, a + 1, b + 1, a, b + 1, b};
            bool is_whole = true;
            for (int k = 0; k < 6; ++k) {
                is_whole = is_whole && !isnan(mesh->points[3 * corners[k] + 2]);
            }
            if (is_whole) {
                memcpy(mesh->triangles + 3 * mesh->triangle_count, corners, sizeof corners);
                mesh->triangle_count += 2;
                height = mesh->points[3 * a + 2];
            }
        }
    }
    for (size_t k = 0; k < columns * rows; ++k) {
        double *z = &mesh->points[3 * k + 2];
        *z = isnan(*z) ? height : *z;
    }
}

/* The surface between the lines. NULL: out of memory, or no heights. */
static const se3di_mesh *make_surface(strip *s)
{
    se3di_iopool *pool = s->l->pool;
    lines *w = se3di_iopool_alloc(pool, sizeof *w);
    se3di_mesh *mesh = se3di_iopool_alloc(pool, sizeof *mesh);
    double *at = se3di_iopool_array(pool, FINE_X + FINE_Y, sizeof *at);
    if (!w || !mesh || !at) {
        s->l->failed = true;
        return NULL;
    }
    if (!find_lines(s, w)) {
        return NULL;
    }
    const size_t columns = w->count[0], rows = w->count[1];
    double *x = at, *y = at + columns;
    list_lines(s, w, 0, x);
    list_lines(s, w, 1, y);
    mesh->point_count = columns * rows;
    mesh->points = se3di_iopool_array(pool, mesh->point_count, 3 * sizeof *mesh->points);
    mesh->triangles =
        se3di_iopool_array(pool, 2 * (columns - 1) * (rows - 1), 3 * sizeof *mesh->triangles);
    if (!mesh->points || !mesh->triangles) {
        s->l->failed = true;
        return NULL;
    }
    for (size_t k = 0; k < mesh->point_count; ++k) {
        double *p = mesh->points + 3 * k;
        p[0] = x[k % columns];
        p[1] = y[k / columns];
        p[2] = get_height(s, p);
    }
    put_triangles(mesh, columns, rows);
    return mesh->triangle_count > 0 ? mesh : NULL;
}

static bool has_heights(const se3di_element_entry *entry)
{
    return entry->kind == SE3DI_ELEMENT_ROAD && entry->height.index1 > 0;
}

static void set_rise(const strip *s, size_t index, se3di_rise *rise)
{
    rise->height = s->owner->height;
    rise->tolerance = s->l->sizes->extent;
    rise->index = index;
    for (int k = 0; k < 3; ++k) {
        rise->places[k][0] = s->low[0] + 0.37 * k * (s->high[0] - s->low[0]);
        rise->places[k][1] = s->low[1] + 0.41 * k * (s->high[1] - s->low[1]);
        rise->first[k] = get_height(s, rise->places[k]);
    }
}

/* @return whether it has changed as a whole, by `up`. */
static bool measure_rise(const se3d_model *model, const se3di_rise *rise, double time, double *up)
{
    bool found = false;
    *up = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double now = eval_height(model, rise->height, time, rise->places[k]) - rise->first[k];
        if (isnan(now)) {
            continue;
        }
        if (found && fabs(now - *up) > 1e-6 * (fabs(now) + rise->tolerance)) {
            *up = 0.0;
            return false;
        }
        *up = now;
        found = true;
    }
    return true;
}

double se3di_rise_get(const se3d_model *model, const se3di_rise *rise, double time)
{
    double up = 0.0;
    if (rise->height.index1 > 0) {
        (void)measure_rise(model, rise, time, &up);
    }
    return up;
}

/* How far the road has risen at every sample since the first; NULL: it stands still, or changes its
 * form. */
static double *find_lift(const strip *s, const se3di_rise *rise)
{
    const se3di_poses *poses = s->l->poses;
    bool rises = false;
    if (!rise || !poses->times || poses->count < 2) {
        return NULL;
    }
    double *lift = se3di_iopool_array(s->l->pool, poses->count, sizeof *lift);
    if (!lift) {
        s->l->failed = true;
        return NULL;
    }
    for (size_t k = 0; k < poses->count; ++k) {
        if (!measure_rise(s->l->model, rise, poses->times[k], &lift[k])) {
            return NULL;
        }
        rises = rises || fabs(lift[k]) > 0.0;
    }
    return rises ? lift : NULL;
}

/* Place and time of a strip. @return false: no wheel is on it. */
static bool begin_strip(strip *s)
{
    find_axes(s);
    s->time = s->l->poses->times ? s->l->poses->times[0] : 0.0;
    if (!s->l->poses->times) {
        (void)se3d_system_get_time(s->l->model->system, &s->time);
    }
    return find_extent(s);
}

static void add_surface(strip *s, size_t index)
{
    double A[9];
    se3di_part part = se3di_part_make("road", SE3DI_UNIT_BOX, asphalt);
    if (!begin_strip(s)) {
        return;
    }
    part.mesh = s->owner->surface ? s->owner->surface : make_surface(s);
    if (!part.mesh) {
        return;
    }
    if (has_heights(s->owner)) {
        se3di_rise *rise = se3di_iopool_alloc(s->l->pool, sizeof *rise);
        if (!rise) {
            s->l->failed = true;
            return;
        }
        set_rise(s, index, rise);
        part.rise = rise;
    }
    for (int i = 0; i < 9; ++i) {
        A[i] = s->axes[3 * (i % 3) + i / 3];
    }
    se3di_rotation_from_matrix(A, part.orientation);
    memcpy(part.position, s->owner->point_i, sizeof part.position);
    memcpy(part.along, s->axes + 6, sizeof part.along);
    part.style = SE3DI_STYLE_SAND;
    part.lift = find_lift(s, part.rise);
    se3di_lister_add(s->l, &part);
}

size_t se3di_drawing_count_rises(const se3d_model *model)
{
    size_t count = 0;
    for (size_t e = 0; e < model->element_count; ++e) {
        count += has_heights(&model->elements[e]);
    }
    return count;
}

void se3di_drawing_list_rises(const se3d_model *model, const se3di_sizes *sizes,
                              const se3di_poses *poses, se3di_rise *rises)
{
    static const se3di_rise still;
    size_t count = 0;
    for (size_t e = 0; e < model->element_count; ++e) {
        const se3di_element_entry *entry = &model->elements[e];
        if (!has_heights(entry)) {
            continue;
        }
        se3di_lister l = {.model = model, .sizes = sizes, .poses = poses};
        strip s = {.l = &l, .owner = entry, .body = se3di_drawing_find_body(model, entry->body_i)};
        rises[count] = still;
        if (begin_strip(&s)) {
            set_rise(&s, count, &rises[count]);
        }
        ++count;
    }
}

/* Whether an element before it has the same plane. */
static bool is_drawn_before(const se3d_model *model, size_t e)
{
    for (size_t k = 0; k < e; ++k) {
        if (is_tyre(&model->elements[k]) && is_on(&model->elements[k], &model->elements[e])) {
            return true;
        }
    }
    return false;
}

void se3di_lister_add_roads(se3di_lister *l)
{
    const se3d_model *model = l->model;
    size_t rises = 0;
    for (size_t e = 0; e < model->element_count && !l->failed; ++e) {
        const se3di_element_entry *entry = &model->elements[e];
        const bool is_here = se3di_drawing_is_body(model, l->body, entry->body_i);
        const bool is_road = entry->kind == SE3DI_ELEMENT_ROAD;
        if (is_here && (is_road || (is_tyre(entry) && entry->road.index1 == 0 &&
                                    !is_drawn_before(model, e)))) {
            strip s = {.l = l, .owner = entry, .body = l->body};
            add_surface(&s, rises);
        }
        rises += has_heights(entry);
    }
}
