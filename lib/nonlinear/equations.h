/* SPDX-License-Identifier: BSD-3-Clause */
/* The equations of a model with their linear solver: what every analysis works on.
 *
 * Each function brings one level of the state in order, at time t, by one KKT system with the mass
 * matrix as weight, so that redundant constraints and underdetermined levels need no special case:
 *
 *     position      min |dq|_M  with  Phi(q + dq, t) = 0       (Newton, line search, damping)
 *     velocity      min |qdot - qdot_0|_M  with  Phi_q qdot = nu
 *     acceleration  M qddot + Phi_q^T lambda = Q,  Phi_q qddot = gamma docs/theory/consistency.md
 */
#ifndef SE3DI_EQUATIONS_H
#define SE3DI_EQUATIONS_H

#include "assembly/assembly.h"
#include "base/guard.h"
#include "linsol/kkt.h"
#include "model/saved.h"
#include "nonlinear/friction_system.h"
#include "primitive/scale.h"
#include "tree/lanes.h"
#include "tree/loops.h"
#include "tree/tree.h"

typedef struct se3di_counters {
    uint64_t steps, rejected, iterations, evaluations, factorizations, solves;
} se3di_counters;

/* What is told of the steps of a run: before one begins, at the model's state, and when it was
 * accepted. INFO_EVENT ends the run at the state that the model is then in. */
typedef struct se3di_watch {
    void *ctx;
    se3d_status (*begin_step)(void *ctx);
    se3d_status (*end_step)(void *ctx);
} se3di_watch;

/* For a method that computes the loops of several states at once. */
typedef struct se3di_loop_lanes {
    se3di_lane_loops rows; /* count 0: loops are not, or cannot be, computed so */
    double *memory;        /* of SE3DI_LANES_MAX states, aligned */
    double *allocated;
    size_t allocated_count;
} se3di_loop_lanes;

typedef struct se3di_equations {
    se3di_assembly assembly;
    se3di_kkt *kkt;
    se3di_counters counters;
    se3di_error *error;            /* where failures are recorded */
    double *b, *c;                 /* right-hand sides [unknowns], [rows] */
    double *x, *l;                 /* solution */
    double *phi;                   /* [rows] */
    double *probe;                 /* [unknowns] */
    se3di_frame *saved;            /* [dense bodies]: poses to come back to within a step */
    se3di_frame *accepted;         /* the last accepted state: frames [dense bodies], */
    double *accepted_acceleration; /* [dense bodies * 6], */
    double *accepted_lambda;       /* [rows] */
    se3di_saved kept;              /* what a step that fails comes back to */
    const se3di_watch *watch;      /* NULL: nobody */
    se3di_guard *guard;            /* NULL: nothing ends a run before its time */
    int32_t iterations_max;        /* of the position Newton */
    int32_t redundant;             /* an acceleration met dependent rows */
    int32_t hold;                  /* positions and velocities of held bodies stay (assembly) */
    int32_t audits;                /* kinematic steps integrate powers to works */
    int32_t keeps;                 /* `kept` is what a failure has to come back to */
    int32_t unfolds; /* poses are assembled: they may leave a stretched chain's line */
    se3di_friction_system friction;
    se3di_tree *tree;        /* joint coordinates, NULL: another formulation */
    se3di_tree_loops loops;  /* its loop constraints, if there are any */
    se3di_loop_lanes lanes;  /* see se3di_equations_take_lanes */
    double *joint_before;    /* [positions of the tree] */
    double *joint_moves;     /* [nodes of the tree * 12] */
    uint64_t masses_version; /* that tree and solver have, */
    uint64_t poses_version;  /* the same */
    int32_t is_open_tree;    /* nothing else constrains it, no force needs a multiplier */
    int32_t has_loops;       /* some constraint is not on the tree */
    int32_t takes_rows;      /* stages take the loops' rows on the tree, not all equations */
    int32_t is_suited;       /* masses_version and poses_version were looked at */
    int32_t is_placed;       /* the links of the tree are at its q and qdot, with poses */
    int32_t joints;          /* what for, and whether they were left at building */
} se3di_equations;

/* moves_states: whether user-defined states are integrated; else they stay as they are. */
se3d_status se3di_equations_init(se3di_equations *equations, se3di_model *model,
                                 const se3di_formulation *formulation, int moves_states,
                                 se3di_error *error);
/* The same in joint coordinates, if explicit methods gain by them: they are the whole motion,
 * friction needs no load, and loops (only if takes_loops) are few clear rows. By the structure
 * alone, so that whoever goes on with a motion decides as it was begun. *picked: they are there;
 * else nothing is held, nor was built what would take far more than the equations of the bodies. */
se3d_status se3di_equations_try_joints(se3di_equations *equations, se3di_model *model,
                                       int takes_loops, se3di_error *error, int *picked);
void se3di_equations_destroy(se3di_equations *equations);
/* What lanes need of loops whose rows come from the links alone, and are clear of each other;
 * nothing of others, nor where a row shares freedoms with too many. @return OK, NO_MEMORY */
se3d_status se3di_equations_take_lanes(se3di_equations *equations);
/* Masses or poses may have changed: rows of light bodies are told from dependent ones by
 * elimination without regularisation, and the tree takes them. */
void se3di_equations_suit_masses(se3di_equations *equations);

/* Evaluate mass and Jacobian at the present state and factor. */
se3d_status se3di_equations_factor(se3di_equations *equations);
/* Factor mass and Jacobian as they have been evaluated. Checked: callbacks have not failed, held
 * bodies stay, the message names the cause. A stage of a step, which may fail, is not checked. */
/* The numbers of equations->kkt: H and C as they are. */
static inline se3di_kkt_values se3di_equations_values(const se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    return (se3di_kkt_values){
        .body = assembly->H, .coupling_upper = assembly->H_pair, .joint = assembly->C};
}
/* The same with other blocks of bodies in the place of H. */
se3di_kkt_values se3di_equations_values_of(se3di_equations *equations, const double *body);
se3d_status se3di_equations_factor_values(se3di_equations *equations, double t, int is_checked);
/* Accelerations and multipliers, x and l, of the state and its mass as evaluated; friction that may
 * stick remains to be added. */
se3d_status se3di_equations_accelerate(se3di_equations *equations, double t, int is_checked);
/* Solve for b, c into x, l. */
se3d_status se3di_equations_solve(se3di_equations *equations);
/* The same by other factors, of `values`. */
se3d_status se3di_equations_solve_by(se3di_equations *equations, se3di_kkt *kkt,
                                     const se3di_kkt_values *values);

/* Consistent levels of the state at t. Positions: @return OK, INCONSISTENT (stationary gap),
 * NO_CONVERGENCE, NOT_FINITE; the poses are then the best ones found, the caller restores. */
se3d_status se3di_position_solve(se3di_equations *equations, double t);
/* The same by few Newton steps only, for a caller that can come nearer: *converged tells.
 * @return OK, NOT_FINITE */
se3d_status se3di_position_correct(se3di_equations *equations, double t, int *converged);
se3d_status se3di_velocity_solve(se3di_equations *equations, double t);
se3d_status se3di_acceleration_solve(se3di_equations *equations, double t);

/* Replace the model's multipliers by those of least 2-norm with the same forces on the bodies,
 * if rows are dependent: those of an integrator hold at a configuration of its own. */
se3d_status se3di_multipliers_reduce(se3di_equations *equations);

/* The largest violation of a position equation relative to its scale, with what is open in words;
 * functions of time evaluated. */
double se3di_position_measure(se3di_equations *equations, char *text, size_t size);

/* Whether a body (dense index) stays where it is. */
static inline int se3di_equations_holds(const se3di_equations *equations, uint32_t body)
{
    return equations->hold && equations->assembly.model->bodies[body].held;
}

/* All three. */
se3d_status se3di_state_solve(se3di_equations *equations, double t);

/* How far the constraints with the present factorisation are from telling all velocities apart: 0
 * to rounding where they do; *body (dense) is the one that can move most. */
se3d_status se3di_equations_probe(se3di_equations *equations, double *worst, uint32_t *body);

/* Fails with SINGULAR if the constraints leave a freedom (motion not determined by the drivers). */
se3d_status se3di_equations_check_determined(se3di_equations *equations);

static inline se3d_status se3di_watch_begin(const se3di_equations *equations)
{
    return equations->watch ? equations->watch->begin_step(equations->watch->ctx) : SE3D_OK;
}

static inline se3d_status se3di_watch_end(const se3di_equations *equations)
{
    return equations->watch ? equations->watch->end_step(equations->watch->ctx) : SE3D_OK;
}

/* Asked in every iteration: fails with INTERRUPTED if the caller wants an end. */
se3d_status se3di_equations_ask(const se3di_equations *equations);
/* Asked before every step from t that is tried: fails with INTERRUPTED, or with STEP_COUNT if
 * the run takes too many. */
se3d_status se3di_equations_try_step(const se3di_equations *equations, double t);

/* Keep and restore the frames of all bodies. */
void se3di_equations_save(se3di_equations *equations);
void se3di_equations_restore(se3di_equations *equations);

/* Keep all that a step reads and writes, history and memories included (particle sets are not), and
 * come back to it, to the bit. @return OK, NO_MEMORY */
se3d_status se3di_equations_keep(se3di_equations *equations);
void se3di_equations_come_back(se3di_equations *equations);

/* Keep and restore the whole state: frames, accelerations, multipliers (not the time). */
void se3di_state_accept(se3di_equations *equations);
void se3di_state_restore(se3di_equations *equations);

#endif
