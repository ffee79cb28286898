/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks by components: bodies that constraints tie together (other than through fixed bodies) make
 * a component; its rows of C, with displacements measured in units of the model's size, go through
 * a rank-revealing QR. A redundant row is a combination of rows before it,
 *
 *     C_r = sum_k f_k C_k,      and consistent only if  Phi_r = sum_k f_k Phi_k  (and nu alike).
 *
 * If the constraints cannot be met, the poses of least violation are analysed: there the
 * violations are a combination of rows that vanishes, so that the contradiction shows as a
 * redundant row. In large models a body whose only constraint has full row rank on it leaves that
 * constraint independent of all others; such bodies are taken off first, so that trees cost no QR.
 * docs/theory/redundancy.md */
#include "analysis/check.h"

#include "analysis/start_moved.h"
#include "assembly/user.h"
#include "base/log.h"
#include "base/text.h"
#include "contact/bodies/body_contacts.h"
#include "force/force.h"
#include "linsol/rank.h"
#include "nonlinear/ranks.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define ROWS_MAX       3000 /* of a component, for a dense analysis */
#define ROWS_SMALL     300  /* of a model: no open ends are taken off */
#define FITS           1e-9 /* violation of assembled poses, relative to the model's size */
#define RANK_ASSEMBLED 1e-8 /* relative size of a row's independent part */
#define RANK_VIOLATED  1e-5 /* if the poses are of least violation only */
#define NAMES_MAX      12   /* in one message */
#define TEXT_SIZE      2048
#define NAME_SIZE      128

typedef struct inspection {
    se3di_check *check;
    se3di_equations *equations;
    const se3di_model *model;
    se3di_error *told;    /* with the log */
    double size;          /* of the model [m] */
    double tolerance;     /* of ranks */
    uint32_t *component;  /* [bodies] representative of each free body's component */
    uint32_t *column;     /* [bodies] place of a free body in the dense matrix */
    uint32_t *row;        /* [rows] equations of the component at hand */
    uint8_t *held;        /* [bodies] of a representative: a constraint leads to a fixed body */
    uint8_t *gone;        /* [constraints] known to be independent */
    uint8_t *off;         /* [bodies] taken off */
    uint32_t *open_count; /* [bodies] constraints that are not gone */
    double *C;            /* dense rows of the component at hand */
    size_t C_count;
    int32_t violated; /* the constraints cannot be met */
    int32_t lost;     /* no assembled poses were found: violations say nothing */
    int32_t moves;    /* the velocities follow the rates, and gamma is in equations->c */
} inspection;

/* ---- messages ---- */

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static se3d_status
add_message(se3di_check *check, const char *format, ...)
{
    char text[TEXT_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    se3di_text_make_plain(text); /* a name may have been cut in a character */
    void *messages = check->messages;
    se3d_status status = se3di_array_reserve(&check->allocator, &messages, &check->message_capacity,
                                             check->message_count + 1, sizeof *check->messages);
    check->messages = messages;
    SE3DI_TRY(status);
    char *copy = se3di_text_copy(&check->allocator, text);
    if (!copy) {
        return SE3D_ERR_NO_MEMORY;
    }
    check->messages[check->message_count++] = copy;
    return SE3D_OK;
}

/* Append to a list of names; beyond NAMES_MAX they are only counted. */
static void list_name(char *list, size_t size, size_t index, size_t count, const char *name)
{
    size_t used = strlen(list);
    if (index < NAMES_MAX) {
        snprintf(list + used, size - used, "%s%s", index > 0 ? ", " : "", name);
    } else if (index == count - 1) {
        snprintf(list + used, size - used, " and %zu more", count - NAMES_MAX);
    }
}

static void name_body(const se3di_model *model, uint32_t body, char *text, size_t size)
{
    const char *name = model->bodies[body].name;
    if (name) {
        snprintf(text, size, "%.100s", name);
    } else {
        snprintf(text, size, "body %" PRIu32, body);
    }
}

/* ---- components ---- */

static uint32_t find_root(const inspection *in, uint32_t body)
{
    while (in->component[body] != body) {
        in->component[body] = in->component[in->component[body]];
        body = in->component[body];
    }
    return body;
}

static void unite(inspection *in)
{
    const se3di_assembly *assembly = &in->equations->assembly;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        in->component[k] = k;
    }
    for (uint32_t j = 0; j < assembly->constraint_count; ++j) {
        int32_t begin = assembly->joint_begin[j];
        for (int32_t k = begin + 1; k < assembly->joint_begin[j + 1]; ++k) {
            uint32_t a = find_root(in, (uint32_t)assembly->joint_body[begin]);
            uint32_t b = find_root(in, (uint32_t)assembly->joint_body[k]);
            in->component[a > b ? a : b] = a > b ? b : a;
        }
    }
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        in->component[k] = find_root(in, k);
    }
}

/* Mark the components that a constraint ties to a fixed body. */
static void mark_held(inspection *in)
{
    const se3di_assembly *assembly = &in->equations->assembly;
    for (uint32_t j = 0; j < assembly->constraint_count; ++j) {
        const se3di_constraint *constraint = &in->model->constraints[j];
        int fixed = 0;
        for (uint32_t k = 0; k < constraint->body_count; ++k) {
            fixed |= in->model->bodies[constraint->bodies[k]].fixed != 0;
        }
        if (fixed && assembly->joint_begin[j] < assembly->joint_begin[j + 1]) {
            in->held[in->component[assembly->joint_body[assembly->joint_begin[j]]]] = 1;
        }
    }
}

/* Whether a spring, damper or bushing leads out of a component. */
static int has_springs(const inspection *in, uint32_t root)
{
    const se3di_assembly *assembly = &in->equations->assembly;
    for (size_t k = 0; k < in->model->force_slots.count; ++k) {
        const se3di_force *force = &in->model->forces[k];
        if (!(se3di_force_class_of(force)->traits & SE3DI_FORCE_HOLDS)) {
            continue;
        }
        const int32_t i = assembly->free_index[force->body_i];
        const int32_t j = assembly->free_index[force->body_j];
        const int inside_i = i >= 0 && in->component[i] == root;
        const int inside_j = j >= 0 && in->component[j] == root;
        if (inside_i != inside_j) {
            return 1;
        }
    }
    return 0;
}

static se3d_status report_unheld(inspection *in, uint32_t root)
{
    const se3di_assembly *assembly = &in->equations->assembly;
    char list[TEXT_SIZE - 256] = "";
    char name[NAME_SIZE];
    size_t count = 0;
    size_t index = 0;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        count += in->component[k] == root;
    }
    for (uint32_t k = root; k < assembly->body_count; ++k) {
        if (in->component[k] == root) {
            name_body(in->model, assembly->free_body[k], name, sizeof name);
            list_name(list, sizeof list, index++, count, name);
        }
    }
    if (has_springs(in, root)) {
        return add_message(
            in->check, "only force elements hold %s: no constraint leads to a fixed body", list);
    }
    if (count == 1) {
        return add_message(in->check, "nothing holds %s: no constraint leads to a fixed body",
                           list);
    }
    return add_message(in->check,
                       "nothing holds %s: they are joined, but no constraint leads to a fixed body",
                       list);
}

/* ---- taking off open ends ---- */

/* Whether the block of a constraint on one body has full row rank. */
static int is_full(const inspection *in, uint32_t joint, int32_t place)
{
    const se3di_assembly *assembly = &in->equations->assembly;
    size_t rows = (size_t)assembly->joint_rows[joint];
    const double *from = assembly->C + assembly->block_offset[place];
    double block[6 * 6];
    if (rows > 6) {
        return 0;
    }
    for (size_t r = 0; r < rows; ++r) {
        double length = 0.0;
        double *v = block + 6 * r;
        for (size_t c = 0; c < 6; ++c) {
            v[c] = from[6 * r + c] * (c < 3 ? in->size : 1.0);
            length += v[c] * v[c];
        }
        for (int pass = 0; pass < 2; ++pass) {
            for (size_t k = 0; k < r; ++k) {
                double dot = 0.0;
                for (size_t c = 0; c < 6; ++c) {
                    dot += v[c] * block[6 * k + c];
                }
                for (size_t c = 0; c < 6; ++c) {
                    v[c] -= dot * block[6 * k + c];
                }
            }
        }
        double rest = 0.0;
        for (size_t c = 0; c < 6; ++c) {
            rest += v[c] * v[c];
        }
        if (!(rest > 1e-8 * length)) { /* far from dependent; near ones are left to the QR */
            return 0;
        }
        for (size_t c = 0; c < 6; ++c) {
            v[c] /= sqrt(rest);
        }
    }
    return 1;
}

/* The only open constraint of `body`, with the place of its block. */
static uint32_t find_open(const inspection *in, uint32_t body, int32_t *place)
{
    const se3di_assembly *assembly = &in->equations->assembly;
    for (uint32_t j = 0; j < assembly->constraint_count; ++j) {
        for (int32_t k = assembly->joint_begin[j]; !in->gone[j] && k < assembly->joint_begin[j + 1];
             ++k) {
            if ((uint32_t)assembly->joint_body[k] == body) {
                *place = k;
                return j;
            }
        }
    }
    return assembly->constraint_count;
}

static void count_open(inspection *in)
{
    const se3di_assembly *assembly = &in->equations->assembly;
    for (int32_t k = 0; k < assembly->joint_begin[assembly->constraint_count]; ++k) {
        ++in->open_count[assembly->joint_body[k]];
    }
}

/* Take off bodies from the open ends, following each chain inwards. */
static void take_off(inspection *in)
{
    const se3di_assembly *assembly = &in->equations->assembly;
    count_open(in);
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        uint32_t body = k;
        while (in->open_count[body] == 1 && !in->off[body]) {
            int32_t place = 0;
            uint32_t joint = find_open(in, body, &place);
            in->off[body] = 1;
            if (joint == assembly->constraint_count || !is_full(in, joint, place)) {
                break;
            }
            in->gone[joint] = 1;
            in->check->rank += (size_t)assembly->joint_rows[joint];
            for (int32_t b = assembly->joint_begin[joint]; b < assembly->joint_begin[joint + 1];
                 ++b) {
                uint32_t other = (uint32_t)assembly->joint_body[b];
                --in->open_count[other];
                body = other != body && in->open_count[other] == 1 ? other : body;
            }
        }
    }
}

/* ---- a component ---- */

static size_t collect_columns(inspection *in, uint32_t root)
{
    size_t count = 0;
    for (uint32_t k = 0; k < in->equations->assembly.body_count; ++k) {
        if (in->component[k] == root) {
            in->column[k] = (uint32_t)(6 * count++);
        }
    }
    return 6 * count;
}

/* Rows of the component `root`; those of constraints between fixed bodies go with `root` =
 * body_count. */
static size_t collect_rows(inspection *in, uint32_t root)
{
    const se3di_assembly *assembly = &in->equations->assembly;
    size_t count = 0;
    for (uint32_t j = 0; j < assembly->constraint_count; ++j) {
        int32_t begin = assembly->joint_begin[j];
        uint32_t owner = begin < assembly->joint_begin[j + 1]
                             ? in->component[assembly->joint_body[begin]]
                             : assembly->body_count;
        for (int32_t r = 0; owner == root && !in->gone[j] && r < assembly->joint_rows[j]; ++r) {
            in->row[count++] = in->model->constraints[j].row_begin + (uint32_t)r;
        }
    }
    return count;
}

static void fill_rows(inspection *in, uint32_t root, size_t columns)
{
    const se3di_assembly *assembly = &in->equations->assembly;
    double *to = in->C;
    for (uint32_t j = 0; j < assembly->constraint_count; ++j) {
        int32_t begin = assembly->joint_begin[j];
        int32_t end = assembly->joint_begin[j + 1];
        if (in->gone[j] || begin == end || in->component[assembly->joint_body[begin]] != root) {
            continue;
        }
        for (int32_t r = 0; r < assembly->joint_rows[j]; ++r, to += columns) {
            for (int32_t k = begin; k < end; ++k) {
                const double *from = assembly->C + assembly->block_offset[k] + 6 * r;
                double *place = to + in->column[assembly->joint_body[k]];
                for (int c = 0; c < 6; ++c) {
                    place[c] = from[c] * (c < 3 ? in->size : 1.0);
                }
            }
        }
    }
}

/* By how much a redundant equation contradicts those it depends on, at the level whose right-hand
 * sides are `v` with the given stride. */
static double contradiction(const inspection *in, const se3di_rank *rank, int32_t k,
                            const double *v, size_t stride)
{
    double sum = v[stride * in->row[rank->redundant[k]]];
    for (int32_t e = rank->combination_begin[k]; e < rank->combination_begin[k + 1]; ++e) {
        sum -= rank->combination[e] * v[stride * in->row[rank->combination_row[e]]];
    }
    return sum;
}

static void name_rows(const inspection *in, const se3di_rank *rank, int32_t k, char *list,
                      size_t size)
{
    char name[NAME_SIZE];
    int32_t begin = rank->combination_begin[k];
    int32_t end = rank->combination_begin[k + 1];
    list[0] = '\0';
    for (int32_t e = begin; e < end; ++e) {
        se3di_row_name(in->model, in->row[rank->combination_row[e]], name, sizeof name);
        list_name(list, size, (size_t)(e - begin), (size_t)(end - begin), name);
    }
}

/* A row that the equations do without. */
static se3d_status report_left_out(inspection *in, uint32_t row)
{
    char name[NAME_SIZE];
    const double scale = se3di_row_get_scale(in->model, row, in->size);
    se3di_row_name(in->model, row, name, sizeof name);
    return add_message(in->check,
                       "%s is redundant but for the digits of its data, and left out of the "
                       "equations: it is off by %.2g%s",
                       name, se3di_row_measure(in->model, row, in->size) * scale,
                       se3di_row_get_unit(in->model, row));
}

static se3d_status report_redundant(inspection *in, const se3di_rank *rank, int32_t k)
{
    char name[NAME_SIZE];
    char list[TEXT_SIZE - 512];
    uint32_t row = in->row[rank->redundant[k]];
    if (in->model->rows[row].left_out & SE3DI_ROW_BROKEN) {
        return SE3D_OK;
    }
    const char *unit = se3di_row_get_unit(in->model, row);
    double scale = se3di_row_get_scale(in->model, row, in->size);
    double gap = contradiction(in, rank, k, in->equations->phi, 1);
    double rate = contradiction(in, rank, k, in->equations->assembly.f + 1, 3);
    int empty = rank->combination_begin[k] == rank->combination_begin[k + 1];
    if (in->model->rows[row].left_out) {
        return report_left_out(in, row);
    }
    se3di_row_name(in->model, row, name, sizeof name);
    name_rows(in, rank, k, list, sizeof list);
    if (!in->lost && fabs(gap) > (in->violated ? 1e-5 : 1e-8) * scale) {
        ++in->check->inconsistent;
        return add_message(in->check, "%s contradicts %s: it is off by %.6g%s", name,
                           empty ? "the fixed bodies" : list, gap, unit);
    }
    if (fabs(rate) > 1e-9 * scale) {
        ++in->check->inconsistent;
        return add_message(in->check,
                           "%s contradicts %s in its rate: it is off by %.6g%s/s, the drivers "
                           "demand different velocities",
                           name, empty ? "the fixed bodies" : list, rate, unit);
    }
    double bend = in->moves ? contradiction(in, rank, k, in->equations->c, 1) : 0.0;
    if (fabs(bend) > 1e-6 * (scale + fabs(in->equations->c[row]))) {
        ++in->check->inconsistent;
        return add_message(in->check,
                           "%s contradicts %s in its second derivative: it is off by %.6g%s/s^2, "
                           "the drivers demand different accelerations",
                           name, empty ? "the fixed bodies" : list, bend, unit);
    }
    if (empty) {
        return add_message(in->check,
                           "%s constrains nothing: its bodies are fixed, or it is degenerate at "
                           "this pose",
                           name);
    }
    return add_message(in->check, "%s duplicates %s", name, list);
}

/* Which bodies the freedoms of a component move. */
static se3d_status report_freedoms(inspection *in, uint32_t root, const se3di_rank *rank)
{
    const se3di_assembly *assembly = &in->equations->assembly;
    char list[TEXT_SIZE - 256] = "";
    char name[NAME_SIZE];
    size_t count = 0;
    for (int pass = 0; pass < 2; ++pass) {
        size_t index = 0;
        for (uint32_t k = root; k < assembly->body_count; ++k) {
            double most = 0.0;
            for (int32_t f = 0; in->component[k] == root && f < rank->freedom_count; ++f) {
                const double *v =
                    rank->freedom + (size_t)f * (size_t)rank->column_count + in->column[k];
                for (int c = 0; c < 6; ++c) {
                    most = fmax(most, fabs(v[c]));
                }
            }
            if (most > 1e-7) {
                name_body(in->model, assembly->free_body[k], name, sizeof name);
                if (pass == 1) {
                    list_name(list, sizeof list, index, count, name);
                }
                ++index;
            }
        }
        count = index;
    }
    return count == 0 ? SE3D_OK
                      : add_message(in->check, "%" PRId32 " degree%s of freedom: %s can move",
                                    rank->freedom_count, rank->freedom_count == 1 ? "" : "s", list);
}

static se3d_status inspect_component(inspection *in, uint32_t root, size_t rows, size_t columns)
{
    const se3d_allocator *allocator = &in->check->allocator;
    se3di_rank rank;
    in->C_count = rows * columns;
    in->C = se3di_alloc(allocator, in->C_count, sizeof *in->C);
    if (!in->C) {
        return SE3D_ERR_NO_MEMORY;
    }
    fill_rows(in, root, columns);
    se3d_status status =
        se3di_rank_analyse(allocator, (int32_t)rows, (int32_t)columns, in->C, in->tolerance, &rank);
    se3di_free(allocator, in->C, in->C_count, sizeof *in->C);
    SE3DI_TRY(status);
    in->check->rank += (size_t)rank.rank;
    for (int32_t k = 0; k < rank.redundant_count && status >= 0; ++k) {
        status = report_redundant(in, &rank, k);
    }
    /* constraints that were taken off are not in this null space */
    if (status >= 0 && in->model->row_count <= ROWS_SMALL &&
        root < in->equations->assembly.body_count) {
        status = report_freedoms(in, root, &rank);
    }
    se3di_rank_destroy(allocator, &rank);
    return status;
}

/* Equations of components that are too large for a dense analysis: only their number is found. */
static se3d_status count_by_factor(inspection *in, size_t rows)
{
    se3di_equations *equations = in->equations;
    se3di_assembly_eval_mass(&equations->assembly);
    const se3di_kkt_values values = se3di_equations_values(equations);
    se3di_kkt_factor_info info = {0};
    SE3DI_TRY(se3di_kkt_factor(equations->kkt, &values, &info));
    in->check->rank = in->model->row_count - (size_t)info.dependent_rows; /* what broke is one */
    return add_message(in->check,
                       "%zu equations depend on each other's bodies: too many to name redundant "
                       "ones (the limit is %d); their number is an estimate",
                       rows, ROWS_MAX);
}

static se3d_status inspect(inspection *in)
{
    const se3di_assembly *assembly = &in->equations->assembly;
    size_t too_many = 0;
    unite(in);
    mark_held(in);
    if (in->model->row_count > ROWS_SMALL) {
        take_off(in);
    }
    for (uint32_t root = 0; root <= assembly->body_count; ++root) {
        if (root < assembly->body_count && in->component[root] != root) {
            continue;
        }
        if (root < assembly->body_count && !in->held[root]) {
            SE3DI_TRY(report_unheld(in, root));
        }
        size_t rows = collect_rows(in, root);
        size_t columns = root < assembly->body_count ? collect_columns(in, root) : 6;
        if (rows > ROWS_MAX) {
            too_many = rows > too_many ? rows : too_many;
        } else if (rows > 0) {
            SE3DI_TRY(inspect_component(in, root, rows, columns));
        }
    }
    return too_many > 0 ? count_by_factor(in, too_many) : SE3D_OK;
}

/* Poses that fit, or those of least violation, with a message if the given ones do not fit. */
static se3d_status settle_poses(inspection *in)
{
    se3di_equations *equations = in->equations;
    double t = in->model->time;
    char gap[400];
    SE3DI_TRY(se3di_assembly_eval_functions(&equations->assembly, t, equations->error));
    double worst = se3di_position_measure(equations, gap, sizeof gap);
    in->tolerance = RANK_ASSEMBLED;
    if (worst <= FITS) {
        return SE3D_OK;
    }
    equations->unfolds = 1;
    se3d_status status = se3di_position_solve(equations, t);
    if (status == SE3D_ERR_INCONSISTENT || status == SE3D_ERR_NO_CONVERGENCE) {
        in->tolerance = RANK_VIOLATED;
        in->violated = 1;
        in->lost = status == SE3D_ERR_NO_CONVERGENCE;
        return add_message(in->check, "%s", equations->error->message);
    }
    SE3DI_TRY(status);
    SE3DI_TRY(add_message(
        in->check, "the given poses do not fit (%s); what follows holds at assembled ones", gap));
    if (!se3di_start_moved_describe(in->model, equations->accepted, gap, sizeof gap)) {
        return SE3D_OK;
    }
    se3di_log_write(in->told, SE3D_LOG_WARNING, SE3D_LOG_MOVED, "%s", gap);
    return add_message(in->check, "%s", gap);
}

/* Accelerations are compared where velocities follow what drives them. */
static void take_motion(inspection *in)
{
    se3di_equations *equations = in->equations;
    const int drives = equations->assembly.timed_count > 0 || equations->assembly.user_count > 0;
    in->moves = drives && !in->violated && se3di_velocity_solve(equations, in->model->time) >= 0;
    if (in->moves) {
        se3di_assembly_eval_gamma(&equations->assembly, equations->c);
    }
}

static se3d_status inspect_model(inspection *in)
{
    SE3DI_TRY(se3di_ranks_decide(in->equations, in->model->time));
    SE3DI_TRY(settle_poses(in));
    take_motion(in);
    se3di_assembly_eval_phi(&in->equations->assembly, in->equations->phi);
    se3di_assembly_eval_jacobian(&in->equations->assembly);
    SE3DI_TRY(se3di_user_report(in->equations->assembly.model, in->equations->error));
    SE3DI_TRY(inspect(in));
    if (in->violated && !in->lost && in->check->inconsistent == 0) {
        in->check->inconsistent = 1;
    }
    return in->check->rank < in->check->equations ? SE3D_INFO_REDUNDANT : SE3D_OK;
}

/* ---- life ---- */

typedef struct work_array {
    void **data;
    size_t count, size;
} work_array;

#define WORK_ARRAYS 7

static void list_work(inspection *in, work_array list[WORK_ARRAYS])
{
    size_t bodies = in->equations->assembly.body_count + 1;
    size_t constraints = in->equations->assembly.constraint_count;
    work_array arrays[WORK_ARRAYS] = {
        {(void **)&in->component, bodies, sizeof *in->component},
        {(void **)&in->column, bodies, sizeof *in->column},
        {(void **)&in->row, in->model->row_count, sizeof *in->row},
        {(void **)&in->held, bodies, sizeof *in->held},
        {(void **)&in->gone, constraints, sizeof *in->gone},
        {(void **)&in->off, bodies, sizeof *in->off},
        {(void **)&in->open_count, bodies, sizeof *in->open_count},
    };
    memcpy(list, arrays, sizeof arrays);
}

static se3d_status inspect_with_work(inspection *in)
{
    const se3d_allocator *allocator = &in->check->allocator;
    work_array work[WORK_ARRAYS];
    se3d_status status = SE3D_OK;
    list_work(in, work);
    for (int k = 0; k < WORK_ARRAYS; ++k) {
        *work[k].data = se3di_alloc(allocator, work[k].count, work[k].size);
        status = *work[k].data ? status : SE3D_ERR_NO_MEMORY;
    }
    if (status >= 0) {
        status = inspect_model(in);
    }
    for (int k = 0; k < WORK_ARRAYS; ++k) {
        se3di_free(allocator, *work[k].data, work[k].count, work[k].size);
    }
    return status;
}

/* ---- shapes ---- */

/* Meshes that meet without a trace: one message, with the first pair. */
static se3d_status report_meshes(se3di_check *check, const se3di_model *model)
{
    uint32_t first[2] = {0, 0};
    size_t pairs = 0;
    char more[60] = "";
    for (uint32_t b = 1; b < model->shape_slots.count; ++b) {
        for (uint32_t a = 0; a < b && se3di_shape_is(&model->shapes[b], SE3DI_SHAPE_IS_SURFACE);
             ++a) {
            if (se3di_shapes_pass_through(model, a, b) && pairs++ == 0) {
                first[0] = a;
                first[1] = b;
            }
        }
    }
    if (pairs == 0) {
        return SE3D_OK;
    }
    if (pairs > 1) {
        snprintf(more, sizeof more, " (and %zu more pairs)", pairs - 1);
    }
    return add_message(
        check,
        "the meshes %.100s and %.100s%s pass through each other: neither is convex or "
        "can be taken apart; close one, make it simpler, or build it from other "
        "shapes",
        se3di_shape_describe(model, first[0]), se3di_shape_describe(model, first[1]), more);
}

se3d_status se3di_check_init(se3di_check *check, se3di_model *model, se3di_error *error)
{
    se3di_error own = {0};
    se3di_equations equations;
    *check = (se3di_check){.allocator = model->allocator};
    SE3DI_TRY(se3di_equations_init(&equations, model, &se3di_formulation_romega, 0, error));
    equations.error = &own;
    check->bodies = equations.assembly.body_count;
    check->equations = model->row_count - model->broken_count;
    inspection in = {.check = check,
                     .equations = &equations,
                     .model = model,
                     .told = error,
                     .size = se3di_model_get_size(model)};
    const int32_t was_known = model->ranks_known;
    se3di_state_accept(&equations);
    se3d_status status = inspect_with_work(&in);
    if (!was_known) { /* a run is to decide where it starts */
        se3di_model_take_all_rows(model);
    }
    if (status >= 0 && report_meshes(check, model) < 0) {
        status = SE3D_ERR_NO_MEMORY;
    }
    se3di_state_restore(&equations);
    se3di_equations_destroy(&equations);
    if (status < 0) {
        se3di_check_destroy(check);
        return se3di_error_set(error, status, "%s",
                               own.status == status ? own.message
                                                    : "no memory for the report on constraints");
    }
    return status;
}

void se3di_check_destroy(se3di_check *check)
{
    for (size_t k = 0; k < check->message_count; ++k) {
        se3di_text_free(&check->allocator, check->messages[k]);
    }
    se3di_free(&check->allocator, check->messages, check->message_capacity,
               sizeof *check->messages);
    check->messages = NULL;
    check->message_count = check->message_capacity = 0;
}
