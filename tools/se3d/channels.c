/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d channels MODEL: what `output` may name. */
#include <stdio.h>
#include <string.h>

#include "options.h"
#include "outcome.h"
#include "text.h"
#include "warnings.h"

static int is_wanted(const se3d_model_channel *c, const char *part)
{
    return !part || strstr(c->name, part);
}

static void print_text(const se3d_model *model, size_t count, const char *part)
{
    static const char *const columns[] = {"", "", "x, y, z", "e0, e1, e2, e3"};
    se3d_model_channel c;
    size_t widest = 0;
    for (size_t k = 0; k < count; ++k) {
        se3d_model_get_listed_channel(model, k, &c);
        const size_t length = is_wanted(&c, part) ? strlen(c.name) : 0;
        widest = length > widest ? length : widest;
    }
    for (size_t k = 0; k < count; ++k) {
        se3d_model_get_listed_channel(model, k, &c);
        if (is_wanted(&c, part)) {
            text_put_plain(stdout, c.name);
            printf("%*s%s%s%s", (int)(widest - strlen(c.name)) + 2, "", c.unit[0] ? "[" : "",
                   c.unit, c.unit[0] ? "]" : "");
            printf("%s%s\n", c.width > 1 ? "  " : "", c.width > 1 ? columns[c.width - 1] : "");
        }
    }
}

static void print_json(const options *o, const se3d_model *model, size_t count)
{
    const char *separator = "";
    outcome_tell();
    fputs("{\"status\": \"done\", \"channels\": [", stdout);
    for (size_t k = 0; k < count; ++k) {
        se3d_model_channel c;
        se3d_model_get_listed_channel(model, k, &c);
        if (is_wanted(&c, o->match)) {
            printf("%s{\"name\": ", separator);
            json_put_text(c.name);
            printf(", \"unit\": ");
            json_put_text(c.unit);
            printf(", \"width\": %zu}", c.width);
            separator = ", ";
        }
    }
    fputs("]}\n", stdout);
}

static int command_channels(int count, char *const *words)
{
    options o;
    se3d_model *model = NULL;
    size_t found = 0;
    int code = options_read(&o, &channels_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    se3d_model_options how = options_get_model(&o);
    how.mass_optional = 1; /* names know no mass */
    code = options_read_model(&o, &how, &model);
    if (code == EXIT_DONE && SE3D_FAILED(se3d_model_list_channels(model, &found))) {
        report_failure(&o, o.model, "out of memory");
        code = EXIT_FAILED;
    } else if (code == EXIT_DONE && o.json) {
        print_json(&o, model, found);
    } else if (code == EXIT_DONE) {
        print_text(model, found, o.match);
    }
    se3d_model_destroy(model);
    return code;
}

const command_entry channels_entry = {
    .name = "channels",
    .run = command_channels,
    .operands = "MODEL",
    .files = "yaml yml json",
    .summary = "list what the results of a model may show",
    .text = "Lists the channels of a model with their units and components: the names that "
            "`output`, events, laws and `se3d plot` take. `se3d explain` says what they mean.",
    .options = (const command_option[]){COMMAND_OPTION_SET,
                                        {"--match", NULL, "TEXT",
                                         "only those with this text in their names"},
                                        {"--json", NULL, NULL, "print them as JSON"},
                                        {0}},
    .examples = (const command_example[]){{"channels suspension.yaml", "all of them"},
                                          {"channels suspension.yaml --match force",
                                           "those whose names contain `force`"},
                                          {0}},
    .exits = "0 done; 1 out of memory; 2 bad usage or model.",
};
