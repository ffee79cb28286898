/* SPDX-License-Identifier: BSD-3-Clause */
/* Integrators behind one table, chosen once per run. A step starts from the model's state at
 * model->time and, on success, leaves the accepted state at the new time; on failure the state of
 * the last accepted step.
 *
 * What a method carries from step to step (beyond the state) is model->history, marked with the
 * method's tag, so that clones and snapshots continue bit-identically. */
#ifndef SE3DI_INTEGRATOR_H
#define SE3DI_INTEGRATOR_H

#include "integrator/equal_steps.h"
#include "nonlinear/equations.h"
#include "nonlinear/jump.h"
#include "nonlinear/newton.h"
#include "se3d/solver.h"

typedef struct se3di_integrator_settings {
    double step;            /* fixed or largest step [s]; 0: chosen */
    double step_most;       /* of fixed-step methods, if none is given */
    double tolerance;       /* of adaptive methods */
    double spectral_radius; /* generalized_alpha */
    double alpha;           /* hht */
    int32_t iterations_max;
    int32_t order;
    int32_t leaves_stiff;   /* a run ends if stability holds the method, or needs radau no more, */
    int32_t leaves_crowd;   /* or where bodies are at each other: SE3DI_CROWD_ */
    int32_t sleeps;         /* convex: islands at rest sleep; */
    int32_t controls_error; /* and a tolerance is asked for */
} se3di_integrator_settings;

typedef struct se3di_integration se3di_integration;
struct se3di_rk_tableau;
struct se3di_explicit_class;
struct se3di_newmark;
struct se3di_convex;

/* The history of a method with `advance` begins with this. */
typedef struct se3di_adaptive_history {
    double time;     /* of the accepted state, the end of the last step [s] */
    double begin;    /* of the last step [s] */
    double next;     /* the next step [s] */
    double error;    /* of the last step, relative to the tolerance */
    double rejected; /* 1: an attempt at the step under way was rejected */
    double renewed;  /* 1: something else acts since the last step */
    double returns;  /* auto: how often stiffness was over, and an explicit method went on */
} se3di_adaptive_history;
_Static_assert(sizeof(se3di_adaptive_history) == 7 * sizeof(double),
               "it is an array of double in the model");

/* The tag of a history is that of its method times this, plus the number of its formulation. */
#define SE3DI_HISTORY_TAGS 4
/* The places of time and begin. */
enum { SE3DI_HISTORY_TIME = 0, SE3DI_HISTORY_BEGIN = 1 };

typedef struct se3di_integrator {
    const char *name;
    uint64_t tag;                                            /* of its history, not 0 */
    size_t (*history_count)(const se3di_assembly *assembly); /* doubles of model->history */
    size_t (*work_count)(const se3di_assembly *assembly);    /* doubles of integration->work */
    /* Fill the history from a consistent state (accelerations included), for a first step of h. */
    se3d_status (*start)(se3di_integration *integration, double h);
    /* Something else acts from the present time on: the history is to go on from the model's state
     * with its new accelerations, and nothing that was computed with the old ones is used again.
     * NULL: nothing is kept of accelerations. */
    se3d_status (*renew)(se3di_integration *integration);
    /* Whether `renew` itself finds what the model shows of accelerations, multipliers and powers,
     * so that nobody has to do so before. NULL: it does not. */
    int (*renews_all)(const se3di_integration *integration);
    /* Whether a history that somebody else wrote may be gone on with: its counts and orders are in
     * their ranges. NULL: it has none. */
    int (*is_sound)(const double *history, size_t count);
    /* Accelerations and multipliers at the model's state. NULL: se3di_acceleration_solve. */
    se3d_status (*accelerate)(se3di_integration *integration);
    /* One step of length h. */
    se3d_status (*step)(se3di_integration *integration, double h);
    /* Several steps to t_end with own step control; NULL, or step control not wanted: steps of
     * settings.step that end there exactly. */
    se3d_status (*run)(se3di_integration *integration, double t_end);
    /* Of methods that step ahead of the model's time and interpolate, others NULL. One accepted
     * step (towards t_end) after the one that is there; `run` to a time within it makes no step, it
     * gives the model the state there. History [0] is its end, [1] its beginning. */
    se3d_status (*advance)(se3di_integration *integration, double t_end);
    /* The state at t within the step, y [se3di_state_count], as the interpolation has it. */
    void (*interpolate)(const se3di_integration *integration, double t, double *y);
    /* Whether stability, not accuracy, has held its last steps so short; NULL: it never does. With
     * settings.leaves_stiff or leaves_crowd `run` then ends where that was seen. Of radau:
     * whether it is not needed any more, or has followed contacts for too long. */
    int (*is_held)(const se3di_integration *integration);
    /* Whether `run`, which left the history that the model has, ended for what touches; and that it
     * is to go on all the same. NULL: settings.leaves_crowd is not looked at. */
    int (*leaves_crowd)(const se3di_model *model);
    void (*stay)(se3di_model *model);
    const struct se3di_explicit_class *explicit_class; /* of explicit methods, */
    const struct se3di_rk_tableau *tableau;            /* and of those of Runge-Kutta */
    /* Of the Newmark family: its coefficients. */
    struct se3di_newmark (*newmark)(const se3di_integrator_settings *settings);
    int32_t is_implicit; /* not 0: integration->newton is made */
    int32_t is_explicit; /* not 0: works with formulations in the fewest unknowns, */
    int32_t is_reduced;  /* and so do these implicit ones */
    uint32_t orders;     /* bit k: settings.order may be k; 0, the default one, always may */
    double reach;        /* smallest tolerance that its control of errors meets; 0: it has none */
    /* The same where it depends on order, model or what is chosen; NULL: it does not. */
    double (*get_reach)(const struct se3di_integration *integration,
                        const struct se3di_model *model);
    int32_t fixes_step;    /* not 0: with settings.step, errors are not controlled */
    int32_t chooses_step;  /* not 0: without one, equal steps are chosen (equal_steps.h) */
    int32_t weighs_bodies; /* not 0: needs a mass matrix of bodies alone, without armatures */
    int32_t moves_first;   /* not 0: steps of positions make velocities, by rates that are given */
    int32_t takes_lanes;   /* not 0: loops of several states are computed at once */
    int32_t takes_particles; /* not 0: steps are no longer than contacts and particles ask for */
    int32_t leaves_stiff;    /* not 0: auto leaves it where stability holds it, */
    int32_t takes_stiff;     /* for this one */
    int32_t takes_crowd; /* not 0: bodies at each other at long steps, each of which is checked */
} se3di_integrator;

/* The ends of accepted steps [s] since a motion began. */
typedef struct se3di_step_list {
    double *ends;
    size_t count, capacity;
    double begin;    /* of the first one [s] */
    uint64_t number; /* of the motion: lists that other motions left are over */
} se3di_step_list;

struct se3di_integration {
    const se3di_integrator *method;
    se3di_equations *equations;
    se3di_integrator_settings settings;
    double *work;
    double error;        /* of the last step, relative to the tolerance, if it is controlled */
    double fraction;     /* of a step that was refused, to where an impact begins; 0: none */
    double end;          /* of the call or, if it is known, of those that go on [s] */
    se3di_newton newton; /* of implicit methods */
    struct se3di_convex *convex; /* of that method; NULL: none yet */
    se3di_saved before_trials;   /* of steps whose length is chosen */
    int32_t is_paced;            /* contacts or stops have shortened the step under way */
    se3di_kink kink;             /* where the accepted state is, if */
    int32_t at_kink;             /* no step can be made before it was passed */
    int32_t shows_motion;        /* what `run` shows may be without accelerations and multipliers */
    int32_t is_moved;            /* for `renew`: the state was settled since the last step */
    int32_t may_wait; /* nobody reads the accelerations that the step under way ends with at once */
    int32_t owes;     /* the evaluation that the last step has left is not counted yet */
    se3di_step_list *record; /* of explicit methods: every step is noted here; NULL: none is */
    const se3di_step_list *repeat; /* and these are made, whatever their errors; NULL: own ones */
    size_t repeated;               /* how many of them are over, */
    uint64_t repeated_number;      /* of this motion */
    int32_t foresees;              /* `end` has made some step another one */
};

/* The methods but AUTO, X(METHOD, name): se3di_integrator_<name> is the table of
 * SE3D_METHOD_<METHOD>, in lib/integrator/<name>.c. */
#define SE3DI_METHOD_LIST(X)                                                                       \
    X(GENERALIZED_ALPHA, generalized_alpha)                                                        \
    X(HHT, hht)                                                                                    \
    X(DOP853, dop853)                                                                              \
    X(RK45, rk45)                                                                                  \
    X(BDF, bdf)                                                                                    \
    X(RADAU, radau)                                                                                \
    X(RATTLE, rattle)                                                                              \
    X(VERLET, verlet)                                                                              \
    X(RK4, rk4)                                                                                    \
    X(CONVEX, convex)                                                                              \
    X(GAUSS, gauss)

#define SE3DI_METHOD_DECLARE(METHOD, name) extern const se3di_integrator se3di_integrator_##name;
SE3DI_METHOD_LIST(SE3DI_METHOD_DECLARE)
#undef SE3DI_METHOD_DECLARE

/* The tolerance that the steps of a run on the model are controlled to: the one that is asked for,
 * or what the method reaches; 0: errors are not controlled. */
double se3di_integration_get_tolerance(const se3di_integration *integration,
                                       const se3di_model *model);

/* auto: the method is held short, by stability or by what touches, and others are to be taken. */
int se3di_integration_must_leave(const se3di_integration *integration);

/* By se3d_method, AUTO: the one with which a run begins; NULL: there is none of that number. */
const se3di_integrator *se3di_integrator_find(int32_t method);
/* The method that left a history with this tag; NULL: there is none. */
const se3di_integrator *se3di_integrator_of_history(uint64_t tag);

#endif
