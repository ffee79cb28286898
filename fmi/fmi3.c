/* SPDX-License-Identifier: BSD-3-Clause */
/* FMI 3.0. Co-simulation is without event mode: steps are finished when the call returns, and end
 * early only where an event of the model ends it. */
#include "fmi3.h"

#include <math.h>
#include <string.h>

#include "instance.h"

#define INSTANCE(c)                                                                                \
    fmi_instance *i = (c);                                                                         \
    if (!i || i->is_telling) {                                                                     \
        return fmi3Error;                                                                          \
    }

static void say(const fmi_instance *instance, int status, const char *category, const char *message)
{
    fmi3LogMessageCallback log = NULL;
    memcpy(&log, &instance->callback, sizeof log);
    if (log) {
        log(instance->environment, (fmi3Status)status, category, message);
    }
}

static fmi3Status done(bool good)
{
    return good ? fmi3OK : fmi3Error;
}

const char *fmi3GetVersion(void)
{
    return "3.0";
}

/* Who hears what the unit says. */
static fmi_instance model_of(fmi3LogMessageCallback log, fmi3InstanceEnvironment environment,
                             bool logging)
{
    fmi_instance model = {
        .say = say, .environment = environment, .logs_events = logging, .logs_warnings = logging};
    memcpy(&model.callback, &log, sizeof log);
    return model;
}

fmi3Instance
fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
                            fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean event_mode,
                            fmi3Boolean early_return, const fmi3ValueReference intermediate[],
                            size_t intermediate_count, fmi3InstanceEnvironment environment,
                            fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update)
{
    fmi_instance model = model_of(log, environment, logging);
    (void)visible;
    (void)early_return;
    (void)intermediate;
    (void)update;
    if (event_mode) {
        fmi_refuse(&model, "fmi3InstantiateCoSimulation", "the unit has no event mode");
        return NULL;
    }
    if (intermediate_count > 0) {
        fmi_refuse(&model, "fmi3InstantiateCoSimulation", "the unit has no intermediate variables");
        return NULL;
    }
    return fmi_create(&model, name, token, resources, false);
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                          fmi3Boolean visible, fmi3Boolean logging,
                                          fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback log)
{
    fmi_instance model = model_of(log, environment, logging);
    (void)visible;
    return fmi_create(&model, name, token, resources, true);
}

fmi3Instance
fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                  fmi3Boolean visible, fmi3Boolean logging,
                                  fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                  fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
                                  fmi3UnlockPreemptionCallback unlock)
{
    fmi_instance model = model_of(log, environment, logging);
    (void)name;
    (void)token;
    (void)resources;
    (void)visible;
    (void)update;
    (void)lock;
    (void)unlock;
    fmi_refuse(&model, "fmi3InstantiateScheduledExecution",
               "the unit is for co-simulation and model exchange only");
    return NULL;
}

void fmi3FreeInstance(fmi3Instance c)
{
    fmi_destroy(c);
}

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t count,
                               const fmi3String names[])
{
    INSTANCE(c)
    return (fmi3Status)fmi_set_logging(i, on, count, names);
}

/* ---- life -----------------------------------------------------------------------------------*/

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean has_tolerance,
                                       fmi3Float64 tolerance, fmi3Float64 start,
                                       fmi3Boolean has_stop, fmi3Float64 stop)
{
    INSTANCE(c)
    if (isnan(start) || (has_stop && isnan(stop)) || (has_tolerance && isnan(tolerance))) {
        return (fmi3Status)fmi_refuse(i, "fmi3EnterInitializationMode", "a number is NaN");
    }
    return done(se3di_fmi_unit_begin(i->unit, start, has_stop ? stop : (double)NAN,
                                     has_tolerance ? tolerance : (double)NAN) &&
                se3di_fmi_unit_enter(i->unit));
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    INSTANCE(c)
    return done(se3di_fmi_unit_start(i->unit));
}

fmi3Status fmi3Terminate(fmi3Instance c)
{
    INSTANCE(c)
    return done(se3di_fmi_unit_terminate(i->unit));
}

fmi3Status fmi3Reset(fmi3Instance c)
{
    INSTANCE(c)
    return done(se3di_fmi_unit_reset(i->unit));
}

/* ---- variables ------------------------------------------------------------------------------*/

fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference vr[], size_t count,
                          fmi3Float64 values[], size_t value_count)
{
    INSTANCE(c)
    return (fmi3Status)fmi_get(i, vr, count, values, value_count);
}

fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference vr[], size_t count,
                          const fmi3Float64 values[], size_t value_count)
{
    INSTANCE(c)
    return (fmi3Status)fmi_set(i, vr, count, values, value_count);
}

/* Types that no variable has. */
#define OTHER_TYPE(name, type)                                                                     \
    fmi3Status fmi3Get##name(fmi3Instance c, const fmi3ValueReference vr[], size_t count,          \
                             type values[], size_t value_count)                                    \
    {                                                                                              \
        INSTANCE(c)                                                                                \
        (void)vr;                                                                                  \
        (void)values;                                                                              \
        (void)value_count;                                                                         \
        return (fmi3Status)fmi_refuse_type(i, count, #name);                                       \
    }                                                                                              \
    fmi3Status fmi3Set##name(fmi3Instance c, const fmi3ValueReference vr[], size_t count,          \
                             const type values[], size_t value_count)                              \
    {                                                                                              \
        INSTANCE(c)                                                                                \
        (void)vr;                                                                                  \
        (void)values;                                                                              \
        (void)value_count;                                                                         \
        return (fmi3Status)fmi_refuse_type(i, count, #name);                                       \
    }
OTHER_TYPE(Float32, fmi3Float32)
OTHER_TYPE(Int8, fmi3Int8)
OTHER_TYPE(UInt8, fmi3UInt8)
OTHER_TYPE(Int16, fmi3Int16)
OTHER_TYPE(UInt16, fmi3UInt16)
OTHER_TYPE(Int32, fmi3Int32)
OTHER_TYPE(UInt32, fmi3UInt32)
OTHER_TYPE(Int64, fmi3Int64)
OTHER_TYPE(UInt64, fmi3UInt64)
OTHER_TYPE(Boolean, fmi3Boolean)
OTHER_TYPE(String, fmi3String)

fmi3Status fmi3GetBinary(fmi3Instance c, const fmi3ValueReference vr[], size_t count,
                         size_t sizes[], fmi3Binary values[], size_t value_count)
{
    INSTANCE(c)
    (void)vr;
    (void)sizes;
    (void)values;
    (void)value_count;
    return (fmi3Status)fmi_refuse_type(i, count, "Binary");
}

fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference vr[], size_t count,
                         const size_t sizes[], const fmi3Binary values[], size_t value_count)
{
    INSTANCE(c)
    (void)vr;
    (void)sizes;
    (void)values;
    (void)value_count;
    return (fmi3Status)fmi_refuse_type(i, count, "Binary");
}

fmi3Status fmi3GetClock(fmi3Instance c, const fmi3ValueReference vr[], size_t count,
                        fmi3Clock values[])
{
    INSTANCE(c)
    (void)vr;
    (void)values;
    return (fmi3Status)fmi_refuse_type(i, count, "Clock");
}

fmi3Status fmi3SetClock(fmi3Instance c, const fmi3ValueReference vr[], size_t count,
                        const fmi3Clock values[])
{
    INSTANCE(c)
    (void)vr;
    (void)values;
    return (fmi3Status)fmi_refuse_type(i, count, "Clock");
}

/* ---- steps ----------------------------------------------------------------------------------*/

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 h, fmi3Boolean no_state_before,
                      fmi3Boolean *event_needed, fmi3Boolean *terminate, fmi3Boolean *early_return,
                      fmi3Float64 *last_time)
{
    INSTANCE(c)
    (void)no_state_before;
    if (!event_needed || !terminate || !early_return || !last_time) {
        return (fmi3Status)fmi_refuse(i, "fmi3DoStep", "a place for an answer is NULL");
    }
    const bool good = se3di_fmi_unit_step(i->unit, time, h);
    const bool ended = se3di_fmi_unit_get_mode(i->unit) == SE3DI_FMI_ENDED;
    *event_needed = false;
    *terminate = good && ended;
    *last_time = se3di_fmi_unit_get_time(i->unit);
    *early_return = good && ended && *last_time < time + h;
    return done(good);
}

/* ---- states ---------------------------------------------------------------------------------*/

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state)
{
    INSTANCE(c)
    return (fmi3Status)fmi_get_state(i, state);
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state)
{
    INSTANCE(c)
    return (fmi3Status)fmi_set_state(i, state);
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state)
{
    INSTANCE(c)
    return (fmi3Status)fmi_free_state(state);
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size)
{
    INSTANCE(c)
    return (fmi3Status)fmi_get_state_size(i, state, size);
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size)
{
    INSTANCE(c)
    return (fmi3Status)fmi_write_state(i, state, bytes, size);
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size,
                                   fmi3FMUState *state)
{
    INSTANCE(c)
    return (fmi3Status)fmi_read_state(i, bytes, size, state);
}

/* ---- model exchange and derivatives ---------------------------------------------------------*/

static fmi3Status exchanged(const fmi_instance *i, bool good)
{
    return (fmi3Status)fmi_done(i, good);
}

#define COMMON(name, parameters, good)                                                             \
    fmi3Status fmi3##name parameters                                                               \
    {                                                                                              \
        INSTANCE(c)                                                                                \
        return exchanged(i, good);                                                                 \
    }
FMI_COMMON_LIST(COMMON)

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *needs_update,
                                    fmi3Boolean *terminate, fmi3Boolean *nominals,
                                    fmi3Boolean *values, fmi3Boolean *time_defined,
                                    fmi3Float64 *time)
{
    INSTANCE(c)
    if (!needs_update || !terminate || !nominals || !values || !time_defined || !time) {
        return (fmi3Status)fmi_refuse(i, "fmi3UpdateDiscreteStates",
                                      "the place for an answer is NULL");
    }
    *needs_update = *nominals = *time_defined = false;
    *time = 0.0;
    return exchanged(i, se3di_fmi_unit_update_event(i->unit, terminate, values));
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean no_state_before,
                                       fmi3Boolean *event, fmi3Boolean *terminate)
{
    INSTANCE(c)
    (void)no_state_before;
    if (!event || !terminate) {
        return (fmi3Status)fmi_refuse(i, "fmi3CompletedIntegratorStep",
                                      "the place for an answer is NULL");
    }
    *terminate = false;
    return exchanged(i, se3di_fmi_unit_complete_step(i->unit, event));
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 dx[], size_t count)
{
    INSTANCE(c)
    return exchanged(i, se3di_fmi_unit_get_derivatives(i->unit, dx, count));
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *count)
{
    INSTANCE(c)
    if (!count) {
        return (fmi3Status)fmi_refuse(i, "fmi3GetNumberOfEventIndicators", "the place is NULL");
    }
    *count = se3di_fmi_unit_count_indicators(i->unit);
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *count)
{
    INSTANCE(c)
    if (!count) {
        return (fmi3Status)fmi_refuse(i, "fmi3GetNumberOfContinuousStates", "the place is NULL");
    }
    *count = se3di_fmi_unit_count_states(i->unit);
    return fmi3OK;
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknowns[],
                                        size_t unknown_count, const fmi3ValueReference knowns[],
                                        size_t known_count, const fmi3Float64 seed[],
                                        size_t seed_count, fmi3Float64 sensitivity[],
                                        size_t sensitivity_count)
{
    INSTANCE(c)
    const fmi_direction direction = {.unknowns = unknowns,
                                     .knowns = knowns,
                                     .unknown_count = unknown_count,
                                     .known_count = known_count,
                                     .seed_count = seed_count,
                                     .out_count = sensitivity_count,
                                     .seed = seed,
                                     .out = sensitivity};
    return (fmi3Status)fmi_derive(i, &direction);
}

/* ---- what the unit does not have --------------------------------------------------------------*/

static fmi3Status refuse(fmi3Instance c, const char *call)
{
    INSTANCE(c)
    return (fmi3Status)fmi_refuse(i, call, "the unit does not have it");
}

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif
#define MISSING(name, parameters)                                                                  \
    fmi3Status fmi3##name parameters                                                               \
    {                                                                                              \
        return refuse(c, "fmi3" #name);                                                            \
    }
FMI3_MISSING_FUNCTIONS(MISSING)
