/* SPDX-License-Identifier: BSD-3-Clause */
/* Tyre: a wheel (body j, centre c, spin axis a to the left, radius R) on a plane (body i, point P,
 * normal n): the road, or what force/road.h finds of it below the wheel, which rises with the speed
 * z_t along its up axis u. With sin g = a . n:
 *
 *     x = a x n / cos g,  y = n x x,  d = (sin g a - n) / cos g       d: down, in the wheel's plane
 *     l = n . (c - P) / cos g,  C = c + l d,  rho = R - l
 *     v = velocity of the wheel less that of the road (z_t u, too) at C,  W = relative spin about a
 *     rhodot = -n . v / cos g,  V_x = x . v + W l,  V_sx = V_x - W r_e,  V_sy = y . v
 *     psidot = (n . w - sin g W) / cos^2 g        w: relative angular velocity
 *     Fz = (k rho + c rhodot) / cos g, never below 0
 *
 * F = Fx x + Fy y + Fz n acts at C, with Mx x + My a + Mz n. My holds Fx (l - r_e): the moment of
 * Fx about the axis is -r_e Fx, so that what is lost in the road is -Fx V_sx - Fy V_sy.
 *
 * Slip may lag by relaxation lengths: z' = V (slip - z) / sigma, z a state (model/state.h) of the
 * tyre's own, V the speed that the slip is relative to.                docs/theory/tyre.md */
#include "force/tyre.h"

#include "force/measure.h"
#include "force/road.h"
#include "force/tyre_lanes.h"
#include "math/vec3.h"
#include "model/state.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define ENVELOPE   0.4  /* of tyres on meshes, over the radius */
#define UPRIGHT    1e-3 /* cos g: a wheel that lies touches nothing */
#define LOOK_AHEAD 64   /* elements among which tyres that are alike are looked for */

typedef struct patch {
    double n[3], a[3], x[3], y[3], d[3];
    double s[3], p[3], e[3]; /* c - r_j, P - r_i, c - P */
    double q[3], b[3];       /* C - r_j, C - r_i */
    double omega_i[3], omega_j[3], v[3];
    double cosine, length, radius; /* cos g, l, R */
    double input[SE3DI_PATCH_INPUTS];
    int touches;
    int is_uneven;          /* 1: the plane depends on where the wheel is: */
    double axes[9];         /* of the road, columns: forward, left, up */
    double up[3], rise;     /* z_t */
    se3di_road_plane plane; /* frame of the road */
} patch;

static void take_velocity(const se3di_frame *i, const se3di_frame *j, patch *c)
{
    double turned[3], omega[3];
    se3di_mul(i->A, i->w, c->omega_i);
    se3di_mul(j->A, j->w, c->omega_j);
    se3di_cross(c->omega_j, c->q, c->v);
    se3di_add(c->v, j->v, c->v);
    se3di_sub(c->v, i->v, c->v);
    se3di_cross(c->omega_i, c->b, turned);
    se3di_sub(c->v, turned, c->v);
    se3di_add_scaled(-c->rise, c->up, c->v);
    se3di_sub(c->omega_j, c->omega_i, omega);
    const double spin = se3di_dot(omega, c->a);
    c->input[SE3DI_PATCH_RATE] = -se3di_dot(c->n, c->v) / c->cosine;
    c->input[SE3DI_PATCH_SPEED] = se3di_dot(c->x, c->v) + spin * c->length;
    c->input[SE3DI_PATCH_SIDE_SPEED] = se3di_dot(c->y, c->v);
    c->input[SE3DI_PATCH_SPIN] = spin;
    c->input[SE3DI_PATCH_TURN] =
        (se3di_dot(omega, c->n) - c->input[SE3DI_PATCH_SINE] * spin) / (c->cosine * c->cosine);
}

static void values_of(const se3di_dual x[3], double v[3])
{
    for (int k = 0; k < 3; ++k) {
        v[k] = x[k].v;
    }
}

/* The plane below the wheel; of a wheel that lies on its side the road's own. */
static se3d_status take_road(const se3di_model *model, const se3di_force *force, double t, patch *c)
{
    const se3di_road *road = &model->roads[force->tyre->surface];
    const se3di_frame *i = &model->frames[force->body_i];
    se3di_road_wheel wheel = {.time = t,
                              .radius = force->rest,
                              .length = force->tyre->envelope[0],
                              .width = force->tyre->envelope[1]};
    if (road->kind == SE3DI_ROAD_MESH && !(wheel.length > 0.0)) {
        wheel.length = ENVELOPE * force->rest;
    }
    if (!(wheel.width > 0.0)) {
        wheel.width = wheel.length;
    }
    double part[3];
    for (int k = 0; k < 3; ++k) { /* columns */
        double axis[3];
        se3di_mul(i->A, road->axes + 3 * k, axis);
        for (int m = 0; m < 3; ++m) {
            c->axes[3 * m + k] = axis[m];
        }
        se3di_copy(axis, c->up);
    }
    se3di_mul(i->A, road->point, c->p);
    se3di_copy(c->up, c->n);
    se3di_add(model->frames[force->body_j].r, c->s, part);
    se3di_sub(part, i->r, part);
    se3di_sub(part, c->p, part);
    se3di_mul_transposed(c->axes, part, wheel.center);
    se3di_mul_transposed(c->axes, c->a, wheel.axis);
    c->is_uneven = wheel.axis[2] * wheel.axis[2] < 1.0 - UPRIGHT * UPRIGHT;
    if (!c->is_uneven) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_road_find_plane(model, road, &wheel, &c->plane));
    values_of(c->plane.normal, part);
    se3di_mul(c->axes, part, c->n);
    values_of(c->plane.point, wheel.center);
    se3di_mul(c->axes, wheel.center, part);
    se3di_add(c->p, part, c->p);
    c->rise = c->plane.rise.v;
    return SE3D_OK;
}

/* The plane below the wheel, and how far it is away. */
static se3d_status take_height(const se3di_model *model, const se3di_force *force, double t,
                               patch *c)
{
    const se3di_frame *i = &model->frames[force->body_i], *j = &model->frames[force->body_j];
    memset(c, 0, offsetof(patch, plane)); /* which is large, and read if there is one */
    se3di_mul(j->A, force->tyre->axis, c->a);
    se3di_mul(j->A, force->s_j, c->s);
    if (force->tyre->surface < 0) {
        se3di_mul(i->A, force->tyre->normal, c->n);
        se3di_mul(i->A, force->s_i, c->p);
    } else {
        SE3DI_TRY(take_road(model, force, t, c));
    }
    se3di_add(j->r, c->s, c->e);
    se3di_sub(c->e, i->r, c->e);
    se3di_sub(c->e, c->p, c->e);
    const double sine = se3di_dot(c->a, c->n);
    c->cosine = sqrt(fmax(0.0, 1.0 - sine * sine));
    c->radius = force->rest;
    c->input[SE3DI_PATCH_SINE] = sine;
    if (c->cosine < UPRIGHT) {
        c->length = c->radius;
        return SE3D_OK;
    }
    c->length = se3di_dot(c->n, c->e) / c->cosine;
    c->input[SE3DI_PATCH_DEFLECTION] = c->radius - c->length;
    c->touches = c->length < c->radius;
    return SE3D_OK;
}

static se3d_status take_patch(const se3di_model *model, const se3di_force *force, double t,
                              patch *c)
{
    const se3di_frame *i = &model->frames[force->body_i], *j = &model->frames[force->body_j];
    SE3DI_TRY(take_height(model, force, t, c));
    for (int k = 0; k < 2; ++k) {
        const uint32_t carrier = force->tyre->carrier[k];
        c->input[SE3DI_PATCH_LAGGED + k] = force->tyre->lags[k] ? model->frames[carrier].v[0] : 0.0;
    }
    if (c->cosine < UPRIGHT) {
        return SE3D_OK;
    }
    const double sine = c->input[SE3DI_PATCH_SINE];
    se3di_cross(c->a, c->n, c->x);
    se3di_scale(1.0 / c->cosine, c->x, c->x);
    se3di_cross(c->n, c->x, c->y);
    se3di_scale(sine / c->cosine, c->a, c->d);
    se3di_add_scaled(-1.0 / c->cosine, c->n, c->d);
    se3di_copy(c->s, c->q);
    se3di_add_scaled(c->length, c->d, c->q);
    se3di_add(c->q, j->r, c->b);
    se3di_sub(c->b, i->r, c->b);
    take_velocity(i, j, c);
    return SE3D_OK;
}

/* ---- Forces by the inputs ------------------------------------------------------------------*/

/* Without derivatives those of slips are not written, and read by no law. */
static int needs_derivatives(const se3di_force *force, int wants_derivative)
{
    return wants_derivative || !se3di_tyre_is_magic(force);
}

/* Those of the instant. */
static void take_slip(const se3di_force *force, const patch *c, int derivatives,
                      se3di_tyre_slip *slip)
{
    if (needs_derivatives(force, derivatives)) {
        se3di_tyre_take_slip(force, c->cosine, c->input, slip);
    } else {
        se3di_tyre_take_slip_values(force, c->cosine, c->input, slip);
    }
}

/* A slip that lags is a number of its own. */
static void take_lag(const se3di_force *force, const patch *c, int derivatives,
                     se3di_tyre_slip *slip)
{
    for (int k = 0; k < 2; ++k) {
        const int at = SE3DI_PATCH_LAGGED + k;
        se3di_dual *followed = se3di_tyre_followed(force, slip, k);
        if (force->tyre->lags[k] && needs_derivatives(force, derivatives)) {
            *followed = se3di_dual_seed(c->input[at], at, 1.0);
        } else if (force->tyre->lags[k]) {
            followed->v = c->input[at];
        }
    }
}

/* `slip`: of the instant; what lags takes its place in it. */
static void find_forces(const se3di_force *force, const patch *c, se3di_tyre_slip *slip,
                        se3di_tyre_forces *forces)
{
    memset(forces, 0, sizeof *forces);
    take_lag(force, c, 1, slip);
    if (!(slip->load.v > 0.0)) {
        return;
    }
    forces->of[2] = slip->load;
    if (se3di_tyre_is_magic(force)) {
        se3di_tyre_magic(force, slip, forces);
    } else if (force->tyre->law == SE3D_TYRE_FIALA) {
        se3di_tyre_fiala(force, slip, forces);
    } else {
        se3di_tyre_brush(force, slip, forces);
    }
    for (int k = 1; k < 6 && force->tyre->mirrored; k += 2) { /* Fy, Mx, Mz */
        forces->of[k] = se3di_dual_scale(-1.0, forces->of[k]);
    }
    const se3di_dual length =
        se3di_dual_seed(c->length, SE3DI_PATCH_DEFLECTION, -1.0); /* R - deflection */
    forces->of[4] = se3di_dual_add(
        forces->of[4], se3di_dual_mul(forces->of[0], se3di_dual_sub(length, slip->rolling_radius)));
}

/* The same values, to the bit, as far as they are wanted. */
static void find_values(const se3di_force *force, const patch *c, se3di_tyre_slip *slip, int which,
                        double of[6])
{
    se3di_tyre_forces forces;
    memset(of, 0, 6 * sizeof *of);
    if (!se3di_tyre_is_magic(force)) {
        find_forces(force, c, slip, &forces);
    } else {
        take_lag(force, c, 0, slip);
        if (!(slip->load.v > 0.0)) {
            return;
        }
        se3di_tyre_magic_values(force, slip, which, &forces);
        forces.of[2].v = slip->load.v;
        for (int k = 1; k < 6 && force->tyre->mirrored; k += 2) { /* Fy, Mx, Mz */
            forces.of[k].v = -forces.of[k].v;
        }
        forces.of[4].v += forces.of[0].v * (c->length - slip->rolling_radius.v);
    }
    for (int k = 0; k < 6; ++k) {
        of[k] = forces.of[k].v;
    }
}

/* ---- Wrench and its derivatives ------------------------------------------------------------*/

/* F and M in the ground frame. */
static void compose(const patch *c, const double of[6], double F[3], double M[3])
{
    se3di_scale(of[0], c->x, F);
    se3di_add_scaled(of[1], c->y, F);
    se3di_add_scaled(of[2], c->n, F);
    se3di_scale(of[3], c->x, M);
    se3di_add_scaled(of[4], c->a, M);
    se3di_add_scaled(of[5], c->n, M);
}

/* b x F + M */
static void moment_about(const double b[3], const double F[3], const double M[3], double T[3])
{
    se3di_cross(b, F, T);
    se3di_add(T, M, T);
}

/* Virtual displacements and changes of velocities, ground frame. */
typedef struct turn {
    double r_i[3], f_i[3], r_j[3], f_j[3]; /* f: rotations */
    double v_i[3], w_i[3], v_j[3], w_j[3];
    double time; /* that passes for a road that moves by itself */
} turn;

/* How plane and rise change as the wheel goes over the road. */
static void vary_plane(const patch *c, const turn *t, patch *out)
{
    double by[SE3DI_DUALS] = {0.0}, part[3], arm[3], n[3], p[3];
    se3di_add(c->e, c->p, arm); /* centre from the origin of body i */
    se3di_sub(t->r_j, t->r_i, part);
    se3di_add(part, out->s, part);
    se3di_cross(t->f_i, arm, n);
    se3di_sub(part, n, part);
    se3di_mul_transposed(c->axes, part, by + SE3DI_ROAD_CENTER);
    se3di_cross(t->f_i, c->a, n);
    se3di_sub(out->a, n, part);
    se3di_mul_transposed(c->axes, part, by + SE3DI_ROAD_AXIS);
    by[SE3DI_ROAD_TIME] = t->time;
    memset(n, 0, sizeof n);
    memset(p, 0, sizeof p);
    out->rise = 0.0;
    for (int m = 0; m <= SE3DI_ROAD_TIME; ++m) {
        for (int k = 0; k < 3; ++k) {
            n[k] += c->plane.normal[k].d[m] * by[m];
            p[k] += c->plane.point[k].d[m] * by[m];
        }
        out->rise += c->plane.rise.d[m] * by[m];
    }
    se3di_mul(c->axes, n, part);
    se3di_add(out->n, part, out->n);
    se3di_mul(c->axes, p, part);
    se3di_add(out->p, part, out->p);
    se3di_cross(t->f_i, c->up, out->up);
}

/* How the patch changes; `out` holds changes in place of values. */
static void vary_pose(const patch *c, const turn *t, patch *out)
{
    double part[3];
    se3di_cross(t->f_i, c->n, out->n);
    se3di_cross(t->f_j, c->a, out->a);
    se3di_cross(t->f_j, c->s, out->s);
    se3di_cross(t->f_i, c->p, out->p);
    if (c->is_uneven) {
        vary_plane(c, t, out);
    }
    se3di_add(t->r_j, out->s, out->e);
    se3di_sub(out->e, t->r_i, out->e);
    se3di_sub(out->e, out->p, out->e);
    const double sine = c->input[SE3DI_PATCH_SINE];
    const double dsine = se3di_dot(out->a, c->n) + se3di_dot(c->a, out->n);
    out->input[SE3DI_PATCH_SINE] = dsine;
    out->cosine = -sine * dsine / c->cosine;
    const double height = se3di_dot(out->n, c->e) + se3di_dot(c->n, out->e);
    out->length = (height - c->length * out->cosine) / c->cosine;
    out->input[SE3DI_PATCH_DEFLECTION] = -out->length;
    se3di_cross(out->a, c->n, out->x);
    se3di_cross(c->a, out->n, part);
    se3di_add(out->x, part, out->x);
    se3di_add_scaled(-out->cosine, c->x, out->x);
    se3di_scale(1.0 / c->cosine, out->x, out->x);
    se3di_cross(out->n, c->x, out->y);
    se3di_cross(c->n, out->x, part);
    se3di_add(out->y, part, out->y);
    se3di_scale(dsine, c->a, out->d);
    se3di_add_scaled(sine, out->a, out->d);
    se3di_sub(out->d, out->n, out->d);
    se3di_add_scaled(-out->cosine, c->d, out->d);
    se3di_scale(1.0 / c->cosine, out->d, out->d);
    se3di_copy(out->s, out->q);
    se3di_add_scaled(out->length, c->d, out->q);
    se3di_add_scaled(c->length, out->d, out->q);
    se3di_add(out->q, t->r_j, out->b);
    se3di_sub(out->b, t->r_i, out->b);
}

static void vary_velocity(const patch *c, const turn *t, patch *out)
{
    double part[3], omega[3];
    se3di_cross(t->f_i, c->omega_i, out->omega_i);
    se3di_add(out->omega_i, t->w_i, out->omega_i);
    se3di_cross(t->f_j, c->omega_j, out->omega_j);
    se3di_add(out->omega_j, t->w_j, out->omega_j);
    se3di_sub(t->v_j, t->v_i, out->v);
    se3di_cross(out->omega_j, c->q, part);
    se3di_add(out->v, part, out->v);
    se3di_cross(c->omega_j, out->q, part);
    se3di_add(out->v, part, out->v);
    se3di_cross(out->omega_i, c->b, part);
    se3di_sub(out->v, part, out->v);
    se3di_cross(c->omega_i, out->b, part);
    se3di_sub(out->v, part, out->v);
    if (c->is_uneven) {
        se3di_add_scaled(-out->rise, c->up, out->v);
        se3di_add_scaled(-c->rise, out->up, out->v);
    }
    se3di_sub(c->omega_j, c->omega_i, omega);
    se3di_sub(out->omega_j, out->omega_i, part);
    const double spin = se3di_dot(part, c->a) + se3di_dot(omega, out->a);
    const double approach = se3di_dot(out->n, c->v) + se3di_dot(c->n, out->v);
    out->input[SE3DI_PATCH_SPIN] = spin;
    out->input[SE3DI_PATCH_RATE] =
        -(approach + c->input[SE3DI_PATCH_RATE] * out->cosine) / c->cosine;
    out->input[SE3DI_PATCH_SPEED] = se3di_dot(out->x, c->v) + se3di_dot(c->x, out->v) +
                                    spin * c->length + c->input[SE3DI_PATCH_SPIN] * out->length;
    out->input[SE3DI_PATCH_SIDE_SPEED] = se3di_dot(out->y, c->v) + se3di_dot(c->y, out->v);
    out->input[SE3DI_PATCH_LAGGED] = out->input[SE3DI_PATCH_LAGGED + 1] = 0.0;
    const double sine = c->input[SE3DI_PATCH_SINE], dsine = out->input[SE3DI_PATCH_SINE];
    const double about = se3di_dot(part, c->n) + se3di_dot(omega, out->n);
    const double less = dsine * c->input[SE3DI_PATCH_SPIN] + sine * spin;
    const double wider = 2.0 * c->input[SE3DI_PATCH_TURN] * sine * dsine; /* of 1 / cos^2 */
    out->input[SE3DI_PATCH_TURN] = (about - less + wider) / (c->cosine * c->cosine);
}

/* One column of K or D: what the wrench changes by. */
static void vary_wrench(const se3di_frame *const frames[2], const patch *c,
                        const se3di_tyre_forces *forces, const turn *t, double column[12])
{
    patch out;
    double of[6], change[6], F[3], M[3], dF[3], dM[3], T[3], dT[3], part[3];
    vary_pose(c, t, &out);
    vary_velocity(c, t, &out);
    for (int k = 0; k < 6; ++k) {
        of[k] = forces->of[k].v;
        change[k] = 0.0;
        for (int m = 0; m < SE3DI_PATCH_INPUTS; ++m) {
            change[k] += forces->of[k].d[m] * out.input[m];
        }
    }
    compose(c, of, F, M);
    compose(c, change, dF, dM);
    compose(&out, of, T, dT);
    se3di_add(dF, T, dF);
    se3di_add(dM, dT, dM);
    for (int side = 0; side < 2; ++side) {
        const double sign = side ? 1.0 : -1.0;
        const double *arm = side ? c->q : c->b, *arm_change = side ? out.q : out.b;
        moment_about(arm, F, M, T);
        moment_about(arm, dF, dM, dT);
        se3di_cross(arm_change, F, part);
        se3di_add(dT, part, dT);
        se3di_cross(side ? t->f_j : t->f_i, T, part);
        se3di_sub(dT, part, dT); /* of A^T */
        se3di_scale(sign, dF, column + 6 * side);
        se3di_mul_transposed(frames[side]->A, dT, part);
        se3di_scale(sign, part, column + 6 * side + 3);
    }
}

/* A unit of coordinate k of 12, or of velocity k - 12. */
static turn turn_of(const se3di_frame *const frames[2], int k)
{
    turn t = {.r_i = {0.0, 0.0, 0.0}};
    double *const parts[8] = {t.r_i, t.f_i, t.r_j, t.f_j, t.v_i, t.w_i, t.v_j, t.w_j};
    const double *A = frames[k % 12 / 6]->A;
    for (int m = 0; m < 3; ++m) {
        parts[k / 3][m] = k / 3 % 2 ? A[3 * m + k % 3] : m == k % 3;
    }
    return t;
}

static void add_derivatives(const se3di_frame *const frames[2], const patch *c,
                            const se3di_tyre_forces *forces, se3di_effect *effect)
{
    for (int k = 0; k < 24; ++k) {
        const turn t = turn_of(frames, k);
        double column[12];
        vary_wrench(frames, c, forces, &t, column);
        for (int r = 0; r < 12; ++r) {
            (k < 12 ? effect->K : effect->D)[12 * r + k % 12] = column[r];
        }
    }
}

/* drho/dt, the plane's way along the road included: what the audit of energy needs. */
static double find_rate_of_deflection(const se3di_frame *const frames[2], const patch *c)
{
    turn t = {.time = 1.0};
    patch out;
    if (!c->is_uneven) {
        return c->input[SE3DI_PATCH_RATE];
    }
    se3di_copy(frames[0]->v, t.r_i);
    se3di_copy(c->omega_i, t.f_i);
    se3di_copy(frames[1]->v, t.r_j);
    se3di_copy(c->omega_j, t.f_j);
    vary_pose(c, &t, &out);
    return out.input[SE3DI_PATCH_DEFLECTION];
}

/* What F and M at the patch are on road and wheel. */
static void to_wrench(const se3di_frame *const frames[2], const patch *c, const double of[6],
                      double wrench[12])
{
    double F[3], M[3], T[3];
    compose(c, of, F, M);
    se3di_scale(-1.0, F, wrench);
    se3di_copy(F, wrench + 6);
    moment_about(c->b, F, M, T);
    se3di_mul_transposed(frames[0]->A, T, wrench + 3);
    se3di_scale(-1.0, wrench + 3, wrench + 3);
    moment_about(c->q, F, M, T);
    se3di_mul_transposed(frames[1]->A, T, wrench + 9);
}

static double find_energy(const se3di_force *force, const patch *c)
{
    const double deflection = c->input[SE3DI_PATCH_DEFLECTION];
    return 0.5 * force->k * deflection * deflection;
}

/* Wrench and powers by forces and moments. */
static void apply(const se3di_model *model, const se3di_force *force, const patch *c,
                  const double of[6], se3di_tyre_load *load)
{
    const se3di_frame *const frames[2] = {&model->frames[force->body_i],
                                          &model->frames[force->body_j]};
    const double *in = c->input;
    double u[12];
    to_wrench(frames, c, of, load->wrench);
    load->power[1] = c->rise * se3di_dot(load->wrench + 6, c->up); /* of a road that rises */
    load->power[0] =
        load->power[1] - force->k * in[SE3DI_PATCH_DEFLECTION] * find_rate_of_deflection(frames, c);
    se3di_velocity_pair(model, force, u);
    for (int k = 0; k < 12; ++k) {
        load->power[0] -= load->wrench[k] * u[k];
    }
}

static void eval_patch(const se3di_model *model, const se3di_force *force, const patch *c,
                       se3di_effect *effect)
{
    const se3di_frame *const frames[2] = {&model->frames[force->body_i],
                                          &model->frames[force->body_j]};
    se3di_tyre_load load;
    se3di_tyre_slip slip;
    se3di_tyre_forces forces;
    double of[6];
    take_slip(force, c, effect->wants_derivative, &slip);
    if (effect->wants_derivative) {
        find_forces(force, c, &slip, &forces);
        for (int k = 0; k < 6; ++k) {
            of[k] = forces.of[k].v;
        }
        add_derivatives(frames, c, &forces, effect);
    } else {
        find_values(force, c, &slip, SE3DI_TYRE_WANTS_ALL, of);
    }
    apply(model, force, c, of, &load);
    memcpy(effect->wrench, load.wrench, sizeof effect->wrench);
    memcpy(effect->power, load.power, sizeof load.power);
    effect->potential = find_energy(force, c);
}

static se3d_status eval_tyre(const se3di_model *model, const se3di_force *force, double t,
                             se3di_effect *effect)
{
    patch c;
    SE3DI_TRY(take_patch(model, force, t, &c));
    if (c.touches) {
        eval_patch(model, force, &c, effect);
    }
    return SE3D_OK;
}

se3d_status se3di_tyre_find_deflection(const se3di_model *model, const se3di_force *force, double t,
                                       double deflection[4])
{
    const se3di_frame *const frames[2] = {&model->frames[force->body_i],
                                          &model->frames[force->body_j]};
    patch c;
    SE3DI_TRY(take_patch(model, force, t, &c));
    deflection[0] = c.input[SE3DI_PATCH_DEFLECTION];
    deflection[1] = c.cosine < UPRIGHT ? 0.0 : find_rate_of_deflection(frames, &c);
    deflection[2] = c.cosine < UPRIGHT ? 0.0 : c.input[SE3DI_PATCH_RATE];
    deflection[3] = c.cosine;
    return SE3D_OK;
}

static se3d_status find_potential(const se3di_model *model, const se3di_force *force, double t,
                                  double *potential)
{
    patch c;
    SE3DI_TRY(take_height(model, force, t, &c));
    *potential = c.touches ? find_energy(force, &c) : 0.0;
    return SE3D_OK;
}

/* ---- Slip that lags ------------------------------------------------------------------------*/

static void find_rates(const se3di_force *force, const patch *c, int derivatives,
                       se3di_tyre_slip *slip, se3di_dual rate[2])
{
    if (needs_derivatives(force, derivatives)) {
        se3di_tyre_find_rates(force, c->input, c->touches, slip, rate);
    } else {
        se3di_tyre_find_rates_values(force, c->input, c->touches, slip, rate);
    }
}

static void find_gain(const se3di_force *force, const se3di_frame *const frames[2], const patch *c,
                      int direction, double gain[12])
{
    se3di_tyre_slip slip;
    se3di_tyre_forces forces;
    double of[6];
    memset(gain, 0, 12 * sizeof *gain);
    if (c->touches) {
        take_slip(force, c, 1, &slip);
        find_forces(force, c, &slip, &forces);
        for (int k = 0; k < 6; ++k) {
            of[k] = forces.of[k].d[SE3DI_PATCH_LAGGED + direction];
        }
        to_wrench(frames, c, of, gain);
    }
}

/* ---- Several at once -----------------------------------------------------------------------*/

/* Its load and the rates of its slips. */
static void eval_alone(const se3di_model *model, const se3di_force *force, const patch *c,
                       se3di_tyre_load *load)
{
    const int lags = force->tyre->lags[0] || force->tyre->lags[1];
    se3di_tyre_slip slip;
    se3di_dual rates[2];
    double of[6];
    if (c->touches || lags) {
        take_slip(force, c, 0, &slip);
    }
    if (lags) {
        find_rates(force, c, 0, &slip, rates);
    }
    for (int k = 0; k < 2; ++k) {
        load->rate[k] = force->tyre->lags[k] ? rates[k].v : 0.0;
    }
    if (c->touches) {
        find_values(force, c, &slip, SE3DI_TYRE_WANTS_ALL, of);
        apply(model, force, c, of, load);
    }
}

/* All presses, and lanes are worth it. */
static int fit_lanes(const se3di_force *const tyres[], const patch *c, int count)
{
    int fit = count > 1 && se3di_tyre_core_avx2() != NULL;
    for (int k = 0; fit && k < count; ++k) {
        const double *in = c[k].input;
        fit = c[k].touches &&
              tyres[k]->k * in[SE3DI_PATCH_DEFLECTION] + tyres[k]->c * in[SE3DI_PATCH_RATE] > 0.0;
    }
    return fit;
}

/* Lanes without a tyre have the first one's numbers. */
static void fill_lanes(const se3di_force *const tyres[], const patch *c, int count,
                       se3di_tyre_lanes *lanes)
{
    for (int k = 0; k < SE3DI_TYRE_LANES; ++k) {
        const int from = k < count ? k : 0;
        lanes->side[k] = tyres[from]->tyre->mirrored ? -1.0 : 1.0;
        lanes->cosine[k] = c[from].cosine;
        lanes->length[k] = c[from].length;
        for (int m = 0; m < SE3DI_PATCH_INPUTS; ++m) {
            lanes->in[m][k] = c[from].input[m];
        }
    }
}

static void eval_lanes(const se3di_model *model, const se3di_force *const tyres[], const patch *c,
                       int count, se3di_tyre_loads *loads)
{
    se3di_tyre_lanes lanes;
    fill_lanes(tyres, c, count, &lanes);
    se3di_tyre_core_avx2()->eval(tyres[0], SE3DI_TYRE_WANTS_ALL, &lanes);
    for (int k = 0; k < count; ++k) {
        double of[6];
        for (int m = 0; m < 6; ++m) {
            of[m] = lanes.of[m][k];
        }
        apply(model, tyres[k], &c[k], of, &loads->of[k]);
        for (int direction = 0; direction < 2; ++direction) {
            const int lags = tyres[k]->tyre->lags[direction];
            loads->of[k].rate[direction] = lags ? lanes.rate[direction][k] : 0.0;
        }
    }
}

static int same(const void *a, const void *b, size_t size)
{
    return memcmp(a, b, size) == 0;
}

/* Two tyres by the same numbers, but for their sides. */
static int are_alike(const se3di_force *a, const se3di_force *b)
{
    const se3di_tyre *p = a->tyre, *q = b->tyre;
    return p->kind == q->kind && p->law == q->law && p->has_turn_slip == q->has_turn_slip &&
           same(p->lags, q->lags, sizeof p->lags) && same(&a->rest, &b->rest, sizeof a->rest) &&
           same(&a->k, &b->k, sizeof a->k) && same(&a->c, &b->c, sizeof a->c) &&
           same(&a->mu, &b->mu, sizeof a->mu) &&
           same(&p->rolling_radius, &q->rolling_radius, sizeof p->rolling_radius) &&
           same(&p->low_speed, &q->low_speed, sizeof p->low_speed) &&
           same(p->relaxation, q->relaxation, sizeof p->relaxation);
}

/* Tyre `first`, and those alike that follow before another one. */
static int list_alike(const se3di_model *model, uint32_t first, se3di_tyre_loads *loads,
                      const se3di_force *tyres[SE3DI_TYRE_LANES])
{
    const se3di_force *force = &model->forces[first];
    const size_t rest = model->force_slots.count - first;
    const uint32_t end = first + (uint32_t)(rest < LOOK_AHEAD ? rest : LOOK_AHEAD);
    int count = 1;
    tyres[0] = force;
    loads->index[0] = first;
    int more = se3di_tyre_is_magic(force);
    for (uint32_t k = first + 1; more && k < end && count < SE3DI_TYRE_LANES; ++k) {
        const se3di_force *other = &model->forces[k];
        if (other->type == SE3DI_FORCE_TYRE && !other->released) {
            more = are_alike(force, other);
            tyres[count] = other;
            loads->index[count] = k;
            count += more;
        }
    }
    return count;
}

void se3di_tyre_eval_alike(const se3di_model *model, uint32_t first, double t,
                           se3di_tyre_loads *loads)
{
    const se3di_force *tyres[SE3DI_TYRE_LANES];
    patch c[SE3DI_TYRE_LANES];
    int fine = 1;
    memset(loads, 0, sizeof *loads);
    loads->count = list_alike(model, first, loads, tyres);
    for (int k = 0; k < loads->count; ++k) {
        loads->of[k].status = take_patch(model, tyres[k], t, &c[k]);
        fine = fine && loads->of[k].status >= 0;
    }
    if (fine && fit_lanes(tyres, c, loads->count)) {
        eval_lanes(model, tyres, c, loads->count, loads);
        return;
    }
    for (int k = 0; k < loads->count; ++k) {
        if (loads->of[k].status >= 0) {
            eval_alone(model, tyres[k], &c[k], &loads->of[k]);
        }
    }
}

se3d_status se3di_tyre_lag_eval(const se3di_model *model, const se3di_force *tyre, double t,
                                int direction, se3di_tyre_lag *lag)
{
    const se3di_frame *const frames[2] = {&model->frames[tyre->body_i],
                                          &model->frames[tyre->body_j]};
    patch c, out = {.cosine = 0.0};
    se3di_tyre_slip slip;
    se3di_dual rates[2];
    SE3DI_TRY(take_patch(model, tyre, t, &c));
    take_slip(tyre, &c, lag->wants_derivative, &slip);
    find_rates(tyre, &c, lag->wants_derivative, &slip, rates);
    const se3di_dual rate = rates[direction];
    lag->rate = rate.v;
    if (!lag->wants_derivative) {
        return SE3D_OK;
    }
    lag->own = rate.d[SE3DI_PATCH_LAGGED + direction];
    find_gain(tyre, frames, &c, direction, lag->gain);
    memset(lag->K, 0, sizeof lag->K);
    memset(lag->D, 0, sizeof lag->D);
    for (int k = 0; k < 24 && !(c.cosine < UPRIGHT); ++k) {
        const turn unit = turn_of(frames, k);
        vary_pose(&c, &unit, &out);
        vary_velocity(&c, &unit, &out);
        for (int m = 0; m < SE3DI_PATCH_INPUTS; ++m) {
            (k < 12 ? lag->K : lag->D)[k % 12] += rate.d[m] * out.input[m];
        }
    }
    return SE3D_OK;
}

/* ---- What it tells -------------------------------------------------------------------------*/

typedef struct told {
    double ratio, tangent;    /* slips of the instant, */
    double followed[2];       /* and those that the forces follow */
    double radius, reference; /* of rolling, V */
    double of[6];
} told;

static void find_alone(const se3di_force *force, const patch *c, int which, told *o)
{
    se3di_tyre_slip slip;
    memset(&slip, 0, sizeof slip);
    memset(o->of, 0, sizeof o->of);
    if (c->touches) {
        take_slip(force, c, 0, &slip);
    }
    o->ratio = slip.ratio.v;
    o->tangent = slip.tangent.v;
    if (c->touches && which >= 0) {
        find_values(force, c, &slip, which, o->of);
    } else {
        take_lag(force, c, 0, &slip);
    }
    for (int k = 0; k < 2; ++k) {
        o->followed[k] = se3di_tyre_followed(force, &slip, k)->v;
    }
    o->radius = slip.rolling_radius.v;
    o->reference = slip.reference.v;
}

static void find_in_lanes(const se3di_force *const *tyres, const patch *c, int count, int which,
                          told *o)
{
    se3di_tyre_lanes lanes;
    fill_lanes(tyres, c, count, &lanes);
    se3di_tyre_core_avx2()->eval(tyres[0], which, &lanes);
    for (int k = 0; k < count; ++k) {
        const se3di_tyre *tyre = tyres[k]->tyre;
        const double *in = c[k].input;
        o[k].ratio = lanes.ratio[k];
        o[k].tangent = lanes.tangent[k];
        o[k].followed[0] = tyre->lags[0] ? in[SE3DI_PATCH_LAGGED] : o[k].ratio;
        o[k].followed[1] = tyre->lags[1] ? in[SE3DI_PATCH_LAGGED + 1] : o[k].tangent;
        o[k].radius = lanes.rolling_radius[k];
        o[k].reference = lanes.reference[k];
        for (int m = 0; m < 6; ++m) {
            o[k].of[m] = lanes.of[m][k];
        }
    }
}

/* The slips that the forces follow; those of a brush are relative to the speed of rolling. */
static void tell_lag(const se3di_force *force, const told *o, double values[SE3D_TYRE_VALUES])
{
    const double side = force->tyre->mirrored ? -1.0 : 1.0;
    const double forward = o->followed[0];
    values[SE3D_TYRE_LAGGED_RATIO] = force->tyre->law == SE3D_TYRE_BRUSH ? 0.0 - forward : forward;
    values[SE3D_TYRE_LAGGED_ANGLE] = side * se3di_atan(o->followed[1]);
}

/* All values before number `end` */
#define BEFORE(end) ((UINT32_C(1) << (end)) - 1)

/* What comes behind the slips. */
static void tell_place(const se3di_model *model, const se3di_force *force, const patch *c,
                       const told *o, double values[SE3D_TYRE_VALUES])
{
    values[SE3D_TYRE_ROLLING_RADIUS] = o->radius;
    values[SE3D_TYRE_TURN_SLIP] = c->touches ? c->input[SE3DI_PATCH_TURN] / o->reference : 0.0;
    tell_lag(force, o, values);
    values[SE3D_TYRE_INCLINATION] = se3di_asin(fmax(-1.0, fmin(1.0, c->input[SE3DI_PATCH_SINE])));
    values[SE3D_TYRE_DEFLECTION] = c->input[SE3DI_PATCH_DEFLECTION];
    values[SE3D_TYRE_LOADED_RADIUS] = c->length;
    values[SE3D_TYRE_SPEED] = c->input[SE3DI_PATCH_SPEED];
    se3di_add(model->frames[force->body_j].r, c->q, values + SE3D_TYRE_CONTACT_X);
}

static void tell(const se3di_model *model, const se3di_force *force, const patch *c, uint32_t which,
                 const told *o, double values[SE3D_TYRE_VALUES])
{
    const double side = force->tyre->mirrored ? -1.0 : 1.0;
    memcpy(values + SE3D_TYRE_FX, o->of, sizeof o->of);
    values[SE3D_TYRE_SLIP_RATIO] = o->ratio;
    if (which >> SE3D_TYRE_SLIP_ANGLE & 1) {
        values[SE3D_TYRE_SLIP_ANGLE] = side * se3di_atan(o->tangent);
    }
    if (which & ~BEFORE(SE3D_TYRE_INCLINATION)) {
        tell_place(model, force, c, o, values);
    }
}

/* What of forces is wanted; -1: nothing. */
static int find_wants(uint32_t which)
{
    const uint32_t moments = BEFORE(SE3D_TYRE_SLIP_RATIO) & ~BEFORE(SE3D_TYRE_MX);
    if (which & moments) {
        return SE3DI_TYRE_WANTS_X | SE3DI_TYRE_WANTS_MOMENTS;
    }
    if (which >> SE3D_TYRE_FX & 1) {
        return SE3DI_TYRE_WANTS_X;
    }
    return which & BEFORE(SE3D_TYRE_MX) ? 0 : -1;
}

/* Of tyres that are alike. */
static se3d_status tell_alike(const se3di_model *model, const se3di_force *const *tyres, int count,
                              uint32_t which, se3di_tyre_values *values)
{
    const int wants = find_wants(which);
    patch c[SE3DI_TYRE_LANES];
    told o[SE3DI_TYRE_LANES];
    int k = 0;
    do { /* there is one */
        SE3DI_TRY(take_patch(model, tyres[k], model->time, &c[k]));
    } while (++k < count);
    const int in_lanes = wants >= 0 && fit_lanes(tyres, c, count);
    if (in_lanes) {
        find_in_lanes(tyres, c, count, wants, o);
    }
    for (k = 0; k < count; ++k) {
        if (!in_lanes) {
            find_alone(tyres[k], &c[k], wants, &o[k]);
        }
        tell(model, tyres[k], &c[k], which, &o[k], values[k]);
    }
    return SE3D_OK;
}

se3d_status se3di_tyre_tell(const se3di_model *model, const se3di_force *const *tyres, size_t count,
                            uint32_t which, se3di_tyre_values *values)
{
    for (size_t begin = 0, end; begin < count; begin = end) {
        end = begin + 1;
        while (end < count && end - begin < SE3DI_TYRE_LANES && se3di_tyre_is_magic(tyres[begin]) &&
               are_alike(tyres[begin], tyres[end])) {
            ++end;
        }
        SE3DI_TRY(tell_alike(model, tyres + begin, (int)(end - begin), which, values + begin));
    }
    return SE3D_OK;
}

const se3di_force_class se3di_force_class_tyre = {
    .name = "tyre",
    .eval = eval_tyre,
    .find_potential = find_potential,
    .traits = SE3DI_FORCE_IS_ELASTIC | SE3DI_FORCE_HOLDS,
};
