/* SPDX-License-Identifier: BSD-3-Clause */
/* The estimate of the error of a step of the Newmark family, from the third derivative j of the
 * motion by differences of velocities:
 *
 *     error = PHASE C h^2 |j| / V,   C = |d_n/(2 h) + beta s/h - 1/6| + 1/12
 *
 * Vibrations that are far too fast for the step ring with it: their velocities change sign at every
 * step and fall by the method's damping only, so that the estimate falls with h, however small they
 * are. What they are in the motion is what the Newton matrix leaves of them,
 *
 *     (M + g D + b K) j' = M j,   Phi_q j' = 0
 *
 * which changes slow motions by a part h^2 and divides vibrations of frequency w by b w^2.
 * docs/theory/newmark.md */
#include "integrator/newmark.h"

#include "math/larger.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define PHASE          12.0 /* rad of the motion over which local errors add up */
#define STAYS          0.81 /* error after which the next step is as long: vibrations grow */
#define SHIFT_WEIGHT   0.1  /* of z beside j, which sees the same where all is well */
#define SHIFT_ROUNDING 1e-9 /* of the size, or of a turn of 1 rad: z of rounding */

/* The largest velocities of the model's state, or what its accelerations make on the way of its
 * length and a turn of 1 rad: [0] of translation, [1] of rotation. */
void se3di_newmark_find_scales(const se3di_assembly *assembly, const double *vdot, double scale[2])
{
    const double length = se3di_newmark_get_history(assembly).header->scale.length;
    double a = 0.0, wdot = 0.0;
    scale[0] = scale[1] = 1e-12;
    for (size_t k = 0; k < assembly->body_count; ++k) {
        const se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        if (se3di_state_is_carrier(assembly, k)) {
            continue;
        }
        scale[0] = fmax(scale[0], se3di_norm(frame->v));
        scale[1] = fmax(scale[1], se3di_norm(frame->w));
        a = fmax(a, se3di_norm(vdot + 6 * k));
        wdot = fmax(wdot, se3di_norm(vdot + 6 * k + 3));
    }
    scale[0] = fmax(scale[0], sqrt(a * length));
    scale[1] = fmax(scale[1], sqrt(wdot));
}

/* C of the step. */
static double get_constant(const se3di_newmark_step *step, double place)
{
    const double span = (0.5 - place) / step->gamma;
    return fabs(0.5 * place + step->beta * span - 1.0 / 6.0) + 1.0 / 12.0;
}

/* The third derivative of the motion. */
static void eval_jerk(const se3di_newmark_step *step, const se3di_newmark_history *past,
                      double *jerk)
{
    const double last = past->header->last, h = step->h;
    for (size_t k = 0; k < step->assembly->unknown_count; ++k) {
        const se3di_frame *frame = &step->assembly->model->frames[step->assembly->free_body[k / 6]];
        const double v = k % 6 < 3 ? frame->v[k % 6] : frame->w[k % 6 - 3];
        const double before = past->y_begin[SE3DI_STATE_SIZE * (k / 6) + 7 + k % 6];
        const double mean = last > 0.0 ? (step->v_n[k] - before) / last : step->vdot_n[k];
        jerk[k] = 2.0 * ((v - step->v_n[k]) / h - mean) / (h + last);
    }
}

/* The local error of velocities in a unit of time in which they change by themselves, added up over
 * PHASE such units, relative to the tolerance. */
static double measure(const se3di_newmark_step *step, const se3di_newmark_header *header,
                      const double *jerk)
{
    double worst = 0.0, scale[2];
    se3di_newmark_find_scales(step->assembly, step->vdot, scale);
    for (size_t k = 0; k < step->assembly->unknown_count; ++k) {
        const size_t kind = k % 6 / 3;
        const double change[6] = {fabs(jerk[k])};
        const double size =
            se3di_state_is_carrier(step->assembly, k / 6)
                ? se3di_state_part(step->assembly, k / 6, &header->scale, change)
                : change[0] / fmax(scale[kind], kind ? header->scale.spin : header->scale.speed);
        worst = se3di_larger(worst, size);
    }
    return PHASE * get_constant(step, header->place / step->h) * step->h * step->h * worst /
           fmax(step->integration->settings.tolerance, SE3DI_NEWMARK_REACH);
}

/* The largest velocities of the model's state, of translation and of rotation. */
static void find_velocities(const se3di_assembly *assembly, double speed[2])
{
    speed[0] = speed[1] = 0.0;
    for (size_t k = 0; k < assembly->body_count; ++k) {
        const se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        if (!se3di_state_is_carrier(assembly, k)) {
            speed[0] = fmax(speed[0], se3di_norm(frame->v));
            speed[1] = fmax(speed[1], se3di_norm(frame->w));
        }
    }
}

double se3di_newmark_measure_shift(const se3di_newmark_step *step, int bears_growth)
{
    const se3di_newmark_header *header = se3di_newmark_get_history(step->assembly).header;
    const double sizes[2] = {header->scale.length, 1.0};
    const double kept[2] = {header->scale.speed, header->scale.spin};
    const double part = bears_growth ? step->h * step->beta / step->gamma : 0.0;
    double worst = 0.0, speed[2];
    if (bears_growth) {
        find_velocities(step->assembly, speed);
    } else {
        se3di_newmark_find_scales(step->assembly, step->vdot, speed);
    }
    for (size_t k = 0; k < step->assembly->unknown_count; k += 3) {
        const size_t kind = k % 6 / 3;
        const double growth = fmax(0.0, speed[kind] - kept[kind]);
        const double borne = SHIFT_ROUNDING * sizes[kind] + part * growth;
        const double shift = se3di_norm(step->z + k) - borne;
        if (!se3di_state_is_carrier(step->assembly, k / 6)) {
            worst = se3di_larger(worst, shift / fmax(speed[kind], kept[kind]));
        }
    }
    return worst / step->h;
}

/* j' into equations->x: at the end of the step, as forces that are out of balance on the way there
 * would add stiffness. */
static se3d_status filter(se3di_newmark_step *step, const double *jerk)
{
    se3di_equations *equations = step->equations;
    double *minus = step->dz;
    se3di_assembly_eval_jacobian(step->assembly);
    SE3DI_TRY(se3di_newmark_factor(step));
    for (uint32_t k = 0; k < step->assembly->unknown_count; ++k) {
        minus[k] = -jerk[k];
    }
    memset(equations->b, 0, step->assembly->unknown_count * sizeof *equations->b);
    memset(equations->c, 0, step->assembly->row_count * sizeof *equations->c);
    se3di_assembly_subtract_mass(step->assembly, minus, equations->b);
    return se3di_newton_solve(&step->integration->newton);
}

se3d_status se3di_newmark_estimate(se3di_newmark_step *step, double most, double *error)
{
    const se3di_newmark_history past = se3di_newmark_get_history(step->assembly);
    double *jerk = step->b;
    *error = 0.0;
    if (!(most > 0.0)) {
        return SE3D_OK;
    }
    eval_jerk(step, &past, jerk);
    *error = measure(step, past.header, jerk);
    if (step->exact && *error > most && isfinite(*error)) {
        SE3DI_TRY(filter(step, jerk));
        *error = fmin(*error, se3di_larger(STAYS, measure(step, past.header, step->equations->x)));
    }
    const double shift = PHASE * SHIFT_WEIGHT * se3di_newmark_measure_shift(step, 0) /
                         fmax(step->integration->settings.tolerance, SE3DI_NEWMARK_REACH);
    *error = se3di_larger(*error, shift);
    return SE3D_OK;
}
