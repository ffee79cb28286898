/* SPDX-License-Identifier: BSD-3-Clause */
/* The velocities of a step of convex, island by island, by Newton:
 *
 *     [M + sum J^T G J   C^T] [change]   [-gradient]
 *     [C                  0 ] [lambda] = [c - C v  ]      G = -dp/dv of a contact, 3 x 3, >= 0
 *
 * with the minimum along `change` by a safeguarded Newton iteration on the derivative of the cost.
 * The caps of friction follow the normal impulses until they agree.    docs/theory/convex.md */
#include "integrator/convex.h"

#include "math/larger.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define ITERATIONS  200
#define FOLLOWING   60   /* iterations in which the caps of friction follow, */
#define ALL_FOLLOW  120  /* none of them after so many */
#define MAY_FOLLOW  0.1  /* of impulses: what is left where they do; */
#define PATIENCE    10   /* or after so many iterations in which they did not */
#define ACCURACY    1e-9 /* of impulses */
#define CAP_CHANGE  3e-4 /* of the largest cap: it needs no other iteration */
#define IS_NEAR     1e-5 /* of impulses: this iteration may be the last */
#define GO_AHEAD    1e-3 /* of impulses: what is left where caps go on as they went, */
#define AHEAD_MOST  4.0  /* at most so many times */
#define ENOUGH      1e-6 /* of impulses, if rounding leaves no better */
#define TAMED_MOST  8    /* times */
#define SHARE       1e-2 /* of the gradient: what the linear equations may leave */
#define SAME        1e-2 /* of a slope: changes that the matrix need not know */
#define SOLVES_MOST 500
#define KEPT        16    /* if one in so many slopes has changed the preconditioner is made anew */
#define GUESSES     6     /* at which contacts act and how, before */
#define GUESSED     1e-3  /* of the largest impulse: they will hardly change */
#define ASTRAY      10.0  /* of all momentum: what guesses may change and are not doubted */
#define ROUNDING    1e-12 /* of velocities: a change that leads nowhere */
#define LINE_STEPS  60
#define LINE_SLOPE  1e-3 /* of the cost along the line, relative to that at its beginning */

void se3di_convex_destroy(se3di_convex *c, const se3d_allocator *allocator)
{
    if (!c) {
        return;
    }
    se3di_free(allocator, c->contacts, c->contact_capacity, sizeof *c->contacts);
    se3di_free(allocator, c->pairs, c->pair_capacity, 2 * sizeof *c->pairs);
    se3di_free(allocator, c->islands, c->island_capacity, sizeof *c->islands);
    se3di_free(allocator, c->place, c->place_capacity, sizeof *c->place);
    se3di_free(allocator, c->body_at, c->body_at_capacity, sizeof *c->body_at);
    se3di_free(allocator, c->root, c->root_capacity, sizeof *c->root);
    se3di_free(allocator, c->number, c->number_capacity, sizeof *c->number);
    se3di_free(allocator, c->order, c->order_capacity, sizeof *c->order);
    se3di_free(allocator, c->stirred, c->stirred_capacity, sizeof *c->stirred);
    se3di_free(allocator, c->mobility, c->mobility_capacity, sizeof *c->mobility);
    se3di_free(allocator, c->own, c->own_capacity, sizeof *c->own);
    se3di_free(allocator, c->geared, c->geared_capacity, sizeof *c->geared);
    se3di_free(allocator, c->tie, c->tie_capacity, sizeof *c->tie);
    se3di_free(allocator, c->spin, c->spin_capacity, sizeof *c->spin);
    se3di_free(allocator, c->body, c->body_capacity, sizeof *c->body);
    se3di_free(allocator, c->coupling, c->coupling_capacity, sizeof *c->coupling);
    se3di_free(allocator, c->work, c->work_capacity, sizeof *c->work);
    se3di_free(allocator, c->touched, c->touched_capacity, sizeof *c->touched);
    se3di_free(allocator, c->asleep, c->sleep_capacity, 1);
    se3di_free(allocator, c->marks, c->mark_capacity, 6 * sizeof *c->marks);
    se3di_free(allocator, c->followed, c->followed_capacity, sizeof *c->followed);
    se3di_free(allocator, c->lawful, c->lawful_capacity, sizeof *c->lawful);
    se3di_free(allocator, c->nest, c->nest_capacity, sizeof *c->nest);
    se3di_free(allocator, c->reach, c->reach_capacity, sizeof *c->reach);
    se3di_free(allocator, c->ended, c->ended_capacity, sizeof *c->ended);
    se3di_convex_rows_destroy(&c->rows, allocator);
    se3di_block_cg_destroy(&c->cg, allocator);
    se3di_free(allocator, c, 1, sizeof *c);
}

static se3d_status reserve_blocks(const se3d_allocator *allocator, double **blocks,
                                  size_t *capacity, size_t count)
{
    void *data = *blocks;
    const se3d_status status =
        se3di_array_reserve(allocator, &data, capacity, 36 * count, sizeof **blocks);
    *blocks = data;
    return status;
}

static se3d_status prepare(se3di_convex *c, se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    const se3d_allocator *allocator = &assembly->model->allocator;
    se3d_status status = se3di_convex_group(c, assembly);
    for (size_t k = 0; k < c->island_count && status >= 0; ++k) {
        status = se3di_convex_is_bound(&c->islands[k])
                     ? se3di_convex_suit_solver(c, assembly, &c->islands[k])
                     : SE3D_OK;
    }
    status = status < 0
                 ? status
                 : se3di_block_cg_reserve(&c->cg, allocator, assembly->body_count, c->pair_count);
    status = status < 0
                 ? status
                 : reserve_blocks(allocator, &c->body, &c->body_capacity, assembly->body_count);
    status = status < 0
                 ? status
                 : reserve_blocks(allocator, &c->coupling, &c->coupling_capacity, c->pair_count);
    status = status < 0 ? status : se3di_convex_place_mass(c, assembly);
    return status < 0 ? se3di_error_set(equations->error, status,
                                        "t = %g s: no memory for the contacts of a step",
                                        assembly->model->time)
                      : SE3D_OK;
}

/* block [6 x 6] += sign (r I L_a)^T G (r I L_b), r: reach, of which r^2 = r */
static void add_block(double *block, double sign, const se3di_convex_contact *contact,
                      const int of[2], const double G[9])
{
    const double *La = contact->lever[of[0]], *Lb = contact->lever[of[1]];
    const double across = sign * contact->reach;
    double GL[9], LG[9];
    se3di_mat_mul(G, Lb, GL);
    for (int r = 0; r < 3; ++r) {
        for (int k = 0; k < 3; ++k) {
            LG[3 * r + k] = La[r] * G[k] + La[3 + r] * G[3 + k] + La[6 + r] * G[6 + k];
        }
    }
    for (int r = 0; r < 3; ++r) {
        for (int k = 0; k < 3; ++k) {
            const double turned = La[r] * GL[k] + La[3 + r] * GL[3 + k] + La[6 + r] * GL[6 + k];
            block[6 * r + k] += across * G[3 * r + k];
            block[6 * r + 3 + k] += across * GL[3 * r + k];
            block[6 * (3 + r) + k] += across * LG[3 * r + k];
            block[6 * (3 + r) + 3 + k] += sign * turned;
        }
    }
}

static void add_contact(se3di_convex *c, const se3di_convex_contact *contact, const double G[9])
{
    for (int k = 0; k < 2; ++k) {
        if (contact->free[k] >= 0) {
            const int same[2] = {k, k};
            add_block(c->body + 36 * (size_t)contact->free[k], 1.0, contact, same, G);
        }
    }
    if (contact->coupling >= 0) {
        const int first = contact->free[0] > contact->free[1], two[2] = {first, !first};
        add_block(c->coupling + 36 * (size_t)contact->coupling, -1.0, contact, two, G);
    }
}

/* gradient -= J^T p */
static void subtract_impulse(const se3di_convex_contact *contact, double *gradient)
{
    se3di_convex_press(contact, -1.0, contact->impulse, gradient);
}

/* Blocks of the matrix without contacts. */
static void clear_blocks(se3di_convex *c, const se3di_convex_island *island)
{
    const size_t bodies = island->body_end - island->body;
    if (bodies > 0) {
        memcpy(c->body + 36 * island->body, c->mass + 36 * island->body,
               36 * bodies * sizeof *c->body);
    }
    se3di_convex_clear_couplings(c, island);
}

/* The gradient without contacts. */
static void clear_gradient(se3di_convex *c, const se3di_convex_island *island)
{
    memcpy(c->gradient + 6 * island->body, c->moved + 6 * island->body,
           6 * (island->body_end - island->body) * sizeof *c->gradient);
}

/* Whether `change` of a slope is small, along the normal beside what is along it and across it
 * beside what is across: one may be a thousand times the other. */
static int is_small(const se3di_convex_contact *contact, const double change[9])
{
    const double *n = contact->normal, *slope = contact->slope;
    double turned[3], along, less, across = 0.0, off = 0.0;
    se3di_mul(slope, n, turned);
    along = se3di_dot(turned, n);
    se3di_mul(change, n, turned);
    less = se3di_dot(turned, n);
    for (int r = 0; r < 3; ++r) {
        for (int k = 0; k < 3; ++k) {
            const double part = n[r] * n[k];
            off = se3di_larger(off, fabs(change[3 * r + k] - less * part));
            across = se3di_larger(across, fabs(slope[3 * r + k] - along * part));
        }
    }
    return fabs(less) <= SAME * along && off <= SAME * across;
}

/* A slope of a contact into the matrix, if it is clearly another than the one that is there. */
static void set_slope(se3di_convex *c, se3di_convex_contact *contact, const double slope[9])
{
    double change[9];
    int differs = 0; /* those of what sticks, and of what has parted, do not */
    for (int k = 0; k < 9; ++k) {
        change[k] = slope[k] - contact->slope[k];
        differs |= change[k] != 0.0;
    }
    if (!differs || is_small(contact, change)) {
        return;
    }
    memcpy(contact->slope, slope, sizeof contact->slope);
    add_contact(c, contact, change);
    ++c->changed;
}

/* Impulses and gradient at v; with the matrix, if another iteration is sure to follow. */
static void evaluate(se3di_convex *c, const se3di_convex_island *island, int with_slopes)
{
    clear_gradient(c, island);
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        se3di_convex_contact *contact = se3di_convex_at(c, k);
        double slope[9];
        se3di_convex_impulse(contact, c->h, contact->v, contact->impulse,
                             with_slopes ? slope : NULL);
        subtract_impulse(contact, c->gradient);
        if (with_slopes) {
            set_slope(c, contact, slope);
        }
    }
}

/* The matrix at v. */
static void evaluate_slopes(se3di_convex *c, const se3di_convex_island *island)
{
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        se3di_convex_contact *contact = se3di_convex_at(c, k);
        double slope[9], impulse[3];
        se3di_convex_impulse(contact, c->h, contact->v, impulse, slope);
        set_slope(c, contact, slope);
    }
}

/* What normal impulses make of the caps of friction, and how that differs from those in use.
 * Returns the share of the change since the last look that leads to where they would agree, if all
 * went on as from that look to this one (Anderson 1965); `is_near` is 1 if they agree. */
static double look_at_caps(se3di_convex *c, const se3di_convex_island *island, int *is_near)
{
    double largest = 0.0, gap = 0.0, change = 0.0, product = 0.0, slope;
    *is_near = 1;
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        se3di_convex_contact *contact = se3di_convex_at(c, k);
        if (contact->way == SE3DI_CONVEX_FRICTION) {
            *is_near &= se3di_convex_look(c, contact, island->momentum);
            continue;
        }
        const int rolls = contact->way == SE3DI_CONVEX_ROLL;
        const se3di_convex_contact *by = rolls ? &c->contacts[contact->partner] : contact;
        const double vn = se3di_dot(by->v, by->normal), before = contact->gap;
        contact->wanted_before = contact->wanted;
        contact->wanted = contact->friction * se3di_convex_normal(by, c->h, vn, &slope);
        contact->gap = contact->wanted - contact->bound;
        largest = fmax(largest, contact->wanted);
        gap = se3di_larger(gap, fabs(contact->gap));
        product += contact->gap * (contact->gap - before);
        change += (contact->gap - before) * (contact->gap - before);
    }
    *is_near &= !(gap > CAP_CHANGE * largest);
    return change > 0.0 ? fmax(-AHEAD_MOST, fmin(0.0, product / change)) : 0.0;
}

/* The caps of friction follow the normal impulses, if one of them is another. */
static void follow(se3di_convex *c, const se3di_convex_island *island, int goes_ahead)
{
    int is_near;
    const double ahead = look_at_caps(c, island, &is_near);
    for (size_t k = island->contact; k < island->contact_end && !is_near; ++k) {
        se3di_convex_contact *contact = se3di_convex_at(c, k);
        const int goes_on = goes_ahead && contact->way != SE3DI_CONVEX_FRICTION;
        const double change = goes_on ? contact->wanted - contact->wanted_before : 0.0;
        contact->bound = fmax(0.0, contact->wanted - ahead * change);
    }
}

/* |x|^2 with the inverse of the diagonal of the mass as weight; x of the island. */
static double weigh(const se3di_convex *c, const se3di_convex_island *island, const double *x)
{
    double sum = 0.0;
    for (size_t body = island->body; body < island->body_end; ++body) {
        const double *M = c->mass + 36 * body;
        for (size_t k = 0; k < 6; ++k) {
            const double m = M[7 * k], value = x[6 * body + k];
            sum += m > 0.0 ? value * value / m : 0.0;
        }
    }
    return sum;
}

/* The part of the impulses that is not balanced, of those in the step and of all momentum. */
static double measure(const se3di_convex *c, se3di_equations *equations,
                      const se3di_convex_island *island)
{
    const size_t begin = 6 * island->body, end = 6 * island->body_end;
    double *sum = equations->b;
    for (size_t k = begin; k < end; ++k) {
        sum[k] = c->moved[k] - c->gradient[k];
    }
    const double size = fmax(island->momentum, weigh(c, island, sum));
    memcpy(sum + begin, c->gradient + begin, (end - begin) * sizeof *sum);
    se3di_convex_add_reactions(c, island, sum);
    const double rest = weigh(c, island, sum);
    return rest <= 0.0 ? 0.0 : sqrt(rest / fmax(size, rest)); /* NaN stays */
}

static se3di_block_matrix matrix_of(const se3di_convex *c, const se3di_convex_island *island)
{
    return se3di_convex_matrix_of(c, island, c->body, c->coupling);
}

/* `change` to the accuracy that an iteration needs. */
static void solve_free(se3di_convex *c, se3di_equations *equations,
                       const se3di_convex_island *island, double share)
{
    const se3di_block_matrix A = matrix_of(c, island);
    if (KEPT * c->changed > island->contact_end - island->contact) {
        ++equations->counters.factorizations;
        se3di_block_cg_factor(&c->cg, &A);
        c->changed = 0;
    } else if (c->changed > 0) {
        se3di_block_cg_renew(&c->cg, &A);
    }
    const size_t begin = 6 * island->body;
    for (size_t k = begin; k < 6 * island->body_end; ++k) {
        equations->b[k] = -c->gradient[k];
    }
    ++equations->counters.solves;
    (void)se3di_block_cg_solve(&c->cg, &A, equations->b + begin, share, SOLVES_MOST,
                               c->change + begin);
}

/* `change`, and lambda. With constraints the velocities themselves are solved for: what is left of
 * them near the end of the iteration is rounding, by which the solver would measure its residual.
 */
static se3d_status solve_bound(se3di_convex *c, se3di_equations *equations,
                               const se3di_convex_island *island)
{
    const se3di_block_matrix A = matrix_of(c, island);
    const se3di_kkt_values values = se3di_convex_values_of(c, island, c->body);
    const size_t first = 6 * island->body;
    se3d_status status = SE3D_OK;
    if (c->changed > 0) {
        ++equations->counters.factorizations;
        c->changed = 0;
        status = se3di_kkt_factor(island->kkt, &values, NULL);
    }
    ++equations->counters.solves;
    for (size_t k = first; k < 6 * island->body_end; ++k) {
        equations->b[k] = -c->gradient[k];
    }
    se3di_block_cg_add_product(&A, c->v + first, equations->b + first);
    status = status < 0 ? status
                        : se3di_kkt_solve(island->kkt, &values, equations->b + first,
                                          c->rows.aimed + island->row, c->change + first,
                                          c->rows.lambda + island->row, NULL);
    ++c->reacts;
    if (c->stop_end < c->contact_count) {
        se3di_convex_take_back_rows(c, &equations->assembly, island, c->lambda);
    }
    if (status == SE3D_ERR_NO_CONVERGENCE) { /* where all is at rest; the iteration will tell */
        status = SE3D_OK;
    }
    for (size_t k = first; k < 6 * island->body_end; ++k) {
        c->change[k] -= c->v[k];
    }
    return status < 0 ? se3di_error_set(equations->error, status,
                                        "t = %g s: the equations of a step of %g s with %zu "
                                        "contacts have no finite solution",
                                        equations->assembly.model->time, c->h, c->contact_count)
                      : status;
}

static double dot(const double *a, const double *b, size_t begin, size_t end)
{
    double sum = 0.0;
    for (size_t k = begin; k < end; ++k) {
        sum += a[k] * b[k];
    }
    return sum;
}

/* The derivative of the cost at v + s change, and its derivative. */
static double slope_at(const se3di_convex *c, const se3di_convex_island *island,
                       const double line[2], double s, double *curvature)
{
    double slope = line[0] + s * line[1];
    *curvature = line[1];
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        const se3di_convex_contact *contact = se3di_convex_at(c, k);
        double v[3], bend;
        se3di_copy(contact->v, v);
        se3di_add_scaled(s, contact->change, v);
        slope -= se3di_convex_along(contact, c->h, v, &bend);
        *curvature += bend;
    }
    return slope;
}

/* The part of `change` after which the cost is least. */
static double search(const se3di_convex *c, const se3di_convex_island *island)
{
    const size_t begin = 6 * island->body, end = 6 * island->body_end;
    const double line[2] = {dot(c->moved, c->change, begin, end),
                            dot(c->carried, c->change, begin, end)};
    double curvature, low = 0.0, high = HUGE_VAL, s = 1.0;
    const double first = dot(c->gradient, c->change, begin, end);
    if (!(first < 0.0) || line[1] <= ROUNDING * ROUNDING * island->momentum) {
        return 1.0;
    }
    for (int k = 0; k < LINE_STEPS; ++k) {
        const double slope = slope_at(c, island, line, s, &curvature);
        if (fabs(slope) <= -LINE_SLOPE * first) {
            break;
        }
        if (slope > 0.0) {
            high = s;
        } else {
            low = s;
        }
        double next = curvature > 0.0 ? s - slope / curvature : HUGE_VAL;
        if (!(next > low && next < high)) {
            next = high < HUGE_VAL ? 0.5 * (low + high) : 2.0 * s;
        }
        s = next;
    }
    return s;
}

/* v + s change, with all that follows from it. */
static void move(se3di_convex *c, const se3di_convex_island *island, double s)
{
    for (size_t k = 6 * island->body; k < 6 * island->body_end; ++k) {
        c->v[k] += s * c->change[k];
        c->moved[k] += s * c->carried[k];
    }
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        se3di_convex_contact *contact = se3di_convex_at(c, k);
        se3di_add_scaled(s, contact->change, contact->v);
    }
}

/* The velocities of points for v. */
static void see(const se3di_convex *c, const se3di_convex_island *island)
{
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        se3di_convex_contact *contact = se3di_convex_at(c, k);
        se3di_convex_slip(contact, c->v, contact->v);
    }
}

/* `values` of bodies by their places. */
static void place(const se3di_convex *c, const se3di_assembly *assembly, const double *values,
                  double *out)
{
    for (size_t k = 0; k < assembly->body_count; ++k) {
        memcpy(out + 6 * (size_t)c->place[k], values + 6 * k, 6 * sizeof *out);
    }
}

/* v by places, M (v - v*), the momentum. Returns 1 if contacts may be far from the optimum. */
static int begin(se3di_convex *c, se3di_convex_island *island)
{
    const size_t first = 6 * island->body, count = 6 * (island->body_end - island->body);
    double *aim = c->carried, *start = c->gradient;
    int is_far = 0;
    se3di_convex_mul_mass(c, island, aim, c->moved);
    island->momentum = weigh(c, island, c->moved);
    se3di_convex_mul_mass(c, island, start, c->moved);
    island->momentum = fmax(island->momentum, weigh(c, island, c->moved));
    if (se3di_convex_is_bound(island)) {
        memcpy(c->v + first, start + first, count * sizeof *c->v);
        memset(c->rows.lambda + island->row, 0,
               (island->row_end - island->row) * sizeof *c->rows.lambda);
    } else {
        memcpy(c->v + first, aim + first, count * sizeof *c->v);
        is_far = !island->is_traced && !se3di_convex_sweep(c, island);
    }
    for (size_t k = first; k < first + count; ++k) {
        c->change[k] = c->v[k] - aim[k];
    }
    se3di_convex_mul_own(c, island, c->change, c->moved); /* armatures begin with `start` */
    clear_blocks(c, island);
    c->reacts = 0;
    c->is_beside = 0;
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        c->is_beside |= se3di_convex_at(c, k)->record != NULL;
    }
    c->changed = island->contact_end - island->contact + 1; /* all */
    see(c, island);
    return is_far;
}

/* What `change` does to contacts and momenta. */
static void carry(se3di_convex *c, const se3di_convex_island *island)
{
    se3di_convex_mul_mass(c, island, c->change, c->carried);
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        se3di_convex_contact *contact = se3di_convex_at(c, k);
        se3di_convex_velocity(contact, c->change, contact->change);
    }
}

/* Impulses as linear functions of v, each about the velocity that its contact would have alone.
 * Returns how far they are from it, as a part of the largest. */
static double foresee(se3di_convex *c, const se3di_convex_island *island)
{
    double far = 0.0, largest = 0.0;
    clear_gradient(c, island);
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        se3di_convex_contact *contact = se3di_convex_at(c, k);
        double ahead[3], less[3], slope[9];
        far = se3di_larger(far, se3di_convex_foresee(c, contact, ahead));
        se3di_convex_impulse(contact, c->h, ahead, contact->impulse, slope);
        set_slope(c, contact, slope);
        largest = fmax(largest, se3di_norm(contact->impulse));
        se3di_sub(contact->v, ahead, ahead);
        se3di_mul(contact->slope, ahead, less);
        se3di_sub(contact->impulse, less, contact->impulse);
        subtract_impulse(contact, c->gradient);
    }
    return largest > 0.0 ? far / largest : 0.0;
}

/* Again one contact after the other, from the impulses of all at once. */
static void relax(se3di_convex *c, const se3di_convex_island *island)
{
    const size_t begin = 6 * island->body, end = 6 * island->body_end;
    clear_gradient(c, island);
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        subtract_impulse(se3di_convex_at(c, k), c->gradient);
    }
    se3di_convex_relax(c, island);
    memset(c->moved + begin, 0, (end - begin) * sizeof *c->moved);
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        se3di_convex_contact *contact = se3di_convex_at(c, k);
        subtract_impulse(contact, c->moved);
        se3di_convex_slip(contact, c->v, contact->v);
    }
    for (size_t k = begin; k < end; ++k) {
        c->moved[k] = -c->moved[k];
    }
}

/* Nearer to the optimum of an island without constraints. What parts, sticks and slides is chosen
 * by impulses and velocities together, which does not depend on how stiff contacts are: Newton's
 * method on the velocities alone stops at the kink of any of them, in a large island at one after
 * the other. */
static void approach(se3di_convex *c, se3di_equations *equations, const se3di_convex_island *island)
{
    for (int guess = 0; guess < GUESSES; ++guess) {
        const double far = foresee(c, island);
        solve_free(c, equations, island, SHARE);
        ++equations->counters.iterations;
        carry(c, island);
        for (size_t k = island->contact; k < island->contact_end; ++k) {
            se3di_convex_contact *contact = se3di_convex_at(c, k);
            double less[3];
            se3di_mul(contact->slope, contact->change, less);
            se3di_sub(contact->impulse, less, contact->impulse);
        }
        move(c, island, 1.0);
        if (!(far > GUESSED)) {
            break;
        }
        relax(c, island);
    }
}

/* What is not balanced at v, with the caps that belong to it. */
static double unbalanced(se3di_convex *c, const se3di_convex_island *island)
{
    see(c, island);
    follow(c, island, 0);
    evaluate(c, island, 0);
    return weigh(c, island, c->gradient);
}

/* Guesses may go astray where bodies are light and contacts stiff. If they change velocities by
 * more than anything gives a reason for, and v* is nearer to the optimum, begin there. */
static void doubt(se3di_convex *c, se3di_equations *equations, const se3di_convex_island *island)
{
    const size_t first = 6 * island->body, count = 6 * (island->body_end - island->body);
    if (!(weigh(c, island, c->moved) > ASTRAY * ASTRAY * island->momentum)) {
        return;
    }
    const double guessed = unbalanced(c, island);
    memcpy(c->carried + first, c->moved + first, count * sizeof *c->moved);
    memcpy(equations->b + first, c->v + first, count * sizeof *c->v);
    memset(c->moved + first, 0, count * sizeof *c->moved);
    for (size_t k = island->body; k < island->body_end; ++k) {
        memcpy(c->v + 6 * k, c->aim + 6 * (size_t)c->body_at[k], 6 * sizeof *c->v);
    }
    if (unbalanced(c, island) > guessed) {
        memcpy(c->moved + first, c->carried + first, count * sizeof *c->moved);
        memcpy(c->v + first, equations->b + first, count * sizeof *c->v);
    }
    see(c, island);
}

static se3d_status fail(const se3di_convex *c, se3di_equations *equations, double rest)
{
    return se3di_error_set(equations->error, SE3D_ERR_NO_CONVERGENCE,
                           "t = %g s: the velocities of a step of %g s with %zu contacts did not "
                           "converge: %.2g of the impulses are not balanced; try a smaller step",
                           equations->assembly.model->time, c->h, c->contact_count, rest);
}

static se3d_status iterate(se3di_convex *c, se3di_equations *equations,
                           const se3di_convex_island *island, int is_first, double share)
{
    const int is_bound = se3di_convex_is_bound(island);
    if (is_bound) {
        SE3DI_TRY(solve_bound(c, equations, island));
    } else {
        solve_free(c, equations, island, share);
    }
    ++equations->counters.iterations;
    carry(c, island);
    move(c, island, is_first && is_bound ? 1.0 : search(c, island));
    return SE3D_OK;
}

/* What linear equations may leave: the less, the faster the iteration ends (Eisenstat and Walker
 * 1996), but no less than it needs. */
static double share_of(double rest, double before)
{
    if (!(rest > 0.0 && before > 0.0)) { /* a host may trap divisions by zero */
        return SHARE;
    }
    const double ratio = before < HUGE_VAL ? rest / before : 1.0;
    return fmin(SHARE, fmax(ratio * sqrt(ratio), 0.1 * ACCURACY / rest));
}

/* Whether caps and gyration follow, and how often they have, or wait; how often impacts were tamed.
 */
typedef struct following {
    int looks, waited, tamed;
    int goes_on, waits;
} following;

static void follow_in_time(se3di_convex *c, const se3di_convex_island *island, int iteration,
                           int may_wait, double rest, following *f)
{
    f->goes_on = f->looks < FOLLOWING && iteration < ALL_FOLLOW;
    f->waits = may_wait && !(rest <= MAY_FOLLOW) && f->waited < PATIENCE;
    f->waited = f->waits ? f->waited + 1 : 0;
    if (f->goes_on && !f->waits) {
        ++f->looks;
        follow(c, island, iteration > 0 && rest <= GO_AHEAD);
        se3di_convex_gyrate(c, island);
    }
}

/* Velocities are found; where caps of friction in joints do not follow any more they may jam. */
static se3d_status finish(se3di_convex *c, se3di_equations *equations,
                          const se3di_convex_island *island, int follows)
{
    return !follows && se3di_convex_jams(c, island)
               ? se3di_friction_refuse(equations, equations->assembly.model->time)
               : SE3D_OK;
}

static se3d_status solve_island(se3di_convex *c, se3di_equations *equations,
                                se3di_convex_island *island)
{
    following f = {.looks = 0};
    double rest = HUGE_VAL;
    if (begin(c, island)) {
        approach(c, equations, island);
        doubt(c, equations, island);
    }
    for (int k = 0; k < ITERATIONS; ++k) {
        SE3DI_TRY(se3di_equations_ask(equations));
        follow_in_time(c, island, k, k > 0, rest, &f);
        const int with_slopes = k > 0 && rest > IS_NEAR;
        evaluate(c, island, with_slopes);
        const double before = rest;
        rest = measure(c, equations, island);
        const int stays = !f.goes_on && rest <= ENOUGH && rest >= 0.5 * before;
        if ((k > 0 || !se3di_convex_is_bound(island)) && (rest <= ACCURACY || stays) &&
            !(f.waits && f.goes_on) && !(f.tamed++ < TAMED_MOST && se3di_convex_tame(c, island))) {
            return finish(c, equations, island, f.goes_on);
        }
        if (!with_slopes) {
            evaluate_slopes(c, island);
        }
        SE3DI_TRY(iterate(c, equations, island, k == 0, share_of(rest, before)));
    }
    evaluate(c, island, 0);
    return rest <= ENOUGH || se3di_convex_jams(c, island) ? finish(c, equations, island, 0)
                                                          : fail(c, equations, rest);
}

/* The velocities back in the order of the assembly; those that are not solved for as loads say. */
static void take_back(se3di_convex *c, const se3di_assembly *assembly)
{
    memcpy(c->change, c->v, assembly->unknown_count * sizeof *c->v);
    for (size_t k = 0; k < assembly->body_count; ++k) {
        const double *from =
            se3di_convex_takes_part(c, k) ? c->change + 6 * (size_t)c->place[k] : c->aim + 6 * k;
        memcpy(c->v + 6 * k, from, 6 * sizeof *from);
    }
    memset(c->lambda, 0, assembly->row_count * sizeof *c->lambda);
    for (size_t k = 0; k < c->island_count; ++k) {
        se3di_convex_take_back_rows(c, assembly, &c->islands[k], c->lambda);
    }
}

se3d_status se3di_convex_solve(se3di_convex *c, se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    SE3DI_TRY(prepare(c, equations));
    c->recoils =
        c->drifting < assembly->body_count && assembly->row_count > 0 && se3di_convex_has_loads(c);
    if (c->recoils) {
        memset(c->recoil, 0, assembly->row_count * sizeof *c->recoil);
    }
    place(c, assembly, c->start, c->gradient);
    place(c, assembly, c->aim, c->carried);
    se3di_convex_gyrate_begin(c, assembly);
    for (size_t k = 0; k < c->island_count; ++k) {
        se3di_convex_choose_ways(c, equations, &c->islands[k]);
        SE3DI_TRY(solve_island(c, equations, &c->islands[k]));
    }
    take_back(c, assembly);
    return SE3D_OK;
}
