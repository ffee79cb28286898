/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d video DIR: the page of `se3d view`, picture by picture, from headless Chromium into ffmpeg.
 */
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "devtools.h"
#include "file.h"
#include "interrupt.h"
#include "options.h"
#include "outcome.h"
#include "process.h"
#include "text.h"
#include "view.h"

enum { TEXT_MOST = 200 }; /* bytes of a title or caption */
enum { RATE = 30, FRAMES_MAX = 60 * 60 * RATE, PATH_SIZE = 4096, START_SECONDS = 60 };

typedef struct film {
    const char *path;
    FILE *file;             /* begun before the work, so that the message comes early */
    char folder[PATH_SIZE]; /* temporary: the page, Chromium's profile, what ffmpeg makes */
    char made[PATH_SIZE + 64];
    char page[PATH_SIZE + 64];
    double start, end; /* of the motion [s] */
    double speed;
    double view[2];       /* azimuth, elevation [degrees] */
    const options *words; /* title, captions and what is hidden; NULL: as it comes */
    size_t count;         /* of pictures */
    devtools browser;
    child encoder;
} film;

static int fail(const char *text, const char *detail)
{
    if (!interrupt_came()) {
        complain("se3d video: %s%s\n", text, detail);
    }
    return 0;
}

/* Wait until the page is there; learn when its motion begins and ends. */
static int meet_page(film *f)
{
    char expression[200];
    snprintf(expression, sizeof expression,
             "window.se3d ? se3d.film(1280, 720, %.9g, %.9g) : 'no ' + (window.se3dProblem || '')",
             f->view[0], f->view[1]);
    for (int k = 0; k < 10 * START_SECONDS && !interrupt_came(); ++k) {
        const char *text = devtools_evaluate(&f->browser, expression);
        if (!text) {
            return fail("Chromium does not answer", "");
        }
        if (strncmp(text, "no", 2) != 0) {
            char *rest = NULL;
            f->start = strtod(text, &rest);
            f->end = strtod(rest, NULL);
            return 1;
        }
        if (text[2] == ' ' && text[3]) {
            return fail("the page has a problem: ", text + 3);
        }
        child_pause(100);
    }
    return fail("the page does not start in Chromium", "");
}

/* A text as a JavaScript string in single quotes, all but letters and digits as %xx. */
static void quote(const char *text, char *quoted, size_t size)
{
    size_t used = (size_t)snprintf(quoted, size, "decodeURIComponent('");
    for (const char *c = text; *c && used + 6 < size; ++c) {
        const int plain =
            (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9');
        used += (size_t)snprintf(quoted + used, size - used, plain ? "%c" : "%%%02X",
                                 (unsigned)(unsigned char)*c);
    }
    snprintf(quoted + used, size - used, "')");
}

/* A caption as the command line has it, FROM,TO,TEXT [s]. @return its text; NULL: it is none. */
static const char *read_caption(const char *word, double *from, double *to)
{
    char *rest = NULL;
    *from = strtod(word, &rest);
    if (rest == word || *rest != ',') {
        return NULL;
    }
    const char *second = rest + 1;
    *to = strtod(second, &rest);
    const int good = rest != second && *rest == ',' && rest[1] && isfinite(*from) &&
                     isfinite(*to) && *to > *from;
    return good && strlen(rest + 1) <= TEXT_MOST && text_is_plain(rest + 1) ? rest + 1 : NULL;
}

static int check_words(const options *o)
{
    static const char known[] = ",title,time,plots,";
    for (size_t k = 0; k < o->caption_count; ++k) {
        double from = 0.0, to = 0.0;
        if (!read_caption(o->captions[k], &from, &to)) {
            complain("se3d video: the caption is `%s`, must be FROM,TO,TEXT: seconds of the motion "
                     "and at most %d bytes of text\n",
                     o->captions[k], TEXT_MOST);
            return 0;
        }
    }
    if (o->title && (strlen(o->title) > TEXT_MOST || !text_is_plain(o->title))) {
        complain("se3d video: the title must be a text of at most %d bytes\n", TEXT_MOST);
        return 0;
    }
    for (const char *word = o->hide; word; word = strchr(word, ',')) {
        char one[40];
        word += *word == ',';
        const size_t length = strcspn(word, ",");
        snprintf(one, sizeof one, ",%.*s,", length < 30 ? (int)length : 30, word);
        if (one[1] == ',' || !strstr(known, one) || strlen(o->hide) > TEXT_MOST) {
            complain("se3d video: hidden is `%s`, must be of title, time, plots\n", o->hide);
            return 0;
        }
    }
    return 1;
}

/* Tell the page what is written on the pictures. */
static int put_words(film *f)
{
    char quoted[3 * TEXT_MOST + 40];
    char expression[880];
    const options *o = f->words;
    if (o && o->title) {
        quote(o->title, quoted, sizeof quoted);
        snprintf(expression, sizeof expression, "se3d.words({title: %s})", quoted);
        if (!devtools_evaluate(&f->browser, expression)) {
            return fail("Chromium does not answer", "");
        }
    }
    if (o && o->hide) {
        snprintf(expression, sizeof expression, "se3d.words({hide: '%s'})", o->hide);
        if (!devtools_evaluate(&f->browser, expression)) {
            return fail("Chromium does not answer", "");
        }
    }
    for (size_t k = 0; o && k < o->caption_count; ++k) {
        double from = 0.0, to = 0.0;
        quote(read_caption(o->captions[k], &from, &to), quoted, sizeof quoted);
        snprintf(expression, sizeof expression, "se3d.words({caption: [%.9g, %.9g, %s]})", from, to,
                 quoted);
        if (!devtools_evaluate(&f->browser, expression)) {
            return fail("Chromium does not answer", "");
        }
    }
    return 1;
}

/* Real time over speed; a motion that lasts no time is shown for a second. */
static int plan(film *f)
{
    const double frames = f->end > f->start ? round((f->end - f->start) / f->speed * RATE) : RATE;
    if (!(frames <= FRAMES_MAX)) {
        complain(
            "se3d video: %g s of motion at speed %g make a film of more than an hour; choose a "
            "larger --speed\n",
            f->end - f->start, f->speed);
        return 0;
    }
    f->count = frames >= 1.0 ? (size_t)frames : 1;
    return 1;
}

enum { WORDS_MOST = 32 };

/* What ffmpeg is told of each kind of film. Loops are half as large, with 15 pictures a second. */
static const struct {
    const char *ending;
    const char *words[14]; /* NULL at the end */
} kinds[] = {{".mp4",
              {"-c:v", "libx264", "-preset", "veryfast", "-crf", "20", "-vf", "scale=out_range=tv",
               "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4"}},
             {".gif",
              {"-vf",
               "fps=15,scale=640:-1:flags=lanczos,split[a][b];[a]palettegen=max_colors=96[p];"
               "[b][p]paletteuse=dither=none:diff_mode=rectangle",
               "-loop", "0", "-f", "gif"}},
             {".webp",
              {"-vf", "fps=15,scale=640:-1:flags=lanczos", "-c:v", "libwebp", "-quality", "60",
               "-loop", "0", "-f", "webp"}}};

/* The kind of film by the end of its name; MP4 if it is another. */
static size_t find_kind(const char *path)
{
    const size_t length = strlen(path);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
        const size_t tail = strlen(kinds[k].ending);
        if (length > tail && strcmp(path + length - tail, kinds[k].ending) == 0) {
            return k;
        }
    }
    return 0;
}

static int start_encoder(film *f)
{
    static const char *const head[] = {"ffmpeg",     "-v", "error", "-y",    "-f", "image2pipe",
                                       "-framerate", "30", "-c:v",  "mjpeg", "-i", "pipe:0"};
    const size_t kind = find_kind(f->path);
    const char *words[WORDS_MOST] = {NULL};
    size_t count = sizeof head / sizeof *head;
    memcpy(words, head, sizeof head);
    for (size_t k = 0; k < 14 && kinds[kind].words[k]; ++k) {
        words[count++] = kinds[kind].words[k];
    }
    words[count] = f->made;
    return child_start(&f->encoder, words, 0, -1, 0) ||
           fail("ffmpeg cannot be started: ", strerror(errno));
}

static int digit(char c)
{
    return c >= 'A' && c <= 'Z'   ? c - 'A'
           : c >= 'a' && c <= 'z' ? c - 'a' + 26
           : c >= '0' && c <= '9' ? c - '0' + 52
           : c == '+'             ? 62
           : c == '/'             ? 63
                                  : -1;
}

/* Decode base64 in place. @return bytes. */
static size_t decode(char *text)
{
    unsigned char *out = (unsigned char *)text;
    size_t used = 0;
    uint32_t bits = 0;
    int count = 0;
    for (const char *c = text; digit(*c) >= 0; ++c) {
        bits = bits << 6 | (uint32_t)digit(*c);
        count += 6;
        if (count >= 8) {
            count -= 8;
            out[used++] = (unsigned char)(bits >> count);
        }
    }
    return used;
}

static int put_picture(film *f, size_t k)
{
    static const char head[] = "data:image/jpeg;base64,";
    char expression[80];
    const double time = f->start + (double)k * f->speed / RATE;
    snprintf(expression, sizeof expression, "se3d.picture(%.9g)", time < f->end ? time : f->end);
    char *text = devtools_evaluate(&f->browser, expression);
    if (!text || strncmp(text, head, strlen(head)) != 0) {
        return fail("Chromium returned no picture", "");
    }
    text += strlen(head);
    return child_write(&f->encoder, text, decode(text)) ||
           fail("ffmpeg has stopped, see above", "");
}

static int put_pictures(film *f, int quiet)
{
    progress bar;
    int good = 1;
    progress_begin(&bar, quiet, 1);
    for (size_t k = 0; k < f->count && good; ++k) {
        good = !interrupt_came() && put_picture(f, k);
        progress_show(&bar, 0, f->start + (double)k * f->speed / RATE,
                      (double)(k + 1) / (double)f->count);
    }
    progress_end(&bar);
    return good;
}

/* Give the film its name, if it is whole. ffmpeg writes in our folder, under a name of ours. */
static int finish(film *f, int good)
{
    const int code = f->encoder.id != 0 ? child_finish(&f->encoder, good ? 600 : 1) : 0;
    if (good && code != 0) {
        good = fail("ffmpeg failed, see above: ", f->path);
    }
    const int kept = file_end(f->file, f->path, good && file_append(f->file, f->made));
    if (good && !kept) {
        complain("se3d video: %s: cannot be written: %s\n", f->path, strerror(errno));
    }
    return kept;
}

static int make_film(film *f, const char *chromium, const char *results, int quiet)
{
    interrupt_begin();
    interrupt_hold();
    f->file = se3di_partial_open(f->path);
    if (!f->file) {
        complain("se3d video: %s: cannot be written: %s\n", f->path, strerror(errno));
        return EXIT_FAILED;
    }
    if (!folder_make_temporary(f->folder, sizeof f->folder)) {
        complain("se3d video: no temporary folder: %s\n", strerror(errno));
        file_end(f->file, f->path, 0);
        return EXIT_FAILED;
    }
    snprintf(f->page, sizeof f->page, "%s/page.html", f->folder);
    snprintf(f->made, sizeof f->made, "%s/film.mp4", f->folder);
    int good = view_write("video", results, NULL, f->page) == EXIT_DONE;
    if (good) {
        good = (devtools_open(&f->browser, chromium, f->folder, f->page) ||
                fail("Chromium does not answer: ", chromium)) &&
               meet_page(f) && put_words(f) && plan(f) && start_encoder(f) &&
               put_pictures(f, quiet);
        devtools_close(&f->browser);
    }
    good = finish(f, good);
    folder_remove(f->folder);
    if (!good && interrupt_came()) {
        complain("se3d video: interrupted\n");
    }
    return good ? EXIT_DONE : EXIT_FAILED;
}

static int write_film(const char *results, const char *path, double speed, const double view[2],
                      const options *words, int quiet)
{
    const char *chromium = devtools_find_chromium();
    film *f = calloc(1, sizeof *f);
    int code = EXIT_FAILED;
    if (!f) {
        complain("se3d video: out of memory\n");
    } else if (!chromium) {
        process_report_missing("video", "chromium", "chromium");
    } else if (!process_is_found("ffmpeg")) {
        process_report_missing("video", "ffmpeg", "ffmpeg");
    } else {
        f->path = path;
        f->speed = speed;
        f->words = words;
        f->view[0] = view[0];
        f->view[1] = view[1];
        code = make_film(f, chromium, results, quiet);
    }
    if (code == EXIT_DONE && outcome_add_file(path, quiet, ": ")) {
        put_count(f->count, "picture", "pictures", "\n");
    }
    free(f);
    return code;
}

static const double usual_view[2] = {-52.0, 20.0};

int video_write(const char *results, const char *path, double speed, int quiet)
{
    return write_film(results, path, speed, usual_view, NULL, quiet);
}

int view_read_angles(const char *command, const char *text, double view[2])
{
    char *rest = NULL;
    if (!text) {
        return 1;
    }
    view[0] = strtod(text, &rest);
    const int good = rest != text && *rest == ',';
    const char *second = good ? rest + 1 : "";
    view[1] = strtod(second, &rest);
    if (!good || rest == second || *rest || !(fabs(view[0]) <= 360.0 && fabs(view[1]) < 90.0)) {
        complain("se3d %s: the view is `%s`, must be AZIMUTH,ELEVATION in degrees\n", command,
                 text);
        return 0;
    }
    return 1;
}

static int command_video(int count, char *const *words)
{
    double view[2] = {usual_view[0], usual_view[1]};
    char folder[PATH_SIZE];
    char path[PATH_SIZE + 64];
    char *rest = NULL;
    options o;
    int code = options_read(&o, &video_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    o.quiet = o.quiet || o.json;
    const double speed = o.speed ? strtod(o.speed, &rest) : 1.0;
    if (!(speed > 0.0 && speed <= 1e12) || (rest && *rest)) {
        complain("se3d video: the speed is `%s`, must be a number > 0\n", o.speed);
        return EXIT_USAGE;
    }
    if (!view_read_angles("video", o.view, view) || !check_words(&o)) {
        return EXIT_USAGE;
    }
    code = run_for_view("video", o.model, o.quiet, folder, sizeof folder);
    if (code != EXIT_DONE) {
        return code;
    }
    snprintf(path, sizeof path, "%.4000s/motion.mp4", folder);
    return write_film(folder, o.directory ? o.directory : path, speed, view, &o, o.quiet);
}

const command_entry video_entry = {
    .name = "video",
    .run = command_video,
    .operands = "DIR|MODEL",
    .files = "yaml yml json",
    .summary = "make a film of results in 3-D",
    .text = "Makes a film (default DIR/motion.mp4; 1280 x 720, 30 pictures a second, "
            "H.264) of the results in DIR, as `se3d run` left them: what `se3d view` "
            "shows. A model is run first. A name that ends with .gif or .webp makes a loop for a "
            "web page: 640 x "
            "360, 15 pictures a second. It needs chromium and ffmpeg.",
    .options =
        (const command_option[]){
            {"--output", "-o", "FILE", "where to, .mp4, .gif or .webp (default: DIR/motion.mp4)"},
            {"--speed", NULL, "S", "seconds of motion in a second of film (default 1: real time)"},
            {"--view", NULL, "A,E",
             "from where: azimuth from x to y and elevation [degrees] (default -52,20)"},
            {"--title", NULL, "TEXT", "in place of the title of the model"},
            {"--caption", NULL, "FROM,TO,TEXT",
             "a text below, from and to these times of the motion [s]; may be repeated"},
            {"--hide", NULL, "WORDS", "of title, time, plots: what is left out"},
            {0}},
    .examples =
        (const command_example[]){
            {"video results/pendulum", "results/pendulum/motion.mp4"},
            {"video results/drum --speed 0.1 --view 0,10", "ten times slower, from the side"},
            {"video results/drum -o drum.webp --hide time,plots", "a loop with its title alone"},
            {"video results/car --caption '0,1.5,before the kerb'",
             "words below the first 1.5 s of the motion"},
            {0}},
    .exits = "0 done; 1 a file or program failed; 2 bad usage.",
};
