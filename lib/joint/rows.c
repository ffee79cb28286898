/* SPDX-License-Identifier: BSD-3-Clause */
#include "joint/rows.h"

#include "math/vec3.h"

#include <assert.h>
#include <string.h>

void se3di_draft_init(se3di_draft *draft, const char *type, const char *name, uint32_t body_i,
                      uint32_t body_j)
{
    *draft = (se3di_draft){.constraint = {.type = type, .body_count = 2, .angle = -1, .law = -1}};
    memcpy(&draft->constraint.name, &name, sizeof name); /* copied by the model, never written */
    draft->constraint.bodies[0] = body_i;
    draft->constraint.bodies[1] = body_j;
    for (int k = 0; k < SE3D_COUPLER_TERMS_MAX; ++k) {
        draft->constraint.joints[k] = -1;
    }
}

se3di_row *se3di_draft_add_row(se3di_draft *draft, const char *name, double value)
{
    assert(draft->row_count < SE3DI_DRAFT_ROWS);
    draft->constraint.pattern = SE3DI_PATTERN_NONE; /* those who add a pattern set it behind */
    se3di_row *row = &draft->rows[draft->row_count++];
    *row =
        (se3di_row){.name = name, .term_begin = draft->term_count, .function = -1, .value = value};
    return row;
}

void se3di_draft_add_term(se3di_draft *draft, const se3di_term *term, double coefficient)
{
    assert(draft->row_count > 0 && draft->term_count < SE3DI_DRAFT_TERMS);
    draft->terms[draft->term_count] = *term;
    draft->terms[draft->term_count++].coefficient = coefficient;
    ++draft->rows[draft->row_count - 1].term_count;
}

/* A term between the draft's bodies at its joint points, without directions. */
static se3di_term term_between(const se3di_draft *draft, se3di_primitive_type type)
{
    const se3di_constraint *c = &draft->constraint;
    se3di_term term = {
        .type = (int32_t)type, .angle = -1, .body_i = c->bodies[0], .body_j = c->bodies[1]};
    se3di_copy(c->frames.point_i, term.s_i);
    se3di_copy(c->frames.point_j, term.s_j);
    return term;
}

/* A row of one term. */
static void add_row_of(se3di_draft *draft, const char *name, double value, const se3di_term *term)
{
    se3di_draft_add_row(draft, name, value);
    se3di_draft_add_term(draft, term, 1.0);
}

/* A row of two directions. */
static void add_row_between(se3di_draft *draft, se3di_primitive_type type, const char *name,
                            const double a_i[3], const double a_j[3])
{
    se3di_term term = term_between(draft, type);
    se3di_copy(a_i, term.a_i);
    se3di_copy(a_j, term.a_j);
    add_row_of(draft, name, 0.0, &term);
}

void se3di_row_add_dp1(se3di_draft *draft, const char *name, const double a_i[3],
                       const double a_j[3])
{
    add_row_between(draft, SE3DI_PRIMITIVE_DP1, name, a_i, a_j);
}

void se3di_row_add_dp2(se3di_draft *draft, const char *name, const double a_i[3])
{
    se3di_term term = term_between(draft, SE3DI_PRIMITIVE_DP2);
    se3di_copy(a_i, term.a_i);
    add_row_of(draft, name, 0.0, &term);
}

void se3di_row_add_triple(se3di_draft *draft, const char *name, const double a_i[3],
                          const double a_j[3])
{
    add_row_between(draft, SE3DI_PRIMITIVE_TRIPLE, name, a_i, a_j);
}

void se3di_row_add_d(se3di_draft *draft, double distance)
{
    se3di_term term = term_between(draft, SE3DI_PRIMITIVE_D);
    add_row_of(draft, "d", distance * distance, &term);
}

void se3di_row_add_spherical(se3di_draft *draft)
{
    static const char *const names[3] = {"cd_x", "cd_y", "cd_z"};
    const int is_first = draft->row_count == 0;
    for (int k = 0; k < 3; ++k) {
        se3di_term term = term_between(draft, SE3DI_PRIMITIVE_CD);
        term.c[k] = 1.0;
        add_row_of(draft, names[k], 0.0, &term);
    }
    draft->constraint.pattern = is_first ? SE3DI_PATTERN_POINT : SE3DI_PATTERN_NONE;
}

void se3di_row_add_perpendicular1(se3di_draft *draft)
{
    const se3di_joint_frames *f = &draft->constraint.frames;
    const int is_point = draft->constraint.pattern == SE3DI_PATTERN_POINT;
    se3di_row_add_dp1(draft, "dp1_a", f->ref_i, f->axis_j);
    se3di_row_add_dp1(draft, "dp1_b", f->third_i, f->axis_j);
    draft->constraint.pattern = is_point ? SE3DI_PATTERN_HINGE : SE3DI_PATTERN_NONE;
}

void se3di_row_add_perpendicular2(se3di_draft *draft)
{
    const se3di_joint_frames *f = &draft->constraint.frames;
    se3di_row_add_dp2(draft, "dp2_a", f->ref_i);
    se3di_row_add_dp2(draft, "dp2_b", f->third_i);
}

void se3di_row_add_orientation(se3di_draft *draft)
{
    const se3di_joint_frames *f = &draft->constraint.frames;
    se3di_row_add_dp1(draft, "dp1_a", f->ref_i, f->axis_j);
    se3di_row_add_dp1(draft, "dp1_b", f->third_i, f->axis_j);
    se3di_row_add_dp1(draft, "dp1_c", f->ref_i, f->third_j);
}

void se3di_displacement_term_init(se3di_term *term, const se3di_joint_frames *frames,
                                  const uint32_t bodies[2])
{
    *term = (se3di_term){.type = SE3DI_PRIMITIVE_DP2,
                         .angle = -1,
                         .coefficient = 1.0,
                         .body_i = bodies[0],
                         .body_j = bodies[1]};
    se3di_copy(frames->axis_i, term->a_i);
    se3di_copy(frames->point_i, term->s_i);
    se3di_copy(frames->point_j, term->s_j);
}
