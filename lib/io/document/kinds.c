/* SPDX-License-Identifier: BSD-3-Clause */
/* What a row of a table says in words: for the reference, and for `se3d explain`. */
#include "io/document/keys.h"

#include <stdio.h>
#include <string.h>

/* With the marks of Markdown. */
static const char *const kind_texts[SE3DI_KIND_END] = {
    [SE3DI_KIND_NUMBER] = "number",
    [SE3DI_KIND_VECTOR] = "[vector](#points)",
    [SE3DI_KIND_DIRECTION] = "direction",
    [SE3DI_KIND_ORIENTATION] = "[orientation](#orientations)",
    [SE3DI_KIND_BOOL] = "`true` or `false`",
    [SE3DI_KIND_TEXT] = "text",
    [SE3DI_KIND_NAME] = "name",
    [SE3DI_KIND_COUNT] = "whole number",
    [SE3DI_KIND_TITLE] = "text",
    [SE3DI_KIND_VERSION] = "1",
    [SE3DI_KIND_PARAMETERS] = "map",
    [SE3DI_KIND_NAMED_POINTS] = "map",
    [SE3DI_KIND_CONDITION] = "condition",
    [SE3DI_KIND_PARTS] = "map",
    [SE3DI_KIND_VALUES] = "map",
    [SE3DI_KIND_FILE] = "file name",
    [SE3DI_KIND_BODY] = "body",
    [SE3DI_KIND_JOINT] = "joint",
    [SE3DI_KIND_MATERIAL] = "material",
    [SE3DI_KIND_POINT] = "[vector](#points) or marker",
    [SE3DI_KIND_FUNCTION] = "function",
    [SE3DI_KIND_FUNCTIONS] = "3 functions",
    [SE3DI_KIND_COEFFICIENT] = "number or table",
    [SE3DI_KIND_MATRIX3] = "3 rows of 3 numbers",
    [SE3DI_KIND_MATRIX6] = "6 numbers or 6 rows of 6",
    [SE3DI_KIND_EULER_PARAMETERS] = "4 numbers",
    [SE3DI_KIND_INERTIA] = "3 or 6 numbers, or 3 rows of 3",
    [SE3DI_KIND_RADIUS] = "number, 2 numbers or `{table: [[radius, frequency], ...]}`",
    [SE3DI_KIND_CURVE] = "pairs of numbers, or the name of a CSV file",
    [SE3DI_KIND_TEXTS] = "two texts",
    [SE3DI_KIND_PAIRS] = "pairs of numbers",
    [SE3DI_KIND_VECTORS] = "list of [vectors](#points)",
    [SE3DI_KIND_NUMBERS] = "list of numbers",
    [SE3DI_KIND_HEIGHTS] = "rows of numbers, or an expression in x and y",
    [SE3DI_KIND_NAMES] = "list of names",
    [SE3DI_KIND_ROWS] = "list of rows of numbers",
    [SE3DI_KIND_COLOR] = "3 or 4 numbers",
    [SE3DI_KIND_CHANNELS] = "list of [channels](#output)",
    [SE3DI_KIND_SNAPSHOTS] = "`true` or name of a set",
    [SE3DI_KIND_OBJECT] = "map",
    [SE3DI_KIND_LIST] = "list",
    [SE3DI_KIND_ONE_OR_LIST] = "map or list",
    [SE3DI_KIND_TERMS] = "1 to 4 maps",
    [SE3DI_KIND_VARIED] = "map",
    [SE3DI_KIND_MEASURES] = "map",
};

const char *se3di_range_get_text(se3di_range range)
{
    static const char *const texts[] = {"", "> 0", ">= 0", "0.01 to 1"};
    return texts[range];
}

static void put_words(const char *const *words, char *text, size_t size)
{
    size_t used = strlen(text);
    for (size_t k = 0; words && words[k] && used + 1 < size; ++k) {
        snprintf(text + used, size - used, "%s`%s`", k > 0 ? ", " : "", words[k]);
        used += strlen(text + used);
    }
}

void se3di_key_describe(const se3di_object *object, const se3di_key *row, char *text, size_t size)
{
    const char *words[SE3DI_WORDS_MAX + 1];
    const char *range = se3di_range_get_text(row->range);
    if (row->kind == SE3DI_KIND_TYPE || row->kind == SE3DI_KIND_WORD ||
        row->kind == SE3DI_KIND_BOUNDARY) {
        snprintf(text, size, "%s", row->kind == SE3DI_KIND_BOUNDARY ? "3 of " : "");
        se3di_key_list_words(row, words);
        put_words(row->kind == SE3DI_KIND_TYPE ? object->types : words, text, size);
    } else {
        snprintf(text, size, "%s%s%s", kind_texts[row->kind], *range ? " " : "", range);
    }
}
