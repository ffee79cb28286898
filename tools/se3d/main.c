/* SPDX-License-Identifier: BSD-3-Clause */
/* The `se3d` program: which command is meant. */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200809L
#include <fcntl.h>
#endif
#include <stdio.h>
#include <string.h>

#include "io/document/guess.h"
#include "options.h"

int command_report_unknown(const char *name)
{
    se3di_guess guess = se3di_guess_begin(name);
    fprintf(stderr, "se3d: unknown command `%s`; there are:", name);
    for (size_t k = 0; command_get(k); ++k) {
        se3di_guess_offer(&guess, command_get(k)->name);
        fprintf(stderr, "%s %s", k > 0 ? "," : "", command_get(k)->name);
    }
    const char *best = se3di_guess_get(&guess);
    if (best) {
        fprintf(stderr, "; did you mean `%s`?\n", best);
    } else {
        fputs("; see `se3d help`\n", stderr);
    }
    return EXIT_USAGE;
}

static int dispatch(int count, char *const *words)
{
    const char *name = words[0];
    const command_entry *c = command_find(name);
    if (c) {
        return c->run(count - 1, words + 1);
    }
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) {
        command_print_overview(stdout);
        return EXIT_DONE;
    }
    if (strcmp(name, "--version") == 0 || strcmp(name, "-V") == 0) {
        printf("se3d %s\n", se3d_version_get_text());
        return EXIT_DONE;
    }
    return command_report_unknown(name);
}

/* The next file that is opened would take the number of a closed standard stream, and get its
 * messages. What can be neither read nor written takes it before. */
static void hold_closed_streams(void)
{
#if !defined(_WIN32)
    for (int number = 0; number < 3; ++number) {
        if (fcntl(number, F_GETFD) < 0 &&
            open("/dev/null", number == 0 ? O_WRONLY : O_RDONLY) != number) {
            return;
        }
    }
#endif
}

int main(int argc, char **argv)
{
    hold_closed_streams();
    if (argc < 2) {
        command_print_overview(stderr);
        return EXIT_USAGE;
    }
    const int code = dispatch(argc - 1, argv + 1);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fputs("se3d: standard output cannot be written\n", stderr);
        return EXIT_FAILED;
    }
    return code;
}
