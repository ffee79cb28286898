/* SPDX-License-Identifier: BSD-3-Clause */
/* Unit surfaces and lines, made from their formulas. */
#include "io/write/unit_mesh.h"

#include <math.h>
#include <string.h>

#include "io/base/elementary.h"

enum {
    AROUND = 32,
    RINGS = 16,
    BALL_AROUND = 20,
    BALL_RINGS = 10,
    TURNS = 8,
    STEPS = 16,
    WIRE = 6
};

static const double pi = 3.14159265358979323846;

static void put_vertex(se3di_unit_mesh *m, double x, double y, double z, const double n[3])
{
    const double p[3] = {x, y, z};
    memcpy(&m->points[3 * m->points_count], p, sizeof p);
    if (n) {
        memcpy(&m->normals[3 * m->points_count], n, 3 * sizeof *n);
    }
    ++m->points_count;
}

static void put_triangle(se3di_unit_mesh *m, size_t a, size_t b, size_t c)
{
    m->indices[m->indices_count++] = (uint32_t)a;
    m->indices[m->indices_count++] = (uint32_t)b;
    m->indices[m->indices_count++] = (uint32_t)c;
}

static void make_box(se3di_unit_mesh *m)
{
    for (int axis = 0; axis < 3; ++axis) {
        for (int side = -1; side <= 1; side += 2) {
            const size_t first = m->points_count;
            double n[3] = {0.0, 0.0, 0.0};
            n[axis] = side;
            for (int k = 0; k < 4; ++k) {
                double p[3];
                p[axis] = 0.5 * side;
                p[(axis + 1) % 3] = (k == 1 || k == 2) ? 0.5 : -0.5;
                p[(axis + 2) % 3] = k >= 2 ? 0.5 : -0.5;
                put_vertex(m, p[0], p[1], p[2], n);
            }
            const size_t flip = side > 0 ? 0 : 1;
            put_triangle(m, first, first + 1 + flip, first + 2 - flip);
            put_triangle(m, first, first + 2 + flip, first + 3 - flip);
        }
    }
}

static void put_quads(se3di_unit_mesh *m, size_t first, size_t rings, size_t around)
{
    for (size_t i = 0; i < rings; ++i) {
        for (size_t k = 0; k < around; ++k) {
            const size_t a = first + i * (around + 1) + k;
            const size_t b = a + around + 1;
            put_triangle(m, a, a + 1, b + 1);
            put_triangle(m, a, b + 1, b);
        }
    }
}

static void put_sphere(se3di_unit_mesh *m, int rings, int around)
{
    for (int i = 0; i <= rings; ++i) {
        for (int k = 0; k <= around; ++k) {
            const double polar = pi - pi * i / rings;
            const double turn = 2.0 * pi * k / around;
            const double n[3] = {io_sin(polar) * io_cos(turn), io_sin(polar) * io_sin(turn),
                                 io_cos(polar)};
            put_vertex(m, n[0], n[1], n[2], n);
        }
    }
    put_quads(m, 0, (size_t)rings, (size_t)around);
}

static void make_sphere(se3di_unit_mesh *m)
{
    put_sphere(m, RINGS, AROUND);
}

static void make_ball(se3di_unit_mesh *m)
{
    put_sphere(m, BALL_RINGS, BALL_AROUND);
}

static void make_cylinder(se3di_unit_mesh *m)
{
    for (int i = 0; i < 2; ++i) {
        for (int k = 0; k <= AROUND; ++k) {
            const double turn = 2.0 * pi * k / AROUND;
            const double n[3] = {io_cos(turn), io_sin(turn), 0.0};
            put_vertex(m, n[0], n[1], i - 0.5, n);
        }
    }
    put_quads(m, 0, 1, AROUND);
    for (int i = 0; i < 2; ++i) {
        const size_t first = m->points_count;
        const double n[3] = {0.0, 0.0, i == 0 ? -1.0 : 1.0};
        for (int k = 0; k < AROUND; ++k) {
            const double turn = 2.0 * pi * k / AROUND;
            put_vertex(m, io_cos(turn), io_sin(turn), i - 0.5, n);
        }
        for (size_t k = 1; k + 1 < AROUND; ++k) {
            put_triangle(m, first, first + k + (i == 0), first + k + (i == 1));
        }
    }
}

static void make_cone(se3di_unit_mesh *m)
{
    const double down[3] = {0.0, 0.0, -1.0};
    const double slope = sqrt(0.5); /* the normal of a cone as high as its radius */
    for (int i = 0; i < 2; ++i) {
        for (int k = 0; k <= AROUND; ++k) {
            const double turn = 2.0 * pi * k / AROUND;
            const double n[3] = {slope * io_cos(turn), slope * io_sin(turn), slope};
            put_vertex(m, (1 - i) * io_cos(turn), (1 - i) * io_sin(turn), i - 0.5, n);
        }
    }
    put_quads(m, 0, 1, AROUND);
    const size_t first = m->points_count;
    for (int k = 0; k < AROUND; ++k) {
        const double turn = 2.0 * pi * k / AROUND;
        put_vertex(m, io_cos(turn), io_sin(turn), -0.5, down);
    }
    for (size_t k = 1; k + 1 < AROUND; ++k) {
        put_triangle(m, first, first + k + 1, first + k);
    }
}

/* A ring of the wire around a point of its middle line. */
static void put_ring(se3di_unit_mesh *m, double radius, double z, double turn)
{
    const double thick[2] = {0.12, 0.02}; /* across and along: it will be stretched along z */
    for (int k = 0; k < WIRE; ++k) {
        const double angle = 2.0 * pi * k / WIRE;
        const double out = radius + thick[0] * io_cos(angle);
        const double n[3] = {io_cos(angle) * io_cos(turn), io_cos(angle) * io_sin(turn),
                             io_sin(angle)};
        put_vertex(m, out * io_cos(turn), out * io_sin(turn), z + thick[1] * io_sin(angle), n);
    }
}

static void make_spring(se3di_unit_mesh *m)
{
    const int count = TURNS * STEPS;
    put_ring(m, 0.0, -0.5, 0.0);
    for (int k = 0; k <= count; ++k) {
        put_ring(m, 1.0, -0.45 + 0.9 * k / count, 2.0 * pi * TURNS * k / count);
    }
    put_ring(m, 0.0, 0.5, 0.0);
    for (size_t i = 0; i < (size_t)count + 2; ++i) {
        for (size_t k = 0; k < WIRE; ++k) {
            const size_t a = i * WIRE + k;
            const size_t b = i * WIRE + (k + 1) % WIRE;
            put_triangle(m, a, a + WIRE, b + WIRE);
            put_triangle(m, a, b + WIRE, b);
        }
    }
}

static void make_grid(se3di_unit_mesh *m)
{
    for (int k = -10; k <= 10; ++k) {
        put_vertex(m, k, -10.0, 0.0, NULL);
        put_vertex(m, k, 10.0, 0.0, NULL);
        put_vertex(m, -10.0, k, 0.0, NULL);
        put_vertex(m, 10.0, k, 0.0, NULL);
    }
}

void se3di_unit_mesh_make(se3di_unit_mesh *mesh, se3di_unit_shape unit)
{
    static void (*const make[])(se3di_unit_mesh *) = {
        make_box, make_sphere, make_cylinder, make_spring, make_grid, make_cone, make_ball};
    make[unit](mesh);
}
