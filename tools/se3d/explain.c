/* SPDX-License-Identifier: BSD-3-Clause */
/* `se3d explain`: what a model file may say, from the tables by which it is read. */
#include <stdbool.h>
#include <string.h>

#include "command.h"
#include "io/document/guess.h"
#include "io/read/objects.h"
#include "options.h"
#include "outcome.h"
#include "plain.h"

static void put_row(const se3di_object *object, const se3di_key *row)
{
    char is[2000];
    char plain[2000];
    se3di_key_describe(object, row, is, sizeof is);
    plain_copy(is, plain, sizeof plain);
    printf("  %-14s %s", row->key, plain);
    if (row->required) {
        fputs("; required", stdout);
    } else if (row->standard) {
        plain_copy(row->standard, plain, sizeof plain);
        printf("; default %s", plain);
    }
    putchar('\n');
    plain_copy(row->text, plain, sizeof plain);
    if (*plain) {
        printf("  %-14s %s\n", "", plain);
    }
}

/* The keys of an object, of one of its types if one is named. */
static void put_object(const se3di_object *object, const char *type)
{
    char plain[2000];
    plain_copy(object->text, plain, sizeof plain);
    printf("%s%s%s: %s\n\n", object->name, type ? " of type " : "", type ? type : "", plain);
    for (const se3di_key *row = object->keys; row->key; ++row) {
        if (se3di_key_is_of(row, type) && !(type && row->kind == SE3DI_KIND_TYPE)) {
            put_row(object, row);
        }
    }
}

static void json_put_member(const char *separator, const char *name, const char *text)
{
    char plain[2000];
    printf("%s\"%s\": ", separator, name);
    if (!text) {
        fputs("null", stdout);
        return;
    }
    plain_copy(text, plain, sizeof plain);
    json_put_text(plain);
}

static void json_put_row(const se3di_object *object, const se3di_key *row)
{
    char is[2000];
    se3di_key_describe(object, row, is, sizeof is);
    json_put_member("{", "key", row->key);
    json_put_member(", ", "is", is);
    printf(", \"required\": %s", row->required ? "true" : "false");
    json_put_member(", ", "default", row->required ? NULL : row->standard);
    json_put_member(", ", "text", row->text);
    putchar('}');
}

/* An object with all its keys, those of one of its types, or one key. */
static void json_put_object(const se3di_object *object, const char *type, const se3di_key *only)
{
    const char *separator = "";
    json_put_member("{", "object", object->name);
    json_put_member(", ", "type", type);
    json_put_member(", ", "text", object->text);
    fputs(", \"keys\": [", stdout);
    for (const se3di_key *row = object->keys; row->key; ++row) {
        if (only ? row == only
                 : se3di_key_is_of(row, type) && !(type && row->kind == SE3DI_KIND_TYPE)) {
            fputs(separator, stdout);
            json_put_row(object, row);
            separator = ", ";
        }
    }
    fputs("]}", stdout);
}

/* Before what is found as number `place`. */
static void json_put_separator(size_t place)
{
    fputs(place > 0 ? ", " : "{\"found\": [", stdout);
}

static void show_object(const options *o, size_t place, const se3di_object *object,
                        const char *type)
{
    if (o->json) {
        json_put_separator(place);
        json_put_object(object, type, NULL);
    } else {
        fputs(place > 0 ? "\n" : "", stdout);
        put_object(object, type);
    }
}

static void show_key(const options *o, size_t place, const se3di_object *object,
                     const se3di_key *row)
{
    if (o->json) {
        json_put_separator(place);
        json_put_object(object, NULL, row);
    } else {
        printf("%s%s.%s\n", place > 0 ? "\n" : "", object->name, row->key);
        put_row(object, row);
    }
}

static bool has_type(const se3di_object *object, const char *type)
{
    for (size_t k = 0; object->types && object->types[k]; ++k) {
        if (strcmp(object->types[k], type) == 0) {
            return true;
        }
    }
    return false;
}

/* All that bears a name: an object, a type, a key, or a key of an object ("joint.axis").
 * @return how many there are */
static size_t explain_name(const options *o, const char *name)
{
    size_t found = 0;
    const size_t head = strcspn(name, ".");
    for (size_t k = 0; se3di_objects_get(k); ++k) {
        const se3di_object *object = se3di_objects_get(k);
        const bool named = strlen(object->name) == head && strncmp(object->name, name, head) == 0;
        if ((named && !name[head]) || has_type(object, name)) {
            show_object(o, found++, object, named ? NULL : name);
        }
    }
    for (size_t k = 0; se3di_objects_get(k); ++k) {
        const se3di_object *object = se3di_objects_get(k);
        const bool named = strlen(object->name) == head && strncmp(object->name, name, head) == 0;
        const char *key = name[head] && named ? name + head + 1 : name;
        for (const se3di_key *row = object->keys; row->key; ++row) {
            if (strcmp(row->key, key) == 0) {
                show_key(o, found++, object, row);
            }
        }
    }
    return found;
}

static void put_objects(void)
{
    char plain[2000];
    puts("A model file is a `model`. `se3d explain NAME` tells the keys of an object, of a type\n"
         "(revolute), or where a key stands (joint.axis).\n");
    for (size_t k = 0; se3di_objects_get(k); ++k) {
        plain_copy(se3di_objects_get(k)->text, plain, sizeof plain);
        printf("  %-14s %s\n", se3di_objects_get(k)->name, plain);
    }
}

static int report_unknown(const char *name)
{
    se3di_guess guess = se3di_guess_begin(name);
    for (size_t k = 0; se3di_objects_get(k); ++k) {
        const se3di_object *object = se3di_objects_get(k);
        se3di_guess_offer(&guess, object->name);
        for (size_t n = 0; object->types && object->types[n]; ++n) {
            se3di_guess_offer(&guess, object->types[n]);
        }
        for (const se3di_key *row = object->keys; row->key; ++row) {
            se3di_guess_offer(&guess, row->key);
        }
    }
    const char *best = se3di_guess_get(&guess);
    complain("se3d explain: no object, type or key is called `%s`%s%s%s\n", name,
             best ? "; did you mean `" : "; see `se3d explain`", best ? best : "",
             best ? "`?" : "");
    return EXIT_USAGE;
}

static int show(const options *o)
{
    size_t found = 0;
    if (o->model) {
        found = explain_name(o, o->model);
    } else if (o->json) {
        for (; se3di_objects_get(found); ++found) {
            show_object(o, found, se3di_objects_get(found), NULL);
        }
    } else {
        put_objects();
        found = 1;
    }
    return found > 0 ? EXIT_DONE : report_unknown(o->model);
}

static int command_explain(int count, char *const *words)
{
    options o;
    int code = options_read(&o, &explain_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    if (o.man && o.json) {
        return options_refuse_both(&explain_entry, "--man");
    }
    if (o.man) {
        manual_print_model();
        return EXIT_DONE;
    }
    code = show(&o);
    if (o.json && code == EXIT_DONE) {
        outcome_tell();
        fputs("], \"status\": \"done\"}\n", stdout);
    }
    return code;
}

const command_entry explain_entry = {
    .name = "explain",
    .run = command_explain,
    .operands = "[NAME]",
    .files = "",
    .summary = "say what a model file may say",
    .text =
        "Without a word, lists the objects of the model file. With the name of an object (joint), "
        "of a type (revolute) or of a key (stiffness, joint.axis), says what may stand there, "
        "in which unit and frame, and what holds by default.",
    .options = (const command_option[]){{"--man", NULL, NULL,
                                         "print the page se3d-model(5) of the manual"},
                                        {"--json", NULL, NULL, "print objects and keys as JSON"},
                                        {0}},
    .examples = (const command_example[]){{"explain", "the objects"},
                                          {"explain revolute", "the keys of a revolute joint"},
                                          {"explain force.c", "one key"},
                                          {0}},
    .exits = "0 done; 2 nothing has this name.",
};
