/* SPDX-License-Identifier: BSD-3-Clause */
/* What is said of a four-bar that is given open, or whose links do not reach. */
#include "support/text_model.h"

#include "se3d/modes.h"

#define FOURBAR(ground)                                                                            \
    "se3d: 1\nbodies:\n"                                                                           \
    "  - {name: c1, mass: 1, inertia: [0.01, 0.1, 0.1], position: [0, 0, 0.25]}\n"                 \
    "  - {name: c2, mass: 1, inertia: [0.01, 0.1, 0.1], position: [1, 0, 0.2]}\n"                  \
    "  - {name: c3, mass: 1, inertia: [0.01, 0.1, 0.1], position: [3, 0, 0.5]}\njoints:\n"         \
    "  - {name: a, type: revolute, body_i: ground, body_j: c1, point_i: [0, 0, 0], point_j: [0, "  \
    "0, -0.25], axis_i: [0, 1, 0], axis_j: [0, 1, 0]}\n"                                           \
    "  - {name: b, type: revolute, body_i: c1, body_j: c2, point_i: [0, 0, 0.25], point_j: "       \
    "[-0.5, 0, 0], axis_i: [0, 1, 0], axis_j: [0, 1, 0]}\n"                                        \
    "  - {name: c, type: revolute, body_i: c2, body_j: c3, point_i: [0.5, 0, 0], point_j: [0, 0, " \
    "0.5], axis_i: [0, 1, 0], axis_j: [0, 1, 0]}\n"                                                \
    "  - {name: d, type: revolute, body_i: ground, body_j: c3, point_i: [" ground ", 0, 0], "      \
    "point_j: [0, 0, -0.5], axis_i: [0, 1, 0], axis_j: [0, 1, 0]}\nanalysis: {type: assembly}\n"   \
    "output: []\n"

/* "... is open by 0.5 m, spread over its loop (a ...": the number. */
static double missing(const char *text)
{
    const char *at = strstr(text, "is open by ");
    CHECK_CONTAINS(text, "m, spread over its loop (a ");
    return at ? strtod(at + 11, NULL) : 0.0;
}

/* Links of 0.5, 1 and 1 over 3 m: half a metre is missing, to five digits. */
static void links_that_do_not_reach_are_named_with_what_is_missing(void)
{
    for (int rp = 0; rp < 2; ++rp) {
        text_model m = text_model_open(FOURBAR("3"), -1, rp, 0.0);
        CHECK(se3d_solver_run(m.solver, 0.0) == SE3D_ERR_INCONSISTENT);
        CHECK_NEAR(missing(se3d_system_get_error(m.system)), 0.5, 1e-5);
        text_model_close(&m);
        m = text_model_open(FOURBAR("4"), -1, rp, 0.0);
        CHECK(se3d_solver_run(m.solver, 0.0) == SE3D_ERR_INCONSISTENT);
        CHECK_NEAR(missing(se3d_system_get_error(m.system)), 1.5, 1e-5);
        text_model_close(&m);
    }
}

static const char *first_message(const se3d_check *check)
{
    const char *text = "";
    CHECK(!se3d_check_get_message(check, 0, &text));
    return text;
}

/* The given poses: c is open by |(1.5, 0.2) - (3, 1)| = 1.7 m, which is not the loop's sum. */
static void check_tells_open_poses_from_links_that_do_not_reach(void)
{
    text_model m = text_model_open(FOURBAR("2.5"), -1, 0, 0.0);
    se3d_check *check = NULL;
    CHECK(se3d_check_create(m.system, &check) >= 0);
    CHECK_CONTAINS(first_message(check),
                   "c is open by 1.7 m (of all: b 0.583 m, c 1.7 m, d 0.5 m)");
    se3d_check_destroy(check);
    text_model_close(&m);
    m = text_model_open(FOURBAR("2.501"), -1, 0, 0.0); /* stretched by a millimetre too much */
    CHECK(se3d_check_create(m.system, &check) >= 0);
    CHECK_NEAR(missing(first_message(check)), 1e-3, 1e-6);
    se3d_check_destroy(check);
    text_model_close(&m);
}

static void modes_of_open_poses_are_refused(void)
{
    text_model m = text_model_open(FOURBAR("2.5"), -1, 0, 0.0);
    se3d_modes *modes = NULL;
    CHECK(se3d_modes_create(m.system, NULL, &modes) == SE3D_ERR_INCONSISTENT && !modes);
    CHECK_CONTAINS(se3d_system_get_error(m.system), "c is open by 1.7 m");
    CHECK_CONTAINS(se3d_system_get_error(m.system), "before modes");
    CHECK(text_model_run(&m, 0.0));
    CHECK(se3d_modes_create(m.system, NULL, &modes) >= 0);
    se3d_modes_destroy(modes);
    text_model_close(&m);
}

/* Given exactly stretched, the poses of least violation are so along their line: two links of 1 m
 * with 1.8 m between their ends, and three over 2.2 m in space. */
static const char *const stretched[] = {
    "se3d: 1\nbodies:\n"
    "  - {name: a, mass: 1, inertia: [1, 1, 1], position: [0.5, 0, 0]}\n"
    "  - {name: b, mass: 1, inertia: [1, 1, 1], position: [1.5, 0, 0]}\njoints:\n"
    "  - {type: revolute, body_i: ground, body_j: a, point_i: [0, 0, 0], point_j: [-0.5, 0, 0], "
    "axis_i: [0, 1, 0], axis_j: [0, 1, 0]}\n"
    "  - {type: revolute, body_i: a, body_j: b, point_i: [0.5, 0, 0], point_j: [-0.5, 0, 0], "
    "axis_i: [0, 1, 0], axis_j: [0, 1, 0]}\n"
    "  - {type: revolute, body_i: ground, body_j: b, point_i: [1.8, 0, 0], point_j: [0.5, 0, 0], "
    "axis_i: [0, 1, 0], axis_j: [0, 1, 0]}\n"
    "analysis: {type: assembly}\noutput: []\n",
    "se3d: 1\nbodies:\n"
    "  - {name: a, mass: 1, inertia: [1, 1, 1], position: [0, 0, 0.5]}\n"
    "  - {name: b, mass: 1, inertia: [1, 1, 1], position: [0, 0, 1.5]}\n"
    "  - {name: c, mass: 1, inertia: [1, 1, 1], position: [0, 0, 2.5]}\njoints:\n"
    "  - {type: spherical, body_i: ground, body_j: a, point_i: [0, 0, 0], point_j: [0, 0, -0.5]}\n"
    "  - {type: spherical, body_i: a, body_j: b, point_i: [0, 0, 0.5], point_j: [0, 0, -0.5]}\n"
    "  - {type: spherical, body_i: b, body_j: c, point_i: [0, 0, 0.5], point_j: [0, 0, -0.5]}\n"
    "  - {type: spherical, body_i: ground, body_j: c, point_i: [0, 0, 2.2], point_j: [0, 0, 0.5]}\n"
    "analysis: {type: assembly}\noutput: []\n"};

static void a_chain_that_is_given_stretched_folds(void)
{
    static const int32_t analyses[] = {SE3D_ANALYSIS_ASSEMBLY, SE3D_ANALYSIS_DYNAMICS,
                                       SE3D_ANALYSIS_EQUILIBRIUM};
    for (size_t k = 0; k < sizeof stretched / sizeof *stretched; ++k) {
        for (size_t a = 0; a < sizeof analyses / sizeof *analyses; ++a) {
            for (int32_t f = 0; f <= SE3D_FORMULATION_JOINT; ++f) {
                text_model m = text_model_open(stretched[k], -1, f, 0.0);
                se3d_solver_def def = se3d_solver_def_default();
                double off[3];
                def.analysis = analyses[a];
                def.formulation = f;
                se3d_solver_destroy(m.solver);
                CHECK(!se3d_solver_create(m.system, &def, &m.solver));
                CHECK(se3d_solver_run(m.solver, 0.0) >= 0);
                CHECK(!se3d_system_get_violation(m.system, off));
                CHECK(off[0] < 1e-10);
                text_model_close(&m);
            }
        }
        text_model m = text_model_open(stretched[k], -1, 0, 0.0);
        se3d_check *check = NULL;
        se3d_check_summary sum = {.struct_size = sizeof sum, .inconsistent = 1};
        CHECK(se3d_check_create(m.system, &check) >= 0 && !se3d_check_get_summary(check, &sum));
        CHECK(sum.inconsistent == 0);
        se3d_check_destroy(check);
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(modes_of_open_poses_are_refused);
    RUN(a_chain_that_is_given_stretched_folds);
    RUN(links_that_do_not_reach_are_named_with_what_is_missing);
    RUN(check_tells_open_poses_from_links_that_do_not_reach);
    return check_finish();
}
