/* SPDX-License-Identifier: BSD-3-Clause */
/* The mass in a step of convex, by places. An armature a of a coordinate x, dx/dt = g v, adds
 *
 *     M += a g^T g
 *
 * to the blocks of its two bodies and to the one that couples them (assembly/armature.h), as they
 * are where the step has its constraints; what g turns by in the step, a gamma g^T, is among the
 * loads.                                                              docs/theory/convex.md */
#include "integrator/convex.h"

#include "math/inertia.h"
#include "math/vec3.h"

#include <string.h>

static void place_own(se3di_convex *c, const se3di_assembly *assembly, size_t k)
{
    const se3di_body *body = &assembly->model->bodies[assembly->free_body[k]];
    const size_t at = (size_t)c->place[k];
    double *M = c->own + 36 * at, *mobility = c->mobility + 10 * at, J[9];
    se3di_inertia_matrix(body->J, J);
    memset(M, 0, 36 * sizeof *M);
    for (size_t r = 0; r < 3; ++r) {
        M[7 * r] = body->mass;
        memcpy(M + 6 * (3 + r) + 3, J + 3 * r, 3 * sizeof *J);
    }
    mobility[0] = 1.0 / M[0];
    for (size_t r = 0; r < 3; ++r) {
        const double one[3] = {r == 0, r == 1, r == 2};
        se3di_solve3(J, one, mobility + 1 + 3 * r);
    }
}

static se3d_status place_armatures(se3di_convex *c, const se3di_assembly *assembly)
{
    const se3d_allocator *allocator = &assembly->model->allocator;
    SE3DI_TRY(se3di_array_reserve_at(allocator, &c->geared, &c->geared_capacity,
                                     36 * (size_t)assembly->body_count, sizeof *c->geared));
    SE3DI_TRY(se3di_array_reserve_at(allocator, &c->tie, &c->tie_capacity, 36 * c->pair_count + 1,
                                     sizeof *c->tie));
    memset(c->tie, 0, 36 * c->pair_count * sizeof *c->tie);
    for (size_t k = 0; k < assembly->body_count; ++k) {
        memcpy(c->geared + 36 * (size_t)c->place[k], assembly->H + 36 * k, 36 * sizeof *c->geared);
    }
    for (uint32_t k = 0; k < assembly->armature_pair_count; ++k) {
        const int32_t pair = se3di_convex_find_tie(c, assembly, k);
        if (pair >= 0) {
            memcpy(c->tie + 36 * (size_t)pair, assembly->H_pair + 36 * (size_t)k,
                   36 * sizeof *c->tie);
        }
    }
    c->mass = c->geared;
    return SE3D_OK;
}

se3d_status se3di_convex_place_mass(se3di_convex *c, const se3di_assembly *assembly)
{
    for (size_t k = 0; k < assembly->body_count; ++k) {
        if (se3di_convex_takes_part(c, k)) {
            place_own(c, assembly, k);
        }
    }
    c->mass = c->own;
    return assembly->armature_count > 0 && assembly->row_count > 0 ? place_armatures(c, assembly)
                                                                   : SE3D_OK;
}

void se3di_convex_mul_own(const se3di_convex *c, const se3di_convex_island *island, const double *x,
                          double *out)
{
    for (size_t body = island->body; body < island->body_end; ++body) {
        const double *M = c->own + 36 * body, *v = x + 6 * body;
        double *p = out + 6 * body;
        for (size_t r = 0; r < 3; ++r) {
            const double *J = M + 6 * (3 + r) + 3;
            p[r] = M[0] * v[r];
            p[3 + r] = J[0] * v[3] + J[1] * v[4] + J[2] * v[5];
        }
    }
}

void se3di_convex_mul_mass(const se3di_convex *c, const se3di_convex_island *island,
                           const double *x, double *out)
{
    const size_t first = 6 * island->body, count = 6 * (island->body_end - island->body);
    if (c->mass == c->own) {
        se3di_convex_mul_own(c, island, x, out);
        return;
    }
    const se3di_block_matrix M = se3di_convex_matrix_of(c, island, c->mass, c->tie);
    memset(out + first, 0, count * sizeof *out);
    se3di_block_cg_add_product(&M, x + first, out + first);
}

void se3di_convex_clear_couplings(se3di_convex *c, const se3di_convex_island *island)
{
    const size_t first = 36 * island->pair, count = 36 * (island->pair_end - island->pair);
    if (count > 0 && c->mass == c->own) {
        memset(c->coupling + first, 0, count * sizeof *c->coupling);
    } else if (count > 0) {
        memcpy(c->coupling + first, c->tie + first, count * sizeof *c->coupling);
    }
}
