/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d check MODEL: bodies, equations, freedoms, redundant and inconsistent constraints. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "options.h"
#include "outcome.h"
#include "preview.h"
#include "text.h"
#include "warnings.h"

static void put_bytes(uint64_t bytes)
{
    static const char *const units[] = {"kB", "MB", "GB"};
    double size = 1e-3 * (double)bytes;
    int k = 0;
    for (; k < 2 && size >= 999.5; ++k) {
        size *= 1e-3;
    }
    printf("%.3g %s", size, units[k]);
}

/* "2.5 minutes" */
static void put_time(double seconds)
{
    const int unit = seconds < 100.0 ? 0 : seconds < 6000.0 ? 1 : seconds < 3.6e5 ? 2 : 3;
    static const struct {
        double length;
        const char *name;
    } units[] = {{1.0, "s"}, {60.0, "minutes"}, {3600.0, "hours"}, {86400.0, "days"}};
    printf("%.2g %s", seconds / units[unit].length, units[unit].name);
}

/* The longest step that is safe, as a part of what contacts take. */
static void print_step(const preview *g, int32_t law)
{
    if (!(g->step > 0.0)) {
        puts("; its step follows from what comes");
        return;
    }
    printf("; steps of %.3g s", g->step);
    if (!(g->automatic > 0.0)) {
        puts("");
    } else if (law < 0) {
        printf(", %.3g of the longest that is safe\n", g->step / g->automatic);
    } else if (law == SE3D_CONTACT_LAW_HERTZ_MINDLIN) {
        printf(", %.3g %% of the time of a Rayleigh wave\n", 2.5 * g->step / g->automatic);
    } else {
        printf(", 1/%.3g of the time of a contact\n", 50.0 * g->automatic / g->step);
    }
}

/* The law of all contacts, -1: pairs of materials have others. */
static int32_t law_of_all(const se3d_system *system)
{
    se3d_contact_settings contact = se3d_contact_settings_default();
    (void)se3d_system_get_contact(system, &contact);
    const size_t count = se3d_system_count_materials(system);
    for (size_t k = 0; k < count; ++k) {
        for (size_t j = 0; j <= k; ++j) {
            se3d_material a, b;
            se3d_material_pair_def pair = se3d_material_pair_def_default();
            (void)se3d_system_get_material(system, k, &a);
            (void)se3d_system_get_material(system, j, &b);
            if (se3d_material_get_pair(system, a, b, &pair) == SE3D_OK && pair.law >= 0 &&
                pair.law != contact.law) {
                return -1;
            }
        }
    }
    return contact.law;
}

/* How fast particles may hit. */
static void print_held(const preview *g)
{
    if (!(g->held.speed > 0.0)) {
        printf("their attraction alone may press them in by more than the overlap_limit, %g of the "
               "radius: give more stiffness or less adhesion\n",
               g->held.limit);
    } else if (isfinite(g->held.speed)) {
        printf("impacts below %.3g m/s stay within the overlap_limit, %g of the radius\n",
               g->held.speed, g->held.limit);
    }
}

static void print_particles(const se3d_model *model)
{
    const se3d_system *system = se3d_model_get_system(model);
    const size_t count = se3d_system_count_particles(system);
    const int32_t law = law_of_all(system);
    for (size_t k = 0; k < count; ++k) {
        preview g;
        if (!preview_look(model, k, &g)) {
            continue;
        }
        text_put_plain(stdout, g.name[0] ? g.name : "particles");
        fputs(": ", stdout);
        put_count(g.count, "particle", "particles", "");
        if (g.count > 0) {
            printf(" of radius %.4g", g.radius_min);
            if (g.radius_max > g.radius_min) {
                printf(" to %.4g", g.radius_max);
            }
            fputs(" m, ", stdout);
        }
        if (g.clumps > 0) {
            put_count(g.clumps, "clump", "clumps", ", ");
        }
        if (g.count > 0) {
            put_bytes(g.bytes);
        }
        print_step(&g, law);
        print_held(&g);
    }
    if (count > 0) {
        preview_pace pace;
        preview_try(model, &pace);
        if (pace.is_known) {
            printf("%.3g steps to the end, about ", pace.steps);
            put_time(pace.seconds);
            puts(" at the pace of the first ones");
        } else if (pace.message[0]) {
            fputs("the first steps fail: ", stdout);
            text_put_plain(stdout, pace.message);
            putchar('\n');
        }
    }
}

static void print_json_particles(const se3d_model *model)
{
    const size_t count = se3d_system_count_particles(se3d_model_get_system(model));
    preview_pace pace = {0};
    fputs("\"particles\": [", stdout);
    for (size_t k = 0; k < count; ++k) {
        preview g;
        if (!preview_look(model, k, &g)) {
            continue;
        }
        fputs(k > 0 ? ", {\"name\": " : "{\"name\": ", stdout);
        json_put_text(g.name);
        printf(", \"count\": %" PRIu64 ", \"clumps\": %" PRIu64 ", \"bytes\": %" PRIu64, g.count,
               g.clumps, g.bytes);
        const struct {
            const char *name;
            double value;
        } numbers[] = {{"radius_min", g.radius_min},
                       {"radius_max", g.radius_max},
                       {"step", g.step},
                       {"automatic_step", g.automatic},
                       {"speed_limit", g.held.speed}};
        for (size_t n = 0; n < sizeof numbers / sizeof *numbers; ++n) {
            printf(", \"%s\": ", numbers[n].name);
            json_put_number(numbers[n].value);
        }
        putchar('}');
    }
    fputs("], ", stdout);
    if (count > 0) {
        preview_try(model, &pace);
        fputs("\"steps\": ", stdout);
        json_put_number(pace.is_known ? pace.steps : (double)NAN);
        fputs(", \"seconds\": ", stdout);
        json_put_number(pace.is_known ? pace.seconds : (double)NAN);
        fputs(", \"first_steps\": ", stdout);
        json_put_text(pace.message);
        fputs(", ", stdout);
    }
}

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
    print_particles(model);
}

static void print_json(const warnings *warned, const se3d_model *model, const se3d_check_summary *s,
                       const se3d_check *check)
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
    print_json_particles(model);
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
        print_json(warned, model, &summary, check);
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
    .text =
        "Reads a model and says how many bodies, equations and degrees of freedom it "
        "has at its present pose, and names redundant and inconsistent constraints "
        "and bodies that nothing holds. Warns of what is probably a mistake: parameters and "
        "points that nothing uses, bodies that fall, shapes that touch nothing, masses far "
        "apart, and bodies that the assembly moves by more than their size. Of particles it says "
        "how many there are, their step beside the time of a contact, and, from the first "
        "steps, which it takes for a quarter of a second, how many there will be and how long "
        "they take.",
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
