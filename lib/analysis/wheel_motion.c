/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/wheel_motion.h"

#include "base/alloc.h"
#include "force/driver_rate.h"
#include "force/measure.h"
#include "joint/equation.h"
#include "math/vec3.h"
#include "primitive/user.h"

#include <math.h>
#include <string.h>

#define RANK_TOLERANCE 1e-9
#define GAP_MAX        1e-7 /* of equations of unit length that a motion leaves, relative */

void se3di_wheel_axes(const se3di_model *model, const se3di_wheel *wheel, double axes[9])
{
    for (int k = 0; k < 3; ++k) {
        se3di_mul(model->frames[wheel->chassis].A, wheel->vehicle + 3 * k, axes + 3 * k);
    }
}

void se3di_wheel_motion_destroy(se3di_wheel_motion *m)
{
    const se3d_allocator *allocator = &m->model->allocator;
    const size_t bodies = m->model->body_slots.count;
    se3di_free(allocator, m->column, bodies, sizeof *m->column);
    se3di_free(allocator, m->used, m->model->constraint_slots.count, sizeof *m->used);
    se3di_free(allocator, m->velocity, 6 * bodies, sizeof *m->velocity);
    se3di_free(allocator, m->acceleration, 6 * bodies, sizeof *m->acceleration);
    se3di_least_norm_destroy(allocator, &m->factors);
    m->column = NULL;
    m->used = NULL;
    m->velocity = m->acceleration = NULL;
}

static int is_held(const se3di_wheel_motion *m, uint32_t body)
{
    return m->model->bodies[body].fixed || body == m->wheel->chassis;
}

static void add_body(se3di_wheel_motion *m, uint32_t body)
{
    if (m->column[body] < 0 && !is_held(m, body)) {
        m->column[body] = (int32_t)m->columns;
        m->columns += 6;
    }
}

/* Whether an equation holds the body of a wheel that names no other to the ground: a road. */
static int is_road(const se3di_wheel_motion *m, const se3di_wheel *wheel,
                   const se3di_constraint *constraint)
{
    const uint32_t *bodies = constraint->bodies;
    if (wheel->travel >= 0 || constraint->row_count != 1 || constraint->body_count != 2) {
        return 0;
    }
    const uint32_t other = bodies[0] == wheel->body ? bodies[1] : bodies[0];
    return (bodies[0] == wheel->body || bodies[1] == wheel->body) &&
           m->model->bodies[other].fixed && other != wheel->chassis;
}

static int is_released(const se3di_wheel_motion *m, size_t constraint)
{
    const int32_t k = (int32_t)constraint;
    for (size_t p = 0; p < m->prescribed_count; ++p) {
        if (is_road(m, m->prescribed[p].wheel, &m->model->constraints[constraint])) {
            return 1;
        }
    }
    return k == m->released[0] || k == m->released[1] || k == m->released[2];
}

/* Whether a body of the constraint takes part. */
static int is_connected(const se3di_wheel_motion *m, const se3di_constraint *constraint)
{
    for (uint32_t b = 0; b < constraint->body_count; ++b) {
        if (m->column[constraint->bodies[b]] >= 0) {
            return 1;
        }
    }
    return 0;
}

/* Bodies from the wheel's on, and their constraints. */
static void collect(se3di_wheel_motion *m)
{
    const se3di_model *model = m->model;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        m->column[k] = -1;
    }
    memset(m->used, 0, model->constraint_slots.count * sizeof *m->used);
    m->columns = m->rows = 0;
    for (size_t k = 0; k < m->prescribed_count; ++k) {
        add_body(m, m->prescribed[k].wheel->body);
    }
    for (size_t before = 0; before != m->rows + 1;) {
        before = m->rows + 1;
        for (size_t k = 0; k < model->constraint_slots.count; ++k) {
            const se3di_constraint *constraint = &model->constraints[k];
            if (m->used[k] || is_released(m, k) || !is_connected(m, constraint)) {
                continue;
            }
            m->used[k] = 1;
            m->rows += constraint->row_count;
            for (uint32_t b = 0; b < constraint->body_count; ++b) {
                add_body(m, constraint->bodies[b]);
            }
        }
    }
}

/* The equations as a dense system, column-major: rows of unit length, turns times the radius. */
typedef struct equations {
    const se3di_model *view; /* the model in the motion */
    size_t rows, columns;
    double *A, *g, *x;
    double *work; /* [rows] */
    size_t size;
} equations;

static void place(const se3di_wheel_motion *m, equations *e, size_t row, uint32_t body,
                  const double block[6])
{
    const int32_t column = m->column[body];
    for (size_t c = 0; c < 6 && column >= 0; ++c) {
        const double scale = c < 3 ? 1.0 : 1.0 / m->wheel->radius;
        e->A[((size_t)column + c) * e->rows + row] += scale * block[c];
    }
}

/* The next column that one of these bodies begins at, -1: none. */
static int32_t find_next(const se3di_wheel_motion *m, const uint32_t *bodies, uint32_t count,
                         int32_t after)
{
    int32_t next = -1;
    for (uint32_t b = 0; b < count; ++b) {
        const int32_t own = m->column[bodies[b]];
        next = own > after && (next < 0 || own < next) ? own : next;
    }
    return next;
}

/* Scale a row of these bodies to unit length, its right-hand side with it. */
static void scale_row(const se3di_wheel_motion *m, equations *e, size_t row, const uint32_t *bodies,
                      uint32_t count)
{
    double square = 0.0;
    for (int32_t at = find_next(m, bodies, count, -1); at >= 0;
         at = find_next(m, bodies, count, at)) {
        for (size_t c = (size_t)at; c < (size_t)at + 6; ++c) {
            square += e->A[c * e->rows + row] * e->A[c * e->rows + row];
        }
    }
    if (!(square > 0.0)) {
        return;
    }
    const double length = sqrt(square);
    for (int32_t at = find_next(m, bodies, count, -1); at >= 0;
         at = find_next(m, bodies, count, at)) {
        for (size_t c = (size_t)at; c < (size_t)at + 6; ++c) {
            e->A[c * e->rows + row] /= length;
        }
    }
    e->g[row] /= length;
}

/* Whether body k of a constraint is one of those before. */
static int is_repeated(const se3di_constraint *constraint, uint32_t k)
{
    for (uint32_t b = 0; b < k; ++b) {
        if (constraint->bodies[b] == constraint->bodies[k]) {
            return 1;
        }
    }
    return 0;
}

/* gamma without what prescribed values add. */
static se3d_status eval_curve(const equations *e, const se3di_constraint *constraint, uint32_t r,
                              double *gamma)
{
    double result[3];
    double jet[3] = {0.0, 0.0, 0.0};
    if (se3di_is_driver_rate(constraint)) {
        return se3di_driver_rate_curve(e->view, constraint, gamma);
    }
    SE3DI_TRY(se3di_equation_eval(e->view, constraint, r, SE3D_FORMULATION_ROMEGA, result));
    if (!se3di_is_user(constraint)) {
        SE3DI_TRY(se3di_row_prescribed(e->view, &e->view->rows[constraint->row_begin + r], jet));
    }
    *gamma = result[2] - jet[2];
    return SE3D_OK;
}

static se3d_status fill_constraint(const se3di_wheel_motion *m, equations *e, size_t *row,
                                   const se3di_constraint *constraint, int curved)
{
    for (uint32_t r = 0; r < constraint->row_count; ++r, ++*row) {
        if (!se3di_is_user(constraint) && m->model->rows[constraint->row_begin + r].left_out) {
            continue; /* stays zero */
        }
        for (uint32_t b = 0; b < constraint->body_count; ++b) {
            double block[7];
            if (is_repeated(constraint, b)) {
                continue;
            }
            SE3DI_TRY(se3di_equation_jacobian(m->model, constraint, r, SE3D_FORMULATION_ROMEGA,
                                              constraint->bodies[b], block));
            place(m, e, *row, constraint->bodies[b], block);
        }
        if (curved) {
            SE3DI_TRY(eval_curve(e, constraint, r, &e->g[*row]));
        }
        scale_row(m, e, *row, constraint->bodies, constraint->body_count);
    }
    return SE3D_OK;
}

/* The spring's length, and the part of its second derivative that has no accelerations. */
static void fill_length(const se3di_wheel_motion *m, equations *e, size_t row,
                        const se3di_wheel *wheel)
{
    const se3di_force *spring = &m->model->forces[wheel->spring];
    se3di_measure length;
    if (se3di_measure_length(m->model, spring, 0, &length)) {
        place(m, e, row, spring->body_i, length.g);
        place(m, e, row, spring->body_j, length.g + 6);
    }
}

static void fill_prescribed(const se3di_wheel_motion *m, equations *e, size_t row,
                            const se3di_wheel_prescription *p, int curved)
{
    const se3di_wheel *wheel = p->wheel;
    const se3di_frame *frame = &e->view->frames[wheel->body];
    uint32_t bodies[3] = {wheel->body, wheel->body, wheel->body};
    double axes[9];
    double block[6] = {0.0};
    double local[3];
    se3di_wheel_axes(m->model, wheel, axes);
    se3di_mul_transposed(frame->A, axes + 6, local);
    e->g[row] = curved ? 0.0 : p->rate;
    if (p->coordinate == SE3DI_WHEEL_LENGTH) {
        fill_length(m, e, row, wheel);
        bodies[1] = m->model->forces[wheel->spring].body_i;
        bodies[2] = m->model->forces[wheel->spring].body_j;
    } else if (p->coordinate == SE3DI_WHEEL_TURN) {
        se3di_copy(local, block + 3);
    } else {
        double turning[3];
        double centripetal[3];
        se3di_copy(axes + 6, block);
        se3di_cross(wheel->center, local, block + 3);
        se3di_cross(frame->w, wheel->center, turning);
        se3di_cross(frame->w, turning, centripetal);
        e->g[row] -= curved ? se3di_dot(local, centripetal) : 0.0;
    }
    place(m, e, row, wheel->body, block);
    scale_row(m, e, row, bodies, 3);
}

static se3d_status fill(const se3di_wheel_motion *m, equations *e, int curved)
{
    size_t row = 0;
    memset(e->A, 0, e->size * sizeof *e->A);
    for (size_t k = 0; k < m->model->constraint_slots.count; ++k) {
        if (m->used[k]) {
            SE3DI_TRY(fill_constraint(m, e, &row, &m->model->constraints[k], curved));
        }
    }
    for (size_t k = 0; k < m->prescribed_count; ++k, ++row) {
        fill_prescribed(m, e, row, &m->prescribed[k], curved);
    }
    return SE3D_OK;
}

/* The largest equation that x leaves, relative. */
static double measure_gap(const equations *e)
{
    double largest = 0.0;
    double size = 0.0;
    for (size_t c = 0; c < e->columns; ++c) {
        size = fmax(size, fabs(e->x[c]));
    }
    for (size_t r = 0; r < e->rows; ++r) {
        double rest = -e->g[r];
        for (size_t c = 0; c < e->columns; ++c) {
            rest += e->A[c * e->rows + r] * e->x[c];
        }
        largest = fmax(largest, fabs(rest));
    }
    return largest / (1.0 + size);
}

static se3d_status solve(se3di_wheel_motion *m, equations *e, int curved, double *result)
{
    SE3DI_TRY(fill(m, e, curved));
    if (!m->factors.qr.A) {
        SE3DI_TRY(se3di_least_norm_factor(&m->model->allocator, (int32_t)e->rows,
                                          (int32_t)e->columns, e->A, RANK_TOLERANCE, &m->factors));
    }
    memcpy(e->work, e->g, e->rows * sizeof *e->work);
    se3di_least_norm_solve(&m->factors, e->work, e->x);
    m->exists = measure_gap(e) <= GAP_MAX;
    for (size_t k = 0; k < m->model->body_slots.count; ++k) {
        for (size_t c = 0; c < 6; ++c) {
            const double scale = c < 3 ? 1.0 : 1.0 / m->wheel->radius;
            result[6 * k + c] = m->column[k] < 0 ? 0.0 : scale * e->x[(size_t)m->column[k] + c];
        }
    }
    return SE3D_OK;
}

/* The same for the velocities or the accelerations along them, in `view`. */
static se3d_status solve_with_memory(se3di_wheel_motion *m, const se3di_model *view, int curved,
                                     double *result)
{
    const se3d_allocator *allocator = &m->model->allocator;
    equations e = {.view = view, .rows = m->rows + m->prescribed_count, .columns = m->columns};
    e.size = e.rows * e.columns + 2 * e.rows + e.columns;
    e.A = se3di_alloc(allocator, e.size, sizeof *e.A);
    if (!e.A) {
        return SE3D_ERR_NO_MEMORY;
    }
    e.g = e.A + e.rows * e.columns;
    e.work = e.g + e.rows;
    e.x = e.work + e.rows;
    const se3d_status status = solve(m, &e, curved, result);
    se3di_free(allocator, e.A, e.size, sizeof *e.A);
    return status;
}

se3d_status se3di_wheel_motion_find(se3di_wheel_motion *m)
{
    const se3d_allocator *allocator = &m->model->allocator;
    const size_t bodies = m->model->body_slots.count;
    m->column = se3di_alloc(allocator, bodies, sizeof *m->column);
    m->used = se3di_alloc(allocator, m->model->constraint_slots.count, sizeof *m->used);
    m->velocity = se3di_alloc(allocator, 6 * bodies, sizeof *m->velocity);
    m->acceleration = se3di_alloc(allocator, 6 * bodies, sizeof *m->acceleration);
    m->factors = (se3di_least_norm){0};
    se3d_status status = SE3D_ERR_NO_MEMORY;
    if (m->column && m->used && m->velocity && m->acceleration) {
        collect(m);
        status = m->columns > 0 ? solve_with_memory(m, m->model, 0, m->velocity) : SE3D_OK;
    }
    if (status < 0) {
        se3di_wheel_motion_destroy(m);
    }
    return status;
}

se3d_status se3di_wheel_motion_change(se3di_wheel_motion *m, const double *rates)
{
    for (size_t k = 0; k < m->prescribed_count; ++k) {
        m->prescribed[k].rate = rates[k];
    }
    return m->columns > 0 ? solve_with_memory(m, m->model, 0, m->velocity) : SE3D_OK;
}

se3d_status se3di_wheel_motion_curve(se3di_wheel_motion *m)
{
    const se3d_allocator *allocator = &m->model->allocator;
    const size_t bodies = m->model->body_slots.count;
    se3di_model view = *m->model; /* only looked at */
    se3di_frame *frames = se3di_alloc(allocator, bodies, sizeof *frames);
    if (!frames) {
        return SE3D_ERR_NO_MEMORY;
    }
    memcpy(frames, m->model->frames, bodies * sizeof *frames);
    for (size_t k = 0; k < bodies; ++k) {
        se3di_copy(m->velocity + 6 * k, frames[k].v);
        se3di_copy(m->velocity + 6 * k + 3, frames[k].w);
        se3di_frame_update(&frames[k]);
    }
    view.frames = frames;
    const se3d_status status = solve_with_memory(m, &view, 1, m->acceleration);
    se3di_free(allocator, frames, bodies, sizeof *frames);
    return status;
}
