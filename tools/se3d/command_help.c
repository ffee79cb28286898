/* SPDX-License-Identifier: BSD-3-Clause */
/* The help of the commands, made from their tables. */
#include <stdint.h>
#include <string.h>

#include "command.h"
#include "options.h"
#include "outcome.h"

enum { COLUMNS = 96, OPTION_COLUMNS = 24, LINE_MAX = 2000 };

/* "a, b, c" of the names of a list. */
static size_t put_names(const char *(*name_of)(int32_t), char *out, size_t size)
{
    size_t used = 0;
    for (int32_t k = 0; *name_of(k) && used + 1 < size; ++k) {
        snprintf(out + used, size - used, "%s%s", k > 0 ? ", " : "", name_of(k));
        used += strlen(out + used);
    }
    return used;
}

void command_expand(const char *text, char *out, size_t size)
{
    static const struct {
        const char *mark;
        const char *(*name_of)(int32_t);
    } lists[] = {{"{methods}", se3d_method_get_name},
                 {"{analyses}", se3d_analysis_get_name},
                 {"{formulations}", se3d_formulation_get_name}};
    size_t used = 0;
    out[0] = '\0';
    while (*text && used + 1 < size) {
        size_t length = 1;
        for (size_t k = 0; *text == '{' && k < sizeof lists / sizeof *lists; ++k) {
            if (strncmp(text, lists[k].mark, strlen(lists[k].mark)) == 0) {
                length = strlen(lists[k].mark);
                used += put_names(lists[k].name_of, out + used, size - used);
            }
        }
        if (length == 1) {
            out[used++] = *text;
            out[used] = '\0';
        }
        text += length;
    }
}

/* Print words from column `start` on, broken before column COLUMNS; "\n" ends a line. */
static void put_wrapped(const char *text, int start)
{
    int column = start;
    while (*text) {
        const int length = (int)strcspn(text, " \n");
        if (column > start && column + 1 + length > COLUMNS) {
            printf("\n%*s", start, "");
            column = start;
        }
        column += printf("%s%.*s", column > start ? " " : "", length, text);
        text += length;
        if (*text == '\n') {
            printf("\n%*s", text[1] == '\n' ? 0 : start, "");
            column = start;
        }
        text += *text != '\0';
    }
    putchar('\n');
}

static void put_option(const command_option *o)
{
    char text[LINE_MAX];
    char name[120];
    snprintf(name, sizeof name, "%s%s%s%s%s", o->alias ? o->alias : "", o->alias ? ", " : "",
             o->name, o->value ? " " : "", o->value ? o->value : "");
    const int used = printf("  %-*s ", OPTION_COLUMNS - 1, name);
    if (used > OPTION_COLUMNS + 2) {
        printf("\n%*s", OPTION_COLUMNS + 2, "");
    }
    command_expand(o->text, text, sizeof text);
    put_wrapped(text, OPTION_COLUMNS + 2);
}

void command_print_help(const command_entry *c)
{
    printf("se3d %s%s%s%s\n\n", c->name, *c->operands ? " " : "", c->operands, " [OPTION]...");
    put_wrapped(c->text, 0);
    putchar('\n');
    for (size_t k = 0; command_get_option(c, k); ++k) {
        put_option(command_get_option(c, k));
    }
    puts("\nExamples:");
    for (const command_example *e = c->examples; e->words; ++e) {
        printf("  se3d %s\n", e->words);
        fputs("      ", stdout);
        put_wrapped(e->text, 6);
    }
    fputs("\nExit code: ", stdout);
    put_wrapped(c->exits, 11);
}

void command_print_overview(FILE *file)
{
    fputs("se3d COMMAND ...: constrained rigid multibody dynamics in three dimensions\n\n", file);
    for (size_t k = 0; command_get(k); ++k) {
        const command_entry *c = command_get(k);
        char words[60];
        snprintf(words, sizeof words, "%s %s", c->name, c->operands);
        fprintf(file, "  se3d %-22s %s\n", words, c->summary);
    }
    fputs("  se3d --version, -V          print the version\n"
          "  se3d --help, -h             print this text; behind a command, its help\n"
          "  se3d --quiet, -q COMMAND    print nothing but errors, and what was asked for\n"
          "\n"
          "`se3d help COMMAND` says more, `se3d explain` what a model file may say.\n"
          "Exit code: 0 done; 1 the analysis failed; 2 bad usage or bad model.\n",
          file);
}

static void json_put_member(const char *separator, const char *name, const char *text)
{
    char plain[LINE_MAX];
    command_expand(text ? text : "", plain, sizeof plain);
    printf("%s\"%s\": ", separator, name);
    json_put_text(plain);
}

static void json_put_command(const command_entry *c)
{
    json_put_member("{", "name", c->name);
    json_put_member(", ", "operands", c->operands);
    json_put_member(", ", "summary", c->summary);
    json_put_member(", ", "text", c->text);
    json_put_member(", ", "exits", c->exits);
    fputs(", \"options\": [", stdout);
    for (size_t k = 0; command_get_option(c, k); ++k) {
        const command_option *o = command_get_option(c, k);
        json_put_member(k > 0 ? ", {" : "{", "name", o->name);
        json_put_member(", ", "alias", o->alias);
        json_put_member(", ", "value", o->value);
        json_put_member(", ", "text", o->text);
        putchar('}');
    }
    fputs("], \"examples\": [", stdout);
    for (const command_example *e = c->examples; e->words; ++e) {
        json_put_member(e > c->examples ? ", {" : "{", "words", e->words);
        json_put_member(", ", "text", e->text);
        putchar('}');
    }
    fputs("]}", stdout);
}

/* All commands, or one. */
static void print_json(const command_entry *only)
{
    const char *separator = "";
    outcome_tell();
    fputs("{\"status\": \"done\", \"commands\": [", stdout);
    for (size_t k = 0; command_get(k); ++k) {
        if (!only || command_get(k) == only) {
            fputs(separator, stdout);
            json_put_command(command_get(k));
            separator = ", ";
        }
    }
    fputs("]}\n", stdout);
}

static int command_help(int count, char *const *words)
{
    options o;
    const int code = options_read(&o, &help_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    if (o.man && o.json) {
        return options_refuse_both(&help_entry, "--man");
    }
    const command_entry *c = o.model ? command_find(o.model) : NULL;
    if (o.model && !c) {
        return command_report_unknown(o.model);
    }
    if (o.man) {
        manual_print_program();
    } else if (o.json) {
        print_json(c);
    } else if (c) {
        command_print_help(c);
    } else {
        command_print_overview(stdout);
    }
    return EXIT_DONE;
}

const command_entry help_entry = {
    .name = "help",
    .run = command_help,
    .operands = "[COMMAND]",
    .files = "",
    .summary = "say what the commands do, or one of them",
    .text = "Without a word, lists the commands. With the name of one, says what it does, with its "
            "options and examples.",
    .options =
        (const command_option[]){
            {"--man", NULL, NULL, "print the page se3d(1) of the manual, for `man -l -`"},
            {"--json", NULL, NULL, "print the commands with their options as JSON"},
            {0}},
    .examples = (const command_example[]){{"help run", "the options of `se3d run`"},
                                          {"help --man | man -l -", "read it as a page"},
                                          {0}},
    .exits = "0 done; 2 there is no such command.",
};
