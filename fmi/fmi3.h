/* SPDX-License-Identifier: BSD-3-Clause */
/* The functions of FMI 3.0, written down from the text of the standard (Functional Mock-up
 * Interface Specification 3.0, sections 2.2 and 4). A unit exports them all; those of kinds that it
 * is not say so. */
#ifndef SE3D_FMI3_H
#define SE3D_FMI3_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define FMI3_EXPORT __attribute__((visibility("default")))
#else
#define FMI3_EXPORT
#endif

typedef void *fmi3Instance;
typedef void *fmi3InstanceEnvironment;
typedef void *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean;
typedef char fmi3Char;
typedef const fmi3Char *fmi3String;
typedef uint8_t fmi3Byte;
typedef const fmi3Byte *fmi3Binary;
typedef bool fmi3Clock;

typedef enum {
    fmi3OK = 0,
    fmi3Warning = 1,
    fmi3Discard = 2,
    fmi3Error = 3,
    fmi3Fatal = 4
} fmi3Status;

typedef enum {
    fmi3Independent = 0,
    fmi3Constant = 1,
    fmi3Fixed = 2,
    fmi3Tunable = 3,
    fmi3Discrete = 4,
    fmi3Dependent = 5
} fmi3DependencyKind;

typedef enum {
    fmi3IntervalNotYetKnown = 0,
    fmi3IntervalUnchanged = 1,
    fmi3IntervalChanged = 2
} fmi3IntervalQualifier;

typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment environment, fmi3Status status,
                                       fmi3String category, fmi3String message);
typedef void (*fmi3ClockUpdateCallback)(fmi3InstanceEnvironment environment);
typedef void (*fmi3IntermediateUpdateCallback)(fmi3InstanceEnvironment environment,
                                               fmi3Float64 time, fmi3Boolean set_requested,
                                               fmi3Boolean get_allowed, fmi3Boolean step_finished,
                                               fmi3Boolean can_return_early,
                                               fmi3Boolean *early_return_requested,
                                               fmi3Float64 *early_return_time);
typedef void (*fmi3LockPreemptionCallback)(void);
typedef void (*fmi3UnlockPreemptionCallback)(void);

/* Types whose values are got and set in one way. */
#define FMI3_TYPES(X)                                                                              \
    X(Float32, fmi3Float32)                                                                        \
    X(Float64, fmi3Float64)                                                                        \
    X(Int8, fmi3Int8)                                                                              \
    X(UInt8, fmi3UInt8)                                                                            \
    X(Int16, fmi3Int16)                                                                            \
    X(UInt16, fmi3UInt16)                                                                          \
    X(Int32, fmi3Int32)                                                                            \
    X(UInt32, fmi3UInt32)                                                                          \
    X(Int64, fmi3Int64)                                                                            \
    X(UInt64, fmi3UInt64)                                                                          \
    X(Boolean, fmi3Boolean)                                                                        \
    X(String, fmi3String)

/* What a unit does: name and parameters; each gives a status. */
#define FMI3_STATUS_FUNCTIONS(X)                                                                   \
    X(SetDebugLogging, (fmi3Instance c, fmi3Boolean on, size_t count, const fmi3String names[]))   \
    X(EnterInitializationMode, (fmi3Instance c, fmi3Boolean has_tolerance, fmi3Float64 tolerance,  \
                                fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop))        \
    X(ExitInitializationMode, (fmi3Instance c))                                                    \
    X(Terminate, (fmi3Instance c))                                                                 \
    X(Reset, (fmi3Instance c))                                                                     \
    X(GetFMUState, (fmi3Instance c, fmi3FMUState * state))                                         \
    X(SetFMUState, (fmi3Instance c, fmi3FMUState state))                                           \
    X(FreeFMUState, (fmi3Instance c, fmi3FMUState * state))                                        \
    X(SerializedFMUStateSize, (fmi3Instance c, fmi3FMUState state, size_t * size))                 \
    X(SerializeFMUState, (fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size))      \
    X(DeserializeFMUState,                                                                         \
      (fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state))                  \
    X(DoStep, (fmi3Instance c, fmi3Float64 time, fmi3Float64 h, fmi3Boolean no_state_before,       \
               fmi3Boolean * event_needed, fmi3Boolean * terminate, fmi3Boolean * early_return,    \
               fmi3Float64 * last_time))                                                           \
    X(EnterEventMode, (fmi3Instance c))                                                            \
    X(EnterContinuousTimeMode, (fmi3Instance c))                                                   \
    X(GetDirectionalDerivative,                                                                    \
      (fmi3Instance c, const fmi3ValueReference unknowns[], size_t unknown_count,                  \
       const fmi3ValueReference knowns[], size_t known_count, const fmi3Float64 seed[],            \
       size_t seed_count, fmi3Float64 sensitivity[], size_t sensitivity_count))                    \
    X(UpdateDiscreteStates, (fmi3Instance c, fmi3Boolean * needs_update, fmi3Boolean * terminate,  \
                             fmi3Boolean * nominals, fmi3Boolean * values,                         \
                             fmi3Boolean * time_defined, fmi3Float64 * time))                      \
    X(CompletedIntegratorStep,                                                                     \
      (fmi3Instance c, fmi3Boolean no_state_before, fmi3Boolean * event, fmi3Boolean * terminate)) \
    X(SetTime, (fmi3Instance c, fmi3Float64 time))                                                 \
    X(SetContinuousStates, (fmi3Instance c, const fmi3Float64 x[], size_t count))                  \
    X(GetContinuousStateDerivatives, (fmi3Instance c, fmi3Float64 dx[], size_t count))             \
    X(GetEventIndicators, (fmi3Instance c, fmi3Float64 values[], size_t count))                    \
    X(GetContinuousStates, (fmi3Instance c, fmi3Float64 x[], size_t count))                        \
    X(GetNominalsOfContinuousStates, (fmi3Instance c, fmi3Float64 x[], size_t count))              \
    X(GetNumberOfEventIndicators, (fmi3Instance c, size_t * count))                                \
    X(GetNumberOfContinuousStates, (fmi3Instance c, size_t * count))

/* What it does not: these fail with a message. */
#define FMI3_MISSING_FUNCTIONS(X)                                                                  \
    X(EnterStepMode, (fmi3Instance c))                                                             \
    X(EnterConfigurationMode, (fmi3Instance c))                                                    \
    X(ExitConfigurationMode, (fmi3Instance c))                                                     \
    X(EvaluateDiscreteStates, (fmi3Instance c))                                                    \
    X(GetNumberOfVariableDependencies, (fmi3Instance c, fmi3ValueReference a, size_t * b))         \
    X(GetVariableDependencies,                                                                     \
      (fmi3Instance c, fmi3ValueReference a, size_t b[], fmi3ValueReference d[], size_t e[],       \
       fmi3DependencyKind f[], size_t g))                                                          \
    X(GetAdjointDerivative,                                                                        \
      (fmi3Instance c, const fmi3ValueReference a[], size_t b, const fmi3ValueReference d[],       \
       size_t e, const fmi3Float64 f[], size_t g, fmi3Float64 h[], size_t i))                      \
    X(GetOutputDerivatives, (fmi3Instance c, const fmi3ValueReference a[], size_t b,               \
                             const fmi3Int32 d[], fmi3Float64 e[], size_t f))                      \
    X(GetIntervalDecimal, (fmi3Instance c, const fmi3ValueReference a[], size_t b,                 \
                           fmi3Float64 d[], fmi3IntervalQualifier e[]))                            \
    X(GetIntervalFraction, (fmi3Instance c, const fmi3ValueReference a[], size_t b,                \
                            fmi3UInt64 d[], fmi3UInt64 e[], fmi3IntervalQualifier f[]))            \
    X(GetShiftDecimal, (fmi3Instance c, const fmi3ValueReference a[], size_t b, fmi3Float64 d[]))  \
    X(GetShiftFraction,                                                                            \
      (fmi3Instance c, const fmi3ValueReference a[], size_t b, fmi3UInt64 d[], fmi3UInt64 e[]))    \
    X(SetIntervalDecimal,                                                                          \
      (fmi3Instance c, const fmi3ValueReference a[], size_t b, const fmi3Float64 d[]))             \
    X(SetIntervalFraction, (fmi3Instance c, const fmi3ValueReference a[], size_t b,                \
                            const fmi3UInt64 d[], const fmi3UInt64 e[]))                           \
    X(SetShiftDecimal,                                                                             \
      (fmi3Instance c, const fmi3ValueReference a[], size_t b, const fmi3Float64 d[]))             \
    X(SetShiftFraction, (fmi3Instance c, const fmi3ValueReference a[], size_t b,                   \
                         const fmi3UInt64 d[], const fmi3UInt64 e[]))                              \
    X(ActivateModelPartition, (fmi3Instance c, fmi3ValueReference a, fmi3Float64 b))

#define FMI3_DECLARE(name, parameters)                                                             \
    typedef fmi3Status fmi3##name##TYPE parameters;                                                \
    FMI3_EXPORT fmi3##name##TYPE fmi3##name;
FMI3_STATUS_FUNCTIONS(FMI3_DECLARE)
FMI3_MISSING_FUNCTIONS(FMI3_DECLARE)
#define FMI3_DECLARE_TYPE(name, type)                                                              \
    FMI3_DECLARE(Get##name, (fmi3Instance c, const fmi3ValueReference vr[], size_t count,          \
                             type values[], size_t value_count))                                   \
    FMI3_DECLARE(Set##name, (fmi3Instance c, const fmi3ValueReference vr[], size_t count,          \
                             const type values[], size_t value_count))
FMI3_TYPES(FMI3_DECLARE_TYPE)
FMI3_DECLARE(GetBinary, (fmi3Instance c, const fmi3ValueReference vr[], size_t count,
                         size_t sizes[], fmi3Binary values[], size_t value_count))
FMI3_DECLARE(SetBinary, (fmi3Instance c, const fmi3ValueReference vr[], size_t count,
                         const size_t sizes[], const fmi3Binary values[], size_t value_count))
FMI3_DECLARE(GetClock,
             (fmi3Instance c, const fmi3ValueReference vr[], size_t count, fmi3Clock values[]))
FMI3_DECLARE(SetClock, (fmi3Instance c, const fmi3ValueReference vr[], size_t count,
                        const fmi3Clock values[]))
#undef FMI3_DECLARE_TYPE
#undef FMI3_DECLARE

typedef const char *fmi3GetVersionTYPE(void);
typedef fmi3Instance fmi3InstantiateModelExchangeTYPE(fmi3String name, fmi3String token,
                                                      fmi3String resources, fmi3Boolean visible,
                                                      fmi3Boolean logging,
                                                      fmi3InstanceEnvironment environment,
                                                      fmi3LogMessageCallback log);
typedef fmi3Instance
fmi3InstantiateCoSimulationTYPE(fmi3String name, fmi3String token, fmi3String resources,
                                fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean event_mode,
                                fmi3Boolean early_return, const fmi3ValueReference intermediate[],
                                size_t intermediate_count, fmi3InstanceEnvironment environment,
                                fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update);
typedef fmi3Instance fmi3InstantiateScheduledExecutionTYPE(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
    fmi3UnlockPreemptionCallback unlock);
typedef void fmi3FreeInstanceTYPE(fmi3Instance c);
FMI3_EXPORT fmi3GetVersionTYPE fmi3GetVersion;
FMI3_EXPORT fmi3InstantiateModelExchangeTYPE fmi3InstantiateModelExchange;
FMI3_EXPORT fmi3InstantiateCoSimulationTYPE fmi3InstantiateCoSimulation;
FMI3_EXPORT fmi3InstantiateScheduledExecutionTYPE fmi3InstantiateScheduledExecution;
FMI3_EXPORT fmi3FreeInstanceTYPE fmi3FreeInstance;

#endif
