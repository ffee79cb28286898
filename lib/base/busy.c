/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/busy.h"

#include <errno.h>
#include <stddef.h>

void se3di_busy_init(se3di_busy *busy)
{
    atomic_init(&busy->level, SE3DI_BUSY_FREE);
    atomic_init(&busy->reading, 0);
    for (int k = 0; k < SE3DI_BUSY_READERS; ++k) {
        atomic_init(&busy->readers[k], 0);
    }
    atomic_flag_clear(&busy->messaging);
}

int32_t se3di_busy_raise(se3di_busy *busy, se3di_busy_level level)
{
    return busy ? atomic_exchange(&busy->level, (int)level) : SE3DI_BUSY_FREE;
}

void se3di_busy_restore(se3di_busy *busy, int32_t level)
{
    if (busy) {
        atomic_store(&busy->level, level);
    }
}

int se3di_busy_allows(se3di_busy *busy, se3di_busy_level most)
{
    return !busy || (atomic_load(&busy->level) <= (int)most && atomic_load(&busy->reading) == 0);
}

/* Different for every thread that lives: errno is each thread's own. */
static uintptr_t this_thread(void)
{
    return (uintptr_t)(void *)&errno;
}

static int is_listed(se3di_busy *busy, uintptr_t thread)
{
    int listed = 0;
    for (int k = 0; k < SE3DI_BUSY_READERS && atomic_load(&busy->reading) != 0; ++k) {
        listed |= atomic_load(&busy->readers[k]) == thread;
    }
    return listed;
}

int se3di_busy_read(se3di_busy *busy, se3di_reading *reading)
{
    const uintptr_t thread = this_thread();
    *reading = (se3di_reading){busy, NULL, {0, 0}};
    if (busy && (atomic_load(&busy->level) >= (int)SE3DI_BUSY_CALL || is_listed(busy, thread))) {
        return 0;
    }
    reading->host = se3di_floats_set();
    for (int k = 0; busy && k < SE3DI_BUSY_READERS && !reading->place; ++k) {
        uintptr_t none = 0;
        if (atomic_compare_exchange_strong(&busy->readers[k], &none, thread)) {
            reading->place = &busy->readers[k];
            atomic_fetch_add(&busy->reading, 1);
        }
    }
    return 1;
}

void se3di_busy_unread(se3di_reading *reading)
{
    se3di_floats_restore(reading->host);
    if (reading->place) {
        atomic_fetch_sub(&reading->busy->reading, 1);
        atomic_store(reading->place, 0);
    }
}
