/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d plot FILE.csv...: results as SVG, PNG and PDF, by way of gnuplot. */
#include "plot.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "command.h"
#include "file.h"
#include "interrupt.h"
#include "options.h"
#include "outcome.h"
#include "process.h"
#include "text.h"

enum { PATH_SIZE = 4096 };

static int take_style(plot *p, const char *value)
{
    p->paper = strcmp(value, "paper") == 0;
    if (!p->paper && strcmp(value, "screen") != 0) {
        complain("se3d plot: the style is `%s`, must be screen or paper\n", value);
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}

static int take_width(plot *p, const char *value)
{
    char *rest = NULL;
    p->width = strtod(value, &rest);
    if (rest == value || (*rest && strcmp(rest, "mm") != 0) ||
        !(p->width >= 30.0 && p->width <= 1000.0)) {
        complain("se3d plot: the width is `%s`, must be 30mm to 1000mm\n", value);
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}

static int take_value(plot *p, const char *name, const char *value)
{
    if (!value) {
        complain("se3d plot: a value is missing after `%s`; see `se3d help plot`\n", name);
        return EXIT_USAGE;
    }
    if (strcmp(name, "-x") == 0) {
        p->x = value;
    } else if (strcmp(name, "--style") == 0) {
        return take_style(p, value);
    } else if (strcmp(name, "--width") == 0) {
        return take_width(p, value);
    } else if (strcmp(name, "-y") != 0) {
        p->output = value;
    } else if (p->channel_count < PLOT_CHANNELS_MAX) {
        p->channels[p->channel_count++] = value;
    } else {
        complain("se3d plot: more than %d channels\n", PLOT_CHANNELS_MAX);
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}

static int add_file(plot *p, const char *word)
{
    if (p->file_count == PLOT_FILES_MAX) {
        complain("se3d plot: more than %d files\n", PLOT_FILES_MAX);
        return EXIT_USAGE;
    }
    p->files[p->file_count++] = word;
    return EXIT_DONE;
}

static int read_word(plot *p, const char *word)
{
    if (command_find_common(word)) {
        options_take_common(word, &p->quiet, &p->help);
    } else if (strcmp(word, "--fft") == 0) {
        p->fft = 1;
    } else if (strcmp(word, "--difference") == 0) {
        p->difference = 1;
    } else if (word[0] == '-' && word[1]) {
        complain("se3d plot: unknown option `%s`; see `se3d help plot`\n", word);
        return EXIT_USAGE;
    } else {
        return add_file(p, word);
    }
    return EXIT_DONE;
}

static int takes_value(const char *word)
{
    static const char *const names[] = {"-x", "-y", "-o", "--style", "--width"};
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
        if (strcmp(word, names[k]) == 0) {
            return 1;
        }
    }
    return 0;
}

static int read_words(plot *p, int count, const char *const *words)
{
    int names = 0; /* after "--" no word is an option */
    for (int k = 0; k < count; ++k) {
        int code = EXIT_DONE;
        if (names) {
            code = add_file(p, words[k]);
        } else if (strcmp(words[k], "--") == 0) {
            names = 1;
        } else if (takes_value(words[k])) {
            code = take_value(p, words[k], k + 1 < count ? words[k + 1] : NULL);
            ++k;
        } else {
            code = read_word(p, words[k]);
        }
        if (code != EXIT_DONE) {
            return code;
        }
    }
    if (p->file_count == 0 && !p->help) {
        complain("se3d plot: which results? Give a CSV file, see `se3d help plot`\n");
        return EXIT_USAGE;
    }
    if (p->difference && !p->help && (p->file_count != 2 || p->x || p->fft)) {
        complain("se3d plot: --difference is of two files, without -x and --fft\n");
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}

static int name_output(plot *p)
{
    static const char *const endings[] = {".svg", ".png", ".pdf", ".gp"};
    if (!path_cut(p->output ? p->output : p->files[0], p->output ? "" : ".csv", p->base,
                  sizeof p->base - 64)) {
        complain("se3d plot: the name of the picture is too long\n");
        return 0;
    }
    for (size_t k = 0; p->output && k < sizeof endings / sizeof *endings; ++k) {
        path_cut(p->base, endings[k], p->base, sizeof p->base);
    }
    if (!text_is_plain(path_get_name(p->base))) {
        complain(
            "se3d plot: the name of the picture has control characters or is not UTF-8; choose "
            "one with -o\n");
        return 0;
    }
    return 1;
}

/* True if a file that gnuplot made ends as it should, but for blanks. */
static int is_whole(const char *path, const char *tail)
{
    char end[16] = "";
    const size_t length = strlen(tail);
    int whole = 0;
    FILE *file = se3di_file_open(path);
    if (file && fseek(file, -(long)sizeof end, SEEK_END) == 0 &&
        fread(end, 1, sizeof end, file) == sizeof end) {
        for (size_t k = 0; k + length <= sizeof end; ++k) {
            whole = whole || memcmp(end + k, tail, length) == 0;
        }
    }
    if (file) {
        fclose(file);
    }
    return whole;
}

/* Give one of the files that were made in `folder` its place and name. */
static int keep(const plot *p, const char *folder, const char *ending)
{
    char made[PATH_SIZE + 64];
    char name[PATH_SIZE + 64];
    snprintf(made, sizeof made, "%s/plot%s", folder, ending);
    snprintf(name, sizeof name, "%s%s", p->base, ending);
    errno = 0;
    if (!file_copy(made, name)) {
        complain("se3d plot: %s: cannot be written: %s\n", name, strerror(errno));
        return 0;
    }
    if (strcmp(ending, ".gp") != 0) {
        outcome_add_file(name, p->quiet, "\n");
    }
    return 1;
}

/* The script is made and run in a folder of its own under names of ours, so that no name of others
 * comes before gnuplot, and it reads no file of settings. */
static int draw_in(plot *p, const char *folder)
{
    static const char *const words[] = {"gnuplot", "-d", "-e", "base='plot'", "plot.gp", NULL};
    char path[PATH_SIZE + 64];
    snprintf(path, sizeof path, "%s/plot.gp", folder);
    errno = 0;
    if (!plot_write_script(p, path)) {
        complain("se3d plot: %s: cannot be written: %s\n", path, strerror(errno ? errno : ENOMEM));
        return 0;
    }
    if (!keep(p, folder, ".gp")) {
        return 0;
    }
    const int code = process_run(folder, words);
    snprintf(path, sizeof path, "%s/plot.svg", folder);
    int whole = code == 0 && is_whole(path, "</svg>");
    snprintf(path, sizeof path, "%s/plot.png", folder);
    whole = whole && is_whole(path, "IEND");
    snprintf(path, sizeof path, "%s/plot.pdf", folder);
    whole = whole && is_whole(path, "%%EOF");
    if (!whole || interrupt_came()) {
        complain("se3d plot: %s on %s.gp\n", interrupt_came() ? "interrupted" : "gnuplot failed",
                 p->base);
        return 0;
    }
    return keep(p, folder, ".svg") && keep(p, folder, ".png") && keep(p, folder, ".pdf");
}

static int draw(plot *p)
{
    char folder[PATH_SIZE];
    if (!folder_make_temporary(folder, sizeof folder)) {
        complain("se3d plot: no temporary folder: %s\n", strerror(errno));
        return EXIT_FAILED;
    }
    const int good = draw_in(p, folder);
    folder_remove(folder);
    return good ? EXIT_DONE : EXIT_FAILED;
}

static int plot_all(plot *p)
{
    for (size_t k = 0; k < p->file_count; ++k) {
        if (!table_read(&p->tables[k], "plot", p->files[k])) {
            return EXIT_FAILED;
        }
    }
    if (!name_output(p)) {
        return EXIT_USAGE;
    }
    if (!plot_make_bode(p)) {
        return EXIT_FAILED;
    }
    if (!plot_choose(p)) {
        return EXIT_USAGE;
    }
    if (!process_is_found("gnuplot")) {
        return process_report_missing("plot", "gnuplot", "gnuplot-nox");
    }
    if ((p->fft && !plot_transform(p)) || (p->difference && !plot_subtract(p))) {
        return EXIT_FAILED;
    }
    return draw(p);
}

/* Models are run, and their results drawn. */
static int run_models(plot *p)
{
    for (size_t k = 0; k < p->file_count; ++k) {
        if (path_is_model(p->files[k])) {
            const int alone = p->file_count == 1 && p->channel_count == 0 && !p->x && !p->fft;
            const int code =
                run_for_plots(p->files[k], p->quiet, alone, p->csv[k], sizeof p->csv[k]);
            if (code != EXIT_DONE) {
                return code;
            }
            p->done = p->csv[k][0] == '\0';
            p->files[k] = p->csv[k];
        }
    }
    return EXIT_DONE;
}

int plot_files(int count, const char *const *words)
{
    plot *p = calloc(1, sizeof *p);
    if (!p) {
        complain("se3d plot: out of memory\n");
        return EXIT_FAILED;
    }
    int code = read_words(p, count, words);
    if (code == EXIT_DONE && p->help) {
        options_print_of(&plot_entry, p->help == OPTIONS_VERSION);
    } else if (code == EXIT_DONE) {
        p->quiet = p->quiet || outcome_wants_json();
        code = run_models(p);
        if (code == EXIT_DONE && !p->done) {
            code = plot_all(p);
        }
        for (size_t k = 0; k < p->file_count; ++k) {
            table_destroy(&p->tables[k]);
        }
    }
    free(p);
    return code;
}

static int command_plot(int count, char *const *words)
{
    interrupt_begin();
    return plot_files(count, (const char *const *)words);
}

const command_entry plot_entry = {
    .name = "plot",
    .run = command_plot,
    .operands = "FILE.csv|MODEL...",
    .files = "csv yaml yml json",
    .summary = "draw results as SVG, PNG and PDF",
    .text = "Draws results as FILE.svg, FILE.png and FILE.pdf, beside the first CSV file; "
            "the gnuplot script is kept as FILE.gp. Curves of one quantity share a frame; "
            "several files are compared in it. A channel is a column (pin.force.z), all "
            "components of one (pin.force) or all of an element (pin). A model is run "
            "first, into results/<model>. Transfer functions (modes_transfer.csv) are drawn as "
            "Bode plots: gain and phase. Without options, the plots that its `output` "
            "asks for are drawn.",
    .options =
        (const command_option[]){
            {"-x", NULL, "CHANNEL", "horizontal axis (default time); a channel makes a phase plot"},
            {"-y", NULL, "CHANNEL",
             "what to draw; may be repeated (default: position, velocity, acceleration and the "
             "reactions)"},
            {"-o", NULL, "FILE", "name of the picture; .svg, .png or .pdf is replaced by each"},
            {"--fft", NULL, NULL, "amplitude over frequency; the spectrum is kept as FILE.fft.csv"},
            {"--difference", NULL, NULL,
             "of two runs: the second less the first, at the same times; kept as "
             "FILE.difference.csv"},
            {"--style", NULL, "STYLE", "screen (default), or paper: small letters, thin lines"},
            {"--width", NULL, "WIDTH", "of the picture, 30mm to 1000mm (of paper: 85mm)"},
            {0}},
    .examples =
        (const command_example[]){
            {"plot results/pendulum/pendulum.csv -y pin.force", "the reaction over time"},
            {"plot a.csv -y pin.force --style paper --width 85mm", "a figure of a paper"},
            {"plot results/m/modes_transfer.csv", "a Bode plot"},
            {"plot results/bump/bump.csv -x hub.travel -y hub.toe -y hub.camber",
             "kinematics of a suspension over the travel of its wheel"},
            {"plot a.csv b.csv -y bar.position.z -o compared", "two runs in one frame"},
            {"plot a.csv b.csv --difference -o apart", "how far they are apart"},
            {0}},
    .exits = "0 done; 1 a file or program failed; 2 bad usage.",
};
