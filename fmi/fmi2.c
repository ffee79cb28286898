/* SPDX-License-Identifier: BSD-3-Clause */
/* FMI 2.0. In co-simulation steps are finished when the call returns; inputs stay as they are
 * between communication points. */
#include "fmi2.h"

#include <math.h>

#include "instance.h"

#define INSTANCE(c)                                                                                \
    fmi_instance *i = (c);                                                                         \
    if (!i || i->is_telling) {                                                                     \
        return fmi2Error;                                                                          \
    }

/* The message is a format of printf without arguments, which not all callers look at; in it a #
 * begins the name of a variable. Both marks stand for themselves if they are twice. */
static void say(const fmi_instance *instance, int status, const char *category, const char *message)
{
    const fmi2CallbackFunctions *functions = instance->callback;
    char text[2 * FMI_MESSAGE_SIZE];
    size_t used = 0;
    for (size_t k = 0; message[k] && k < FMI_MESSAGE_SIZE - 1; ++k) {
        text[used++] = message[k];
        if (message[k] == '%' || message[k] == '#') {
            text[used++] = message[k];
        }
    }
    text[used] = '\0';
    if (functions->logger) {
        functions->logger(functions->componentEnvironment, instance->name ? instance->name : "",
                          (fmi2Status)status, category, text);
    }
}

static fmi2Status done(bool good)
{
    return good ? fmi2OK : fmi2Error;
}

const char *fmi2GetTypesPlatform(void)
{
    return "default";
}

const char *fmi2GetVersion(void)
{
    return "2.0";
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                              fmi2Boolean logging)
{
    (void)visible;
    if (!functions) {
        return NULL;
    }
    union {
        const void *constant;
        void *pointer;
    } callback = {.constant = functions};
    fmi_instance model = {.say = say,
                          .callback = callback.pointer,
                          .environment = functions->componentEnvironment,
                          .logs_events = logging != 0,
                          .logs_warnings = logging != 0};
    return fmi_create(&model, name, guid, resources, type == fmi2ModelExchange);
}

void fmi2FreeInstance(fmi2Component c)
{
    fmi_destroy(c);
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count,
                               const fmi2String *names)
{
    INSTANCE(c)
    return (fmi2Status)fmi_set_logging(i, on != 0, count, names);
}

/* ---- life -----------------------------------------------------------------------------------*/

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance,
                               fmi2Real start, fmi2Boolean has_stop, fmi2Real stop)
{
    INSTANCE(c)
    if (isnan(start) || (has_stop && isnan(stop)) || (has_tolerance && isnan(tolerance))) {
        return (fmi2Status)fmi_refuse(i, "fmi2SetupExperiment", "a number is NaN");
    }
    return done(se3di_fmi_unit_begin(i->unit, start, has_stop ? stop : (double)NAN,
                                     has_tolerance ? tolerance : (double)NAN));
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    INSTANCE(c)
    return done(se3di_fmi_unit_enter(i->unit));
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    INSTANCE(c)
    return done(se3di_fmi_unit_start(i->unit));
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    INSTANCE(c)
    return done(se3di_fmi_unit_terminate(i->unit));
}

fmi2Status fmi2Reset(fmi2Component c)
{
    INSTANCE(c)
    return done(se3di_fmi_unit_reset(i->unit));
}

/* ---- variables ------------------------------------------------------------------------------*/

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference *vr, size_t count,
                       fmi2Real *values)
{
    INSTANCE(c)
    return (fmi2Status)fmi_get(i, vr, count, values, count);
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference *vr, size_t count,
                       const fmi2Real *values)
{
    INSTANCE(c)
    return (fmi2Status)fmi_set(i, vr, count, values, count);
}

/* Types that no variable has. */
#define OTHER_TYPE(type, get, set)                                                                 \
    fmi2Status fmi2Get##type(fmi2Component c, const fmi2ValueReference *vr, size_t count,          \
                             get *values)                                                          \
    {                                                                                              \
        INSTANCE(c)                                                                                \
        (void)vr;                                                                                  \
        (void)values;                                                                              \
        return (fmi2Status)fmi_refuse_type(i, count, #type);                                       \
    }                                                                                              \
    fmi2Status fmi2Set##type(fmi2Component c, const fmi2ValueReference *vr, size_t count,          \
                             set *values)                                                          \
    {                                                                                              \
        INSTANCE(c)                                                                                \
        (void)vr;                                                                                  \
        (void)values;                                                                              \
        return (fmi2Status)fmi_refuse_type(i, count, #type);                                       \
    }
OTHER_TYPE(Integer, fmi2Integer, const fmi2Integer)
OTHER_TYPE(Boolean, fmi2Boolean, const fmi2Boolean)
OTHER_TYPE(String, fmi2String, const fmi2String)

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference *unknowns,
                                        size_t unknown_count, const fmi2ValueReference *knowns,
                                        size_t known_count, const fmi2Real *seed,
                                        fmi2Real *sensitivity)
{
    INSTANCE(c)
    const fmi_direction direction = {.unknowns = unknowns,
                                     .knowns = knowns,
                                     .unknown_count = unknown_count,
                                     .known_count = known_count,
                                     .seed_count = known_count,
                                     .out_count = unknown_count,
                                     .seed = seed,
                                     .out = sensitivity};
    return (fmi2Status)fmi_derive(i, &direction);
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference *vr, size_t count,
                                       const fmi2Integer *orders, const fmi2Real *values)
{
    INSTANCE(c)
    (void)vr;
    (void)count;
    (void)orders;
    (void)values;
    return (fmi2Status)fmi_refuse(i, "fmi2SetRealInputDerivatives", "inputs are not interpolated");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference *vr, size_t count,
                                        const fmi2Integer *orders, fmi2Real *values)
{
    INSTANCE(c)
    (void)vr;
    (void)count;
    (void)orders;
    (void)values;
    return (fmi2Status)fmi_refuse(i, "fmi2GetRealOutputDerivatives",
                                  "the unit does not have derivatives of outputs");
}

/* ---- steps ----------------------------------------------------------------------------------*/

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real h, fmi2Boolean no_state_before)
{
    INSTANCE(c)
    (void)no_state_before;
    if (!se3di_fmi_unit_step(i->unit, time, h)) {
        return fmi2Error;
    }
    return se3di_fmi_unit_get_mode(i->unit) == SE3DI_FMI_ENDED ? fmi2Discard : fmi2OK;
}

fmi2Status fmi2CancelStep(fmi2Component c)
{
    INSTANCE(c)
    return (fmi2Status)fmi_refuse(i, "fmi2CancelStep", "no step is under way");
}

/* A question that has no answer here. */
static fmi2Status discard(fmi_instance *i, const void *value)
{
    if (!value) {
        return (fmi2Status)fmi_refuse(i, "fmi2GetStatus", "the place for the answer is NULL");
    }
    return fmi2Discard;
}

#define NO_ANSWER(name, type)                                                                      \
    fmi2Status fmi2Get##name(fmi2Component c, const fmi2StatusKind kind, type *value)              \
    {                                                                                              \
        INSTANCE(c)                                                                                \
        (void)kind;                                                                                \
        return discard(i, value);                                                                  \
    }
NO_ANSWER(Status, fmi2Status)
NO_ANSWER(IntegerStatus, fmi2Integer)
NO_ANSWER(StringStatus, fmi2String)

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    INSTANCE(c)
    if (!value || kind != fmi2LastSuccessfulTime) {
        return discard(i, value);
    }
    *value = se3di_fmi_unit_get_time(i->unit);
    return fmi2OK;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    INSTANCE(c)
    if (!value || kind != fmi2Terminated) {
        return discard(i, value);
    }
    *value = se3di_fmi_unit_get_mode(i->unit) == SE3DI_FMI_ENDED ? fmi2True : fmi2False;
    return fmi2OK;
}

/* ---- model exchange -------------------------------------------------------------------------*/

static fmi2Status exchanged(const fmi_instance *i, bool good)
{
    return (fmi2Status)fmi_done(i, good);
}

#define COMMON(name, parameters, good)                                                             \
    fmi2Status fmi2##name parameters                                                               \
    {                                                                                              \
        INSTANCE(c)                                                                                \
        return exchanged(i, good);                                                                 \
    }
FMI_COMMON_LIST(COMMON)

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info)
{
    INSTANCE(c)
    bool ends = false;
    bool moved = false;
    if (!info) {
        return (fmi2Status)fmi_refuse(i, "fmi2NewDiscreteStates", "the event info is NULL");
    }
    const fmi2Status status = exchanged(i, se3di_fmi_unit_update_event(i->unit, &ends, &moved));
    *info = (fmi2EventInfo){.terminateSimulation = ends, .valuesOfContinuousStatesChanged = moved};
    return status;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean no_state_before,
                                       fmi2Boolean *event, fmi2Boolean *terminate)
{
    INSTANCE(c)
    bool asks = false;
    (void)no_state_before;
    if (!event || !terminate) {
        return (fmi2Status)fmi_refuse(i, "fmi2CompletedIntegratorStep",
                                      "the place for an answer is NULL");
    }
    const fmi2Status status = exchanged(i, se3di_fmi_unit_complete_step(i->unit, &asks));
    *event = asks;
    *terminate = fmi2False;
    return status;
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real dx[], size_t count)
{
    INSTANCE(c)
    return exchanged(i, se3di_fmi_unit_get_derivatives(i->unit, dx, count));
}

/* ---- states ---------------------------------------------------------------------------------*/

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    INSTANCE(c)
    return (fmi2Status)fmi_get_state(i, state);
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state)
{
    INSTANCE(c)
    return (fmi2Status)fmi_set_state(i, state);
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    INSTANCE(c)
    return (fmi2Status)fmi_free_state(state);
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    INSTANCE(c)
    return (fmi2Status)fmi_get_state_size(i, state, size);
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte *bytes, size_t size)
{
    INSTANCE(c)
    return (fmi2Status)fmi_write_state(i, state, bytes, size);
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte *bytes, size_t size,
                                   fmi2FMUstate *state)
{
    INSTANCE(c)
    return (fmi2Status)fmi_read_state(i, bytes, size, state);
}
