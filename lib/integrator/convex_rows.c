/* SPDX-License-Identifier: BSD-3-Clause */
/* Constraints in a step of convex, island by island: their blocks, what C v is to be, multipliers,
 * and the solvers of the islands' equations. A solver is kept by the first body of its island and
 * lasts while the same bodies are coupled in the same way: what happens in one machine does not
 * make others begin anew. Joints that broke join nothing. */
#include "integrator/convex.h"

#include "model/model.h"

#include <string.h>

/* The numbers of a pattern: bodies, pairs, which bodies, and which of them contacts couple. */
struct se3di_convex_solver {
    se3di_kkt *kkt;
    int32_t *key;
    size_t key_count, key_capacity;
};

static void clear_solver(se3di_convex_solver *solver)
{
    se3di_kkt_destroy(solver->kkt);
    solver->kkt = NULL;
    solver->key_count = 0;
}

void se3di_convex_rows_destroy(se3di_convex_rows *rows, const se3d_allocator *allocator)
{
    for (size_t k = 0; k < rows->solver_capacity; ++k) {
        clear_solver(&rows->solvers[k]);
        se3di_free(allocator, rows->solvers[k].key, rows->solvers[k].key_capacity,
                   sizeof *rows->solvers[k].key);
    }
    se3di_free(allocator, rows->solvers, rows->solver_capacity, sizeof *rows->solvers);
    se3di_free(allocator, rows->joint, rows->joint_capacity, sizeof *rows->joint);
    se3di_free(allocator, rows->count, rows->count_capacity, sizeof *rows->count);
    se3di_free(allocator, rows->begin, rows->begin_capacity, sizeof *rows->begin);
    se3di_free(allocator, rows->body, rows->body_capacity, sizeof *rows->body);
    se3di_free(allocator, rows->C, rows->C_capacity, sizeof *rows->C);
    se3di_free(allocator, rows->lambda, rows->lambda_capacity, sizeof *rows->lambda);
    se3di_free(allocator, rows->aimed, rows->aimed_capacity, sizeof *rows->aimed);
    se3di_free(allocator, rows->key, rows->key_capacity, sizeof *rows->key);
}

static se3d_status reserve_all(se3di_convex *c, const se3di_assembly *assembly)
{
    se3di_convex_rows *r = &c->rows;
    const size_t joints = assembly->constraint_count, rows = assembly->row_count;
    const struct {
        void *place;
        size_t *capacity, count, size;
    } arrays[] = {
        {&r->solvers, &r->solver_capacity, assembly->body_count, sizeof *r->solvers},
        {&r->joint, &r->joint_capacity, joints, sizeof *r->joint},
        {&r->count, &r->count_capacity, joints, sizeof *r->count},
        {&r->begin, &r->begin_capacity, joints + c->island_count, sizeof *r->begin},
        {&r->body, &r->body_capacity, assembly->joint_body_count, sizeof *r->body},
        {&r->C, &r->C_capacity, assembly->joint_value_count, sizeof *r->C},
        {&r->lambda, &r->lambda_capacity, rows, sizeof *r->lambda},
        {&r->aimed, &r->aimed_capacity, rows, sizeof *r->aimed},
        {&r->key, &r->key_capacity, 2 + assembly->body_count + 2 * c->pair_count, sizeof *r->key}};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k) {
        SE3DI_TRY(se3di_array_reserve_at(&assembly->model->allocator, arrays[k].place,
                                         arrays[k].capacity, arrays[k].count, arrays[k].size));
    }
    return SE3D_OK;
}

int32_t se3di_convex_joined(const se3di_assembly *assembly, uint32_t joint)
{
    const se3di_model *model = assembly->model;
    const int32_t begin = assembly->joint_begin[joint];
    const int acts = assembly->joint_rows[joint] > 0 && assembly->joint_begin[joint + 1] > begin &&
                     !se3di_is_broken(&model->constraints[joint], model->rows);
    return acts ? assembly->joint_body[begin] : -1;
}

/* NULL: it acts on none that is solved for. */
static se3di_convex_island *island_of(const se3di_convex *c, const se3di_assembly *assembly,
                                      uint32_t joint)
{
    const int32_t body = se3di_convex_joined(assembly, joint);
    const int32_t number = body >= 0 ? c->number[body] : -1;
    return number >= 0 ? &c->islands[number] : NULL;
}

static size_t value_count(const se3di_assembly *assembly, uint32_t joint)
{
    return (size_t)(6 * assembly->joint_rows[joint] *
                    (assembly->joint_begin[joint + 1] - assembly->joint_begin[joint]));
}

static void count_joints(se3di_convex *c, const se3di_assembly *assembly)
{
    for (uint32_t j = 0; j < assembly->constraint_count; ++j) {
        se3di_convex_island *island = island_of(c, assembly, j);
        if (island) {
            ++island->joint_end;
            island->row_end += (size_t)assembly->joint_rows[j];
            island->link += (size_t)(assembly->joint_begin[j + 1] - assembly->joint_begin[j]);
            island->value += value_count(assembly, j);
        }
    }
}

/* Counts become beginnings. */
static void lay_out(se3di_convex *c)
{
    size_t joint = 0, row = 0, link = 0, value = 0;
    for (size_t k = 0; k < c->island_count; ++k) {
        se3di_convex_island *island = &c->islands[k];
        const size_t joints = island->joint_end, rows = island->row_end;
        const size_t links = island->link, values = island->value;
        island->joint = island->joint_end = joint;
        island->row = island->row_end = row;
        island->begin = joint + k;
        island->link = link;
        island->value = value;
        c->rows.begin[island->begin] = 0;
        joint += joints;
        row += rows;
        link += links;
        value += values;
    }
}

static void place_joint(se3di_convex *c, const se3di_assembly *assembly, uint32_t j,
                        se3di_convex_island *island)
{
    se3di_convex_rows *r = &c->rows;
    const size_t at = island->joint_end - island->joint,
                 first = (size_t)r->begin[island->begin + at];
    const int32_t begin = assembly->joint_begin[j], count = assembly->joint_begin[j + 1] - begin;
    r->joint[island->joint_end] = (int32_t)j;
    r->count[island->joint_end++] = assembly->joint_rows[j];
    r->begin[island->begin + at + 1] = (int32_t)first + count;
    for (int32_t e = 0; e < count; ++e) {
        r->body[island->link + first + (size_t)e] =
            c->place[assembly->joint_body[begin + e]] - (int32_t)island->body;
    }
}

/* Blocks of C, and what C v is to be, from those of the assembly. */
static void gather(se3di_convex *c, const se3di_assembly *assembly)
{
    double *C = c->rows.C;
    size_t row = 0;
    for (size_t k = 0; k < c->joint_count; ++k) {
        const uint32_t j = (uint32_t)c->rows.joint[k];
        const size_t values = value_count(assembly, j), rows = (size_t)assembly->joint_rows[j];
        memcpy(C, assembly->C + assembly->block_offset[assembly->joint_begin[j]],
               values * sizeof *C);
        memcpy(c->rows.aimed + row, c->aimed + assembly->model->constraints[j].row_begin,
               rows * sizeof *c->aimed);
        C += values;
        row += rows;
    }
}

/* Solvers of what is no island any more, or was of another model. */
static void clear_old(se3di_convex *c, const se3di_assembly *assembly)
{
    se3di_convex_rows *r = &c->rows;
    const int is_other = r->topology_version != assembly->topology_version ||
                         r->break_version != assembly->break_version;
    for (size_t k = 0; k < r->solver_capacity; ++k) {
        const int is_first = k < assembly->body_count && c->number[k] >= 0 &&
                             c->body_at[c->islands[c->number[k]].body] == (int32_t)k;
        if (r->solvers[k].kkt && (is_other || !is_first)) {
            clear_solver(&r->solvers[k]);
        }
    }
    r->topology_version = assembly->topology_version;
    r->break_version = assembly->break_version;
}

se3d_status se3di_convex_share_rows(se3di_convex *c, const se3di_assembly *assembly)
{
    c->joint_count = 0;
    if (assembly->row_count == 0) {
        return SE3D_OK;
    }
    SE3DI_TRY(reserve_all(c, assembly));
    count_joints(c, assembly);
    lay_out(c);
    for (uint32_t j = 0; j < assembly->constraint_count; ++j) {
        se3di_convex_island *island = island_of(c, assembly, j);
        if (island) {
            place_joint(c, assembly, j, island);
            island->row_end += (size_t)assembly->joint_rows[j];
            ++c->joint_count;
        }
    }
    gather(c, assembly);
    clear_old(c, assembly);
    return SE3D_OK;
}

/* The pattern of an island, in numbers. */
static size_t write_key(const se3di_convex *c, const se3di_convex_island *island, int32_t *key)
{
    const size_t bodies = island->body_end - island->body;
    const size_t pairs = island->pair_end - island->pair;
    size_t count = 0;
    key[count++] = (int32_t)bodies;
    key[count++] = (int32_t)pairs;
    memcpy(key + count, c->body_at + island->body, bodies * sizeof *key);
    count += bodies;
    for (size_t k = 2 * island->pair; k < 2 * island->pair_end; ++k) {
        key[count++] = c->pairs[k] - (int32_t)island->body;
    }
    return count;
}

static se3d_status make_solver(se3di_convex *c, const se3d_allocator *allocator,
                               const se3di_convex_island *island, se3di_convex_solver *solver)
{
    const size_t bodies = island->body_end - island->body;
    const se3di_kkt_pattern pattern = {.body_count = bodies,
                                       .joint_count = island->joint_end - island->joint,
                                       .coupling_count = island->pair_end - island->pair,
                                       .joint_rows = c->rows.count + island->joint,
                                       .joint_begin = c->rows.begin + island->begin,
                                       .joint_body = c->rows.body + island->link,
                                       .coupling = solver->key + 2 + bodies,
                                       .body_size = 6,
                                       .symmetric = true,
                                       .body_kind = SE3DI_KKT_BODY_FULL};
    SE3DI_TRY(se3di_kkt_create(allocator, &pattern, SE3DI_KKT_STRUCTURED, NULL, &solver->kkt));
    se3di_kkt_settings settings = se3di_kkt_get_settings(solver->kkt);
    settings.iterated = true;
    se3di_kkt_set_settings(solver->kkt, &settings);
    return SE3D_OK;
}

se3d_status se3di_convex_suit_solver(se3di_convex *c, const se3di_assembly *assembly,
                                     se3di_convex_island *island)
{
    const se3d_allocator *allocator = &assembly->model->allocator;
    se3di_convex_solver *solver = &c->rows.solvers[c->body_at[island->body]];
    const size_t count = write_key(c, island, c->rows.key);
    if (!solver->kkt || solver->key_count != count ||
        memcmp(solver->key, c->rows.key, count * sizeof *solver->key) != 0) {
        clear_solver(solver);
        SE3DI_TRY(se3di_array_reserve_at(allocator, &solver->key, &solver->key_capacity, count,
                                         sizeof *solver->key));
        memcpy(solver->key, c->rows.key, count * sizeof *solver->key);
        SE3DI_TRY(make_solver(c, allocator, island, solver));
        solver->key_count = count;
    }
    island->kkt = solver->kkt;
    return SE3D_OK;
}

void se3di_convex_add_reactions(const se3di_convex *c, const se3di_convex_island *island,
                                double *out)
{
    const se3di_convex_rows *r = &c->rows;
    if (island->joint == island->joint_end) {
        return; /* there may be no rows at all */
    }
    const double *lambda = r->lambda + island->row, *C = r->C + island->value;
    for (size_t j = 0; j < island->joint_end - island->joint; ++j) {
        const int32_t rows = r->count[island->joint + j];
        for (int32_t e = r->begin[island->begin + j]; e < r->begin[island->begin + j + 1]; ++e) {
            double *own = out + 6 * (island->body + (size_t)r->body[island->link + (size_t)e]);
            for (int32_t row = 0; row < rows; ++row, C += 6) {
                for (int k = 0; k < 6; ++k) {
                    own[k] += lambda[row] * C[k];
                }
            }
        }
        lambda += rows;
    }
}

void se3di_convex_take_back_rows(const se3di_convex *c, const se3di_assembly *assembly,
                                 const se3di_convex_island *island, double *out)
{
    size_t row = island->row;
    for (size_t k = island->joint; k < island->joint_end; ++k) {
        const uint32_t j = (uint32_t)c->rows.joint[k];
        const double *lambda = c->rows.lambda + row;
        memcpy(out + assembly->model->constraints[j].row_begin, lambda,
               (size_t)assembly->joint_rows[j] * sizeof *lambda);
        row += (size_t)assembly->joint_rows[j];
    }
}
