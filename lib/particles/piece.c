/* SPDX-License-Identifier: BSD-3-Clause */
#include "particles/piece.h"

#include "math/quaternion.h"
#include "particles/clump.h"
#include "particles/draw.h"

/* NULL: a sphere. */
static const se3di_clump_template *template_of(const se3di_particles *set, uint32_t clump)
{
    return clump > 0 ? &set->templates[clump - 1] : NULL;
}

/* Of lengths over those of the template. */
static double scale_of(const se3di_clump_template *of, const se3di_piece *piece)
{
    return piece->radius / of->bound;
}

/* The mass of a unit of the template's. */
static double factor_of(const se3di_particles *set, const se3di_clump_template *of,
                        const se3di_piece *piece)
{
    const double scale = scale_of(of, piece);
    return (of->given ? 1.0 : set->stuffs[piece->material].material.density) * scale * scale *
           scale;
}

/* Its spheres, of which each counts with the mass that it has at most. */
static void append_balls(se3di_particles *set, const se3di_clump *clump, uint32_t material)
{
    const se3di_clump_template *of = &set->templates[clump->template_index];
    for (uint32_t k = 0; k < of->count; ++k) {
        const se3di_clump_ball *ball = &set->balls[of->begin + k];
        const uint32_t id = se3di_particles_append(set, material, clump->scale * ball->radius,
                                                   clump->x, NULL, NULL);
        set->particles[set->count - 1].inverse_mass = ball->most / clump->factor;
        set->clump_of[id] = (uint32_t)set->clump_count;
    }
}

uint32_t se3di_clumps_append(se3di_particles *set, const se3di_clump_made *made)
{
    static const double rest[3] = {0.0, 0.0, 0.0};
    const se3di_clump_template *of = &set->templates[made->template_index];
    const double density = set->stuffs[made->material].material.density;
    se3di_clump *clump = &set->clumps[set->clump_count];
    *clump = (se3di_clump){.scale = made->scale,
                           .factor = (of->given ? 1.0 : density) * made->scale * made->scale *
                                     made->scale,
                           .first = (uint32_t)set->id_count,
                           .template_index = made->template_index};
    se3di_copy(made->x, clump->x);
    se3di_copy(made->v ? made->v : rest, clump->v);
    se3di_clump_set(set, clump, made->q, made->w ? made->w : rest);
    append_balls(set, clump, made->material);
    ++set->clump_count;
    se3di_clump_place(set, clump, 1);
    return clump->first;
}

size_t se3di_piece_count(const se3di_particles *set, uint32_t clump)
{
    const se3di_clump_template *of = template_of(set, clump);
    return of ? of->count : 1;
}

double se3di_piece_mass(const se3di_particles *set, const se3di_piece *piece)
{
    const se3di_clump_template *of = template_of(set, piece->clump);
    return of ? factor_of(set, of, piece) * of->mass
              : se3di_particles_weigh(set, piece->material, piece->radius);
}

double se3di_piece_smallest(const se3di_particles *set, const se3di_piece *piece)
{
    const se3di_clump_template *of = template_of(set, piece->clump);
    return of ? scale_of(of, piece) * of->smallest : piece->radius;
}

double se3di_piece_lightest(const se3di_particles *set, const se3di_piece *piece)
{
    const se3di_clump_template *of = template_of(set, piece->clump);
    return of ? factor_of(set, of, piece) / of->most : se3di_piece_mass(set, piece);
}

/* Uniform on the sphere of unit quaternions, by rejection: no function that is not exact. */
static void draw_turn(uint64_t state, double q[4])
{
    double square;
    do {
        square = 0.0;
        for (int k = 0; k < 4; ++k) {
            q[k] = 2.0 * se3di_random_draw(&state) - 1.0;
            square += q[k] * q[k];
        }
    } while (!(square > 1e-4 && square <= 1.0));
}

void se3di_piece_turn(se3di_piece *piece, const double turn[4], uint64_t seed, uint64_t number)
{
    double square = 0.0;
    for (int k = 0; k < 4; ++k) {
        square += turn[k] * turn[k];
        piece->q[k] = turn[k];
    }
    if (!(square > 0.0)) {
        /* every clump has a stream of its own */
        uint64_t state = seed ^ (UINT64_C(0xD1B54A32D192ED03) * (number + 1));
        (void)se3di_random_draw(&state);
        draw_turn(state ^ (state >> 31), piece->q);
    }
    (void)se3di_quat_normalize(piece->q, piece->q);
}

double se3di_piece_sphere(const se3di_particles *set, const se3di_piece *piece, size_t k,
                          double x[3])
{
    const se3di_clump_template *of = template_of(set, piece->clump);
    if (!of) {
        se3di_copy(piece->x, x);
        return piece->radius;
    }
    const se3di_clump_ball *ball = &set->balls[of->begin + k];
    double q[4], A[9], r[3];
    se3di_quat_mul(piece->q, of->axes, q);
    se3di_quat_to_matrix(q, A);
    se3di_mul(A, ball->r, r);
    se3di_copy(piece->x, x);
    se3di_add_scaled(scale_of(of, piece), r, x);
    return scale_of(of, piece) * ball->radius;
}

void se3di_piece_append(se3di_particles *set, const se3di_piece *piece, const double v[3])
{
    const se3di_clump_template *of = template_of(set, piece->clump);
    const size_t before = set->count;
    if (of) {
        se3di_clump_made made = {.template_index = piece->clump - 1,
                                 .material = piece->material,
                                 .scale = scale_of(of, piece),
                                 .v = v};
        se3di_copy(piece->x, made.x);
        for (int k = 0; k < 4; ++k) {
            made.q[k] = piece->q[k];
        }
        (void)se3di_clumps_append(set, &made);
    } else {
        (void)se3di_particles_append(set, piece->material, piece->radius, piece->x, v, NULL);
    }
    for (size_t k = before; k < set->count; ++k) {
        set->spins[k].tag = (uint16_t)piece->tag;
    }
}
