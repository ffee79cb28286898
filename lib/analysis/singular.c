/* SPDX-License-Identifier: BSD-3-Clause */
/* The motion at t -+ eta is regular and known with its velocities and accelerations; if both sides
 * belong to one smooth motion, the quintic through them gives the state at t:
 *
 *     f   = (f0 + f1)/2 + 5 H/32 (f0' - f1') + H^2/64 (f0'' + f1'')          H = 2 eta
 *     f'  = 15/(8 H) (f1 - f0) - 7/16 (f0' + f1') + H/32 (f1'' - f0'')
 *     f'' = 3/(2 H) (f1' - f0') - 1/4 (f0'' + f1'')
 *
 * for r and p. They do if f1 - f0 = H/2 (f0' + f1') + H^2/12 (f0'' - f1'') + O(H^5); another branch
 * misses this by O(H). Multipliers: the cubic through t -+ eta, t -+ 2 eta, then the least change
 * that balances the forces on the bodies.  docs/theory/kinematics.md */
#include "analysis/singular.h"

#include "math/quaternion.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define TURN_SIDE 0.015 /* rad, or relative to the model's size: eta */
#define SMOOTH    1e-3  /* largest relative mismatch of the two sides */
#define FITS      1e-9  /* largest relative violation of the interpolated position */

enum { COORDINATES = 7 };

typedef struct side {
    double f[COORDINATES], d[COORDINATES], c[COORDINATES]; /* r and p with two derivatives */
} side;

typedef struct passage {
    se3di_equations *equations;
    double t, eta;
    side *sides[2]; /* [dense bodies] */
    double *lambda; /* [rows] */
    size_t bodies, rows;
} passage;

/* Half the way to the other side: short against the turns and shifts of all bodies. */
static double choose_eta(const se3di_equations *equations, double t)
{
    const se3di_model *model = equations->assembly.model;
    double size = se3di_model_get_size(model);
    double rate = 0.0;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        const se3di_frame *frame = &model->frames[k];
        if (model->bodies[k].state == 0) {
            rate = fmax(rate, fmax(se3di_norm(frame->w), se3di_norm(frame->v) / size));
        }
    }
    double half = 0.5 * (t - model->time);
    return rate * half > TURN_SIDE ? TURN_SIDE / rate : half;
}

static void record(const passage *p, side *sides)
{
    const se3di_model *model = p->equations->assembly.model;
    for (size_t k = 0; k < p->bodies; ++k) {
        const se3di_frame *frame = &model->frames[k];
        const double *a = model->acceleration + 6 * k;
        se3di_copy(frame->r, sides[k].f);
        se3di_copy(frame->v, sides[k].d);
        se3di_copy(a, sides[k].c);
        memcpy(sides[k].f + 3, frame->p, sizeof frame->p);
        memcpy(sides[k].d + 3, frame->pdot, sizeof frame->pdot);
        se3di_quat_acceleration(frame->p, frame->w, a + 3, sides[k].c + 3);
    }
}

/* Visit t - 2 eta, t - eta, t + eta, t + 2 eta. */
static se3d_status visit(passage *p)
{
    static const double stations[4] = {-2.0, -1.0, 1.0, 2.0};
    static const double weights[4] = {-1.0 / 6.0, 4.0 / 6.0, 4.0 / 6.0, -1.0 / 6.0};
    const se3di_model *model = p->equations->assembly.model;
    for (int k = 0; k < 4; ++k) {
        SE3DI_TRY(se3di_kinematics_advance(p->equations, p->t + stations[k] * p->eta));
        for (size_t r = 0; r < p->rows; ++r) {
            p->lambda[r] += weights[k] * model->lambda[r];
        }
        if (k == 1 || k == 2) {
            record(p, p->sides[k - 1]);
        }
    }
    return SE3D_OK;
}

static int is_smooth(const passage *p)
{
    double H = 2.0 * p->eta;
    double worst = 0.0, scale = 1e-9;
    for (size_t b = 0; b < p->bodies; ++b) {
        const side *s = &p->sides[0][b], *e = &p->sides[1][b];
        for (int k = 0; k < COORDINATES; ++k) {
            double step = 0.5 * H * (s->d[k] + e->d[k]) + H * H / 12.0 * (s->c[k] - e->c[k]);
            worst = fmax(worst, fabs(e->f[k] - s->f[k] - step));
            scale = fmax(scale, H * fmax(fabs(s->d[k]), fabs(e->d[k])));
        }
    }
    return worst <= SMOOTH * scale;
}

static void interpolate(const passage *p)
{
    se3di_model *model = p->equations->assembly.model;
    double H = 2.0 * p->eta;
    for (size_t b = 0; b < p->bodies; ++b) {
        const side *s = &p->sides[0][b], *e = &p->sides[1][b];
        se3di_frame *frame = &model->frames[b];
        side at;
        if (model->bodies[b].fixed) {
            continue;
        }
        for (int k = 0; k < COORDINATES; ++k) {
            at.f[k] = 0.5 * (s->f[k] + e->f[k]) + 5.0 * H / 32.0 * (s->d[k] - e->d[k]) +
                      H * H / 64.0 * (s->c[k] + e->c[k]);
            at.d[k] = 15.0 / (8.0 * H) * (e->f[k] - s->f[k]) - 7.0 / 16.0 * (s->d[k] + e->d[k]) +
                      H / 32.0 * (e->c[k] - s->c[k]);
            at.c[k] = 1.5 / H * (e->d[k] - s->d[k]) - 0.25 * (s->c[k] + e->c[k]);
        }
        se3di_copy(at.f, frame->r);
        se3di_copy(at.d, frame->v);
        se3di_quat_normalize(at.f + 3, frame->p);
        se3di_quat_angular_velocity(frame->p, at.d + 3, frame->w);
        se3di_frame_update(frame);
        se3di_copy(at.c, model->acceleration + 6 * b);
        se3di_quat_angular_velocity(frame->p, at.c + 3, model->acceleration + 6 * b + 3);
    }
}

/* lambda += the least change with M qddot + Phi_q^T lambda = Q. */
static se3d_status balance(const passage *p)
{
    se3di_equations *equations = p->equations;
    se3di_assembly *assembly = &equations->assembly;
    SE3DI_TRY(se3di_equations_factor(equations));
    SE3DI_TRY(se3di_assembly_eval_forces(assembly, p->t, equations->b, equations->error));
    se3di_assembly_add_transposed(assembly, -1.0, p->lambda, equations->b);
    se3di_assembly_get_acceleration(assembly, equations->probe);
    se3di_assembly_subtract_inertia(assembly, equations->probe, equations->b);
    memset(equations->c, 0, assembly->row_count * sizeof *equations->c);
    SE3DI_TRY(se3di_equations_solve(equations));
    for (size_t r = 0; r < p->rows; ++r) {
        assembly->model->lambda[r] = p->lambda[r] + equations->l[r];
    }
    return SE3D_OK;
}

static se3d_status pass(passage *p)
{
    se3di_equations *equations = p->equations;
    char gap[200];
    SE3DI_TRY(visit(p));
    int smooth = is_smooth(p);
    if (smooth) {
        interpolate(p);
        equations->assembly.model->time = p->t;
        SE3DI_TRY(se3di_assembly_eval_functions(&equations->assembly, p->t, equations->error));
        smooth = se3di_position_measure(equations, gap, sizeof gap) <= FITS;
    }
    if (!smooth) {
        return se3di_error_set(equations->error, SE3D_ERR_SINGULAR,
                               "t = %g s: at this singular position the mechanism may move on in "
                               "more than one way, and the motion before it does not decide which",
                               p->t);
    }
    return balance(p);
}

se3d_status se3di_singular_pass(se3di_equations *equations, double t)
{
    const se3di_assembly *assembly = &equations->assembly;
    const se3d_allocator *allocator = &assembly->model->allocator;
    passage p = {.equations = equations,
                 .t = t,
                 .eta = choose_eta(equations, t),
                 .bodies = assembly->dense_count,
                 .rows = assembly->row_count};
    p.sides[0] = se3di_alloc(allocator, p.bodies, sizeof(side));
    p.sides[1] = se3di_alloc(allocator, p.bodies, sizeof(side));
    p.lambda = se3di_alloc(allocator, p.rows, sizeof(double));
    se3d_status status = SE3D_ERR_NO_MEMORY;
    if (p.sides[0] && p.sides[1] && p.lambda) {
        memset(p.lambda, 0, p.rows * sizeof *p.lambda);
        status = pass(&p);
    } else {
        se3di_error_set(equations->error, status, "no memory to pass a singular position");
    }
    se3di_free(allocator, p.lambda, p.rows, sizeof(double));
    se3di_free(allocator, p.sides[1], p.bodies, sizeof(side));
    se3di_free(allocator, p.sides[0], p.bodies, sizeof(side));
    return status;
}
