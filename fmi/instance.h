/* SPDX-License-Identifier: BSD-3-Clause */
/* What both versions of the standard have in common: instances, states, paths. */
#ifndef SE3D_FMI_INSTANCE_H
#define SE3D_FMI_INSTANCE_H

#include <stdbool.h>

#include "io/fmi/unit.h"

/* Statuses have the same numbers in both: OK, Warning, Discard, Error, Fatal. */
enum { FMI_OK = 0, FMI_WARNING = 1, FMI_DISCARD = 2, FMI_ERROR = 3 };
enum { FMI_MESSAGE_SIZE = 2000 };

typedef struct fmi_instance fmi_instance;
typedef void (*fmi_say)(const fmi_instance *instance, int status, const char *category,
                        const char *message);

struct fmi_instance {
    se3di_fmi_unit *unit;
    fmi_say say; /* hands on to the caller */
    void *callback;
    void *environment;
    char *name;
    bool logs_events; /* these are told; errors always are */
    bool logs_warnings;
    bool is_telling; /* the caller is told something: from there no call is let in */
};

/* A state of a unit as bytes. */
typedef struct fmi_state {
    size_t size;
    unsigned char *bytes;
} fmi_state;

/* `callback` and `environment` stay with the caller. `folder`: of the resources, or a URI of it.
 * `exchanges`: the caller integrates.
 * @return NULL: `say` was told why */
fmi_instance *fmi_create(const fmi_instance *model, const char *name, const char *token,
                         const char *folder, bool exchanges);
/* The status of what the unit has done. */
int fmi_done(const fmi_instance *instance, bool good);
/* From within `say` nothing is destroyed. */
void fmi_destroy(fmi_instance *instance);
/* Say why a call is refused. @return FMI_ERROR */
int fmi_refuse(fmi_instance *instance, const char *call, const char *why);
/* Switch categories on or off, all if there are none. @return a status */
int fmi_set_logging(fmi_instance *instance, bool on, size_t count, const char *const *categories);

int fmi_get(fmi_instance *instance, const uint32_t *references, size_t count, double *values,
            size_t value_count);
int fmi_set(fmi_instance *instance, const uint32_t *references, size_t count, const double *values,
            size_t value_count);
/* Of another type than the variables have: fine for none of them. */
int fmi_refuse_type(fmi_instance *instance, size_t count, const char *type);

/* What is asked of a directional derivative. */
typedef struct fmi_direction {
    const uint32_t *unknowns, *knowns;
    size_t unknown_count, known_count, seed_count, out_count;
    const double *seed;
    double *out;
} fmi_direction;

int fmi_derive(fmi_instance *instance, const fmi_direction *d);

/* A state is a pointer to an fmi_state, which the caller has as void *. One that *state has is used
 * again. */
int fmi_get_state(fmi_instance *instance, void **state);
int fmi_set_state(fmi_instance *instance, const void *state);
/* *state becomes NULL; no place: nothing. @return FMI_OK */
int fmi_free_state(void **state);
int fmi_get_state_size(fmi_instance *instance, const void *state, size_t *size);
int fmi_write_state(fmi_instance *instance, const void *state, void *bytes, size_t size);
int fmi_read_state(fmi_instance *instance, const void *bytes, size_t size, void **state);

/* The functions of model exchange that both versions have with the same parameters: X(name,
 * parameters, what the unit does), in which `i` is the instance of `c`. */
#define FMI_COMMON_LIST(X)                                                                         \
    X(EnterEventMode, (void *c), se3di_fmi_unit_enter_event(i->unit))                              \
    X(EnterContinuousTimeMode, (void *c), se3di_fmi_unit_enter_continuous(i->unit))                \
    X(SetTime, (void *c, double time), se3di_fmi_unit_set_time(i->unit, time))                     \
    X(SetContinuousStates, (void *c, const double x[], size_t count),                              \
      se3di_fmi_unit_set_states(i->unit, x, count))                                                \
    X(GetContinuousStates, (void *c, double x[], size_t count),                                    \
      se3di_fmi_unit_get_states(i->unit, x, count))                                                \
    X(GetNominalsOfContinuousStates, (void *c, double x[], size_t count),                          \
      se3di_fmi_unit_get_nominals(i->unit, x, count))                                              \
    X(GetEventIndicators, (void *c, double values[], size_t count),                                \
      se3di_fmi_unit_get_indicators(i->unit, values, count))

#endif
