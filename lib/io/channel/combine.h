/* SPDX-License-Identifier: BSD-3-Clause */
/* Expressions of channels: hypot(pin.force.x, pin.force.z), bar.position.z - 30 mm. */
#ifndef SE3D_IO_COMBINE_H
#define SE3D_IO_COMBINE_H

#include "io/channel/channel.h"
#include "io/document/reader.h"

/* A text whose channels have become variables of the same length, so that columns of messages stay
 * right: pin.force.x is pin_force_x. Names with other characters stand in ' '. */
typedef struct se3di_mentions {
    const char *text;
    const char *variables[SE3D_EXPRESSION_VARIABLE_MAX + 1]; /* the time, the channels, NULL */
    se3di_dimension dimensions[SE3D_EXPRESSION_VARIABLE_MAX];
    se3di_channel channels[SE3D_EXPRESSION_VARIABLE_MAX]; /* [0] is not used */
    size_t components[SE3D_EXPRESSION_VARIABLE_MAX];
    size_t count; /* of the variables */
} se3di_mentions;

/* Whether a text has operators and is not the name of a channel all the same. */
bool se3di_text_is_combination(se3d_model *model, const char *text);
/* Whether a text has a name that may be a channel's; unlike the next one it looks up none. */
bool se3di_text_has_mention(const se3di_component *part, const char *text);
/* Find the channels that a text names, `taken` (NULL at the end) variables before them; of a part
 * (NULL: none) its own before those of the model. If it cannot, `problem` gets why and *where the
 * place in the text. */
bool se3di_mentions_find(se3d_model *model, const se3di_component *part, const char *text,
                         const char *const *taken, se3di_mentions *mentions, size_t *where,
                         char *problem, size_t size);
/* The same of a node: it reports. */
bool se3di_mentions_read(se3di_reader *reader, const se3di_node *node, const char *const *taken,
                         se3di_mentions *mentions);
/* The number that the text of `plain`, which is the node's, stands for with these channels. */
bool se3di_mentions_eval(se3di_reader *reader, const se3di_node *node, const se3di_mentions *m,
                         const se3di_node *plain, se3di_amount *q);
/* The channel that an expression is, as the model file has it: with parameters, points and units.
 * @return false after a report */
bool se3di_combination_read(se3di_reader *reader, const se3di_node *node, const char *name,
                            se3di_channel *channel);
/* The same without a file: in SI units. */
bool se3di_combination_find(se3d_model *model, const char *text, se3di_channel *channel,
                            char *problem, size_t size);
/* A component of a channel as a channel of its own. */
bool se3di_component_find(se3d_model *model, const char *name, se3di_channel *channel,
                          char *problem, size_t size);

#endif
