/* SPDX-License-Identifier: BSD-3-Clause */
/* FMI 3.0 behind the table of unit.h. */
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

#include "fmi3.h"
#include "unit.h"

#define POINTER(name, parameters) static fmi3##name##TYPE *p_##name;
FMI3_STATUS_FUNCTIONS(POINTER)
FMI3_MISSING_FUNCTIONS(POINTER)
static fmi3GetFloat64TYPE *p_GetFloat64;
static fmi3SetFloat64TYPE *p_SetFloat64;
static fmi3GetInt32TYPE *p_GetInt32;
static fmi3InstantiateCoSimulationTYPE *p_Instantiate;
static fmi3InstantiateModelExchangeTYPE *p_InstantiateModelExchange;
static fmi3FreeInstanceTYPE *p_FreeInstance;

/* What was set up, which this version hands over when the initialization begins. */
static struct {
    int has_tolerance, has_stop;
    double tolerance, start, stop;
} experiment;

static void hear(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
                 fmi3String message)
{
    (void)environment;
    if (status >= fmi3Error && strcmp(category, "logStatusError") == 0) {
        snprintf(told_last, sizeof told_last, "%s", message);
        ++told_errors;
        if (told_meddle) {
            told_meddle();
        }
    }
}

static void *instantiate(const char *name, const char *token, const char *folder, int logging)
{
    char path[3000];
    snprintf(path, sizeof path, "%s/", folder ? folder : "");
    memset(&experiment, 0, sizeof experiment);
    if (unit_exchanges) {
        return p_InstantiateModelExchange(name, token, folder ? path : NULL, false, logging != 0,
                                          NULL, hear);
    }
    return p_Instantiate(name, token, folder ? path : NULL, false, logging != 0, false, false, NULL,
                         0, NULL, hear, NULL);
}

static int enter(void *c)
{
    return (int)p_EnterInitializationMode(c, experiment.has_tolerance != 0, experiment.tolerance,
                                          experiment.start, experiment.has_stop != 0,
                                          experiment.stop);
}

/* What is wrong is refused when it is handed over. */
static int setup(void *c, int has_tolerance, double tolerance, double start, int has_stop,
                 double stop)
{
    int status = GOOD;
    const int wrong = !(start - start == 0.0) || (has_stop && !(stop >= start)) ||
                      (has_tolerance && !(tolerance > 0.0));
    experiment.has_tolerance = has_tolerance;
    experiment.has_stop = has_stop;
    experiment.tolerance = tolerance;
    experiment.start = start;
    experiment.stop = stop;
    if (wrong || !c) {
        status = enter(c);
        memset(&experiment, 0, sizeof experiment);
    }
    return status;
}

static int get(void *c, const uint32_t *vr, size_t count, double *values)
{
    return (int)p_GetFloat64(c, vr, count, values, count);
}

static int set(void *c, const uint32_t *vr, size_t count, const double *values)
{
    return (int)p_SetFloat64(c, vr, count, values, count);
}

static int step(void *c, double time, double h, double *reached, int *ended)
{
    bool event = true;
    bool end = false;
    bool early = false;
    const int status = (int)p_DoStep(c, time, h, true, &event, &end, &early, reached);
    *ended = end;
    return status == fmi3OK && (event || (early && !end)) ? BAD : status;
}

static int get_state(void *c, void **state)
{
    return (int)p_GetFMUState(c, state);
}

static int set_state(void *c, void *state)
{
    return (int)p_SetFMUState(c, state);
}

static int free_state(void *c, void **state)
{
    return (int)p_FreeFMUState(c, state);
}

static int state_size(void *c, void *state, size_t *size)
{
    return (int)p_SerializedFMUStateSize(c, state, size);
}

static int write_state(void *c, void *state, unsigned char *bytes, size_t size)
{
    return (int)p_SerializeFMUState(c, state, bytes, size);
}

static int read_state(void *c, const unsigned char *bytes, size_t size, void **state)
{
    return (int)p_DeserializeFMUState(c, bytes, size, state);
}

static int other_type(void *c, size_t count)
{
    const fmi3ValueReference vr = 0;
    fmi3Int32 value = 0;
    return (int)p_GetInt32(c, &vr, count, &value, count);
}

static int directional(void *c, const uint32_t *unknowns, size_t unknown_count,
                       const uint32_t *knowns, size_t known_count, const double *seed, double *out)
{
    return (int)p_GetDirectionalDerivative(c, unknowns, unknown_count, knowns, known_count, seed,
                                           known_count, out, unknown_count);
}

static int update(void *c, int *ends, int *moved, int *more)
{
    bool answers[5] = {false, false, false, false, false};
    double time = 0.0;
    const fmi3Status status = p_UpdateDiscreteStates(c, &answers[0], &answers[1], &answers[2],
                                                     &answers[3], &answers[4], &time);
    *more = answers[0];
    *ends = answers[1];
    *moved = answers[3];
    return (int)status;
}

static int complete(void *c, int *event, int *ends)
{
    bool asks = false;
    bool ended = false;
    const fmi3Status status = p_CompletedIntegratorStep(c, true, &asks, &ended);
    *event = asks;
    *ends = ended;
    return (int)status;
}

static int get_derivatives(void *c, double *dx, size_t count)
{
    return (int)p_GetContinuousStateDerivatives(c, dx, count);
}

static int logging(void *c, const char *category)
{
    return (int)p_SetDebugLogging(c, true, 1, &category);
}

#include "functions_both.inc"

int functions_load_3(functions *f, const char *object)
{
    int missing = 0;
    const char *(*version)(void) = NULL;
    if (fill(f, object) < 0) {
        return -1;
    }
#define LOAD_NAMED(name, parameters) LOAD(p_##name, "fmi3" #name);
    FMI3_STATUS_FUNCTIONS(LOAD_NAMED)
    FMI3_MISSING_FUNCTIONS(LOAD_NAMED)
#define LOAD_TYPE(name, type)                                                                      \
    LOAD(version, "fmi3Get" #name);                                                                \
    LOAD(version, "fmi3Set" #name);
    FMI3_TYPES(LOAD_TYPE)
    LOAD(version, "fmi3GetBinary");
    LOAD(version, "fmi3SetBinary");
    LOAD(version, "fmi3GetClock");
    LOAD(version, "fmi3SetClock");
    LOAD(version, "fmi3InstantiateScheduledExecution");
    LOAD(p_GetFloat64, "fmi3GetFloat64");
    LOAD(p_SetFloat64, "fmi3SetFloat64");
    LOAD(p_GetInt32, "fmi3GetInt32");
    LOAD(p_Instantiate, "fmi3InstantiateCoSimulation");
    LOAD(p_InstantiateModelExchange, "fmi3InstantiateModelExchange");
    LOAD(p_FreeInstance, "fmi3FreeInstance");
    LOAD(version, "fmi3GetVersion");
    return missing + (!version || strcmp(version(), "3.0") != 0);
}
