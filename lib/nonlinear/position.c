/* SPDX-License-Identifier: BSD-3-Clause */
/* Positions: min |dq|_M with Phi(q, t) = 0, by Newton with line search; if that stalls (far from
 * a solution, or if there is none) by damped Gauss-Newton (Levenberg-Marquardt: the KKT system
 * with a large regularisation), which ends in the least sum of squared violations. A stationary
 * violation means that the constraints cannot be met from here: the gap is named.
 * docs/theory/consistency.md */
#include "nonlinear/equations.h"

#include "math/elementary.h"
#include "math/larger.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define DAMPED_ITERATIONS 200
#define GAP_MAX           100.0 /* sizes; a larger one is the size */
#define CORRECTIONS       10
#define DISTURBANCE       0.03 /* [rad], of the size */
#define DIGITS            1e-4 /* of the size: what dimensions of four digits leave open */

typedef struct position_problem {
    se3di_equations *equations;
    double size;    /* of the mechanism [m] */
    double merit;   /* sum of squared violations: scaled, or as they are while `damped` */
    double worst;   /* largest scaled violation */
    uint32_t where; /* its row */
    int32_t damped; /* the damped step descends in the plain sum */
} position_problem;

static void measure(position_problem *problem)
{
    se3di_equations *equations = problem->equations;
    const se3di_assembly *assembly = &equations->assembly;
    se3di_assembly_eval_phi(assembly, equations->phi);
    problem->merit = 0.0;
    problem->worst = 0.0;
    problem->where = 0;
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        double scaled =
            fabs(equations->phi[k]) / se3di_row_get_scale(assembly->model, k, problem->size);
        double part = problem->damped ? equations->phi[k] : scaled;
        problem->merit += part * part;
        if (!(scaled <= problem->worst)) {
            problem->worst = scaled;
            problem->where = k;
        }
    }
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        double gap =
            assembly->formulation->normalisation(&assembly->model->frames[assembly->free_body[k]]);
        problem->merit += gap * gap;
        problem->worst = se3di_larger(problem->worst, fabs(gap));
    }
}

/* Newton or damped step into x; its largest turn or relative shift is returned in *length. */
static se3d_status compute_step(position_problem *problem, double *length)
{
    se3di_equations *equations = problem->equations;
    const se3di_assembly *assembly = &equations->assembly;
    size_t n = (size_t)assembly->formulation->block;
    SE3DI_TRY(se3di_equations_factor(equations));
    memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
    for (size_t k = 0; k < assembly->body_count; ++k) {
        if (n == 8) {
            equations->b[k * n + 7] = assembly->formulation->normalisation(
                &assembly->model->frames[assembly->free_body[k]]);
        }
    }
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] = -equations->phi[k];
    }
    SE3DI_TRY(se3di_equations_solve(equations));
    ++equations->counters.iterations;
    *length = 0.0;
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        size_t part = k % n;
        double weight = part < 3 ? 1.0 / problem->size : n == 8 ? 2.0 : 1.0;
        *length = part < 7 ? fmax(*length, weight * fabs(equations->x[k])) : *length;
    }
    return SE3D_OK;
}

static void move(const position_problem *problem, double fraction)
{
    se3di_equations *equations = problem->equations;
    const se3di_assembly *assembly = &equations->assembly;
    size_t n = (size_t)assembly->formulation->block;
    double dq[SE3DI_BLOCK_MAX];
    se3di_equations_restore(equations);
    for (size_t k = 0; k < assembly->body_count; ++k) {
        if (se3di_equations_holds(equations, assembly->free_body[k])) {
            continue;
        }
        for (size_t c = 0; c < n; ++c) {
            dq[c] = fraction * equations->x[k * n + c];
        }
        se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        assembly->formulation->move(frame, dq);
        se3di_quat_normalize(frame->p, frame->p); /* a damped step must only fight the violation */
        se3di_frame_update(frame);
    }
}

/* Take the step, shortened until the violation falls. Returns 0 if it does not. */
static int search_line(position_problem *problem, double length)
{
    double merit = problem->merit;
    double fraction = length > 1.0 ? 1.0 / length : 1.0;
    se3di_equations_save(problem->equations);
    for (int halvings = 0; halvings < 12; ++halvings, fraction *= 0.5) {
        move(problem, fraction);
        measure(problem);
        if (problem->merit <= (1.0 - 1e-4 * fraction) * merit) {
            return 1;
        }
    }
    se3di_equations_restore(problem->equations);
    measure(problem);
    return 0;
}

/* Newton until rounding. Returns with *converged = 0 if it stalls. */
static se3d_status run_newton(position_problem *problem, int32_t iterations, int *converged)
{
    se3di_equations *equations = problem->equations;
    *converged = 0;
    for (int32_t k = 0; k <= iterations; ++k) {
        double length;
        SE3DI_TRY(se3di_equations_ask(equations));
        if (problem->worst <= 1e-15) {
            *converged = 1;
            return SE3D_OK;
        }
        SE3DI_TRY(compute_step(problem, &length));
        int fell = search_line(problem, length);
        if (!isfinite(problem->worst)) {
            return se3di_error_set(equations->error, SE3D_ERR_NOT_FINITE,
                                   "t = %g s: a constraint is not finite",
                                   equations->assembly.model->time);
        }
        if ((length < 1e-7 || !fell) && problem->worst < 1e-11) {
            *converged = 1;
            return SE3D_OK;
        }
        if (!fell) {
            return SE3D_OK;
        }
    }
    return SE3D_OK;
}

/* Damped steps: the regularised system without refinement. Ends where the violation is below
 * `target`, or at the least violation. */
static se3d_status run_damped(position_problem *problem, double target, int *stationary)
{
    se3di_equations *equations = problem->equations;
    se3di_kkt_settings exact = se3di_kkt_get_settings(equations->kkt);
    se3di_kkt_settings damped = exact;
    se3d_status status = SE3D_OK;
    damped.max_refinements = 0;
    damped.regularise = SE3DI_KKT_REGULARISE_FIRST;
    double damping = 1e-2;
    double length = 1.0;
    int slow = 0;
    *stationary = 0;
    problem->damped = 1;
    measure(problem);
    for (int k = 0; k < DAMPED_ITERATIONS && problem->worst > target && !*stationary; ++k) {
        double before = problem->merit;
        damped.eps = damping;
        damped.eps_min = damping;
        se3di_kkt_set_settings(equations->kkt, &damped);
        status = se3di_equations_ask(equations);
        status = status < 0 ? status : compute_step(problem, &length);
        if (status < 0) {
            break;
        }
        int fell = search_line(problem, length);
        damping = fell ? fmax(damping * 0.3, 1e-6) : damping * 10.0;
        slow = fell && before - problem->merit < 1e-12 * before ? slow + 1 : 0;
        *stationary = slow > 1 || damping > 1e6;
    }
    problem->damped = 0;
    measure(problem);
    se3di_kkt_set_settings(equations->kkt, &exact);
    return status;
}

/* ---- what is open ---- */

typedef struct open_joint {
    double length; /* [m] */
    double angle;  /* [rad], or a cosine */
} open_joint;

/* By how much a constraint is open. */
static open_joint measure_joint(const se3di_equations *equations,
                                const se3di_constraint *constraint)
{
    const se3di_model *model = equations->assembly.model;
    open_joint open = {0.0, 0.0};
    for (uint32_t k = 0; k < constraint->row_count; ++k) {
        uint32_t row = constraint->row_begin + k;
        double phi = equations->phi[row];
        switch (se3di_row_get_type(model, row)) {
        case SE3DI_PRIMITIVE_D: {
            double f = equations->assembly.f[3 * row];
            phi = sqrt(fmax(phi + f, 0.0)) - sqrt(fmax(f, 0.0));
            open.length = se3di_hypot(open.length, phi);
            break;
        }
        case SE3DI_PRIMITIVE_CD:
        case SE3DI_PRIMITIVE_DP2:
        case SE3DI_PRIMITIVE_TRIPLE:
            open.length = se3di_hypot(open.length, phi);
            break;
        default:
            open.angle = fmax(open.angle, fabs(phi));
            break;
        }
    }
    return open;
}

static void name_constraint(const se3di_model *model, uint32_t k, char *text, size_t size)
{
    const se3di_constraint *constraint = &model->constraints[k];
    if (constraint->name) {
        snprintf(text, size, "%.80s", constraint->name);
    } else {
        snprintf(text, size, "%s %u", constraint->type, k);
    }
}

/* The joint that is open the widest (of equal ones the last, which closes the loop), and the sum of
 * all gaps: around a loop whose links do not reach, the length that is missing. */
static uint32_t find_widest(const se3di_equations *equations, double *widest, double *total)
{
    const se3di_assembly *assembly = &equations->assembly;
    uint32_t where = assembly->constraint_count;
    *widest = *total = 0.0;
    for (uint32_t k = 0; k < assembly->constraint_count; ++k) {
        double length = measure_joint(equations, &assembly->model->constraints[k]).length;
        *total += length;
        if (length > 0.0 && length >= 0.999 * *widest) {
            where = k;
            *widest = fmax(*widest, length);
        }
    }
    return where;
}

/* " (A 0.25 m, B 0.25 m)": the joints with a part in the gap. */
static void list_open(const se3di_equations *equations, double widest, char *text, size_t size)
{
    const se3di_assembly *assembly = &equations->assembly;
    size_t count = 0;
    text[0] = '\0';
    for (uint32_t k = 0; k < assembly->constraint_count && count < 6; ++k) {
        double length = measure_joint(equations, &assembly->model->constraints[k]).length;
        if (length > 1e-3 * widest) {
            char name[100];
            size_t used = strlen(text);
            name_constraint(assembly->model, k, name, sizeof name);
            snprintf(text + used, size - used, "%s%.40s %.3g m", count > 0 ? ", " : "", name,
                     length);
            ++count;
        }
    }
}

/* What is open: lengths, or if there are none the worst angle. Only at the least violation do
 * the gaps around a loop add up to what is missing. */
static void describe_gap(const position_problem *problem, int least, char *text, size_t size)
{
    const se3di_equations *equations = problem->equations;
    const se3di_model *model = equations->assembly.model;
    double widest, total;
    char name[128];
    uint32_t joint = find_widest(equations, &widest, &total);
    if (joint == equations->assembly.constraint_count || widest < 1e-3 * problem->worst) {
        if (equations->assembly.row_count == 0) {
            snprintf(text, size, "no constraint is open");
            return;
        }
        se3di_row_name(model, problem->where, name, sizeof name);
        snprintf(text, size, "%s is off by %.6g%s", name, equations->phi[problem->where],
                 se3di_row_get_unit(model, problem->where));
        return;
    }
    name_constraint(model, joint, name, sizeof name);
    if (total < 1.001 * widest) {
        snprintf(text, size, "%s is open by %.6g m", name, widest);
        return;
    }
    char list[200];
    list_open(equations, widest, list, sizeof list);
    if (least) {
        snprintf(text, size, "%s is open by %.6g m, spread over its loop (%s)", name, total, list);
    } else {
        snprintf(text, size, "%s is open by %.6g m (of all: %s)", name, widest, list);
    }
}

double se3di_position_measure(se3di_equations *equations, char *text, size_t size)
{
    position_problem problem = {.equations = equations};
    problem.size = se3di_model_get_size(equations->assembly.model);
    measure(&problem);
    describe_gap(&problem, 0, text, size);
    return problem.worst;
}

/* ", the driver push locks", if a driver has a part in the gap. */
static void describe_lock(const se3di_equations *equations, char *text, size_t size)
{
    const se3di_assembly *assembly = &equations->assembly;
    double widest, total;
    text[0] = '\0';
    (void)find_widest(equations, &widest, &total);
    for (uint32_t k = 0; k < assembly->constraint_count; ++k) {
        const se3di_constraint *constraint = &assembly->model->constraints[k];
        open_joint open = measure_joint(equations, constraint);
        int takes_part = open.length > 1e-3 * widest && open.length > 0.0;
        if (strcmp(constraint->type, "driver") == 0 && (takes_part || open.angle > 1e-9)) {
            char name[100];
            name_constraint(assembly->model, k, name, sizeof name);
            snprintf(text, size, ", the driver %s asks for more than the mechanism can reach",
                     name);
            return;
        }
    }
}

/* ", but body a is held", if all bodies of an open constraint that could move are. */
static int describe_held(const se3di_equations *equations, char *text, size_t size)
{
    const se3di_assembly *assembly = &equations->assembly;
    double widest, total;
    (void)find_widest(equations, &widest, &total);
    for (uint32_t k = 0; k < assembly->constraint_count; ++k) {
        const open_joint open = measure_joint(equations, &assembly->model->constraints[k]);
        int held = open.length > 1e-3 * widest || open.angle > 1e-9;
        uint32_t body = 0;
        for (int32_t e = assembly->joint_begin[k]; e < assembly->joint_begin[k + 1]; ++e) {
            body = assembly->free_body[assembly->joint_body[e]];
            held = held && se3di_equations_holds(equations, body);
        }
        if (held && assembly->joint_begin[k] < assembly->joint_begin[k + 1]) {
            const char *name = assembly->model->bodies[body].name;
            char joint[100];
            name_constraint(assembly->model, k, joint, sizeof joint);
            snprintf(text, size, "%s requires body %.64s to move, but it is held", joint,
                     name ? name : "without a name");
            return 1;
        }
    }
    return 0;
}

/* Violations that dimensions of few digits leave. */
static se3d_status report_digits(const position_problem *problem, double t, const char *gap)
{
    return se3di_error_set(
        problem->equations->error, SE3D_ERR_INCONSISTENT,
        "t = %g s: the constraints fit to %.2g of the size of the mechanism, but not exactly: %s; "
        "give positions, axes and dimensions more digits, or put a joint with more freedom into "
        "the loop, such as a spherical one",
        t, problem->worst, gap);
}

static se3d_status report_gap(const position_problem *problem, double t, int stationary)
{
    char gap[400];
    char held[240];
    describe_gap(problem, stationary, gap, sizeof gap);
    if (problem->equations->hold && describe_held(problem->equations, held, sizeof held)) {
        return se3di_error_set(problem->equations->error, SE3D_ERR_INCONSISTENT,
                               "t = %g s: the constraints cannot be met: %s (%s); give it the pose "
                               "that the constraints require, or do not hold it",
                               t, held, gap);
    }
    char lock[180];
    describe_lock(problem->equations, lock, sizeof lock);
    if (problem->worst < DIGITS && !lock[0]) {
        return report_digits(problem, t, gap);
    }
    if (stationary) {
        return se3di_error_set(
            problem->equations->error, SE3D_ERR_INCONSISTENT,
            "t = %g s: the constraints cannot be met: %s at the least violation%s; "
            "the mechanism is locked, over-constrained, or its parts cannot reach each other",
            t, gap, lock);
    }
    return se3di_error_set(
        problem->equations->error, SE3D_ERR_NO_CONVERGENCE,
        "t = %g s: the positions did not converge: %s; the initial poses are too "
        "far from an assembled one, or the step is too large",
        t, gap);
}

/* A mechanism whose points all lie at the origins of their bodies has no size of its own: what it
 * is open by is one, else a step would be limited to nothing. */
static void widen(position_problem *problem)
{
    const se3di_equations *equations = problem->equations;
    double gap = 0.0;
    for (uint32_t k = 0; k < equations->assembly.constraint_count; ++k) {
        gap =
            fmax(gap, measure_joint(equations, &equations->assembly.model->constraints[k]).length);
    }
    if (gap > GAP_MAX * problem->size) {
        problem->size = gap;
        measure(problem);
    }
}

static void update_frames(se3di_equations *equations)
{
    for (uint32_t k = 0; k < equations->assembly.dense_count; ++k) {
        if (equations->assembly.free_index[k] >= 0) {
            se3di_frame_update(&equations->assembly.model->frames[k]);
        }
    }
}

/* Newton, and where it stalls damped steps. */
static se3d_status approach(position_problem *problem, int *converged, int *stationary)
{
    se3di_equations *equations = problem->equations;
    *stationary = 0;
    SE3DI_TRY(run_newton(problem, equations->iterations_max, converged));
    for (int round = 0; round < 3 && !*converged && !*stationary; ++round) {
        SE3DI_TRY(run_damped(problem, round == 0 ? 1e-4 : 1e-11, stationary));
        if (problem->worst < 1e-2) {
            SE3DI_TRY(run_newton(problem, equations->iterations_max, converged));
        }
    }
    return SE3D_OK;
}

/* All bodies a little aside, each in another direction. */
static void disturb(position_problem *problem)
{
    se3di_equations *equations = problem->equations;
    const size_t n = (size_t)equations->assembly.formulation->block;
    uint64_t seed = 88172645463325252u;
    for (size_t k = 0; k < equations->assembly.unknown_count; ++k) {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        const double part = (double)(seed >> 11) * 0x1p-52 - 1.0;
        equations->x[k] = DISTURBANCE * part * (k % n < 3 ? problem->size : 1.0);
    }
    se3di_equations_save(equations);
    move(problem, 1.0);
    measure(problem);
}

/* The poses of least violation may be so along a line only: a chain that is given exactly stretched
 * and must fold. From beside it there is a way on; if not, the poses stay. */
static se3d_status unfold(position_problem *problem, int *converged)
{
    const se3di_assembly *assembly = &problem->equations->assembly;
    const size_t count = assembly->dense_count;
    se3di_frame *found = se3di_alloc(&assembly->model->allocator, count, sizeof *found);
    int stationary;
    if (!found) {
        return se3di_error_set(problem->equations->error, SE3D_ERR_NO_MEMORY,
                               "no memory for poses");
    }
    memcpy(found, assembly->model->frames, count * sizeof *found);
    disturb(problem);
    const se3d_status status = approach(problem, converged, &stationary);
    if (status < 0 || !*converged) {
        *converged = 0;
        memcpy(assembly->model->frames, found, count * sizeof *found);
        measure(problem);
    }
    se3di_free(&assembly->model->allocator, found, count, sizeof *found);
    return status == SE3D_ERR_CALLBACK ? status : SE3D_OK;
}

se3d_status se3di_position_solve(se3di_equations *equations, double t)
{
    position_problem problem = {.equations = equations};
    int converged, stationary;
    problem.size = se3di_model_get_size(equations->assembly.model);
    SE3DI_TRY(se3di_assembly_eval_functions(&equations->assembly, t, equations->error));
    measure(&problem);
    widen(&problem);
    SE3DI_TRY(approach(&problem, &converged, &stationary));
    if (stationary && !converged && equations->unfolds) {
        SE3DI_TRY(unfold(&problem, &converged));
    }
    update_frames(equations);
    return converged ? SE3D_OK : report_gap(&problem, t, stationary);
}

se3d_status se3di_position_correct(se3di_equations *equations, double t, int *converged)
{
    position_problem problem = {.equations = equations};
    problem.size = se3di_model_get_size(equations->assembly.model);
    SE3DI_TRY(se3di_assembly_eval_functions(&equations->assembly, t, equations->error));
    measure(&problem);
    widen(&problem);
    SE3DI_TRY(run_newton(&problem, CORRECTIONS, converged));
    update_frames(equations);
    return SE3D_OK;
}
