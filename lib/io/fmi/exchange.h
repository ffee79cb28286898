/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files of a unit share: unit.c has its life and its steps, exchange.c what a caller that
 * integrates asks for, derivative.c how values depend on others. */
#ifndef SE3D_IO_FMI_EXCHANGE_H
#define SE3D_IO_FMI_EXCHANGE_H

#include "base/coder.h"
#include "io/channel/sample.h"
#include "io/fmi/recipe.h"
#include "io/fmi/unit.h"

struct se3di_fmi_unit {
    se3di_iopool pool;
    se3di_fmi_recipe recipe;
    const char *path; /* of the model */
    se3di_fmi_tell tell;
    void *ctx;
    se3d_model *model;
    se3d_solver *solver; /* NULL: not started */
    se3d_solver_stats stats;
    se3di_sample sample; /* answers at the present state; of `model` */
    se3di_fmi_variables variables;
    double *values;   /* of inputs and parameters: [variables.count], where the caller */
    bool *given;      /* has set them */
    double *places;   /* pairs for each: when a rate was set, and the integral of it then */
    bool model_stale; /* a parameter has changed, or the start is wanted again */
    bool state_stale; /* an input has changed at the present time */
    bool shows_all;   /* some output needs accelerations or multipliers */
    se3di_fmi_mode mode;
    size_t analysis;
    double start, stop, tolerance; /* NaN: as in the file, none, as in the file */
    double time;
    struct se3di_fmi_exchange *exchange; /* NULL: co-simulation */
    bool is_quiet;                       /* nobody is told of what a trial state makes of it */
    bool is_discarded;                   /* what has failed may go well after a shorter step */
    char token[SE3DI_FMI_TOKEN_SIZE];
};

/* What a caller integrates. */
typedef struct se3di_fmi_exchange {
    se3d_coordinates *coordinates; /* of the unit's model; NULL: not begun */
    se3d_snapshot *base;           /* the last completed step, from where trial states begin */
    double *x, *dx;                /* [states] as the caller has set them; derivatives */
    double *shown;                 /* [states] what constraints make of x */
    double *given;                 /* [states] room for one more */
    double *signs;                 /* [indicators] at the last event, then impacts: [stops] */
    bool is_stale;                 /* the system is not at x */
    bool is_drifted;               /* constraints are violated: the next event mends it */
} se3di_fmi_exchange;

/* Say why, and be false. */
SE3DI_IO_FORMAT(2, 3)
bool se3di_fmi_fail(se3di_fmi_unit *u, const char *format, ...);
/* With the system's message, or the text of the status. */
bool se3di_fmi_fail_system(se3di_fmi_unit *u, const char *what, se3d_status status);
bool se3di_fmi_is_in(se3di_fmi_unit *u, unsigned modes, const char *call);
/* The value of a variable that is set. */
double se3di_fmi_value_of(const se3di_fmi_unit *u, size_t k);
/* The state at the start, or with the inputs as they are now. */
bool se3di_fmi_refresh(se3di_fmi_unit *u);

/* Set an input that was checked, also one that must not change continuously. */
bool se3di_fmi_unit_force(se3di_fmi_unit *u, size_t k, double value);

/* Memory for it. */
bool se3di_fmi_exchange_create(se3di_fmi_unit *u);
/* Take the states from the system, which is at the beginning. */
bool se3di_fmi_exchange_begin(se3di_fmi_unit *u);
/* The model goes. */
void se3di_fmi_exchange_drop(se3di_fmi_unit *u);
/* Bring the system to the time, the states and the inputs that were set. */
bool se3di_fmi_exchange_update(se3di_fmi_unit *u);
/* A state, derivative or indicator of the list of variables. */
bool se3di_fmi_exchange_get(se3di_fmi_unit *u, const se3di_fmi_variable *v, size_t reference,
                            double *value);
/* How many numbers there are beside the snapshot: x, signs, impacts. */
size_t se3di_fmi_exchange_count(const se3di_fmi_unit *u);
/* Set states, all checked by who calls. */
void se3di_fmi_exchange_put(se3di_fmi_unit *u, const double *x);
/* After the system was put back to `base`, which it takes: x and signs as `numbers` has them. */
bool se3di_fmi_exchange_resume(se3di_fmi_unit *u, se3d_snapshot *base, const double *numbers);

#endif
