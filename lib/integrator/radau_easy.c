/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/radau_easy.h"

#include "integrator/explicit_rk.h"
#include "math/elementary.h"

#include <math.h>
#include <string.h>

#define PAIRS       6    /* of multiplications, */
#define PAIRS_FIRST 2    /* and those of them that growth is not measured in */
#define LOOKS       16.0 /* steps from one look to the next */
#define PATIENCE    8.0  /* steps in a row, */
#define DOUBLED     10.0 /* twice as many after each return, up to so many of them */
#define GOLDEN      0.6180339887498949

/* w = M^-1 (-K q - D v) on the constraints, D v from the Newton matrix M + c D + c^2 K. */
static se3d_status differentiate(se3di_radau *m, const double *q, const double *v, double *w)
{
    se3di_equations *equations = m->equations;
    const se3di_newton *newton = &m->integration->newton;
    const size_t n = m->assembly->unknown_count;
    const double c = se3di_radau_gamma * m->h;
    memset(w, 0, n * sizeof *w);
    se3di_newton_add_matrix(newton, v, w);
    se3di_assembly_subtract_mass(m->assembly, v, w);
    se3di_tangent_add_stiffness(&newton->tangent, -c * c, v, w);
    for (size_t k = 0; k < n; ++k) {
        equations->b[k] = -w[k] / c;
    }
    se3di_tangent_add_stiffness(&newton->tangent, -1.0, q, equations->b);
    SE3DI_TRY(se3di_equations_solve(equations));
    memcpy(w, equations->x, n * sizeof *w);
    return SE3D_OK;
}

/* @return sqrt(v^T M v), by which q and v are divided */
static double normalise(se3di_radau *m, double *q, double *v)
{
    const size_t n = m->assembly->unknown_count;
    double *minus_Mv = m->equations->b, square = 0.0;
    memset(minus_Mv, 0, n * sizeof *minus_Mv);
    se3di_assembly_subtract_mass(m->assembly, v, minus_Mv);
    for (size_t k = 0; k < n; ++k) {
        square -= v[k] * minus_Mv[k];
    }
    const double size = sqrt(fmax(square, 0.0));
    for (size_t k = 0; k < n && size > 0.0; ++k) {
        q[k] /= size;
        v[k] /= size;
    }
    return size;
}

/* Any velocities that the constraints allow. */
static se3d_status set_start(se3di_radau *m, double *q, double *v)
{
    se3di_equations *equations = m->equations;
    const size_t n = m->assembly->unknown_count;
    SE3DI_TRY(se3di_equations_factor(equations));
    memset(equations->c, 0, m->assembly->row_count * sizeof *equations->c);
    for (size_t k = 0; k < n; ++k) {
        const double turns = GOLDEN * (double)(k + 1); /* no two bodies are alike */
        equations->b[k] = 1.0 + turns - floor(turns);
        q[k] = 0.0;
    }
    SE3DI_TRY(se3di_equations_solve(equations));
    memcpy(v, equations->x, n * sizeof *v);
    (void)normalise(m, q, v);
    return SE3D_OK;
}

/* Velocities are compared over two multiplications: in one, those of an oscillation become
 * positions. */
static se3d_status find_rate(se3di_radau *m, double *rate)
{
    const size_t n = m->assembly->unknown_count;
    double *q = m->u, *v = q + n, *w = v + n, growth = 1.0;
    SE3DI_TRY(set_start(m, q, v));
    for (int k = 0; k < PAIRS; ++k) {
        SE3DI_TRY(differentiate(m, q, v, w));
        SE3DI_TRY(differentiate(m, v, w, q));
        double *const free = v;
        v = q;
        q = w;
        w = free;
        const double size = normalise(m, q, v);
        growth *= k < PAIRS_FIRST ? 1.0 : se3di_pow(size, 0.5 / (PAIRS - PAIRS_FIRST));
    }
    *rate = growth;
    return SE3D_OK;
}

/* HUGE_VAL: it is not known. */
static double measure_rate(se3di_radau *m)
{
    se3di_equations *equations = m->equations;
    se3di_error *const error = equations->error, inner = {0};
    double rate = HUGE_VAL;
    equations->error = &inner;
    const se3di_kkt_settings before = se3di_state_begin(equations, 1e-8, 1e-13);
    const se3d_status status = find_rate(m, &rate);
    se3di_state_end(equations, &before);
    equations->error = error;
    return status >= 0 && isfinite(rate) ? rate : HUGE_VAL;
}

void se3di_radau_watch_ease(se3di_radau *m, const se3di_adaptive_history *at,
                            se3di_radau_ease *ease)
{
    if (m->assembly->model->contacts.pair_count > 0) {
        *ease = (se3di_radau_ease){0};
        return;
    }
    if (!(ease->until > 0.0)) {
        ease->rate = measure_rate(m);
        ease->until = LOOKS;
    }
    ease->until -= 1.0;
    const int is_easy = at->next * ease->rate < se3di_integrator_dop853.tableau->stable;
    ease->count = is_easy ? ease->count + 1.0 : 0.0;
    ease->is_over = ease->count >= ldexp(PATIENCE, (int)fmax(0.0, fmin(at->returns, DOUBLED)));
}
