/* SPDX-License-Identifier: BSD-3-Clause */
/* `forces`: bushing, placed in the ground frame or on its bodies. */
#include "io/read/forces_bushing.h"

#include <math.h>
#include <string.h>

#include "io/base/rotation.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/function.h"
#include "io/document/keys.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/bodies.h"
#include "io/read/elements.h"
#include "io/read/objects.h"

/* Force over displacement, force over angle or moment over displacement, moment over angle. */
static bool read_row(se3di_reader *reader, const se3di_node *node, size_t row, double values[6])
{
    size_t k = 0;
    if (node->kind != SE3DI_NODE_LIST || node->count != 6) {
        return se3di_read_vector(reader, node, 6, values); /* says why not */
    }
    for (const se3di_node *part = node->first; part; part = part->next, ++k) {
        reader->alternative = (row >= 3) + (k >= 3);
        if (!se3di_read_number(reader, part, SE3DI_ANY, &values[k])) {
            return false;
        }
    }
    return true;
}

/* 6 numbers on the diagonal, or 6 rows of 6. */
static bool read_matrix(se3di_reader *reader, const se3di_node *node, const char *key,
                        double matrix[36])
{
    const se3di_node *child = se3di_node_get(node, key);
    size_t row = 0;
    if (!child) {
        return true;
    }
    if (child->kind != SE3DI_NODE_LIST || child->count != 6) {
        return se3di_reader_fail(reader, child,
                                 "must be the 6 numbers of the diagonal (x, y, z, about x, y, z) "
                                 "or 6 rows of 6 numbers");
    }
    if (child->first->kind != SE3DI_NODE_LIST) {
        for (const se3di_node *part = child->first; part; part = part->next, ++row) {
            reader->alternative = row < 3 ? 0 : 2;
            if (!se3di_read_number(reader, part, SE3DI_ANY, &matrix[7 * row])) {
                return false;
            }
        }
        return true;
    }
    for (const se3di_node *part = child->first; part; part = part->next, ++row) {
        if (!read_row(reader, part, row, &matrix[6 * row])) {
            return false;
        }
    }
    return true;
}

/* The Euler parameters of frame `f` (ground) in the body's frame: A^T F. */
static void to_body_frame(const double body[4], const double f[4], double local[4])
{
    double A[9];
    double F[9];
    double product[9];
    se3di_rotation_to_matrix(body, A);
    se3di_rotation_to_matrix(f, F);
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            product[3 * i + j] = A[i] * F[j] + A[3 + i] * F[3 + j] + A[6 + i] * F[6 + j];
        }
    }
    se3di_rotation_from_matrix(product, local);
}

/* The frame of a bushing on a body, from a point and axes in the ground frame. */
static bool place(se3di_reader *reader, se3d_body body, const double at[3], const double frame[4],
                  double point[3], double orientation[4])
{
    double r[3];
    double p[4];
    if (SE3D_FAILED(se3d_body_get_position(reader->system, body, r)) ||
        SE3D_FAILED(se3d_body_get_orientation(reader->system, body, p))) {
        return se3di_reader_fail_memory(reader);
    }
    const double d[3] = {at[0] - r[0], at[1] - r[1], at[2] - r[2]};
    se3di_rotation_apply_inverse(p, d, point);
    to_body_frame(p, frame, orientation);
    return true;
}

static bool read_axes(se3di_reader *reader, const se3di_node *node, const char *key,
                      const se3di_body_entry *body, double p[4])
{
    const bool is_ground = body == &reader->model->bodies[0];
    const se3di_node *child = se3di_node_get(node, key);
    if (!se3di_read_orientation(reader, child, p) ||
        !se3di_check_frame(reader, child ? child : node, body)) {
        return false;
    }
    (is_ground ? se3di_place_orientation : se3di_flip_orientation)(&reader->part->place, p);
    return true;
}

/* Products of a polar and an axial component, and of the mirrored axis and another, change sign. */
static void mirror(const se3di_placement *place, double K[36])
{
    for (int i = 0; place->mirror >= 0 && i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            const bool turned =
                ((i % 3 == place->mirror) != (i >= 3)) != ((j % 3 == place->mirror) != (j >= 3));
            K[6 * i + j] = turned ? 0.0 - K[6 * i + j] : K[6 * i + j];
        }
    }
}

static bool read_frames(se3di_reader *reader, const se3di_node *node,
                        const se3di_body_entry *const bodies[2], se3d_bushing_def *def)
{
    const bool global = se3di_node_get(node, "at") != NULL;
    double at[3] = {0.0, 0.0, 0.0};
    double frame[4] = {1.0, 0.0, 0.0, 0.0};
    for (const se3di_node *child = node->first; child; child = child->next) {
        const char *others =
            global ? " point_i point_j orientation_i orientation_j " : " orientation ";
        if (se3di_keys_contain(others, child->key)) {
            return se3di_reader_fail(
                reader, child,
                "is not allowed here: give `at` and `orientation` (ground frame), "
                "or point_i, point_j, orientation_i, orientation_j");
        }
    }
    if (!global) {
        return se3di_read_key_point(reader, node, "point_i", bodies[0], def->point_i) &&
               se3di_read_key_point(reader, node, "point_j", bodies[1], def->point_j) &&
               read_axes(reader, node, "orientation_i", bodies[0], def->orientation_i) &&
               read_axes(reader, node, "orientation_j", bodies[1], def->orientation_j);
    }
    if (!se3di_read_key_ground_point(reader, node, "at", at) ||
        !se3di_read_key_orientation(reader, node, frame)) {
        return false;
    }
    se3di_place_orientation(&reader->part->place, frame);
    return place(reader, bodies[0]->body, at, frame, def->point_i, def->orientation_i) &&
           place(reader, bodies[1]->body, at, frame, def->point_j, def->orientation_j);
}

bool se3di_read_bushing(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    const se3di_body_entry *bodies[2] = {NULL, NULL};
    se3d_bushing_def def = se3d_bushing_def_default();
    if (!se3di_read_bodies_ij(reader, node, "a bushing", bodies) ||
        !read_frames(reader, node, bodies, &def) || !read_matrix(reader, node, "K", def.K) ||
        !read_matrix(reader, node, "C", def.C)) {
        return false;
    }
    for (size_t k = 0; k < 36; ++k) {
        const double off = def.K[k] - def.K[6 * (k % 6) + k / 6];
        if (fabs(off) > 1e-9 * (fabs(def.K[k]) + fabs(def.K[6 * (k % 6) + k / 6]))) {
            return se3di_reader_fail_key(reader, node, "K",
                                         "is not symmetric: row %zu and column %zu differ by %g",
                                         k / 6 + 1, k % 6 + 1, off);
        }
    }
    mirror(&reader->part->place, def.K);
    mirror(&reader->part->place, def.C);
    def.name = entry->name;
    def.body_i = bodies[0]->body;
    def.body_j = bodies[1]->body;
    entry->body = def.body_j;
    memcpy(entry->point, def.point_j, sizeof entry->point);
    return se3di_reader_check(reader, node,
                              se3d_force_create_bushing(reader->system, &def, &entry->force));
}
