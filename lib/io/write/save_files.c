/* SPDX-License-Identifier: BSD-3-Clause */
/* Files that a model names, as a file at another place has to say them. */
#include <stdio.h>
#include <string.h>

#include "io/base/file.h"
#include "io/write/save.h"

enum { PATH_SIZE = 4300 };

/* The folder of a path with its '/', or "". */
static const char *folder_of(se3di_save *s, const char *path)
{
    const char *slash = path ? strrchr(path, '/') : NULL;
    return slash ? se3di_iopool_copy(&s->pool, path, (size_t)(slash - path) + 1) : "";
}

/* From one folder to another, both whole paths that end with '/'. @return false: too long */
static bool lead(const char *from, const char *to, char *path, size_t size)
{
    size_t used = 0;
    size_t same = 0;
    for (size_t k = 0; from[k] && from[k] == to[k]; ++k) {
        same = from[k] == '/' ? k + 1 : same;
    }
    if (same <= 1 && from[0] == '/') { /* nothing but the root */
        return (size_t)snprintf(path, size, "%s", to) < size;
    }
    path[0] = '\0';
    for (const char *at = strchr(from + same, '/'); at; at = strchr(at + 1, '/')) {
        if (used + 4 > size) {
            return false;
        }
        memcpy(path + used, "../", 4);
        used += 3;
    }
    return (size_t)snprintf(path + used, size - used, "%s", to + same) < size - used;
}

/* The way from the folder of the file to be to the one of a part. */
static bool find_way(const char *from, const char *to, char *way, size_t size)
{
    char whole_from[PATH_SIZE];
    char whole_to[PATH_SIZE];
    const size_t same = strlen(from);
    if (strncmp(from, to, same) == 0 && (same > 0 || to[0] != '/') && !strstr(to + same, "../")) {
        return (size_t)snprintf(way, size, "%s", to + same) < size;
    }
    return se3di_file_find_folder(from, whole_from, sizeof whole_from) &&
           se3di_file_find_folder(to, whole_to, sizeof whole_to) &&
           lead(whole_from, whole_to, way, size);
}

bool se3di_save_is_in_metres(const se3di_component *part)
{
    const se3di_units si = se3di_units_si();
    const se3di_measure *length = part && part->scope ? &part->scope->units.length : &si.length;
    return length->times / length->over == 1.0;
}

const char *se3di_save_get_file(se3di_save *s, const se3di_component *part, const char *file)
{
    char way[PATH_SIZE];
    char text[2 * PATH_SIZE];
    const char *to = folder_of(s, part ? part->file : s->model->file);
    const char *from = folder_of(s, s->path ? s->path : s->model->file);
    if (!from || !to || file[0] == '/' || strcmp(from, to) == 0) {
        return file;
    }
    if (!find_way(from, to, way, sizeof way)) {
        se3di_save_refuse(s, "the way to its file %.200s is not known", file);
        return file;
    }
    const int length = snprintf(text, sizeof text, "%s%.4000s", way, file);
    return se3di_iopool_copy(&s->pool, text, (size_t)length);
}
