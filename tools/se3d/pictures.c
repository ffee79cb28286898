/* SPDX-License-Identifier: BSD-3-Clause */
/* Plots, scenes and films after a run. */
#include "pictures.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options.h"
#include "outcome.h"
#include "process.h"
#include "view.h"

enum { PATH_SIZE = 4096 };

static int join(const char *folder, const char *file, char *path)
{
    const int length = path_is_absolute(file) ? snprintf(path, PATH_SIZE, "%s", file)
                                              : snprintf(path, PATH_SIZE, "%s/%s", folder, file);
    if (length < 0 || length >= PATH_SIZE) {
        complain("se3d run: the path of %s is too long\n", file);
        return 0;
    }
    return 1;
}

/* As `se3d plot` would. */
static int make_plot(const se3d_model_picture *picture, const char *folder, const char *path,
                     int quiet)
{
    char results[PATH_SIZE];
    int count = 0;
    const char **words = calloc(8 + 2 * picture->channel_count, sizeof *words);
    if (!words || !join(folder, picture->results, results)) {
        free(words);
        return EXIT_FAILED;
    }
    words[count++] = "-o";
    words[count++] = path;
    if (picture->x) {
        words[count++] = "-x";
        words[count++] = picture->x;
    }
    for (size_t k = 0; k < picture->channel_count; ++k) {
        words[count++] = "-y";
        words[count++] = picture->channels[k];
    }
    if (picture->fft) {
        words[count++] = "--fft";
    }
    if (quiet) {
        words[count++] = "--quiet";
    }
    words[count++] = "--";
    words[count++] = results;
    const int code = plot_files(count, words);
    free(words);
    return code;
}

static int make_scene(se3d_scene *scene, const char *folder, const char *path, int quiet)
{
    char without[PATH_SIZE];
    se3d_model_error error;
    int code = EXIT_DONE;
    path_cut(path, ".glb", without, sizeof without);
    if (strlen(without) == strlen(path)) {
        code = view_write("run", folder, NULL, path);
    } else if (!scene || SE3D_FAILED(se3d_scene_write(scene, path, &error))) {
        complain("se3d run: %s\n", scene ? error.message : "out of memory");
        code = EXIT_FAILED;
    }
    if (code == EXIT_DONE) {
        outcome_add_file(path, quiet, "\n");
    }
    return code;
}

int pictures_make(const se3d_model *model, se3d_scene *scene, const char *folder, const char *type,
                  int quiet)
{
    int worst = EXIT_DONE;
    for (size_t k = 0; k < se3d_model_count_pictures(model); ++k) {
        char path[PATH_SIZE];
        se3d_model_picture picture;
        int code = EXIT_FAILED;
        se3d_model_get_picture(model, k, &picture);
        if (type && strcmp(type, picture.type) != 0) {
            continue;
        }
        if (join(folder, picture.file, path)) {
            code = strcmp(picture.type, "plot") == 0 ? make_plot(&picture, folder, path, quiet)
                   : strcmp(picture.type, "scene") == 0
                       ? make_scene(scene, folder, path, quiet)
                       : video_write(folder, path, picture.speed, quiet);
        }
        worst = code != EXIT_DONE ? EXIT_FAILED : worst;
    }
    return worst;
}
