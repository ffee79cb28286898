/* SPDX-License-Identifier: BSD-3-Clause */
/* Directional derivatives: central differences of two widths, extrapolated,
 *
 *     D(h) = (f(h) - f(-h)) / (2 h)        D = (4 D(h) - D(2 h)) / 3 + O(h^4)
 *
 * along the seed, whose largest part is h of what is nominal. In the initialization the model is
 * read and its analyses before are run anew for each, since they see inputs and parameters. */
#include "io/fmi/exchange.h"

#include <math.h>
#include <string.h>

#define WIDTH 1e-3

typedef struct question {
    se3di_fmi_unit *u;
    const uint32_t *unknowns, *knowns;
    size_t unknown_count, known_count;
    const double *seed;
    double *values; /* [known_count], where it is asked; then [states], the states there */
    double *at;     /* [known_count] trial values */
    double *f;      /* [4 * unknown_count] */
} question;

static const se3di_fmi_variable *variable_of(const se3di_fmi_unit *u, uint32_t reference)
{
    return &u->variables.list[reference];
}

static bool is_initializing(const se3di_fmi_unit *u)
{
    return u->mode == SE3DI_FMI_INITIALIZING;
}

/* In the initialization states are unknown, and parameters known. */
static bool is_known(const se3di_fmi_unit *u, se3di_fmi_role role)
{
    return role == SE3DI_FMI_INPUT || (is_initializing(u) ? role == SE3DI_FMI_PARAMETER
                                                          : u->exchange && role == SE3DI_FMI_STATE);
}

static bool is_unknown(const se3di_fmi_unit *u, se3di_fmi_role role)
{
    return role == SE3DI_FMI_OUTPUT ||
           (u->exchange && (role == SE3DI_FMI_DERIVATIVE || role == SE3DI_FMI_INDICATOR)) ||
           (is_initializing(u) &&
            (role == SE3DI_FMI_CALCULATED || (u->exchange && role == SE3DI_FMI_STATE)));
}

static bool check(const question *q)
{
    se3di_fmi_unit *u = q->u;
    for (size_t k = 0; k < q->unknown_count + q->known_count; ++k) {
        const bool is_cause = k >= q->unknown_count;
        const uint32_t reference = is_cause ? q->knowns[k - q->unknown_count] : q->unknowns[k];
        if (reference >= u->variables.count) {
            return se3di_fmi_fail(u, "the value reference %u is unknown: there are 0 to %zu",
                                  (unsigned)reference, u->variables.count - 1);
        }
        const se3di_fmi_variable *v = variable_of(u, reference);
        const bool fits = is_cause ? is_known(u, v->role) : is_unknown(u, v->role);
        if (!fits) {
            return se3di_fmi_fail(u, "%s is no %s of a derivative", v->name,
                                  is_cause ? "known" : "unknown");
        }
    }
    for (size_t k = 0; k < q->known_count; ++k) {
        if (!isfinite(q->seed[k])) {
            return se3di_fmi_fail(u, "the seed is %g, must be finite", q->seed[k]);
        }
    }
    return true;
}

static bool get_all(const question *q, double *values)
{
    for (size_t k = 0; k < q->unknown_count; ++k) {
        if (!se3di_fmi_unit_get(q->u, q->unknowns[k], &values[k])) {
            return false;
        }
    }
    return true;
}

/* Set the knowns to their values and a part of the seed. */
static bool go(const question *q, double part)
{
    se3di_fmi_unit *u = q->u;
    double *x = u->exchange && !is_initializing(u) ? u->exchange->given : NULL;
    if (x) {
        memcpy(x, q->values + q->known_count, u->variables.states * sizeof *x);
    }
    for (size_t k = 0; k < q->known_count; ++k) {
        const se3di_fmi_variable *v = variable_of(u, q->knowns[k]);
        q->at[k] = q->values[k] + part * q->seed[k];
        if (v->role == SE3DI_FMI_STATE) {
            x[v->element] = q->at[k];
        } else if (!se3di_fmi_unit_force(u, q->knowns[k], q->at[k])) {
            return false;
        }
    }
    if (x) {
        se3di_fmi_exchange_put(u, x);
    }
    return true;
}

/* The unit of the seed: its largest part in nominal values. 0: it is zero */
static double measure(const question *q)
{
    double size = 0.0;
    for (size_t k = 0; k < q->known_count; ++k) {
        const se3di_fmi_variable *v = variable_of(q->u, q->knowns[k]);
        const double value = fabs(q->values[k]);
        const double nominal = v->role == SE3DI_FMI_STATE                      ? v->nominal
                               : v->role == SE3DI_FMI_PARAMETER && value > 0.0 ? value
                                                                               : fmax(1.0, value);
        size = fmax(size, fabs(q->seed[k]) / nominal);
    }
    return size;
}

static bool difference(const question *q, double *out)
{
    static const double parts[] = {1.0, -1.0, 2.0, -2.0};
    const double size = measure(q);
    const size_t n = q->unknown_count;
    const double h = size > 0.0 ? WIDTH / size : 0.0;
    memset(out, 0, n * sizeof *out);
    if (!(size > 0.0)) {
        return true;
    }
    for (size_t i = 0; i < 4; ++i) {
        if (!go(q, parts[i] * h) || !get_all(q, q->f + i * n)) {
            return false;
        }
    }
    for (size_t k = 0; k < n; ++k) {
        const double near = (q->f[k] - q->f[n + k]) / (2.0 * h);
        const double far = (q->f[2 * n + k] - q->f[3 * n + k]) / (4.0 * h);
        out[k] = (4.0 * near - far) / 3.0;
    }
    return true;
}

/* What is known exactly: positions whose derivative is a velocity. */
static void correct(const question *q, double *out)
{
    const se3di_fmi_variables *all = &q->u->variables;
    for (size_t k = 0; k < q->unknown_count && !all->projects && !is_initializing(q->u); ++k) {
        const se3di_fmi_variable *v = variable_of(q->u, q->unknowns[k]);
        if (v->role != SE3DI_FMI_DERIVATIVE || v->component == 0) {
            continue;
        }
        out[k] = 0.0;
        for (size_t i = 0; i < q->known_count; ++i) {
            out[k] += q->knowns[i] == all->state + v->component - 1 ? q->seed[i] : 0.0;
        }
    }
}

/* In model exchange the states, and elsewhere everything, is put back afterwards. */
static bool ask(question *q, double *out)
{
    se3di_fmi_unit *u = q->u;
    for (size_t k = 0; k < q->known_count; ++k) {
        if (!se3di_fmi_unit_get(u, q->knowns[k], &q->values[k])) {
            return false;
        }
    }
    if (u->exchange && !is_initializing(u)) {
        memcpy(q->values + q->known_count, u->exchange->x, u->variables.states * sizeof *q->values);
    }
    bool good = difference(q, out);
    if (is_initializing(u) || u->mode == SE3DI_FMI_FAILED) {
        return good; /* bytes put back what was */
    }
    const bool is_discarded = u->is_discarded;
    good = go(q, 0.0) && good;
    u->is_discarded = is_discarded;
    correct(q, out);
    return good;
}

static bool allocate(question *q, se3di_iopool *pool)
{
    const size_t states = q->u->exchange ? q->u->variables.states : 0;
    q->values = se3di_iopool_array(pool, q->known_count + states + 1, sizeof *q->values);
    q->at = se3di_iopool_array(pool, q->known_count + 1, sizeof *q->at);
    q->f = se3di_iopool_array(pool, 4 * q->unknown_count + 1, sizeof *q->f);
    return (q->values && q->at && q->f) || se3di_fmi_fail(q->u, "out of memory");
}

/* Beside the steps of a solver of its own, and at the start, the unit goes back to its bytes. */
static bool ask_aside(question *q, se3di_iopool *pool, double *out)
{
    size_t size = 0;
    if (!se3di_fmi_unit_write(q->u, NULL, &size)) {
        return false;
    }
    unsigned char *bytes = se3di_iopool_alloc(pool, size);
    if (!bytes) {
        return se3di_fmi_fail(q->u, "out of memory");
    }
    if (!se3di_fmi_unit_write(q->u, bytes, &size)) {
        return false;
    }
    const bool good = ask(q, out);
    return se3di_fmi_unit_read(q->u, bytes, size) && good;
}

bool se3di_fmi_unit_derive(se3di_fmi_unit *unit, const uint32_t *unknowns, size_t unknown_count,
                           const uint32_t *knowns, size_t known_count, const double *seed,
                           double *out)
{
    const unsigned modes = 1U << SE3DI_FMI_INITIALIZING |
                           (unit->exchange ? 1U << SE3DI_FMI_EVENT | 1U << SE3DI_FMI_CONTINUOUS
                                           : 1U << SE3DI_FMI_STEPPING);
    question q = {.u = unit,
                  .unknowns = unknowns,
                  .knowns = knowns,
                  .unknown_count = unknown_count,
                  .known_count = known_count,
                  .seed = seed};
    se3di_iopool pool;
    unit->is_discarded = false;
    if (!se3di_fmi_is_in(unit, modes, "a derivative") || !check(&q)) {
        return false;
    }
    se3di_iopool_init(&pool, NULL);
    const bool good =
        allocate(&q, &pool) &&
        (unit->exchange && !is_initializing(unit) ? ask(&q, out) : ask_aside(&q, &pool, out));
    se3di_iopool_destroy(&pool);
    return good;
}
