/* SPDX-License-Identifier: BSD-3-Clause */
/* The layout of model files: what it makes of a mess, and that it changes nothing else in any file
 * of the repository. */
#include "check.h"
#include "io/document/layout.h"

#include <dirent.h>
#include <stdlib.h>

/* The layout of a text, in the pool. */
static const char *lay_out(se3di_iopool *pool, const char *text, size_t length)
{
    se3d_model_error error = {0, 0, ""};
    char *made = NULL;
    size_t made_length = 0;
    CHECK(se3di_layout_make(pool, "m.yaml", text, length, &made, &made_length, &error) == SE3D_OK);
    if (!made) {
        fprintf(stderr, "%s\n", error.message);
    }
    CHECK(made && strlen(made) == made_length && error.message[0] == '\0');
    return made ? made : "";
}

static void check_layout(const char *text, const char *expected)
{
    se3di_iopool pool;
    se3di_iopool_init(&pool, NULL);
    const char *made = lay_out(&pool, text, strlen(text));
    CHECK(strcmp(made, expected) == 0);
    if (strcmp(made, expected) != 0) {
        fprintf(stderr, "%s", made);
    }
    made = lay_out(&pool, made, strlen(made));
    CHECK(strcmp(made, expected) == 0);
    se3di_iopool_destroy(&pool);
}

static void indents_follow_the_depth(void)
{
    check_layout("se3d:   1\nbodies:\n- name:  x\n  mass: 3\n-    {name: y}\njoints:\n"
                 "         -  name: j\n            at:\n               - 1\n               - 2\n",
                 "se3d: 1\nbodies:\n  - name: x\n    mass: 3\n  - {name: y}\njoints:\n"
                 "  - name: j\n    at:\n      - 1\n      - 2\n");
}

static void spaces_between_values_are_one(void)
{
    check_layout("a:   { b: 1,c : [ 1,2 ,  3 ] , d: {} , e: [ ] }   \nf:\tg\n",
                 "a: {b: 1, c: [1, 2, 3], d: {}, e: []}\nf: g\n");
    check_layout("{\"a\":1,\"b\":[true,null]}", "{\"a\": 1, \"b\": [true, null]}\n");
}

static void lines_in_brackets_stand_behind_one(void)
{
    check_layout(
        "a:\n- {b: 1,\n        c: [1,\n            2],\n   d: [\n 3,\n 4\n ],\n   e: 5}\n",
        "a:\n  - {b: 1,\n     c: [1,\n         2],\n     d: [\n       3,\n       4\n     ],\n"
        "     e: 5}\n");
    check_layout("a:\n    b: [1, 2,\n      3]\n", "a:\n  b: [1, 2,\n    3]\n");
    check_layout("a: {b: \"x +\n y\",\n c: 1}\n", "a: {b: \"x +\n        y\",\n    c: 1}\n");
}

static void comments_stay(void)
{
    check_layout("\n\n# head  \nse3d: 1 # one\ntitle: long # two\n\n\n\na:\n      # of b\n"
                 "      b: 2\n      # behind b\n# of c\nc: [1, # first\n    2]# no comment\n# end",
                 "# head\nse3d: 1      # one\ntitle: long  # two\n\na:\n  # of b\n  b: 2\n"
                 "  # behind b\n# of c\nc: [1,  # first\n    2]  # no comment\n# end\n");
}

static void texts_of_many_lines_stay_the_same_texts(void)
{
    check_layout(
        "a:\n      b: |\n           x\n             y\n\n           z\n      c: >-\n"
        "        u\n        v\n      d: two\n       words\n      e: \"p \\\n   q\n\n   r\"\n",
        "a:\n  b: |\n    x\n      y\n\n    z\n  c: >-\n    u\n    v\n  d: two\n"
        "     words\n  e: \"p \\\n      q\n\n      r\"\n");
}

static void what_cannot_be_laid_out_stays(void)
{
    static const char *const texts[] = {"? a\n:   1\n", "a:   |2\n    x\n   y\n",
                                        "a:   |+\n  x\n\n\nb: 1\n"};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; ++k) {
        se3di_iopool pool;
        se3di_iopool_init(&pool, NULL);
        const char *made = lay_out(&pool, texts[k], strlen(texts[k]));
        made = lay_out(&pool, made, strlen(made));
        CHECK(strcmp(made, lay_out(&pool, made, strlen(made))) == 0);
        se3di_iopool_destroy(&pool);
    }
    se3d_model_error error = {0, 0, ""};
    se3di_iopool pool;
    char *made = NULL;
    size_t length = 0;
    se3di_iopool_init(&pool, NULL);
    CHECK(se3di_layout_make(&pool, "m.yaml", "a: [1", 5, &made, &length, &error) == SE3D_ERR_MODEL);
    CHECK_CONTAINS(error.message, "m.yaml:2:1: syntax error");
    CHECK(made == NULL);
    se3di_iopool_destroy(&pool);
}

/* ---- files ---- */

static int is_same_tree(const se3di_node *a, const se3di_node *b)
{
    int same = a->kind == b->kind && a->plain == b->plain && a->count == b->count &&
               strcmp(a->key ? a->key : "", b->key ? b->key : "") == 0 &&
               (a->kind != SE3DI_NODE_SCALAR || strcmp(a->text, b->text) == 0);
    const se3di_node *other = b->first;
    for (const se3di_node *one = a->first; same && one; one = one->next, other = other->next) {
        same = is_same_tree(one, other);
    }
    return same;
}

/* Spaces behind lines, CR LF and more empty lines, which leave no trace. */
static size_t make_mess(const char *text, size_t length, char *mess)
{
    size_t at = 0;
    for (size_t k = 0; k < length; ++k) {
        if (text[k] == '\n') {
            memcpy(mess + at, "  \r", 3);
            at += 3;
        }
        mess[at++] = text[k];
        if (text[k] == '\n' && k + 1 < length && text[k + 1] == '\n') {
            mess[at++] = '\n';
        }
    }
    return at;
}

static void check_tree(const char *name, const char *text, size_t length)
{
    se3di_iopool pool;
    se3di_node *trees[3] = {NULL, NULL, NULL};
    se3d_model_error error = {0, 0, ""};
    se3di_iopool_init(&pool, NULL);
    const char *made = lay_out(&pool, text, length);
    const char *again = lay_out(&pool, made, strlen(made));
    char *mess = malloc(6 * length + 1);
    const size_t mess_length = make_mess(text, length, mess);
    const char *mended = lay_out(&pool, mess, mess_length);
    const int good =
        se3di_document_parse(&pool, name, text, length, &trees[0], &error) == SE3D_OK &&
        se3di_document_parse(&pool, name, made, strlen(made), &trees[1], &error) == SE3D_OK &&
        se3di_document_parse(&pool, name, mended, strlen(mended), &trees[2], &error) == SE3D_OK &&
        strcmp(made, again) == 0 && is_same_tree(trees[0], trees[1]) &&
        is_same_tree(trees[0], trees[2]) && strcmp(mended, made) == 0;
    CHECK(good);
    if (!good) {
        fprintf(stderr, "%s: %s\n", name, error.message);
    }
    free(mess);
    se3di_iopool_destroy(&pool);
}

static int check_folder(const char *folder)
{
    int count = 0;
    DIR *list = opendir(folder);
    CHECK(list != NULL);
    for (struct dirent *entry = list ? readdir(list) : NULL; entry; entry = readdir(list)) {
        char path[600];
        const size_t end = strlen(entry->d_name);
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        FILE *file =
            end > 5 && strcmp(entry->d_name + end - 5, ".yaml") == 0 ? fopen(path, "rb") : NULL;
        if (file) {
            se3di_iopool pool;
            char *text = NULL;
            size_t length = 0;
            se3di_iopool_init(&pool, NULL);
            CHECK(se3di_document_read(&pool, file, &text, &length) == SE3D_OK);
            check_tree(path, text, length);
            se3di_iopool_destroy(&pool);
            fclose(file);
            ++count;
        }
    }
    if (list) {
        closedir(list);
    }
    return count;
}

static void no_value_of_any_example_changes(void)
{
    CHECK(check_folder("examples/models") > 30);
    CHECK(check_folder("examples/models/parts") > 0);
    CHECK(check_folder("examples/fsae") > 10);
}

int main(void)
{
    RUN(indents_follow_the_depth);
    RUN(spaces_between_values_are_one);
    RUN(lines_in_brackets_stand_behind_one);
    RUN(comments_stay);
    RUN(texts_of_many_lines_stay_the_same_texts);
    RUN(what_cannot_be_laid_out_stays);
    RUN(no_value_of_any_example_changes);
    return check_finish();
}
