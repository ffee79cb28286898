/* SPDX-License-Identifier: BSD-3-Clause */
/* Tyre property files: units, what is missing or unknown, and files that are refused. */
#include "support/scratch.h"

#include <math.h>

#define FILE_NAME "se3d_test_tyre.tir"
#define MODEL(more)                                                                                \
    "se3d: 1\n"                                                                                    \
    "bodies: [{name: rim, mass: 10, inertia: [1, 1, 1], position: [0, 0, 0.29],\n"                 \
    "  velocity: [20, -1, 0], angular_velocity: [0, 70, 0]}]\n"                                    \
    "forces: [{name: t, type: tyre, body: rim, file: " FILE_NAME more "}]\n"
#define NEEDED "PCX1 = 1.6\nPDX1=1.2\nPKX1=20\nPCY1= 1.3\nPDY1 =1.1\nPKY1=-15\nPKY2=1.5 $ peak\n"
#define SI                                                                                         \
    "$ comment\n! another\n[MODEL]\nFITTYP = 61\n[UNITS]\nLENGTH='meter'\nFORCE = 'newton'\n"      \
    "[VERTICAL]\nFNOMIN = +4e3\nUNLOADED_RADIUS=.3\nVERTICAL_STIFFNESS = 2.0E+5\n" NEEDED

typedef struct heard {
    char text[2000];
} heard;

static void listen(void *ctx, se3d_log_level level, se3d_log_kind kind, const char *message)
{
    heard *h = ctx;
    if (level == SE3D_LOG_WARNING && kind == SE3D_LOG_FILE) {
        const size_t used = strlen(h->text);
        snprintf(h->text + used, sizeof h->text - used, "%s\n", message);
    }
}

static se3d_model *open_bytes(const char *tir, size_t size, const char *text, heard *h,
                              se3d_model_error *error)
{
    se3d_model *model = NULL;
    se3d_model_options options = se3d_model_options_default();
    options.log = listen;
    options.log_ctx = h;
    h->text[0] = '\0';
    scratch_write(FILE_NAME, tir, size);
    (void)se3d_model_read_text(text, strlen(text), scratch_path("se3d_test.yaml"), &options, &model,
                               error);
    scratch_remove(FILE_NAME);
    return model;
}

static se3d_model *open(const char *tir, const char *text, heard *h, se3d_model_error *error)
{
    return open_bytes(tir, strlen(tir), text, h, error);
}

/* All that it tells. */
static void tell(const char *tir, const char *text, double values[SE3D_TYRE_VALUES])
{
    heard h;
    se3d_model_error error = {0, 0, ""};
    se3d_force force;
    se3d_model *model = open(tir, text, &h, &error);
    CHECK(model != NULL);
    memset(values, 0, SE3D_TYRE_VALUES * sizeof *values);
    if (!model) {
        fprintf(stderr, "%s\n", error.message);
        return;
    }
    se3d_system *system = se3d_model_get_system(model);
    CHECK(!se3d_force_find(system, "t", &force));
    CHECK(!se3d_tyre_get_values(system, force, 0, SE3D_TYRE_VALUES, values));
    se3d_model_destroy(model);
}

static void the_same_tyre_in_other_units_does_the_same(void)
{
    static const char other[] =
        "[MODEL]\nFITTYP=61\n[UNITS]\nLENGTH='mm'\nFORCE='kilonewton'\nANGLE='degrees'\n"
        "FNOMIN=4\nALPMAX=60\nALPMIN=-60\nUNLOADED_RADIUS=300\nVERTICAL_STIFFNESS=0.2\n" NEEDED;
    double si[SE3D_TYRE_VALUES], mm[SE3D_TYRE_VALUES];
    tell(SI, MODEL(""), si);
    tell(other, MODEL(""), mm);
    CHECK_NEAR(si[SE3D_TYRE_FZ], 2000.0, 1e-9);
    CHECK(si[SE3D_TYRE_FX] > 10.0 && si[SE3D_TYRE_FY] > 10.0);
    for (int k = 0; k < SE3D_TYRE_VALUES; ++k) {
        CHECK_NEAR(mm[k], si[k], 1e-9 * (1.0 + fabs(si[k])));
    }
}

/* Of editors of Windows. */
static void marks_and_ends_of_lines_make_no_difference(void)
{
    double plain[SE3D_TYRE_VALUES], other[SE3D_TYRE_VALUES];
    char text[2 * sizeof SI];
    size_t used = 0;
    for (const char *c = SI; *c; ++c) {
        if (*c == '\n') {
            text[used++] = '\r';
        }
        text[used++] = *c;
    }
    text[used] = '\0';
    tell(SI, MODEL(""), plain);
    tell("\xEF\xBB\xBF" SI, MODEL(""), other);
    CHECK(memcmp(plain, other, sizeof plain) == 0);
    tell(text, MODEL(""), other);
    CHECK(memcmp(plain, other, sizeof plain) == 0);
}

static void the_model_file_goes_before_the_tyre_file(void)
{
    double given[SE3D_TYRE_VALUES], file[SE3D_TYRE_VALUES];
    tell(SI, MODEL(""), file);
    tell(SI, MODEL(", k: 1e5, mu: 0.5, model: mf52"), given);
    CHECK_NEAR(given[SE3D_TYRE_FZ], 1000.0, 1e-9);
    CHECK(fabs(given[SE3D_TYRE_FX]) < fabs(file[SE3D_TYRE_FX]));
}

static void refuse_bytes(const char *tir, size_t size, const char *text, const char *part)
{
    heard h;
    se3d_model_error error = {0, 0, ""};
    se3d_model *model = open_bytes(tir, size, text, &h, &error);
    CHECK(!model);
    CHECK(error.line >= 4);
    if (!strstr(error.message, part)) {
        fprintf(stderr, "%s\n  lacks: %s\n", error.message, part);
        CHECK(0);
    }
    se3d_model_destroy(model);
}

static void refuse(const char *tir, const char *text, const char *part)
{
    refuse_bytes(tir, strlen(tir), text, part);
}

/* How many slips lag. */
static size_t count_lags(const char *tir, const char *text)
{
    heard h;
    se3d_model_error error = {0, 0, ""};
    se3d_model *model = open(tir, text, &h, &error);
    CHECK(model != NULL);
    const size_t count = model ? se3d_system_count_states(se3d_model_get_system(model)) : 99;
    se3d_model_destroy(model);
    return count;
}

static int has_turn_slip(const char *tir, const char *text)
{
    heard h;
    se3d_model_error error = {0, 0, ""};
    se3d_model *model = open(tir, text, &h, &error);
    se3d_tyre_def def = se3d_tyre_def_default();
    se3d_force tyre;
    CHECK(model != NULL);
    CHECK(model && !se3d_force_find(se3d_model_get_system(model), "t", &tyre));
    CHECK(model && !se3d_force_get_tyre(se3d_model_get_system(model), tyre, &def));
    se3d_model_destroy(model);
    return def.has_turn_slip;
}

static void slip_lags_where_file_or_model_say_so(void)
{
#define LENGTHS "PTX1 = 1.8\nPTY1=2\nPTY2 = 2\n"
    CHECK(count_lags(SI LENGTHS, MODEL("")) == 0);
    CHECK(count_lags(SI LENGTHS, MODEL(", transient: true")) == 2);
    CHECK(count_lags(SI "USE_MODE = 4\n" LENGTHS, MODEL("")) == 0);
    CHECK(count_lags(SI "USE_MODE = -14\n" LENGTHS, MODEL("")) == 2);
    CHECK(count_lags(SI "USE_MODE = 14\n" LENGTHS, MODEL(", transient: false")) == 0);
    CHECK(count_lags(SI "USE_MODE = 14\n", MODEL("")) == 0);
    CHECK(count_lags(SI, MODEL(", relaxation_y: 0.4")) == 1);
    CHECK(count_lags(SI "LONGITUDINAL_STIFFNESS=3e5\nLATERAL_STIFFNESS = 1e5\n",
                     MODEL(", transient: true")) == 2);
#define TURNING "PHYP1 = 1\nPHYP2 = 0.15\nQCRP1 = 0.2\nQDRP1 = 1\n"
    CHECK(has_turn_slip(SI "USE_MODE = 5\n" TURNING, MODEL("")));
    CHECK(has_turn_slip(SI "USE_MODE = -25\n" TURNING, MODEL("")));
    CHECK(has_turn_slip(SI TURNING, MODEL(", turn_slip: true")));
    CHECK(!has_turn_slip(SI "USE_MODE = 15\n", MODEL("")));
    CHECK(!has_turn_slip(SI "USE_MODE = 14\n" TURNING, MODEL("")));
    CHECK(!has_turn_slip(SI "USE_MODE = 5\n" TURNING, MODEL(", turn_slip: false")));
    refuse(SI, MODEL(", turn_slip: true"), "PHYP1 = 0");
    refuse(SI "PHYP1 = 1\nQCRP1 = 1\n", MODEL(", turn_slip: true"), "PHYP2 = 0");
    refuse(SI "PHYP1 = 1\nQCRP1 = 1\nPHYP2 = 1\nQDRP1 = 2\n", MODEL(", turn_slip: true"),
           "QDRP1 = 2");
    refuse(SI, MODEL(", transient: true"), "neither PTX1 nor LONGITUDINAL_STIFFNESS");
    refuse(SI "PTX1=1\nPTY1 = 1\n", MODEL(", transient: true"), "PTY2");
#undef LENGTHS
}

/* A file whose last digit of USE_MODE asks for turn slip with this instead of one of its lines. */
static void pass_without_turn_slip(const char *lines, const char *part)
{
    heard h;
    char tir[3000];
    se3d_model_error error = {0, 0, ""};
    snprintf(tir, sizeof tir, "%s%s%s", SI "USE_MODE = 15\n" TURNING, lines, "\n");
    CHECK(!has_turn_slip(tir, MODEL("")));
    se3d_model_destroy(open(tir, MODEL(""), &h, &error));
    CHECK(strstr(h.text, "turn slip"));
    if (!strstr(h.text, part)) {
        fprintf(stderr, "%s: %s\n  lacks: %s\n", lines, h.text, part);
        CHECK(0);
    }
    refuse(tir, MODEL(", turn_slip: true"), part);
    se3d_model_destroy(open(tir, MODEL(", turn_slip: false"), &h, &error));
    CHECK(!strstr(h.text, "turn slip"));
}

/* A file whose USE_MODE asks for slip that lags, with these lines about lengths. */
static void pass_without_lags(const char *lines, const char *part)
{
    heard h;
    char tir[3000];
    se3d_model_error error = {0, 0, ""};
    snprintf(tir, sizeof tir, "%s%s", SI "USE_MODE = 14\n", lines);
    CHECK(count_lags(tir, MODEL("")) == 0);
    se3d_model_destroy(open(tir, MODEL(""), &h, &error));
    CHECK(strstr(h.text, "slip that lags") && strstr(h.text, part));
    se3d_model_destroy(open(tir, MODEL(", transient: false"), &h, &error));
    CHECK(!strstr(h.text, "slip that lags"));
    CHECK(count_lags(tir, MODEL(", relaxation_x: 0.3, relaxation_y: 0.3")) == 2);
}

static void lags_without_lengths_are_left_out(void)
{
    heard h;
    se3d_model_error error = {0, 0, ""};
    pass_without_lags("", "PTX1 or LONGITUDINAL_STIFFNESS, PTY1 or LATERAL_STIFFNESS");
    pass_without_lags("PTX1 = 0\nPTY1 = 2\nPTY2 = 2\n", ": PTX1 or LONGITUDINAL_STIFFNESS\n");
    pass_without_lags("PTX1 = 1.8\nPTY1 = 2\n", ": PTY2\n");
    pass_without_lags("PTX1 = 1.8\nLATERAL_STIFFNESS = -1\n", ": PTY1 or LATERAL_STIFFNESS\n");
    CHECK(count_lags(SI "USE_MODE = 14\nPTX1 = 1.8\n", MODEL(", relaxation_y: 0.3")) == 2);
    se3d_model_destroy(
        open(SI "USE_MODE = 14\nPTX1 = 1\nLATERAL_STIFFNESS = 1e5\n", MODEL(""), &h, &error));
    CHECK(!strstr(h.text, "slip that lags"));
}

static void turn_slip_that_lacks_something_is_left_out(void)
{
    heard h;
    se3d_model_error error = {0, 0, ""};
    pass_without_turn_slip("PHYP1 = 0", "PHYP1 = 0");
    pass_without_turn_slip("PHYP1 = -1", "PHYP1 = -1");
    pass_without_turn_slip("PHYP2 = 0", "PHYP2 = 0");
    pass_without_turn_slip("QCRP1 = 0", "QCRP1 = 0");
    pass_without_turn_slip("LMP = 0", "LMP = 0");
    pass_without_turn_slip("QDRP1 = 0", "QDRP1 = 0");
    pass_without_turn_slip("QDRP1 = 0.009", "QDRP1 = 0.009");
    pass_without_turn_slip("QDRP1 = 2", "QDRP1 = 2");
    CHECK(has_turn_slip(SI "USE_MODE = 15\n" TURNING "QDRP1 = 0.01\n", MODEL("")));
    CHECK(has_turn_slip(SI "USE_MODE = 15\n" TURNING "QDRP1 = 1.99\n", MODEL("")));
    CHECK(has_turn_slip(SI "USE_MODE = 15\n" TURNING "PHYP2 = -0.1\n", MODEL("")));
    CHECK(!has_turn_slip(SI "USE_MODE = 15\nPHYP2 = 0.15\nQCRP1 = 0.2\n", MODEL("")));
    se3d_model_destroy(open(SI "USE_MODE = 5\nPHYP2 = 1\n", MODEL(""), &h, &error));
    CHECK(strstr(h.text, "PHYP1 = 0") && strstr(h.text, "QCRP1 = 0") &&
          strstr(h.text, "QDRP1 = 0") && !strstr(h.text, "PHYP2") && !strstr(h.text, "LMP"));
    se3d_model_destroy(open(SI "USE_MODE = 5\n" TURNING, MODEL(""), &h, &error));
    CHECK(!strstr(h.text, "turn slip"));
#undef TURNING
}

static void what_is_unknown_or_missing_is_told(void)
{
    heard h;
    se3d_model_error error = {0, 0, ""};
    se3d_model *model =
        open(SI "QUARK = 3\n[SHAPE]\n{radial width}\n1.0 0.0\n", MODEL(""), &h, &error);
    CHECK(model != NULL);
    CHECK(strstr(h.text, "QUARK") && strstr(h.text, "has no effect here"));
    CHECK(strstr(h.text, "PDX2") && strstr(h.text, "missing"));
    CHECK(!strstr(h.text, "PHY3") && !strstr(h.text, "PCX1"));
    se3d_model_destroy(model);
}

/* Fitting programs write keys that they know nothing about. */
static void a_key_without_a_value_counts_as_missing(void)
{
    heard h;
    se3d_model_error error = {0, 0, ""};
    const char *file = SI "PDX2 =\nINFLPRES =    $ not measured\nWIDTH = ''\n";
    se3d_model *model = open(file, MODEL(""), &h, &error);
    CHECK(model != NULL);
    CHECK(strstr(h.text, "has no value and counts as missing: PDX2, INFLPRES, WIDTH"));
    CHECK(strstr(h.text, "is missing and counts as without it: PDX2"));
    se3d_model_destroy(model);
    refuse("FITTYP=6\nFNOMIN=\n" NEEDED, MODEL(""), "lacks what a Magic Formula needs: FNOMIN");
}

/* A file of lateral tests. */
static void a_tyre_without_longitudinal_force_is_told(void)
{
    static const char lateral[] =
        "FITTYP = 61\nFNOMIN = 4e3\nUNLOADED_RADIUS = .3\nVERTICAL_STIFFNESS = 2e5\nPCX1 = 0\n"
        "Q_RE0 = 0\nPCY1 = 1.3\nPDY1 = 1\nPKY1 = -20\nPKY2 = 2\n";
    heard h;
    se3d_model_error error = {0, 0, ""};
    double values[SE3D_TYRE_VALUES];
    se3d_model_destroy(open(lateral, MODEL(""), &h, &error));
    CHECK(strstr(h.text, "has no longitudinal force: PCX1, PDX1 and PKX1 are 0 or missing"));
    CHECK(strstr(h.text, "counts as 1, the radius would vanish without: Q_RE0 = 0"));
    tell(lateral, MODEL(""), values);
    CHECK(!(fabs(values[SE3D_TYRE_FX]) > 0.0));
    CHECK(fabs(values[SE3D_TYRE_FY]) > 1.0 && isfinite(values[SE3D_TYRE_MZ]));
    CHECK_NEAR(values[SE3D_TYRE_ROLLING_RADIUS], 0.3 - 0.01 / 3.0, 1e-9);
    refuse("FITTYP=6\nFNOMIN=1\nPCX1=1\nPCY1=1\nPDY1=1\nPKY1=1\nPKY2=1\n", MODEL(""),
           "lacks what a Magic Formula needs: PDX1, PKX1");
}

static void files_of_other_kinds_are_refused(void)
{
    static const char binary[] = SI "PDX2 = 1\0\n"; /* without the byte it is a good file */
    refuse(SI "PDX2 = 1.2.3\n", MODEL(""), "line 19: PDX2 must be a number");
    refuse(SI "PDX2 = nan\n", MODEL(""), "must be a number");
    refuse(SI "PDX2 = 1e999\n", MODEL(""), "PDX2");
    refuse(SI "PDX2 = 0x10\n", MODEL(""), "must be a number");
    refuse(SI "PDX2 1\n", MODEL(""), "must be KEY = value");
    refuse(SI "= 1\n", MODEL(""), "must have a key");
    refuse(SI "[OPEN\n", MODEL(""), "must be a section");
    refuse(SI "FORCE = 'ounce'\n", MODEL(""), "`ounce` is no unit, allowed are: newton");
    refuse(SI "FITTYP = 94\n", MODEL(""), "FITTYP must be 5, 6");
    refuse("[MODEL]\nFITTYP=6\nFNOMIN=1\n", MODEL(""), "PCY1, PDY1, PKY1, PKY2");
    refuse("FNOMIN=4000\n" NEEDED, MODEL(""), "FITTYP");
    refuse("FITTYP=6\nFNOMIN=4000\n" NEEDED, MODEL(""), "radius");
    refuse("FITTYP=6\nFNOMIN=-4000\nUNLOADED_RADIUS=.3\nVERTICAL_STIFFNESS=1e5\n" NEEDED, MODEL(""),
           "FNOMIN");
    refuse(SI, MODEL(", model: brush"), "only mf52 and mf61");
    refuse(SI "PDX1 = 0\n", MODEL(""), "PDX1 = 0, must not be 0");
    refuse_bytes(binary, sizeof binary - 1, MODEL(""), "has a zero byte, must be text");
}

int main(void)
{
    RUN(the_same_tyre_in_other_units_does_the_same);
    RUN(marks_and_ends_of_lines_make_no_difference);
    RUN(the_model_file_goes_before_the_tyre_file);
    RUN(what_is_unknown_or_missing_is_told);
    RUN(slip_lags_where_file_or_model_say_so);
    RUN(lags_without_lengths_are_left_out);
    RUN(turn_slip_that_lacks_something_is_left_out);
    RUN(a_key_without_a_value_counts_as_missing);
    RUN(a_tyre_without_longitudinal_force_is_told);
    RUN(files_of_other_kinds_are_refused);
    return check_finish();
}
