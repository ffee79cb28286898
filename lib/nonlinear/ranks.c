/* SPDX-License-Identifier: BSD-3-Clause */
/* Candidates are rows that depend, to some five digits, on rows before them, by elimination with
 * pivots (linsol/null_space.h; displacements in units of the model's size). Whether they stay met
 * tells a redundant row from one at a singular position: the mechanism without its candidates and
 * drivers is moved by a tenth of a radian or of its size along a freedom, both ways. A row that is
 *
 *     dependent, met to rounding  is redundant, and stays where it is
 *     met to the digits of data   is left out
 *     off by more                 constrains, and stays
 */
#include "nonlinear/ranks.h"

#include "linsol/null_space.h"
#include "primitive/user.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SUSPICIOUS 1e-8  /* pivot of a row over its weight: its independent part squared */
#define CANDIDATE  3e-5  /* relative independent part */
#define DEPENDENT  1e-10 /* the same of rounding, */
#define EXACT      1e-13 /* and that of a row that goes back while others are left out */
#define ROUGH      1e-6  /* poses that are off by more are assembled first */
#define ROUNDING   1e-9  /* violation of a redundant row, relative */
#define DIGITS     3e-5  /* that of one that is left out */
#define SWING      0.02  /* rad or relative, */
#define SWINGS     5     /* each way */
#define ROUNDS     4

typedef struct decision {
    se3di_equations *equations;
    se3di_model *model;
    double t, size;
    se3di_frame *given; /* [bodies] */
    se3di_frame *start; /* [bodies] consistent poses that the mechanism is moved from */
    double *direction;  /* [6 free bodies] */
    double *rest;       /* [rows] relative independent part, -1: independent or no candidate */
    double *most;       /* [rows] largest relative violation */
    double *C;          /* scaled rows */
    int32_t *joint_rows;
    int32_t *is_geometric; /* [constraints] */
    size_t value_count;    /* of C */
} decision;

/* A callback's rows do not move the mechanism, as far as one can see. */
static int stands_still(const se3di_model *model, const se3di_constraint *constraint, double t)
{
    se3di_user_values values;
    if (!constraint->callback ||
        se3di_user_eval(model, constraint, t, SE3DI_USER_NU, &values) < 0) {
        return 0;
    }
    for (uint32_t r = 0; r < constraint->row_count; ++r) {
        if (fabs(values.nu[r]) > 0.0) {
            return 0;
        }
    }
    return 1;
}

/* Rows of drivers and functions of time move the mechanism. */
static int is_geometric(const se3di_model *model, const se3di_constraint *constraint, double t)
{
    if (se3di_is_user(constraint) && !se3di_is_broken(constraint, model->rows)) {
        return stands_still(model, constraint, t);
    }
    int geometric =
        strcmp(constraint->type, "driver") != 0 && !se3di_is_broken(constraint, model->rows);
    for (uint32_t r = 0; r < constraint->row_count; ++r) {
        const se3di_row *row = &model->rows[constraint->row_begin + r];
        geometric = geometric && row->function < 0 && row->term_count > 0;
    }
    return geometric;
}

/* Rows that broke are among them: nothing takes them back. */
static int is_driving(const decision *d, uint32_t joint)
{
    const se3di_model *model = d->model;
    return !d->is_geometric[joint] &&
           model->rows[model->constraints[joint].row_begin].term_count > 0;
}

static void leave_out(se3di_model *model, uint32_t row, int32_t left_out)
{
    if (!(model->rows[row].left_out & SE3DI_ROW_BROKEN)) {
        model->left_out_count += (uint32_t)(left_out - model->rows[row].left_out);
        model->rows[row].left_out = left_out;
    }
}

static void put_back(const decision *d, const se3di_frame *frames)
{
    memcpy(d->model->frames, frames, d->model->body_slots.count * sizeof *frames);
}

/* ---- candidates ---- */

/* Whether some pivot nearly vanishes, all bodies weighing alike. */
static se3d_status suspect(const decision *d, int *suspicious)
{
    se3di_equations *equations = d->equations;
    se3di_assembly *assembly = &equations->assembly;
    const se3di_kkt_values values = se3di_equations_values(equations);
    const double like[2] = {assembly->like_mass, assembly->like_inertia};
    const int32_t levels = assembly->levels;
    se3di_kkt_factor_info info = {.min_pivot = 1.0};
    se3di_assembly_level(assembly);
    se3di_assembly_eval_mass(assembly);
    se3di_assembly_eval_jacobian(assembly);
    se3di_kkt_hold(equations->kkt, false);
    se3di_kkt_expect(equations->kkt, NULL, NULL);
    const se3d_status status = se3di_kkt_factor(equations->kkt, &values, &info);
    assembly->like_mass = like[0];
    assembly->like_inertia = like[1];
    assembly->levels = levels;
    se3di_assembly_eval_mass(assembly);
    *suspicious = status >= 0 && (info.min_pivot < SUSPICIOUS || info.dependent_rows > 0);
    return SE3D_OK; /* what cannot be factored is told where it has to be */
}

/* Rows of geometry in r-omega, displacements in units of the size. */
static void scale_rows(const decision *d, const se3di_assembly *flat)
{
    memcpy(d->C, flat->C, d->value_count * sizeof *d->C);
    for (size_t k = 0; k < d->value_count; ++k) {
        d->C[k] *= k % 6 < 3 ? d->size : 1.0;
    }
    for (uint32_t joint = 0; joint < flat->constraint_count; ++joint) {
        d->joint_rows[joint] = d->is_geometric[joint] ? flat->joint_rows[joint] : 0;
    }
}

/* The rests of all rows, in the order of the model. */
static void spread_rests(const decision *d, const se3di_assembly *flat)
{
    size_t found = 0;
    for (uint32_t joint = 0; joint < flat->constraint_count; ++joint) {
        found += (size_t)d->joint_rows[joint];
    }
    for (uint32_t joint = flat->constraint_count; joint-- > 0;) {
        double *rest = d->rest + d->model->constraints[joint].row_begin;
        found -= (size_t)d->joint_rows[joint];
        if (d->joint_rows[joint] > 0) {
            memmove(rest, d->rest + found, (size_t)d->joint_rows[joint] * sizeof *rest);
        } else {
            for (int32_t r = 0; r < flat->joint_rows[joint]; ++r) {
                rest[r] = -1.0;
            }
        }
    }
}

/* A sum of all freedoms, of size one. */
static void mix_freedoms(const decision *d, const double *Z, size_t freedoms, size_t n)
{
    uint64_t seed = 88172645463325252u;
    double largest = 0.0;
    memset(d->direction, 0, n * sizeof *d->direction);
    for (size_t f = 0; f < freedoms; ++f) {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        const double share = (seed & 1 ? 1.0 : -1.0) * (0.5 + (double)(seed >> 12) * 0x1p-53);
        for (size_t k = 0; k < n; ++k) {
            d->direction[k] += share * Z[f * n + k];
        }
    }
    for (size_t k = 0; k < n; ++k) {
        largest = fmax(largest, fabs(d->direction[k]));
    }
    for (size_t k = 0; k < n && largest > 0.0; ++k) {
        d->direction[k] *= (k % 6 < 3 ? d->size : 1.0) / largest;
    }
}

static se3d_status eliminate(const decision *d, const se3di_assembly *flat)
{
    const se3di_null_space_pattern pattern = {.body_count = flat->body_count,
                                              .joint_count = flat->constraint_count,
                                              .joint_rows = d->joint_rows,
                                              .joint_begin = flat->joint_begin,
                                              .joint_body = flat->joint_body,
                                              .block_offset = flat->block_offset};
    const size_t n = 6 * (size_t)flat->body_count;
    double *Z;
    int32_t freedoms;
    int32_t dependent;
    scale_rows(d, flat);
    const se3d_status status = se3di_null_space_find(&d->model->allocator, &pattern, d->C,
                                                     CANDIDATE, &Z, &freedoms, &dependent, d->rest);
    if (status == SE3D_ERR_NO_MEMORY) {
        return status;
    }
    for (uint32_t k = 0; status < 0 && k < flat->row_count; ++k) {
        d->rest[k] = -1.0;
    }
    if (status >= 0) {
        spread_rests(d, flat);
        mix_freedoms(d, Z, (size_t)freedoms, n);
        se3di_free(&d->model->allocator, Z, (size_t)freedoms * n, sizeof *Z);
    }
    return SE3D_OK;
}

static se3d_status allocate(decision *d, const se3di_assembly *flat)
{
    const se3d_allocator *allocator = &d->model->allocator;
    d->value_count = flat->joint_value_count;
    d->C = se3di_alloc(allocator, d->value_count, sizeof *d->C);
    d->joint_rows = se3di_alloc(allocator, flat->constraint_count, sizeof *d->joint_rows);
    d->is_geometric = se3di_alloc(allocator, flat->constraint_count, sizeof *d->is_geometric);
    d->rest = se3di_alloc(allocator, flat->row_count, sizeof *d->rest);
    d->most = se3di_alloc(allocator, flat->row_count, sizeof *d->most);
    d->direction = se3di_alloc(allocator, 6 * (size_t)flat->body_count, sizeof *d->direction);
    d->start = se3di_alloc(allocator, d->model->body_slots.count, sizeof *d->start);
    return d->C && d->joint_rows && d->is_geometric && d->rest && d->most && d->direction &&
                   d->start
               ? SE3D_OK
               : SE3D_ERR_NO_MEMORY;
}

static void release(decision *d)
{
    const se3di_assembly *assembly = &d->equations->assembly;
    const se3d_allocator *allocator = &d->model->allocator;
    se3di_free(allocator, d->C, d->value_count, sizeof *d->C);
    se3di_free(allocator, d->joint_rows, assembly->constraint_count, sizeof *d->joint_rows);
    se3di_free(allocator, d->is_geometric, assembly->constraint_count, sizeof *d->is_geometric);
    se3di_free(allocator, d->rest, assembly->row_count, sizeof *d->rest);
    se3di_free(allocator, d->most, assembly->row_count, sizeof *d->most);
    se3di_free(allocator, d->direction, 6 * (size_t)assembly->body_count, sizeof *d->direction);
    se3di_free(allocator, d->start, d->model->body_slots.count, sizeof *d->start);
    se3di_free(allocator, d->given, d->model->body_slots.count, sizeof *d->given);
}

static se3d_status find_candidates(decision *d)
{
    se3di_assembly flat;
    const se3di_user_failure failure = d->model->user_failure;
    SE3DI_TRY(se3di_assembly_init(&flat, d->model, &se3di_formulation_romega,
                                  d->equations->assembly.moves_states, d->equations->error));
    se3d_status status = allocate(d, &flat);
    for (uint32_t joint = 0; joint < flat.constraint_count && status >= 0; ++joint) {
        d->is_geometric[joint] = is_geometric(d->model, &d->model->constraints[joint], d->t);
    }
    if (status >= 0) {
        se3di_assembly_eval_jacobian(&flat);
        status = eliminate(d, &flat);
    }
    se3di_assembly_destroy(&flat);
    d->model->user_failure = failure;
    return status;
}

/* ---- moving the mechanism ---- */

static void measure_candidates(const decision *d)
{
    for (uint32_t k = 0; k < d->model->row_count; ++k) {
        if (d->rest[k] >= 0.0) {
            d->most[k] = fmax(d->most[k], se3di_row_measure(d->model, k, d->size));
        }
    }
}

static void shift(const decision *d, double length)
{
    const se3di_assembly *assembly = &d->equations->assembly;
    double dq[6];
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        for (int c = 0; c < 6; ++c) {
            dq[c] = length * d->direction[6 * k + (uint32_t)c];
        }
        se3di_frame *frame = &d->model->frames[assembly->free_body[k]];
        se3di_formulation_romega.move(frame, dq);
        se3di_frame_update(frame);
    }
}

/* Drivers let the mechanism go, or hold it again. */
static void release_drivers(const decision *d, int32_t released)
{
    for (uint32_t j = 0; j < d->equations->assembly.constraint_count; ++j) {
        const se3di_constraint *constraint = &d->model->constraints[j];
        for (uint32_t r = 0; r < constraint->row_count && is_driving(d, j); ++r) {
            leave_out(d->model, constraint->row_begin + r, released);
        }
    }
}

/* Whether the caller has to know. */
static int is_fatal(se3d_status status)
{
    return status == SE3D_ERR_NO_MEMORY || status == SE3D_ERR_CALLBACK ||
           status == SE3D_ERR_INTERRUPTED;
}

static se3d_status swing(const decision *d, double side)
{
    put_back(d, d->start);
    for (int k = 0; k < SWINGS; ++k) {
        int converged = 0;
        shift(d, side * SWING);
        const se3d_status status = se3di_position_correct(d->equations, d->t, &converged);
        if (status < 0 || !converged) { /* it does not reach, or a callback does not like it */
            return status == SE3D_ERR_INTERRUPTED ? status : SE3D_OK;
        }
        measure_candidates(d);
    }
    return SE3D_OK;
}

static se3d_status swing_both_ways(const decision *d)
{
    const se3di_user_failure failure = d->model->user_failure;
    release_drivers(d, 1);
    se3d_status status = swing(d, 1.0);
    status = status < 0 ? status : swing(d, -1.0);
    release_drivers(d, 0);
    d->model->user_failure = failure;
    put_back(d, d->start);
    return status;
}

/* ---- decision ---- */

static int has_misfit(const decision *d)
{
    double most = 0.0;
    for (uint32_t k = 0; k < d->model->row_count; ++k) {
        if (d->rest[k] > DEPENDENT) {
            return 1;
        }
        most = d->rest[k] < 0.0 ? most : fmax(most, se3di_row_measure(d->model, k, d->size));
    }
    return most > ROUNDING;
}

/* Candidates that are off by too much are none. Returns whether there were any. */
static int drop_independent(const decision *d)
{
    int dropped = 0;
    for (uint32_t k = 0; k < d->model->row_count; ++k) {
        if (d->rest[k] >= 0.0 && !(d->most[k] <= DIGITS)) {
            d->rest[k] = -1.0;
            leave_out(d->model, k, 0);
            dropped = 1;
        }
    }
    return dropped;
}

/* Those that are redundant but for rounding are solved with the others. What is independent of them
 * by a little may be met all through the swing, and will be off by as much after a turn; and
 * without those that are left out it would pull in a direction that is noise. */
static void take_redundant(const decision *d)
{
    for (uint32_t k = 0; k < d->model->row_count; ++k) {
        if (d->rest[k] >= 0.0 && d->rest[k] <= EXACT && d->most[k] <= ROUNDING) {
            leave_out(d->model, k, 0);
        }
    }
}

/* Leave candidates out, and see what becomes of them. */
static se3d_status try_candidates(const decision *d)
{
    const size_t rows = d->model->row_count;
    int dropped = 1;
    for (uint32_t k = 0; k < rows; ++k) {
        leave_out(d->model, k, d->rest[k] >= 0.0);
    }
    for (int round = 0; round < ROUNDS && dropped && d->model->left_out_count > 0; ++round) {
        memset(d->most, 0, rows * sizeof *d->most);
        put_back(d, d->given);
        const se3d_status status = se3di_position_solve(d->equations, d->t);
        if (status < 0) {
            se3di_model_take_all_rows(d->model);
            return is_fatal(status) ? status : SE3D_OK;
        }
        memcpy(d->start, d->model->frames, d->model->body_slots.count * sizeof *d->start);
        measure_candidates(d);
        dropped = drop_independent(d);
        if (!dropped) {
            SE3DI_TRY(swing_both_ways(d));
            dropped = drop_independent(d);
        }
    }
    take_redundant(d);
    return SE3D_OK;
}

static se3d_status decide(decision *d)
{
    se3di_equations *equations = d->equations;
    char text[200];
    int suspicious = 1;
    SE3DI_TRY(se3di_assembly_eval_functions(&equations->assembly, d->t, equations->error));
    const double worst = se3di_position_measure(equations, text, sizeof text);
    se3d_status status = SE3D_OK;
    if (!(worst <= ROUGH)) {
        status = se3di_position_solve(equations, d->t);
        if (status < 0 && status != SE3D_ERR_INCONSISTENT) {
            return is_fatal(status) ? status : SE3D_OK; /* told where positions are solved for */
        }
    }
    if (status >= 0) {
        SE3DI_TRY(suspect(d, &suspicious));
    }
    if (!suspicious) {
        return SE3D_OK;
    }
    SE3DI_TRY(find_candidates(d));
    return has_misfit(d) ? try_candidates(d) : SE3D_OK;
}

static se3d_status decide_kept(decision *d)
{
    d->given = se3di_alloc(&d->model->allocator, d->model->body_slots.count, sizeof *d->given);
    if (!d->given) {
        return SE3D_ERR_NO_MEMORY;
    }
    memcpy(d->given, d->model->frames, d->model->body_slots.count * sizeof *d->given);
    const se3d_status status = decide(d);
    put_back(d, d->given);
    return status;
}

se3d_status se3di_ranks_decide(se3di_equations *equations, double t)
{
    se3di_model *model = equations->assembly.model;
    decision d = {.equations = equations, .model = model, .t = t};
    se3di_error *const error = equations->error;
    const se3di_counters counters = equations->counters;
    const int32_t hold = equations->hold;
    se3di_error own = {0};
    if (model->ranks_known || model->row_count == 0) {
        return SE3D_OK;
    }
    d.size = se3di_model_get_size(model);
    se3di_model_take_all_rows(model);
    equations->error = &own;
    equations->hold = 0;
    const se3d_status status = decide_kept(&d);
    release(&d);
    equations->error = error;
    equations->hold = hold;
    equations->counters = counters;
    if (status < 0) {
        se3di_model_take_all_rows(model);
        return se3di_error_set(error, status, "%s",
                               own.status == status ? own.message : "no memory to decide on ranks");
    }
    model->ranks_known = 1;
    return SE3D_OK;
}

void se3di_ranks_describe(const se3di_model *model, char *text, size_t size)
{
    const double length = se3di_model_get_size(model);
    size_t count = 0;
    text[0] = '\0';
    for (uint32_t k = 0; k < model->row_count; ++k) {
        const size_t used = strlen(text);
        char name[128];
        if (model->rows[k].left_out != SE3DI_ROW_DEPENDENT || used + 64 > size) {
            continue;
        }
        se3di_row_name(model, k, name, sizeof name);
        snprintf(text + used, size - used, "%s%.60s (off by %.2g%s)", count++ > 0 ? ", " : "", name,
                 se3di_row_measure(model, k, length) * se3di_row_get_scale(model, k, length),
                 se3di_row_get_unit(model, k));
    }
}
