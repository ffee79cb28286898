/* SPDX-License-Identifier: BSD-3-Clause */
/* FMI 2.0 behind the table of unit.h. */
#include <dlfcn.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2.h"
#include "unit.h"

int told_errors;
char told_last[2000];
void (*told_meddle)(void);
int unit_exchanges;

void told_clear(void)
{
    told_errors = 0;
    told_last[0] = '\0';
}

#define POINTER(name, parameters) static fmi2##name##TYPE *p_##name;
FMI2_STATUS_FUNCTIONS(POINTER)
static fmi2InstantiateTYPE *p_Instantiate;
static fmi2FreeInstanceTYPE *p_FreeInstance;

#if defined(__GNUC__)
__attribute__((__format__(__printf__, 5, 6)))
#endif
static void
hear(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
     fmi2String message, ...)
{
    va_list arguments;
    (void)environment;
    if (status < fmi2Error || strcmp(category, "logStatusError") != 0 || !name) {
        return;
    }
    va_start(arguments, message);
    vsnprintf(told_last, sizeof told_last, message, arguments);
    va_end(arguments);
    ++told_errors;
    if (told_meddle) {
        told_meddle();
    }
}

static void *instantiate(const char *name, const char *token, const char *folder, int logging)
{
    static const fmi2CallbackFunctions callbacks = {hear, calloc, free, NULL, NULL};
    char uri[3000];
    snprintf(uri, sizeof uri, "file://%s", folder ? folder : "");
    return p_Instantiate(name, unit_exchanges ? fmi2ModelExchange : fmi2CoSimulation, token,
                         folder ? uri : NULL, &callbacks, 0, logging);
}

static int setup(void *c, int has_tolerance, double tolerance, double start, int has_stop,
                 double stop)
{
    return (int)p_SetupExperiment(c, has_tolerance, tolerance, start, has_stop, stop);
}

static int enter(void *c)
{
    return (int)p_EnterInitializationMode(c);
}

static int get(void *c, const uint32_t *vr, size_t count, double *values)
{
    return (int)p_GetReal(c, vr, count, values);
}

static int set(void *c, const uint32_t *vr, size_t count, const double *values)
{
    return (int)p_SetReal(c, vr, count, values);
}

static int step(void *c, double time, double h, double *reached, int *ended)
{
    const fmi2Status status = p_DoStep(c, time, h, fmi2True);
    *reached = time + h;
    *ended = 0;
    if (status == fmi2Discard) {
        p_GetRealStatus(c, fmi2LastSuccessfulTime, reached);
        p_GetBooleanStatus(c, fmi2Terminated, ended);
    }
    return (int)status;
}

static int get_state(void *c, void **state)
{
    return (int)p_GetFMUstate(c, state);
}

static int set_state(void *c, void *state)
{
    return (int)p_SetFMUstate(c, state);
}

static int free_state(void *c, void **state)
{
    return (int)p_FreeFMUstate(c, state);
}

static int state_size(void *c, void *state, size_t *size)
{
    return (int)p_SerializedFMUstateSize(c, state, size);
}

static int write_state(void *c, void *state, unsigned char *bytes, size_t size)
{
    return (int)p_SerializeFMUstate(c, state, (fmi2Byte *)bytes, size);
}

static int read_state(void *c, const unsigned char *bytes, size_t size, void **state)
{
    return (int)p_DeSerializeFMUstate(c, (const fmi2Byte *)bytes, size, state);
}

static int other_type(void *c, size_t count)
{
    const fmi2ValueReference vr = 0;
    fmi2Integer value = 0;
    return (int)p_GetInteger(c, &vr, count, &value);
}

static int directional(void *c, const uint32_t *unknowns, size_t unknown_count,
                       const uint32_t *knowns, size_t known_count, const double *seed, double *out)
{
    return (int)p_GetDirectionalDerivative(c, unknowns, unknown_count, knowns, known_count, seed,
                                           out);
}

static int update(void *c, int *ends, int *moved, int *more)
{
    fmi2EventInfo info = {0};
    const fmi2Status status = p_NewDiscreteStates(c, &info);
    *ends = info.terminateSimulation;
    *moved = info.valuesOfContinuousStatesChanged;
    *more = info.newDiscreteStatesNeeded;
    return (int)status;
}

static int complete(void *c, int *event, int *ends)
{
    return (int)p_CompletedIntegratorStep(c, fmi2True, event, ends);
}

static int get_derivatives(void *c, double *dx, size_t count)
{
    return (int)p_GetDerivatives(c, dx, count);
}

static int logging(void *c, const char *category)
{
    return (int)p_SetDebugLogging(c, fmi2True, 1, &category);
}

#include "functions_both.inc"

int functions_load_2(functions *f, const char *object)
{
    int missing = 0;
    const char *(*version)(void) = NULL;
    if (fill(f, object) < 0) {
        return -1;
    }
#define LOAD_NAMED(name, parameters) LOAD(p_##name, "fmi2" #name);
    FMI2_STATUS_FUNCTIONS(LOAD_NAMED)
    LOAD(p_Instantiate, "fmi2Instantiate");
    LOAD(p_FreeInstance, "fmi2FreeInstance");
    LOAD(version, "fmi2GetTypesPlatform");
    missing += !version || strcmp(version(), "default") != 0;
    LOAD(version, "fmi2GetVersion");
    return missing + (!version || strcmp(version(), "2.0") != 0);
}
