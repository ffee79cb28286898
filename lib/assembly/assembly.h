/* SPDX-License-Identifier: BSD-3-Clause */
/* The equations of a model in one formulation: numbering, the KKT pattern, and the evaluation of
 *
 *     [M   Phi_q^T] [qddot ]   [Q + velocity terms]
 *     [Phi_q      ] [lambda] = [gamma             ]
 *
 * and of its position- and velocity-level relatives. Bodies that move are numbered 0 .. body_count
 * - 1 ("free bodies"); every constraint of the model is a joint of the KKT pattern, so that
 * equation rows are numbered as in the model. The forces of constraints on the bodies are -Phi_q^T
 * lambda.
 *
 * Vectors over free bodies have `block` numbers per body (with normalisation).
 * docs/theory/assembly.md */
#ifndef SE3DI_ASSEMBLY_H
#define SE3DI_ASSEMBLY_H

#include "force/force.h"
#include "formulation/formulation.h"

/* The places of a term's blocks in the joint's row of the KKT matrix; -1: the body is fixed. */
typedef struct se3di_term_place {
    int32_t slot_i, slot_j; /* block within its joint */
} se3di_term_place;

/* An armature among the force elements, and which of the coupled pairs its bodies are, -1: one of
 * them is fixed. */
typedef struct se3di_armature_place {
    uint32_t force;
    int32_t pair;
} se3di_armature_place;

typedef struct se3di_assembly {
    se3di_model *model;
    const se3di_formulation *formulation;
    uint64_t topology_version; /* of the model this was built for, */
    uint64_t break_version;    /* and that, too */
    uint32_t body_count;       /* free bodies */
    uint32_t row_count;        /* constraint equations */
    uint32_t unknown_count;    /* body_count * block */
    uint32_t *free_body;       /* free -> dense */
    int32_t *free_index;       /* dense -> free, -1: fixed */
    int32_t *joint_rows;       /* equations of each constraint */
    int32_t *joint_begin;      /* [constraints + 1] into joint_body */
    int32_t *joint_body;       /* free bodies of each constraint, none twice */
    size_t *block_offset;      /* of each block in C, indexed as joint_body */
    size_t joint_value_count;  /* doubles of C */
    se3di_term_place *places;  /* [terms] */
    int8_t *is_fused;          /* [constraints]: evaluated by assembly/fused.h */
    uint32_t *timed_rows;      /* rows with a function of time */
    uint32_t timed_count;
    uint32_t constraint_count, place_count, dense_count, joint_body_count;
    double *H;       /* body blocks */
    double *H_pair;  /* of the bodies that armatures couple: rows of the first, columns of the
                            second */
    double *C;       /* joint blocks */
    double *f;       /* [rows * 3] jets of the functions of time */
    double *wrench;  /* [dense bodies * 6] */
    double power[2]; /* of gravity and elements with it: dissipated, fed in [W] */
    double contact_power[2]; /* the same of contacts of bodies, of the last loads */
    const double *push;  /* the same, from outside the model's elements (particles); NULL: none */
    double time;         /* of the last evaluation, and of its functions of time */
    uint32_t user_count; /* constraints with a callback */
    uint32_t reserved;
    int32_t levels; /* H weighs all bodies alike: for motions that the constraints determine */
    int32_t moves_states; /* carriers of states are among the free bodies */
    size_t tree_count;    /* positions and velocities of the tree of joints; 0: there is none */
    double like_mass;     /* [kg] of each body then: the mean, */
    double like_inertia;  /* [kg m^2] */
    uint32_t armature_count, armature_pair_count;
    se3di_armature_place *armature;
    int32_t *armature_pair; /* [2 * pairs] free bodies i < j, increasing */
} se3di_assembly;

/* Build the structure; moves_states 0: user-defined states stay as they are. On failure nothing is
 * held. */
se3d_status se3di_assembly_init(se3di_assembly *assembly, se3di_model *model,
                                const se3di_formulation *formulation, int moves_states,
                                se3di_error *error);
void se3di_assembly_destroy(se3di_assembly *assembly);

/* Functions of time at t, for all that follows. */
/* Take the prescribed values of rows without a function from the model, if they have changed. */
void se3di_assembly_take_values(se3di_assembly *assembly);
se3d_status se3di_assembly_eval_functions(se3di_assembly *assembly, double t, se3di_error *error);
/* Phi [rows]; with `functions` evaluated. */
void se3di_assembly_eval_phi(const se3di_assembly *assembly, double *phi);
/* Phi_q into C. */
void se3di_assembly_eval_jacobian(se3di_assembly *assembly);
/* gamma [rows]. */
void se3di_assembly_eval_gamma(const se3di_assembly *assembly, double *gamma);
/* Both, in one pass. */
void se3di_assembly_eval_rows(se3di_assembly *assembly, double *gamma);
/* The same for some constraints only; the others' blocks and gamma are left as they are. */
void se3di_assembly_eval_some_rows(se3di_assembly *assembly, const uint32_t *constraints,
                                   uint32_t count, double *gamma);
/* Mass blocks into H, or equal ones if it `levels`. */
void se3di_assembly_eval_mass(se3di_assembly *assembly);
/* H does not change with the state: blocks of bodies in r-omega alone. */
static inline int se3di_assembly_is_plain(const se3di_assembly *assembly)
{
    return assembly->formulation->block == 6 && assembly->armature_count == 0;
}
/* The same for methods whose H is constant without armatures. */
void se3di_assembly_follow_mass(se3di_assembly *assembly);
/* From now on H weighs all bodies alike: by their mean mass, and by how far joints are from the
 * centres of the bodies that move (1 m if they are at the centres). */
void se3di_assembly_level(se3di_assembly *assembly);
/* out [unknowns] -= M x, M the mass whatever H is. */
void se3di_assembly_subtract_inertia(const se3di_assembly *assembly, const double *x, double *out);
/* What gravity and force elements do to the bodies: `wrench`. */
se3d_status se3di_assembly_eval_elements(se3di_assembly *assembly, double t, se3di_error *error);
/* What acts on the bodies, contacts included: `wrench`. */
se3d_status se3di_assembly_eval_wrenches(se3di_assembly *assembly, double t, se3di_error *error);
/* The same with the powers of elements, and with efforts along known coordinates apart from
 * `wrench`, which sums->wrench becomes. */
se3d_status se3di_assembly_sum_loads(se3di_assembly *assembly, double t, se3di_force_sums *sums,
                                     se3di_error *error);
/* The same, and velocity terms, into b [unknowns]. */
se3d_status se3di_assembly_eval_forces(se3di_assembly *assembly, double t, double *b,
                                       se3di_error *error);

/* out [unknowns] = H x */
void se3di_assembly_mul_mass(const se3di_assembly *assembly, const double *x, double *out);
/* out [unknowns] -= H x */
void se3di_assembly_subtract_mass(const se3di_assembly *assembly, const double *x, double *out);
/* out [rows] = C x, x [unknowns] */
void se3di_assembly_mul(const se3di_assembly *assembly, const double *x, double *out);
/* out [unknowns] += scale C^T l */
void se3di_assembly_add_transposed(const se3di_assembly *assembly, double scale, const double *l,
                                   double *out);

/* Velocities and accelerations of the free bodies as vectors over unknowns (normalisation entry 0).
 */
void se3di_assembly_get_velocity(const se3di_assembly *assembly, double *qdot);
void se3di_assembly_set_velocity(se3di_assembly *assembly, const double *qdot);
void se3di_assembly_get_acceleration(const se3di_assembly *assembly, double *qddot);
void se3di_assembly_set_acceleration(se3di_assembly *assembly, const double *qddot);

/* The model's structure is still the one that this was built for. */
static inline int se3di_assembly_fits(const se3di_assembly *assembly)
{
    return assembly->topology_version == assembly->model->topology_version &&
           assembly->break_version == assembly->model->break_version;
}

/* Name of a row: "pin.cd_x", or "joint 3.cd_x" if the constraint has no name. */
void se3di_row_name(const se3di_model *model, uint32_t row, char *text, size_t size);

#endif
