/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d check MODEL: bodies, equations, freedoms, redundant and inconsistent constraints. */
#include <inttypes.h>
#include <stdio.h>

#include "options.h"
#include "outcome.h"
#include "text.h"
#include "warnings.h"

static void print_text(const se3d_model *model, const se3d_check_summary *s,
                       const se3d_check *check)
{
    const char *title = se3d_model_get_title(model);
    text_put_plain(stdout, se3d_model_get_name(model));
    fputs(title[0] ? ": " : "", stdout);
    text_put_plain(stdout, title);
    putchar('\n');
    put_count(s->bodies, "body", "bodies", ", ");
    put_count(se3d_system_count_constraints(se3d_model_get_system(model)), "constraint or driver",
              "constraints and drivers", ", ");
    put_count(se3d_system_count_forces(se3d_model_get_system(model)), "force", "forces", "\n");
    put_count(s->equations, "equation", "equations", "");
    printf(", rank %zu, %zu redundant, %zu inconsistent\n", s->rank, s->redundant, s->inconsistent);
    put_count(s->freedoms, "degree of freedom", "degrees of freedom", "");
    printf(" (Gruebler count %" PRId64 ")\n", s->gruebler);
    for (size_t k = 0; k < se3d_check_count_messages(check); ++k) {
        const char *text = NULL;
        if (!SE3D_FAILED(se3d_check_get_message(check, k, &text))) {
            printf("- %s\n", text);
        }
    }
}

static void print_json(const warnings *warned, const se3d_check_summary *s, const se3d_check *check)
{
    char strict[WARNING_SIZE];
    const char *why = warnings_get_verdict(warned, strict);
    outcome_tell();
    printf("{\"status\": \"%s\", \"model\": ", s->inconsistent > 0 || why[0] ? "failed" : "done");
    json_put_text(warned->o->model);
    fputs(", \"message\": ", stdout);
    json_put_text(s->inconsistent > 0 ? "constraints contradict each other" : why);
    printf(", \"bodies\": %zu, \"equations\": %zu, \"rank\": %zu, \"redundant\": %zu, "
           "\"inconsistent\": %zu, \"freedoms\": %zu, \"gruebler\": %" PRId64 ", \"messages\": [",
           s->bodies, s->equations, s->rank, s->redundant, s->inconsistent, s->freedoms,
           s->gruebler);
    for (size_t k = 0; k < se3d_check_count_messages(check); ++k) {
        const char *text = NULL;
        if (!SE3D_FAILED(se3d_check_get_message(check, k, &text))) {
            fputs(k > 0 ? ", " : "", stdout);
            json_put_text(text);
        }
    }
    fputs("], ", stdout);
    warnings_put_json(warned);
    fputs("}\n", stdout);
}

static int check_model(const warnings *warned, se3d_model *model)
{
    const options *o = warned->o;
    se3d_system *system = se3d_model_get_system(model);
    se3d_check *check = NULL;
    se3d_check_summary summary = {.struct_size = sizeof summary};
    if (SE3D_FAILED(se3d_check_create(system, &check)) ||
        SE3D_FAILED(se3d_check_get_summary(check, &summary))) {
        report_failure(o, o->model, se3d_system_get_error(system));
        se3d_check_destroy(check);
        return EXIT_FAILED;
    }
    if (o->json) {
        print_json(warned, &summary, check);
    } else if (!o->quiet) {
        print_text(model, &summary, check);
    }
    se3d_check_destroy(check);
    return summary.inconsistent > 0 ? EXIT_FAILED : warnings_forbid(warned, EXIT_DONE);
}

static int command_check(int count, char *const *words)
{
    options o;
    se3d_model *model = NULL;
    int code = options_read(&o, &check_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    se3d_model_options how = options_get_model(&o);
    warnings warned = {.o = &o};
    how.mass_optional = 1; /* constraints know no mass */
    how.log = warnings_add;
    how.log_ctx = &warned;
    code = options_read_model(&o, &how, &model);
    if (code == EXIT_DONE) {
        code = check_model(&warned, model);
    }
    se3d_model_destroy(model);
    return code;
}

const command_entry check_entry = {
    .name = "check",
    .run = command_check,
    .operands = "MODEL",
    .files = "yaml yml json",
    .summary = "count equations and freedoms, name redundant constraints",
    .text = "Reads a model and says how many bodies, equations and degrees of freedom it "
            "has at its present pose, and names redundant and inconsistent constraints "
            "and bodies that nothing holds. Warns of what is probably a mistake: parameters and "
            "points that nothing uses, bodies that fall, shapes that touch nothing, masses far "
            "apart, and bodies that the assembly moves by more than their size.",
    .options =
        (const command_option[]){COMMAND_OPTION_SET,
                                 COMMAND_OPTION_STRICT,
                                 {"--json", NULL, NULL, "print the counts and messages as JSON"},
                                 {0}},
    .examples = (const command_example[]){{"check suspension.yaml", "what the joints leave free"},
                                          {"check suspension.yaml --json", "the same for programs"},
                                          {0}},
    .exits =
        "0 done; 1 constraints contradict each other, or warnings with --strict; 2 bad usage or "
        "model.",
};
