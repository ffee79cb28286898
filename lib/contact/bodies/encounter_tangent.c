/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives of the law at one point, direction by direction: how the place and the normal move
 * with the bodies, and then the chain rule along encounter.c.
 *
 * With R the radii of curvature (tensors in the tangent plane) of the two surfaces, d the
 * displacements and t the rotations of the bodies at the point,
 *
 *     (R_i + R_j) dn = d_j - d_i + R_i (t_i x n) + R_j (t_j x n)
 *
 * in the tangent plane: a flat face (R infinite) takes the normal along, a corner (0) does not.
 * docs/theory/body-contact.md */
#include "contact/bodies/encounter.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define FLAT 1e8 /* stands for an infinite radius, in units of the contact's own */

typedef struct geometry {
    double C[9];    /* (R_i + R_j)^-1 */
    double W[2][9]; /* C R_i, C R_j */
    double H[9];    /* R_i C R_j */
} geometry;

/* R about a point so far below the surface, 2 x 2 in the basis of the tangent plane. */
static void bend_matrix(const se3di_bend *bend, double inside, const double n[3],
                        const double *const basis[2], double flat, double R[4])
{
    double across[3];
    se3di_cross(n, bend->u, across);
    double r0 = fmin(bend->r[0], flat) - inside;
    double r1 = fmin(bend->r[1], flat) - inside;
    double a[2], b[2];
    for (int k = 0; k < 2; ++k) {
        a[k] = se3di_dot(bend->u, basis[k]);
        b[k] = se3di_dot(across, basis[k]);
    }
    for (int k = 0; k < 4; ++k) {
        R[k] = r0 * a[k / 2] * a[k % 2] + r1 * b[k / 2] * b[k % 2];
    }
}

static void mul2(const double A[4], const double B[4], double out[4])
{
    for (int k = 0; k < 4; ++k) {
        out[k] = A[2 * (k / 2)] * B[k % 2] + A[2 * (k / 2) + 1] * B[2 + k % 2];
    }
}

static void lift(const double *const basis[2], const double A[4], double out[9])
{
    for (int k = 0; k < 9; ++k) {
        double sum = 0.0;
        for (int c = 0; c < 4; ++c) {
            sum += A[c] * basis[c / 2][k / 3] * basis[c % 2][k % 3];
        }
        out[k] = sum;
    }
}

static double finite_size(double most, const se3di_bend *bend)
{
    for (int k = 0; k < 2; ++k) {
        most = bend->r[k] < HUGE_VAL ? fmax(most, bend->r[k]) : most;
    }
    return most;
}

static void eval_geometry(const se3di_encounter *e, geometry *g)
{
    const double *n = e->at->normal;
    double first[3], second[3], R[2][4], S[4], C[4], W[2][4], H[4];
    double scale = finite_size(finite_size(e->radius, &e->at->bend_i), &e->at->bend_j);
    const double *const basis[2] = {first, second};
    se3di_perpendicular(n, first);
    se3di_cross(n, first, second);
    double inside =
        e->at->share * e->at->overlap; /* how deep the point is below the surface of i */
    bend_matrix(&e->at->bend_i, inside, n, basis, FLAT * scale, R[0]);
    bend_matrix(&e->at->bend_j, e->at->overlap - inside, n, basis, FLAT * scale, R[1]);
    for (int k = 0; k < 4; ++k) {
        S[k] = R[0][k] + R[1][k];
    }
    double det = S[0] * S[3] - S[1] * S[2];
    double size = S[0] + S[3];
    if (!(size > 0.0) || !(det > 1e-12 * scale * size)) { /* a corner on a corner: frozen */
        memset(g, 0, sizeof *g);
        return;
    }
    C[0] = S[3] / det;
    C[1] = -S[1] / det;
    C[2] = -S[2] / det;
    C[3] = S[0] / det;
    mul2(C, R[0], W[0]);
    mul2(C, R[1], W[1]);
    mul2(R[0], W[1], H);
    lift(basis, C, g->C);
    lift(basis, W[0], g->W[0]);
    lift(basis, W[1], g->W[1]);
    lift(basis, H, g->H);
}

static void add_mul(const double A[9], const double x[3], double out[3])
{
    double y[3];
    se3di_mul(A, x, y);
    se3di_add(out, y, out);
}

/* d of an encounter's quantities along one change. */
typedef struct rates {
    double n[3], p[3], delta;
    double arm[2][3], w[2][3], v[3], vn, vt[3];
    double surface_spin[3];
    double inverse_mass, root_mass, s, root, onset, xi[3], rho[3], twist, normal;
    double force[3], moment[3];
} rates;

static void move_point(const se3di_encounter *e, const geometry *g, const se3di_encounter_change *c,
                       rates *d)
{
    const double *n = e->at->normal;
    double at[2][3], turned[2][3], apart[3], turn[3];
    for (int k = 0; k < 2; ++k) {
        se3di_cross(c->turn[k], e->arm[k], at[k]);
        se3di_add(c->r[k], at[k], at[k]);
        se3di_cross(c->turn[k], n, turned[k]);
    }
    se3di_sub(at[1], at[0], apart);
    se3di_sub(turned[1], turned[0], turn);
    d->delta = -se3di_dot(n, apart);
    se3di_mul(g->C, apart, d->n);
    add_mul(g->W[0], turned[0], d->n);
    add_mul(g->W[1], turned[1], d->n);
    se3di_copy(at[0], d->p); /* + W_i^T (d_j - d_i) in the plane, the share of it along n */
    double along[3];
    se3di_mul_transposed(g->W[0], apart, along);
    se3di_add(d->p, along, d->p);
    se3di_add_scaled(-e->at->share * d->delta, n, d->p);
    add_mul(g->H, turn, d->p);
}

static void move_velocity(const se3di_encounter *e, const se3di_encounter_change *c, rates *d)
{
    const double *n = e->at->normal;
    double at[2][3], x[3];
    for (int k = 0; k < 2; ++k) {
        se3di_sub(d->p, c->r[k], d->arm[k]);
        se3di_cross(c->turn[k], e->w[k], d->w[k]);
        se3di_add(d->w[k], c->w[k], d->w[k]);
        se3di_cross(d->w[k], e->arm[k], at[k]);
        se3di_cross(e->w[k], d->arm[k], x);
        se3di_add(at[k], x, at[k]);
        se3di_add(at[k], c->v[k], at[k]);
    }
    se3di_sub(at[1], at[0], d->v);
    se3di_encounter_drift_rate(e, c, d->p, d->n, x, d->surface_spin);
    se3di_add(d->v, x, d->v);
    d->vn = se3di_dot(d->n, e->v) + se3di_dot(n, d->v);
    se3di_copy(d->v, d->vt);
    se3di_add_scaled(-d->vn, n, d->vt);
    se3di_add_scaled(-e->vn, d->n, d->vt);
}

static void move_mass(const se3di_encounter *e, const se3di_encounter_change *c, rates *d)
{
    double inverse = 0.0;
    for (int k = 0; k < 2; ++k) {
        double da[3], x[3];
        if (e->memory || e->model->bodies[e->body[k]].fixed) {
            continue; /* that of the last accepted state */
        }
        se3di_cross(d->arm[k], e->at->normal, da);
        se3di_cross(e->arm[k], d->n, x);
        se3di_add(da, x, da);
        se3di_cross(c->turn[k], e->lever[k], x);
        se3di_sub(da, x, da);
        inverse += 2.0 * se3di_dot(e->turned[k], da);
    }
    d->inverse_mass = inverse;
    d->root_mass = -0.5 * e->root_mass * inverse / e->alone; /* of points that share: nearly */
}

/* d of x - (n . x) n, where x is already projected and dx is that of what it was made from. */
static void project_rate(const double n[3], const double dn[3], const double raw[3],
                         const double dx[3], double out[3])
{
    double along = se3di_dot(n, raw);
    double rate = se3di_dot(dn, raw) + se3di_dot(n, dx);
    se3di_copy(dx, out);
    se3di_add_scaled(-rate, n, out);
    se3di_add_scaled(-along, dn, out);
}

static void move_new(const se3di_encounter *e, rates *d)
{
    double step = e->model->contacts.step;
    double time = 0.0, rate = 0.0;
    d->onset = 0.0;
    if (step > 0.0) {
        int within = e->vn * step < -e->at->overlap;
        time = within ? -e->at->overlap / e->vn : step;
        rate = within ? (-d->delta - time * d->vn) / e->vn : 0.0;
        d->onset = time > 0.0 ? e->onset * rate / time : 0.0;
    }
    se3di_scale(time, d->vt, d->xi);
    se3di_add_scaled(rate, e->vt, d->xi);
}

static void move_memory(const se3di_encounter *e, const se3di_encounter_change *c, rates *d)
{
    const double *n = e->at->normal;
    double raw[3], moved[3], turn[3], marks[3], dmarks[3];
    if (!e->memory) {
        move_new(e, d);
        return;
    }
    memset(raw, 0, sizeof raw);
    memset(moved, 0, sizeof moved);
    memset(marks, 0, sizeof marks);
    memset(dmarks, 0, sizeof dmarks);
    for (int k = 0; k < 2; ++k) {
        const se3di_frame *frame = &e->model->frames[e->body[k]];
        double x[3], dx[3];
        double sign = k ? 1.0 : -1.0;
        se3di_encounter_anchor(e, k, x);
        se3di_cross(c->turn[k], x, dx);
        se3di_add(dx, c->r[k], dx);
        se3di_add(x, frame->r, x);
        se3di_encounter_unroll_rate(e, k, c->turn[k], d->n, d->p, d->delta, x, dx);
        se3di_encounter_unroll(e, k, x);
        se3di_add_scaled(sign, x, raw);
        se3di_add_scaled(sign, dx, moved);
        se3di_add_scaled(0.5, x, marks);
        se3di_add_scaled(0.5, dx, dmarks);
    }
    project_rate(n, d->n, raw, moved, d->xi);
    se3di_sub(c->turn[1], c->turn[0], turn);
    se3di_add_scaled(e->elapsed, d->surface_spin, turn);
    se3di_sub(d->p, dmarks, dmarks);
    se3di_encounter_wander_rate(e, marks, d->delta, d->n, dmarks, turn, d->xi);
    d->twist = e->radius * (se3di_dot(turn, n) + se3di_dot(e->turn, d->n));
    se3di_scale(e->radius, turn, turn);
    se3di_copy(e->memory->roll, raw);
    se3di_add_scaled(e->radius, e->turn, raw);
    project_rate(n, d->n, raw, turn, d->rho);
}

/* d of f = x cap / |x| if it is capped, of x if it is not. */
static void cap_rate(double factor, double cap, double dcap, const double x[3], const double dx[3],
                     double out[3])
{
    double size = se3di_norm(x);
    se3di_copy(dx, out);
    if (factor < 1.0) {
        double along = se3di_dot(x, dx) / (size * size);
        se3di_add_scaled(-along, x, out);
        se3di_scale(cap / size, out, out);
        se3di_add_scaled(dcap / size, x, out);
    }
}

static void move_rolling(const se3di_encounter *e, rates *d)
{
    const double *n = e->at->normal;
    double spin[3], dspin[3], raw[3], dbend[3], dm[3], wring[3] = {e->wring, 0.0, 0.0};
    const double root = se3di_pair_turn(&e->pair, e->root);
    const double droot = e->pair.kr_constant ? 0.0 : d->root;
    double k = se3di_pair_kr(&e->pair, e->s);
    double c = e->pair.dr * e->root_mass * root * e->radius;
    double dk = e->pair.kr_constant ? 0.0 : e->pair.kr * d->s;
    double dc = e->pair.dr * e->radius * (d->root_mass * root + e->root_mass * droot);
    se3di_encounter_spin(e, raw);
    se3di_sub(d->w[1], d->w[0], dspin);
    se3di_add(dspin, d->surface_spin, dspin);
    double turn = se3di_dot(raw, n);
    double dturn = se3di_dot(dspin, n) + se3di_dot(raw, d->n);
    project_rate(n, d->n, raw, dspin, dspin);
    se3di_copy(raw, spin);
    se3di_add_scaled(-turn, n, spin);
    for (int a = 0; a < 3; ++a) {
        dbend[a] = -dk * e->rho[a] - k * d->rho[a] - dc * spin[a] - c * dspin[a];
    }
    cap_rate(e->yield, e->pair.rolling * e->normal, e->pair.rolling * d->normal, e->bend, dbend,
             dm);
    double dwring[3] = {-dk * e->twist - k * d->twist - dc * turn - c * dturn, 0.0, 0.0};
    double dt[3];
    cap_rate(e->slack, e->pair.torsion * e->normal, e->pair.torsion * d->normal, wring, dwring, dt);
    se3di_scale(e->radius, dm, d->moment);
    se3di_add_scaled(e->radius * dt[0], n, d->moment);
    se3di_add_scaled(e->radius * e->slack * e->wring, d->n, d->moment);
}

static void move_force(const se3di_encounter *e, rates *d)
{
    const se3di_pair *pair = &e->pair;
    double delta = e->at->overlap;
    double damping = pair->dn * e->root_mass * e->root;
    double ddamping = pair->dn * (d->root_mass * e->root + e->root_mass * d->root);
    double drag = pair->dt * e->root_mass * e->root;
    double ddrag = pair->dt * (d->root_mass * e->root + e->root_mass * d->root);
    const double s = se3di_pair_tangent(pair, e->s), ds = pair->kt_constant ? 0.0 : d->s;
    double dpull[3];
    double delastic = pair->kn * (d->s * delta + e->s * d->delta);
    d->normal = 0.0;
    if (e->normal > 0.0) {
        d->normal = delastic - e->onset * damping * d->vn -
                    (d->onset * damping + e->onset * ddamping) * e->vn;
    }
    for (int a = 0; a < 3; ++a) {
        dpull[a] = -pair->kt * (ds * e->xi[a] + s * d->xi[a]) - ddrag * e->vt[a] - drag * d->vt[a];
    }
    cap_rate(e->give, pair->friction * e->normal, pair->friction * d->normal, e->pull, dpull,
             d->force);
    double dattraction =
        pair->cohesion * e->radius * d->delta + 0.5 * e->stick * delastic / e->elastic;
    se3di_add_scaled(d->normal - dattraction, e->at->normal, d->force);
    se3di_add_scaled(e->normal - e->attraction, d->n, d->force);
    if (pair->rolling > 0.0 || pair->torsion > 0.0) {
        move_rolling(e, d);
    }
}

/* A user-defined law. */
static void call_rate(const se3di_encounter *e, rates *d)
{
    se3di_encounter_rates seen = {
        .delta = d->delta, .vn = d->vn, .inverse_mass = d->inverse_mass, .onset = d->onset};
    se3di_copy(d->n, seen.n);
    se3di_copy(d->vt, seen.vt);
    se3di_copy(d->xi, seen.xi);
    se3di_sub(d->w[1], d->w[0], seen.spin);
    se3di_add(seen.spin, d->surface_spin, seen.spin);
    se3di_encounter_call_rate(e, &seen, d->force, d->moment);
}

static void wrench_rate(const se3di_encounter *e, const se3di_encounter_change *c, const rates *d,
                        double out[12])
{
    for (int k = 0; k < 2; ++k) {
        double torque[3], dtorque[3], x[3];
        double sign = k ? 1.0 : -1.0;
        se3di_cross(e->arm[k], e->force, torque);
        se3di_add(torque, e->moment, torque);
        se3di_cross(d->arm[k], e->force, dtorque);
        se3di_cross(e->arm[k], d->force, x);
        se3di_add(dtorque, x, dtorque);
        se3di_add(dtorque, d->moment, dtorque);
        se3di_cross(c->turn[k], torque, x);
        se3di_sub(dtorque, x, dtorque);
        se3di_scale(sign, dtorque, dtorque);
        se3di_scale(sign, d->force, out + 6 * k);
        se3di_mul_transposed(e->model->frames[e->body[k]].A, dtorque, out + 6 * k + 3);
    }
}

static void eval_rate(const se3di_encounter *e, const geometry *g, const se3di_encounter_change *c,
                      double out[12])
{
    rates d;
    memset(&d, 0, sizeof d);
    move_point(e, g, c, &d);
    move_velocity(e, c, &d);
    move_mass(e, c, &d);
    if (e->law == SE3DI_LAW_HERTZ_MINDLIN) {
        d.s = 0.5 * e->s * d.delta / e->at->overlap;
        d.root = 0.5 * e->root * d.s / e->s;
    }
    move_memory(e, c, &d);
    if (e->law == SE3DI_LAW_CALLBACK) {
        call_rate(e, &d);
    } else {
        move_force(e, &d);
    }
    wrench_rate(e, c, &d, out);
}

static void put_column(double *matrix, int column, double sign, const double out[12])
{
    for (int r = 0; r < 12; ++r) {
        matrix[12 * r + column] = sign * out[r];
    }
}

/* A translation of one body is the opposite one of the other: 3 columns stand for 6. Those of a
 * body that is fixed nobody reads. */
static void eval_stiffness(const se3di_encounter *e, const geometry *g, double K[144])
{
    double out[12];
    for (int a = 0; a < 3; ++a) {
        se3di_encounter_change pose;
        memset(&pose, 0, sizeof pose);
        pose.r[1][a] = 1.0;
        eval_rate(e, g, &pose, out);
        put_column(K, 6 + a, 1.0, out);
        put_column(K, a, -1.0, out);
    }
    for (int k = 0; k < 2; ++k) {
        const double *A = e->model->frames[e->body[k]].A;
        for (int a = 0; a < 3 && !e->model->bodies[e->body[k]].fixed; ++a) {
            se3di_encounter_change pose;
            memset(&pose, 0, sizeof pose);
            for (int i = 0; i < 3; ++i) {
                pose.turn[k][i] = A[3 * i + a];
            }
            eval_rate(e, g, &pose, out);
            put_column(K, 6 * k + 3 + a, 1.0, out);
        }
    }
}

/* Velocities act by that of j relative to i at the point, and by how fast j turns on i, which only
 * some laws see. */
static void eval_damping(const se3di_encounter *e, const geometry *g, double D[144])
{
    const int is_felt =
        e->law == SE3DI_LAW_CALLBACK || e->pair.rolling > 0.0 || e->pair.torsion > 0.0;
    double slid[3][12], spun[3][12];
    memset(spun, 0, sizeof spun);
    for (int a = 0; a < 3; ++a) {
        se3di_encounter_change speed;
        memset(&speed, 0, sizeof speed);
        speed.v[1][a] = 1.0;
        eval_rate(e, g, &speed, slid[a]);
        put_column(D, 6 + a, 1.0, slid[a]);
        put_column(D, a, -1.0, slid[a]);
        if (is_felt) { /* about the point: without what that turns of the arm */
            memset(&speed, 0, sizeof speed);
            speed.w[1][a] = 1.0;
            se3di_cross(e->arm[1], speed.w[1], speed.v[1]);
            eval_rate(e, g, &speed, spun[a]);
        }
    }
    for (int k = 0; k < 2; ++k) {
        const double *A = e->model->frames[e->body[k]].A;
        for (int a = 0; a < 3; ++a) {
            const double w[3] = {A[a], A[3 + a], A[6 + a]};
            double v[3], out[12];
            se3di_cross(w, e->arm[k], v);
            for (int r = 0; r < 12; ++r) {
                out[r] = v[0] * slid[0][r] + v[1] * slid[1][r] + v[2] * slid[2][r] +
                         w[0] * spun[0][r] + w[1] * spun[1][r] + w[2] * spun[2][r];
            }
            put_column(D, 6 * k + 3 + a, k ? 1.0 : -1.0, out);
        }
    }
}

void se3di_encounter_derivative(const se3di_encounter *e, double K[144], double D[144])
{
    geometry g;
    memset(K, 0, 144 * sizeof *K);
    memset(D, 0, 144 * sizeof *D);
    if (e->normal > 0.0 || e->attraction > 0.0) {
        eval_geometry(e, &g);
        eval_stiffness(e, &g, K);
        eval_damping(e, &g, D);
    }
}
