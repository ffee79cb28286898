/* SPDX-License-Identifier: BSD-3-Clause */
/* The functions of FMI 2.0, written down from the text of the standard (Functional Mock-up
 * Interface for Model Exchange and Co-Simulation, 2.0.x; sections 2.1, 3.2 and 4.2). A unit exports
 * them; whoever uses one looks them up by their names. */
#ifndef SE3D_FMI2_H
#define SE3D_FMI2_H

#include <stddef.h>

#if defined(__GNUC__)
#define FMI2_EXPORT __attribute__((visibility("default")))
#else
#define FMI2_EXPORT
#endif

typedef void *fmi2Component;
typedef void *fmi2ComponentEnvironment;
typedef void *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef char fmi2Char;
typedef const fmi2Char *fmi2String;
typedef char fmi2Byte;

enum { fmi2False = 0, fmi2True = 1 };

typedef enum {
    fmi2OK = 0,
    fmi2Warning = 1,
    fmi2Discard = 2,
    fmi2Error = 3,
    fmi2Fatal = 4,
    fmi2Pending = 5
} fmi2Status;

typedef enum { fmi2ModelExchange = 0, fmi2CoSimulation = 1 } fmi2Type;

typedef enum {
    fmi2DoStepStatus = 0,
    fmi2PendingStatus = 1,
    fmi2LastSuccessfulTime = 2,
    fmi2Terminated = 3
} fmi2StatusKind;

typedef struct {
    void (*logger)(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                   fmi2String category, fmi2String message, ...);
    void *(*allocateMemory)(size_t count, size_t size);
    void (*freeMemory)(void *memory);
    void (*stepFinished)(fmi2ComponentEnvironment environment, fmi2Status status);
    fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;

typedef struct {
    fmi2Boolean newDiscreteStatesNeeded;
    fmi2Boolean terminateSimulation;
    fmi2Boolean nominalsOfContinuousStatesChanged;
    fmi2Boolean valuesOfContinuousStatesChanged;
    fmi2Boolean nextEventTimeDefined;
    fmi2Real nextEventTime;
} fmi2EventInfo;

/* The functions: name and parameters; all but the first four give a status. */
#define FMI2_STATUS_FUNCTIONS(X)                                                                   \
    X(SetDebugLogging, (fmi2Component c, fmi2Boolean on, size_t count, const fmi2String *names))   \
    X(SetupExperiment, (fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance,            \
                        fmi2Real start, fmi2Boolean has_stop, fmi2Real stop))                      \
    X(EnterInitializationMode, (fmi2Component c))                                                  \
    X(ExitInitializationMode, (fmi2Component c))                                                   \
    X(Terminate, (fmi2Component c))                                                                \
    X(Reset, (fmi2Component c))                                                                    \
    X(GetReal, (fmi2Component c, const fmi2ValueReference *vr, size_t count, fmi2Real *values))    \
    X(GetInteger,                                                                                  \
      (fmi2Component c, const fmi2ValueReference *vr, size_t count, fmi2Integer *values))          \
    X(GetBoolean,                                                                                  \
      (fmi2Component c, const fmi2ValueReference *vr, size_t count, fmi2Boolean *values))          \
    X(GetString,                                                                                   \
      (fmi2Component c, const fmi2ValueReference *vr, size_t count, fmi2String *values))           \
    X(SetReal,                                                                                     \
      (fmi2Component c, const fmi2ValueReference *vr, size_t count, const fmi2Real *values))       \
    X(SetInteger,                                                                                  \
      (fmi2Component c, const fmi2ValueReference *vr, size_t count, const fmi2Integer *values))    \
    X(SetBoolean,                                                                                  \
      (fmi2Component c, const fmi2ValueReference *vr, size_t count, const fmi2Boolean *values))    \
    X(SetString,                                                                                   \
      (fmi2Component c, const fmi2ValueReference *vr, size_t count, const fmi2String *values))     \
    X(GetFMUstate, (fmi2Component c, fmi2FMUstate * state))                                        \
    X(SetFMUstate, (fmi2Component c, fmi2FMUstate state))                                          \
    X(FreeFMUstate, (fmi2Component c, fmi2FMUstate * state))                                       \
    X(SerializedFMUstateSize, (fmi2Component c, fmi2FMUstate state, size_t * size))                \
    X(SerializeFMUstate, (fmi2Component c, fmi2FMUstate state, fmi2Byte * bytes, size_t size))     \
    X(DeSerializeFMUstate,                                                                         \
      (fmi2Component c, const fmi2Byte *bytes, size_t size, fmi2FMUstate *state))                  \
    X(GetDirectionalDerivative, (fmi2Component c, const fmi2ValueReference *unknowns,              \
                                 size_t unknown_count, const fmi2ValueReference *knowns,           \
                                 size_t known_count, const fmi2Real *seed, fmi2Real *sensitivity)) \
    X(SetRealInputDerivatives, (fmi2Component c, const fmi2ValueReference *vr, size_t count,       \
                                const fmi2Integer *orders, const fmi2Real *values))                \
    X(GetRealOutputDerivatives, (fmi2Component c, const fmi2ValueReference *vr, size_t count,      \
                                 const fmi2Integer *orders, fmi2Real *values))                     \
    X(DoStep, (fmi2Component c, fmi2Real time, fmi2Real h, fmi2Boolean no_state_before))           \
    X(CancelStep, (fmi2Component c))                                                               \
    X(GetStatus, (fmi2Component c, const fmi2StatusKind kind, fmi2Status *value))                  \
    X(GetRealStatus, (fmi2Component c, const fmi2StatusKind kind, fmi2Real *value))                \
    X(GetIntegerStatus, (fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value))          \
    X(GetBooleanStatus, (fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value))          \
    X(GetStringStatus, (fmi2Component c, const fmi2StatusKind kind, fmi2String *value))            \
    X(EnterEventMode, (fmi2Component c))                                                           \
    X(NewDiscreteStates, (fmi2Component c, fmi2EventInfo * info))                                  \
    X(EnterContinuousTimeMode, (fmi2Component c))                                                  \
    X(CompletedIntegratorStep, (fmi2Component c, fmi2Boolean no_state_before, fmi2Boolean * event, \
                                fmi2Boolean * terminate))                                          \
    X(SetTime, (fmi2Component c, fmi2Real time))                                                   \
    X(SetContinuousStates, (fmi2Component c, const fmi2Real x[], size_t count))                    \
    X(GetDerivatives, (fmi2Component c, fmi2Real dx[], size_t count))                              \
    X(GetEventIndicators, (fmi2Component c, fmi2Real values[], size_t count))                      \
    X(GetContinuousStates, (fmi2Component c, fmi2Real x[], size_t count))                          \
    X(GetNominalsOfContinuousStates, (fmi2Component c, fmi2Real x[], size_t count))

#define FMI2_DECLARE(name, parameters)                                                             \
    typedef fmi2Status fmi2##name##TYPE parameters;                                                \
    FMI2_EXPORT fmi2##name##TYPE fmi2##name;
FMI2_STATUS_FUNCTIONS(FMI2_DECLARE)
#undef FMI2_DECLARE

typedef const char *fmi2GetTypesPlatformTYPE(void);
typedef const char *fmi2GetVersionTYPE(void);
typedef fmi2Component fmi2InstantiateTYPE(fmi2String name, fmi2Type type, fmi2String guid,
                                          fmi2String resources,
                                          const fmi2CallbackFunctions *functions,
                                          fmi2Boolean visible, fmi2Boolean logging);
typedef void fmi2FreeInstanceTYPE(fmi2Component c);
FMI2_EXPORT fmi2GetTypesPlatformTYPE fmi2GetTypesPlatform;
FMI2_EXPORT fmi2GetVersionTYPE fmi2GetVersion;
FMI2_EXPORT fmi2InstantiateTYPE fmi2Instantiate;
FMI2_EXPORT fmi2FreeInstanceTYPE fmi2FreeInstance;

#endif
