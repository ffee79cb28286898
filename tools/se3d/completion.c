/* SPDX-License-Identifier: BSD-3-Clause */
/* `se3d completion SHELL`: the script by which a shell completes command lines of the program. */
#include <string.h>

#include "command.h"
#include "options.h"
#include "outcome.h"

/* "a b c" of the names and aliases of a command's options. */
static void put_options(const command_entry *c)
{
    for (size_t k = 0; command_get_option(c, k); ++k) {
        const command_option *o = command_get_option(c, k);
        printf("%s%s%s%s", k > 0 ? " " : "", o->alias ? o->alias : "", o->alias ? " " : "",
               o->name);
    }
}

static void put_commands(void)
{
    for (size_t k = 0; command_get(k); ++k) {
        printf("%s%s", k > 0 ? " " : "", command_get(k)->name);
    }
}

/* What follows the option --method and its like, or "". */
static void list_values(const command_option *o, char *out, size_t size)
{
    static const struct {
        const char *option;
        const char *names;
    } lists[] = {{"--method", "{methods}"},
                 {"--analysis", "{analyses}, modes"},
                 {"--formulation", "{formulations}"}};
    out[0] = '\0';
    for (size_t k = 0; k < sizeof lists / sizeof *lists; ++k) {
        if (strcmp(o->name, lists[k].option) == 0) {
            command_expand(lists[k].names, out, size);
        }
    }
    for (char *c = out; (c = strchr(c, ',')) != NULL;) {
        memmove(c, c + 1, strlen(c));
    }
}

static void put_bash_values(void)
{
    char values[1000];
    for (const command_option *o = run_entry.options; o->name; ++o) {
        list_values(o, values, sizeof values);
        if (*values) {
            printf("    %s) COMPREPLY=($(compgen -W '%s' -- \"$word\")); return ;;\n", o->name,
                   values);
        }
    }
}

static void put_bash(void)
{
    fputs("# se3d: completion for bash. Load it with: . <(se3d completion bash)\n"
          "_se3d() {\n"
          "    local word=${COMP_WORDS[COMP_CWORD]} last=${COMP_WORDS[COMP_CWORD-1]} ending=\n"
          "    COMPREPLY=()\n"
          "    if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
          "        COMPREPLY=($(compgen -W '",
          stdout);
    put_commands();
    fputs(" --help --version --quiet' -- \"$word\"))\n"
          "        return\n"
          "    fi\n"
          "    case $last in\n",
          stdout);
    put_bash_values();
    fputs("    esac\n"
          "    case ${COMP_WORDS[1]} in\n",
          stdout);
    for (size_t k = 0; command_get(k); ++k) {
        const command_entry *c = command_get(k);
        printf("    %s) options='", c->name);
        put_options(c);
        printf("' ending='%s' ;;\n", c->files);
    }
    fputs("    *) return ;;\n"
          "    esac\n"
          "    case $word in\n"
          "    -*) COMPREPLY=($(compgen -W \"$options\" -- \"$word\")); return ;;\n"
          "    esac\n"
          "    if [ \"${COMP_WORDS[1]}\" = help ]; then\n"
          "        COMPREPLY=($(compgen -W '",
          stdout);
    put_commands();
    fputs("' -- \"$word\"))\n"
          "        return\n"
          "    fi\n"
          "    COMPREPLY=($(compgen -d -- \"$word\"))\n"
          "    for each in $ending; do\n"
          "        COMPREPLY+=($(compgen -f -X \"!*.$each\" -- \"$word\"))\n"
          "    done\n"
          "}\n"
          "complete -o filenames -F _se3d se3d\n",
          stdout);
}

/* A text in single quotes of a shell; `also` is left out of it. */
static void put_quoted(const char *text, const char *also)
{
    char expanded[2000];
    command_expand(text, expanded, sizeof expanded);
    for (const char *c = expanded; *c; ++c) {
        if (*c == '\'') {
            fputs("'\\''", stdout);
        } else {
            putchar(strchr(also, *c) ? ' ' : *c);
        }
    }
}

/* ":VALUE:(a b c)", what zsh offers behind an option, nothing behind a flag. */
static void put_zsh_value(const command_option *o)
{
    char values[1000];
    list_values(o, values, sizeof values);
    if (o->value) {
        printf(":%s:", o->value);
        printf(*values ? "(%s)" : "%s", values);
    }
}

static void put_zsh_command(const command_entry *c)
{
    printf("%s)\n    _arguments", c->name);
    for (size_t k = 0; command_get_option(c, k); ++k) {
        const command_option *o = command_get_option(c, k);
        printf(" \\\n        '*%s[", o->name);
        put_quoted(o->text, "[]:");
        putchar(']');
        put_zsh_value(o);
        putchar('\'');
    }
    if (*c->files) {
        printf(" \\\n        '*:%s:_files -g \"*.(", c->operands);
        for (const char *f = c->files; *f; ++f) {
            putchar(*f == ' ' ? '|' : *f);
        }
        fputs(")(-.)\"'", stdout);
    } else {
        fputs(" \\\n        '*:operand:_files'", stdout);
    }
    puts("\n    ;;");
}

static void put_zsh(void)
{
    puts("#compdef se3d\n"
         "# se3d: completion for zsh. Put it as _se3d into a folder of $fpath.\n"
         "if (( CURRENT == 2 )); then\n"
         "    local -a commands=(");
    for (size_t k = 0; command_get(k); ++k) {
        printf("        '%s:", command_get(k)->name);
        put_quoted(command_get(k)->summary, ":");
        puts("'");
    }
    puts("    )\n"
         "    _describe command commands\n"
         "    return\n"
         "fi\n"
         "shift words\n"
         "(( CURRENT-- ))\n"
         "case $words[1] in");
    for (size_t k = 0; command_get(k); ++k) {
        put_zsh_command(command_get(k));
    }
    puts("esac");
}

static void put_fish_option(const command_entry *c, const command_option *o)
{
    char values[1000];
    printf("complete -c se3d -n '__fish_seen_subcommand_from %s'", c->name);
    const char *names[] = {o->name, o->alias};
    for (size_t k = 0; k < 2; ++k) {
        if (names[k]) {
            const int is_long = strncmp(names[k], "--", 2) == 0;
            printf(" -%c %s", is_long ? 'l' : 's', names[k] + 1 + is_long);
        }
    }
    list_values(o, values, sizeof values);
    fputs(o->value ? " -r" : "", stdout);
    if (*values) {
        printf(" -f -a '%s'", values);
    }
    fputs(" -d '", stdout);
    put_quoted(o->text, "");
    puts("'");
}

static void put_fish(void)
{
    puts("# se3d: completion for fish. Put it as se3d.fish into ~/.config/fish/completions.");
    for (size_t k = 0; command_get(k); ++k) {
        const command_entry *c = command_get(k);
        printf("complete -c se3d -f -n __fish_use_subcommand -a %s -d '", c->name);
        put_quoted(c->summary, "");
        puts("'");
        for (size_t n = 0; command_get_option(c, n); ++n) {
            put_fish_option(c, command_get_option(c, n));
        }
    }
}

static int command_completion(int count, char *const *words)
{
    static const struct {
        const char *name;
        void (*put)(void);
    } shells[] = {{"bash", put_bash}, {"zsh", put_zsh}, {"fish", put_fish}};
    options o;
    const int code = options_read(&o, &completion_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    for (size_t k = 0; k < sizeof shells / sizeof *shells; ++k) {
        if (strcmp(shells[k].name, o.model) == 0) {
            shells[k].put();
            return EXIT_DONE;
        }
    }
    complain("se3d completion: the shell is `%s`, must be bash, zsh or fish\n", o.model);
    return EXIT_USAGE;
}

const command_entry completion_entry = {
    .name = "completion",
    .run = command_completion,
    .operands = "SHELL",
    .files = "",
    .summary = "print the completion script of bash, zsh or fish",
    .text = "Prints the script by which a shell completes the commands, options and files of this "
            "program. An installed program has it already.",
    .only_prints = 1,
    .options = (const command_option[]){{0}},
    .examples = (const command_example[]){{"completion bash >~/.local/share/bash-completion/"
                                           "completions/se3d",
                                           "for bash, from the next shell on"},
                                          {0}},
    .exits = "0 done; 2 another shell.",
};
