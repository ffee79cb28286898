/* SPDX-License-Identifier: BSD-3-Clause */
/* Who is at work on a system: user code that is called from there must not change what is
 * being worked on, nor begin the same work anew.
 *
 * A call that works for long (a run, an analysis) raises the level; it has the system to itself,
 * also in callbacks of several threads. Readers that evaluate the user's callbacks may run at the
 * same time in several threads: each is on a list with its thread, so that a callback cannot enter
 * one again. */
#ifndef SE3DI_BASE_BUSY_H
#define SE3DI_BASE_BUSY_H

#include "base/floats.h"

#include <stdatomic.h>
#include <stdint.h>

/* What runs, from what allows all to what allows least. */
typedef enum se3di_busy_level {
    SE3DI_BUSY_FREE = 0,  /* nothing */
    SE3DI_BUSY_EVENT = 1, /* the callback of an event: values and the state may be set */
    SE3DI_BUSY_VALUE = 2, /* the value of an event: everything may be read */
    SE3DI_BUSY_CALL = 3   /* anything else: what is stored may be read */
} se3di_busy_level;

#define SE3DI_BUSY_READERS 64 /* threads; those beyond are not watched */

typedef struct se3di_busy {
    atomic_int level;                             /* se3di_busy_level */
    atomic_uint reading;                          /* readers on the list */
    atomic_uintptr_t readers[SE3DI_BUSY_READERS]; /* threads within the user's callbacks; 0: none */
    atomic_flag messaging;                        /* a message is being written */
} se3di_busy;

/* A reader's place on the list. */
typedef struct se3di_reading {
    se3di_busy *busy;
    atomic_uintptr_t *place; /* NULL: not on it */
    se3di_floats host;       /* how its host rounds */
} se3di_reading;

void se3di_busy_init(se3di_busy *busy);
/* Set the level; @return the one before. `busy` may be NULL here and below: never busy. */
int32_t se3di_busy_raise(se3di_busy *busy, se3di_busy_level level);
void se3di_busy_restore(se3di_busy *busy, int32_t level);
/* Whether what is allowed up to `most` may be done now. */
int se3di_busy_allows(se3di_busy *busy, se3di_busy_level most);

/* Before and after a reader evaluates callbacks. @return whether it may */
int se3di_busy_read(se3di_busy *busy, se3di_reading *reading);
void se3di_busy_unread(se3di_reading *reading);

#endif
