/* SPDX-License-Identifier: BSD-3-Clause */
/* Studies: what their functions do with NULL, wrong numbers and files that are not theirs. Included
 * by test_io_functions.c only. */
#ifndef SE3D_TESTS_MISUSE_STUDIES_H
#define SE3D_TESTS_MISUSE_STUDIES_H

static const char study_text[] =
    "se3d: 1\nparameters: {h: 1}\n"
    "bodies: [{name: block, mass: 1, inertia: [1, 1, 1], position: [0, 0, h]}]\n"
    "analysis: {type: assembly}\n"
    "study: {parameters: {h: [1, 2, 3]}, measures: {z: {final: block.position.z}}}\n";

typedef struct study_world {
    se3d_model *model;
    se3d_study *study;
    char path[900];
} study_world;

static study_world open_study_of(const world *w, const char *of)
{
    study_world s = {NULL, NULL, ""};
    snprintf(s.path, sizeof s.path, "%s/study.csv", w->folder);
    remove(s.path);
    IS(se3d_model_read_text(of, strlen(of), "s.yaml", NULL, &s.model, NULL), SE3D_OK);
    IS(se3d_study_create(s.model, &s.study, NULL), SE3D_OK);
    return s;
}

static study_world open_study(const world *w)
{
    return open_study_of(w, study_text);
}

static void close_study(study_world *s)
{
    se3d_study_destroy(s->study);
    se3d_model_destroy(s->model);
    remove(s->path);
}

static void study_create(const world *w)
{
    study_world s = open_study(w);
    se3d_study *study = s.study;
    se3d_model_error error;
    IS(se3d_study_create(NULL, &study, &error), SE3D_ERR_NULL);
    CHECK(study == NULL && error.message[0]);
    IS(se3d_study_create(s.model, NULL, &error), SE3D_ERR_NULL);
    IS(se3d_study_create(w->model, &study, &error), SE3D_ERR_STATE);
    CHECK(study == NULL);
    CHECK_CONTAINS(error.message, "the model has no `study`");
    se3d_study_destroy(NULL);
    close_study(&s);
}

static void study_getters(const world *w)
{
    study_world s = open_study(w);
    double value = 0.0;
    CHECK(se3d_study_count_samples(NULL) == 0 && se3d_study_count_samples(s.study) == 3);
    CHECK(se3d_study_count_parameters(NULL) == 0 && se3d_study_count_parameters(s.study) == 1);
    CHECK(se3d_study_count_measures(NULL) == 0 && se3d_study_count_measures(s.study) == 1);
    CHECK(!se3d_study_get_parameter_name(NULL, 0)[0] && !se3d_study_get_measure_name(NULL, 0)[0]);
    CHECK(!se3d_study_get_parameter_name(s.study, 1)[0]);
    CHECK(!se3d_study_get_measure_name(s.study, SIZE_MAX)[0]);
    CHECK(strcmp(se3d_study_get_parameter_name(s.study, 0), "h") == 0);
    CHECK(strcmp(se3d_study_get_measure_name(s.study, 0), "z") == 0);
    IS(se3d_study_get_sample(NULL, 0, &value), SE3D_ERR_NULL);
    IS(se3d_study_get_sample(s.study, 0, NULL), SE3D_ERR_NULL);
    IS(se3d_study_get_sample(s.study, 3, &value), SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_study_get_sample(s.study, 2, &value), SE3D_OK);
    CHECK_NEAR(value, 3.0, 0.0);
    close_study(&s);
}

static int ask_for_end(void *ctx)
{
    (void)ctx;
    return 1;
}

static void study_runs(const world *w)
{
    study_world s = open_study(w);
    double h = 4.0, z = 0.0;
    const char *line = NULL;
    IS(se3d_study_eval(NULL, &h, &z, NULL), SE3D_ERR_NULL);
    IS(se3d_study_eval(s.study, NULL, &z, NULL), SE3D_ERR_NULL);
    IS(se3d_study_eval(s.study, &h, NULL, NULL), SE3D_ERR_NULL);
    IS(se3d_study_eval(s.study, &h, &z, NULL), SE3D_OK);
    CHECK_NEAR(z, 4.0, 0.0);
    h = HUGE_VAL;
    IS(se3d_study_eval(s.study, &h, &z, NULL), SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_study_run_sample(NULL, 0, &line), SE3D_ERR_NULL);
    CHECK(line && !line[0]);
    IS(se3d_study_run_sample(s.study, 0, NULL), SE3D_ERR_NULL);
    IS(se3d_study_run_sample(s.study, 3, &line), SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_study_answer(NULL, "{}", 2, &line), SE3D_ERR_NULL);
    IS(se3d_study_answer(s.study, NULL, 2, &line), SE3D_ERR_NULL);
    IS(se3d_study_answer(s.study, "{}", 2, NULL), SE3D_ERR_NULL);
    IS(se3d_study_set_interrupt(NULL, ask_for_end, NULL), SE3D_ERR_NULL);
    IS(se3d_study_set_interrupt(s.study, NULL, NULL), SE3D_OK);
    IS(se3d_study_run_sample(s.study, 0, &line), SE3D_OK);
    CHECK(strcmp(line, "0,1,1,ok\n") == 0);
    close_study(&s);
}

static void study_sensitivities(const world *w)
{
    study_world s = open_study(w);
    double h = 4.0, z = 0.0, slope = 0.0, error = 0.0;
    CHECK(se3d_study_count_sensitivities(NULL) == 0);
    CHECK(se3d_study_count_sensitivities(s.study) == 1);
    CHECK(!se3d_study_get_sensitivity_name(NULL, 0)[0]);
    CHECK(!se3d_study_get_sensitivity_name(s.study, 1)[0]);
    CHECK(strcmp(se3d_study_get_sensitivity_name(s.study, 0), "h") == 0);
    IS(se3d_study_eval_nominal(NULL, &z, NULL), SE3D_ERR_NULL);
    IS(se3d_study_eval_nominal(s.study, NULL, NULL), SE3D_ERR_NULL);
    IS(se3d_study_eval_nominal(s.study, &z, NULL), SE3D_OK);
    CHECK_NEAR(z, 1.0, 0.0);
    IS(se3d_study_eval_sensitivity(NULL, 0, &h, &slope, &error, NULL), SE3D_ERR_NULL);
    IS(se3d_study_eval_sensitivity(s.study, 0, NULL, &slope, &error, NULL), SE3D_ERR_NULL);
    IS(se3d_study_eval_sensitivity(s.study, 0, &h, NULL, &error, NULL), SE3D_ERR_NULL);
    IS(se3d_study_eval_sensitivity(s.study, 1, &h, &slope, &error, NULL),
       SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_study_eval_sensitivity(s.study, 0, &h, &slope, NULL, NULL), SE3D_OK);
    CHECK_NEAR(h, 1.0, 0.0);
    CHECK_NEAR(slope, 1.0, 1e-12);
    close_study(&s);
}

static const char study_search[] =
    "se3d: 1\nparameters: {h: 1}\n"
    "bodies: [{name: block, mass: 1, inertia: [1, 1, 1], position: [0, 0, h]}]\n"
    "analysis: {type: assembly}\n"
    "study: {measures: {z: {final: block.position.z}}, optimize: {minimize: z, "
    "parameters: {h: {from: 0, to: 2}}, constraints: {z: {from: 0.5}}}}\n";

static void study_goals(const world *w)
{
    study_world s = open_study_of(w, study_search), none = open_study(w);
    double h = 4.0, z = 0.0, bounds[2];
    char written[100];
    size_t measure = 0;
    se3d_study_goal goal;
    IS(se3d_study_get_goal(NULL, &goal), SE3D_ERR_NULL);
    IS(se3d_study_get_goal(s.study, NULL), SE3D_ERR_NULL);
    IS(se3d_study_get_goal(none.study, &goal), SE3D_ERR_STATE);
    IS(se3d_study_get_goal_sized(s.study, &goal, 0), SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_study_get_goal(s.study, &goal), SE3D_OK);
    CHECK(se3d_study_count_unknowns(NULL) + se3d_study_count_unknowns(none.study) == 0);
    CHECK(se3d_study_count_limits(NULL) + se3d_study_count_limits(none.study) == 0);
    CHECK(!se3d_study_get_unknown_name(NULL, 0)[0]);
    CHECK(!se3d_study_get_unknown_name(s.study, 1)[0]);
    IS(se3d_study_get_unknown(NULL, 0, bounds, &h), SE3D_ERR_NULL);
    IS(se3d_study_get_unknown(s.study, 0, NULL, &h), SE3D_ERR_NULL);
    IS(se3d_study_get_unknown(s.study, 0, bounds, NULL), SE3D_ERR_NULL);
    IS(se3d_study_get_unknown(s.study, 1, bounds, &h), SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_study_write_unknown(NULL, 0, 1.0, written, sizeof written), SE3D_ERR_NULL);
    IS(se3d_study_write_unknown(s.study, 0, 1.0, NULL, sizeof text), SE3D_ERR_NULL);
    IS(se3d_study_write_unknown(s.study, 1, 1.0, written, sizeof written),
       SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_study_write_unknown(s.study, 0, 1.0, written, 99), SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_study_get_limit(NULL, 0, &measure, bounds), SE3D_ERR_NULL);
    IS(se3d_study_get_limit(s.study, 0, NULL, bounds), SE3D_ERR_NULL);
    IS(se3d_study_get_limit(s.study, 0, &measure, NULL), SE3D_ERR_NULL);
    IS(se3d_study_get_limit(s.study, 1, &measure, bounds), SE3D_ERR_INVALID_ARGUMENT);
    IS(se3d_study_eval_unknowns(NULL, &h, &z, NULL, NULL), SE3D_ERR_NULL);
    IS(se3d_study_eval_unknowns(s.study, NULL, &z, NULL, NULL), SE3D_ERR_NULL);
    IS(se3d_study_eval_unknowns(s.study, &h, NULL, NULL, NULL), SE3D_ERR_NULL);
    IS(se3d_study_eval_unknowns(none.study, &h, &z, NULL, NULL), SE3D_ERR_STATE);
    IS(se3d_study_eval_unknowns(s.study, &h, &z, NULL, NULL), SE3D_OK);
    CHECK_NEAR(z, 4.0, 0.0);
    h = (double)NAN;
    IS(se3d_study_eval_unknowns(s.study, &h, &z, NULL, NULL), SE3D_ERR_INVALID_ARGUMENT);
    close_study(&s);
    close_study(&none);
}

static const char study_motion[] =
    "se3d: 1\nparameters: {h: 1}\n"
    "bodies: [{name: block, mass: 1, inertia: [1, 1, 1], position: [0, 0, h]}]\n"
    "analysis: {type: dynamics, duration: 0.01, step: 0.01}\n"
    "study: {parameters: {h: [1, 2, 3]}, measures: {z: {initial: block.position.z}}}\n";
/* One analysis before the one that is measured. */
static const char study_motions[] =
    "se3d: 1\nparameters: {h: 1}\n"
    "bodies: [{name: block, mass: 1, inertia: [1, 1, 1], position: [0, 0, h]}]\n"
    "analysis: [{type: dynamics, duration: 0.01}, {type: dynamics, duration: 0.01}]\n"
    "study: {parameters: {h: [1, 2, 3]}, measures: {z: {final: block.position.z}}}\n";
static int study_meddled;

/* From the interrupt of a sample neither the study nor its model can be run again or taken away. */
static int meddle_with_study(void *ctx)
{
    const study_world *s = ctx;
    se3d_study *study = s->study;
    double h = 4.0, z = 0.0;
    const char *line = NULL;
    se3d_model_error error;
    IS(se3d_study_eval(study, &h, &z, &error), SE3D_ERR_STATE);
    CHECK_CONTAINS(error.message, "is being run");
    IS(se3d_study_run_sample(study, 0, &line), SE3D_ERR_STATE);
    IS(se3d_study_answer(study, "{\"sample\": 0}", 13, &line), SE3D_ERR_STATE);
    IS(se3d_study_eval_nominal(study, &z, &error), SE3D_ERR_STATE);
    IS(se3d_study_eval_sensitivity(study, 0, &h, &z, NULL, &error), SE3D_ERR_STATE);
    se3d_study_destroy(study);
    se3d_model_destroy(s->model); /* whose tree the sample is read from */
    ++study_meddled;
    return 0;
}

static void study_keeps_its_sample(const world *w)
{
    study_world s = open_study_of(w, study_motion);
    double h = 4.0, z = 0.0;
    const char *line = NULL;
    IS(se3d_study_set_interrupt(s.study, meddle_with_study, &s), SE3D_OK);
    IS(se3d_study_eval(s.study, &h, &z, NULL), SE3D_OK);
    CHECK_NEAR(z, 4.0, 0.0);
    IS(se3d_study_run_sample(s.study, 0, &line), SE3D_OK);
    CHECK(strcmp(line, "0,1,1,ok\n") == 0);
    IS(se3d_study_answer(s.study, "{\"id\": 1, \"sample\": 1}", 22, &line), SE3D_OK);
    CHECK_CONTAINS(line, "\"z\": 2");
    CHECK(study_meddled >= 3);
    close_study(&s);
}

/* The same while models beside the point are brought to where they follow its run. */
static void study_keeps_its_neighbours(const world *w)
{
    study_world s = open_study_of(w, study_motions);
    double h = 4.0, z = 0.0, slope = 0.0;
    IS(se3d_study_set_interrupt(s.study, meddle_with_study, &s), SE3D_OK);
    study_meddled = 0;
    IS(se3d_study_eval_nominal(s.study, &z, NULL), SE3D_OK);
    const int once = study_meddled;
    IS(se3d_study_eval_sensitivity(s.study, 0, &h, &slope, NULL, NULL), SE3D_OK);
    CHECK_NEAR(slope, 1.0, 1e-9);
    CHECK(once > 0 && study_meddled >= 10 * once);
    close_study(&s);
}

static void study_table_definitions(const world *w)
{
    study_world s = open_study(w);
    se3d_study_table *table = NULL;
    se3d_study_table_def def = {.shards = 9};
    se3d_model_error error;
    se3d_study_table_def_init(NULL, sizeof def);
    se3d_study_table_def_init(&def, 1);
    CHECK(def.shards == 9);
    def = se3d_study_table_def_default();
    CHECK(def.shard == 1 && def.shards == 1);
    IS(se3d_study_table_open(s.study, &def, &table, &error), SE3D_ERR_INVALID_ARGUMENT);
    def.path = s.path;
    IS(se3d_study_table_open(NULL, &def, &table, &error), SE3D_ERR_NULL);
    IS(se3d_study_table_open(s.study, NULL, &table, &error), SE3D_ERR_NULL);
    IS(se3d_study_table_open(s.study, &def, NULL, &error), SE3D_ERR_NULL);
    def.shard = 2;
    IS(se3d_study_table_open(s.study, &def, &table, &error), SE3D_ERR_INVALID_ARGUMENT);
    def.shard = 0;
    IS(se3d_study_table_open(s.study, &def, &table, &error), SE3D_ERR_INVALID_ARGUMENT);
    def.shard = 1;
    def.struct_size = 4096;
    IS(se3d_study_table_open(s.study, &def, &table, &error), SE3D_ERR_INVALID_ARGUMENT);
    def.struct_size = sizeof def;
    def.path = "/dev/null/a/b.csv";
    IS(se3d_study_table_open(s.study, &def, &table, &error), SE3D_ERR_IO);
    CHECK_CONTAINS(error.message, "/dev/null/a/b.csv: cannot be written");
    def.path = w->folder;
    IS(se3d_study_table_open(s.study, &def, &table, NULL), SE3D_ERR_IO);
    CHECK(table == NULL);
    close_study(&s);
}

static void study_tables(const world *w)
{
    static const char *const wrong[] = {"",
                                        "0",
                                        "0,1,1,ok",
                                        "3,1,1,ok\n",
                                        "0,1,ok\n",
                                        "0,1,1,1,ok\n",
                                        "x,1,1,ok\n",
                                        "0,1,1,\"ok\n",
                                        "0,1,1,ok\n1,2,2,ok\n"};
    study_world s = open_study(w);
    se3d_study_table *table = NULL, *other = NULL;
    se3d_study_table_def def = se3d_study_table_def_default();
    se3d_model_error error;
    def.path = s.path;
    IS(se3d_study_table_open(s.study, &def, &table, &error), SE3D_OK);
    IS(se3d_study_table_append(NULL, "0,1,1,ok\n", &error), SE3D_ERR_NULL);
    IS(se3d_study_table_append(table, NULL, &error), SE3D_ERR_NULL);
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
        IS(se3d_study_table_append(table, wrong[k], &error), SE3D_ERR_INVALID_ARGUMENT);
    }
    IS(se3d_study_table_append(table, "1,2,,\"a, b\"\n", &error), SE3D_OK);
    IS(se3d_study_table_append(table, "1,2,2,ok\n", NULL), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_study_table_has(table, 1) && !se3d_study_table_has(table, 0));
    CHECK(!se3d_study_table_has(table, 99) && !se3d_study_table_has(NULL, 0));
    CHECK(se3d_study_table_count_failed(table) == 1 && se3d_study_table_count_failed(NULL) == 0);
    se3d_study_table_close(table);
    se3d_study_table_close(NULL);
    IS(se3d_study_table_open(s.study, &def, &other, &error), SE3D_ERR_STATE);
    CHECK(other == NULL);
    CHECK_CONTAINS(error.message, "is there already");
    def.resume = 1;
    IS(se3d_study_table_open(s.study, &def, &other, &error), SE3D_OK);
    CHECK(se3d_study_table_has(other, 1) && se3d_study_table_count_failed(other) == 1);
    se3d_study_table_close(other);
    close_study(&s);
}

static void study_merge(const world *w)
{
    study_world s = open_study(w);
    const char *paths[] = {s.path};
    se3d_study_merge_options how = {.partial = 7};
    se3d_model_error error;
    uint64_t failed = 3;
    se3d_study_merge_options_init(NULL, sizeof how);
    se3d_study_merge_options_init(&how, 1);
    CHECK(how.partial == 7);
    how = se3d_study_merge_options_default();
    IS(se3d_study_merge(NULL, paths, 1, s.path, &how, &failed, &error), SE3D_ERR_NULL);
    CHECK(failed == 0 && error.message[0]);
    IS(se3d_study_merge(s.study, NULL, 1, s.path, &how, NULL, &error), SE3D_ERR_NULL);
    IS(se3d_study_merge(s.study, paths, 1, NULL, &how, NULL, &error), SE3D_ERR_NULL);
    IS(se3d_study_merge(s.study, paths, 1, s.path, &how, NULL, &error), SE3D_ERR_IO);
    IS(se3d_study_merge(s.study, NULL, 0, s.path, NULL, NULL, &error), SE3D_ERR_STATE);
    CHECK_CONTAINS(error.message, "samples 0 to 2 are missing");
    how.struct_size = 3;
    IS(se3d_study_merge(s.study, NULL, 0, s.path, &how, NULL, &error), SE3D_ERR_INVALID_ARGUMENT);
    how = se3d_study_merge_options_default();
    how.partial = 1;
    IS(se3d_study_merge(s.study, NULL, 0, "/dev/null/a.csv", &how, NULL, NULL), SE3D_ERR_IO);
    close_study(&s);
}

#endif
