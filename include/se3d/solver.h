/* SPDX-License-Identifier: BSD-3-Clause */
/* Solvers: one analysis of one system.
 *
 * Threads: the rule of se3d/se3d.h; what needs a solver for itself needs its system, too. */
#ifndef SE3D_SOLVER_H
#define SE3D_SOLVER_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The analysis of a solver. @since 0.1 */
typedef enum se3d_analysis {
    SE3D_ANALYSIS_ASSEMBLY = 0,         /* consistent positions, velocities, accelerations */
    SE3D_ANALYSIS_KINEMATICS = 1,       /* motion under drivers: no forces needed */
    SE3D_ANALYSIS_INVERSE_DYNAMICS = 2, /* motion under drivers, with reactions and efforts */
    SE3D_ANALYSIS_DYNAMICS = 3,         /* motion under forces */
    SE3D_ANALYSIS_EQUILIBRIUM = 4       /* static position */
} se3d_analysis;

/* Get the name of an analysis as in a model file ("assembly", "dynamics"). The analyses have the
 * numbers from 0 to the one before the first without a name.
 * @param[in] analysis  se3d_analysis, or any number
 * @return the name, static; "" if no analysis has that number.
 * @since 0.1 */
SE3D_API const char *se3d_analysis_get_name(int32_t analysis);

/* How a solver of dynamics steps in time. AUTO takes verlet with particles; convex, of order 1,
 * from where ten free bodies or more are at others, if nothing acts on them but constant gravity,
 * no tolerance is given and no step above 5 ms; radau with strong dampers; gauss where nothing but
 * constant gravity acts on an open tree of joints, or, at tolerances from 2.3e-10 on, on loops of
 * plane pins and balls, in joint coordinates (single steps of given length: dop853); else dop853,
 * which it leaves for radau if stability limits the steps, and radau for it where they would be
 * stable; both for convex if contacts of three free bodies or more alone make their steps very
 * short. @since 0.1 */
typedef enum se3d_method {
    SE3D_METHOD_AUTO = 0,
    SE3D_METHOD_GENERALIZED_ALPHA = 1,
    SE3D_METHOD_HHT = 2,
    SE3D_METHOD_DOP853 = 3,
    SE3D_METHOD_RK45 = 4,
    SE3D_METHOD_BDF = 5,
    SE3D_METHOD_RADAU = 6,
    SE3D_METHOD_RATTLE = 7,
    SE3D_METHOD_VERLET = 8,
    SE3D_METHOD_RK4 = 9,
    SE3D_METHOD_CONVEX = 10,
    SE3D_METHOD_GAUSS = 11
} se3d_method;

/* Get the name of a method as in a model file ("auto", "dop853"). The methods have the numbers from
 * 0 to the one before the first without a name.
 * @param[in] method  se3d_method, or any number
 * @return the name, static; "" if no method has that number.
 * @since 0.1 */
SE3D_API const char *se3d_method_get_name(int32_t method);

/* Get the name of a formulation as in a model file ("romega", "rp", "joint", "auto").
 * @param[in] formulation  se3d_formulation, or any number
 * @return the name, static; "" if no formulation has that number.
 * @since 0.1 */
SE3D_API const char *se3d_formulation_get_name(int32_t formulation);

/* The definition of a solver. @since 0.1 */
typedef struct se3d_solver_def {
    size_t struct_size;
    int32_t analysis;    /* se3d_analysis, default DYNAMICS */
    int32_t formulation; /* se3d_formulation, default AUTO */
    int32_t method;      /* se3d_method, dynamics only, default AUTO */
    /* bdf: 1..5, rattle: 2, 4, gauss: 8, 16, others: the one they have. 0: the default, of gauss 16
     * for tolerances below 1e-6; where only constant gravity acts on what it integrates in joint
     * coordinates in lanes, below 3e-6 on open trees of 8 freedoms or more, below 1e-3 on smaller
     * ones, and at every tolerance on loops; else, and where its iterations have failed, 8 */
    int32_t order;
    /* Of generalized_alpha, hht, rattle, verlet, convex: fixed; of the others: the largest one;
     * >= 1e-15 [s]; 0: chosen by the error. What a fixed one errs by nobody knows before it is
     * compared with one twice as long (se3d_run_options.estimate, docs/theory/estimates.md). rattle
     * and verlet choose equal steps once, to the tolerance, by trial steps ahead
     * (se3d_solver_get_step); contacts and stops shorten them, and where they turn out to be too
     * long they are halved and the log is warned. Beside particles verlet takes at most 1 ms.
     * convex: 1 ms, less if force elements are stiff, or, if a tolerance is given, by the error. */
    double step;
    double tolerance;       /* relative error if steps are chosen, 1e-14..0.1; 0: 1e-6. Below what a
                               method reaches it works at that (se3d_solver_get_tolerance) */
    double spectral_radius; /* generalized_alpha: at infinite frequency, 0..1, default 0.9 */
    double alpha;           /* hht: -1/3..0, default -0.1 */
    size_t iterations_max;  /* Newton iterations per step; 0: 25 */
    uint64_t steps_max;     /* steps that a run may try; 0: 1e9 */
    double horizon;         /* if runs go on to this time [s], their steps are counted together and
                       foreseen up to it; 0, or not after t_end: each run by itself */
    se3d_interrupt interrupt; /* asked whether a run is to end now; NULL: none */
    void *interrupt_ctx;      /* of `interrupt` */
    int32_t sleep;    /* convex: not 0: bodies that have been at rest for .25 s with all that they
                         touch are left out until something touches them or is set */
    int32_t reserved; /* 0 */
} se3d_solver_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_solver_def_default. @since 0.1 */
SE3D_API void se3d_solver_def_init(se3d_solver_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_solver_def se3d_solver_def_default(void)
{
    se3d_solver_def def;
    se3d_solver_def_init(&def, sizeof def);
    return def;
}

/* Create a solver. The system may be edited between steps. If the system is destroyed first, the
 * calls of the solver return STATE. @return OK, NULL, INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_solver_create(se3d_system *system, const se3d_solver_def *def,
                                        se3d_solver **out);

/* Destroy a solver, also after its system; NULL is fine. Within a callback of its system nothing
 * is destroyed, and a message (STATE) says so. @since 0.1 */
SE3D_API void se3d_solver_destroy(se3d_solver *solver);

/* Run to a time. At the present time the state is only made consistent: positions and velocities
 * are projected, accelerations and multipliers are computed. A run of more than def.steps_max steps
 * of def.step is refused, and a run of any method is given up once its pace shows that it would
 * take more. On failure, and when def.interrupt ends the run, the state is that of the last
 * accepted step; another run goes on from there. The message is the system's.
 * @param[in] t_end  not before the present time, to rounding [s]
 * @return OK, INFO_*, NULL, STATE (the system is gone), INVALID_ARGUMENT, INCONSISTENT,
 *         NO_CONVERGENCE, SINGULAR, NOT_FINITE, STEP_SIZE, STEP_COUNT, INTERRUPTED, CALLBACK,
 *         UNSUPPORTED, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_solver_run(se3d_solver *solver, double t_end);

/* What a run computes of the state that it ends in. @since 0.1 */
typedef enum se3d_shown {
    SE3D_SHOWN_ALL = 0, /* everything, constraints to rounding */
    SE3D_SHOWN_MOTION =
        1 /* positions, velocities, works, constraints to a tenth of the tolerance */
} se3d_shown;

/* Set what later runs of a solver compute of the state that they end in; at first it is all. If
 * many states are wanted, most of what they cost is accelerations and multipliers: with MOTION
 * they are left out, and the functions that read them, or reactions, efforts and violations, return
 * STATE until a run with ALL, or a step, has moved on. Steps are the same. Runs of dynamics whose
 * method interpolates leave them out, unless there are contacts, friction, stops or particles, or,
 * by generalized_alpha and hht, any force elements.
 * @param[in] shown  se3d_shown
 * @return OK, NULL, INVALID_ARGUMENT, STATE (the system is gone).
 * @since 0.1 */
SE3D_API se3d_status se3d_solver_set_shown(se3d_solver *solver, int32_t shown);

/* Bring the system of a solver to where the solution that another system is at leads if its data
 * become those of the first one, by one step of Newton's method with the Jacobian of the other: the
 * systems have the same bodies, constraints and forces, with other masses, points or values. States
 * that follow so have the derivatives with respect to these data of the exact solutions (implicit
 * function theorem); the solutions themselves they approach as the data do. Kinematics, inverse
 * dynamics (but works, which become NaN), and equilibria, in r-omega, without friction, contacts
 * and particles. Dynamics by explicit methods that choose their steps is moved to the present time
 * of `from` by the steps of that run, which is followed from its first state on.
 * docs/theory/sensitivities.md
 * @param[in] from  a solver of the same analysis that has come to a solution, of another system,
 *                  which stays as it is
 * @return OK, NULL, INVALID_ARGUMENT (the same system), STATE (a system is gone, `from` has no
 *         solution or has moved before it was followed, another structure), UNSUPPORTED,
 *         NO_CONVERGENCE (an equilibrium leaves a freedom), or as se3d_solver_run; then the state
 *         is of no use, but for dynamics, where it stays.
 * @since 0.1 */
SE3D_API se3d_status se3d_solver_follow(se3d_solver *solver, se3d_solver *from);

/* Make one step that moves the time on; n steps come to n h, to rounding. A step that is too long
 * for an impact on a stop or between shapes, and by explicit methods for what rests there, returns
 * STEP_SIZE with a length that would do: se3d_solver_run chooses its own. Shapes that convex finds
 * too fast meet in parts of the step.
 * @param[in] h  length of the step, >= 1e-15 [s]
 * @return as se3d_solver_run.
 * @since 0.1 */
SE3D_API se3d_status se3d_solver_step(se3d_solver *solver, double h);

/* Counters since creation. @since 0.1 */
typedef struct se3d_solver_stats {
    uint64_t steps;          /* accepted */
    uint64_t rejected;       /* rejected steps */
    uint64_t iterations;     /* Newton iterations */
    uint64_t evaluations;    /* acceleration evaluations */
    uint64_t factorizations; /* of the linear solver */
    uint64_t solves;         /* of the linear solver */
    uint64_t reserved[10];   /* 0; for counters to come: other structures hold this one */
} se3d_solver_stats;

/* As se3d_solver_get_stats, told the size of *stats in bytes. @return as se3d_solver_get_stats,
 * and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_solver_get_stats_sized(const se3d_solver *solver,
                                                 se3d_solver_stats *stats, size_t size);

/* Get the counters of a solver since its creation. @return OK, NULL. @since 0.1 */
static inline se3d_status se3d_solver_get_stats(const se3d_solver *solver, se3d_solver_stats *stats)
{
    return se3d_solver_get_stats_sized(solver, stats, sizeof *stats);
}
/* How far the start that the user gave was from what the constraints admit: the last one that a run
 * of the solver began from. All is zero if it was met but for rounding (1e-9 of the model's size
 * and speeds), and the velocities if none was given (all zero) or drivers say them. Norms are
 * roots of the sums of squares over the bodies. @since 0.1 */
typedef struct se3d_start_change {
    double time;                  /* of the start [s] */
    double position;              /* norm of the displacements of centres of mass [m] */
    double rotation;              /* [rad] */
    double velocity;              /* [m/s] */
    double angular_velocity;      /* [rad/s] */
    double most_position;         /* of the body that was moved most [m] */
    double most_rotation;         /* [rad] */
    double most_velocity;         /* of the body whose velocity was changed most [m/s] */
    double most_angular_velocity; /* [rad/s] */
    se3d_body moved;              /* that body; null: none */
    se3d_body deflected;          /* the body whose velocity was changed most; null: none */
} se3d_start_change;

/* As se3d_solver_get_start_change, told the size of *change in bytes. @return as
 * se3d_solver_get_start_change, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_solver_get_start_change_sized(const se3d_solver *solver,
                                                        se3d_start_change *change, size_t size);

/* Get how far the last start of a run was from what the constraints admit. @return OK, NULL.
 * @since 0.1 */
static inline se3d_status se3d_solver_get_start_change(const se3d_solver *solver,
                                                       se3d_start_change *change)
{
    return se3d_solver_get_start_change_sized(solver, change, sizeof *change);
}

/* Get the tolerance to which the steps of a run are controlled: the one asked for, or the smallest
 * one that the method in use reaches if that is larger (dop853, gauss, rk45, rk4 6.7e-12, but
 * gauss 6.7e-13 in joint coordinates on open trees without contact, functions and friction, bdf
 * 1e-11, radau 1e-13, or 1e-10 with redundant equations, generalized_alpha, hht 1e-11, rattle,
 * verlet 1e-10, of order 4 1e-11, convex 1e-6); the log is told of that.
 * @param[out] tolerance  [relative] 0: errors are not controlled (other analyses,
 *                        generalized_alpha, hht, rattle and verlet with a step, and convex with one
 *                        or if no tolerance is asked for)
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_solver_get_tolerance(const se3d_solver *solver, double *tolerance);

/* Get the length of equal steps of a run: the one that was given, with verlet a shorter one of
 * contacts or particles, or the one that rattle and verlet have chosen, which clones and snapshots
 * of the system go on with.
 * @param[out] step  [s]; 0: the method adapts its steps, or none was chosen yet, or the system is
 *                   gone
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_solver_get_step(const se3d_solver *solver, double *step);

/* Get the method in use; of AUTO the one that it picked: where that is gauss, it is dop853 after a
 * step of given length, and gauss again after a run.
 * @param[out] name  "generalized_alpha", ...; static
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_solver_get_method(const se3d_solver *solver, const char **name);

/* Get the formulation in use; of AUTO the one that it picked for the system as it was when the last
 * run or step began, "romega" before the first.
 * @param[out] name  "romega", "rp", "joint"; static
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_solver_get_formulation(const se3d_solver *solver, const char **name);

/* Get when AUTO changed the method during a run, the last time, because stability or what touches
 * kept its steps short, or did no more, or many bodies came together.
 * @param[out] time  [s]; NaN: it did not
 * @param[out] left  the method that it left, "": none; static
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_solver_get_switch(const se3d_solver *solver, double *time,
                                            const char **left);

/* Get whether the steps so far would be others if the runs had another end (`horizon`): without
 * `step` methods of equal steps choose theirs by the whole run, and the first step of others is no
 * longer than that. Else a solver with another horizon goes on with the same bits.
 * @param[out] foresees  0, 1
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_solver_get_foresight(const se3d_solver *solver, int32_t *foresees);

/* Write what a solver knows beside the state of its system (se3d_snapshot_write) as bytes, which
 * are the same on every machine: what it has counted, the records of its events and what it has
 * seen of them in the step under way, the start that it has changed, the method it has left.
 * @param[out] bytes    [*size]; NULL: only *size is told
 * @param[in] capacity  of `bytes`
 * @param[out] size     how many bytes it takes
 * @return OK, NULL, INVALID_ARGUMENT (capacity), STATE (its system is gone).
 * @since 0.1 */
SE3D_API se3d_status se3d_solver_write(const se3d_solver *solver, void *bytes, size_t capacity,
                                       size_t *size);

/* Read what se3d_solver_write wrote into a new solver of the same definition (but for the horizon,
 * see se3d_solver_get_foresight), with the same events, made in the same order, of a system whose
 * state was restored (se3d_snapshot_restore). It goes on as if it had run from the beginning.
 * After a failure it is as new.
 * @param[in] bytes  [size]
 * @param[in] size   of `bytes`
 * @return OK, NULL, INVALID_ARGUMENT (no such bytes), STATE (of another analysis), NO_MEMORY, or a
 *         failure to prepare a run.
 * @since 0.1 */
SE3D_API se3d_status se3d_solver_read(se3d_solver *solver, const void *bytes, size_t size);

#ifdef __cplusplus
}
#endif
#endif
