/* SPDX-License-Identifier: BSD-3-Clause */
/* docs/se3d.schema.json and the tables of docs/model-file/reference.md are what the tables of the
 * readers say. With the argument `write` they are written anew (tools/update_keys.sh). */
#include <stdarg.h>
#include <stdlib.h>

#include "check.h"
#include "io/read/objects.h"

enum { TEXT_MAX = 1 << 18 };

typedef struct text {
    char bytes[TEXT_MAX];
    size_t length;
} text;

static text schema, reference, written;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
put(text *t, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(t->bytes + t->length, TEXT_MAX - t->length, format, arguments);
    va_end(arguments);
    t->length += length > 0 ? (size_t)length : 0;
    if (t->length >= TEXT_MAX) {
        fprintf(stderr, "a document is longer than %d bytes\n", (int)TEXT_MAX);
        exit(1);
    }
}

static const char *const schema_head =
    "{\n"
    "  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n"
    "  \"title\": \"se3d model file\",\n"
    "  \"$ref\": \"#/$defs/model\",\n"
    "  \"$defs\": {\n"
    "    \"number\": {\n"
    "      \"description\": \"A number with or without a unit, or an expression over the "
    "parameters.\",\n"
    "      \"type\": [\"number\", \"string\"]\n"
    "    },\n"
    "    \"vector\": {\n"
    "      \"description\": \"Three numbers, or the name of a point or an expression over "
    "points.\",\n"
    "      \"type\": [\"array\", \"string\"], \"items\": {\"$ref\": \"#/$defs/number\"}, "
    "\"minItems\": 3, \"maxItems\": 3\n"
    "    },\n"
    "    \"pair_of_numbers\": {\"type\": \"array\", \"items\": {\"$ref\": \"#/$defs/number\"}, "
    "\"minItems\": 2, \"maxItems\": 2},\n"
    "    \"name\": {\"description\": \"1 to 100 characters, none of . , ; \\\" ' ` [ ] { }\", "
    "\"type\": [\"string\", \"number\"]},\n"
    "    \"point\": {\n"
    "      \"description\": \"Three coordinates in the body frame [m], or the name of a marker of "
    "that body.\",\n"
    "      \"anyOf\": [{\"$ref\": \"#/$defs/vector\"}, {\"type\": \"string\"}]\n"
    "    },\n"
    "    \"function\": {\n"
    "      \"description\": \"A number, an expression in t, or a table.\",\n"
    "      \"anyOf\": [{\"$ref\": \"#/$defs/number\"}, {\"$ref\": \"#/$defs/spline\"}]\n"
    "    },\n"
    "    \"coefficient\": {\n"
    "      \"description\": \"A number, or a table through points.\",\n"
    "      \"anyOf\": [{\"$ref\": \"#/$defs/number\"}, {\"$ref\": \"#/$defs/spline\"}]\n"
    "    },\n"
    "    \"matrix6\": {\n"
    "      \"description\": \"The 6 numbers of the diagonal (x, y, z, about x, y, z), or 6 rows of "
    "6.\",\n"
    "      \"type\": \"array\", \"minItems\": 6, \"maxItems\": 6,\n"
    "      \"items\": {\"anyOf\": [{\"$ref\": \"#/$defs/number\"}, {\"type\": \"array\", "
    "\"items\": "
    "{\"$ref\": \"#/$defs/number\"}, \"minItems\": 6, \"maxItems\": 6}]}\n"
    "    }";

#define REFERENCE(name)     "\"$ref\": \"#/$defs/" name "\""
#define ITEMS(name, number) "\"type\": \"array\", \"items\": {" REFERENCE(name) "}, " number
#define EXACTLY(count)      "\"minItems\": " #count ", \"maxItems\": " #count
#define LIST(items)         "\"type\": [\"array\", \"null\"], \"items\": " items

/* How the schema describes a kind; %s: the name of an object. */
static const char *const kinds[SE3DI_KIND_END] = {
    [SE3DI_KIND_NUMBER] = REFERENCE("number"),
    [SE3DI_KIND_VECTOR] = REFERENCE("vector"),
    [SE3DI_KIND_DIRECTION] = REFERENCE("vector"),
    [SE3DI_KIND_ORIENTATION] = REFERENCE("orientation"),
    [SE3DI_KIND_BOOL] = "\"type\": \"boolean\"",
    [SE3DI_KIND_WORD] = NULL,
    [SE3DI_KIND_TEXT] = "\"type\": \"string\"",
    [SE3DI_KIND_NAME] = REFERENCE("name"),
    [SE3DI_KIND_COUNT] = "\"type\": [\"integer\", \"string\"]",
    [SE3DI_KIND_TYPE] = NULL,
    [SE3DI_KIND_TITLE] = "\"type\": [\"string\", \"number\"]",
    [SE3DI_KIND_VERSION] = "\"const\": 1",
    [SE3DI_KIND_PARAMETERS] = "\"type\": [\"object\", \"null\"], \"additionalProperties\": "
                              "{\"anyOf\": [{" REFERENCE("number") "}, {" REFERENCE("vector") "}]}",
    [SE3DI_KIND_CONDITION] = "\"type\": [\"boolean\", \"number\", \"string\"]",
    [SE3DI_KIND_PARTS] = "\"type\": [\"object\", \"null\"], \"additionalProperties\": "
                         "{" REFERENCE("%s") "}",
    [SE3DI_KIND_VALUES] = "\"type\": [\"object\", \"null\"], \"additionalProperties\": "
                          "{\"anyOf\": [{" REFERENCE("number") "}, {" REFERENCE("vector") "}]}",
    [SE3DI_KIND_NAMED_POINTS] = "\"type\": [\"object\", \"null\"], "
                                "\"additionalProperties\": {" REFERENCE("vector") "}",
    [SE3DI_KIND_FILE] = "\"type\": \"string\"",
    [SE3DI_KIND_BODY] = REFERENCE("name"),
    [SE3DI_KIND_JOINT] = REFERENCE("name"),
    [SE3DI_KIND_MATERIAL] = REFERENCE("name"),
    [SE3DI_KIND_POINT] = REFERENCE("point"),
    [SE3DI_KIND_FUNCTION] = REFERENCE("function"),
    [SE3DI_KIND_FUNCTIONS] = ITEMS("function", EXACTLY(3)),
    [SE3DI_KIND_COEFFICIENT] = REFERENCE("coefficient"),
    [SE3DI_KIND_MATRIX3] = ITEMS("vector", EXACTLY(3)),
    [SE3DI_KIND_MATRIX6] = REFERENCE("matrix6"),
    [SE3DI_KIND_EULER_PARAMETERS] = ITEMS("number", EXACTLY(4)),
    [SE3DI_KIND_INERTIA] = "\"type\": \"array\", \"anyOf\": ["
                           "{\"items\": {" REFERENCE("number") "}, " EXACTLY(
                               3) "}, "
                                  "{\"items\": {" REFERENCE("number") "}, " EXACTLY(
                                      6) "}, "
                                         "{\"items\": {" REFERENCE("vector") "}, " EXACTLY(3) "}]",
    [SE3DI_KIND_RADIUS] = "\"anyOf\": [{" REFERENCE("radius") "}, {" REFERENCE(
        "number") "}, {" REFERENCE("pair_of_numbers") "}]",
    [SE3DI_KIND_BOUNDARY] = NULL,
    [SE3DI_KIND_CURVE] =
        "\"anyOf\": [{\"type\": \"string\"}, {" ITEMS("pair_of_numbers", "\"minItems\": 2") "}]",
    [SE3DI_KIND_TEXTS] = "\"type\": \"array\", \"items\": {\"type\": \"string\"}, " EXACTLY(2),
    [SE3DI_KIND_PAIRS] = ITEMS("pair_of_numbers", "\"minItems\": 1"),
    [SE3DI_KIND_VECTORS] = ITEMS("vector", "\"minItems\": 3"),
    [SE3DI_KIND_NUMBERS] = ITEMS("number", "\"minItems\": 1"),
    [SE3DI_KIND_HEIGHTS] = "\"anyOf\": [{" REFERENCE(
        "number") "}, {\"type\": \"array\", "
                  "\"minItems\": 2, \"items\": {\"type\": \"array\", \"minItems\": "
                  "2, \"items\": {" REFERENCE("number") "}}}]",
    [SE3DI_KIND_NAMES] = ITEMS("name", "\"minItems\": 1"),
    [SE3DI_KIND_ROWS] =
        "\"type\": \"array\", \"minItems\": 2, \"items\": {" ITEMS("number", "\"minItems\": 2") "}",
    [SE3DI_KIND_COLOR] = ITEMS("number", "\"minItems\": 3, \"maxItems\": 4"),
    [SE3DI_KIND_CHANNELS] =
        LIST("{\"anyOf\": [{\"type\": \"string\"}, {\"type\": \"object\", \"minProperties\": 1, "
             "\"maxProperties\": 1, \"additionalProperties\": {\"type\": \"string\"}}]}"),
    [SE3DI_KIND_SNAPSHOTS] = "\"type\": [\"boolean\", \"string\"]",
    [SE3DI_KIND_OBJECT] = REFERENCE("%s"),
    [SE3DI_KIND_LIST] = LIST("{" REFERENCE("%s") "}"),
    [SE3DI_KIND_ONE_OR_LIST] = "\"anyOf\": [{" REFERENCE("%s") "}, {\"type\": \"array\", "
                                                               "\"items\": {" REFERENCE("%s") "}}]",
    [SE3DI_KIND_TERMS] = "\"type\": \"array\", \"minItems\": 1, \"maxItems\": 4, \"items\": "
                         "{" REFERENCE("%s") "}",
    [SE3DI_KIND_VARIED] =
        "\"type\": \"object\", \"additionalProperties\": {\"anyOf\": "
        "[{" REFERENCE("number") "}, {\"type\": \"array\", \"items\": {" REFERENCE(
            "number") "}}, {" REFERENCE("%s") "}]}",
    [SE3DI_KIND_MEASURES] = "\"type\": \"object\", \"additionalProperties\": {\"anyOf\": "
                            "[{\"type\": \"string\"}, {" REFERENCE("%s") "}]}",
};

/* A text in JSON, without the addresses of its links. */
static void put_json_text(text *t, const char *from)
{
    for (const char *c = from; *c; ++c) {
        const char *end = c[0] == ']' && c[1] == '(' ? strchr(c, ')') : NULL;
        const bool opens = *c == '[' && strstr(c, "](") && strcspn(c, "]") + c == strstr(c, "](");
        if (end) {
            c = end;
        } else if (!opens) {
            put(t, "%s%c", *c == '"' || *c == '\\' ? "\\" : "", *c);
        }
    }
}

static size_t count_types(const se3di_object *object, const se3di_key *row, bool having)
{
    size_t count = 0;
    for (size_t k = 0; object->types && object->types[k]; ++k) {
        count += se3di_key_is_of(row, object->types[k]) == having;
    }
    return count;
}

/* The types that have what a row says, or those that have not where they are fewer. */
static void put_types(text *t, const se3di_object *object, const se3di_key *row, const char *mark)
{
    const bool having = count_types(object, row, true) <= count_types(object, row, false);
    const char *between = having ? "" : "all but ";
    for (size_t k = 0; row->types && object->types[k]; ++k) {
        if (se3di_key_is_of(row, object->types[k]) == having) {
            put(t, "%s%s%s%s", between, mark, object->types[k], mark);
            between = ", ";
        }
    }
}

/* "a", "b", ... of the words of a row. */
static void put_row_words(text *t, const se3di_object *object, const se3di_key *row)
{
    const char *own[SE3DI_WORDS_MAX + 1];
    se3di_key_list_words(row, own);
    const char *const *words = row->kind == SE3DI_KIND_TYPE ? object->types : own;
    for (size_t k = 0; words[k]; ++k) {
        put(t, "%s\"%s\"", k > 0 ? ", " : "", words[k]);
    }
}

static void put_schema_kind(text *t, const se3di_object *object, const se3di_key *row)
{
    if (row->kind == SE3DI_KIND_WORD || row->kind == SE3DI_KIND_TYPE) {
        put(t, "\"enum\": [");
        put_row_words(t, object, row);
        put(t, "]");
    } else if (row->kind == SE3DI_KIND_BOUNDARY) {
        put(t, "\"type\": \"array\", \"items\": {\"enum\": [");
        put_row_words(t, object, row);
        put(t, "]}, " EXACTLY(3));
    } else if (row->object) {
        const char *from = kinds[row->kind];
        for (const char *at; (at = strstr(from, "%s")) != NULL; from = at + 2) {
            put(t, "%.*s%s", (int)(at - from), from, row->object);
        }
        put(t, "%s", from);
    } else {
        put(t, "%s", kinds[row->kind]);
    }
    if (row->kind == SE3DI_KIND_FILE && row->words) {
        put(t, ", \"pattern\": \"\\\\.(");
        for (size_t k = 0; row->words[k]; ++k) {
            put(t, "%s%s", k > 0 ? "|" : "", row->words[k] + 1);
        }
        put(t, ")$\"");
    }
}

/* "tsda, rsda: [m], > 0; default 1", with what there is of it. */
static void put_schema_text(text *t, const se3di_object *object, const se3di_key *row)
{
    const size_t start = t->length;
    if (row->types && count_types(object, row, true) < 5) {
        put_types(t, object, row, "");
        put(t, ": ");
    }
    put_json_text(t, row->text);
    if (row->range != SE3DI_ANY) {
        put(t, "%s%s", row->text[0] ? ", " : "", se3di_range_get_text(row->range));
    }
    if (row->standard) {
        put(t, "%sdefault ", t->length > start ? "; " : "");
        put_json_text(t, row->standard);
    }
}

static const se3di_key *next_of_key(const se3di_key *row)
{
    for (const se3di_key *other = row + 1; other->key; ++other) {
        if (strcmp(other->key, row->key) == 0) {
            return other;
        }
    }
    return NULL;
}

static void put_schema_property(text *t, const se3di_object *object, const se3di_key *row)
{
    static text one;
    const se3di_key *other = next_of_key(row);
    put(t, "        \"%s\": {", row->key);
    if (other && other->kind != row->kind) {
        put(t, "\"anyOf\": [{");
        put_schema_kind(t, object, row);
        put(t, "}, {");
        put_schema_kind(t, object, other);
        put(t, "}]");
    } else {
        put_schema_kind(t, object, row);
    }
    one.length = 0;
    one.bytes[0] = '\0';
    for (const se3di_key *each = row; each; each = next_of_key(each)) {
        put(&one, "%s", each == row ? "" : "; ");
        put_schema_text(&one, object, each);
    }
    if (one.length > 0) {
        put(t, ", \"description\": \"%s.\"", one.bytes);
    }
    put(t, "}");
}

static void put_schema_object(text *t, const se3di_object *object)
{
    const char *between = "";
    put(t, ",\n    \"%s\": {\n      \"description\": \"%s\",\n      \"type\": \"object\",\n",
        object->name, object->text);
    put(t, "      \"additionalProperties\": false,\n      \"properties\": {\n");
    for (const se3di_key *row = object->keys; row->key; ++row) {
        if (se3di_object_find(object, NULL, row->key) == row) {
            put(t, "%s", between);
            put_schema_property(t, object, row);
            between = ",\n";
        }
    }
    put(t, "\n      }");
    between = ",\n      \"required\": [";
    for (const se3di_key *row = object->keys; row->key; ++row) {
        if (row->required) {
            put(t, "%s\"%s\"", between, row->key);
            between = ", ";
        }
    }
    put(t, "%s", between[1] == ' ' ? "]" : "");
    put(t, "%s%s\n    }", object->rule ? ",\n      " : "", object->rule ? object->rule : "");
}

static void make_schema(text *t)
{
    t->length = 0;
    put(t, "%s", schema_head);
    for (size_t k = 0; se3di_objects_get(k); ++k) {
        put_schema_object(t, se3di_objects_get(k));
    }
    put(t, "\n  }\n}\n");
}

static void put_reference_row(text *t, const se3di_object *object, const se3di_key *row)
{
    put(t, "| `%s` | ", row->key);
    if (object->types) {
        put_types(t, object, row, "`");
        put(t, " | ");
    }
    char is[2000];
    se3di_key_describe(object, row, is, sizeof is);
    put(t, "%s | ", is);
    put(t, "%s | %s |\n",
        row->required   ? "required"
        : row->standard ? row->standard
                        : "",
        row->text);
}

static void put_reference(text *t, const se3di_object *object)
{
    put(t, "%s",
        object->types ? "| key | of | is | default | meaning |\n|---|---|---|---|---|\n"
                      : "| key | is | default | meaning |\n|---|---|---|---|\n");
    for (const se3di_key *row = object->keys; row->key; ++row) {
        put_reference_row(t, object, row);
    }
}

static const se3di_object *find_object(const char *name, size_t length)
{
    for (size_t k = 0; se3di_objects_get(k); ++k) {
        const se3di_object *object = se3di_objects_get(k);
        if (strlen(object->name) == length && strncmp(object->name, name, length) == 0) {
            return object;
        }
    }
    return NULL;
}

/* The reference with its tables made anew: between `<!-- keys of NAME -->` and `<!-- end -->`.
 * @return how many tables it has */
static size_t make_reference(const char *from, text *t)
{
    static const char begin[] = "<!-- keys of ";
    static const char end[] = "<!-- end -->";
    size_t count = 0;
    t->length = 0;
    for (const char *at; (at = strstr(from, begin)) != NULL; ++count) {
        const char *name = at + strlen(begin);
        const size_t length = strcspn(name, " ");
        const char *last = strstr(name, end);
        const se3di_object *object = find_object(name, length);
        CHECK(last && object);
        if (!last || !object) {
            fprintf(stderr, "reference.md: %.40s\n", at);
            return 0;
        }
        put(t, "%.*s\n\n", (int)(name + strcspn(name, "\n") - from), from);
        put_reference(t, object);
        put(t, "\n");
        from = last;
    }
    put(t, "%s", from);
    return count;
}

static const char *path_of(const char *name)
{
    static char path[800];
    const char *source = getenv("SE3D_SOURCE_DIR");
    snprintf(path, sizeof path, "%s/docs/%s", source ? source : ".", name);
    return path;
}

static void read_document(const char *name, text *t)
{
    FILE *file = fopen(path_of(name), "rb");
    t->length = file ? fread(t->bytes, 1, TEXT_MAX - 1, file) : 0;
    t->bytes[t->length] = '\0';
    if (file) {
        fclose(file);
    }
}

static void expect_same(const char *name, const text *made, const text *found)
{
    size_t k = 0;
    size_t line = 1;
    while (made->bytes[k] && made->bytes[k] == found->bytes[k]) {
        line += made->bytes[k++] == '\n';
    }
    const bool same = made->length == found->length && k == made->length;
    if (!same) {
        fprintf(stderr,
                "docs/%s:%zu differs from the tables of the readers; run "
                "sh tools/update_keys.sh\n  made:  %.*s\n  found: %.*s\n",
                name, line, (int)strcspn(made->bytes + k, "\n"), made->bytes + k,
                (int)strcspn(found->bytes + k, "\n"), found->bytes + k);
    }
    CHECK(same);
}

static void the_schema_is_what_the_tables_say(void)
{
    make_schema(&schema);
    read_document("se3d.schema.json", &written);
    expect_same("se3d.schema.json", &schema, &written);
}

static void the_reference_has_a_table_of_every_object(void)
{
    read_document("model-file/reference.md", &written);
    const size_t count = make_reference(written.bytes, &reference);
    expect_same("model-file/reference.md", &reference, &written);
    size_t objects = 0;
    while (se3di_objects_get(objects)) {
        CHECK(strstr(written.bytes, "<!-- keys of ") != NULL);
        ++objects;
    }
    CHECK(count == objects);
}

/* The place that a key goes to has the size of what is read. */
static void places_have_the_size_of_their_kind(void)
{
    static const size_t sizes[SE3DI_KIND_PLACES] = {
        [SE3DI_KIND_NUMBER] = sizeof(double),        [SE3DI_KIND_VECTOR] = 3 * sizeof(double),
        [SE3DI_KIND_DIRECTION] = 3 * sizeof(double), [SE3DI_KIND_ORIENTATION] = 4 * sizeof(double),
        [SE3DI_KIND_BOOL] = sizeof(int32_t),         [SE3DI_KIND_WORD] = sizeof(int32_t),
        [SE3DI_KIND_TEXT] = sizeof(char *),          [SE3DI_KIND_NAME] = sizeof(char *)};
    for (size_t k = 0; se3di_objects_get(k); ++k) {
        const se3di_object *object = se3di_objects_get(k);
        for (const se3di_key *row = object->keys; row->key; ++row) {
            const bool good =
                !row->structure || (row->kind < SE3DI_KIND_PLACES && row->size == sizes[row->kind]);
            if (!good) {
                fprintf(stderr, "%s.%s -> %s\n", object->name, row->key, row->structure);
            }
            CHECK(good);
        }
    }
}

/* The types of a row are types of its object, rows of one key have different ones, and rows say
 * what their kind needs. */
static void rows_are_complete(void)
{
    for (size_t k = 0; se3di_objects_get(k); ++k) {
        const se3di_object *object = se3di_objects_get(k);
        for (const se3di_key *row = object->keys; row->key; ++row) {
            char list[600];
            const char *words[SE3DI_WORDS_MAX + 1];
            se3di_key_list_words(row, words);
            bool good =
                (row->kind != SE3DI_KIND_WORD && row->kind != SE3DI_KIND_BOUNDARY) || words[0];
            good = good && (row->kind != SE3DI_KIND_COUNT || row->most > 0.0) && row->text &&
                   (!row->types || object->types) &&
                   (!row->object || find_object(row->object, strlen(row->object)));
            snprintf(list, sizeof list, "%s", row->types ? row->types : "");
            for (char *word = strtok(list, " "); word; word = strtok(NULL, " ")) {
                bool known = false;
                for (size_t i = 0; object->types && object->types[i]; ++i) {
                    known = known || strcmp(object->types[i], word) == 0;
                }
                good = good && known && se3di_object_find(object, word, row->key) == row;
            }
            if (!good) {
                fprintf(stderr, "%s.%s\n", object->name, row->key);
            }
            CHECK(good);
        }
    }
}

static int write_document(const char *name, const text *t)
{
    FILE *file = fopen(path_of(name), "wb");
    const bool good = file && fwrite(t->bytes, 1, t->length, file) == t->length;
    return (file && fclose(file) == 0 && good) ? 0 : 1;
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "write") == 0) {
        make_schema(&schema);
        read_document("model-file/reference.md", &written);
        make_reference(written.bytes, &reference);
        return write_document("se3d.schema.json", &schema) |
               write_document("model-file/reference.md", &reference);
    }
    RUN(the_schema_is_what_the_tables_say);
    RUN(the_reference_has_a_table_of_every_object);
    RUN(places_have_the_size_of_their_kind);
    RUN(rows_are_complete);
    return check_finish();
}
