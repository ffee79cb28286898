/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: joint coordinates. The poses of the bodies stay the truth: every call reads the
 * coordinates from them, unless they are, to the bit, what the last call has read or set. */
#include "se3d/coordinates.h"

#include "assembly/loads.h"
#include "assembly/user.h"
#include "base/floats.h"
#include "linsol/rank.h"
#include "math/vec3.h"
#include "system/coordinate.h"
#include "system/definition.h"
#include "tree/loops.h"
#include "tree/recursion.h"

#include <math.h>
#include <string.h>

#define RANK_TOLERANCE 1e-10

struct se3d_coordinates {
    se3d_system *system; /* NULL: it is gone */
    se3d_allocator allocator;
    struct se3d_coordinates *next;
    se3di_tree tree;
    se3di_assembly assembly;
    se3di_tree_loops loops;
    double *wrench;                         /* [bodies * 6] */
    double *joint;                          /* [nodes * 6] */
    double *given;                          /* [velocities] */
    uint64_t masses_version, poses_version; /* what the tree was refreshed for */
    se3di_frame *seen;                      /* [bodies], and turns [angles]: where tree->q and */
    double *turns;                          /* tree->qdot are from, if it is placed */
    int32_t is_placed;
    int32_t reserved;
    size_t bodies, nodes, velocities, angles;
    size_t positions;
};

/* ---- life ---- */

static void release(se3d_coordinates *c)
{
    se3di_tree_loops_destroy(&c->loops);
    se3di_assembly_destroy(&c->assembly);
    se3di_tree_destroy(&c->tree);
    se3di_free(&c->allocator, c->wrench, 6 * c->bodies, sizeof(double));
    se3di_free(&c->allocator, c->joint, 6 * c->nodes, sizeof(double));
    se3di_free(&c->allocator, c->given, c->velocities, sizeof(double));
    se3di_free(&c->allocator, c->seen, c->bodies, sizeof *c->seen);
    se3di_free(&c->allocator, c->turns, c->angles, sizeof(double));
    c->wrench = c->joint = c->given = c->turns = NULL;
    c->seen = NULL;
}

static void take_versions(se3d_coordinates *c)
{
    c->masses_version = c->system->model.masses_version;
    c->poses_version = c->system->model.poses_version;
}

/* One that is on no coordinate of the tree is not a part of its mass matrix. */
static se3d_status check_armatures(const se3d_coordinates *c)
{
    const int32_t foreign = c->tree.foreign_armature;
    if (foreign < 0) {
        return SE3D_OK;
    }
    const char *name = c->system->model.forces[foreign].name;
    return se3di_error_set(&c->system->error, SE3D_ERR_UNSUPPORTED,
                           "the joint of the armature '%.64s' closes a loop, all of whose other "
                           "joints have armatures or are not on the tree: joint coordinates have "
                           "no place for it",
                           name ? name : "");
}

static se3d_status build(se3d_coordinates *c)
{
    se3d_system *system = c->system;
    SE3DI_TRY(se3di_tree_init(&c->tree, &system->model, 0, &system->error));
    SE3DI_TRY(check_armatures(c));
    SE3DI_TRY(se3di_assembly_init(&c->assembly, &system->model, &se3di_formulation_romega, 0,
                                  &system->error));
    SE3DI_TRY(se3di_tree_loops_init(&c->loops, &c->tree, &c->assembly, &system->error));
    c->bodies = c->tree.body_count;
    c->nodes = c->tree.count;
    c->positions = c->tree.q_count;
    c->velocities = c->tree.v_count;
    c->wrench = se3di_alloc(&c->allocator, 6 * c->bodies, sizeof(double));
    c->joint = se3di_alloc(&c->allocator, 6 * c->nodes, sizeof(double));
    c->angles = system->model.angle_count;
    c->seen = se3di_alloc(&c->allocator, c->bodies, sizeof *c->seen);
    c->turns = se3di_alloc(&c->allocator, c->angles, sizeof(double));
    c->given = se3di_alloc(&c->allocator, c->velocities, sizeof(double));
    if (!c->wrench || !c->joint || !c->seen || !c->turns || !c->given) {
        return se3di_error_set(&system->error, SE3D_ERR_NO_MEMORY,
                               "no memory for joint coordinates");
    }
    take_versions(c);
    return SE3D_OK;
}

se3d_status se3d_coordinates_create(se3d_system *system, se3d_coordinates **coordinates)
{
    if (coordinates) {
        *coordinates = NULL;
    }
    SE3DI_EDIT(system);
    SE3DI_TRY(se3di_check_pointer(system, "coordinates", coordinates));
    se3d_coordinates *c = se3di_alloc(&system->model.allocator, 1, sizeof *c);
    if (!c) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for joint coordinates");
    }
    c->system = system;
    c->allocator = system->model.allocator;
    const se3d_status status = build(c);
    if (status < 0) {
        release(c);
        se3di_free(&system->model.allocator, c, 1, sizeof *c);
        return se3di_log_error(&system->error, status);
    }
    c->next = system->coordinates;
    system->coordinates = c;
    *coordinates = c;
    return SE3D_OK;
}

void se3d_coordinates_destroy(se3d_coordinates *coordinates)
{
    se3d_coordinates *c = coordinates;
    if (!c || (c->system && se3di_enter(c->system, SE3DI_BUSY_FREE, __func__) < 0)) {
        return;
    }
    if (c->system) {
        se3d_coordinates **link = &c->system->coordinates;
        while (*link != c) {
            link = &(*link)->next;
        }
        *link = c->next;
        release(c);
    }
    const se3d_allocator allocator = c->allocator;
    se3di_free(&allocator, c, 1, sizeof *c);
}

void se3di_coordinates_orphan(se3d_system *system)
{
    for (se3d_coordinates *c = system->coordinates; c; c = c->next) {
        release(c);
        c->system = NULL;
    }
    system->coordinates = NULL;
}

/* ---- counts and names ---- */

size_t se3d_coordinates_count(const se3d_coordinates *coordinates)
{
    return coordinates ? coordinates->velocities : 0;
}

size_t se3d_coordinates_count_positions(const se3d_coordinates *coordinates)
{
    return coordinates ? coordinates->positions : 0;
}

size_t se3d_coordinates_count_loop_rows(const se3d_coordinates *coordinates)
{
    return coordinates && coordinates->system ? coordinates->loops.row_count : 0;
}

/* The structure is still the one that the tree was built for. */
static se3d_status check_structure(const se3d_coordinates *c)
{
    const se3di_model *model = &c->system->model;
    if (c->tree.topology_version == model->topology_version &&
        c->tree.break_version == model->break_version) {
        return SE3D_OK;
    }
    return SE3DI_FAIL(c->system, SE3D_ERR_STATE,
                      "elements of the system came, went, changed or broke since these coordinates "
                      "were made: make them anew");
}

static const se3di_tree_node *find_node(const se3di_tree *tree, size_t velocity)
{
    const se3di_tree_node *n = tree->nodes;
    while (velocity >= n->v + (size_t)n->v_count) {
        ++n;
    }
    return n;
}

se3d_status se3d_coordinates_get_entry(se3d_coordinates *coordinates, size_t index,
                                       se3d_constraint *joint, se3d_body *body, se3d_body *parent,
                                       size_t *component, size_t *position)
{
    SE3DI_OWNED(coordinates);
    se3d_system *system = coordinates->system;
    SE3DI_TRY(check_structure(coordinates));
    if (index >= coordinates->velocities) {
        return SE3DI_FAIL_OF(system, "index", SE3D_ERR_INVALID_ARGUMENT, " = %zu, must be < %zu",
                             index, coordinates->velocities);
    }
    const se3di_model *model = &system->model;
    const se3di_tree_node *n = find_node(&coordinates->tree, index);
    if (joint) {
        *joint = se3di_constraint_handle(model, n->constraint);
    }
    if (body) {
        *body = se3di_body_handle(model, n->body);
    }
    if (parent) {
        *parent = se3di_body_handle(model, n->parent_body);
    }
    if (component) {
        *component = index - n->v;
    }
    if (position) {
        *position = n->q;
    }
    return SE3D_OK;
}

/* ---- state ---- */

/* The tree is up to date with what setters changed. */
static se3d_status begin(se3d_coordinates *c)
{
    SE3DI_TRY(check_structure(c));
    const se3di_model *model = &c->system->model;
    if (c->masses_version != model->masses_version || c->poses_version != model->poses_version) {
        se3di_tree_refresh(&c->tree);
        if (c->masses_version != model->masses_version) {
            se3di_tree_loops_refresh(&c->loops);
        } else {
            se3di_tree_loops_take_points(&c->loops);
        }
        take_versions(c);
        c->is_placed = 0;
    }
    return SE3D_OK;
}

/* The tree is placed where the bodies are. */
static void see(se3d_coordinates *c)
{
    const se3di_model *model = &c->system->model;
    memcpy(c->seen, model->frames, c->bodies * sizeof *c->seen);
    for (size_t k = 0; k < c->angles; ++k) {
        c->turns[k] = model->angles[k].theta;
    }
    c->is_placed = 1;
}

static int is_placed(const se3d_coordinates *c)
{
    const se3di_model *model = &c->system->model;
    int same = c->is_placed && memcmp(c->seen, model->frames, c->bodies * sizeof *c->seen) == 0;
    for (size_t k = 0; same && k < c->angles; ++k) {
        same = memcmp(&c->turns[k], &model->angles[k].theta, sizeof *c->turns) == 0;
    }
    return same;
}

/* And placed at the present state. */
static se3d_status place(se3d_coordinates *c)
{
    se3di_tree *tree = &c->tree;
    SE3DI_TRY(begin(c));
    if (!is_placed(c)) {
        se3di_tree_get(tree, tree->q, tree->qdot);
        se3di_tree_place(tree, tree->q, tree->qdot, tree->frames);
        see(c);
    }
    return SE3D_OK;
}

se3d_status se3d_coordinates_get(se3d_coordinates *coordinates, double *q, double *qdot)
{
    SE3DI_OWNED(coordinates);
    const se3di_floats host = se3di_floats_set();
    const se3d_status status = begin(coordinates);
    if (status >= 0) {
        se3di_tree_get(&coordinates->tree, q, qdot);
    }
    se3di_floats_restore(host);
    return status;
}

static se3d_status check_numbers(se3d_system *system, const char *what, const double *values,
                                 size_t count)
{
    for (size_t k = 0; values && k < count; ++k) {
        if (!isfinite(values[k])) {
            return SE3DI_FAIL_OF(system, what, SE3D_ERR_NOT_FINITE, "[%zu] = %g, must be finite", k,
                                 values[k]);
        }
    }
    return SE3D_OK;
}

static se3d_status check_quaternions(const se3d_coordinates *c, const double *q)
{
    for (uint32_t k = 0; q && k < c->tree.count; ++k) {
        const se3di_tree_node *n = &c->tree.nodes[k];
        const size_t at = n->q + (n->type == SE3DI_TREE_FREE ? 3 : 0);
        if (n->type != SE3DI_TREE_FREE && n->type != SE3DI_TREE_SPHERICAL) {
            continue;
        }
        const double *p = q + at;
        const double norm = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
        if (!(norm > 1e-6 && norm < HUGE_VAL)) {
            return SE3DI_FAIL_OF(c->system, "q", SE3D_ERR_INVALID_ARGUMENT,
                                 "[%zu] to [%zu] are a quaternion of length %g", at, at + 3, norm);
        }
    }
    return SE3D_OK;
}

/* What large coordinates give is finite, too. */
static se3d_status check_frames(const se3d_coordinates *c)
{
    for (uint32_t k = 0; k < c->tree.count; ++k) {
        const se3di_frame *frame = &c->tree.frames[c->tree.nodes[k].body];
        double sum = 0.0; /* NaN, if one is not finite */
        for (int i = 0; i < 3; ++i) {
            sum += 0.0 * frame->r[i] + 0.0 * frame->v[i] + 0.0 * frame->w[i];
        }
        if (!(sum == 0.0)) {
            return SE3DI_FAIL(c->system, SE3D_ERR_NOT_FINITE,
                              "the coordinates give a body no finite position or velocity");
        }
    }
    return SE3D_OK;
}

/* Turn counters go on from the angles that were set. */
static void set_turns(se3d_coordinates *c, const double *q)
{
    for (uint32_t k = 0; k < c->tree.count; ++k) {
        const se3di_tree_node *n = &c->tree.nodes[k];
        if (n->angle >= 0) {
            c->system->model.angles[n->angle].theta =
                q[n->q + (n->type == SE3DI_TREE_PLANAR ? 2 : 0)];
        }
    }
}

/* Poses and velocities of tree->frames. */
static void set_frames(se3d_coordinates *c)
{
    for (uint32_t k = 0; k < c->tree.count; ++k) {
        const uint32_t body = c->tree.nodes[k].body;
        c->system->model.frames[body] = c->tree.frames[body];
    }
}

/* The velocities of tree->frames; poses, which may violate joints of the tree, stay. */
static void set_velocities(se3d_coordinates *c)
{
    for (uint32_t k = 0; k < c->tree.count; ++k) {
        const uint32_t body = c->tree.nodes[k].body;
        se3di_frame *frame = &c->system->model.frames[body];
        se3di_copy(c->tree.frames[body].v, frame->v);
        se3di_copy(c->tree.frames[body].w, frame->w);
        se3di_frame_update(frame);
    }
}

se3d_status se3d_coordinates_set(se3d_coordinates *coordinates, const double *q, const double *qdot)
{
    se3d_coordinates *c = coordinates;
    SE3DI_SET_OF(c);
    SE3DI_TRY(begin(c));
    SE3DI_TRY(check_numbers(c->system, "q", q, c->positions));
    SE3DI_TRY(check_numbers(c->system, "qdot", qdot, c->velocities));
    SE3DI_TRY(check_quaternions(c, q));
    if (!q && !qdot) {
        return SE3D_OK;
    }
    se3di_tree *tree = &c->tree;
    c->is_placed = 0;
    if (!q || !qdot) {
        se3di_tree_get(tree, tree->q, tree->qdot);
    }
    if (q) {
        memcpy(tree->q, q, c->positions * sizeof *q);
    }
    if (qdot) {
        memcpy(tree->qdot, qdot, c->velocities * sizeof *qdot);
    }
    se3di_tree_place(tree, tree->q, tree->qdot, tree->frames);
    SE3DI_TRY(check_frames(c));
    if (q) {
        set_frames(c);
        set_turns(c, tree->q);
        see(c);
        se3di_model_touch_poses(&c->system->model);
    } else {
        set_velocities(c);
        se3di_model_touch_state(&c->system->model);
    }
    c->poses_version = c->system->model.poses_version;
    return SE3D_OK;
}

se3d_status se3d_coordinates_move(se3d_coordinates *coordinates, const double *q, const double *dq,
                                  double *out)
{
    SE3DI_OWNED(coordinates);
    SE3DI_TRY(check_structure(coordinates));
    if (!q || !dq || !out) {
        return SE3DI_FAIL(coordinates->system, SE3D_ERR_NULL, "q, dq or out is NULL");
    }
    const se3di_floats host = se3di_floats_set();
    se3di_tree_move(&coordinates->tree, q, dq, out);
    se3di_floats_restore(host);
    return SE3D_OK;
}

/* ---- dynamics ---- */

/* All that acts on the bodies, into the tree. */
static se3d_status load(se3d_coordinates *c)
{
    se3d_system *system = c->system;
    const double t = system->model.time;
    if (c->loops.count == 0 && se3di_tree_falls(&c->tree)) {
        se3di_tree_sum_efforts(&c->tree);
        se3di_tree_pull(&c->tree, system->model.gravity);
        return SE3D_OK;
    }
    se3di_force_sums sums = se3di_tree_sums(&c->tree);
    sums.wrench = c->wrench;
    se3d_status status = se3di_loads_sum(&system->model, t, &sums);
    if (status < 0) {
        return SE3DI_FAIL(system, status, "t = %g s: force element %u: %s", t, sums.failed,
                          se3d_status_get_text(status));
    }
    se3di_tree_take_wrenches(&c->tree, system->model.frames, c->wrench);
    return SE3D_OK;
}

static se3d_status factor(se3d_coordinates *c, const double *effort)
{
    if (se3di_tree_factor(&c->tree, effort) < 0) {
        return SE3DI_FAIL(c->system, SE3D_ERR_SINGULAR,
                          "a coordinate has no inertia: check the masses");
    }
    return SE3D_OK;
}

/* The efforts of the caller (NULL: none) and those of elements along coordinates. */
static const double *add_efforts(se3d_coordinates *c, const double *effort)
{
    double *sum = c->tree.effort;
    for (size_t k = 0; c->tree.has_efforts && effort && k < c->velocities; ++k) {
        sum[k] += effort[k];
    }
    return c->tree.has_efforts ? sum : effort;
}

/* Values and functions of the rows, where loops or drivers of coordinates read them. */
static se3d_status take_rows(se3d_coordinates *c)
{
    se3d_system *system = c->system;
    if (c->loops.count > 0 || c->assembly.timed_count > 0) {
        se3di_assembly_take_values(&c->assembly);
        SE3DI_TRY(se3di_assembly_eval_functions(&c->assembly, system->model.time, &system->error));
    }
    if (c->tree.given_count > 0) {
        se3di_tree_take_given(&c->tree, &c->assembly);
    }
    return SE3D_OK;
}

static se3d_status accelerate(se3d_coordinates *c, const double *effort, double *qddot)
{
    se3d_system *system = c->system;
    SE3DI_TRY(place(c));
    SE3DI_TRY(load(c));
    SE3DI_TRY(take_rows(c));
    SE3DI_TRY(factor(c, add_efforts(c, effort)));
    if (c->loops.count == 0) {
        se3di_tree_accelerate(&c->tree, c->tree.e, qddot);
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_tree_loops_factor(&c->loops));
    const se3d_status status = se3di_tree_loops_accelerate(&c->loops, qddot);
    return status < 0 ? SE3DI_FAIL(system, status, "the equations of the loops: %s",
                                   se3d_status_get_text(status))
                      : status;
}

/* What was computed is finite. */
static se3d_status finish(se3d_coordinates *c, se3d_status status, const char *what, double *values)
{
    if (status >= 0) {
        const se3d_status finite = check_numbers(c->system, what, values, c->velocities);
        status = finite < 0 ? finite : status;
    }
    for (size_t k = 0; status < 0 && k < c->velocities; ++k) {
        values[k] = 0.0;
    }
    return se3di_work_end(c->system, status);
}

/* What is computed from has finite numbers, or none, and there is a place for what comes of it. */
static se3d_status begin_work(se3d_coordinates *c, const char *from, const double *given,
                              const char *what, const double *values)
{
    SE3DI_TRY(se3di_check_pointer(c->system, what, values));
    SE3DI_TRY(check_numbers(c->system, from, given, c->velocities));
    se3di_work_begin(c->system);
    return SE3D_OK;
}

se3d_status se3d_coordinates_compute_accelerations(se3d_coordinates *coordinates,
                                                   const double *effort, double *qddot)
{
    se3d_coordinates *c = coordinates;
    SE3DI_EDIT_PAST_OF(c);
    SE3DI_TRY(begin_work(c, "effort", effort, "qddot", qddot));
    return finish(c, accelerate(c, effort, qddot), "qddot", qddot);
}

static se3d_status find_efforts(se3d_coordinates *c, const double *qddot, double *effort)
{
    SE3DI_TRY(place(c));
    SE3DI_TRY(load(c));
    memset(c->given, 0, c->velocities * sizeof *c->given);
    const double *rates = qddot ? qddot : c->given;
    se3di_tree_propagate(&c->tree, rates);
    se3di_tree_efforts(&c->tree, rates, c->joint, effort);
    for (size_t k = 0; c->tree.has_efforts && k < c->velocities; ++k) {
        effort[k] -= c->tree.effort[k];
    }
    return SE3D_OK;
}

se3d_status se3d_coordinates_compute_efforts(se3d_coordinates *coordinates, const double *qddot,
                                             double *effort)
{
    se3d_coordinates *c = coordinates;
    SE3DI_EDIT_PAST_OF(c);
    SE3DI_TRY(begin_work(c, "qddot", qddot, "effort", effort));
    return finish(c, find_efforts(c, qddot, effort), "effort", effort);
}

static se3d_status find_gravity(se3d_coordinates *c, double *effort)
{
    double g[3];
    se3di_tree *tree = &c->tree;
    SE3DI_TRY(place(c));
    if (se3di_gravity_eval(&c->system->model, c->system->model.time, g, NULL) < 0) {
        return SE3DI_FAIL(c->system, SE3D_ERR_NOT_FINITE, "gravity is not finite");
    }
    for (uint32_t k = 0; k < tree->count; ++k) {
        double *f = c->joint + 6 * (size_t)k;
        se3di_scale(-tree->nodes[k].mass, g, f + 3);
        se3di_cross(tree->links[k].s, f + 3, f);
    }
    se3di_tree_project(tree, c->joint, effort);
    return SE3D_OK;
}

se3d_status se3d_coordinates_compute_gravity(se3d_coordinates *coordinates, double *effort)
{
    se3d_coordinates *c = coordinates;
    SE3DI_EDIT_PAST_OF(c);
    SE3DI_TRY(se3di_check_pointer(c->system, "effort", effort));
    se3di_work_begin(c->system);
    return finish(c, find_gravity(c, effort), "effort", effort);
}

/* ---- inertia ---- */

se3d_status se3d_coordinates_compute_mass_matrix(se3d_coordinates *coordinates, double *M)
{
    SE3DI_EDIT_PAST_OF(coordinates);
    SE3DI_TRY(se3di_check_pointer(coordinates->system, "M", M));
    se3di_work_begin(coordinates->system);
    const se3d_status status = place(coordinates);
    if (status >= 0) {
        se3di_tree_mass_matrix(&coordinates->tree, M);
    }
    return se3di_work_end(coordinates->system, status);
}

se3d_status se3d_coordinates_multiply_mass(se3d_coordinates *coordinates, const double *x,
                                           double *out)
{
    SE3DI_EDIT_PAST_OF(coordinates);
    SE3DI_TRY(se3di_check_pointer(coordinates->system, "x", x));
    SE3DI_TRY(se3di_check_pointer(coordinates->system, "out", out));
    se3di_work_begin(coordinates->system);
    const se3d_status status = place(coordinates);
    if (status >= 0) {
        se3di_tree_mul(&coordinates->tree, x, out);
    }
    return se3di_work_end(coordinates->system, status);
}

/* Nodes are prescribed by drivers or, `given` 0, free. */
static void prescribe(se3di_tree *tree, int given)
{
    for (uint32_t k = 0; k < tree->count; ++k) {
        se3di_tree_node *n = &tree->nodes[k];
        n->flags &= ~SE3DI_TREE_GIVEN;
        n->flags |= given && n->driver >= 0 ? SE3DI_TREE_GIVEN : 0;
    }
}

static se3d_status solve_mass(se3d_coordinates *c, const double *x, double *out)
{
    SE3DI_TRY(place(c));
    memset(c->tree.wrench, 0, 6 * c->nodes * sizeof *c->tree.wrench);
    prescribe(&c->tree, 0);
    const se3d_status status = factor(c, NULL);
    if (status >= 0) {
        se3di_tree_solve(&c->tree, x, out);
    }
    prescribe(&c->tree, 1);
    return status;
}

se3d_status se3d_coordinates_solve_mass(se3d_coordinates *coordinates, const double *x, double *out)
{
    se3d_coordinates *c = coordinates;
    SE3DI_EDIT_PAST_OF(c);
    SE3DI_TRY(se3di_check_pointer(c->system, "x", x));
    SE3DI_TRY(se3di_check_pointer(c->system, "out", out));
    se3di_work_begin(c->system);
    return se3di_work_end(c->system, solve_mass(c, x, out));
}

/* ---- points, momentum ---- */

static se3d_status place_marker(se3d_coordinates *c, se3d_marker marker, uint32_t *body,
                                double point[3])
{
    uint32_t index;
    SE3DI_TRY(se3di_find_marker(c->system, "marker", marker, &index));
    SE3DI_TRY(place(c));
    const se3di_marker *m = &c->system->model.markers[index];
    *body = m->body;
    se3di_tree_point(&c->tree, m->body, m->s, point);
    return SE3D_OK;
}

se3d_status se3d_coordinates_compute_jacobian(se3d_coordinates *coordinates, se3d_marker marker,
                                              double *J, double *rate)
{
    uint32_t body;
    double point[3];
    SE3DI_EDIT_PAST_OF(coordinates);
    se3di_work_begin(coordinates->system);
    const se3d_status status = place_marker(coordinates, marker, &body, point);
    if (status >= 0 && J) {
        se3di_tree_jacobian(&coordinates->tree, body, point, J);
    }
    if (status >= 0 && rate) {
        se3di_tree_jacobian_rate(&coordinates->tree, body, point, rate);
    }
    return se3di_work_end(coordinates->system, status);
}

se3d_status se3d_coordinates_compute_transposed(se3d_coordinates *coordinates, se3d_marker marker,
                                                const double wrench[6], double *effort)
{
    uint32_t body;
    double point[3];
    SE3DI_EDIT_PAST_OF(coordinates);
    SE3DI_TRY(se3di_check_pointer(coordinates->system, "wrench", wrench));
    SE3DI_TRY(se3di_check_pointer(coordinates->system, "effort", effort));
    se3di_work_begin(coordinates->system);
    const se3d_status status = place_marker(coordinates, marker, &body, point);
    if (status >= 0) {
        memset(effort, 0, coordinates->velocities * sizeof *effort);
        se3di_tree_add_transposed(&coordinates->tree, body, point, wrench, effort);
    }
    return se3di_work_end(coordinates->system, status);
}

/* Of each body, about the centre. */
static void sum_momentum(const se3d_coordinates *c, const double centre[3], double momentum[6])
{
    const se3di_model *model = &c->system->model;
    memset(momentum, 0, 6 * sizeof *momentum);
    for (uint32_t k = 0; k < c->tree.count; ++k) {
        const se3di_body *body = &model->bodies[c->tree.nodes[k].body];
        const se3di_frame *frame = &c->tree.frames[c->tree.nodes[k].body];
        const double *J = body->J, *w = frame->w;
        const double spin[3] = {J[0] * w[0] + J[3] * w[1] + J[5] * w[2],
                                J[3] * w[0] + J[1] * w[1] + J[4] * w[2],
                                J[5] * w[0] + J[4] * w[1] + J[2] * w[2]};
        double p[3], arm[3], moment[3], turned[3];
        se3di_scale(body->mass, frame->v, p);
        se3di_sub(frame->r, centre, arm);
        se3di_cross(arm, p, moment);
        se3di_mul(frame->A, spin, turned);
        for (int i = 0; i < 3; ++i) {
            momentum[i] += moment[i] + turned[i];
            momentum[3 + i] += p[i];
        }
    }
}

static se3d_status find_momentum(se3d_coordinates *c, double momentum[6], double *H)
{
    double centre[3];
    SE3DI_TRY(place(c));
    (void)se3di_tree_centre(&c->tree, centre);
    if (momentum) {
        sum_momentum(c, centre, momentum);
    }
    if (H) {
        se3di_tree_momentum_matrix(&c->tree, centre, H);
    }
    return SE3D_OK;
}

se3d_status se3d_coordinates_compute_momentum(se3d_coordinates *coordinates, double momentum[6],
                                              double *H)
{
    SE3DI_EDIT_PAST_OF(coordinates);
    se3di_work_begin(coordinates->system);
    return se3di_work_end(coordinates->system, find_momentum(coordinates, momentum, H));
}

/* ---- loops ---- */

static se3d_status find_loop_jacobian(se3d_coordinates *c, double *G)
{
    se3di_tree_loops *loops = &c->loops;
    SE3DI_TRY(place(c));
    se3di_assembly_eval_some_rows(&c->assembly, loops->constraints, loops->count, loops->gamma);
    SE3DI_TRY(se3di_user_report(&c->system->model, &c->system->error));
    se3di_tree_loops_jacobian(loops, G);
    return check_numbers(c->system, "G", G, loops->row_count * c->velocities);
}

se3d_status se3d_coordinates_compute_loop_jacobian(se3d_coordinates *coordinates, double *G)
{
    se3d_coordinates *c = coordinates;
    SE3DI_EDIT_PAST_OF(c);
    SE3DI_TRY(se3di_check_pointer(c->system, "G", G));
    se3di_work_begin(c->system);
    return se3di_work_end(c->system, find_loop_jacobian(c, G));
}

static se3d_status find_null_space(se3d_coordinates *c, double *G, double *N, size_t *freedoms)
{
    se3di_rank rank;
    const size_t n = c->velocities;
    size_t rows = c->loops.row_count;
    SE3DI_TRY(find_loop_jacobian(c, G));
    for (uint32_t k = 0; k < c->tree.count; ++k) {
        const se3di_tree_node *node = &c->tree.nodes[k];
        if (node->flags & SE3DI_TREE_GIVEN) {
            memset(G + rows * n, 0, n * sizeof *G);
            G[rows++ * n + node->v] = 1.0;
        }
    }
    const se3d_status status =
        se3di_rank_analyse(&c->allocator, (int32_t)rows, (int32_t)n, G, RANK_TOLERANCE, &rank);
    if (status >= 0) {
        *freedoms = (size_t)rank.freedom_count;
        memcpy(N, rank.freedom, *freedoms * n * sizeof *N);
        se3di_rank_destroy(&c->allocator, &rank);
        return SE3D_OK;
    }
    return SE3DI_FAIL(c->system, status, "the null space of the loops: %s",
                      se3d_status_get_text(status));
}

se3d_status se3d_coordinates_compute_null_space(se3d_coordinates *coordinates, double *N,
                                                size_t *freedoms)
{
    se3d_coordinates *c = coordinates;
    if (freedoms) {
        *freedoms = 0;
    }
    SE3DI_EDIT_PAST_OF(c);
    SE3DI_TRY(se3di_check_pointer(c->system, "N", N));
    SE3DI_TRY(se3di_check_pointer(c->system, "freedoms", freedoms));
    const size_t count = (c->loops.row_count + c->tree.given_count) * c->velocities;
    double *G = se3di_alloc(&c->allocator, count, sizeof *G);
    if (!G) {
        return SE3DI_FAIL(c->system, SE3D_ERR_NO_MEMORY, "no memory for the null space");
    }
    se3di_work_begin(c->system);
    const se3d_status status = find_null_space(c, G, N, freedoms);
    se3di_free(&c->allocator, G, count, sizeof *G);
    return se3di_work_end(c->system, status);
}
