/* SPDX-License-Identifier: BSD-3-Clause */
/* Equations with their linear solver: creation, velocities, accelerations. */
#include "nonlinear/equations.h"

#include "assembly/user.h"
#include "force/driver_rate.h"
#include "math/larger.h"
#include "model/integral.h"
#include "nonlinear/against.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define RATES_MAX         10   /* Newton steps for velocities */
#define MIN_NORM_ROWS_MAX 600  /* for a dense solution */
#define LIGHT             1e-7 /* of the heaviest body */

static se3d_status create_kkt(se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    se3di_kkt_pattern pattern = {
        .body_count = assembly->body_count,
        .joint_count = assembly->constraint_count,
        .joint_rows = assembly->joint_rows,
        .joint_begin = assembly->joint_begin,
        .joint_body = assembly->joint_body,
        .coupling_count = assembly->armature_pair_count,
        .coupling = assembly->armature_pair,
        .body_size = assembly->formulation->block,
        .symmetric = true,
        .body_kind = se3di_assembly_is_plain(assembly) ? SE3DI_KKT_BODY_MASS : SE3DI_KKT_BODY_FULL,
    };
    return se3di_kkt_create(&assembly->model->allocator, &pattern, SE3DI_KKT_STRUCTURED,
                            assembly->model->shelf, &equations->kkt);
}

/* Whether some body is so light beside others that the regularisation would outweigh what heavy
 * ones add to its joints' rows. */
static int has_light_body(const se3di_assembly *assembly)
{
    double least[2] = {HUGE_VAL, HUGE_VAL};
    double most[2] = {0.0, 0.0};
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const se3di_body *body = &assembly->model->bodies[assembly->free_body[k]];
        if (body->state != 0) {
            continue;
        }
        least[0] = fmin(least[0], body->mass);
        most[0] = fmax(most[0], body->mass);
        for (int c = 0; c < 3; ++c) {
            least[1] = fmin(least[1], body->J[c]);
            most[1] = fmax(most[1], body->J[c]);
        }
    }
    return least[0] < LIGHT * most[0] || least[1] < LIGHT * most[1];
}

/* Rows that determine a motion and are no more than its unknowns do not depend on each other. */
static int has_rows_to_spare(const se3di_assembly *assembly)
{
    return !assembly->levels || assembly->row_count != assembly->unknown_count;
}

void se3di_equations_suit_masses(se3di_equations *equations)
{
    const se3di_model *model = equations->assembly.model;
    if (equations->is_suited && equations->masses_version == model->masses_version &&
        equations->poses_version == model->poses_version) {
        return;
    }
    if (equations->tree) {
        se3di_tree_refresh(equations->tree);
        if (equations->has_loops && equations->masses_version != model->masses_version) {
            se3di_tree_loops_refresh(&equations->loops);
        } else if (equations->has_loops) {
            se3di_tree_loops_take_points(&equations->loops);
        }
        equations->is_placed = 0;
    }
    equations->masses_version = model->masses_version;
    equations->poses_version = model->poses_version;
    equations->is_suited = 1;
    se3di_kkt_settings settings = se3di_kkt_get_settings(equations->kkt);
    settings.regularise =
        has_light_body(&equations->assembly) || !has_rows_to_spare(&equations->assembly)
            ? SE3DI_KKT_REGULARISE_LATE
            : SE3DI_KKT_REGULARISE_AUTO;
    se3di_kkt_set_settings(equations->kkt, &settings);
}

/* H with other weights of the bodies, which are alone: nothing couples them. */
se3di_kkt_values se3di_equations_values_of(se3di_equations *equations, const double *body)
{
    se3di_assembly *assembly = &equations->assembly;
    const size_t n = (size_t)assembly->formulation->block;
    memset(assembly->H_pair, 0, assembly->armature_pair_count * n * n * sizeof *assembly->H_pair);
    return (se3di_kkt_values){
        .body = body, .coupling_upper = assembly->H_pair, .joint = assembly->C};
}

static double *alloc_doubles(const se3di_equations *equations, size_t count)
{
    return se3di_alloc(&equations->assembly.model->allocator, count, sizeof(double));
}

static int has_loops(const se3di_tree *tree)
{
    int found = 0;
    for (uint32_t k = 0; k < tree->constraint_count; ++k) {
        found |= se3di_tree_leaves(tree, k);
    }
    return found;
}

/* Of a recursion over the tree, a link, in the units of the costs of loops and the KKT solver. */
#define LINK_COST 100.0

enum { AS_TOLD, IF_OPEN, IF_THEY_PAY, LEFT }; /* equations->joints */

/* Loops are not built that cannot pay. */
static se3d_status foresee_loops(se3di_equations *equations)
{
    size_t members;
    if (!equations->has_loops || equations->joints == AS_TOLD) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_tree_loops_count_members(equations->tree, &equations->assembly, &members));
    const double cost = LINK_COST * equations->tree->count + se3di_loop_system_least_cost(members);
    if (equations->joints == IF_OPEN || cost >= se3di_kkt_get_cost(equations->kkt)) {
        equations->joints = LEFT;
    }
    return SE3D_OK;
}

static se3d_status create_tree(se3di_equations *equations)
{
    se3di_model *model = equations->assembly.model;
    if (equations->assembly.formulation->id != SE3D_FORMULATION_JOINT) {
        return SE3D_OK;
    }
    se3di_tree *tree = se3di_alloc(&model->allocator, 1, sizeof *tree);
    if (!tree) {
        return SE3D_ERR_NO_MEMORY;
    }
    const se3d_status status =
        se3di_tree_init(tree, model, equations->assembly.moves_states, equations->error);
    if (status < 0) {
        se3di_free(&model->allocator, tree, 1, sizeof *tree);
        return status;
    }
    tree->keeps_turns = 1;
    se3di_tree_refresh(tree);
    equations->tree = tree;
    equations->assembly.tree_count = (size_t)tree->q_count + tree->v_count;
    equations->has_loops = has_loops(tree);
    /* nothing but the tree constrains the motion, and nothing that acts depends on multipliers */
    equations->is_open_tree = tree->given_count == 0 && equations->friction.count == 0 &&
                              !equations->has_loops && tree->foreign_armature < 0;
    SE3DI_TRY(foresee_loops(equations));
    if (equations->joints == LEFT) {
        return SE3D_OK;
    }
    if (equations->has_loops) {
        SE3DI_TRY(
            se3di_tree_loops_init(&equations->loops, tree, &equations->assembly, equations->error));
    }
    equations->joint_before = alloc_doubles(equations, tree->q_count);
    equations->joint_moves = alloc_doubles(equations, 12 * (size_t)tree->count);
    return equations->joint_before && equations->joint_moves ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}

static int prefers_joints(const se3di_equations *equations)
{
    const se3di_tree *tree = equations->tree;
    int joints = 0;
    for (uint32_t k = 0; k < tree->count; ++k) {
        joints |= tree->nodes[k].constraint >= 0;
    }
    if (!joints || equations->joints == LEFT || equations->friction.count > 0 ||
        tree->foreign_armature >= 0 || tree->model->left_out_count > tree->model->broken_count) {
        return 0;
    }
    return !equations->has_loops ||
           (equations->loops.leaves_freedom &&
            se3di_loop_system_is_regular(&equations->loops.system) &&
            LINK_COST * tree->count + se3di_loop_system_cost(&equations->loops.system) <
                se3di_kkt_get_cost(equations->kkt));
}

#define BAND_MAX 64 /* rows, on average, that one is not clear of: others take sparse factors */

se3d_status se3di_equations_take_lanes(se3di_equations *equations)
{
    se3di_loop_lanes *lanes = &equations->lanes;
    if (lanes->allocated || !equations->has_loops ||
        !se3di_tree_loops_need_links_only(&equations->loops) ||
        !se3di_loop_system_is_regular(&equations->loops.system)) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_lane_loops_init(&lanes->rows, &equations->loops));
    if (lanes->rows.entry_count > BAND_MAX * (size_t)lanes->rows.count) {
        se3di_lane_loops_destroy(&lanes->rows);
        return SE3D_OK;
    }
    lanes->allocated_count =
        SE3DI_LANES_MAX * se3di_lane_loops_room(&lanes->rows) + SE3DI_LANES_ALIGN / sizeof(double);
    lanes->allocated = alloc_doubles(equations, lanes->allocated_count);
    lanes->memory = lanes->allocated ? se3di_lanes_align(lanes->allocated) : NULL;
    return lanes->allocated ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}

static void destroy_tree(se3di_equations *equations)
{
    const se3d_allocator *allocator = &equations->assembly.model->allocator;
    if (equations->tree) {
        se3di_lane_loops_destroy(&equations->lanes.rows);
        se3di_free(allocator, equations->lanes.allocated, equations->lanes.allocated_count,
                   sizeof(double));
        se3di_tree_loops_destroy(&equations->loops);
        se3di_free(allocator, equations->joint_before, equations->tree->q_count, sizeof(double));
        se3di_free(allocator, equations->joint_moves, 12 * (size_t)equations->tree->count,
                   sizeof(double));
        se3di_tree_destroy(equations->tree);
        se3di_free(allocator, equations->tree, 1, sizeof *equations->tree);
    }
}

static se3d_status allocate(se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    SE3DI_TRY(create_kkt(equations));
    SE3DI_TRY(se3di_friction_system_init(&equations->friction, assembly));
    SE3DI_TRY(create_tree(equations));
    if (equations->joints == LEFT) {
        return SE3D_OK;
    }
    se3di_equations_suit_masses(equations);
    equations->b = alloc_doubles(equations, assembly->unknown_count);
    equations->x = alloc_doubles(equations, assembly->unknown_count);
    equations->c = alloc_doubles(equations, assembly->row_count);
    equations->l = alloc_doubles(equations, assembly->row_count);
    equations->probe = alloc_doubles(equations, assembly->unknown_count);
    equations->phi = alloc_doubles(equations, assembly->row_count);
    equations->saved =
        se3di_alloc(&assembly->model->allocator, assembly->dense_count, sizeof *equations->saved);
    equations->accepted = se3di_alloc(&assembly->model->allocator, assembly->dense_count,
                                      sizeof *equations->accepted);
    equations->accepted_acceleration = alloc_doubles(equations, 6 * (size_t)assembly->dense_count);
    equations->accepted_lambda = alloc_doubles(equations, assembly->row_count);
    int complete = equations->accepted && equations->accepted_acceleration &&
                   equations->accepted_lambda && equations->b && equations->x && equations->c &&
                   equations->l && equations->phi && equations->probe && equations->saved;
    return complete ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}

static se3d_status init(se3di_equations *equations, se3di_model *model,
                        const se3di_formulation *formulation, int moves_states, se3di_error *error)
{
    SE3DI_TRY(se3di_model_check_stale(model, error));
    model->remembers = 1;
    SE3DI_TRY(se3di_assembly_init(&equations->assembly, model, formulation, moves_states, error));
    se3d_status status = allocate(equations);
    if (status < 0) {
        se3di_equations_destroy(equations);
        se3di_error_set(error, status, "no memory for the linear solver");
    }
    return status;
}

se3d_status se3di_equations_init(se3di_equations *equations, se3di_model *model,
                                 const se3di_formulation *formulation, int moves_states,
                                 se3di_error *error)
{
    *equations = (se3di_equations){.error = error, .iterations_max = 25};
    return init(equations, model, formulation, moves_states, error);
}

se3d_status se3di_equations_try_joints(se3di_equations *equations, se3di_model *model,
                                       int takes_loops, se3di_error *error, int *picked)
{
    *picked = 0;
    *equations = (se3di_equations){
        .error = error, .iterations_max = 25, .joints = takes_loops ? IF_THEY_PAY : IF_OPEN};
    SE3DI_TRY(init(equations, model, &se3di_formulation_joint, 1, error));
    *picked = prefers_joints(equations);
    if (!*picked) {
        se3di_equations_destroy(equations);
    }
    return SE3D_OK;
}

void se3di_equations_destroy(se3di_equations *equations)
{
    se3di_assembly *assembly = &equations->assembly;
    if (!assembly->model) {
        return;
    }
    const se3d_allocator *allocator = &assembly->model->allocator;
    se3di_kkt_destroy(equations->kkt);
    destroy_tree(equations);
    se3di_friction_system_destroy(&equations->friction, assembly);
    se3di_free(allocator, equations->b, assembly->unknown_count, sizeof(double));
    se3di_free(allocator, equations->x, assembly->unknown_count, sizeof(double));
    se3di_free(allocator, equations->c, assembly->row_count, sizeof(double));
    se3di_free(allocator, equations->l, assembly->row_count, sizeof(double));
    se3di_free(allocator, equations->probe, assembly->unknown_count, sizeof(double));
    se3di_free(allocator, equations->phi, assembly->row_count, sizeof(double));
    se3di_free(allocator, equations->saved, assembly->dense_count, sizeof *equations->saved);
    se3di_free(allocator, equations->accepted, assembly->dense_count, sizeof *equations->accepted);
    se3di_free(allocator, equations->accepted_acceleration, 6 * (size_t)assembly->dense_count,
               sizeof(double));
    se3di_free(allocator, equations->accepted_lambda, assembly->row_count, sizeof(double));
    se3di_saved_destroy(&equations->kept, allocator);
    se3di_assembly_destroy(assembly);
    memset(equations, 0, sizeof *equations);
}

se3d_status se3di_equations_ask(const se3di_equations *equations)
{
    return se3di_guard_ask(equations->guard)
               ? se3di_error_set(equations->error, SE3D_ERR_INTERRUPTED,
                                 "interrupted on the way from t = %.9g s",
                                 equations->assembly.model->time)
               : SE3D_OK;
}

se3d_status se3di_equations_try_step(const se3di_equations *equations, double t)
{
    const se3di_guard *guard = equations->guard;
    se3di_guard_pace pace;
    se3di_integrals_advance(equations->assembly.model, t);
    SE3DI_TRY(se3di_equations_ask(equations));
    if (!guard || !se3di_guard_count(equations->guard, t, &pace)) {
        return SE3D_OK;
    }
    if (!(pace.length > 0.0)) {
        return se3di_error_set(equations->error, SE3D_ERR_STEP_COUNT,
                               "t = %.17g s: %.6g steps were tried and the time does not advance; "
                               "steps_max = %.6g",
                               t, pace.steps, guard->most);
    }
    return se3di_error_set(
        equations->error, SE3D_ERR_STEP_COUNT,
        "t = %.9g s: %.6g steps were tried since t = %.9g s, the last ones %.3g s long; about %.2g "
        "would be needed to t = %.9g s, steps_max = %.6g; something moves far faster than the "
        "rest: "
        "look for stiffness, mass or speed out of range",
        t, pace.steps, guard->begin, pace.length, pace.foreseen, guard->end, guard->most);
}

void se3di_equations_save(se3di_equations *equations)
{
    memcpy(equations->saved, equations->assembly.model->frames,
           equations->assembly.dense_count * sizeof *equations->saved);
}

void se3di_equations_restore(se3di_equations *equations)
{
    memcpy(equations->assembly.model->frames, equations->saved,
           equations->assembly.dense_count * sizeof *equations->saved);
}

/* Lists of contacts are exchanged from state to state: both must have room for the one that is
 * kept. */
static se3d_status keep(se3di_saved *kept, se3di_model *model)
{
    void *next = model->contacts.next;
    SE3DI_TRY(se3di_saved_fill(kept, model, &model->allocator));
    const se3d_status status =
        se3di_array_reserve(&model->allocator, &next, &model->contacts.next_capacity,
                            model->contacts.count, sizeof *model->contacts.next);
    model->contacts.next = next;
    return status;
}

se3d_status se3di_equations_keep(se3di_equations *equations)
{
    equations->keeps = 0;
    if (keep(&equations->kept, equations->assembly.model) < 0) {
        return se3di_error_set(equations->error, SE3D_ERR_NO_MEMORY, "no memory for a step");
    }
    equations->keeps = 1;
    return SE3D_OK;
}

void se3di_equations_come_back(se3di_equations *equations)
{
    if (equations->keeps) {
        se3di_saved_restore(&equations->kept, equations->assembly.model);
    }
}

void se3di_state_accept(se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    const se3di_model *model = assembly->model;
    memcpy(equations->accepted, model->frames, assembly->dense_count * sizeof *model->frames);
    memcpy(equations->accepted_acceleration, model->acceleration,
           6 * (size_t)assembly->dense_count * sizeof(double));
    if (assembly->row_count > 0) {
        memcpy(equations->accepted_lambda, model->lambda, assembly->row_count * sizeof(double));
    }
}

void se3di_state_restore(se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    se3di_model *model = assembly->model;
    memcpy(model->frames, equations->accepted, assembly->dense_count * sizeof *model->frames);
    memcpy(model->acceleration, equations->accepted_acceleration,
           6 * (size_t)assembly->dense_count * sizeof(double));
    if (assembly->row_count > 0) {
        memcpy(model->lambda, equations->accepted_lambda, assembly->row_count * sizeof(double));
    }
}

/* Held bodies do not move: nothing reaches them through their constraints. */
static void release_held(se3di_equations *equations)
{
    se3di_assembly *assembly = &equations->assembly;
    size_t n = (size_t)assembly->formulation->block;
    for (uint32_t joint = 0; joint < assembly->constraint_count; ++joint) {
        for (int32_t k = assembly->joint_begin[joint]; k < assembly->joint_begin[joint + 1]; ++k) {
            uint32_t body = assembly->free_body[assembly->joint_body[k]];
            if (se3di_equations_holds(equations, body)) {
                memset(assembly->C + assembly->block_offset[k], 0,
                       (size_t)assembly->joint_rows[joint] * n * sizeof *assembly->C);
            }
        }
    }
}

/* What an analysis asks before it factors: no callback has failed; held bodies stay. */
static se3d_status check_values(se3di_equations *equations)
{
    const se3d_status reported = se3di_user_report(equations->assembly.model, equations->error);
    if (reported < 0) {
        se3di_kkt_expect(equations->kkt, NULL,
                         NULL); /* or another solution would be taken for it */
        return reported;
    }
    if (equations->hold) {
        release_held(equations);
    }
    return SE3D_OK;
}

/* The movable body of the least mass or moment of inertia: its block is the one that has no inverse
 * if one has none. */
static uint32_t find_lightest(const se3di_assembly *assembly)
{
    double least = HUGE_VAL;
    uint32_t lightest = 0;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const uint32_t index = assembly->free_body[k];
        const se3di_body *body = &assembly->model->bodies[index];
        const double moment = fmin(body->J[0], fmin(body->J[1], body->J[2]));
        const double size = body->state == 0 ? fmin(body->mass, moment) : HUGE_VAL;
        lightest = size < least ? index : lightest;
        least = fmin(least, size);
    }
    return lightest;
}

static se3d_status report_singular(se3di_equations *equations, double t)
{
    const se3di_model *model = equations->assembly.model;
    const uint32_t index = find_lightest(&equations->assembly);
    const se3di_body *body = &model->bodies[index];
    char number[32];
    snprintf(number, sizeof number, "number %u", (unsigned)index);
    return se3di_error_set(
        equations->error, SE3D_ERR_SINGULAR,
        "t = %g s: the mass matrix of a body is singular; body %.100s has the least "
        "of mass, %g kg, and moments of inertia, %g, %g, %g kg m^2",
        t, body->name ? body->name : number, body->mass, body->J[0], body->J[1], body->J[2]);
}

se3d_status se3di_equations_factor_values(se3di_equations *equations, double t, int is_checked)
{
    if (is_checked) {
        SE3DI_TRY(check_values(equations));
    }
    const se3di_kkt_values values = se3di_equations_values(equations);
    ++equations->counters.factorizations;
    const se3d_status status = se3di_kkt_factor(equations->kkt, &values, NULL);
    if (status == SE3D_ERR_SINGULAR && is_checked) {
        return report_singular(equations, t);
    }
    if (status < 0) {
        const char *what = is_checked ? "the equations are not finite: an angle has no direction, "
                                        "or the state has diverged"
                                      : "the equations are singular or not finite";
        return se3di_error_set(equations->error, status, "t = %g s: %s", t, what);
    }
    return status;
}

se3d_status se3di_equations_factor(se3di_equations *equations)
{
    se3di_assembly_eval_mass(&equations->assembly);
    se3di_assembly_eval_jacobian(&equations->assembly);
    return se3di_equations_factor_values(equations, equations->assembly.model->time, 1);
}

se3d_status se3di_equations_solve_by(se3di_equations *equations, se3di_kkt *kkt,
                                     const se3di_kkt_values *values)
{
    ++equations->counters.solves;
    se3di_kkt_solve_info info = {0};
    se3d_status status =
        se3di_kkt_solve(kkt, values, equations->b, equations->c, equations->x, equations->l, &info);
    if (status == SE3D_ERR_NO_CONVERGENCE && !(info.residual_b > 1e-6)) {
        status = SE3D_OK; /* c may be all rounding; the caller checks what it needs of C x = c */
    }
    if (status < 0) {
        return se3di_error_set(
            equations->error, status, "t = %g s: %s", equations->assembly.model->time,
            status == SE3D_ERR_NOT_FINITE ? "the solution of the linear equations is not finite"
                                          : "the linear equations could not be solved");
    }
    return status;
}

se3d_status se3di_equations_solve(se3di_equations *equations)
{
    const se3di_kkt_values values = se3di_equations_values(equations);
    return se3di_equations_solve_by(equations, equations->kkt, &values);
}

/* b = H qdot: the weights of the present velocities. */
static void weigh_velocity(se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    size_t n = (size_t)assembly->formulation->block;
    se3di_assembly_get_velocity(assembly, equations->x);
    se3di_assembly_mul_mass(assembly, equations->x, equations->b);
    for (size_t k = 0; n == 8 && k < assembly->body_count; ++k) {
        equations->b[8 * k + 7] = 0.0; /* p . pdot = 0 */
    }
}

/* The equations of a level hold: |C x - c| <= 1e-7 of the largest part. Dependent rows that
 * contradict the others show here. */
static se3d_status check_level(se3di_equations *equations, double t, const char *level)
{
    const se3di_assembly *assembly = &equations->assembly;
    double scale = 0.0;
    double worst = 0.0;
    uint32_t where = 0;
    size_t n = (size_t)assembly->formulation->block;
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        /* What the right-hand side would do to the free body counts too: x may be all rounding. */
        double diagonal = assembly->H[k / n * n * n + (n + 1) * (k % n)];
        double alone = diagonal > 0.0 ? fabs(equations->b[k] / diagonal) : 0.0;
        scale = fmax(scale, fmax(fabs(equations->x[k]), alone));
    }
    se3di_assembly_mul(assembly, equations->x, equations->l);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        double gap = fabs(equations->l[k] - equations->c[k]);
        scale = fmax(scale, fabs(equations->c[k]));
        if (!(gap <= worst)) {
            worst = gap;
            where = k;
        }
    }
    if (worst <= 1e-6 * scale + 1e-12) {
        return SE3D_OK;
    }
    char name[128], with[400];
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->l[k] -= equations->c[k];
    }
    se3di_row_name(assembly->model, where, name, sizeof name);
    se3di_against_describe(assembly->model, equations->l, where, with, sizeof with);
    return se3di_error_set(
        equations->error, SE3D_ERR_INCONSISTENT,
        "t = %g s: the constraints contradict each other: the %s equation of %s "
        "cannot be met (off by %.3g)%s; the mechanism is locked or over-constrained",
        t, level, name, worst, with);
}

/* phi = Phi_q qdot of the held bodies, which their neighbours have to follow. */
static void take_held_rates(se3di_equations *equations)
{
    se3di_assembly *assembly = &equations->assembly;
    size_t n = (size_t)assembly->formulation->block;
    se3di_assembly_eval_jacobian(assembly);
    se3di_assembly_get_velocity(assembly, equations->x);
    for (size_t k = 0; k < assembly->body_count; ++k) {
        if (!se3di_equations_holds(equations, assembly->free_body[k])) {
            memset(equations->x + k * n, 0, n * sizeof *equations->x);
        }
    }
    se3di_assembly_mul(assembly, equations->x, equations->phi);
}

/* Whether velocities meet rows that are no linear equations of them, as rates that follow other
 * velocities by any function. */
static int follows_rates(se3di_equations *equations)
{
    se3di_assembly *assembly = &equations->assembly;
    double largest = 0.0, worst = 0.0;
    if (assembly->user_count == 0 || se3di_find_driver_rate(assembly->model) == SE3DI_NO_INDEX) {
        return 1;
    }
    se3di_assembly_eval_jacobian(assembly);
    se3di_assembly_get_velocity(assembly, equations->x);
    se3di_assembly_mul(assembly, equations->x, equations->c);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        largest = se3di_larger(largest, fabs(equations->c[k]));
        worst = se3di_larger(worst, fabs(assembly->f[3 * k + 1] - equations->c[k]));
    }
    return worst <= 1e-14 * largest;
}

static se3d_status solve_velocity(se3di_equations *equations, double t)
{
    se3di_assembly *assembly = &equations->assembly;
    memset(equations->phi, 0, assembly->row_count * sizeof *equations->phi);
    if (equations->hold) {
        take_held_rates(equations);
    }
    SE3DI_TRY(se3di_equations_factor(equations));
    weigh_velocity(equations);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] = assembly->f[3 * k + 1] - equations->phi[k];
    }
    SE3DI_TRY(se3di_equations_solve(equations));
    SE3DI_TRY(check_level(equations, t, "velocity"));
    se3di_assembly_set_velocity(assembly, equations->x);
    return SE3D_OK;
}

se3d_status se3di_velocity_solve(se3di_equations *equations, double t)
{
    se3di_assembly *assembly = &equations->assembly;
    SE3DI_TRY(se3di_assembly_eval_functions(assembly, t, equations->error));
    SE3DI_TRY(solve_velocity(equations, t));
    for (int k = 0; !follows_rates(equations); ++k) {
        if (k == RATES_MAX) { /* all but rounding, or there are no such velocities */
            for (uint32_t row = 0; row < assembly->row_count; ++row) {
                equations->c[row] = assembly->f[3 * row + 1];
            }
            return check_level(equations, t, "velocity");
        }
        SE3DI_TRY(solve_velocity(equations, t));
    }
    return SE3D_OK;
}

/* C and the right-hand sides of accelerations: b of all loads but friction that may stick, c. */
static se3d_status eval_accelerated(se3di_equations *equations, double t)
{
    se3di_assembly *assembly = &equations->assembly;
    se3di_assembly_eval_rows(assembly, equations->c);
    se3di_friction_system_begin(equations);
    return se3di_assembly_eval_forces(assembly, t, equations->b, equations->error);
}

se3d_status se3di_equations_accelerate(se3di_equations *equations, double t, int is_checked)
{
    SE3DI_TRY(eval_accelerated(equations, t));
    se3di_kkt_expect(equations->kkt, equations->b, equations->c);
    SE3DI_TRY(se3di_equations_factor_values(equations, t, is_checked));
    return se3di_equations_solve(equations);
}

/* Whether the factors that velocities were solved by are those of accelerations, too. */
static int keeps_factors(const se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    return assembly->levels && !has_rows_to_spare(assembly) && assembly->user_count == 0 &&
           !equations->hold && se3di_kkt_get_dependent_rows(equations->kkt) == 0;
}

/* Of a motion that the constraints determine, H weighing all bodies alike: accelerations from the
 * constraints alone, then C^T lambda = Q - M qddot, as H qddot + C^T lambda = Q - (M - H) qddot. So
 * masses decide on no rank. */
static se3d_status solve_driven(se3di_equations *equations, double t, int has_factors)
{
    se3di_assembly *assembly = &equations->assembly;
    se3di_assembly_eval_mass(assembly);
    SE3DI_TRY(eval_accelerated(equations, t));
    SE3DI_TRY(has_factors ? check_values(equations)
                          : se3di_equations_factor_values(equations, assembly->model->time, 1));
    SE3DI_TRY(se3di_equations_solve(equations));
    se3di_assembly_subtract_inertia(assembly, equations->x, equations->b);
    se3di_assembly_mul_mass(assembly, equations->x, equations->probe);
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        equations->b[k] += equations->probe[k];
    }
    return se3di_equations_solve(equations);
}

static se3d_status solve_free(se3di_equations *equations, double t)
{
    se3di_assembly_eval_mass(&equations->assembly);
    return se3di_equations_accelerate(equations, t, 1);
}

static se3d_status solve_acceleration(se3di_equations *equations, double t, int has_factors)
{
    se3di_assembly *assembly = &equations->assembly;
    SE3DI_TRY(se3di_assembly_eval_functions(assembly, t, equations->error));
    const se3d_status status =
        assembly->levels ? solve_driven(equations, t, has_factors) : solve_free(equations, t);
    SE3DI_TRY(status);
    ++equations->counters.evaluations;
    equations->redundant |=
        status == SE3D_INFO_REDUNDANT &&
        se3di_kkt_get_dependent_rows(equations->kkt) > (int32_t)assembly->model->broken_count;
    SE3DI_TRY(se3di_friction_system_finish(equations, t));
    if (assembly->row_count > 0) {
        memcpy(assembly->model->lambda, equations->l, assembly->row_count * sizeof *equations->l);
    }
    SE3DI_TRY(check_level(equations, t, "acceleration"));
    se3di_assembly_set_acceleration(assembly, equations->x);
    return SE3D_OK;
}

se3d_status se3di_acceleration_solve(se3di_equations *equations, double t)
{
    return solve_acceleration(equations, t, 0);
}

se3d_status se3di_multipliers_reduce(se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    if (assembly->row_count == 0) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_equations_factor(equations));
    se3di_assembly_get_acceleration(assembly, equations->x);
    se3di_assembly_mul_mass(assembly, equations->x, equations->b);
    se3di_assembly_mul(assembly, equations->x, equations->c); /* not all rounding, as zeros are */
    se3di_assembly_add_transposed(assembly, 1.0, assembly->model->lambda, equations->b);
    se3d_status status = se3di_equations_solve(equations);
    SE3DI_TRY(status);
    if (status != SE3D_INFO_REDUNDANT && assembly->row_count <= MIN_NORM_ROWS_MAX) {
        /* near a singular position the fast solver does not tell dependent rows apart */
        const se3di_kkt_values values = se3di_equations_values(equations);
        se3di_assembly_get_acceleration(assembly, equations->x);
        SE3DI_TRY(se3di_kkt_min_norm(equations->kkt, &values, equations->b, equations->x, 1e-10,
                                     equations->l, NULL));
        status = SE3D_INFO_REDUNDANT;
    }
    if (status == SE3D_INFO_REDUNDANT) {
        memcpy(assembly->model->lambda, equations->l, assembly->row_count * sizeof *equations->l);
    }
    return SE3D_OK;
}

se3d_status se3di_state_solve(se3di_equations *equations, double t)
{
    SE3DI_TRY(se3di_position_solve(equations, t));
    SE3DI_TRY(se3di_velocity_solve(equations, t));
    const int has_factors = keeps_factors(equations);
    int32_t hold = equations->hold;
    equations->hold = 0; /* held bodies accelerate like all others */
    se3d_status status = solve_acceleration(equations, t, has_factors);
    equations->hold = hold;
    return status;
}

/* r-p: there are no velocities along p. */
static void make_tangent(const se3di_equations *equations, double *qdot)
{
    const se3di_assembly *assembly = &equations->assembly;
    if (assembly->formulation->block != 8) {
        return;
    }
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const double *p = assembly->model->frames[assembly->free_body[k]].p;
        double *pdot = qdot + 8 * (size_t)k + 3;
        double along = p[0] * pdot[0] + p[1] * pdot[1] + p[2] * pdot[2] + p[3] * pdot[3];
        for (int c = 0; c < 4; ++c) {
            pdot[c] -= along * p[c];
        }
        pdot[4] = 0.0;
    }
}

/* Any velocity y is recovered from C x = C y if the constraints leave no freedom. */
se3d_status se3di_equations_probe(se3di_equations *equations, double *worst, uint32_t *body)
{
    const se3di_assembly *assembly = &equations->assembly;
    size_t n = (size_t)assembly->formulation->block;
    uint64_t seed = 88172645463325252u;
    *worst = 0.0;
    *body = 0;
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        equations->x[k] = (double)(seed >> 11) * 0x1p-53 + 0.25;
    }
    make_tangent(equations, equations->x);
    se3di_assembly_mul(assembly, equations->x, equations->c);
    memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
    memcpy(equations->probe, equations->x, assembly->unknown_count * sizeof *equations->x);
    SE3DI_TRY(se3di_equations_solve(equations));
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        double off = k % n < 7 ? fabs(equations->x[k] - equations->probe[k]) : 0.0;
        if (!(off <= *worst)) {
            *worst = off;
            *body = assembly->free_body[k / n];
        }
    }
    return SE3D_OK;
}

se3d_status se3di_equations_check_determined(se3di_equations *equations)
{
    double worst;
    uint32_t body;
    SE3DI_TRY(se3di_equations_factor(equations));
    SE3DI_TRY(se3di_equations_probe(equations, &worst, &body));
    if (worst <= 1e-5) {
        return SE3D_OK;
    }
    const char *name = equations->assembly.model->bodies[body].name;
    return se3di_error_set(
        equations->error, SE3D_ERR_SINGULAR,
        "the drivers and constraints do not determine the motion: body %s can still move; add a "
        "driver for every degree of freedom, start away from a singular position, or use the "
        "dynamics analysis",
        name ? name : "without a name");
}
