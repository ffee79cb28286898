/* SPDX-License-Identifier: BSD-3-Clause */
/* Near the optimum: one contact after the other is given the impulse that its law asks for while
 * all others stay, forth and back (projected Gauss-Seidel). What sticks, slides or parts, and which
 * impacts there are, is so found before Newton's method looks at all of them together. It begins
 * with the impulses of the step before. */
#include "integrator/convex.h"

#include "math/larger.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define SWEEPS         4
#define SWEEPS_AT_REST 2    /* impulses are those of the step before */
#define SWEEPS_BETWEEN 16   /* guesses of all contacts at once */
#define LOOKS          3    /* for an impulse of a spring that is not linear */
#define CALM           1e-3 /* of the largest impulse: changes that need no other sweep */
#define PASSED_ON      0.2  /* of such a change: those on the same bodies are looked at again */
#define NEAR           1e-6 /* of an impulse: what is left of it */

/* Whether its normal impulse is a linear function of the velocity, while there is any. */
static int is_linear(const se3di_convex_contact *contact)
{
    return contact->way == SE3DI_CONVEX_IMPACT ||
           (contact->way != SE3DI_CONVEX_ROLL && !(contact->power > 1.0));
}

/* (I + D W)^-1, D the slope of a law that sticks, W what an impulse does to the velocity. */
static void invert_law(se3di_convex_contact *contact, const double W[9])
{
    const double *n = contact->normal;
    double A[9], nW[3];
    for (int k = 0; k < 3; ++k) {
        nW[k] = n[0] * W[k] + n[1] * W[3 + k] + n[2] * W[6 + k];
    }
    for (int r = 0; r < 3; ++r) {
        const double more = (contact->steepness - contact->drag) * n[r];
        for (int k = 0; k < 3; ++k) {
            A[3 * r + k] = (r == k) + contact->drag * W[3 * r + k] + more * nW[k];
        }
    }
    for (int k = 0; k < 3; ++k) {
        const double one[3] = {k == 0, k == 1, k == 2};
        double column[3];
        se3di_solve3(A, one, column);
        for (int r = 0; r < 3; ++r) {
            contact->answer[3 * r + k] = column[r];
        }
    }
}

static void respond_alone(const se3di_convex *c, se3di_convex_contact *contact, const double W[9])
{
    double turned[3];
    se3di_mul(W, contact->normal, turned);
    contact->response[0] = se3di_dot(turned, contact->normal);
    contact->response[1] = fmax(0.0, W[0] + W[4] + W[8] - contact->response[0]);
    if (is_linear(contact)) {
        contact->rise = contact->way == SE3DI_CONVEX_IMPACT
                            ? contact->damping * contact->rebound
                            : c->h * contact->stiffness * contact->overlap;
        contact->steepness = contact->way == SE3DI_CONVEX_IMPACT
                                 ? contact->damping
                                 : c->h * (contact->lead * contact->stiffness + contact->damping);
        invert_law(contact, W);
    }
}

/* What an impulse on the point does to its velocity. */
static void respond(const se3di_convex *c, se3di_convex_contact *contact)
{
    double W[9] = {0.0};
    for (int k = 0; k < 2; ++k) {
        if (contact->free[k] >= 0) {
            const double *mobility = c->mobility + 10 * (size_t)contact->free[k];
            double turn[9], turning[9];
            for (int r = 0; r < 3; ++r) { /* J^-1 is symmetric: its rows times those of the lever */
                for (int e = 0; e < 3; ++e) {
                    turn[3 * r + e] = se3di_dot(mobility + 1 + 3 * r, contact->lever[k] + 3 * e);
                }
            }
            se3di_mat_mul(contact->lever[k], turn, turning);
            for (int e = 0; e < 9; ++e) {
                W[e] += turning[e] + (e % 4 == 0 ? contact->reach * mobility[0] : 0.0);
            }
        }
    }
    respond_alone(c, contact, W);
}

/* v += M^-1 J^T p; what a body has once is read faster than what each of its contacts has */
static void apply(se3di_convex *c, const se3di_convex_contact *contact, const double p[3])
{
    for (int k = 0; k < 2; ++k) {
        if (contact->free[k] >= 0) {
            const double sign = k ? 1.0 : -1.0;
            const double *mobility = c->mobility + 10 * (size_t)contact->free[k];
            double *v = c->v + 6 * (size_t)contact->free[k], moment[3], turned[3];
            se3di_mul_transposed(contact->lever[k], p, moment);
            se3di_mul(mobility + 1, moment, turned);
            se3di_add_scaled(sign * contact->reach * mobility[0], p, v);
            se3di_add_scaled(sign, turned, v + 3);
        }
    }
}

/* p_n at the velocity that p_n leaves of vn, the one without it. */
static double find_normal(const se3di_convex_contact *contact, double h, double vn, double response)
{
    double p = 0.0;
    if (is_linear(contact)) {
        return fmax(0.0, (contact->rise - contact->steepness * vn) /
                             (1.0 + response * contact->steepness));
    }
    for (int k = 0; k < LOOKS; ++k) {
        double slope;
        const double gap = se3di_convex_normal(contact, h, vn + response * p, &slope) - p;
        const double change = gap / (1.0 + response * slope);
        p = fmax(0.0, p + change);
        if (!(fabs(change) > NEAR * p)) {
            break;
        }
    }
    return p;
}

/* The same of torsion, which may be along the normal or against it. */
static double find_torsion(const se3di_convex_contact *contact, double vn, double response)
{
    const double p =
        (contact->rise - contact->steepness * vn) / (1.0 + response * contact->steepness);
    const double cap = contact->share[1] * contact->bound;
    return fmax(-cap, fmin(p, cap));
}

/* The same as find_impulse() where its law is linear and it sticks. Returns 0 if it does not. */
static int find_held(const se3di_convex *c, const se3di_convex_contact *contact, const double v[3],
                     double p[3])
{
    const double *n = contact->normal;
    const double vn = se3di_dot(v, n);
    double missing[3];
    if (!is_linear(contact)) {
        return 0;
    }
    const double along =
        contact->rise - contact->attraction + (contact->drag - contact->steepness) * vn;
    for (int k = 0; k < 3; ++k) {
        missing[k] = along * n[k] - c->h * contact->tangential * contact->xi[k] -
                     contact->drag * v[k] - contact->impulse[k];
    }
    se3di_mul(contact->answer, missing, p);
    se3di_add(p, contact->impulse, p);
    const double normal = se3di_dot(p, n), pressed = normal + contact->attraction;
    const double cap = contact->friction * pressed;
    return pressed >= 0.0 && se3di_dot(p, p) - normal * normal <= cap * cap;
}

/* The impulse p that its law asks for where `impulse` left the velocity v, while all others stay,
 * as if p_n and p_t did nothing to each other's velocities. */
static void find_impulse(const se3di_convex *c, const se3di_convex_contact *contact,
                         const double v[3], double p[3])
{
    const double *n = contact->normal;
    const double *response = contact->response;
    const double vn = se3di_dot(v, n), before = se3di_dot(contact->impulse, n);
    const int rolls = contact->way == SE3DI_CONVEX_ROLL;
    const double alone = vn - response[0] * (before + contact->attraction);
    const double normal = rolls ? find_torsion(contact, alone, response[0])
                                : find_normal(contact, c->h, alone, response[0]);
    const double share = 1.0 / (1.0 + contact->drag * response[1]);
    for (int k = 0; k < 3; ++k) {
        const double across = contact->impulse[k] - before * n[k];
        const double vt = v[k] - vn * n[k] - response[1] * across;
        p[k] = -share * (c->h * contact->tangential * contact->xi[k] + contact->drag * vt);
    }
    const double size = se3di_norm(p);
    const double cap = rolls ? se3di_convex_cap(contact) : contact->friction * normal;
    se3di_scale(size > cap ? cap / size : 1.0, p, p);
    se3di_add_scaled(normal - contact->attraction, n, p);
}

/* What presses where it rolls. */
static double load_of(const se3di_convex *c, const se3di_convex_contact *contact)
{
    const se3di_convex_contact *presser = &c->contacts[contact->partner];
    return fmax(0.0, se3di_dot(presser->impulse, presser->normal) + presser->attraction);
}

/* Give it that impulse. Returns how much it changed. */
static double settle(se3di_convex *c, se3di_convex_contact *contact)
{
    double v[3], p[3], change[3];
    if (contact->way == SE3DI_CONVEX_ROLL) {
        contact->bound = contact->friction * load_of(c, contact);
    }
    se3di_convex_slip(contact, c->v, v);
    if (!find_held(c, contact, v, p)) {
        find_impulse(c, contact, v, p);
    }
    se3di_sub(p, contact->impulse, change);
    se3di_copy(p, contact->impulse);
    const double size = se3di_norm(change);
    if (!(size <= 0.0)) { /* most do not touch any more where much parts */
        apply(c, contact, change);
    }
    return size;
}

double se3di_convex_foresee(const se3di_convex *c, se3di_convex_contact *contact, double ahead[3])
{
    const double *n = contact->normal, *response = contact->response;
    double p[3], change[3];
    find_impulse(c, contact, contact->v, p);
    se3di_sub(p, contact->impulse, change);
    const double along = se3di_dot(change, n);
    for (int k = 0; k < 3; ++k) {
        ahead[k] =
            contact->v[k] + response[1] * change[k] + (response[0] - response[1]) * along * n[k];
    }
    if (contact->way != SE3DI_CONVEX_ROLL) { /* whose cap is that of the last sweep */
        contact->bound = contact->friction * (se3di_dot(p, n) + contact->attraction);
    }
    return se3di_norm(change);
}

/* What the step before did, if it acted by the law then as now. */
static void remember(se3di_convex *c, const se3di_convex_island *island)
{
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        se3di_convex_contact *contact = se3di_convex_at(c, k);
        const se3di_body_contact *record = contact->record;
        respond(c, contact);
        if (record && contact->way == SE3DI_CONVEX_SPRING &&
            record->kind != SE3DI_CONTACT_PARTING) {
            se3di_scale(c->h, record->force, contact->impulse);
            apply(c, contact, contact->impulse);
        }
    }
}

/* Whether a body of it was moved in this sweep or the one before. */
static int is_stirred(const se3di_convex *c, const se3di_convex_contact *contact, int sweep)
{
    return (contact->free[0] >= 0 && c->stirred[contact->free[0]] + 1 >= sweep) ||
           (contact->free[1] >= 0 && c->stirred[contact->free[1]] + 1 >= sweep);
}

static void stir(se3di_convex *c, const se3di_convex_contact *contact, int sweep)
{
    for (int k = 0; k < 2; ++k) {
        if (contact->free[k] >= 0) {
            c->stirred[contact->free[k]] = sweep;
        }
    }
}

static double largest_impulse(const se3di_convex *c, const se3di_convex_island *island)
{
    double largest = 0.0;
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        largest = fmax(largest, se3di_norm(se3di_convex_at(c, k)->impulse));
    }
    return largest;
}

/* Returns the sweeps after which hardly anything changed any more. After the first one only those
 * are looked at again whose bodies others have moved. */
static int sweep_all(se3di_convex *c, const se3di_convex_island *island, int most)
{
    const size_t count = island->contact_end - island->contact;
    double largest = largest_impulse(c, island);
    memset(c->stirred + island->body, -1, (island->body_end - island->body) * sizeof *c->stirred);
    for (int sweep = 0; sweep < most; ++sweep) {
        const double calm = CALM * largest;
        size_t changed = 0;
        for (size_t k = 0; k < count; ++k) {
            const size_t at = sweep % 2 ? count - 1 - k : k;
            se3di_convex_contact *contact = se3di_convex_at(c, island->contact + at);
            if (!is_stirred(c, contact, sweep)) {
                continue;
            }
            const double change = settle(c, contact);
            largest = fmax(largest, se3di_norm(contact->impulse));
            if (change > PASSED_ON * calm) {
                stir(c, contact, sweep);
            }
            changed += change > calm;
        }
        if (changed == 0) {
            return sweep;
        }
    }
    return most;
}

int se3di_convex_sweep(se3di_convex *c, const se3di_convex_island *island)
{
    remember(c, island);
    return sweep_all(c, island, SWEEPS) <= SWEEPS_AT_REST;
}

void se3di_convex_relax(se3di_convex *c, const se3di_convex_island *island)
{
    for (size_t k = island->body; k < island->body_end; ++k) {
        se3di_convex_let_go(c, k, c->gradient + 6 * k);
    }
    (void)sweep_all(c, island, SWEEPS_BETWEEN);
}
