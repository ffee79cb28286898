/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/import/material.h"

#include <math.h>
#include <string.h>

#define RESTITUTION_MIN 0.01 /* of a model file */
#define SINKS           1e-4 /* [m] */

static bool is_same(const se3di_machine_material *a, const se3di_machine_material *b)
{
    const double x[5] = {a->friction, a->restitution, a->stiffness, a->young, a->poisson};
    const double y[5] = {b->friction, b->restitution, b->stiffness, b->young, b->poisson};
    return memcmp(x, y, sizeof x) == 0;
}

static bool is_taken(const se3di_machine *m, const char *name)
{
    for (const se3di_machine_material *at = m->materials; at; at = at->next) {
        if (strcmp(at->name, name) == 0) {
            return true;
        }
    }
    return false;
}

/* A name that no other material has; what stands in quotes may have any characters. */
static const char *free_name(se3di_machine *m, const char *wish)
{
    const char *base = wish && *wish ? wish : "material";
    const char *name = se3di_machine_text(m, "%.80s", base);
    for (size_t k = 2; name && is_taken(m, name); ++k) {
        name = se3di_machine_text(m, "%.80s_%zu", base, k);
    }
    return name;
}

static double within(se3di_machine *m, double value, double least, double most, const char *what,
                     const char *name, size_t line)
{
    const double taken = !(value >= least) ? least : value > most ? most : value;
    if (!(fabs(taken - value) <= 0.0)) {
        se3di_machine_note_of(m, SE3D_IMPORT_NOTE, line,
                              "the %s of material `%.60s` is %g, here it is %g", what,
                              name ? name : "", value, taken);
    }
    return taken;
}

const char *se3di_machine_material_name(se3di_machine *m, const se3di_machine_material *wanted,
                                        size_t line)
{
    se3di_machine_material one = *wanted;
    size_t count = 0;
    const char *wish = wanted->name;
    one.friction = within(m, one.friction, 0.0, 1e3, "friction", wish, line);
    one.restitution = within(m, one.restitution, RESTITUTION_MIN, 1.0, "restitution", wish, line);
    for (const se3di_machine_material *at = m->materials; at; at = at->next) {
        ++count;
        if (is_same(at, &one) || count == SE3DI_MATERIALS_MAX) {
            if (!is_same(at, &one)) {
                se3di_machine_note_of(m, SE3D_IMPORT_LOST, line,
                                      "the material `%.60s`: there are more than %d different "
                                      "ones, it is `%.60s`",
                                      wish ? wish : "", SE3DI_MATERIALS_MAX, at->name);
            }
            return at->name;
        }
    }
    se3di_machine_material *made = se3di_iopool_alloc(m->pool, sizeof *made);
    one.name = free_name(m, wish);
    if (!made || !one.name) {
        se3di_machine_fail_memory(m);
        return NULL;
    }
    one.next = NULL;
    *made = one;
    *(m->last_material ? &m->last_material->next : &m->materials) = made;
    m->last_material = made;
    return made->name;
}

double se3di_machine_stiffness(const se3di_machine *m)
{
    double mass = 0.0;
    for (size_t k = 0; k < m->body_count; ++k) {
        mass += m->bodies[k].fixed ? 0.0 : m->bodies[k].mass;
    }
    const double wanted = fmin(fmax(mass, 1e-6), 1e9) * 9.81 / SINKS;
    double power = 1e-2;
    while (power < wanted) {
        power *= 10.0;
    }
    return power;
}
