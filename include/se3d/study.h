/* SPDX-License-Identifier: BSD-3-Clause */
/* Studies: many runs of one model with other parameters, as `study` of its model file asks for.
 *
 * Sample i is a function of the study and i alone: it may be run by any process, in any order, and
 * has the same bits. docs/theory/studies.md
 *
 * Threads: the rule of se3d/se3d.h; a study includes its model. */
#ifndef SE3D_STUDY_H
#define SE3D_STUDY_H

#include "se3d/io.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A study of a model. @since 0.1 */
typedef struct se3d_study se3d_study;

/* A table of samples that is being written: a row for each. @since 0.1 */
typedef struct se3d_study_table se3d_study_table;

/* Create a study of a model whose file has `study`. The model must outlive it; it is read again for
 * each sample from what is in memory, with the options that it was read with.
 * @param[out] error  filled on failure, emptied on success; may be NULL
 * @return OK, NULL, STATE (no `study`, or no analysis to measure), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_study_create(se3d_model *model, se3d_study **out,
                                       se3d_model_error *error);

/* Destroy a study; NULL is fine. While a sample runs (from its interrupt) nothing is destroyed.
 * @since 0.1 */
SE3D_API void se3d_study_destroy(se3d_study *study);

/* Count the samples. @return the number; 0 for NULL. @since 0.1 */
SE3D_API uint64_t se3d_study_count_samples(const se3d_study *study);

/* Count the parameters that vary. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_study_count_parameters(const se3d_study *study);

/* Get the name of a parameter that varies.
 * @param[in] index  from 0, below se3d_study_count_parameters
 * @return the text, owned by the model; "" for NULL or a
 * wrong index. @since 0.1 */
SE3D_API const char *se3d_study_get_parameter_name(const se3d_study *study, size_t index);

/* Count the measures. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_study_count_measures(const se3d_study *study);

/* Get the name of a measure.
 * @param[in] index  from 0, below se3d_study_count_measures
 * @return the text, owned by the model; "" for NULL or a wrong index.
 * @since 0.1 */
SE3D_API const char *se3d_study_get_measure_name(const se3d_study *study, size_t index);

/* Get the values of the parameters in a sample.
 * @param[in] sample       from 0, below se3d_study_count_samples
 * @param[out] parameters  [se3d_study_count_parameters], each in SI units if `study` gives it a
 *                         unit, else in those of the model file
 * @return OK, NULL, INVALID_ARGUMENT (sample).
 * @since 0.1 */
SE3D_API se3d_status se3d_study_get_sample(const se3d_study *study, uint64_t sample,
                                           double *parameters);

/* Run the model with other parameters and measure it.
 * @param[in] parameters  [se3d_study_count_parameters], as in se3d_study_get_sample
 * @param[out] measures   [se3d_study_count_measures], each in SI units; NaN: it has none
 * @param[out] error      filled on failure: why; may be NULL
 * @return OK, NULL, INVALID_ARGUMENT (a parameter is not finite), STATE (while a sample runs),
 *         NO_MEMORY, NOT_FINITE (a measure has no value: `error` says which, the others are good),
 *         or why the model could not be read or run: then all are NaN.
 * @since 0.1 */
SE3D_API se3d_status se3d_study_eval(se3d_study *study, const double *parameters, double *measures,
                                     se3d_model_error *error);

/* Run a sample and write its row of the table: its number, parameters, measures and `ok` or why it
 * failed, with commas between them and a line break at the end.
 * @param[in] sample  from 0, below se3d_study_count_samples
 * @param[out] row    the text, owned by the study until the next call
 * @return OK, NULL, INVALID_ARGUMENT (sample), STATE (while a sample runs), or as se3d_study_eval:
 *         then there is a row, too, but for NO_MEMORY and INTERRUPTED.
 * @since 0.1 */
SE3D_API se3d_status se3d_study_run_sample(se3d_study *study, uint64_t sample, const char **row);

/* Let runs ask whether they are to end: they fail with INTERRUPTED then. NULL: they do not ask.
 * @return OK, NULL. @since 0.1 */
SE3D_API se3d_status se3d_study_set_interrupt(se3d_study *study, se3d_interrupt interrupt,
                                              void *ctx);

/* Count the parameters of which derivatives are taken: those under `sensitivities` of the study, or
 * all that vary. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_study_count_sensitivities(const se3d_study *study);

/* Get the name of a parameter of which derivatives are taken.
 * @param[in] index  from 0, below se3d_study_count_sensitivities
 * @return the text, owned by the model; "" for NULL or a wrong index. @since 0.1 */
SE3D_API const char *se3d_study_get_sensitivity_name(const se3d_study *study, size_t index);

/* Run the model with its own parameters and measure it, as exactly as for derivatives: dynamics by
 * a method of high order at the tolerance 1e-11, if the options of the model ask for no other.
 * @param[out] measures  [se3d_study_count_measures], each in SI units; NaN: it has none
 * @param[out] error     filled on failure: why; may be NULL
 * @return as se3d_study_eval.
 * @since 0.1 */
SE3D_API se3d_status se3d_study_eval_nominal(se3d_study *study, double *measures,
                                             se3d_model_error *error);

/* Take the derivatives of all measures with respect to one parameter, where all parameters are as
 * in the model: of kinematics, inverse dynamics and equilibria by the implicit function theorem, of
 * dynamics by explicit methods with the steps of one run; else by differences of runs, extrapolated
 * to the step 0; of one side, where runs on the other one fail. docs/theory/sensitivities.md
 * @param[in] index         from 0, below se3d_study_count_sensitivities
 * @param[out] value        of the parameter, in SI units [SI] if it has a unit, else in those of
 *                          the file
 * @param[out] derivatives  [se3d_study_count_measures]; NaN: there is none
 * @param[out] errors       [se3d_study_count_measures] estimates of their errors; may be NULL
 * @param[out] error        filled on failure: why; may be NULL
 * @return OK, NULL, INVALID_ARGUMENT (index), STATE (while a sample runs), NO_MEMORY, INTERRUPTED,
 *         NOT_FINITE (a measure has no value: the others have their derivatives), or why the model
 *         could not be run.
 * @since 0.1 */
SE3D_API se3d_status se3d_study_eval_sensitivity(se3d_study *study, size_t index, double *value,
                                                 double *derivatives, double *errors,
                                                 se3d_model_error *error);

/* What a study seeks, as `optimize` of its file says. @since 0.1 */
typedef struct se3d_study_goal {
    const char *method;   /* "cobyla", "slsqp", ...; owned by the library */
    int32_t maximizes;    /* not 0: the measure is to be the greatest, else the least */
    int32_t reserved;     /* 0 */
    size_t measure;       /* index of the measure */
    uint64_t evaluations; /* of the measures, at most */
    double tolerance;     /* end below steps of this share of the bounds [1] */
    uint64_t seed;        /* of methods that draw */
} se3d_study_goal;

/* As se3d_study_get_goal, told the size of *goal in bytes. @return as se3d_study_get_goal, and
 * INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_study_get_goal_sized(const se3d_study *study, se3d_study_goal *goal,
                                               size_t size);

/* Get what a study seeks. @return OK, NULL, STATE (nothing). @since 0.1 */
static inline se3d_status se3d_study_get_goal(const se3d_study *study, se3d_study_goal *goal)
{
    return se3d_study_get_goal_sized(study, goal, sizeof *goal);
}

/* Count the parameters that are sought. @return the number; 0 for NULL, or if there are none.
 * @since 0.1 */
SE3D_API size_t se3d_study_count_unknowns(const se3d_study *study);

/* Get the name of a parameter that is sought.
 * @param[in] index  from 0, below se3d_study_count_unknowns
 * @return the text, owned by the model; "" for NULL or a wrong index. @since 0.1 */
SE3D_API const char *se3d_study_get_unknown_name(const se3d_study *study, size_t index);

/* Get between what a parameter is sought, and from where.
 * @param[in] index    from 0, below se3d_study_count_unknowns
 * @param[out] bounds  the least and the greatest value, in SI units [SI] if `optimize` gives it a
 *                     unit, else in those of the file
 * @param[out] start   the first value, in the same unit [SI]
 * @return OK, NULL, INVALID_ARGUMENT (index). @since 0.1 */
SE3D_API se3d_status se3d_study_get_unknown(const se3d_study *study, size_t index, double bounds[2],
                                            double *start);

/* Write a value of a parameter that is sought as the model file takes it, and --set: "0.2 kg*m^2".
 * @param[in] index  from 0, below se3d_study_count_unknowns
 * @param[in] value  as in se3d_study_get_unknown [SI]
 * @param[out] text  [size] with a 0 at its end
 * @param[in] size   at least 100
 * @return OK, NULL, INVALID_ARGUMENT (index, size). @since 0.1 */
SE3D_API se3d_status se3d_study_write_unknown(const se3d_study *study, size_t index, double value,
                                              char *text, size_t size);

/* Count the measures that are limited. @return the number; 0 for NULL, or if there are none.
 * @since 0.1 */
SE3D_API size_t se3d_study_count_limits(const se3d_study *study);

/* Get the limits of a measure.
 * @param[in] index     from 0, below se3d_study_count_limits
 * @param[out] measure  its index
 * @param[out] bounds   the least and the greatest value [SI], as numbers in the frame of the
 *                      measure; infinite: none; equal: the only value
 * @return OK, NULL, INVALID_ARGUMENT (index). @since 0.1 */
SE3D_API se3d_status se3d_study_get_limit(const se3d_study *study, size_t index, size_t *measure,
                                          double bounds[2]);

/* Run the model with values of the parameters that are sought, and measure it.
 * @param[in] values        [se3d_study_count_unknowns], as in se3d_study_get_unknown [SI]
 * @param[out] measures     [se3d_study_count_measures], each in SI units; NaN: it has none
 * @param[out] derivatives  [se3d_study_count_unknowns][se3d_study_count_measures] of each measure
 *                          with respect to each parameter, exact to about 1e-9 if models can
 *                          follow the run (se3d_solver_follow), else by differences of fourth order
 *                          of runs within its bounds; NaN: there is none; NULL: not wanted
 * @param[out] error        filled on failure: why; may be NULL
 * @return OK, NULL, INVALID_ARGUMENT (a value is not finite), STATE (nothing is sought, or while a
 *         sample runs), or as se3d_study_eval.
 * @since 0.1 */
SE3D_API se3d_status se3d_study_eval_unknowns(se3d_study *study, const double *values,
                                              double *measures, double *derivatives,
                                              se3d_model_error *error);

/* Answer a request in JSON, {"id": 1, "parameters": {"m": 2}}, with {"id": 1, "measures": {"top":
 * 0.5}}; what fails has "error". Any parameter of the model may be given, in the units of its file;
 * those that are not are as in the file, all of them in {"id": 1}. {"id": 1, "sample": 7} runs a
 * sample of the study.
 * @param[in] request  [length] one object, UTF-8
 * @param[in] length   in bytes
 * @param[out] reply   the text, without a line break, owned by the study until the next call
 * @return OK, also if the reply is an error; NULL, STATE (while a sample runs), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_study_answer(se3d_study *study, const char *request, size_t length,
                                       const char **reply);

/* Which samples a table has, and where it is. @since 0.1 */
typedef struct se3d_study_table_def {
    size_t struct_size;
    const char *path; /* of the file, required; its folder is made if missing */
    uint32_t shard;   /* from 1 to `shards`: samples shard - 1, shard - 1 + shards, ... */
    uint32_t shards;  /* into how many tables the samples are divided; default 1 of 1 */
    int32_t resume;   /* not 0: go on with what is there; 0: nothing may be there */
    int32_t reserved; /* 0 */
} se3d_study_table_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_study_table_def_default. @since 0.1 */
SE3D_API void se3d_study_table_def_init(se3d_study_table_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_study_table_def se3d_study_table_def_default(void)
{
    se3d_study_table_def def;
    se3d_study_table_def_init(&def, sizeof def);
    return def;
}

/* Open a table. A line that a kill has torn is dropped. The study must outlive the table.
 * @param[out] error  filled on failure, emptied on success; may be NULL
 * @return OK, NULL, INVALID_ARGUMENT (def), STATE (the file is there, or of another model, study or
 *         version, or damaged, or open in another process), IO, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_study_table_open(se3d_study *study, const se3d_study_table_def *def,
                                           se3d_study_table **out, se3d_model_error *error);

/* Tell whether a table has the row of a sample.
 * @param[in] sample  from 0
 * @return 1 or 0; 0 for NULL. @since 0.1 */
SE3D_API int se3d_study_table_has(const se3d_study_table *table, uint64_t sample);

/* Count the rows of samples that failed. @return the number; 0 for NULL. @since 0.1 */
SE3D_API uint64_t se3d_study_table_count_failed(const se3d_study_table *table);

/* Append a row of se3d_study_run_sample: it is on its way to the disk when the call returns.
 * @param[in] row     the text
 * @param[out] error  filled on failure; may be NULL
 * @return OK, NULL, INVALID_ARGUMENT (no row of this table, or one that it has), IO.
 * @since 0.1 */
SE3D_API se3d_status se3d_study_table_append(se3d_study_table *table, const char *row,
                                             se3d_model_error *error);

/* Close a table; NULL is fine. @since 0.1 */
SE3D_API void se3d_study_table_close(se3d_study_table *table);

/* How to merge tables. @since 0.1 */
typedef struct se3d_study_merge_options {
    size_t struct_size;
    se3d_model_report report; /* of every problem; NULL: none */
    void *ctx;                /* of `report` */
    int32_t partial;          /* not 0: write what is there although samples are missing */
    int32_t reserved;         /* 0 */
} se3d_study_merge_options;

/* Fill `options`, of `size` bytes, with the defaults: see se3d_study_merge_options_default.
 * @since 0.1 */
SE3D_API void se3d_study_merge_options_init(se3d_study_merge_options *options, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_study_merge_options se3d_study_merge_options_default(void)
{
    se3d_study_merge_options how;
    se3d_study_merge_options_init(&how, sizeof how);
    return how;
}

/* Merge tables into one in the order of the samples, with the bytes of a table that was never
 * divided. Missing samples, samples with two different rows, and files of another model or study
 * are reported.
 * @param[in] paths    [count] of the tables
 * @param[in] count    how many tables there are
 * @param[in] path     of the file to write, under a temporary name first
 * @param[in] options  NULL: the defaults
 * @param[out] failed  how many samples failed; may be NULL
 * @param[out] error   filled on failure; may be NULL
 * @return OK, NULL, INVALID_ARGUMENT (options), STATE (there were problems: the file is written
 *         only with `partial`), IO, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_study_merge(se3d_study *study, const char *const *paths, size_t count,
                                      const char *path, const se3d_study_merge_options *options,
                                      uint64_t *failed, se3d_model_error *error);

#ifdef __cplusplus
}
#endif

#endif
