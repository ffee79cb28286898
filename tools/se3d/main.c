/* SPDX-License-Identifier: BSD-3-Clause */
/* The `se3d` program: which command is meant. */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200809L
#include <fcntl.h>
#include <signal.h>
#endif
#include <stdio.h>
#include <string.h>

#include "io/document/guess.h"
#include "options.h"
#include "outcome.h"
#include "process.h"

int command_report_unknown(const char *name)
{
    se3di_guess guess = se3di_guess_begin(name);
    complain("se3d: unknown command `%s`; there are:", name);
    for (size_t k = 0; command_get(k); ++k) {
        se3di_guess_offer(&guess, command_get(k)->name);
        complain("%s %s", k > 0 ? "," : "", command_get(k)->name);
    }
    const char *best = se3di_guess_get(&guess);
    if (best) {
        complain("; did you mean `%s`?\n", best);
    } else {
        complain("; see `se3d help`\n");
    }
    return EXIT_USAGE;
}

/* A mistake in the words may stand before the one that asks for JSON. */
static int end(const char *command, int code, int count, char *const *words)
{
    for (int k = 0; code == EXIT_USAGE && k < count && strcmp(words[k], "--") != 0; ++k) {
        if (strcmp(words[k], "--json") == 0 || strcmp(words[k], "--json-lines") == 0) {
            outcome_want_json();
        }
    }
    outcome_end(command, code);
    return code;
}

static int run_command(int count, char **words)
{
    const command_entry *c = command_find(words[0]);
    const int code = c ? c->run(count - 1, words + 1) : command_report_unknown(words[0]);
    return end(words[0], code, count, words);
}

/* Options that all commands have may stand before the command: they go behind its name. */
static int dispatch(int count, char **words)
{
    int first = 0;
    while (first < count && command_find_common(words[first])) {
        ++first;
    }
    if (first == count || words[first][0] == '-') {
        const char *word = words[first == count ? 0 : first];
        if (first == count && (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0)) {
            command_print_overview(stdout);
            return EXIT_DONE;
        }
        if (first == count && (strcmp(word, "--version") == 0 || strcmp(word, "-V") == 0)) {
            printf("se3d %s\n", se3d_version_get_text());
            return EXIT_DONE;
        }
        if (first < count) {
            return end(word, command_report_unknown(word), count, words);
        }
        complain("se3d: which command? See `se3d help`\n");
        return end("", EXIT_USAGE, count, words);
    }
    char *name = words[first];
    memmove(words + 1, words, (size_t)first * sizeof *words);
    words[0] = name;
    return run_command(count, words);
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

/* A file that is larger than a limit is an error of the write, which takes the unfinished file away
 * and is told, for every command. */
static void survive_limits(void)
{
#if !defined(_WIN32)
    signal(SIGXFSZ, SIG_IGN);
#endif
}

int main(int argc, char **argv)
{
    hold_closed_streams();
    survive_limits();
    if (argc > 0) {
        process_set_own_name(argv[0]);
    }
    if (argc < 2) {
        command_print_overview(stderr);
        return EXIT_USAGE;
    }
    const int code = dispatch(argc - 1, argv + 1);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        complain("se3d: standard output cannot be written\n");
        return EXIT_FAILED;
    }
    return code;
}
