/* SPDX-License-Identifier: BSD-3-Clause */
/* The state of explicit methods as that of the bodies. */
#include "integrator/motion.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"

#include <string.h>

static size_t count(const se3di_equations *equations)
{
    return se3di_state_count(&equations->assembly);
}

static void get(se3di_equations *equations, double *y)
{
    se3di_state_get(&equations->assembly, y);
}

static void set(se3di_equations *equations, const double *y)
{
    se3di_state_set(&equations->assembly, y);
}

static se3d_status derive(se3di_equations *equations, double t, const double *l, double *derivative)
{
    return se3di_state_derivative(&equations->assembly, t, equations->x, l, derivative);
}

static se3d_status evaluate(se3di_equations *equations, double t, double *derivative)
{
    SE3DI_TRY(se3di_state_evaluate(equations, t));
    return se3di_state_derivative_of(equations, t, derivative);
}

static se3d_status evaluate_at(se3di_equations *equations, double t, const double *y,
                               double *derivative)
{
    set(equations, y);
    return evaluate(equations, t, derivative);
}

static void move(const se3di_equations *equations, const double *y, double *derivative)
{
    for (uint32_t k = 0; k < equations->assembly.body_count; ++k) {
        double p[4];
        se3di_quat_normalize(y + 3, p);
        se3di_copy(y + 7, derivative);
        se3di_quat_rate(p, y + 10, derivative + 3);
        y += SE3DI_STATE_SIZE;
        derivative += SE3DI_STATE_SIZE;
    }
}

/* Changes and rates are those of the bodies already. */
static const double *pass(se3di_equations *equations, const double *y, double *out)
{
    (void)equations, (void)out;
    return y;
}

static void stand(se3di_equations *equations, const double *y)
{
    (void)equations, (void)y;
}

static void follow(se3di_equations *equations)
{
    (void)equations;
}

static void accept_angles(se3di_equations *equations)
{
    se3di_angles_accept(equations->assembly.model);
}

static void show(se3di_equations *equations, const double *y, double *bodies)
{
    memcpy(bodies, y, se3di_state_count(&equations->assembly) * sizeof *y);
}

static int finds_all(const se3di_equations *equations)
{
    (void)equations;
    return 0;
}

static int set_frames(se3di_equations *equations, const double *y)
{
    set(equations, y);
    return 0;
}

static double count_dependent(const se3di_equations *equations)
{
    return se3di_kkt_get_dependent_rows(equations->kkt);
}

const se3di_motion se3di_motion_bodies = {
    .count = count,
    .get = get,
    .set = set,
    .set_again = set,
    .set_frames = set_frames,
    .get_rates = pass,
    .evaluate = evaluate,
    .evaluate_at = evaluate_at,
    .derive = derive,
    .move = move,
    .spread = pass,
    .project = se3di_state_project,
    .measure_gap = se3di_state_measure_gap,
    .keep = get,
    .stand = stand,
    .follow = follow,
    .accept_angles = accept_angles,
    .show = show,
    .finds_all = finds_all,
    .may_report = finds_all,
    .are_all_plain = finds_all,
    .can_wait = finds_all,
    .count_dependent = count_dependent,
};

const se3di_motion *se3di_motion_find(const se3di_equations *equations)
{
    const se3di_model *model = equations->assembly.model;
    return equations->tree && model->left_out_count == model->broken_count ? &se3di_motion_joints
                                                                           : &se3di_motion_bodies;
}
