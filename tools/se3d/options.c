/* SPDX-License-Identifier: BSD-3-Clause */
/* Reading the command line. */
#include "options.h"
#include "outcome.h"

#include <stdio.h>
#include <string.h>

static int usage_error(const char *command, const char *what, const char *word)
{
    complain("se3d %s: %s `%s`; see `se3d help %s`\n", command, what, word, command);
    return EXIT_USAGE;
}

static int put_setting(options *o, const char *command, const char *name, size_t length,
                       const char *value)
{
    if (o->setting_count == SETTINGS_MAX) {
        return usage_error(command, "too many --set, no room for", name);
    }
    memcpy(o->names[o->setting_count], name, length);
    o->names[o->setting_count][length] = '\0';
    o->settings[o->setting_count].name = o->names[o->setting_count];
    o->settings[o->setting_count].value = value;
    ++o->setting_count;
    return EXIT_DONE;
}

static int add_setting(options *o, const char *command, const char *text)
{
    const char *equals = strchr(text, '=');
    if (!equals || equals == text || !equals[1]) {
        return usage_error(command, "--set needs NAME=VALUE, not", text);
    }
    const size_t length = (size_t)(equals - text);
    if (length >= sizeof o->names[0]) {
        return usage_error(command, "this name is too long:", text);
    }
    return put_setting(o, command, text, length, equals + 1);
}

static int add_caption(options *o, const char *command, const char *text)
{
    if (o->caption_count == CAPTIONS_MAX) {
        return usage_error(command, "too many --caption, no room for", text);
    }
    o->captions[o->caption_count++] = text;
    return EXIT_DONE;
}

/* The place that the value of an option goes to; NULL: it has none or is unknown. */
static const char **value_target(options *o, const char *name)
{
    const struct {
        const char *name;
        const char **target;
    } table[] = {{"-o", &o->directory},        {"--output", &o->directory},
                 {"--analysis", &o->analysis}, {"--formulation", &o->formulation},
                 {"--method", &o->method},     {"--step", &o->step},
                 {"--duration", &o->duration}, {"--tolerance", &o->tolerance},
                 {"--time", &o->time},         {"--speed", &o->speed},
                 {"--view", &o->view},         {"--format", &o->format},
                 {"--fmi", &o->fmi},           {"--shard", &o->shard},
                 {"--jobs", &o->jobs},         {"--checkpoint", &o->checkpoint},
                 {"--match", &o->match},       {"--kind", &o->kind},
                 {"--port", &o->port},         {"--title", &o->title},
                 {"--with", &o->with},         {"--hide", &o->hide},
                 {"--print", &o->print},       {"--threads", &o->threads}};
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        if (strcmp(table[k].name, name) == 0) {
            return table[k].target;
        }
    }
    return NULL;
}

static int *flag_target(options *o, const char *name)
{
    const struct {
        const char *name;
        int *target;
    } table[] = {{"--quiet", &o->quiet},
                 {"-q", &o->quiet},
                 {"--json", &o->json},
                 {"--json-lines", &o->json_lines},
                 {"--check", &o->check},
                 {"--csv", &o->csv},
                 {"--man", &o->man},
                 {"--partial", &o->partial},
                 {"--merge-fixed", &o->merge_fixed},
                 {"--free-base", &o->free_base},
                 {"--resume", &o->resume},
                 {"--keep", &o->keep},
                 {"--strict", &o->strict},
                 {"--no-estimate", &o->no_estimate},
                 {"--merge", &o->merge},
                 {"--list", &o->list},
                 {"--unchecked", &o->unchecked},
                 {"--server", &o->server},
                 {"--sensitivities", &o->sensitivities},
                 {"--optimize", &o->optimize},
                 {"--version", &o->version},
                 {"-V", &o->version},
                 {"--help", &o->help},
                 {"-h", &o->help}};
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        if (strcmp(table[k].name, name) == 0) {
            return table[k].target;
        }
    }
    return NULL;
}

/* What an option sets in the model; NULL: nothing. */
static const char *place_of(const char *name)
{
    return strcmp(name, "--every") == 0 ? "output[0].every" : NULL;
}

/* An option with a value: "--name VALUE" or "--name=VALUE". @return words used, 0: an error. */
static int read_valued(options *o, const char *command, const char *name, const char *value,
                       int used)
{
    const char **target = value_target(o, name);
    if (!value || (!value[0] && target)) {
        usage_error(command, "a value is missing after", name);
        return 0;
    }
    if (strcmp(name, "--set") == 0) {
        return add_setting(o, command, value) == EXIT_DONE ? used : 0;
    }
    const char *place = place_of(name);
    if (place) {
        return put_setting(o, command, place, strlen(place), value) == EXIT_DONE ? used : 0;
    }
    if (strcmp(name, "--caption") == 0) {
        return add_caption(o, command, value) == EXIT_DONE ? used : 0;
    }
    *target = value;
    return used;
}

/* @return words used, 0: an error that was reported. */
static int read_option(options *o, const command_entry *c, int count, char *const *words)
{
    char name[40];
    const char *word = words[0];
    const char *equals = strncmp(word, "--", 2) == 0 ? strchr(word, '=') : NULL;
    const size_t length = equals ? (size_t)(equals - word) : strlen(word);
    if (length >= sizeof name) {
        usage_error(c->name, "unknown option", word);
        return 0;
    }
    memcpy(name, word, length);
    name[length] = '\0';
    int *flag = flag_target(o, name);
    if (flag && !equals && command_find_option(c, name)) {
        *flag = 1;
        if (flag == &o->json || flag == &o->json_lines) {
            outcome_want_json();
        }
        return 1;
    }
    if (flag || !command_find_option(c, name)) {
        usage_error(c->name, "unknown option", word);
        return 0;
    }
    if (equals) {
        return read_valued(o, c->name, name, equals + 1, 1);
    }
    return read_valued(o, c->name, name, count > 1 ? words[1] : NULL, 2);
}

/* What is missing where no operand is given. */
static int report_no_operand(const command_entry *c)
{
    static const struct {
        const char *operands;
        const char *text;
    } table[] = {{"MODEL", "which model? Give a file"},
                 {"DIR|MODEL", "which results? Give the folder that `se3d run` wrote, or a model"},
                 {"FILE", "which model? Give a file"},
                 {"FILE.yaml", "which file? Give a name such as first.yaml"},
                 {"SHELL", "which shell? Give bash, zsh or fish"}};
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        if (strcmp(table[k].operands, c->operands) == 0) {
            complain("se3d %s: %s; see `se3d help %s`\n", c->name, table[k].text, c->name);
        }
    }
    return EXIT_USAGE;
}

/* Standard output is for one of the two. */
static int check_json(const options *o, const command_entry *c)
{
    const char *target = o->directory ? o->directory : c->prints == 1 ? "-" : o->model;
    if (o->json && c->prints && strcmp(target, "-") == 0) {
        complain("se3d %s: --json needs -o, standard output is for one of the two\n", c->name);
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}

/* `-o -` is what a command prints without -o; it makes no file or folder of that name (-o ./-). */
static int check_output(options *o, const command_entry *c)
{
    if (!o->directory || strcmp(o->directory, "-") != 0 || c->prints == COMMAND_PRINTS_GIVEN) {
        return EXIT_DONE;
    }
    o->directory = NULL;
    return c->prints ? EXIT_DONE
                     : usage_error(c->name,
                                   "results are not for standard output, but the rows of one file "
                                   "are:",
                                   "--print -");
}

void options_take_common(const char *word, int *quiet, int *help)
{
    const char *name = command_find_common(word)->name;
    *quiet = *quiet || strcmp(name, "--quiet") == 0;
    *help = strcmp(name, "--help") == 0      ? 1
            : strcmp(name, "--version") == 0 ? OPTIONS_VERSION
                                             : *help;
    if (strcmp(name, "--json") == 0) {
        outcome_want_json();
    }
}

void options_print_of(const command_entry *c, int version)
{
    outcome_tell();
    if (version) {
        printf("se3d %s\n", se3d_version_get_text());
    } else {
        command_print_help(c);
    }
}

int options_read(options *o, const command_entry *c, int count, char *const *words)
{
    int options_end = 0;
    memset(o, 0, sizeof *o);
    for (int k = 0; k < count;) {
        const char *word = words[k];
        if (!options_end && strcmp(word, "--") == 0) {
            options_end = 1;
            ++k;
        } else if (!options_end && word[0] == '-' && word[1]) {
            const int used = read_option(o, c, count - k, words + k);
            if (used == 0) {
                return EXIT_USAGE;
            }
            k += used;
        } else if (o->model) {
            return usage_error(c->name, "one operand at a time, unexpected argument", word);
        } else {
            o->model = word;
            ++k;
        }
    }
    o->json = o->json || o->json_lines;
    if (o->help || o->version) {
        options_print_of(c, o->version);
        o->help = 1;
        return EXIT_DONE;
    }
    if (!o->model && c->operands[0] != '[') {
        return report_no_operand(c);
    }
    const int code = check_output(o, c);
    return code == EXIT_DONE ? check_json(o, c) : code;
}

int options_check_file(const options *o, const command_entry *c)
{
    if (strcmp(o->model, "-") != 0) {
        return EXIT_DONE;
    }
    complain("se3d %s: the model must be a file, which is packed, not standard input\n", c->name);
    return EXIT_USAGE;
}

int options_refuse_both(const command_entry *c, const char *name)
{
    complain("se3d %s: standard output is for %s or for --json, not for both\n", c->name, name);
    return EXIT_USAGE;
}

se3d_model_options options_get_model(const options *o)
{
    se3d_model_options how = se3d_model_options_default();
    how.settings = o->settings;
    how.setting_count = o->setting_count;
    how.analysis = o->analysis;
    how.formulation = o->formulation;
    how.method = o->method;
    how.step = o->step;
    how.tolerance = o->tolerance;
    how.duration = o->duration;
    how.threads = o->threads;
    return how;
}
