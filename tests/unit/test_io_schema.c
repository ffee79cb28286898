/* SPDX-License-Identifier: BSD-3-Clause */
/* docs/se3d.schema.json and the reader know the same keys and types. The schema is read with our
 * own document parser, JSON being a subset of YAML. */
#include <stdlib.h>

#include "check.h"
#include "io/document/document.h"
#include "io/document/keys.h"

static se3di_iopool pool;

static se3di_node *read_schema(void)
{
    static char text[200000];
    char path[800];
    se3d_model_error error = {0, 0, ""};
    se3di_node *root = NULL;
    const char *source = getenv("SE3D_SOURCE_DIR");
    snprintf(path, sizeof path, "%s/docs/se3d.schema.json", source ? source : ".");
    FILE *file = fopen(path, "rb");
    if (file) {
        const size_t length = fread(text, 1, sizeof text, file);
        fclose(file);
        se3di_document_parse(&pool, path, text, length, &root, &error);
    }
    if (!root) {
        fprintf(stderr, "%s: %s\n", path, error.message);
    }
    return root;
}

static int reader_has_key(const se3di_object_keys *object, const char *word)
{
    for (const char *const *key = object->keys; *key; ++key) {
        if (strcmp(*key, word) == 0) {
            return 1;
        }
    }
    return 0;
}

static void expect(int holds, const char *object, const char *what, const char *word)
{
    if (!holds) {
        fprintf(stderr, "%s: %s `%s`\n", object, what, word);
    }
    CHECK(holds);
}

static void compare_types(const se3di_object_keys *object, const se3di_node *properties)
{
    const se3di_node *allowed = se3di_node_get(se3di_node_get(properties, "type"), "enum");
    size_t count = 0;
    for (const se3di_type_keys *type = object->types; type && type->type; ++type, ++count) {
        int found = 0;
        for (const se3di_node *word = allowed ? allowed->first : NULL; word; word = word->next) {
            found = found || strcmp(word->text, type->type) == 0;
        }
        expect(found, object->name, "the schema lacks the type", type->type);
    }
    CHECK(!object->types || (allowed && allowed->count == count));
}

static void schema_and_reader_know_the_same_keys(void)
{
    const se3di_node *defs = se3di_node_get(read_schema(), "$defs");
    CHECK(defs != NULL);
    for (int k = 0; defs && k < SE3DI_OBJECT_COUNT; ++k) {
        const se3di_object_keys *object = se3di_keys_get((se3di_object)k);
        const se3di_node *properties =
            se3di_node_get(se3di_node_get(defs, object->name), "properties");
        expect(properties != NULL, object->name, "the schema lacks", object->name);
        for (const char *const *key = object->keys; *key; ++key) {
            expect(se3di_node_get(properties, *key) != NULL, object->name,
                   "the schema lacks the key", *key);
        }
        for (const se3di_node *key = properties ? properties->first : NULL; key; key = key->next) {
            expect(reader_has_key(object, key->key), object->name, "the reader lacks the key",
                   key->key);
        }
        compare_types(object, properties);
    }
}

static void every_key_of_a_type_is_a_key_of_its_object(void)
{
    for (int k = 0; k < SE3DI_OBJECT_COUNT; ++k) {
        const se3di_object_keys *object = se3di_keys_get((se3di_object)k);
        for (const se3di_type_keys *type = object->types; type && type->type; ++type) {
            char list[400];
            snprintf(list, sizeof list, "%s %s", type->keys, object->common);
            for (char *word = strtok(list, " "); word; word = strtok(NULL, " ")) {
                expect(reader_has_key(object, word), type->type, "is unknown:", word);
            }
        }
    }
}

static void every_key_is_used_by_some_type(void)
{
    for (int k = 0; k < SE3DI_OBJECT_COUNT; ++k) {
        const se3di_object_keys *object = se3di_keys_get((se3di_object)k);
        for (const char *const *key = object->keys; object->types && *key; ++key) {
            int used = se3di_keys_contain(object->common, *key);
            for (const se3di_type_keys *type = object->types; type->type; ++type) {
                used = used || se3di_keys_contain(type->keys, *key);
            }
            expect(used, object->name, "no type has", *key);
        }
    }
}

int main(void)
{
    se3di_iopool_init(&pool, NULL);
    RUN(schema_and_reader_know_the_same_keys);
    RUN(every_key_of_a_type_is_a_key_of_its_object);
    RUN(every_key_is_used_by_some_type);
    se3di_iopool_destroy(&pool);
    return check_finish();
}
