/* SPDX-License-Identifier: BSD-3-Clause */
#if !defined(_WIN32)
#define _XOPEN_SOURCE 700
#endif

#include "interrupt.h"

#include <signal.h>
#include <string.h>

static volatile sig_atomic_t came;
static volatile sig_atomic_t held;

static void note(int number)
{
    came = 1;
    if (!held && (number == SIGINT || number == SIGTERM)) {
        signal(number, SIG_DFL); /* the second one ends the program */
    }
}

#if defined(_WIN32)
void interrupt_begin(void)
{
    signal(SIGINT, note);
    signal(SIGTERM, note);
}
#else
/* The end of a terminal may be told twice, by the system and by the shell; who has asked to survive
 * it (nohup) does. */
void interrupt_begin(void)
{
    struct sigaction action;
    struct sigaction before;
    memset(&action, 0, sizeof action);
    sigemptyset(&action.sa_mask);
    action.sa_handler = note;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    if (sigaction(SIGHUP, NULL, &before) == 0 && before.sa_handler != SIG_IGN) {
        sigaction(SIGHUP, &action, NULL);
    }
    action.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &action, NULL);
}
#endif

void interrupt_hold(void)
{
    held = 1;
}

int interrupt_came(void)
{
    return came;
}
