/* SPDX-License-Identifier: BSD-3-Clause */
/* The `se3d` program: which command is meant. */
#include <stdio.h>
#include <string.h>

#include "options.h"

static const char help[] =
    "se3d COMMAND ...: constrained rigid multibody dynamics in three dimensions\n"
    "\n"
    "  se3d run MODEL        run a model's analyses, write results as CSV\n"
    "  se3d check MODEL      count equations and freedoms, name redundant constraints\n"
    "  se3d evaluate MODEL   print Phi, nu, gamma and the Jacobian of every constraint\n"
    "  se3d plot FILE.csv    draw results as SVG and PNG\n"
    "  se3d view DIR         make one HTML file that shows results in 3-D\n"
    "  se3d video DIR        make an MP4 film of results in 3-D\n"
    "  se3d --version        print the version\n"
    "\n"
    "`se3d COMMAND --help` says more. The model file: docs/model-file/reference.md.\n"
    "Exit code: 0 done; 1 the analysis failed; 2 bad usage or bad model.\n";

typedef struct command {
    const char *name;
    int (*run)(int count, char *const *words);
} command;

static const command commands[] = {{"run", command_run},           {"check", command_check},
                                   {"evaluate", command_evaluate}, {"plot", command_plot},
                                   {"view", command_view},         {"video", command_video}};

static int dispatch(int count, char *const *words)
{
    const char *name = words[0];
    for (size_t k = 0; k < sizeof commands / sizeof *commands; ++k) {
        if (strcmp(commands[k].name, name) == 0) {
            return commands[k].run(count - 1, words + 1);
        }
    }
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || strcmp(name, "help") == 0) {
        fputs(help, stdout);
        return EXIT_DONE;
    }
    if (strcmp(name, "--version") == 0) {
        printf("se3d %s\n", se3d_version_get_text());
        return EXIT_DONE;
    }
    fprintf(stderr, "se3d: unknown command `%s`; there are:", name);
    for (size_t k = 0; k < sizeof commands / sizeof *commands; ++k) {
        fprintf(stderr, "%s %s", k > 0 ? "," : "", commands[k].name);
    }
    fputs("; see `se3d --help`\n", stderr);
    return EXIT_USAGE;
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        fputs(help, stderr);
        return EXIT_USAGE;
    }
    const int code = dispatch(argc - 1, argv + 1);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fputs("se3d: standard output cannot be written\n", stderr);
        return EXIT_FAILED;
    }
    return code;
}
