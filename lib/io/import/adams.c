/* SPDX-License-Identifier: BSD-3-Clause */
/* Adams Solver data sets (.adm): units, gravity, and the statements in the order in which they need
 * each other. */
#include "io/import/adams.h"

#include <string.h>

#include "io/import/formats.h"
#include "io/import/scan.h"

typedef struct unit {
    const char *name;
    double value;
} unit;

static bool read_unit(se3di_adams *a, const se3di_adams_statement *s, const char *key,
                      const unit *units, double *value)
{
    const char *text = se3di_adams_get(s, key);
    for (const unit *u = units; text && u->name; ++u) {
        if (se3di_scan_equal(text, u->name)) {
            *value = u->value;
            return true;
        }
    }
    return !text ||
           se3di_machine_fail(a->m, s->line, 1, "UNITS: %s = %.40s is not known", key, text);
}

static bool read_system(se3di_adams *a, const se3di_adams_statement *s)
{
    static const struct {
        const char *name;
        double force, mass, length;
    } systems[] = {{"MKS", 1.0, 1.0, 1.0},
                   {"MMKS", 1.0, 1.0, 1e-3},
                   {"CGS", 1e-5, 1e-3, 1e-2},
                   {"FPS", 4.4482216152605, 0.45359237, 0.3048},
                   {"IPS", 4.4482216152605, 0.45359237, 0.0254}};
    const char *text = se3di_adams_get(s, "SYSTEM");
    for (size_t k = 0; text && k < sizeof systems / sizeof *systems; ++k) {
        if (se3di_scan_equal(text, systems[k].name)) {
            a->force = systems[k].force;
            a->mass = systems[k].mass;
            a->length = systems[k].length;
            return true;
        }
    }
    return !text ||
           se3di_machine_fail(a->m, s->line, 1, "UNITS: SYSTEM = %.40s is not known", text);
}

static bool read_units(se3di_adams *a, se3di_adams_statement *s)
{
    static const unit forces[] = {{"NEWTON", 1.0},
                                  {"KILONEWTON", 1e3},
                                  {"MILLINEWTON", 1e-3},
                                  {"CENTINEWTON", 1e-2},
                                  {"MEGANEWTON", 1e6},
                                  {"MICRONEWTON", 1e-6},
                                  {"NANONEWTON", 1e-9},
                                  {"DYNE", 1e-5},
                                  {"KILOGRAM_FORCE", 9.80665},
                                  {"POUND_FORCE", 4.4482216152605},
                                  {"KPOUND_FORCE", 4448.2216152605},
                                  {"OUNCE_FORCE", 0.278013850953781},
                                  {"POUNDAL", 0.138254954376},
                                  {NULL, 0.0}};
    static const unit masses[] = {{"KILOGRAM", 1.0},
                                  {"GRAM", 1e-3},
                                  {"TONNE", 1e3},
                                  {"MEGAGRAM", 1e3},
                                  {"MILLIGRAM", 1e-6},
                                  {"MICROGRAM", 1e-9},
                                  {"POUND_MASS", 0.45359237},
                                  {"KPOUND_MASS", 453.59237},
                                  {"OUNCE_MASS", 0.028349523125},
                                  {"SLUG", 14.5939029372064},
                                  {"SLINCH", 175.126835246476},
                                  {NULL, 0.0}};
    static const unit lengths[] = {{"METER", 1.0},     {"MILLIMETER", 1e-3}, {"CENTIMETER", 1e-2},
                                   {"KILOMETER", 1e3}, {"MICROMETER", 1e-6}, {"NANOMETER", 1e-9},
                                   {"INCH", 0.0254},   {"FOOT", 0.3048},     {"YARD", 0.9144},
                                   {"MILE", 1609.344}, {"MILS", 2.54e-5},    {"MICROINCH", 2.54e-8},
                                   {NULL, 0.0}};
    static const unit times[] = {
        {"SECOND", 1.0},       {"MILLISECOND", 1e-3}, {"MINUTE", 60.0}, {"HOUR", 3600.0},
        {"MICROSECOND", 1e-6}, {"NANOSECOND", 1e-9},  {"DAY", 86400.0}, {NULL, 0.0}};
    return read_system(a, s) && read_unit(a, s, "FORCE", forces, &a->force) &&
           read_unit(a, s, "MASS", masses, &a->mass) &&
           read_unit(a, s, "LENGTH", lengths, &a->length) &&
           read_unit(a, s, "TIME", times, &a->time);
}

static bool read_gravity(se3di_adams *a, se3di_adams_statement *s)
{
    static const char *const keys[3] = {"IGRAV", "JGRAV", "KGRAV"};
    const double scale = a->length / (a->time * a->time);
    for (int k = 0; k < 3; ++k) {
        a->m->gravity[k] = 0.0;
        if (!se3di_adams_number(a, s, keys[k], scale, &a->m->gravity[k])) {
            return false;
        }
    }
    return true;
}

static const struct {
    const char *word;
    bool (*make)(se3di_adams *a, se3di_adams_statement *s);
} makers[] = {{"JOINT", se3di_adams_joint},     {"JPRIM", se3di_adams_jprim},
              {"GCON", se3di_adams_gcon},       {"MOTION", se3di_adams_motion},
              {"COUPLER", se3di_adams_coupler}, {"GEAR", se3di_adams_gear},
              {"SFORCE", se3di_adams_sforce},   {"SPRINGDAMPER", se3di_adams_springdamper},
              {"BUSHING", se3di_adams_bushing}, {"GFORCE", se3di_adams_gforce},
              {"VFORCE", se3di_adams_gforce},   {"VTORQUE", se3di_adams_gforce}};

static bool make_all(se3di_adams *a, const char *word,
                     bool (*make)(se3di_adams *a, se3di_adams_statement *s))
{
    for (se3di_adams_statement *s = a->first; s; s = s->next) {
        if (strcmp(s->word, word) == 0 && !make(a, s)) {
            return false;
        }
    }
    return true;
}

static bool make_rackpin(se3di_adams *a, se3di_adams_statement *s)
{
    return !se3di_adams_has(s, "RACKPIN") || se3di_adams_rackpin(a, s);
}

/* Statements that no model file has a place for; those of the analysis are none of the model. */
static void note_others(se3di_adams *a)
{
    static const char *const quiet[] = {
        "PART",        "MARKER",     "ACCGRAV",    "UNITS", "GRAPHICS",    "OUTPUT",
        "RESULTS",     "INTEGRATOR", "KINEMATICS", "DEBUG", "PREFERENCES", "LIST",
        "EQUILIBRIUM", "DYNAMICS",   "IC",         "LSE",   "LINEAR",      "EXECUTION",
        "END",         "STRING",     "VARIABLE",   "DATA"};
    size_t requests = 0;
    size_t line = 0;
    for (const se3di_adams_statement *s = a->first; s; s = s->next) {
        bool known = strcmp(s->word, "REQUEST") == 0;
        requests += known;
        line = known && line == 0 ? s->line : line;
        for (size_t k = 0; k < sizeof quiet / sizeof *quiet; ++k) {
            known = known || strcmp(s->word, quiet[k]) == 0;
        }
        for (size_t k = 0; k < sizeof makers / sizeof *makers; ++k) {
            known = known || strcmp(s->word, makers[k].word) == 0;
        }
        if (!known) {
            se3di_adams_lose(a, s, NULL);
        }
    }
    if (requests > 0) {
        se3di_machine_note_of(a->m, SE3D_IMPORT_NOTE, line,
                              "%zu REQUEST%s: results.csv holds every channel, and those of the "
                              "markers can be added under `output`",
                              requests, requests == 1 ? "" : "s");
    }
}

bool se3di_import_adams(se3di_machine *m, const char *text, size_t length)
{
    se3di_adams a = {.m = m, .force = 1.0, .mass = 1.0, .length = 1.0, .time = 1.0};
    m->gravity[2] = 0.0;
    if (!se3di_adams_read(&a, text, length) || !make_all(&a, "UNITS", read_units)) {
        return false;
    }
    if (!make_all(&a, "ACCGRAV", read_gravity) || !se3di_adams_parts(&a)) {
        return false;
    }
    if (m->body_count == 0) {
        return se3di_machine_fail(m, 0, 0, "there is no PART that moves");
    }
    for (size_t k = 0; k < sizeof makers / sizeof *makers; ++k) {
        if (!make_all(&a, makers[k].word, makers[k].make)) {
            return false;
        }
    }
    if (!make_all(&a, "JOINT", make_rackpin)) {
        return false;
    }
    note_others(&a);
    return m->status >= 0;
}
