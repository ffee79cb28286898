/* SPDX-License-Identifier: BSD-3-Clause */
/* A locale that writes a comma for the decimal point: one that is installed, or one that is made in
 * the folder of the test. Needs _POSIX_C_SOURCE. */
#ifndef SE3D_TESTS_SUPPORT_COMMA_LOCALE_H
#define SE3D_TESTS_SUPPORT_COMMA_LOCALE_H

#include <locale.h>

#include "check.h"

/* Set it for `category`. @return whether there is one */
static inline int comma_locale_set(int category)
{
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"};
    char command[1000];
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
        if (setlocale(category, names[k]) && *localeconv()->decimal_point == ',') {
            return 1;
        }
    }
    snprintf(command, sizeof command,
             "localedef -i de_DE -f UTF-8 '%s/de_DE.UTF-8' >'%s/localedef.txt' 2>&1",
             check_scratch(), check_scratch());
    return system(command) >= 0 && setenv("LOCPATH", check_scratch(), 1) == 0 &&
           setlocale(category, names[0]) && *localeconv()->decimal_point == ',';
}

#endif
