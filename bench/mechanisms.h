/* SPDX-License-Identifier: BSD-3-Clause */
/* The mechanisms of the bench, built through the public interface. Bars are 1 m long; gravity is
 * -9.81 m/s^2 along y. */
#ifndef BENCH_MECHANISMS_H
#define BENCH_MECHANISMS_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "se3d/se3d.h"

typedef struct bench_mechanism {
    se3d_system *system;
    se3d_body tip;
    double point[3];    /* of the tip, in its body's frame */
    se3d_status status; /* the first failure */
} bench_mechanism;

static inline void bench_note(bench_mechanism *m, se3d_status status)
{
    m->status = m->status < 0 ? m->status : status;
}

static inline se3d_body bench_add_bar(bench_mechanism *m, double x, double y, double turn,
                                      double mass, const double inertia[3])
{
    se3d_body_def def = se3d_body_def_default();
    se3d_body body = {0, 0};
    def.mass = mass;
    memcpy(def.inertia, inertia, 3 * sizeof *inertia);
    def.position[0] = x;
    def.position[1] = y;
    def.orientation[0] = cos(0.5 * turn);
    def.orientation[3] = sin(0.5 * turn);
    bench_note(m, se3d_body_create(m->system, &def, &body));
    return body;
}

static inline void bench_add_joint(bench_mechanism *m, se3d_body i, se3d_body j, double x, double y,
                                   int ball)
{
    const double axis[3] = {0.0, 0.0, 1.0};
    const double at[3] = {x, y, 0.0};
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint joint;
    def.body_i = i;
    def.body_j = j;
    bench_note(m, se3d_joint_def_set_frame(m->system, &def, at, axis, NULL));
    bench_note(m, ball ? se3d_joint_create_spherical(m->system, &def, &joint)
                       : se3d_joint_create_revolute(m->system, &def, &joint));
}

/* Bars 1 x .05 x .05 m of steel along +x from the origin, at rest; with ball joints, each turns
 * about itself at 1 rad/s. */
static inline void bench_build_chain(bench_mechanism *m, int n, int ball)
{
    const double inertia[3] = {0.008125, 1.6290625, 1.6290625};
    const double spin[3] = {1.0, 0.0, 0.0};
    se3d_body last;
    bench_note(m, se3d_system_get_ground(m->system, &last));
    for (int k = 0; k < n; ++k) {
        se3d_body bar = bench_add_bar(m, k + 0.5, 0.0, 0.0, 19.5, inertia);
        bench_add_joint(m, last, bar, k, 0.0, ball);
        if (ball) {
            bench_note(m, se3d_body_set_angular_velocity(m->system, bar, spin));
        }
        last = bar;
    }
    m->tip = last;
    m->point[0] = 0.5;
}

/* IFToMM A02: n windows of four-bars in a row, plain revolutes; bars of 1 kg. */
static inline void bench_build_fourbars(bench_mechanism *m, int n)
{
    const double inertia[3] = {1e-3, 1.0 / 12.0, 1.0 / 12.0};
    const double right = 1.5707963267948966;
    const double w[3] = {0.0, 0.0, -1.0};
    const double v[3] = {0.5, 0.0, 0.0};
    const double vc[3] = {1.0, 0.0, 0.0};
    se3d_body ground, left = {0, 0};
    bench_note(m, se3d_system_get_ground(m->system, &ground));
    for (int k = 0; k <= n; ++k) {
        se3d_body bar = bench_add_bar(m, k, 0.5, right, 1.0, inertia);
        bench_note(m, se3d_body_set_velocity(m->system, bar, v));
        bench_note(m, se3d_body_set_angular_velocity(m->system, bar, w));
        bench_add_joint(m, ground, bar, k, 0.0, 0);
        if (k > 0) {
            se3d_body coupler = bench_add_bar(m, k - 0.5, 1.0, 0.0, 1.0, inertia);
            bench_note(m, se3d_body_set_velocity(m->system, coupler, vc));
            bench_add_joint(m, left, coupler, k - 1.0, 1.0, 0);
            bench_add_joint(m, coupler, bar, k, 1.0, 0);
        } else {
            m->tip = bar;
        }
        left = bar;
    }
    m->point[0] = 0.5;
}

/* n bars along half a circle from the origin, pinned to the ground at both ends; at rest. */
static inline void bench_build_arch(bench_mechanism *m, int n)
{
    const double inertia[3] = {0.008125, 1.6290625, 1.6290625}, part = 3.14159265358979312 / n;
    double x = 0.0, y = 0.0;
    se3d_body ground, last;
    bench_note(m, se3d_system_get_ground(m->system, &ground));
    last = ground;
    for (int k = 0; k < n; ++k) {
        const double turn = (k + 0.5) * part - 1.57079632679489656;
        const double c = cos(turn), s = sin(turn);
        se3d_body bar = bench_add_bar(m, x + 0.5 * c, y + 0.5 * s, turn, 19.5, inertia);
        bench_add_joint(m, last, bar, x, y, 0);
        m->tip = 2 * k < n ? bar : m->tip;
        last = bar;
        x += c;
        y += s;
    }
    bench_add_joint(m, last, ground, x, y, 0);
    m->point[0] = 0.5;
}

/* n floors of n windows of four-bars on each other, bars of 1 kg; all posts turn alike. */
static inline void bench_build_grid(bench_mechanism *m, int n)
{
    const double inertia[3] = {1e-3, 1.0 / 12.0, 1.0 / 12.0}, right = 1.5707963267948966;
    const double w[3] = {0.0, 0.0, -1.0};
    se3d_body below[65], ground, beam = {0, 0};
    bench_note(m, se3d_system_get_ground(m->system, &ground));
    for (int k = 0; k <= n && k < 65; ++k) {
        below[k] = ground;
    }
    for (int floor = 0; floor < n; ++floor) {
        for (int k = 0; k <= n && k < 65; ++k) {
            const double v[3] = {floor + 0.5, 0.0, 0.0}, top[3] = {floor + 1.0, 0.0, 0.0};
            se3d_body post = bench_add_bar(m, k, floor + 0.5, right, 1.0, inertia);
            bench_note(m, se3d_body_set_velocity(m->system, post, v));
            bench_note(m, se3d_body_set_angular_velocity(m->system, post, w));
            bench_add_joint(m, below[k], post, k, floor, 0);
            if (k > 0) {
                beam = bench_add_bar(m, k - 0.5, floor + 1.0, 0.0, 1.0, inertia);
                bench_note(m, se3d_body_set_velocity(m->system, beam, top));
                bench_add_joint(m, below[k - 1], beam, k - 1.0, floor + 1.0, 0);
                bench_add_joint(m, beam, post, k, floor + 1.0, 0);
            }
            below[k] = post;
            m->tip = post;
        }
    }
    m->point[0] = 0.5;
}

/* IFToMM A01: 1 kg at 1 m from a pin, along -x, at rest. A body must have inertia: that of a ball
 * of a tenth of a millimetre. */
static inline void bench_build_pendulum(bench_mechanism *m)
{
    const double inertia[3] = {4e-9, 4e-9, 4e-9};
    se3d_body ground;
    bench_note(m, se3d_system_get_ground(m->system, &ground));
    m->tip = bench_add_bar(m, -1.0, 0.0, 0.0, 1.0, inertia);
    bench_add_joint(m, ground, m->tip, 0.0, 0.0, 0);
}

/* kind: a chain with revolutes, b with balls, c closed at its end, f four-bars, g a grid of them, p
 * pendulum. Destroy m->system. */
static inline bench_mechanism bench_build(char kind, int n)
{
    const double gravity[3] = {0.0, -9.81, 0.0};
    bench_mechanism m = {0};
    bench_note(&m, se3d_system_create(NULL, &m.system));
    bench_note(&m, se3d_system_set_gravity(m.system, gravity));
    if (kind == 'f') {
        bench_build_fourbars(&m, n);
    } else if (kind == 'c') {
        bench_build_arch(&m, n);
    } else if (kind == 'g') {
        bench_build_grid(&m, n);
    } else if (kind == 'p') {
        bench_build_pendulum(&m);
    } else {
        bench_build_chain(&m, n, kind == 'b');
    }
    return m;
}

/* Of METHOD/FORMULATION; METHOD alone: what users get. */
static inline int32_t bench_formulation(const char *method)
{
    const char *slash = strchr(method, '/');
    for (int32_t k = 0; slash && *se3d_formulation_get_name(k); ++k) {
        if (strcmp(slash + 1, se3d_formulation_get_name(k)) == 0) {
            return k;
        }
    }
    return SE3D_FORMULATION_AUTO;
}

#endif
