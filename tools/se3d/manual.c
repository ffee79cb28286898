/* SPDX-License-Identifier: BSD-3-Clause */
/* The pages of the manual, se3d(1) and se3d-model(5), as man(7) text from the program's tables. */
#include <string.h>

#include "command.h"
#include "io/read/objects.h"
#include "options.h"
#include "plain.h"

/* A text in which nothing is a request or an escape of roff. */
static void put_roff(const char *text)
{
    int begins = 1;
    for (const char *c = text; *c; ++c) {
        if (begins && (*c == '.' || *c == '\'')) {
            fputs("\\&", stdout);
        }
        begins = *c == '\n';
        if (*c == '\\') {
            fputs("\\e", stdout);
        } else if (*c == '-') {
            fputs("\\-", stdout);
        } else if (begins && c[1] == '\n') {
            fputs("\n.PP", stdout);
        } else if (*c != '`') {
            putchar(*c);
        }
    }
    putchar('\n');
}

static void put_expanded(const char *text)
{
    char expanded[2000];
    char plain[2000];
    command_expand(text, expanded, sizeof expanded);
    plain_copy(expanded, plain, sizeof plain);
    put_roff(plain);
}

static void put_head(const char *name, int section, const char *summary)
{
    printf(".TH %s %d \"\" \"se3d %s\" \"libse3d\"\n.SH NAME\n%s \\- ", name, section,
           se3d_version_get_text(), name);
    put_roff(summary);
}

static void put_option(const command_option *o)
{
    fputs(".TP\n", stdout);
    fputs(o->value ? ".BR " : ".B ", stdout);
    if (o->value) {
        fputs("\"", stdout);
    }
    for (const char *c = o->name; *c; ++c) {
        printf(*c == '-' ? "\\-" : "%c", *c);
    }
    if (o->alias) {
        fputs(", ", stdout);
        for (const char *c = o->alias; *c; ++c) {
            printf(*c == '-' ? "\\-" : "%c", *c);
        }
    }
    if (o->value) {
        printf("\" \" %s\"", o->value);
    }
    putchar('\n');
    put_expanded(o->text);
}

static void put_command(const command_entry *c)
{
    printf(".SS se3d %s %s\n", c->name, c->operands);
    put_expanded(c->text);
    for (size_t k = 0; command_get_option(c, k); ++k) {
        put_option(command_get_option(c, k));
    }
    puts(".PP\nExit code:");
    put_roff(c->exits);
}

void manual_print_program(void)
{
    put_head("se3d", 1, "constrained rigid multibody dynamics in three dimensions");
    puts(".SH SYNOPSIS");
    for (size_t k = 0; command_get(k); ++k) {
        const command_entry *c = command_get(k);
        printf(".B se3d %s\n%s%s\n.br\n", c->name, c->operands, " [OPTION]...");
    }
    puts(".SH DESCRIPTION\n"
         "Reads mechanisms from model files, see\n.BR se3d\\-model (5),\n"
         "computes assembly, kinematics, inverse dynamics, dynamics, equilibria and modes, and\n"
         "writes results as tables, plots, pages in 3\\-D and films.\n"
         ".SH COMMANDS");
    for (size_t k = 0; command_get(k); ++k) {
        put_command(command_get(k));
    }
    puts(".SH EXAMPLES");
    for (size_t k = 0; command_get(k); ++k) {
        for (const command_example *e = command_get(k)->examples; e->words; ++e) {
            fputs(".TP\n.B se3d ", stdout);
            put_roff(e->words);
            put_roff(e->text);
        }
    }
    puts(".SH SEE ALSO\n.BR se3d\\-model (5)");
}

static void put_key(const se3di_object *object, const se3di_key *row)
{
    char is[2000];
    printf(".TP\n.B %s\n", row->key);
    se3di_key_describe(object, row, is, sizeof is);
    put_expanded(is);
    if (row->types) {
        fputs(".br\nof:", stdout);
        put_roff(row->types);
    }
    if (row->required || row->standard) {
        fputs(".br\n", stdout);
        put_expanded(row->required ? "required" : "default:");
        if (row->standard) {
            put_expanded(row->standard);
        }
    }
    if (*row->text) {
        fputs(".br\n", stdout);
        put_expanded(row->text);
    }
}

void manual_print_model(void)
{
    put_head("se3d-model", 5, "model files of se3d");
    puts(".SH DESCRIPTION\n"
         "A model is one YAML document (JSON is a subset) that begins with\n.B se3d: 1\n"
         "and is an object\n.B model\nof the list below. Everything is in SI units and radians,\n"
         "if nothing else is said. Every number may be an expression. Unknown keys are errors.\n"
         ".PP\n"
         ".B se3d explain NAME\ntells the same of one object, type or key.\n"
         ".SH OBJECTS");
    for (size_t k = 0; se3di_objects_get(k); ++k) {
        const se3di_object *object = se3di_objects_get(k);
        printf(".SS %s\n", object->name);
        put_expanded(object->text);
        for (const se3di_key *row = object->keys; row->key; ++row) {
            put_key(object, row);
        }
    }
    puts(".SH SEE ALSO\n.BR se3d (1)");
}
