/* SPDX-License-Identifier: BSD-3-Clause */
#include "interrupt.h"

#include <signal.h>

static volatile sig_atomic_t came;

static void note(int number)
{
    came = 1;
    signal(number, SIG_DFL); /* the second one ends the program */
}

void interrupt_begin(void)
{
    signal(SIGINT, note);
    signal(SIGTERM, note);
#if defined(SIGPIPE)
    signal(SIGPIPE, SIG_IGN);
#endif
}

int interrupt_came(void)
{
    return came;
}
