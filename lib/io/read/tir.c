/* SPDX-License-Identifier: BSD-3-Clause */
/* Tyre property files: sections in brackets, KEY = value, comments from $ or ! on, texts in quotes.
 * Files are data from anywhere: each line is checked, what is not known is listed in a warning. */
#include "io/read/tir.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/attachment.h"
#include "io/document/document.h"
#include "io/document/keys.h"

enum { LIST_SIZE = 400, NUMBER_MAX = 60 };
#define LEAST 1e-40 /* positive numbers that a tyre takes */

typedef struct tir {
    se3di_reader *reader;
    const se3di_node *tyre;
    const char *file;
    size_t line;
    double *c; /* coefficients */
    se3d_tyre_def *def;
    double length, force, angle, time, pressure; /* units [SI]; 0: not given */
    bool has[SE3D_TYRE_COEFFICIENTS];
    bool has_law, in_table, is_transient, has_turn_slip;
    char unknown[LIST_SIZE]; /* keys */
    char empty[LIST_SIZE];   /* keys without a value */
    size_t unknown_count;
} tir;

static bool fail(const tir *t, const char *key, const char *what)
{
    return se3di_reader_fail_key(t->reader, t->tyre, "file", "`%.200s`, line %zu: %.60s%s%s",
                                 t->file, t->line, key, *key ? " " : "", what);
}

/* A list of names, which ends with ... if there are too many. */
static void append(char list[LIST_SIZE], const char *name)
{
    const size_t used = strlen(list);
    if (used + strlen(name) + 8 < LIST_SIZE) {
        snprintf(list + used, LIST_SIZE - used, "%s%s", used > 0 ? ", " : "", name);
    } else if (used + 6 < LIST_SIZE && strcmp(list + used - 3, "...") != 0) {
        snprintf(list + used, LIST_SIZE - used, ", ...");
    }
}

static void warn(const tir *t, const char *what, const char *list)
{
    char message[LIST_SIZE + 400];
    const se3d_model_options *options = t->reader->options;
    if (options->log && *list) {
        snprintf(message, sizeof message, "%.200s: %s: %s", t->file, what, list);
        options->log(options->log_ctx, SE3D_LOG_WARNING, SE3D_LOG_FILE, message);
    }
}

/* Digits with at most one point, and an exponent: nothing else is a number here. */
static bool is_number(const char *text)
{
    const char *at = text + strspn(text, "+-");
    const size_t whole = strspn(at, "0123456789");
    const size_t after = at[whole] == '.' ? strspn(at + whole + 1, "0123456789") + 1 : 0;
    if (at - text > 1 || whole + after < 1 || (whole == 0 && after < 2)) {
        return false;
    }
    at += whole + after;
    if (*at == 'e' || *at == 'E') {
        at += 1 + (at[1] == '+' || at[1] == '-');
        const size_t digits = strspn(at, "0123456789");
        at += digits > 0 ? digits : 0;
        return digits > 0 && !*at;
    }
    return !*at;
}

static bool take_number(const tir *t, const char *key, const char *text, double *value)
{
    se3d_expression *expression = NULL;
    se3d_expression_def def = se3d_expression_def_default();
    if (!is_number(text) || strlen(text) > NUMBER_MAX) {
        return fail(t, key, "must be a number such as 1.25 or -3e-2");
    }
    def.text = text + (*text == '+');
    def.allocator = se3di_iopool_lend(t->reader->pool);
    se3d_status status = se3d_expression_create(&def, &expression, NULL);
    if (status == SE3D_ERR_NO_MEMORY) {
        return se3di_reader_fail_memory(t->reader);
    }
    status = status < 0 ? status : se3d_expression_eval(expression, NULL, value);
    se3d_expression_destroy(expression);
    return status < 0 || !isfinite(*value) ? fail(t, key, "must be a finite number") : true;
}

/* ---- Units ---------------------------------------------------------------------------------*/

typedef struct unit {
    const char *quantity, *name;
    double size;
} unit;

static const unit units[] = {
    {"LENGTH", "meter", 1.0},
    {"LENGTH", "m", 1.0},
    {"LENGTH", "mm", 1e-3},
    {"LENGTH", "millimeter", 1e-3},
    {"LENGTH", "cm", 1e-2},
    {"LENGTH", "centimeter", 1e-2},
    {"LENGTH", "km", 1e3},
    {"LENGTH", "kilometer", 1e3},
    {"LENGTH", "inch", 0.0254},
    {"LENGTH", "in", 0.0254},
    {"LENGTH", "foot", 0.3048},
    {"LENGTH", "ft", 0.3048},
    {"LENGTH", "mile", 1609.344},
    {"FORCE", "newton", 1.0},
    {"FORCE", "n", 1.0},
    {"FORCE", "kilonewton", 1e3},
    {"FORCE", "knewton", 1e3},
    {"FORCE", "kn", 1e3},
    {"FORCE", "kg_force", 9.80665},
    {"FORCE", "kgf", 9.80665},
    {"FORCE", "pound_force", 4.4482216152605},
    {"FORCE", "lbf", 4.4482216152605},
    {"ANGLE", "radians", 1.0},
    {"ANGLE", "radian", 1.0},
    {"ANGLE", "rad", 1.0},
    {"ANGLE", "degrees", 0.017453292519943295},
    {"ANGLE", "degree", 0.017453292519943295},
    {"ANGLE", "deg", 0.017453292519943295},
    {"TIME", "second", 1.0},
    {"TIME", "sec", 1.0},
    {"TIME", "s", 1.0},
    {"TIME", "millisecond", 1e-3},
    {"TIME", "ms", 1e-3},
    {"TIME", "minute", 60.0},
    {"TIME", "min", 60.0},
    {"TIME", "hour", 3600.0},
    {"PRESSURE", "pascal", 1.0},
    {"PRESSURE", "pa", 1.0},
    {"PRESSURE", "kpascal", 1e3},
    {"PRESSURE", "kpa", 1e3},
    {"PRESSURE", "bar", 1e5},
    {"PRESSURE", "psi", 6894.757293168361},
};

static bool take_unit(tir *t, const char *quantity, char *name)
{
    const struct {
        const char *quantity;
        double *to;
    } places[] = {{"LENGTH", &t->length},
                  {"FORCE", &t->force},
                  {"ANGLE", &t->angle},
                  {"TIME", &t->time},
                  {"PRESSURE", &t->pressure}};
    char allowed[LIST_SIZE] = "";
    for (char *at = name; *at; ++at) {
        *at = (char)(*at >= 'A' && *at <= 'Z' ? *at - 'A' + 'a' : *at);
    }
    for (size_t k = 0; k < sizeof units / sizeof *units; ++k) {
        if (strcmp(units[k].quantity, quantity) != 0) {
            continue;
        }
        append(allowed, units[k].name);
        for (size_t p = 0; p < 5 && strcmp(units[k].name, name) == 0; ++p) {
            if (strcmp(places[p].quantity, quantity) == 0) {
                *places[p].to = units[k].size;
                return true;
            }
        }
    }
    if (!*allowed) {
        return true; /* MASS: no coefficient has it */
    }
    return se3di_reader_fail_key(t->reader, t->tyre, "file",
                                 "`%.200s`, line %zu: %s = `%.40s` is no unit, allowed are: %s",
                                 t->file, t->line, quantity, name, allowed);
}

/* ---- Keys ----------------------------------------------------------------------------------*/

/* FITTYP: 5, 6, 21, 51, 52 or 60, 61, 62; or the name of the format. */
static bool take_law(tir *t, const char *key, const char *text)
{
    if (se3di_keys_contain(" 5 6 21 51 52 PAC2002 MF52 MF_52 ", text)) {
        t->def->law = SE3D_TYRE_MF52;
    } else if (se3di_keys_contain(" 60 61 62 MF61 MF_61 MF62 MF_62 ", text)) {
        t->def->law = SE3D_TYRE_MF61;
    } else if (strcmp(key, "FITTYP") == 0) {
        return fail(t, key, "must be 5, 6, 21, 51 or 52 (Magic Formula 5.2) or 60, 61 or 62 (6.1)");
    } else if (se3di_keys_contain(" USER MF_05 MF-TYRE ", text)) {
        return true; /* FITTYP says which */
    } else {
        return fail(t, key, "must be PAC2002, MF52 or MF61: other formulas are not known");
    }
    t->has_law = true;
    return true;
}

static bool take_side(tir *t, const char *text)
{
    const bool right = strcmp(text, "RIGHT") == 0 || strcmp(text, "Right") == 0;
    t->def->measured_side = right ? SE3D_TYRE_RIGHT : SE3D_TYRE_LEFT;
    return true; /* LEFT, SYMMETRIC, UNKNOWN, ... */
}

/* What says nothing about forces on a plane road. */
static bool is_idle(const char *key)
{
    static const char idle[] =
        " FILE_TYPE FILE_VERSION FILE_FORMAT FUNCTION_NAME N_TIRE_STATES WIDTH "
        "ASPECT_RATIO RIM_RADIUS RIM_WIDTH TYRE_MASS TIRE_MASS MASS IXX IYY IZZ GRAVITY "
        "USER_SUB_ID "
        "SWITCH_INTEG BELT_MASS BELT_IXX BELT_IYY FREQ_LONG FREQ_LAT FREQ_YAW FREQ_WINDUP "
        "DAMP_LONG DAMP_LAT DAMP_YAW DAMP_WINDUP DAMP_RESIDUAL DAMP_VLOW HMAX PRESMIN PRESMAX "
        "BOTTOM_STIFF BOTTOM_OFFST MC_CONTOUR_A MC_CONTOUR_B ";
    return se3di_keys_contain(idle, key);
}

/* USE_MODE: from 11 to 25 in size slip lags, where the file has lengths; with the last digit 5 turn
 * slip counts, where the file has coefficients for it. */
static bool take_mode(tir *t, const char *text)
{
    double mode = 0.0;
    if (!take_number(t, "USE_MODE", text, &mode)) {
        return false;
    }
    t->is_transient = fabs(mode) > 10.0;
    t->has_turn_slip = fabs(fmod(fabs(mode), 10.0) - 5.0) < 0.5;
    return true;
}

static bool take_pair(tir *t, char *key, char *text)
{
    const struct {
        const char *key;
        double *to;
    } places[] = {{"UNLOADED_RADIUS", &t->def->radius},
                  {"VERTICAL_STIFFNESS", &t->def->k},
                  {"VERTICAL_DAMPING", &t->def->c},
                  {"VXLOW", &t->def->low_speed}};
    size_t index = 0;
    for (size_t k = 0; k < sizeof places / sizeof *places; ++k) {
        if (strcmp(key, places[k].key) == 0) {
            return take_number(t, key, text, places[k].to);
        }
    }
    if (strcmp(key, "FITTYP") == 0 || strcmp(key, "PROPERTY_FILE_FORMAT") == 0) {
        return t->has_law && *key == 'P' ? true : take_law(t, key, text);
    }
    if (strcmp(key, "TYRESIDE") == 0) {
        return take_side(t, text);
    }
    if (strcmp(key, "USE_MODE") == 0) {
        return take_mode(t, text);
    }
    if (key[0] == 'Q' && key[1] == '_') { /* Q_RE0 is QRE0 */
        memmove(key + 1, key + 2, strlen(key + 2) + 1);
    }
    if (!SE3D_FAILED(se3d_tyre_coefficient_find(key, &index))) {
        t->has[index] = true;
        return take_number(t, key, text, &t->c[index]);
    }
    if (!is_idle(key)) {
        append(t->unknown, key);
        ++t->unknown_count;
    }
    return true;
}

/* ---- Lines ---------------------------------------------------------------------------------*/

/* Without blanks and quotes at its ends. */
static char *trim(char *text)
{
    text += strspn(text, " \t\r'\"");
    size_t length = strlen(text);
    while (length > 0 && strchr(" \t\r'\"", text[length - 1])) {
        text[--length] = '\0';
    }
    return text;
}

static bool read_line(tir *t, char *line)
{
    static const char *const quantities = " LENGTH FORCE ANGLE MASS TIME PRESSURE TEMPERATURE ";
    line[strcspn(line, "$!")] = '\0';
    char *equals = strchr(line, '=');
    char *bracket = line + strspn(line, " \t\r");
    if (!*bracket) {
        return true;
    }
    if (*bracket == '[') {
        t->in_table = false;
        return strchr(bracket, ']') ? true : fail(t, "[", "must be a section, [NAME]");
    }
    if (*bracket == '{') {
        t->in_table = true; /* numbers of a table follow */
        append(t->unknown, trim(bracket));
        ++t->unknown_count;
        return true;
    }
    if (!equals) {
        return t->in_table ? true : fail(t, trim(line), "must be KEY = value or [SECTION]");
    }
    *equals = '\0';
    char *key = trim(line);
    char *text = trim(equals + 1);
    if (!*key || strlen(key) > NUMBER_MAX) {
        return fail(t, "", "must have a key of at most 60 characters before `=`");
    }
    if (!*text) { /* as programs write what was not measured */
        append(t->empty, key);
        return true;
    }
    return se3di_keys_contain(quantities, key) ? take_unit(t, key, text) : take_pair(t, key, text);
}

/* The lines of a text, which is cut up. */
static bool read_lines(tir *t, char *text, size_t size)
{
    if (memchr(text, '\0', size)) {
        return fail(t, "", "has a zero byte, must be text");
    }
    for (char *at = text + se3di_byte_order_mark_length(text, size); at; ++t->line) {
        char *end = strchr(at, '\n');
        if (end) {
            *end = '\0';
        }
        if (!read_line(t, at)) {
            return false;
        }
        at = end ? end + 1 : NULL;
    }
    return true;
}

/* ---- What came out -------------------------------------------------------------------------*/

static void convert(tir *t)
{
    static const int loads[] = {SE3D_TYRE_FNOMIN, SE3D_TYRE_FZMIN, SE3D_TYRE_FZMAX};
    static const int angles[] = {SE3D_TYRE_ALPMIN, SE3D_TYRE_ALPMAX, SE3D_TYRE_CAMMIN,
                                 SE3D_TYRE_CAMMAX};
    const double length = t->length > 0.0 ? t->length : 1.0;
    const double force = t->force > 0.0 ? t->force : 1.0;
    const double angle = t->angle > 0.0 ? t->angle : 1.0;
    const double time = t->time > 0.0 ? t->time : 1.0;
    const double pressure = t->pressure > 0.0 ? t->pressure : 1.0;
    for (size_t k = 0; k < sizeof loads / sizeof *loads; ++k) {
        t->c[loads[k]] *= force;
    }
    for (size_t k = 0; k < sizeof angles / sizeof *angles; ++k) {
        t->c[angles[k]] *= angle;
    }
    t->c[SE3D_TYRE_LONGVL] *= t->has[SE3D_TYRE_LONGVL] ? length / time : 1.0;
    t->c[SE3D_TYRE_NOMPRES] *= pressure;
    t->c[SE3D_TYRE_INFLPRES] *= pressure;
    t->c[SE3D_TYRE_LONGITUDINAL_STIFFNESS] *= force / length;
    t->c[SE3D_TYRE_LATERAL_STIFFNESS] *= force / length;
    t->def->radius *= length;
    t->def->k *= force / length;
    t->def->c *= force * time / length;
}

/* Of the coefficients of slip forces and aligning moment, those that the version has and the file
 * has not. */
static void list_missing(const tir *t, char list[LIST_SIZE])
{
    static const char new_ones[] =
        " RBX3 PEY5 PKY4 PKY5 PKY6 PKY7 PPX1 PPX2 PPX3 PPX4 PPY1 PPY2 PPY3 "
        "PPY4 PPY5 RBY4 QDZ10 QDZ11 PPZ1 PPZ2 ";
    static const char *const names[SE3D_TYRE_COEFFICIENTS] = {
#define NAME(NAME, number, value) #NAME,
        SE3D_TYRE_COEFFICIENT_LIST(NAME)
#undef NAME
    };
    const char *others = t->def->law == SE3D_TYRE_MF52 ? new_ones : " PHY3 ";
    for (int k = SE3D_TYRE_PCX1; k <= SE3D_TYRE_SSZ4; ++k) {
        if (!t->has[k] && !se3di_keys_contain(others, names[k])) {
            append(list, names[k]);
        }
    }
}

/* Lateral tests alone: nothing is known of the longitudinal force. */
static bool is_lateral(const tir *t)
{
    return !(fabs(t->c[SE3D_TYRE_PCX1]) > 0.0) && !(fabs(t->c[SE3D_TYRE_PDX1]) > 0.0) &&
           !(fabs(t->c[SE3D_TYRE_PKX1]) > 0.0);
}

static bool check_needed(const tir *t)
{
    static const struct {
        int at;
        const char *name;
    } needed[] = {{SE3D_TYRE_FNOMIN, "FNOMIN"}, {SE3D_TYRE_PCX1, "PCX1"}, {SE3D_TYRE_PDX1, "PDX1"},
                  {SE3D_TYRE_PKX1, "PKX1"},     {SE3D_TYRE_PCY1, "PCY1"}, {SE3D_TYRE_PDY1, "PDY1"},
                  {SE3D_TYRE_PKY1, "PKY1"},     {SE3D_TYRE_PKY2, "PKY2"}};
    const size_t first = is_lateral(t) ? 4 : 0;
    char list[LIST_SIZE] = "";
    for (size_t k = 0; k < sizeof needed / sizeof *needed; ++k) {
        if (!t->has[needed[k].at] && (k < 1 || k >= first)) {
            append(list, needed[k].name);
        }
    }
    if (!t->has_law && !se3di_node_get(t->tyre, "model")) {
        append(list, "FITTYP");
    }
    return !*list ||
           se3di_reader_fail_key(t->reader, t->tyre, "file",
                                 "`%.200s` lacks what a Magic Formula needs: %s", t->file, list);
}

/* What USE_MODE asks for counts if a tyre takes the coefficients with it. Else a warning names
 * those that it does not, unless the model file decides by a key of its own. */
static bool conclude(const tir *t, const char *key, const char *what, const char *list)
{
    if (!se3di_node_get(t->tyre, key)) {
        warn(t, what, list);
    }
    return !*list;
}

/* Relaxation lengths of both directions: those of the model file, or what they follow from. */
static bool can_lag(const tir *t)
{
    const double *c = t->c;
    char list[LIST_SIZE] = "";
    if (!se3di_node_get(t->tyre, "relaxation_x") && !(fabs(c[SE3D_TYRE_PTX1]) > 0.0) &&
        !(c[SE3D_TYRE_LONGITUDINAL_STIFFNESS] > 0.0)) {
        append(list, "PTX1 or LONGITUDINAL_STIFFNESS");
    }
    if (!se3di_node_get(t->tyre, "relaxation_y")) {
        if (fabs(c[SE3D_TYRE_PTY1]) > 0.0) {
            if (!(fabs(c[SE3D_TYRE_PTY2]) > 0.0)) {
                append(list, "PTY2");
            }
        } else if (!(c[SE3D_TYRE_LATERAL_STIFFNESS] > 0.0)) {
            append(list, "PTY1 or LATERAL_STIFFNESS");
        }
    }
    return conclude(t, "transient", "USE_MODE asks for slip that lags, which is left out without",
                    list);
}

/* What se3d_tyre_create wants with turn slip. */
static bool can_turn(const tir *t)
{
    static const struct {
        int at;
        const char *name, *allowed;
        double least, most;
    } needed[] = {{SE3D_TYRE_PHYP1, "PHYP1", "> 0", LEAST, DBL_MAX},
                  {SE3D_TYRE_PHYP2, "PHYP2", "not 0", -DBL_MAX, DBL_MAX},
                  {SE3D_TYRE_QCRP1, "QCRP1", "> 0", LEAST, DBL_MAX},
                  {SE3D_TYRE_QDRP1, "QDRP1", "in [0.01, 1.99]", 0.01, 1.99},
                  {SE3D_TYRE_LMP, "LMP", "> 0", LEAST, DBL_MAX}};
    char list[LIST_SIZE] = "";
    for (size_t k = 0; k < sizeof needed / sizeof *needed; ++k) {
        const double value = t->c[needed[k].at];
        if (!(fabs(value) > 0.0 && value >= needed[k].least && value <= needed[k].most)) {
            char text[NUMBER_MAX];
            snprintf(text, sizeof text, "%s = %g (must be %s)", needed[k].name, value,
                     needed[k].allowed);
            append(list, text);
        }
    }
    return conclude(t, "turn_slip", "USE_MODE asks for turn slip, which is left out", list);
}

bool se3di_read_tir(se3di_reader *reader, const se3di_node *tyre, const char *file,
                    double *coefficients, se3d_tyre_def *def)
{
    tir t = {
        .reader = reader, .tyre = tyre, .file = file, .line = 1, .c = coefficients, .def = def};
    se3di_iopool pool; /* of the text */
    char *text = NULL, missing[LIST_SIZE] = "";
    size_t size = 0;
    se3d_tyre_coefficients_init(coefficients, SE3D_TYRE_COEFFICIENTS);
    se3di_iopool_init(&pool, &reader->pool->allocator);
    const bool good = se3di_read_attachment(reader, tyre, "file", file, &pool, &text, &size) &&
                      read_lines(&t, text, size) && check_needed(&t);
    se3di_iopool_destroy(&pool);
    if (!good) {
        return false;
    }
    convert(&t);
    def->is_transient = t.is_transient && can_lag(&t);
    def->has_turn_slip = t.has_turn_slip && can_turn(&t);
    list_missing(&t, missing);
    if (is_lateral(&t)) {
        warn(&t, "has no longitudinal force", "PCX1, PDX1 and PKX1 are 0 or missing");
    }
    if (!(fabs(t.c[SE3D_TYRE_QRE0]) > 0.0)) { /* as programs write what was not measured */
        t.c[SE3D_TYRE_QRE0] = 1.0;
        warn(&t, "counts as 1, the radius would vanish without", "Q_RE0 = 0");
    }
    warn(&t, "has no effect here", t.unknown);
    warn(&t, "has no value and counts as missing", t.empty);
    warn(&t, "is missing and counts as without it", missing);
    def->coefficients = coefficients;
    def->coefficient_count = SE3D_TYRE_COEFFICIENTS;
    return true;
}
