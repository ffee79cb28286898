/* SPDX-License-Identifier: BSD-3-Clause */
/* Models of other programs as model files: URDF, SDF, MJCF, Adams data sets, Chrono
 * YAML, ME751 JSON.
 *
 * An import is the text of a model file and notes on what is different from the file it was made
 * of. docs/import.md says what becomes of what.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_IMPORT_H
#define SE3D_IMPORT_H

#include "se3d/io.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A file that was imported. @since 0.1 */
typedef struct se3d_model_import se3d_model_import;

/* What a note is about. @since 0.1 */
typedef enum se3d_model_import_note_kind {
    SE3D_IMPORT_LOST = 1,    /* not carried: the model is another machine without it */
    SE3D_IMPORT_CHANGED = 2, /* carried in another way, within rounding of the data */
    SE3D_IMPORT_NAMED = 3,   /* has another name in the model */
    SE3D_IMPORT_NOTE = 4     /* good to know */
} se3d_model_import_note_kind;

/* How to import. @since 0.1 */
typedef struct se3d_model_import_options {
    size_t struct_size;
    const se3d_allocator *allocator; /* copied; NULL: malloc. expat uses malloc in any case */
    const char *format;  /* "urdf", "sdf", "mjcf", "adams", "chrono", "me751"; NULL: by the
                            file */
    const char *folder;  /* of the model file, for paths of meshes; NULL: the file's */
    int32_t merge_fixed; /* not 0: links on fixed joints are one body */
    int32_t free_base;   /* not 0: the root of a robot may move */
} se3d_model_import_options;

/* Fill `options`, of `size` bytes, with the defaults: see se3d_model_import_options_default.
 * @since 0.1 */
SE3D_API void se3d_model_import_options_init(se3d_model_import_options *options, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_model_import_options se3d_model_import_options_default(void)
{
    se3d_model_import_options how;
    se3d_model_import_options_init(&how, sizeof how);
    return how;
}

/* Import a file.
 * @param[in] path     of the file
 * @param[in] options  NULL: the defaults
 * @param[out] error   filled on failure, emptied on success; may be NULL
 * @return OK, NULL, INVALID_ARGUMENT (options), IO (cannot be read), MODEL (malformed, or no known
 *         format; see the message), NO_MEMORY. What could not be carried is no failure: see
 *         se3d_model_import_count_lost.
 * @since 0.1 */
SE3D_API se3d_status se3d_model_import_file(const char *path,
                                            const se3d_model_import_options *options,
                                            se3d_model_import **out, se3d_model_error *error);

/* Import from memory.
 * @param[in] text     [length] as in a file
 * @param[in] length   in bytes
 * @param[in] name     stands for the file in messages; meshes, and files that it names, are
 *                     looked for in its folder
 * @param[in] options  NULL: the defaults
 * @param[out] error   filled on failure, emptied on success; may be NULL
 * @return OK, NULL, INVALID_ARGUMENT (options), MODEL (malformed, or no known format; see the
 *         message), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_model_import_text(const char *text, size_t length, const char *name,
                                            const se3d_model_import_options *options,
                                            se3d_model_import **out, se3d_model_error *error);

/* Destroy an import; NULL is fine. @since 0.1 */
SE3D_API void se3d_model_import_destroy(se3d_model_import *import);

/* Get the model file, which se3d_model_read_text reads.
 * @param[out] length  in bytes; may be NULL
 * @return the text, owned by the import; "" for NULL.
 * @since 0.1 */
SE3D_API const char *se3d_model_import_get_text(const se3d_model_import *import, size_t *length);

/* Get the name of the format that was read: "URDF", "Adams". @return the text; "" for NULL.
 * @since 0.1 */
SE3D_API const char *se3d_model_import_get_format(const se3d_model_import *import);

/* One note. @since 0.1 */
typedef struct se3d_model_import_note {
    size_t line;         /* in the file, 1-based; 0: none */
    int32_t kind;        /* se3d_model_import_note_kind */
    int32_t reserved;    /* 0 */
    const char *message; /* owned by the import */
} se3d_model_import_note;

/* Count the notes, at most 1000 of which are kept. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_model_import_count_notes(const se3d_model_import *import);

/* Count what could not be carried. @return the number of notes of the kind LOST; 0 for NULL.
 * @since 0.1 */
SE3D_API size_t se3d_model_import_count_lost(const se3d_model_import *import);

/* As se3d_model_import_get_note, told the size of *note in bytes. @return as
 * se3d_model_import_get_note, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_model_import_get_note_sized(const se3d_model_import *import, size_t index,
                                                      se3d_model_import_note *note, size_t size);

/* Get a note.
 * @param[in] index  from 0, below se3d_model_import_count_notes
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
static inline se3d_status se3d_model_import_get_note(const se3d_model_import *import, size_t index,
                                                     se3d_model_import_note *note)
{
    return se3d_model_import_get_note_sized(import, index, note, sizeof *note);
}

#ifdef __cplusplus
}
#endif

#endif
