/* SPDX-License-Identifier: BSD-3-Clause */
#define _XOPEN_SOURCE 700

#include "page.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "child.h"
#include "file.h"
#include "options.h"
#include "outcome.h"
#include "process.h"

char *page_read_whole(const char *path, size_t *size)
{
    FILE *file = se3di_file_open(path);
    char *data = NULL;
    *size = 0;
    if (file && fseek(file, 0, SEEK_END) == 0) {
        const long length = ftell(file);
        rewind(file);
        data = length >= 0 ? malloc((size_t)length + 1) : NULL;
        if (data) {
            *size = fread(data, 1, (size_t)length, file);
            data[*size] = '\0';
        }
    }
    if (file) {
        fclose(file);
    }
    return data;
}

/* The folder of the page's parts: SE3D_VIEWER, beside an installed program, or in the sources. */
static int find_viewer(char *folder, size_t size)
{
    static const char *const places[] = {"../share/se3d/viewer", "../../../tools/viewer",
                                         "../../tools/viewer"};
    char program[PAGE_PATH];
    char file[PAGE_PATH + 64];
    const char *given = getenv("SE3D_VIEWER");
    if (given) {
        snprintf(folder, size, "%s", given);
        return 1;
    }
    if (!process_get_own_folder(program, sizeof program)) {
        return 0;
    }
    for (size_t k = 0; k < sizeof places / sizeof *places; ++k) {
        const int used = snprintf(folder, size, "%s/%s", program, places[k]);
        snprintf(file, sizeof file, "%.4000s/viewer.js", folder);
        if (used > 0 && (size_t)used < size && access(file, R_OK) == 0) {
            return 1;
        }
    }
    return 0;
}

/* The place where three.js is kept. @return false: the user has no place for it. */
static int find_cache(char *folder, size_t size)
{
    const char *given = getenv("SE3D_CACHE");
    const char *user = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    const int used = given               ? snprintf(folder, size, "%s", given)
                     : (user && user[0]) ? snprintf(folder, size, "%s/se3d", user)
                     : (home && home[0]) ? snprintf(folder, size, "%s/.cache/se3d", home)
                                         : 0;
    return used > 0 && (size_t)used < size;
}

static int put_file(FILE *out, const char *folder, const char *name)
{
    char path[PAGE_PATH + 64];
    size_t size = 0;
    snprintf(path, sizeof path, "%.4000s/%s", folder, name);
    char *data = page_read_whole(path, &size);
    if (!data) {
        complain("se3d: %s: cannot be read\n", path);
        return 0;
    }
    fwrite(data, 1, size, out);
    free(data);
    return 1;
}

/* Whether what is at `path` may be run or shown: if not, says so. */
static int check_own(const page_parts *p, const char *path)
{
    if (file_is_own(path)) {
        return 1;
    }
    complain("se3d %s: %s belongs to another user, or others can change it; set SE3D_CACHE to a "
             "folder of your own\n",
             p->command, path);
    return 0;
}

/* Make three.js in the cache, if it is not. What others could have put there is not taken, and
 * nothing is run where they could. */
static int make_three(const page_parts *p)
{
    char script[PAGE_PATH + 64];
    snprintf(script, sizeof script, "%.4000s/build.sh", p->viewer);
    const char *const words[] = {"sh", script, p->cache, NULL};
    if (!file_is_missing(p->cache) && !check_own(p, p->cache)) {
        return EXIT_FAILED;
    }
    if (process_run(NULL, words) != 0) {
        complain("se3d %s: three.js could not be made, see above\n", p->command);
        return EXIT_FAILED;
    }
    snprintf(script, sizeof script, "%.4000s/three.js", p->cache);
    return check_own(p, p->cache) && check_own(p, script) ? EXIT_DONE : EXIT_FAILED;
}

int page_begin(page_parts *p, const char *command)
{
    char script[PAGE_PATH + 64];
    p->command = command;
    p->is_passing = 0;
    if (!find_viewer(p->viewer, sizeof p->viewer)) {
        complain("se3d %s: the parts of the page are not found; set SE3D_VIEWER to the folder "
                 "tools/viewer of the source\n",
                 command);
        return EXIT_FAILED;
    }
    snprintf(script, sizeof script, "%.4000s/three.js", p->viewer);
    if (access(script, R_OK) == 0) { /* installed with the program */
        strcpy(p->cache, p->viewer);
        return EXIT_DONE;
    }
    if (!find_cache(p->cache, sizeof p->cache)) {
        p->is_passing = folder_make_temporary(p->cache, sizeof p->cache);
        if (!p->is_passing) {
            complain("se3d %s: no temporary folder: %s\n", command, strerror(errno));
            return EXIT_FAILED;
        }
    }
    return make_three(p);
}

void page_end(const page_parts *p)
{
    if (p->is_passing) {
        folder_remove(p->cache);
    }
}

int page_put_begin(FILE *file, const page_parts *p, int asks_nobody)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n", file);
    if (asks_nobody) {
        fputs("<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
              "script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
              "base-uri 'none'; form-action 'none'\">\n",
              file);
    }
    fputs("<meta name=\"viewport\" content=\"width=device-width\">"
          "<link rel=\"icon\" href=\"data:,\">\n<title>se3d</title>\n<style>\n",
          file);
    const int good = put_file(file, p->viewer, "viewer.css");
    fputs("</style></head><body>\n", file);
    return good && put_file(file, p->viewer, "viewer.html");
}

int page_put_part(FILE *file, const page_parts *p, const char *name)
{
    return put_file(file, p->viewer, name);
}

int page_put_end(FILE *file, const page_parts *p, const char *script)
{
    fputs("<script>\n", file);
    int good = put_file(file, p->cache, "three.js");
    fputs("\n", file);
    const char *const scripts[] = {"plots.js",  "light.js",  "coils.js", "rounds.js",
                                   "grains.js", "viewer.js", script};
    for (size_t k = 0; k < sizeof scripts / sizeof *scripts && scripts[k]; ++k) {
        fputs("</script>\n<script>\n", file);
        good = good && put_file(file, p->viewer, scripts[k]);
    }
    fputs("</script>\n</body></html>\n", file);
    return good;
}
