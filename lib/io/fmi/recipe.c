/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/fmi/recipe.h"

#include <stdio.h>
#include <string.h>

enum { SETTINGS_MAX = 1000 };
static const char head[] = "se3d-fmu 1";

/* The options that are a text, by their names. */
static const struct {
    const char *word;
    size_t offset;
} words[] = {{"analysis", offsetof(se3d_model_options, analysis)},
             {"formulation", offsetof(se3d_model_options, formulation)},
             {"method", offsetof(se3d_model_options, method)},
             {"step", offsetof(se3d_model_options, step)},
             {"duration", offsetof(se3d_model_options, duration)},
             {"tolerance", offsetof(se3d_model_options, tolerance)},
             {"threads", offsetof(se3d_model_options, threads)}};
enum { WORDS = sizeof words / sizeof *words };

static const char **text_of(se3d_model_options *options, size_t k)
{
    return (const char **)(void *)((char *)options + words[k].offset);
}

/* One line, or its length if there is no text. */
static size_t put(char *text, const char *word, const char *rest, const char *more)
{
    const size_t length = strlen(word) + strlen(rest) + strlen(more) + 2 + (*more != '\0');
    if (text) {
        snprintf(text, length + 1, "%s %s%s%s\n", word, rest, *more ? "=" : "", more);
    }
    return length;
}

static size_t put_all(const se3di_fmi_recipe *recipe, char *text)
{
    se3d_model_options options = recipe->options;
    size_t used = text ? (size_t)snprintf(text, sizeof head + 1, "%s\n", head) : sizeof head;
    used += put(text ? text + used : NULL, "model", recipe->model, "");
    for (size_t k = 0; k < WORDS; ++k) {
        const char *rest = *text_of(&options, k);
        used += rest ? put(text ? text + used : NULL, words[k].word, rest, "") : 0;
    }
    for (size_t k = 0; k < options.setting_count; ++k) {
        used += put(text ? text + used : NULL, "set", options.settings[k].name,
                    options.settings[k].value);
    }
    return used;
}

char *se3di_fmi_recipe_write(const se3di_fmi_recipe *recipe, se3di_iopool *pool)
{
    char *text = se3di_iopool_alloc(pool, put_all(recipe, NULL) + 1);
    if (text) {
        put_all(recipe, text);
    }
    return text;
}

static bool take(se3di_fmi_recipe *recipe, char *word, char *rest, se3d_model_setting *settings)
{
    char *equals = strchr(rest, '=');
    if (strcmp(word, "model") == 0) {
        recipe->model = rest;
        return true;
    }
    if (strcmp(word, "set") == 0 && equals && recipe->options.setting_count < SETTINGS_MAX) {
        *equals = '\0';
        settings[recipe->options.setting_count++] = (se3d_model_setting){rest, equals + 1};
        return true;
    }
    for (size_t k = 0; k < WORDS; ++k) {
        if (strcmp(word, words[k].word) == 0) {
            *text_of(&recipe->options, k) = rest;
            return true;
        }
    }
    return false;
}

bool se3di_fmi_recipe_read(se3di_fmi_recipe *recipe, char *text, se3di_iopool *pool)
{
    se3d_model_setting *settings = se3di_iopool_array(pool, SETTINGS_MAX, sizeof *settings);
    const size_t length = sizeof head - 1;
    recipe->model = NULL;
    recipe->options = se3d_model_options_default();
    recipe->options.settings = settings;
    if (!settings || strncmp(text, head, length) != 0 || text[length] != '\n') {
        return false;
    }
    for (char *line = text + length + 1; *line;) {
        char *end = line + strcspn(line, "\n");
        char *next = end + (*end != '\0');
        *end = '\0';
        char *rest = strchr(line, ' ');
        if (!rest) {
            return false;
        }
        *rest = '\0';
        if (!take(recipe, line, rest + 1, settings)) {
            return false;
        }
        line = next;
    }
    return recipe->model != NULL;
}
