/* SPDX-License-Identifier: BSD-3-Clause */
/* What `study` of a model file asks for: which parameters vary, and what is measured. */
#ifndef SE3D_IO_STUDY_ENTRY_H
#define SE3D_IO_STUDY_ENTRY_H

#include "io/channel/output.h"
#include "io/document/scope.h"

/* How the samples are laid out. */
typedef enum se3di_study_method {
    SE3DI_STUDY_GRID = 0, /* all combinations, the last parameter fastest */
    SE3DI_STUDY_MONTE_CARLO = 1,
    SE3DI_STUDY_LATIN_HYPERCUBE = 2,
    SE3DI_STUDY_SOBOL = 3,
    SE3DI_STUDY_TABLE = 4 /* rows of a file */
} se3di_study_method;

typedef enum se3di_distribution {
    SE3DI_DISTRIBUTION_LIST = 0,  /* of values, each as likely as the others */
    SE3DI_DISTRIBUTION_RANGE = 1, /* from a[0] to a[1]: evenly in a grid, else uniform */
    SE3DI_DISTRIBUTION_NORMAL = 2,
    SE3DI_DISTRIBUTION_UNIFORM = 3,
    SE3DI_DISTRIBUTION_LOGNORMAL = 4,
    SE3DI_DISTRIBUTION_TRIANGULAR = 5,
    SE3DI_DISTRIBUTION_EXPONENTIAL = 6,
    SE3DI_DISTRIBUTION_WEIBULL = 7
} se3di_distribution;

enum { SE3DI_STUDY_PARAMETERS_MAX = 1000, SE3DI_STUDY_MEASURES_MAX = 1000 };

/* One parameter that varies. */
typedef struct se3di_study_variable {
    const char *name;
    se3di_distribution distribution;
    double a[3];        /* its arguments */
    double *values;     /* LIST: [count] */
    size_t count;       /* LIST, and RANGE in a grid */
    se3di_amount shape; /* the unit of its values, if they have one */
} se3di_study_variable;

/* In the order of the keys of `measure`. */
typedef enum se3di_reduction {
    SE3DI_REDUCE_MAX = 0,
    SE3DI_REDUCE_MIN = 1,
    SE3DI_REDUCE_RANGE = 2,
    SE3DI_REDUCE_MEAN = 3,
    SE3DI_REDUCE_RMS = 4,
    SE3DI_REDUCE_INTEGRAL = 5,
    SE3DI_REDUCE_INITIAL = 6,
    SE3DI_REDUCE_FINAL = 7,
    SE3DI_REDUCE_AT = 8,         /* at a time or an event */
    SE3DI_REDUCE_SETTLING = 9,   /* time until it stays within a band */
    SE3DI_REDUCE_TIME_OF = 10,   /* time of an event */
    SE3DI_REDUCE_FREQUENCY = 11, /* of a mode */
    SE3DI_REDUCE_DAMPING = 12,
    SE3DI_REDUCE_MISFIT = 13,    /* from a curve */
    SE3DI_REDUCE_EXPRESSION = 14 /* of measures above it, and parameters */
} se3di_reduction;

typedef struct se3di_study_measure {
    const char *name;
    const se3di_node *node; /* of the expression */
    const se3di_node *map;  /* of the measure; NULL: it is an expression */
    se3di_reduction reduction;
    size_t source;     /* index of what it is made of, SE3DI_STUDY_NO_SOURCE: of no channel */
    const char *event; /* NULL: none */
    double time;       /* AT: since the beginning of the analysis [s] */
    size_t along;      /* MISFIT: as `source`, of x; SE3DI_STUDY_NO_SOURCE: the time */
    double *x, *y;     /* MISFIT: [point_count] of the curve, x ascending */
    size_t point_count;
    double mode;         /* FREQUENCY, DAMPING: its number, from 1 */
    double band, target; /* SETTLING, in the unit of the channel */
    bool has_target;     /* else its last value */
} se3di_study_measure;

#define SE3DI_STUDY_NO_SOURCE SIZE_MAX

/* The number that a source is in one model. */
typedef struct se3di_study_channel {
    se3di_channel channel;
    size_t component;
} se3di_study_channel;

/* One parameter that is sought. */
typedef struct se3di_study_unknown {
    const char *name;
    double from, to, start;
    se3di_amount shape; /* the unit of its values, if they have one */
} se3di_study_unknown;

/* What a measure may be: from..to; one value if they are equal. */
typedef struct se3di_study_limit {
    size_t measure;
    double from, to; /* infinite: none */
} se3di_study_limit;

typedef struct se3di_study_goal {
    int32_t method;   /* index among se3di_study_goal_methods */
    int32_t greatest; /* not 0: the measure is to be the greatest, else the least */
    size_t measure;
    double evaluations, tolerance;
    se3di_study_unknown *unknowns;
    size_t unknown_count;
    se3di_study_limit *limits;
    size_t limit_count;
} se3di_study_goal;

typedef struct se3di_study_entry {
    int32_t method; /* se3di_study_method */
    int32_t reserved;
    double samples;
    double seed;
    double every;    /* time between rows [s]; 0: the step */
    double analysis; /* that is measured, from 1; 0: the last */
    const char *table;
    se3di_study_variable *variables; /* of samples; none: there are no samples */
    size_t variable_count;
    const char **sensitivities; /* parameters of which derivatives are taken */
    size_t sensitivity_count;
    se3di_study_goal *goal; /* NULL: nothing is sought */
    se3di_study_measure *measures;
    size_t measure_count;
    const se3di_node **sources; /* channels and expressions of them, each once */
    size_t source_count;
    se3d_model_options options; /* with which the model was read, copied */
} se3di_study_entry;

#endif
