/* SPDX-License-Identifier: BSD-3-Clause */
/* libse3d-io: model files (YAML or JSON) and results (CSV). Link with -lse3d-io -lse3d.
 *
 * A model owns the system it was read into. The file format: docs/model-file/reference.md.
 *
 * Threads: the rule of se3d/se3d.h; a model includes its system. */
#ifndef SE3D_IO_H
#define SE3D_IO_H

#include "se3d/se3d.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Why a file was rejected or a run failed: "file:line:column: path: what, and what is allowed".
 * @since 0.1 */
typedef struct se3d_model_error {
    size_t line;        /* 1-based; 0 if no line is to blame */
    size_t column;      /* 1-based, in characters; 0 if unknown */
    char message[1024]; /* the text, UTF-8 */
} se3d_model_error;

/* What to replace in a model; both texts as on the command line. @since 0.1 */
typedef struct se3d_model_setting {
    const char *name;  /* of a parameter, or a path with a dot or bracket in it: keys and names of
                        * entries, as in bodies.bar.mass, entries also as in output[0].every */
    const char *value; /* of a parameter: an expression; at a path: any value as in the file. A key
                        * that is not there is added. */
} se3d_model_setting;

/* Called for each mistake of a model, in the order of the lines. `error` is valid during the call.
 * @since 0.1 */
typedef void (*se3d_model_report)(void *ctx, const se3d_model_error *error);

/* How to read a model. Texts are as in the file; NULL: as the file says. @since 0.1 */
typedef struct se3d_model_options {
    size_t struct_size;
    const se3d_allocator *allocator;    /* copied, also for the system; NULL: malloc */
    const se3d_model_setting *settings; /* [setting_count] */
    size_t setting_count;               /* default 0 */
    const char *analysis;               /* run this type only */
    const char *formulation;            /* of every analysis */
    const char *method;                 /* of every dynamics analysis */
    const char *step;                   /* expression over the parameters [s] */
    const char *duration;               /* expression over the parameters [s] */
    int32_t mass_optional;    /* not 0: bodies without mass get 1 kg, 1 kg m^2 (geometry only) */
    int32_t reserved;         /* 0 */
    const char *tolerance;    /* expression over the parameters, of every analysis */
    se3d_model_report report; /* of all mistakes, at most SE3D_MODEL_MISTAKES_MAX; NULL: reading
                               * ends at the first one, which `error` has in any case */
    void *report_ctx;         /* of `report` */
    se3d_log_callback log;    /* of the model's system; NULL: silent */
    void *log_ctx;            /* of `log` */
    const char *threads;      /* expression over the parameters, of particles: results do not depend
                               * on it; without particles it changes nothing */
} se3d_model_options;

/* The largest number of mistakes that are reported of one model. @since 0.1 */
enum { SE3D_MODEL_MISTAKES_MAX = 20 };

/* Fill `options`, of `size` bytes, with the defaults: see se3d_model_options_default. @since 0.1 */
SE3D_API void se3d_model_options_init(se3d_model_options *options, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_model_options se3d_model_options_default(void)
{
    se3d_model_options options;
    se3d_model_options_init(&options, sizeof options);
    return options;
}

/* Read a model file and build its system.
 * @param[in] path     of the file
 * @param[in] options  NULL: the defaults
 * @param[out] error   filled on failure, emptied on success; may be NULL
 * @return OK, NULL, INVALID_ARGUMENT (options), IO (cannot be read), MODEL (malformed; see the
 *         message), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_model_read_file(const char *path, const se3d_model_options *options,
                                          se3d_model **out, se3d_model_error *error);

/* Read a model from memory and build its system.
 * @param[in] text     [length] UTF-8
 * @param[in] length   in bytes
 * @param[in] name     stands for the file in messages
 * @param[in] options  NULL: the defaults
 * @param[out] error   filled on failure, emptied on success; may be NULL
 * @return OK, NULL, INVALID_ARGUMENT (options), MODEL (malformed; see the message), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_model_read_text(const char *text, size_t length, const char *name,
                                          const se3d_model_options *options, se3d_model **out,
                                          se3d_model_error *error);

/* Destroy a model and its system; NULL is fine. Within se3d_model_run, a sample of a study of the
 * model or a callback of the system nothing is destroyed. @since 0.1 */
SE3D_API void se3d_model_destroy(se3d_model *model);

/* Get the system of a model, which may be changed, but not destroyed: the model keeps it and its
 * particles (se3d_system_set_kept). @return the system, owned by the model; NULL for NULL.
 * @since 0.1 */
SE3D_API se3d_system *se3d_model_get_system(const se3d_model *model);

/* Get the name of the file without folder and extension. @return the text, owned by the model;
 * "" for NULL. @since 0.1 */
SE3D_API const char *se3d_model_get_name(const se3d_model *model);

/* Get the title of a model. @return the text, owned by the model; "" if it has none. @since 0.1 */
SE3D_API const char *se3d_model_get_title(const se3d_model *model);

/* Get the value of a parameter of the file.
 * @param[in] name    of the parameter
 * @param[out] value  [any unit]
 * @return OK, NULL, INVALID_ARGUMENT (no such parameter).
 * @since 0.1 */
SE3D_API se3d_status se3d_model_get_parameter(const se3d_model *model, const char *name,
                                              double *value);

/* Count the parameters of the file itself, without those of its parts. @return the number; 0 for
 * NULL. @since 0.1 */
SE3D_API size_t se3d_model_count_parameters(const se3d_model *model);

/* Get the name of a parameter of the file.
 * @param[in] index  from 0, below se3d_model_count_parameters
 * @return the text, owned by the model; "" for NULL or a wrong index. @since 0.1 */
SE3D_API const char *se3d_model_get_parameter_name(const se3d_model *model, size_t index);

/* Get what the file says that a parameter is: "30 mm", "2*a". Settings replace the value only.
 * @param[in] index  from 0, below se3d_model_count_parameters
 * @return the text, owned by the model; "" for a list, NULL or a wrong index. @since 0.1 */
SE3D_API const char *se3d_model_get_parameter_text(const se3d_model *model, size_t index);

/* How to write a model. @since 0.1 */
typedef struct se3d_write_options {
    size_t struct_size;
    int32_t partial; /* not 0: what a file cannot hold (callbacks, and what refers to them; studies;
                              of a file with units all but the elements) is left out, and a comment
                              says so; 0, the default: it is an error */
    int32_t elements_only; /* not 0: without analyses, results, events, particles */
} se3d_write_options;

/* Fill `options`, of `size` bytes, with the defaults: see se3d_write_options_default. @since 0.1 */
SE3D_API void se3d_write_options_init(se3d_write_options *options, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_write_options se3d_write_options_default(void)
{
    se3d_write_options options;
    se3d_write_options_init(&options, sizeof options);
    return options;
}

/* Write a model with its system as it is now: elements with the values that were set, poses and
 * velocities. Parts, repeats and expressions are resolved, in SI units; analyses, results and
 * particles are as the file said them. Read again, an element is the same to the bit, wherever the
 * bodies are. Runs then have the same bits if the constraints were made in the order of a file
 * (joints, couplers, primitives, drivers) and no angle has turned farther than half round; else
 * they agree to rounding. Not written are what an analysis has left in the system and what wheels
 * count as zero travel. Studies, and all but the elements of a file with units of its own, cannot
 * be written: that is UNSUPPORTED unless `partial` or `elements_only` leaves them out.
 * @param[in] path     of the file
 * @param[in] options  NULL: the defaults
 * @param[out] error   filled on failure, emptied on success; may be NULL
 * @return OK, NULL, INVALID_ARGUMENT (options), UNSUPPORTED (a file cannot hold it: the message
 *         names the element or the sections), IO, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_model_write(const se3d_model *model, const char *path,
                                      const se3d_write_options *options, se3d_model_error *error);

/* As se3d_model_write, to memory.
 * @param[out] text     [capacity] UTF-8, ends with a zero byte; NULL: only *length is told
 * @param[in] capacity  of `text`
 * @param[out] length   of the text, without the zero byte
 * @return OK, NULL, INVALID_ARGUMENT (options, capacity), UNSUPPORTED, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_model_write_text(const se3d_model *model,
                                           const se3d_write_options *options, char *text,
                                           size_t capacity, size_t *length,
                                           se3d_model_error *error);

/* Write a system that was made by calls as a model file; elements without a name get one. @return
 * as se3d_model_write. @since 0.1 */
SE3D_API se3d_status se3d_system_write(const se3d_system *system, const char *path,
                                       const se3d_write_options *options, se3d_model_error *error);

/* One entry of `analysis`. @since 0.1 */
typedef struct se3d_model_analysis {
    double start;     /* [s]; NaN: where the analysis before ended, 0 for the first */
    double duration;  /* [s]; 0 for assembly, equilibrium, modes */
    const char *type; /* "dynamics", ...; owned by the model */
} se3d_model_analysis;

/* Count the analyses of a model, which run one after the other. @return the number; 0 for NULL.
 * @since 0.1 */
SE3D_API size_t se3d_model_count_analyses(const se3d_model *model);

/* As se3d_model_get_analysis, told the size of *analysis in bytes. @return as
 * se3d_model_get_analysis, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_model_get_analysis_sized(const se3d_model *model, size_t index,
                                                   se3d_model_analysis *analysis, size_t size);

/* Get an analysis of a model.
 * @param[in] index  from 0, below se3d_model_count_analyses
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
static inline se3d_status se3d_model_get_analysis(const se3d_model *model, size_t index,
                                                  se3d_model_analysis *analysis)
{
    return se3d_model_get_analysis_sized(model, index, analysis, sizeof *analysis);
}

/* Get the definition of the solver of an analysis. `def` comes from se3d_solver_def_default.
 * @param[in] index  from 0, below se3d_model_count_analyses
 * @return OK, NULL, INVALID_ARGUMENT (index), UNSUPPORTED (modes need no solver).
 * @since 0.1 */
SE3D_API se3d_status se3d_model_get_solver(const se3d_model *model, size_t index,
                                           se3d_solver_def *def);

/* One results file. @since 0.1 */
typedef struct se3d_model_output {
    const char *file;     /* relative to the results' folder; owned by the model */
    double every;         /* time between rows [s]; 0: the analysis's step */
    size_t channel_count; /* without `time` */
} se3d_model_output;

/* Count the results files of a model. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_model_count_outputs(const se3d_model *model);

/* As se3d_model_get_output, told the size of *output in bytes. @return as se3d_model_get_output,
 * and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_model_get_output_sized(const se3d_model *model, size_t index,
                                                 se3d_model_output *output, size_t size);

/* Get a results file of a model.
 * @param[in] index  from 0, below se3d_model_count_outputs
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
static inline se3d_status se3d_model_get_output(const se3d_model *model, size_t index,
                                                se3d_model_output *output)
{
    return se3d_model_get_output_sized(model, index, output, sizeof *output);
}

/* Get the name of a channel of a results file.
 * @param[in] output  index of the results file
 * @param[in] k       index of the channel, from 0
 * @param[out] name   "bar.position", ...; owned by the model
 * @return OK, NULL, INVALID_ARGUMENT (output, k).
 * @since 0.1 */
SE3D_API se3d_status se3d_model_get_channel(const se3d_model *model, size_t output, size_t k,
                                            const char **name);

/* A channel that a model file may name. @since 0.1 */
typedef struct se3d_model_channel {
    const char *name; /* "bar.position", ...; owned by the model */
    const char *unit; /* "m/s^2", "" for plain numbers; owned by the model */
    size_t width;     /* columns, at most 4 */
} se3d_model_channel;

/* List what a model can show: all channels of its elements, of at most 10,000 of each kind.
 * @param[out] count  the number of channels
 * @return OK, NULL, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_model_list_channels(se3d_model *model, size_t *count);

/* As se3d_model_get_listed_channel, told the size of *channel in bytes. @return as
 * se3d_model_get_listed_channel, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_model_get_listed_channel_sized(const se3d_model *model, size_t k,
                                                         se3d_model_channel *channel, size_t size);

/* Get a channel of the list that se3d_model_list_channels has made.
 * @param[in] k  from 0, below the number that it said
 * @return OK, NULL, INVALID_ARGUMENT (k).
 * @since 0.1 */
static inline se3d_status se3d_model_get_listed_channel(const se3d_model *model, size_t k,
                                                        se3d_model_channel *channel)
{
    return se3d_model_get_listed_channel_sized(model, k, channel, sizeof *channel);
}

/* Compute a channel of a results file at the present state.
 * @param[in] output  index of the results file
 * @param[in] k       index of the channel, from 0
 * @param[in] stats   feeds `steps` and `iterations`; NULL: zeros
 * @param[out] value  as many numbers as the channel has columns, in its frame and [unit]
 * @param[out] width  the number of columns, at most 4
 * @return OK, NULL, INVALID_ARGUMENT (output, k), or what the system's getter returned.
 * @since 0.1 */
SE3D_API se3d_status se3d_model_get_channel_value(const se3d_model *model, size_t output, size_t k,
                                                  const se3d_solver_stats *stats, double value[4],
                                                  size_t *width);

/* Add an event to a solver on the model's system. Its value is a channel of the model file, in
 * place of the value and ctx of `def`. The model must outlive the solver.
 * @param[in] channel  one number: "pin.angle", "bar.position.z", ...
 * @param[out] error   filled on failure; may be NULL
 * @return OK, NULL, STATE (the system is gone), INVALID_ARGUMENT (no such channel, not one number,
 *         a count), UNSUPPORTED, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_model_create_event(se3d_model *model, se3d_solver *solver,
                                             const char *channel, const se3d_event_def *def,
                                             se3d_event *out, se3d_model_error *error);

/* A shape of a body, as the file describes it. @since 0.1 */
typedef struct se3d_model_shape {
    int32_t type;          /* se3d_shape_type */
    int32_t reserved;      /* 0 */
    se3d_body body;        /* that it is on */
    double size[3];        /* box: lengths of its edges [m] */
    double radius;         /* sphere, capsule, cylinder [m] */
    double length;         /* capsule (between its centres), cylinder, funnel, along its z [m] */
    double scale;          /* mesh: factor on its vertices [1] */
    double position[3];    /* of the shape's centre, body frame [m] */
    double orientation[4]; /* shape -> body, Euler parameters */
    double color[3];       /* 0..1; -1 if none is given */
    const char *file;      /* mesh; "" for the others; owned by the model */
    double bottom_radius;  /* funnel, at its lower end along z [m], */
    double top_radius;     /* and at its upper end [m] */
    double semi_axes[3];   /* ellipsoid, along its x, y, z [m] */
} se3d_model_shape;

/* Count the shapes of the bodies of a model. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_model_count_shapes(const se3d_model *model);

/* As se3d_model_get_shape, told the size of *shape in bytes. @return as se3d_model_get_shape,
 * and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_model_get_shape_sized(const se3d_model *model, size_t index,
                                                se3d_model_shape *shape, size_t size);

/* Get a shape as the file describes it.
 * @param[in] index  from 0, below se3d_model_count_shapes
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
static inline se3d_status se3d_model_get_shape(const se3d_model *model, size_t index,
                                               se3d_model_shape *shape)
{
    return se3d_model_get_shape_sized(model, index, shape, sizeof *shape);
}

/* Called during a run after each row; return not 0 to stop it. @since 0.1 */
typedef int (*se3d_run_progress)(void *ctx, size_t analysis, double time, double fraction);

/* How to run a model. @since 0.1 */
typedef struct se3d_run_options {
    size_t struct_size;
    const char *directory;      /* for relative files, made if missing; NULL: "." */
    se3d_run_progress progress; /* NULL: none */
    void *ctx;                  /* of `progress` */
    se3d_interrupt interrupt;   /* asked within rows too whether the run is to end; NULL: none */
    void *interrupt_ctx;        /* of `interrupt` */
    double checkpoint; /* > 0: at the first row so long after the last checkpoint, by the clock, the
                           file run.checkpoint is written to `directory` [s] */
    int32_t resume;    /* not 0: go on from run.checkpoint in `directory`, if it is there */
    int32_t estimate;  /* not 0: a copy of the system follows dynamics with a given equal step, in
                          steps twice as long, to estimate its error (se3d_run_analysis). That takes
                          half as much time again; the log is told of errors above 1e-3. By convex
                          until bodies touch. Not with particles, `fmus`, nor with checkpoints */
    se3d_scene *scene; /* that `progress` records, kept in checkpoints; NULL: none */
    const char *temporary; /* folder in which packed units (`fmus`) are unpacked, into a private one
                              that is removed with the end of their analysis; NULL: /tmp */
    int32_t keep; /* not 0: a run.checkpoint of the last rows before those at the end stays when
                         the run is complete, to go on with a longer duration */
    int32_t reserved_end; /* 0 */
} se3d_run_options;

/* Fill `options`, of `size` bytes, with the defaults: see se3d_run_options_default. @since 0.1 */
SE3D_API void se3d_run_options_init(se3d_run_options *options, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_run_options se3d_run_options_default(void)
{
    se3d_run_options options;
    se3d_run_options_init(&options, sizeof options);
    return options;
}

/* Run every analysis of a model and write its results. A file is written under a temporary name,
 * where its rows can be seen after about a second, and gets its own when the run is over. If an
 * analysis fails, the rows so far are kept; if it is interrupted, they end with one at the time
 * that was reached. A run that resumes leaves the same files as one that was never ended, to the
 * byte; it must be of the same model files, options and version of the library, and the results
 * must be as they were left. Durations of analyses may be others in files and options, of the one
 * under way where nothing that was done depends on it, and of later ones. The checkpoint is removed
 * when a run is complete, unless it is to be kept, or when one begins anew. One that cannot be
 * written is told to the log, and the one before stays.
 * @param[in] options  NULL: the defaults
 * @param[out] error   filled on failure: when, where, why and what to try; may be NULL
 * @return OK or INFO_* of the last analysis, NULL, INVALID_ARGUMENT (options), STATE (no analysis,
 *         within a run of the model, or a checkpoint or results that do not fit), IO, NO_MEMORY, or
 *         the status of the analysis that failed; *out tells what was done, also then, and is NULL
 *         if nothing ran.
 * @since 0.1 */
SE3D_API se3d_status se3d_model_run(se3d_model *model, const se3d_run_options *options,
                                    se3d_run **out, se3d_model_error *error);

/* Read a model file, run every analysis and write its results, in one call: as
 * se3d_model_read_file, se3d_model_run and se3d_model_destroy with their defaults.
 * @param[in] path       of the model file
 * @param[in] directory  for relative files of results, made if missing; NULL: "."
 * @param[out] error     filled on failure, emptied on success; may be NULL
 * @return OK or INFO_* of the last analysis, or as se3d_model_read_file and se3d_model_run
 * @since 0.1 */
SE3D_API se3d_status se3d_model_run_file(const char *path, const char *directory,
                                         se3d_model_error *error);

/* Destroy the report of a run; NULL is fine. @since 0.1 */
SE3D_API void se3d_run_destroy(se3d_run *run);

/* The report on one analysis. @since 0.1 */
typedef struct se3d_run_analysis {
    const char *type;        /* owned by the run, as all texts below */
    const char *formulation; /* "rp", "romega", "joint" */
    const char *method;      /* in use; "" if the analysis has none */
    int32_t status;          /* se3d_status */
    int32_t reserved;        /* 0 */
    double start;            /* [s] */
    double end;              /* time that was reached [s] */
    double cpu_time;         /* [s] */
    se3d_solver_stats stats; /* of its solver */
    const char *left;        /* the method that `auto` left on the way for `method`, "": none */
    double left_at;          /* when [s], NaN: never */
    const char *moved;       /* the body that the start moved most, "": none */
    const char *deflected;   /* the body whose velocity the start changed most, "": none */
    double start_change[8];  /* as se3d_start_change: norms [m, rad, m/s, rad/s], and those of the
                               bodies above */
    const char *left_out;    /* equations that are redundant but for the digits of their data, with
                               what they are off by at the end, "": none */
    double tolerance;        /* that was asked for [relative]; 0: the analysis controls no errors */
    double reached;          /* as se3d_solver_get_tolerance [relative] */
    double step;             /* as se3d_solver_get_step [s] */
    /* About what equal steps err by up to estimated_to, over the largest values, with `estimate` of
     * the options; 0 if there is none. */
    double error_position;         /* of centres, over the largest travel [relative] */
    double error_velocity;         /* of centres [relative] */
    double error_angular_velocity; /* [relative] */
    double error_work;             /* of works, of which the largest counts [relative] */
    double error_state;            /* of states, each over its own [relative] */
    double estimated_to;           /* [s], NaN: nothing was estimated */
    const char *unestimated;       /* why the estimate ends before the run, "": it does not */
} se3d_run_analysis;

/* Count the analyses that a run began. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_run_count_analyses(const se3d_run *run);

/* As se3d_run_get_analysis, told the size of *analysis in bytes. @return as
 * se3d_run_get_analysis, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_run_get_analysis_sized(const se3d_run *run, size_t index,
                                                 se3d_run_analysis *analysis, size_t size);

/* Get what an analysis of a run did.
 * @param[in] index  from 0, below se3d_run_count_analyses
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
static inline se3d_status se3d_run_get_analysis(const se3d_run *run, size_t index,
                                                se3d_run_analysis *analysis)
{
    return se3d_run_get_analysis_sized(run, index, analysis, sizeof *analysis);
}

/* The particles of a name at the end of a run. @since 0.1 */
typedef struct se3d_run_particles {
    const char *name;  /* "particles": those without a name; owned by the model */
    uint64_t count;    /* that are there */
    uint64_t left;     /* removed by sinks, and those that are there but beyond the domain */
    uint64_t inserted; /* by sources */
    uint64_t deferred; /* of all so far, those that a source had to put off for room */
} se3d_run_particles;

/* Count the names that ever had particles in a run. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_run_count_particles(const se3d_run *run);

/* As se3d_run_get_particles, told the size of *particles in bytes. @return as
 * se3d_run_get_particles, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_run_get_particles_sized(const se3d_run *run, size_t index,
                                                  se3d_run_particles *particles, size_t size);

/* Get the particles of a name at the end of a run.
 * @param[in] index  from 0, below se3d_run_count_particles
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
static inline se3d_status se3d_run_get_particles(const se3d_run *run, size_t index,
                                                 se3d_run_particles *particles)
{
    return se3d_run_get_particles_sized(run, index, particles, sizeof *particles);
}

/* An event that happened. @since 0.1 */
typedef struct se3d_run_event {
    const char *name;    /* of the event */
    const char *channel; /* with its component; both owned by the model */
    double time;         /* [s] */
    double value;        /* of the channel then [its unit] */
    size_t analysis;     /* index */
    int32_t direction;   /* SE3D_EVENT_RISING or _FALLING */
    int32_t stopped;     /* not 0: it ended the analysis */
} se3d_run_event;

/* Count the events that happened in a run. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_run_count_events(const se3d_run *run);

/* As se3d_run_get_event, told the size of *event in bytes. @return as se3d_run_get_event, and
 * INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_run_get_event_sized(const se3d_run *run, size_t index,
                                              se3d_run_event *event, size_t size);

/* Get an event that happened in a run.
 * @param[in] index  from 0, below se3d_run_count_events
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
static inline se3d_status se3d_run_get_event(const se3d_run *run, size_t index,
                                             se3d_run_event *event)
{
    return se3d_run_get_event_sized(run, index, event, sizeof *event);
}

/* A file that was written. @since 0.1 */
typedef struct se3d_run_file {
    const char *path; /* with the folder of the results; owned by the run */
    uint64_t rows;    /* without the header */
    size_t columns;   /* with `time` */
} se3d_run_file;

/* Count the files that a run wrote. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_run_count_files(const se3d_run *run);

/* As se3d_run_get_file, told the size of *file in bytes. @return as se3d_run_get_file, and
 * INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_run_get_file_sized(const se3d_run *run, size_t index, se3d_run_file *file,
                                             size_t size);

/* Get a file that a run wrote.
 * @param[in] index  from 0, below se3d_run_count_files
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
static inline se3d_status se3d_run_get_file(const se3d_run *run, size_t index, se3d_run_file *file)
{
    return se3d_run_get_file_sized(run, index, file, sizeof *file);
}

/* What a column of a channel was over a run: an entry `summary` of the `output` asks for it. Of the
 * rows that it names; between them a number counts as a straight line. @since 0.1 */
typedef struct se3d_run_summary {
    const char *file;    /* of the table, as in the model file; owned by the model */
    const char *channel; /* the column, such as bar.position.z; owned by the run */
    double min;          /* the smallest value [unit of the channel] */
    double min_time;     /* the first time of it [s] */
    double max;          /* the largest [unit of the channel] */
    double max_time;     /* [s] */
    double mean;         /* integral over time [unit of the channel] */
    double rms;          /* root of the mean of squares [unit of the channel] */
    double integral;     /* over the time of all analyses [unit of the channel times s] */
    double last;         /* at the end [unit of the channel] */
} se3d_run_summary;

/* Count the columns that summaries of a run have. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_run_count_summaries(const se3d_run *run);

/* As se3d_run_get_summary, told the size of *summary in bytes. @return as se3d_run_get_summary, and
 * INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_run_get_summary_sized(const se3d_run *run, size_t index,
                                                se3d_run_summary *summary, size_t size);

/* Get a column of a summary.
 * @param[in] index  from 0, below se3d_run_count_summaries
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
static inline se3d_status se3d_run_get_summary(const se3d_run *run, size_t index,
                                               se3d_run_summary *summary)
{
    return se3d_run_get_summary_sized(run, index, summary, sizeof *summary);
}

/* A picture that the `output` of a model asks for. libse3d-io describes it only; the program `se3d`
 * makes it after the run, from the files that the run leaves. @since 0.1 */
typedef struct se3d_model_picture {
    const char *type;    /* "plot", "scene", "video"; owned by the model, as all texts here */
    const char *file;    /* to make; relative to the folder of the results */
    const char *results; /* plot: the CSV file it shows */
    const char *x;       /* plot: the channel of the horizontal axis; NULL: time */
    const char *const *channels; /* plot: [channel_count]; none: the usual ones */
    size_t channel_count;        /* of `channels` */
    double speed;                /* video: seconds of motion in one of film [s/s] */
    int32_t fft;                 /* plot: not 0: amplitudes over frequency */
    int32_t reserved;            /* 0 */
} se3d_model_picture;

/* Count the pictures that the `output` of a model asks for. @return the number; 0 for NULL.
 * @since 0.1 */
SE3D_API size_t se3d_model_count_pictures(const se3d_model *model);

/* As se3d_model_get_picture, told the size of *picture in bytes. @return as
 * se3d_model_get_picture, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_model_get_picture_sized(const se3d_model *model, size_t index,
                                                  se3d_model_picture *picture, size_t size);

/* Get a picture that the `output` of a model asks for.
 * @param[in] index  from 0, below se3d_model_count_pictures
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
static inline se3d_status se3d_model_get_picture(const se3d_model *model, size_t index,
                                                 se3d_model_picture *picture)
{
    return se3d_model_get_picture_sized(model, index, picture, sizeof *picture);
}

/* Create an empty scene of a model, which must outlive it. Reader (the model is not changed).
 * @return OK, NULL, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_scene_create(se3d_model *model, se3d_scene **out);

/* Destroy a scene; NULL is fine. Within the se3d_model_run that was given it nothing is destroyed.
 * @since 0.1 */
SE3D_API void se3d_scene_destroy(se3d_scene *scene);

/* Record the present poses, for example in the progress callback of a run. Times at or before
 * the last one are skipped; a long motion is thinned out evenly to at most 1250 samples. @return
 * OK, NULL. @since 0.1 */
SE3D_API se3d_status se3d_scene_record(se3d_scene *scene);

/* Write a scene as binary glTF 2.0 (.glb), under a temporary name first. An empty scene gets the
 * present poses.
 * @param[in] path    of the file
 * @param[out] error  filled on failure, emptied on success; may be NULL
 * @return OK, NULL, IO (see the message), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_scene_write(se3d_scene *scene, const char *path, se3d_model_error *error);

#ifdef __cplusplus
}
#endif
#endif
