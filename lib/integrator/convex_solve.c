/* SPDX-License-Identifier: BSD-3-Clause */
/* The velocities of a step of convex, by Newton:
 *
 *     [M + sum J^T G J   C^T] [change]   [-gradient]
 *     [C                  0 ] [lambda] = [c - C v  ]      G = -dp/dv of a contact, 3 x 3, >= 0
 *
 * with the minimum along `change` by a safeguarded Newton iteration on the derivative of the cost.
 * The caps of friction follow the normal impulses until they agree.    docs/theory/convex.md */
#include "integrator/convex.h"

#include "base/sort.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define ITERATIONS 200
#define FOLLOWING  60   /* iterations in which the caps of friction follow */
#define ACCURACY   1e-9 /* of impulses */
#define CAP_CHANGE 1e-4 /* of the largest cap: it needs no other iteration */
#define ENOUGH     1e-6 /* of impulses, if rounding leaves no better */
#define LINE_STEPS 60
#define LINE_SLOPE 1e-6 /* of the cost along the line, relative to that at its beginning */

void se3di_convex_destroy(se3di_convex *c, const se3d_allocator *allocator)
{
    if (!c) {
        return;
    }
    se3di_free(allocator, c->contacts, c->contact_capacity, sizeof *c->contacts);
    se3di_free(allocator, c->pairs, c->pair_capacity, 2 * sizeof *c->pairs);
    se3di_free(allocator, c->kkt_pairs, c->kkt_pair_capacity, 2 * sizeof *c->kkt_pairs);
    se3di_free(allocator, c->body, c->body_capacity, sizeof *c->body);
    se3di_free(allocator, c->coupling, c->coupling_capacity, sizeof *c->coupling);
    se3di_free(allocator, c->work, c->work_capacity, sizeof *c->work);
    se3di_free(allocator, c->touched, c->touched_capacity, sizeof *c->touched);
    se3di_kkt_destroy(c->kkt);
    se3di_free(allocator, c, 1, sizeof *c);
}

static se3d_status reserve_pairs(const se3d_allocator *allocator, int32_t **pairs, size_t *capacity,
                                 size_t count)
{
    void *data = *pairs;
    const se3d_status status =
        se3di_array_reserve(allocator, &data, capacity, count, 2 * sizeof **pairs);
    *pairs = data;
    return status;
}

static int compare_pairs(const int32_t *a, const int32_t *b)
{
    const int first = (a[0] > b[0]) - (a[0] < b[0]);
    return first ? first : (a[1] > b[1]) - (a[1] < b[1]);
}

static int is_coupled(const se3di_convex_contact *contact)
{
    return contact->free[0] >= 0 && contact->free[1] >= 0;
}

static int32_t find_pair(const se3di_convex *c, const int32_t pair[2])
{
    size_t low = 0, high = c->pair_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (compare_pairs(c->pairs + 2 * middle, pair) < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return (int32_t)low;
}

static void get_pair(const se3di_convex_contact *contact, int32_t pair[2])
{
    const int turned = contact->free[0] > contact->free[1];
    pair[0] = contact->free[turned];
    pair[1] = contact->free[!turned];
}

/* The couplings of bodies by contacts. */
static se3d_status list_pairs(se3di_convex *c, const se3d_allocator *allocator)
{
    size_t count = 0;
    SE3DI_TRY(reserve_pairs(allocator, &c->pairs, &c->pair_capacity, c->contact_count));
    for (size_t k = 0; k < c->contact_count; ++k) {
        if (is_coupled(&c->contacts[k])) {
            get_pair(&c->contacts[k], c->pairs + 2 * count);
            count += count == 0 || compare_pairs(c->pairs + 2 * count, c->pairs + 2 * count - 2);
        }
    }
    se3di_sort_tuples(c->pairs, count, 2);
    c->pair_count = 0;
    for (size_t k = 0; k < count; ++k) {
        if (c->pair_count == 0 ||
            compare_pairs(c->pairs + 2 * k, c->pairs + 2 * (c->pair_count - 1)) != 0) {
            memmove(c->pairs + 2 * c->pair_count++, c->pairs + 2 * k, 2 * sizeof *c->pairs);
        }
    }
    for (size_t k = 0; k < c->contact_count; ++k) {
        if (is_coupled(&c->contacts[k])) {
            int32_t pair[2];
            get_pair(&c->contacts[k], pair);
            c->contacts[k].coupling = find_pair(c, pair);
        }
    }
    return SE3D_OK;
}

static int is_same_pattern(const se3di_convex *c, const se3di_assembly *assembly)
{
    return c->kkt && c->topology_version == assembly->topology_version &&
           c->kkt_pair_count == c->pair_count &&
           (c->pair_count == 0 ||
            memcmp(c->kkt_pairs, c->pairs, 2 * c->pair_count * sizeof *c->pairs) == 0);
}

/* The solver for what touches now. */
static se3d_status suit_solver(se3di_convex *c, const se3di_assembly *assembly)
{
    const se3d_allocator *allocator = &assembly->model->allocator;
    const se3di_kkt_pattern pattern = {.body_count = assembly->body_count,
                                       .joint_count = assembly->constraint_count,
                                       .coupling_count = c->pair_count,
                                       .joint_rows = assembly->joint_rows,
                                       .joint_begin = assembly->joint_begin,
                                       .joint_body = assembly->joint_body,
                                       .coupling = c->pairs,
                                       .body_size = 6,
                                       .symmetric = true,
                                       .body_kind = SE3DI_KKT_BODY_FULL};
    if (is_same_pattern(c, assembly)) {
        return SE3D_OK;
    }
    se3di_kkt_destroy(c->kkt);
    c->kkt = NULL;
    SE3DI_TRY(reserve_pairs(allocator, &c->kkt_pairs, &c->kkt_pair_capacity, c->pair_count));
    SE3DI_TRY(se3di_kkt_create(allocator, &pattern, SE3DI_KKT_STRUCTURED, &c->kkt));
    se3di_kkt_settings settings = se3di_kkt_get_settings(c->kkt);
    settings.iterated = true;
    se3di_kkt_set_settings(c->kkt, &settings);
    c->kkt_pair_count = c->pair_count;
    c->topology_version = assembly->topology_version;
    if (c->pair_count > 0) {
        memcpy(c->kkt_pairs, c->pairs, 2 * c->pair_count * sizeof *c->pairs);
    }
    return SE3D_OK;
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
    se3d_status status = list_pairs(c, allocator);
    status = status < 0 ? status : suit_solver(c, assembly);
    status = status < 0
                 ? status
                 : reserve_blocks(allocator, &c->body, &c->body_capacity, assembly->body_count);
    status = status < 0
                 ? status
                 : reserve_blocks(allocator, &c->coupling, &c->coupling_capacity, c->pair_count);
    return status < 0 ? se3di_error_set(equations->error, status,
                                        "t = %g s: no memory for the contacts of a step",
                                        assembly->model->time)
                      : status;
}

/* block [6 x 6] += sign (I L_a)^T G (I L_b) */
static void add_block(double *block, double sign, const double *La, const double G[9],
                      const double *Lb)
{
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
            block[6 * r + k] += sign * G[3 * r + k];
            block[6 * r + 3 + k] += sign * GL[3 * r + k];
            block[6 * (3 + r) + k] += sign * LG[3 * r + k];
            block[6 * (3 + r) + 3 + k] += sign * turned;
        }
    }
}

static void add_contact(se3di_convex *c, const se3di_convex_contact *contact, const double G[9])
{
    for (int k = 0; k < 2; ++k) {
        if (contact->free[k] >= 0) {
            add_block(c->body + 36 * (size_t)contact->free[k], 1.0, contact->lever[k], G,
                      contact->lever[k]);
        }
    }
    if (contact->coupling >= 0) {
        const int first = contact->free[0] > contact->free[1];
        add_block(c->coupling + 36 * (size_t)contact->coupling, -1.0, contact->lever[first], G,
                  contact->lever[!first]);
    }
}

/* gradient -= J^T p */
static void subtract_impulse(const se3di_convex_contact *contact, double *gradient)
{
    for (int k = 0; k < 2; ++k) {
        if (contact->free[k] >= 0) {
            double *g = gradient + 6 * (size_t)contact->free[k], turning[3];
            const double sign = k ? -1.0 : 1.0;
            se3di_mul_transposed(contact->lever[k], contact->impulse, turning);
            se3di_add_scaled(sign, contact->impulse, g);
            se3di_add_scaled(sign, turning, g + 3);
        }
    }
}

/* Impulses, gradient and, if `is_wanted`, the blocks of the matrix at v. */
static void evaluate(se3di_convex *c, const se3di_assembly *assembly, int is_wanted)
{
    memcpy(c->gradient, c->moved, assembly->unknown_count * sizeof *c->gradient);
    if (is_wanted && assembly->body_count > 0) {
        memcpy(c->body, assembly->H, 36 * (size_t)assembly->body_count * sizeof *c->body);
        if (c->pair_count > 0) {
            memset(c->coupling, 0, 36 * c->pair_count * sizeof *c->coupling);
        }
    }
    for (size_t k = 0; k < c->contact_count; ++k) {
        se3di_convex_contact *contact = &c->contacts[k];
        double G[9];
        se3di_convex_impulse(contact, c->h, contact->v, contact->impulse, is_wanted ? G : NULL);
        subtract_impulse(contact, c->gradient);
        if (is_wanted) {
            add_contact(c, contact, G);
        }
    }
}

/* The caps of friction to the normal impulses, if one of them is another. */
static void follow(se3di_convex *c)
{
    double largest = 0.0, change = 0.0;
    for (size_t k = 0; k < c->contact_count; ++k) {
        se3di_convex_contact *contact = &c->contacts[k];
        contact->wanted = contact->friction * se3di_convex_normal(contact, c->h, contact->v);
        largest = fmax(largest, contact->wanted);
        change = fmax(change, fabs(contact->wanted - contact->bound));
    }
    for (size_t k = 0; k < c->contact_count && change > CAP_CHANGE * largest; ++k) {
        c->contacts[k].bound = c->contacts[k].wanted;
    }
}

/* |x|^2 with the inverse of the diagonal of the mass as weight. */
static double weigh(const se3di_assembly *assembly, const double *x)
{
    double sum = 0.0;
    for (size_t body = 0; body < assembly->body_count; ++body) {
        const double *M = assembly->H + 36 * body;
        for (size_t k = 0; k < 6; ++k) {
            const double m = M[7 * k], value = x[6 * body + k];
            sum += m > 0.0 ? value * value / m : 0.0;
        }
    }
    return sum;
}

/* The part of the impulses that is not balanced, of those in the step and of all momentum. */
static double measure(const se3di_convex *c, se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    double *sum = equations->b;
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        sum[k] = c->moved[k] - c->gradient[k];
    }
    const double size = fmax(c->momentum, weigh(assembly, sum));
    memcpy(sum, c->gradient, assembly->unknown_count * sizeof *sum);
    se3di_assembly_add_transposed(assembly, 1.0, c->lambda, sum);
    const double rest = weigh(assembly, sum);
    return rest > 0.0 ? sqrt(rest / fmax(size, rest)) : 0.0;
}

/* out [6] += B v, or B^T v */
static void add_block_product(const double *B, int transposed, const double *v, double *out)
{
    for (size_t r = 0; r < 6; ++r) {
        for (size_t k = 0; k < 6; ++k) {
            out[r] += (transposed ? B[6 * k + r] : B[6 * r + k]) * v[k];
        }
    }
}

/* out += the matrix times v. */
static void add_product(const se3di_convex *c, const se3di_assembly *assembly, double *out)
{
    for (size_t body = 0; body < assembly->body_count; ++body) {
        add_block_product(c->body + 36 * body, 0, c->v + 6 * body, out + 6 * body);
    }
    for (size_t k = 0; k < c->pair_count; ++k) {
        const size_t i = 6 * (size_t)c->pairs[2 * k], j = 6 * (size_t)c->pairs[2 * k + 1];
        add_block_product(c->coupling + 36 * k, 0, c->v + j, out + i);
        add_block_product(c->coupling + 36 * k, 1, c->v + i, out + j);
    }
}

/* `change`, and lambda. With constraints the velocities themselves are solved for: what is left of
 * them near the end of the iteration is rounding, by which the solver would measure its residual.
 */
static se3d_status solve_linear(se3di_convex *c, se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    const se3di_kkt_values values = {
        .body = c->body, .coupling_upper = c->coupling, .joint = assembly->C};
    ++equations->counters.factorizations;
    ++equations->counters.solves;
    se3d_status status = se3di_kkt_factor(c->kkt, &values, NULL);
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        equations->b[k] = -c->gradient[k];
    }
    if (assembly->row_count > 0) {
        add_product(c, assembly, equations->b);
    }
    status = status < 0 ? status
                        : se3di_kkt_solve(c->kkt, &values, equations->b, c->aimed, c->change,
                                          c->lambda, NULL);
    if (status == SE3D_ERR_NO_CONVERGENCE) { /* where all is at rest; the iteration will tell */
        status = SE3D_OK;
    }
    for (size_t k = 0; assembly->row_count > 0 && k < assembly->unknown_count; ++k) {
        c->change[k] -= c->v[k];
    }
    return status < 0 ? se3di_error_set(equations->error, status,
                                        "t = %g s: the equations of a step of %g s with %zu "
                                        "contacts have no finite solution",
                                        assembly->model->time, c->h, c->contact_count)
                      : status;
}

static double dot(const double *a, const double *b, size_t count)
{
    double sum = 0.0;
    for (size_t k = 0; k < count; ++k) {
        sum += a[k] * b[k];
    }
    return sum;
}

/* The derivative of the cost at v + s change, and its derivative. */
static double slope_at(const se3di_convex *c, const double line[2], double s, double *curvature)
{
    double slope = line[0] + s * line[1];
    *curvature = line[1];
    for (size_t k = 0; k < c->contact_count; ++k) {
        const se3di_convex_contact *contact = &c->contacts[k];
        double v[3], bend;
        se3di_copy(contact->v, v);
        se3di_add_scaled(s, contact->change, v);
        slope -= se3di_convex_along(contact, c->h, v, &bend);
        *curvature += bend;
    }
    return slope;
}

/* The part of `change` after which the cost is least. */
static double search(const se3di_convex *c, size_t unknowns)
{
    const double line[2] = {dot(c->moved, c->change, unknowns),
                            dot(c->carried, c->change, unknowns)};
    double curvature, low = 0.0, high = HUGE_VAL, s = 1.0;
    const double first = slope_at(c, line, 0.0, &curvature);
    if (!(first < 0.0)) {
        return 1.0;
    }
    for (int k = 0; k < LINE_STEPS; ++k) {
        const double slope = slope_at(c, line, s, &curvature);
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
static void move(se3di_convex *c, const se3di_assembly *assembly, double s)
{
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        c->v[k] += s * c->change[k];
        c->moved[k] += s * c->carried[k];
    }
    for (size_t k = 0; k < c->contact_count; ++k) {
        se3di_convex_velocity(&c->contacts[k], c->v, c->contacts[k].v);
    }
}

static void begin(se3di_convex *c, const se3di_assembly *assembly)
{
    memcpy(c->v, c->start, assembly->unknown_count * sizeof *c->v);
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        c->change[k] = c->v[k] - c->aim[k];
    }
    se3di_assembly_mul_mass(assembly, c->aim, c->moved);
    c->momentum = weigh(assembly, c->moved);
    se3di_assembly_mul_mass(assembly, c->start, c->moved);
    c->momentum = fmax(c->momentum, weigh(assembly, c->moved));
    se3di_assembly_mul_mass(assembly, c->change, c->moved);
    memset(c->change, 0, assembly->unknown_count * sizeof *c->change);
    memset(c->carried, 0, assembly->unknown_count * sizeof *c->carried);
    for (size_t k = 0; k < assembly->row_count; ++k) {
        c->lambda[k] = 0.0;
    }
    move(c, assembly, 0.0);
}

static se3d_status fail(const se3di_convex *c, se3di_equations *equations, double rest)
{
    return se3di_error_set(equations->error, SE3D_ERR_NO_CONVERGENCE,
                           "t = %g s: the velocities of a step of %g s with %zu contacts did not "
                           "converge: %.2g of the impulses are not balanced; try a smaller step",
                           equations->assembly.model->time, c->h, c->contact_count, rest);
}

se3d_status se3di_convex_solve(se3di_convex *c, se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    double rest = HUGE_VAL;
    SE3DI_TRY(prepare(c, equations));
    begin(c, assembly);
    for (int k = 0; k < ITERATIONS; ++k) {
        SE3DI_TRY(se3di_equations_ask(equations));
        if (k < FOLLOWING) {
            follow(c);
        }
        evaluate(c, assembly, 1);
        const double before = rest;
        rest = measure(c, equations);
        const int stays = k >= FOLLOWING && rest <= ENOUGH && rest >= 0.5 * before;
        if ((k > 0 || assembly->row_count == 0) && (rest <= ACCURACY || stays)) {
            return SE3D_OK;
        }
        SE3DI_TRY(solve_linear(c, equations));
        ++equations->counters.iterations;
        se3di_assembly_mul_mass(assembly, c->change, c->carried);
        for (size_t n = 0; n < c->contact_count; ++n) {
            se3di_convex_velocity(&c->contacts[n], c->change, c->contacts[n].change);
        }
        move(c, assembly,
             k == 0 && assembly->row_count > 0 ? 1.0 : search(c, assembly->unknown_count));
    }
    evaluate(c, assembly, 0);
    return rest <= ENOUGH ? SE3D_OK : fail(c, equations, rest);
}
