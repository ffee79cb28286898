/* SPDX-License-Identifier: BSD-3-Clause */
/* A series of VTK files: the surfaces of bodies and the points of particles. */
#include "io/write/vtk.h"

#include <errno.h>
#include <string.h>

#include "io/base/file.h"
#include "io/base/number.h"
#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/model/mesh.h"
#include "io/model/model.h"
#include "io/write/contact_list.h"
#include "io/write/drawing.h"
#include "io/write/particle_list.h"
#include "io/write/unit_mesh.h"
#include "io/write/vtk_file.h"
#include "se3d/bond.h"

enum { PATH_SIZE = 4096, PARTS = 5 };
static const char *const part_names[PARTS] = {"bodies", "grains", "contacts", "fields", "bonds"};

typedef struct surface {
    const double *points;
    const uint32_t *indices; /* of triangles */
    size_t points_count, indices_count;
} surface;

/* A part, and whose it is: a body's, or one between two bodies, as of a spring. */
typedef struct piece {
    se3di_part part;
    size_t body;
    size_t between1; /* which of its element, from 1; 0: of a body */
} piece;

struct se3di_vtk {
    se3d_model *model;
    se3di_iopool *pool;
    const char *path;            /* of the list: ends with .pvd, or with .vtkhdf */
    int compression;             /* 0: none */
    bool is_hdf5;                /* the latter: each part has a list of its own */
    const char *listed;          /* the list, or the first of them */
    const se3d_field_grid *grid; /* NULL: no fields */
    se3di_sizes sizes;
    piece *pieces;
    size_t piece_count, piece_capacity;
    const se3di_unit_mesh *units; /* [SE3DI_UNIT_COUNT] */
    double *poses;                /* of all bodies */
    size_t points_count, triangles_count;
    double *points, *velocities; /* [points_count][3] */
    double *triangles;           /* [triangles_count][3] */
    double *bodies;              /* of every triangle; -1: between two */
    double *times;
    size_t count, capacity;
    int failure; /* errno of the first failure; ENOMEM also if memory is missing */
};

static surface surface_of(const se3di_vtk *vtk, const se3di_part *part)
{
    const se3di_unit_mesh *unit = &vtk->units[part->unit];
    const se3di_mesh *mesh = part->mesh;
    const surface s = {mesh ? mesh->points : unit->points, mesh ? mesh->triangles : unit->indices,
                       mesh ? mesh->point_count : unit->points_count,
                       mesh ? 3 * mesh->triangle_count : unit->indices_count};
    return s;
}

static bool list_pieces(se3di_vtk *vtk, const se3di_part *parts, size_t count, size_t body,
                        size_t between1)
{
    for (size_t k = 0; k < count; ++k) {
        const surface s = surface_of(vtk, &parts[k]);
        piece *grown = se3di_iopool_grow(vtk->pool, vtk->pieces, vtk->piece_count,
                                         &vtk->piece_capacity, sizeof *grown);
        if (!grown) {
            return false;
        }
        vtk->pieces = grown;
        const piece added = {parts[k], body, between1};
        vtk->pieces[vtk->piece_count++] = added;
        vtk->points_count += s.points_count;
        vtk->triangles_count += s.indices_count / 3;
    }
    return true;
}

static bool list_all(se3di_vtk *vtk)
{
    const se3d_model *model = vtk->model;
    const se3di_poses poses = {vtk->poses, model->body_count, 1, NULL};
    for (size_t k = 0; k < model->body_count; ++k) {
        se3di_parts parts = {NULL, 0, 0};
        if (!se3di_drawing_list(model, k, &vtk->sizes, &poses, vtk->pool, &parts) ||
            !list_pieces(vtk, parts.list, parts.count, k, 0)) {
            return false;
        }
    }
    for (size_t e = 0; e < model->element_count; ++e) {
        for (size_t w = 0; w < se3di_drawing_count_between(&model->elements[e]); ++w) {
            const se3di_part part = se3di_drawing_get_between(model, e, w, &vtk->sizes, vtk->poses);
            if (!list_pieces(vtk, &part, 1, 0, w + 1)) {
                return false;
            }
        }
    }
    return true;
}

static void connect(se3di_vtk *vtk)
{
    size_t first = 0;
    size_t corner = 0;
    for (size_t k = 0; k < vtk->piece_count; ++k) {
        const piece *p = &vtk->pieces[k];
        const surface s = surface_of(vtk, &p->part);
        for (size_t i = 0; i < s.indices_count; ++i) {
            vtk->triangles[corner] = (double)(first + s.indices[i]);
            vtk->bodies[corner++ / 3] = p->between1 > 0 ? -1.0 : (double)p->body;
        }
        first += s.points_count;
    }
}

static bool prepare(se3di_vtk *vtk)
{
    se3di_iopool *pool = vtk->pool;
    se3di_unit_mesh *units = se3di_iopool_array(pool, SE3DI_UNIT_COUNT, sizeof *units);
    vtk->poses = se3di_iopool_array(pool, vtk->model->body_count, SE3DI_POSE * sizeof(double));
    if (!units || !vtk->poses) {
        return false;
    }
    for (int k = 0; k < SE3DI_UNIT_COUNT; ++k) {
        se3di_unit_mesh_make(&units[k], (se3di_unit_shape)k);
    }
    vtk->units = units;
    se3di_drawing_get_poses(vtk->model, vtk->poses);
    const se3di_poses poses = {vtk->poses, vtk->model->body_count, 1, NULL};
    se3di_drawing_measure(vtk->model, &poses, &vtk->sizes);
    if (!list_all(vtk)) {
        return false;
    }
    vtk->points = se3di_iopool_array(pool, vtk->points_count + 1, 3 * sizeof(double));
    vtk->velocities = se3di_iopool_array(pool, vtk->points_count + 1, 3 * sizeof(double));
    vtk->triangles = se3di_iopool_array(pool, vtk->triangles_count + 1, 3 * sizeof(double));
    vtk->bodies = se3di_iopool_array(pool, vtk->triangles_count + 1, sizeof(double));
    if (!vtk->points || !vtk->velocities || !vtk->triangles || !vtk->bodies) {
        return false;
    }
    connect(vtk);
    return true;
}

/* "DIR/motion_bodies.vtkhdf.series". */
static bool name_part_list(const se3di_vtk *vtk, int part, char *path)
{
    const int length =
        snprintf(path, PATH_SIZE, "%.*s_%s.vtkhdf.series",
                 (int)(strrchr(vtk->path, '.') - vtk->path), vtk->path, part_names[part]);
    return length > 0 && length < PATH_SIZE;
}

static bool find_listed(se3di_vtk *vtk)
{
    char path[PATH_SIZE];
    vtk->listed =
        name_part_list(vtk, 0, path) ? se3di_iopool_copy(vtk->pool, path, strlen(path)) : NULL;
    return vtk->listed;
}

se3di_vtk *se3di_vtk_open(se3d_model *model, se3di_iopool *pool, const char *path,
                          const se3d_field_grid *grid, int compression)
{
    se3di_vtk *vtk = se3di_iopool_alloc(pool, sizeof *vtk);
    if (!vtk) {
        return NULL;
    }
    vtk->model = model;
    vtk->pool = pool;
    vtk->grid = grid;
    vtk->compression = compression;
    vtk->path = se3di_iopool_copy(pool, path, strlen(path));
    vtk->listed = vtk->path;
    vtk->is_hdf5 = strcmp(strrchr(path, '.'), ".vtkhdf") == 0;
    return vtk->path && (!vtk->is_hdf5 || find_listed(vtk)) && prepare(vtk) ? vtk : NULL;
}

const char *se3di_vtk_get_path(const se3di_vtk *vtk)
{
    return vtk->listed;
}

size_t se3di_vtk_count(const se3di_vtk *vtk)
{
    return vtk->count;
}

/* The points of a part in the frame of its body (a spring's: of the ground), to `local`. */
static void place(const se3di_part *part, const double unit[3], double local[3])
{
    double pose[SE3DI_POSE];
    const double stretched[3] = {unit[0] * part->scale[0], unit[1] * part->scale[1],
                                 unit[2] * part->scale[2]};
    memcpy(pose, part->position, 3 * sizeof *pose);
    memcpy(pose + 3, part->orientation, 4 * sizeof *pose);
    se3di_drawing_to_ground(pose, stretched, local);
}

typedef struct motion {
    double pose[SE3DI_POSE];
    double v[3]; /* of the origin, ground frame */
    double w[3]; /* body frame */
} motion;

/* Position and velocity of a point of a body. */
static void carry(const motion *m, const double s[3], double r[3], double v[3])
{
    const double still[SE3DI_POSE] = {0.0,        0.0,        0.0,       m->pose[3],
                                      m->pose[4], m->pose[5], m->pose[6]};
    const double turning[3] = {m->w[1] * s[2] - m->w[2] * s[1], m->w[2] * s[0] - m->w[0] * s[2],
                               m->w[0] * s[1] - m->w[1] * s[0]};
    se3di_drawing_to_ground(m->pose, s, r);
    se3di_drawing_to_ground(still, turning, v);
    for (int i = 0; i < 3; ++i) {
        v[i] += m->v[i];
    }
}

static void move_points(se3di_vtk *vtk)
{
    const se3d_model *model = vtk->model;
    double time = 0.0;
    size_t point = 0;
    (void)se3d_system_get_time(model->system, &time);
    for (size_t k = 0; k < vtk->piece_count; ++k) {
        const piece *p = &vtk->pieces[k];
        const surface s = surface_of(vtk, &p->part);
        motion m = {{0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
        se3di_part part = p->between1 > 0
                              ? se3di_drawing_get_between(model, p->part.element1 - 1,
                                                          p->between1 - 1, &vtk->sizes, vtk->poses)
                              : p->part;
        if (p->between1 == 0) {
            const se3d_body body = model->bodies[p->body].body;
            memcpy(m.pose, vtk->poses + SE3DI_POSE * p->body, sizeof m.pose);
            se3d_body_get_velocity(model->system, body, m.v);
            se3d_body_get_angular_velocity(model->system, body, m.w);
        }
        for (int i = 0; part.rise && i < 3; ++i) {
            part.position[i] += se3di_rise_get(model, part.rise, time) * part.along[i];
        }
        for (size_t i = 0; i < s.points_count; ++i, ++point) {
            double local[3];
            place(&part, s.points + 3 * i, local);
            carry(&m, local, vtk->points + 3 * point, vtk->velocities + 3 * point);
        }
    }
}

/* The path of a file of the series: "DIR/motion/bodies_00007.vtp"; `whole` false: as the list says
 * it, without DIR.
 */
static bool name_file(const se3di_vtk *vtk, int part, size_t number, bool whole, char *path)
{
    const char *start = vtk->path;
    for (const char *c = vtk->path; *c && !whole; ++c) {
        start = *c == '/' || *c == '\\' ? c + 1 : start;
    }
    const int length = snprintf(path, PATH_SIZE, "%.*s/%s_%05zu.%s",
                                (int)(strrchr(start, '.') - start), start, part_names[part], number,
                                vtk->is_hdf5 ? "vtkhdf"
                                : part == 3  ? "vti"
                                             : "vtp");
    return length > 0 && length < PATH_SIZE;
}

static bool write_bodies(se3di_vtk *vtk, const se3di_vtk_target *to)
{
    const size_t n = vtk->points_count;
    const size_t polys = vtk->triangles_count;
    const se3di_vtk_array arrays[] = {
        {SE3DI_VTK_POINT_DATA, "velocity", vtk->velocities, n, 3, 3, 0.0, 0.0, false},
        {SE3DI_VTK_CELL_DATA, "body", vtk->bodies, polys, 1, 1, 0.0, 0.0, true},
        {SE3DI_VTK_POINTS, "points", vtk->points, n, 3, 3, 0.0, 0.0, false},
        {SE3DI_VTK_POLYS, "connectivity", vtk->triangles, 3 * polys, 1, 1, 0.0, 0.0, true},
        {SE3DI_VTK_POLYS, "offsets", NULL, polys, 1, 1, 3.0, 3.0, true}};
    const se3di_vtk_file file = {n, 0, polys, arrays, sizeof arrays / sizeof *arrays, 0, NULL};
    se3di_drawing_get_poses(vtk->model, vtk->poses);
    move_points(vtk);
    return se3di_vtk_file_write(&file, to);
}

/* A part of each row of a table of points. */
typedef struct column {
    const char *name;
    size_t first, width;
    bool is_integer;
} column;

enum { COLUMNS_MOST = 6 }; /* a name NULL: there are fewer */

/* The rows of a table as points with what their columns say; the place is at `place`. */
static bool write_rows(const se3di_vtk_target *to, const double *rows, size_t n, size_t width,
                       size_t place, const column columns[COLUMNS_MOST])
{
    se3di_vtk_array arrays[COLUMNS_MOST + 3];
    size_t count = 0;
    for (size_t k = 0; k < COLUMNS_MOST && columns[k].name; ++k) {
        const column *c = &columns[k];
        arrays[count++] = (se3di_vtk_array){
            SE3DI_VTK_POINT_DATA, c->name, rows + c->first, n, c->width, width, 0.0, 0.0,
            c->is_integer};
    }
    se3di_vtk_array *points = arrays + count;
    points[0] =
        (se3di_vtk_array){SE3DI_VTK_POINTS, "points", rows + place, n, 3, width, 0.0, 0.0, false};
    points[1] = (se3di_vtk_array){SE3DI_VTK_VERTS, "connectivity", NULL, n, 1, 1, 0.0, 1.0, true};
    points[2] = (se3di_vtk_array){SE3DI_VTK_VERTS, "offsets", NULL, n, 1, 1, 1.0, 1.0, true};
    const se3di_vtk_file file = {n, n, 0, arrays, count + 3, 0, NULL};
    return se3di_vtk_file_write(&file, to);
}

static bool write_particles(const se3d_model *model, se3di_sample *sample, se3di_iopool *pool,
                            const se3di_vtk_target *to)
{
    /* The columns of a row: time, id, radius, position, velocity, angular velocity, force,
     * clump. */
    const column columns[COLUMNS_MOST] = {
        {"radius", 2, 1, false},
        {"velocity", 6, 3, false},
        {"angular_velocity", 9, 3, false},
        {"id", 1, 1, true},
        {"force", 12, 1, false},
        {model->particles->clump_count > 0 ? "clump" : NULL, 13, 1, true}};
    se3di_particle_rows list;
    (void)sample;
    return se3di_tagged_get_rows(model, pool, &list) >= 0 &&
           write_rows(to, list.rows, list.count, SE3DI_PARTICLE_COLUMNS, 3, columns);
}

static bool write_contacts(const se3d_model *model, se3di_sample *sample, se3di_iopool *pool,
                           const se3di_vtk_target *to)
{
    static const column columns[COLUMNS_MOST] = {{"normal", 4, 3, false},
                                                 {"overlap", 7, 1, false},
                                                 {"normal_force", 8, 1, false},
                                                 {"tangential_force", 9, 3, false}};
    se3di_contact_rows list;
    return se3di_contacts_get_rows(model, sample, pool, &list) >= 0 &&
           write_rows(to, list.rows, list.count, SE3DI_CONTACT_NUMBERS, 1, columns);
}

/* Of bond k: tension, shear, energy, group, ids of both, then the places of its ends. */
enum { BOND_NUMBERS = 6 };

/* The place of a particle in arrays of all, which are in the order of their ids. */
static size_t find_id(const uint32_t *ids, size_t count, uint32_t id)
{
    size_t low = 0, high = count;
    while (low + 1 < high) {
        const size_t middle = (low + high) / 2;
        *(ids[middle] <= id ? &low : &high) = middle;
    }
    return low;
}

static bool list_bonds(const se3d_particles *set, se3di_iopool *pool, double **numbers,
                       double **places, size_t *count)
{
    const size_t n = se3d_particles_count(set), bonds = se3d_particles_count_bonds(set);
    uint32_t *ids = se3di_iopool_array(pool, n + 1, sizeof *ids);
    double *r = se3di_iopool_array(pool, n + 1, 3 * sizeof *r);
    se3d_particles_bond_state *list = se3di_iopool_array(pool, bonds + 1, sizeof *list);
    *numbers = se3di_iopool_array(pool, bonds + 1, BOND_NUMBERS * sizeof **numbers);
    *places = se3di_iopool_array(pool, bonds + 1, 6 * sizeof **places);
    *count = bonds;
    if (!ids || !r || !list || !*numbers || !*places || se3d_particles_get_ids(set, n, ids) < 0 ||
        se3d_particles_get_all(set, n, r, NULL, NULL) < 0 ||
        se3d_particles_get_bonds(set, bonds, list) < 0) {
        return false;
    }
    for (size_t k = 0; k < bonds; ++k) {
        const se3d_particles_bond_state *bond = &list[k];
        const double row[BOND_NUMBERS] = {
            bond->tension,       bond->shear,     bond->energy,
            (double)bond->group, (double)bond->i, bond->j == UINT32_MAX ? -1.0 : (double)bond->j};
        memcpy(*numbers + BOND_NUMBERS * k, row, sizeof row);
        memcpy(*places + 6 * k, r + 3 * find_id(ids, n, bond->i), 3 * sizeof *r);
        memcpy(*places + 6 * k + 3, bond->place, 3 * sizeof *r);
    }
    return true;
}

static bool write_bonds(const se3d_model *model, se3di_sample *sample, se3di_iopool *pool,
                        const se3di_vtk_target *to)
{
    static const char *const names[BOND_NUMBERS] = {"tension", "shear", "energy",
                                                    "group",   "first", "second"};
    double *numbers, *places;
    size_t n;
    (void)sample;
    if (!list_bonds(model->particles->set, pool, &numbers, &places, &n)) {
        return false;
    }
    se3di_vtk_array arrays[BOND_NUMBERS + 3];
    for (size_t k = 0; k < BOND_NUMBERS; ++k) {
        arrays[k] = (se3di_vtk_array){SE3DI_VTK_CELL_DATA, names[k], numbers + k, n,    1,
                                      BOND_NUMBERS,        0.0,      0.0,         k > 2};
    }
    arrays[BOND_NUMBERS] =
        (se3di_vtk_array){SE3DI_VTK_POINTS, "points", places, 2 * n, 3, 3, 0.0, 0.0, false};
    arrays[BOND_NUMBERS + 1] =
        (se3di_vtk_array){SE3DI_VTK_LINES, "connectivity", NULL, 2 * n, 1, 1, 0.0, 1.0, true};
    arrays[BOND_NUMBERS + 2] =
        (se3di_vtk_array){SE3DI_VTK_LINES, "offsets", NULL, n, 1, 1, 2.0, 2.0, true};
    const se3di_vtk_file file = {2 * n, 0, 0, arrays, BOND_NUMBERS + 3, n, NULL};
    return se3di_vtk_file_write(&file, to);
}

/* Points with memory of their own. @return false: errno says why */
static bool write_points(const se3di_vtk *vtk, se3di_sample *sample, const se3di_vtk_target *to,
                         bool (*write)(const se3d_model *, se3di_sample *, se3di_iopool *,
                                       const se3di_vtk_target *))
{
    se3di_iopool pool;
    se3di_iopool_init(&pool, &vtk->model->pool.allocator);
    errno = ENOMEM; /* unless something else fails */
    const bool good = write(vtk->model, sample, &pool, to);
    const int why = errno;
    se3di_iopool_destroy(&pool);
    errno = why;
    return good;
}

/* What of the numbers of a cell has a name of its own. */
static const column field_columns[] = {{"density", SE3D_FIELD_DENSITY, 1, false},
                                       {"solid_fraction", SE3D_FIELD_SOLID_FRACTION, 1, false},
                                       {"velocity", SE3D_FIELD_VELOCITY, 3, false},
                                       {"temperature", SE3D_FIELD_TEMPERATURE, 1, false},
                                       {"kinetic_stress", SE3D_FIELD_KINETIC_STRESS, 6, false},
                                       {"contact_stress", SE3D_FIELD_CONTACT_STRESS, 6, false}};
enum { FIELD_COLUMNS = sizeof field_columns / sizeof *field_columns };

bool se3di_vtk_write_fields(const se3d_field_grid *grid, const double *values, size_t cells,
                            const se3di_vtk_target *to)
{
    se3di_vtk_array arrays[FIELD_COLUMNS];
    se3di_vtk_grid image = {.cells = {grid->cells[0], grid->cells[1], grid->cells[2]}};
    for (int a = 0; a < 3; ++a) {
        image.origin[a] = grid->lower[a];
        image.spacing[a] = (grid->upper[a] - grid->lower[a]) / grid->cells[a];
    }
    for (int k = 0; k < FIELD_COLUMNS; ++k) {
        const column *c = &field_columns[k];
        arrays[k] = (se3di_vtk_array){SE3DI_VTK_CELL_DATA,
                                      c->name,
                                      values + c->first,
                                      cells,
                                      c->width,
                                      SE3D_FIELD_VALUES,
                                      0.0,
                                      0.0,
                                      false};
    }
    const se3di_vtk_file file = {.arrays = arrays, .array_count = FIELD_COLUMNS, .grid = &image};
    return se3di_vtk_file_write(&file, to);
}

static bool write_fields(const se3di_vtk *vtk, const se3di_vtk_target *to)
{
    const se3d_field_grid *grid = vtk->grid;
    const size_t cells = (size_t)grid->cells[0] * (size_t)grid->cells[1] * (size_t)grid->cells[2];
    se3di_iopool pool;
    se3di_iopool_init(&pool, &vtk->model->pool.allocator);
    double *values = se3di_iopool_array(&pool, cells, SE3D_FIELD_VALUES * sizeof *values);
    errno = ENOMEM; /* unless something else fails */
    const bool good = values &&
                      se3d_particles_get_fields(vtk->model->particles->set, grid,
                                                cells * SE3D_FIELD_VALUES, values) >= 0 &&
                      se3di_vtk_write_fields(grid, values, cells, to);
    const int why = errno;
    se3di_iopool_destroy(&pool);
    errno = why;
    return good;
}

/* A series of its own for what the model has. */
static bool has_part(const se3di_vtk *vtk, int part)
{
    const se3d_model *model = vtk->model;
    return part == 0 || (part == 3 && vtk->grid) || (part == 1 && model->particles) ||
           (part == 4 && model->particles && model->particles->bond_count > 0) ||
           (part == 2 && (model->particles || se3di_node_get(model->root, "contact")));
}

static bool write_part(se3di_vtk *vtk, se3di_sample *sample, int part, const se3di_vtk_target *to)
{
    switch (part) {
    case 0:
        return write_bodies(vtk, to);
    case 1:
        return write_points(vtk, sample, to, write_particles);
    case 2:
        return write_points(vtk, sample, to, write_contacts);
    case 4:
        return write_points(vtk, sample, to, write_bonds);
    default:
        return write_fields(vtk, to);
    }
}

static bool write_state(se3di_vtk *vtk, se3di_sample *sample, size_t number)
{
    char path[PATH_SIZE];
    const se3di_vtk_target to = {path, vtk->compression, &vtk->model->pool.allocator};
    bool good = true;
    for (int part = 0; part < PARTS && good; ++part) {
        if (has_part(vtk, part)) {
            errno = ENAMETOOLONG;
            good = name_file(vtk, part, number, true, path) && se3di_file_make_folders(path) &&
                   write_part(vtk, sample, part, &to);
        }
    }
    return good;
}

/* Take the files of a state away: it is not whole, or makes room for the list. */
static void forget_state(const se3di_vtk *vtk, size_t number)
{
    char path[PATH_SIZE];
    for (int part = 0; part < PARTS; ++part) {
        if (has_part(vtk, part) && name_file(vtk, part, number, true, path)) {
            remove(path);
        }
    }
}

void se3di_vtk_record(se3di_vtk *vtk, se3di_sample *sample, double time)
{
    if (vtk->failure != 0) {
        return;
    }
    if (vtk->count > 0 && !(time > vtk->times[vtk->count - 1])) {
        --vtk->count;
    }
    double *grown =
        se3di_iopool_grow(vtk->pool, vtk->times, vtk->count, &vtk->capacity, sizeof *grown);
    if (!grown) {
        vtk->failure = ENOMEM;
        return;
    }
    vtk->times = grown;
    if (!write_state(vtk, sample, vtk->count)) {
        vtk->failure = errno ? errno : EIO;
        forget_state(vtk, vtk->count);
        return;
    }
    vtk->times[vtk->count++] = time;
}

void se3di_vtk_pack(se3di_vtk *vtk, se3di_coder *coder)
{
    size_t count = vtk->count;
    se3di_code_count(coder, &count, 1.0);
    if (coder->in) {
        vtk->times = se3di_iopool_array(vtk->pool, count + 1, sizeof *vtk->times);
        vtk->capacity = vtk->times ? count + 1 : 0;
        vtk->count = vtk->times ? count : 0;
        coder->failed = coder->failed || !vtk->times;
    }
    se3di_code_numbers(coder, vtk->times, vtk->count);
}

/* An attribute of the list. */
static void put_path(FILE *file, const char *path)
{
    for (; *path; ++path) {
        if (strchr("&<>\"'", *path)) {
            fprintf(file, "&#%d;", *path);
        } else {
            fputc(*path, file);
        }
    }
}

/* A text of JSON. */
static void put_text(FILE *file, const char *text)
{
    fputc('"', file);
    for (; *text; ++text) {
        if (*text == '"' || *text == '\\' || (unsigned char)*text < 0x20) {
            fprintf(file, "\\u%04x", (unsigned)(unsigned char)*text);
        } else {
            fputc(*text, file);
        }
    }
    fputc('"', file);
}

/* The times of one part, as ParaView reads them. */
static bool write_part_list(const se3di_vtk *vtk, int part)
{
    char path[PATH_SIZE];
    char time[48];
    errno = ENAMETOOLONG;
    FILE *file = name_part_list(vtk, part, path) ? se3di_partial_open(path) : NULL;
    if (!file) {
        return false;
    }
    fputs("{\"file-series-version\": \"1.0\", \"files\": [", file);
    for (size_t k = 0; k < vtk->count; ++k) {
        char name[PATH_SIZE];
        time[se3di_number_format(vtk->times[k], time)] = '\0';
        name_file(vtk, part, k, false, name);
        fputs(k > 0 ? ",\n{\"name\": " : "\n{\"name\": ", file);
        put_text(file, name);
        fprintf(file, ", \"time\": %s}", time);
    }
    fputs("\n]}\n", file);
    return se3di_partial_close(file, path);
}

static bool write_part_lists(const se3di_vtk *vtk)
{
    bool good = true;
    for (int part = 0; part < PARTS && good; ++part) {
        good = !has_part(vtk, part) || write_part_list(vtk, part);
    }
    return good;
}

static void forget_lists(const se3di_vtk *vtk)
{
    char path[PATH_SIZE];
    for (int part = 0; part < PARTS; ++part) {
        if (has_part(vtk, part) && name_part_list(vtk, part, path)) {
            se3di_file_remove(path);
        }
    }
}

static bool write_list(const se3di_vtk *vtk)
{
    char path[PATH_SIZE];
    char time[48];
    FILE *file = se3di_partial_open(vtk->path);
    if (!file) {
        return false;
    }
    fputs("<?xml version=\"1.0\"?>\n"
          "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
          "<Collection>\n",
          file);
    for (size_t k = 0; k < vtk->count; ++k) {
        time[se3di_number_format(vtk->times[k], time)] = '\0';
        for (int part = 0; part < PARTS; ++part) {
            if (!has_part(vtk, part)) {
                continue;
            }
            name_file(vtk, part, k, false, path);
            fprintf(file, "<DataSet timestep=\"%s\" part=\"%d\" name=\"%s\" file=\"", time, part,
                    part_names[part]);
            put_path(file, path);
            fputs("\"/>\n", file);
        }
    }
    fputs("</Collection>\n</VTKFile>\n", file);
    return se3di_partial_close(file, vtk->path);
}

se3d_status se3di_vtk_close(se3di_vtk *vtk, int *why)
{
    errno = 0;
    while (vtk->count > 0 && !(vtk->is_hdf5 ? write_part_lists(vtk) : write_list(vtk))) {
        const int failed = errno ? errno : EIO;
        vtk->failure = vtk->failure ? vtk->failure : failed;
        if (failed != ENOSPC) {
            vtk->count = 0;
            break;
        }
        forget_state(vtk, --vtk->count); /* on a full disk the last states make room */
    }
    if (vtk->is_hdf5 && vtk->count == 0) {
        forget_lists(vtk);
    }
    *why = vtk->failure;
    return vtk->failure == 0 ? SE3D_OK : vtk->failure == ENOMEM ? SE3D_ERR_NO_MEMORY : SE3D_ERR_IO;
}
