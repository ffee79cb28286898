/* SPDX-License-Identifier: BSD-3-Clause */
/* Files of meshes. Packages of robots' formats are looked for where they usually lie: above the
 * file that names them. */
#if !defined(_WIN32)
#define _XOPEN_SOURCE 700
#endif

#include "io/import/mesh.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/base/file.h"
#include "io/import/scan.h"

enum { UP_MAX = 8 /* folders above the file */ };

const char *se3di_path_folder(se3di_machine *m, const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *folder =
        slash ? se3di_iopool_copy(m->pool, path, slash > path ? (size_t)(slash - path) : 1) : ".";
    if (!folder) {
        se3di_machine_fail_memory(m);
    }
    return folder;
}

const char *se3di_path_join(se3di_machine *m, const char *folder, const char *name)
{
    if (name[0] == '/' || !folder || !folder[0] || strcmp(folder, ".") == 0) {
        return name;
    }
    return se3di_machine_text(m, "%s/%s", folder, name);
}

static bool is_file(const char *path)
{
    FILE *file = path && strlen(path) < 4000 ? se3di_file_open(path) : NULL;
    if (file) {
        fclose(file);
    }
    return file != NULL;
}

#if defined(_WIN32)
static const char *absolute(se3di_machine *m, const char *path)
{
    (void)m;
    return path;
}
#else
static const char *absolute(se3di_machine *m, const char *path)
{
    char *real = realpath(path, NULL);
    const char *copy = real ? se3di_iopool_copy(m->pool, real, strlen(real)) : path;
    free(real);
    if (!copy) {
        se3di_machine_fail_memory(m);
    }
    return copy;
}
#endif

/* The path from the folder of the model file to `path`. */
static const char *seen_from_model(se3di_machine *m, const char *path)
{
    if (!m->options->folder) {
        return path;
    }
    const char *to = absolute(m, path);
    const char *from = absolute(m, m->options->folder[0] ? m->options->folder : ".");
    size_t common = 0; /* characters up to the last '/' that both have */
    size_t k = 0;
    if (!to || !from || to[0] != '/' || from[0] != '/') {
        return to;
    }
    while (to[k] && to[k] == from[k]) {
        ++k;
        common = to[k - 1] == '/' ? k : common;
    }
    if (!from[k] && to[k] == '/') {
        common = k + 1;
    }
    const char *out = to + common;
    int up = 0;
    for (const char *rest = strlen(from) > common ? from + common : ""; *rest && out; ++up) {
        out = up < 40 ? se3di_machine_text(m, "../%s", out) : NULL;
        rest += strcspn(rest, "/");
        rest += *rest == '/';
    }
    return out ? out : to;
}

/* "package://name/rest" below a folder above: as name/rest, or as rest if the folder is the
 * package. */
static const char *find_in_packages(se3di_machine *m, const char *folder, const char *name)
{
    const char *rest = strchr(name, '/');
    const char *up = folder && folder[0] ? folder : ".";
    for (int k = 0; up && k < UP_MAX; ++k) {
        const char *whole = se3di_machine_text(m, "%s/%s", up, name);
        const char *inner = rest ? se3di_machine_text(m, "%s%s", up, rest) : NULL;
        if (whole && is_file(whole)) {
            return whole;
        }
        if (inner && is_file(inner)) {
            return inner;
        }
        up = strcmp(up, ".") == 0 ? ".." : se3di_machine_text(m, "%s/..", up);
    }
    return NULL;
}

static const char *find_mesh(se3di_machine *m, const char *folder, const char *name)
{
    static const char *const packages[] = {"package://", "model://"};
    for (size_t k = 0; k < 2; ++k) {
        if (strncmp(name, packages[k], strlen(packages[k])) == 0) {
            return find_in_packages(m, folder, name + strlen(packages[k]));
        }
    }
    if (strncmp(name, "file://", 7) == 0) {
        name += 7;
    }
    const char *path = se3di_path_join(m, folder, name);
    return path && is_file(path) ? path : NULL;
}

static bool has_ending(const char *name, const char *ending)
{
    const size_t length = strlen(name);
    const size_t size = strlen(ending);
    return length > size && se3di_scan_equal(name + length - size, ending);
}

bool se3di_mesh_take(se3di_machine *m, size_t line, const char *folder, const char *name,
                     const double scale[3], se3di_machine_shape *shape)
{
    const char *why = NULL;
    if (!has_ending(name, ".stl") && !has_ending(name, ".obj")) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, line,
                              "the mesh `%.300s` is neither STL nor OBJ; `assimp export IN "
                              "OUT.stl` converts it, then change its name in the file",
                              name);
        return false;
    }
    if (!(scale[0] > 0.0) || scale[1] < scale[0] || scale[1] > scale[0] || scale[2] < scale[0] ||
        scale[2] > scale[0]) {
        why = "its scale is not one factor > 0 along all axes";
    }
    const char *path = why ? NULL : find_mesh(m, folder, name);
    if (!why && !path) {
        why = "there is no such file";
    }
    if (why) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, line, "the mesh `%.300s`: %s", name, why);
        return false;
    }
    shape->type = "mesh";
    shape->file = seen_from_model(m, path);
    shape->scale = scale[0];
    return shape->file != NULL;
}
