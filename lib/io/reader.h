/* SPDX-License-Identifier: BSD-3-Clause */
/* Reading values out of a document: every function returns false after it has reported why. The
 * first error ends the reading. */
#ifndef SE3D_IO_READER_H
#define SE3D_IO_READER_H

#include "io/keys.h"
#include "io/model.h"

typedef struct se3di_reader {
    se3d_model *model;
    const se3d_model_options *options;
    se3d_model_error *error;
    se3d_status status;
} se3di_reader;

typedef enum se3di_range {
    SE3DI_ANY = 0,         /* finite */
    SE3DI_POSITIVE = 1,    /* finite and > 0 */
    SE3DI_NOT_NEGATIVE = 2 /* finite and >= 0 */
} se3di_range;

/* Report about a node: "file:line:column: path: text". Always false. */
SE3DI_IO_FORMAT(3, 4)
bool se3di_reader_fail(se3di_reader *reader, const se3di_node *node, const char *format, ...);
/* Report about a key of a map: where the key is, or where the map begins if it has no such key. */
SE3DI_IO_FORMAT(4, 5)
bool se3di_reader_fail_key(se3di_reader *reader, const se3di_node *map, const char *key,
                           const char *format, ...);
bool se3di_reader_fail_memory(se3di_reader *reader);
/* Report the system's message about the element that `map` describes, at the key it names. */
bool se3di_reader_fail_system(se3di_reader *reader, const se3di_node *map, se3d_status status);

/* `node` must be a map whose keys are those of `object` (and, if it has types, of its type). */
bool se3di_read_keys(se3di_reader *reader, const se3di_node *node, se3di_object object);
/* The `type` of a map, one of `types`; `what` is "a joint type", ... */
bool se3di_read_type(se3di_reader *reader, const se3di_node *node, se3di_object object,
                     const char **type);
/* A list, or nothing (NULL or empty: *list is NULL). */
bool se3di_read_list(se3di_reader *reader, const se3di_node *map, const char *key,
                     const se3di_node **list);
/* A text that is one of `words` (NULL at the end): its index. */
bool se3di_read_word(se3di_reader *reader, const se3di_node *node, const char *const *words,
                     size_t *index);
bool se3di_read_text(se3di_reader *reader, const se3di_node *node, const char **text);
bool se3di_read_bool(se3di_reader *reader, const se3di_node *node, int32_t *value);
/* A name that other things refer to: not empty, without blanks at its ends, dots, commas, ... */
bool se3di_read_name(se3di_reader *reader, const se3di_node *node, const char **name);

/* The name of a file inside the folder of the results: relative, without "..", "." and "//". */
bool se3di_read_file_name(se3di_reader *reader, const se3di_node *node, const char **name);

bool se3di_read_number(se3di_reader *reader, const se3di_node *node, se3di_range range,
                       double *value);
/* The number under `key`, left alone where there is none. */
bool se3di_read_key_number(se3di_reader *reader, const se3di_node *map, const char *key,
                           se3di_range range, double *value);
/* A coefficient of restitution, 0.01 to 1, left alone where there is none. */
bool se3di_read_key_restitution(se3di_reader *reader, const se3di_node *map, double *value);
/* The same for a whole number from 0 to `largest`. */
bool se3di_read_key_count(se3di_reader *reader, const se3di_node *map, const char *key,
                          double largest, double *value);
/* The material that the value of `key` names, which is made where it is needed first. */
bool se3di_read_key_material(se3di_reader *reader, const se3di_node *map, const char *key,
                             se3d_material *material);
/* The material of a name. @return false: there is none, or (reader->status < 0) it is refused. */
bool se3di_reader_find_material(se3di_reader *reader, const char *name, se3d_material *material);
bool se3di_read_vector(se3di_reader *reader, const se3di_node *node, size_t size, double *value);
bool se3di_read_key_vector(se3di_reader *reader, const se3di_node *map, const char *key,
                           double value[3]);
/* As above, and not the zero vector. */
bool se3di_read_key_direction(se3di_reader *reader, const se3di_node *map, const char *key,
                              double value[3]);
/* The Euler parameters under `orientation`, left alone where there is none. */
bool se3di_read_key_orientation(se3di_reader *reader, const se3di_node *map, double p[4]);
/* The Euler parameters that a map says; NULL: left alone. */
bool se3di_read_orientation(se3di_reader *reader, const se3di_node *node, double p[4]);
/* A number, or a function of `variables` (NULL at the end, the first is the time): then *function
 * is not null. */
bool se3di_read_function(se3di_reader *reader, const se3di_node *node, const char *const *variables,
                         double *value, se3d_function *function);

/* The body whose name stands under `key`; entry NULL: only the handle is wanted. */
bool se3di_read_key_body(se3di_reader *reader, const se3di_node *map, const char *key,
                         const se3di_body_entry **entry);
/* The joint whose name stands under `key`. */
bool se3di_read_key_joint(se3di_reader *reader, const se3di_node *map, const char *key,
                          se3d_constraint *joint);
/* The coordinate of `joint` under `coordinate`, or the only one that it has. */
bool se3di_read_key_coordinate(se3di_reader *reader, const se3di_node *map, se3d_constraint joint,
                               int32_t *coordinate);
/* body_i and body_j, which must differ; `what` is "a spring", ... */
bool se3di_read_bodies_ij(se3di_reader *reader, const se3di_node *node, const char *what,
                          const se3di_body_entry *bodies[2]);
/* A point of a body: three coordinates or the name of one of its markers; left alone where there is
 * none. */
bool se3di_read_key_point(se3di_reader *reader, const se3di_node *map, const char *key,
                          const se3di_body_entry *body, double point[3]);

/* The sections of the file, in the order in which they are read. */
bool se3di_read_parameters(se3di_reader *reader, const se3di_node *root);
bool se3di_read_materials(se3di_reader *reader, const se3di_node *root);
bool se3di_read_bodies(se3di_reader *reader, const se3di_node *root);
bool se3di_read_shapes(se3di_reader *reader, const se3di_node *body, size_t entry);
/* Mass and inertia of a body from its shapes' densities. */
bool se3di_read_shape_mass(se3di_reader *reader, const se3di_node *body, se3d_body_def *def);
bool se3di_read_joints(se3di_reader *reader, const se3di_node *root);
bool se3di_read_constraints(se3di_reader *reader, const se3di_node *root);
bool se3di_read_drivers(se3di_reader *reader, const se3di_node *root);
bool se3di_read_forces(se3di_reader *reader, const se3di_node *root);
bool se3di_read_analyses(se3di_reader *reader, const se3di_node *root);
/* The keys that only an analysis of type modes has. */
bool se3di_read_modes(se3di_reader *reader, const se3di_node *node, se3di_analysis_entry *entry);
/* `contact` and `particles`, after the analyses. */
bool se3di_read_contact(se3di_reader *reader, const se3di_node *root);
bool se3di_read_particles(se3di_reader *reader, const se3di_node *root);
bool se3di_read_outputs(se3di_reader *reader, const se3di_node *root);
bool se3di_read_events(se3di_reader *reader, const se3di_node *root);

/* Load the file that the key `file` of a map names, relative to the model, to memory of `pool`; a
 * zero follows it. */
bool se3di_read_attachment(se3di_reader *reader, const se3di_node *map, const char *file,
                           se3di_iopool *pool, char **text, size_t *size);

/* Begin an element: its name, given or made up, is added to the model. */
bool se3di_read_element(se3di_reader *reader, const se3di_node *node, se3di_element_kind kind,
                        se3di_element_entry **entry);
/* One that a pair of bodies carries: used for joints and two of the constraints. */
bool se3di_read_pair(se3di_reader *reader, const se3di_node *node, const char *type,
                     se3di_element_entry *entry);

/* Force elements of one type each. */
bool se3di_read_bushing(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry);
bool se3di_read_friction(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry);
bool se3di_read_stop(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry);

/* Compile the text of `node`; def->symbols NULL: the parameters. */
bool se3di_read_compile(se3di_reader *reader, const se3di_node *node, se3d_expression_def *def,
                        se3d_expression **expression);
/* Evaluate the text of `node` as an expression over `symbols`. */
bool se3di_read_expression(se3di_reader *reader, const se3di_node *node,
                           const se3d_expression_symbol *symbols, size_t count, double *value);

/* True for letters, digits and '_', not beginning with a digit. */
bool se3di_text_is_identifier(const char *text);

#endif
