/* SPDX-License-Identifier: BSD-3-Clause */
/* A unit is a program: its shared object is loaded when a run asks for it and not before. What the
 * standard calls things is written down here, for the few functions that a run needs. */
#include "io/run/guest.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/floats.h"
#include "base/hash.h"
#include "io/base/file.h"
#include "io/base/pack.h"
#include "io/base/pool.h"
#include "io/base/unzip.h"
#include "io/model/settable.h"
#include "io/run/guest_description.h"

#define STATE_MOST (SIZE_MAX / 4)
enum { TOLD = 300, PATH_SIZE = 4096, FOLDER_MOST = 1000 };
enum { GOOD_MOST = 1 /* OK, Warning */, DISCARD = 2, FAILED = 3, FATAL = 4 };

#if defined(__linux__) && defined(__x86_64__)
#define PLATFORM2 "linux64"
#define PLATFORM3 "x86_64-linux"
#elif defined(__linux__) && defined(__aarch64__)
#define PLATFORM2 "linuxaarch64"
#define PLATFORM3 "aarch64-linux"
#endif

#if defined(PLATFORM2) && defined(__GNUC__)
/* Programs that are linked statically do not have them. */
extern void *dlopen(const char *path, int how) __attribute__((weak));
extern void *dlsym(void *object, const char *name) __attribute__((weak));
extern int dlclose(void *object) __attribute__((weak));
extern char *dlerror(void) __attribute__((weak));
extern char *realpath(const char *path, char *resolved);
#define HAS_OBJECTS 1
#define NOW         2 /* RTLD_NOW, local */
#else
#define HAS_OBJECTS 0
#endif

typedef struct callbacks_2 {
    void (*logger)(void *environment, const char *name, int status, const char *category,
                   const char *message, ...);
    void *(*allocate)(size_t count, size_t size);
    void (*release)(void *memory);
    void (*finished)(void *environment, int status);
    void *environment;
} callbacks_2;

typedef void (*log_3)(void *environment, int status, const char *category, const char *message);

/* The functions, of either version. */
typedef struct calls {
    void *(*instantiate_2)(const char *name, int type, const char *guid, const char *resources,
                           const callbacks_2 *callbacks, int visible, int logging);
    void *(*instantiate_3)(const char *name, const char *token, const char *resources, bool visible,
                           bool logging, bool events, bool early, const uint32_t *intermediate,
                           size_t count, void *environment, log_3 log, void *update);
    int (*setup_2)(void *c, int has_tolerance, double tolerance, double start, int has_stop,
                   double stop);
    int (*enter_2)(void *c);
    int (*enter_3)(void *c, bool has_tolerance, double tolerance, double start, bool has_stop,
                   double stop);
    int (*leave)(void *c);
    int (*get_2)(void *c, const uint32_t *references, size_t count, double *values);
    int (*set_2)(void *c, const uint32_t *references, size_t count, const double *values);
    int (*get_3)(void *c, const uint32_t *references, size_t count, double *values, size_t room);
    int (*set_3)(void *c, const uint32_t *references, size_t count, const double *values,
                 size_t given);
    int (*step_2)(void *c, double time, double h, int no_state_before);
    int (*step_3)(void *c, double time, double h, bool no_state_before, bool *event, bool *ends,
                  bool *early, double *reached);
    int (*whole_2)(void *c, const uint32_t *references, size_t count, int32_t *values);
    int (*whole_3)(void *c, const uint32_t *references, size_t count, int32_t *values, size_t room);
    int (*terminate)(void *c);
    void (*release)(void *c);
    int (*get_state)(void *c, void **state);
    int (*set_state)(void *c, void *state);
    int (*free_state)(void *c, void **state);
    int (*state_size)(void *c, void *state, size_t *size);
    int (*write_state)(void *c, void *state, unsigned char *bytes, size_t size);
    int (*read_state)(void *c, const unsigned char *bytes, size_t size, void **state);
} calls;

typedef struct guest {
    const se3di_guest_entry *entry;
    const char *folder; /* of the unit, or where it is unpacked */
    const char *made;   /* by us, to be taken away; NULL: none */
    int hold;           /* of it */
    se3di_guest_description description;
    uint32_t *inputs, *outputs; /* value references */
    bool *wholes;               /* [outputs] whole numbers */
    double *said;               /* [outputs] what acts */
    double *places;             /* [2 outputs] since when a rate is so, its integral then */
    void *object;               /* NULL: not loaded */
    void *instance;             /* NULL: none */
    calls f;
    callbacks_2 callbacks;
    char told[TOLD];
    double start, time;
    double points; /* communication points so far */
    bool keeps;    /* its state is asked for */
    int worst;     /* status that it has told. FAILED: it cannot go on; FATAL: no call is allowed */
} guest;

struct se3di_guests {
    se3di_iopool pool;
    se3d_model *model;
    guest *list;
    size_t count;
    bool has_failed;
};

/* ---- what a unit says -------------------------------------------------------------------------*/

static void keep_told(guest *g, int status, const char *message)
{
    if (status > GOOD_MOST && message) {
        snprintf(g->told, sizeof g->told, "%s", message);
    }
}

#if defined(__GNUC__)
__attribute__((__format__(__printf__, 5, 6)))
#endif
static void
hear_2(void *environment, const char *name, int status, const char *category, const char *message,
       ...)
{
    char text[TOLD];
    va_list arguments;
    (void)name;
    (void)category;
    va_start(arguments, message);
    vsnprintf(text, sizeof text, message, arguments);
    va_end(arguments);
    keep_told(environment, status, text);
}

static void hear_3(void *environment, int status, const char *category, const char *message)
{
    (void)category;
    keep_told(environment, status, message);
}

static se3d_status fail(const guest *g, se3d_status status, char *problem, const char *what)
{
    snprintf(problem, SE3DI_GUEST_PROBLEM, "fmu `%.60s`: %.200s%s%.250s", g->entry->name, what,
             g->told[0] ? ": " : "", g->told);
    return status;
}

/* Whether a call went well. */
static bool good(guest *g, int status)
{
    se3di_floats_resume();
    g->worst = status > g->worst ? status : g->worst;
    return status >= 0 && status <= GOOD_MOST;
}

/* ---- loading ----------------------------------------------------------------------------------*/

#if HAS_OBJECTS
static bool load(guest *g, const char *name, void *pointer)
{
    char text[100];
    snprintf(text, sizeof text, "fmi%d%s", g->description.version, name);
    void *found = dlsym(g->object, text);
    memcpy(pointer, &found, sizeof found); /* a function as what it is */
    if (!found) {
        snprintf(g->told, sizeof g->told, "%s is missing", text);
    }
    return found != NULL;
}

static bool load_functions(guest *g)
{
    const bool both = load(g, "ExitInitializationMode", &g->f.leave) &&
                      load(g, "Terminate", &g->f.terminate) &&
                      load(g, "FreeInstance", &g->f.release);
    if (g->description.version == 2) {
        return both && load(g, "Instantiate", &g->f.instantiate_2) &&
               load(g, "SetupExperiment", &g->f.setup_2) &&
               load(g, "EnterInitializationMode", &g->f.enter_2) &&
               load(g, "GetInteger", &g->f.whole_2) && load(g, "GetReal", &g->f.get_2) &&
               load(g, "SetReal", &g->f.set_2) && load(g, "DoStep", &g->f.step_2);
    }
    return both && load(g, "InstantiateCoSimulation", &g->f.instantiate_3) &&
           load(g, "EnterInitializationMode", &g->f.enter_3) &&
           load(g, "GetInt32", &g->f.whole_3) && load(g, "GetFloat64", &g->f.get_3) &&
           load(g, "SetFloat64", &g->f.set_3) && load(g, "DoStep", &g->f.step_3);
}

static bool load_states(guest *g)
{
    const bool old = g->description.version == 2;
    return load(g, old ? "GetFMUstate" : "GetFMUState", &g->f.get_state) &&
           load(g, old ? "SetFMUstate" : "SetFMUState", &g->f.set_state) &&
           load(g, old ? "FreeFMUstate" : "FreeFMUState", &g->f.free_state) &&
           load(g, old ? "SerializedFMUstateSize" : "SerializedFMUStateSize", &g->f.state_size) &&
           load(g, old ? "SerializeFMUstate" : "SerializeFMUState", &g->f.write_state) &&
           load(g, old ? "DeSerializeFMUstate" : "DeserializeFMUState", &g->f.read_state);
}

static se3d_status load_object(guest *g, char *problem)
{
    char path[PATH_SIZE];
    if (!dlopen || !dlsym || !dlclose) {
        return fail(g, SE3D_ERR_UNSUPPORTED, problem,
                    "this program is linked statically and cannot load units");
    }
    snprintf(path, sizeof path, "%s%s/binaries/%s/%.500s.so", g->folder[0] == '/' ? "" : "./",
             g->folder, g->description.version == 2 ? PLATFORM2 : PLATFORM3,
             g->description.identifier);
    g->object = dlopen(path, NOW);
    se3di_floats_resume();
    if (!g->object) {
        const char *why = dlerror ? dlerror() : NULL;
        snprintf(g->told, sizeof g->told, "%.290s", why ? why : path);
        return fail(g, SE3D_ERR_IO, problem, "it has no shared object that this machine can load");
    }
    return load_functions(g) && (!g->keeps || load_states(g))
               ? SE3D_OK
               : fail(g, SE3D_ERR_UNSUPPORTED, problem, "is not a whole unit");
}

static void unload(guest *g)
{
    if (g->object) {
        dlclose(g->object);
    }
}
#else
static se3d_status load_object(guest *g, char *problem)
{
    return fail(g, SE3D_ERR_UNSUPPORTED, problem, "units are loaded on Linux only");
}

static void unload(guest *g)
{
    (void)g;
}
#endif

/* ---- values -----------------------------------------------------------------------------------*/

static bool set(guest *g, const uint32_t *references, size_t count, const double *values)
{
    return count == 0 || good(g, g->description.version == 2
                                     ? g->f.set_2(g->instance, references, count, values)
                                     : g->f.set_3(g->instance, references, count, values, count));
}

static bool get(guest *g, size_t k, double *value)
{
    const bool old = g->description.version == 2;
    const uint32_t *reference = &g->outputs[k];
    int32_t whole = 0;
    int status = 0;
    if (g->wholes[k]) {
        status = old ? g->f.whole_2(g->instance, reference, 1, &whole)
                     : g->f.whole_3(g->instance, reference, 1, &whole, 1);
        *value = whole;
    } else {
        status = old ? g->f.get_2(g->instance, reference, 1, value)
                     : g->f.get_3(g->instance, reference, 1, value, 1);
    }
    return good(g, status);
}

static se3d_status find_variable(const guest *g, const char *name, const char *causality,
                                 uint32_t *reference, bool *is_whole, char *problem)
{
    char what[200];
    const bool old = g->description.version == 2;
    const char *type = old ? "Real" : "Float64";
    for (size_t k = 0; k < g->description.count; ++k) {
        const se3di_guest_variable *v = &g->description.variables[k];
        if (strcmp(v->name, name) == 0) {
            const bool whole = is_whole && strcmp(v->type, old ? "Integer" : "Int32") == 0;
            if (strcmp(v->causality, causality) == 0 && (whole || strcmp(v->type, type) == 0)) {
                if (is_whole) {
                    *is_whole = whole;
                }
                *reference = v->reference;
                return SE3D_OK;
            }
            snprintf(what, sizeof what, "`%.60s` is %.20s %.20s, must be %s %s", name, v->causality,
                     v->type, causality, type);
            return fail(g, SE3D_ERR_INVALID_ARGUMENT, problem, what);
        }
    }
    snprintf(what, sizeof what, "it has no variable `%.60s`", name);
    return fail(g, SE3D_ERR_INVALID_ARGUMENT, problem, what);
}

static se3d_status find_variables(guest *g, se3di_iopool *pool, char *problem)
{
    const se3di_guest_entry *e = g->entry;
    se3d_status status = SE3D_OK;
    g->inputs = se3di_iopool_array(pool, e->input_count + 1, sizeof *g->inputs);
    g->outputs = se3di_iopool_array(pool, e->output_count + 1, sizeof *g->outputs);
    g->wholes = se3di_iopool_array(pool, e->output_count + 1, sizeof *g->wholes);
    g->said = se3di_iopool_array(pool, e->output_count + 1, sizeof *g->said);
    g->places = se3di_iopool_array(pool, e->output_count + 1, 2 * sizeof *g->places);
    if (!g->inputs || !g->outputs || !g->wholes || !g->said || !g->places) {
        return fail(g, SE3D_ERR_NO_MEMORY, problem, "out of memory");
    }
    for (size_t k = 0; k < e->input_count && status >= 0; ++k) {
        status = find_variable(g, e->inputs[k].variable, "input", &g->inputs[k], NULL, problem);
    }
    for (size_t k = 0; k < e->output_count && status >= 0; ++k) {
        status = find_variable(g, e->outputs[k].variable, "output", &g->outputs[k], &g->wholes[k],
                               problem);
    }
    return status;
}

/* ---- life -------------------------------------------------------------------------------------*/

/* A path as a part of a URI. */
static void quote(char *out, const char *path)
{
    static const char plain[] = "-._~/";
    for (; *path; ++path) {
        const unsigned char c = (unsigned char)*path;
        const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                              (c >= '0' && c <= '9') || strchr(plain, c);
        out += is_plain ? snprintf(out, 2, "%c", c) : snprintf(out, 4, "%%%02X", c);
    }
    *out = '\0';
}

static bool instantiate(guest *g)
{
    char resources[PATH_SIZE];
    char quoted[3 * FOLDER_MOST + 1];
    const se3di_guest_description *d = &g->description;
    char *folder = NULL;
#if HAS_OBJECTS
    folder = realpath(g->folder, NULL);
#endif
    const char *path = folder ? folder : g->folder;
    if (strlen(path) > FOLDER_MOST) {
        snprintf(g->told, sizeof g->told, "the path of its folder is too long");
        free(folder);
        return false;
    }
    quote(quoted, path);
    snprintf(resources, sizeof resources, d->version == 2 ? "file://%s/resources" : "%s/resources/",
             d->version == 2 ? quoted : path);
    free(folder);
    g->callbacks = (callbacks_2){hear_2, calloc, free, NULL, g};
    g->instance =
        d->version == 2
            ? g->f.instantiate_2(g->entry->name, 1, d->token, resources, &g->callbacks, 0, 0)
            : g->f.instantiate_3(g->entry->name, d->token, resources, false, false, false, false,
                                 NULL, 0, g, hear_3, NULL);
    se3di_floats_resume();
    return g->instance != NULL;
}

static bool begin(guest *g, double start, double stop)
{
    return g->description.version != 2 ||
           good(g, g->f.setup_2(g->instance, 0, 0.0, start, 1, stop));
}

static bool enter(guest *g, double start, double stop)
{
    return good(g, g->description.version == 2
                       ? g->f.enter_2(g->instance)
                       : g->f.enter_3(g->instance, false, 0.0, start, true, stop));
}

static se3d_status set_parameters(guest *g, char *problem)
{
    for (size_t k = 0; k < g->entry->parameter_count; ++k) {
        const se3di_guest_parameter *p = &g->entry->parameters[k];
        uint32_t reference = 0;
        const se3d_status status =
            find_variable(g, p->variable, "parameter", &reference, NULL, problem);
        if (status < 0) {
            return status;
        }
        if (!set(g, &reference, 1, &p->value)) {
            return fail(g, SE3D_ERR_INVALID_ARGUMENT, problem, "a parameter is refused");
        }
    }
    return SE3D_OK;
}

/* What a run needs of an archive on this machine. */
static bool is_needed(const char *name)
{
    static const char *const folders[] = {
#if HAS_OBJECTS
        "binaries/" PLATFORM2 "/",
        "binaries/" PLATFORM3 "/",
#endif
        "resources/"
    };
    bool needed = strcmp(name, "modelDescription.xml") == 0;
    for (size_t k = 0; k < sizeof folders / sizeof *folders; ++k) {
        needed = needed || strncmp(name, folders[k], strlen(folders[k])) == 0;
    }
    return needed;
}

/* Unpack a unit into a folder of its own; one that is a folder already is used where it is. */
static se3d_status unpack(guest *g, se3di_iopool *pool, const char *temporary, char *problem)
{
    char path[PATH_SIZE];
    FILE *file = se3di_file_open(g->entry->path);
    if (!file) {
        return SE3D_OK; /* a folder, or the description is found missing there */
    }
    fclose(file);
    if (!HAS_OBJECTS) {
        return fail(g, SE3D_ERR_UNSUPPORTED, problem, "units of other programs are for Linux");
    }
    if (!se3di_temporary_hold(temporary, path, sizeof path, &g->hold)) {
        snprintf(g->told, sizeof g->told, "%.150s: %s", path, se3di_file_get_text(errno));
        return fail(g, SE3D_ERR_IO, problem, "it cannot be unpacked");
    }
    g->folder = g->made = se3di_iopool_copy(pool, path, strlen(path));
    if (!g->made) {
        se3di_temporary_release(path, g->hold);
        return fail(g, SE3D_ERR_NO_MEMORY, problem, "out of memory");
    }
    const se3d_status status =
        se3di_unzip(g->entry->path, path, is_needed, &pool->allocator, g->told, sizeof g->told);
    return status < 0 ? fail(g, status, problem, g->entry->path) : SE3D_OK;
}

/* Into the initialization, which ends at the first communication point. */
static se3d_status open_guest(const guest *list, guest *g, se3di_iopool *pool, double stop,
                              char *problem)
{
    char path[PATH_SIZE];
    if (strlen(g->folder) > FOLDER_MOST) {
        return fail(g, SE3D_ERR_IO, problem, "the path of its folder is too long");
    }
    if (!(stop + g->entry->step > stop)) {
        return fail(g, SE3D_ERR_INVALID_ARGUMENT, problem,
                    "its `step` is too short to be seen at the end of the analysis");
    }
    snprintf(path, sizeof path, "%s/modelDescription.xml", g->folder);
    se3d_status status = se3di_guest_describe(path, pool, &g->description, g->told, sizeof g->told);
    if (status < 0) {
        return fail(g, status, problem, path);
    }
    g->told[0] = '\0';
    for (const guest *other = list; other < g && g->description.is_single; ++other) {
        if (strcmp(other->description.token, g->description.token) == 0) {
            return fail(g, SE3D_ERR_UNSUPPORTED, problem, "there can be one of this unit only");
        }
    }
    if (g->keeps && !g->description.has_states) {
        return fail(g, SE3D_ERR_UNSUPPORTED, problem,
                    "the run can have no checkpoints, since the unit cannot write its state "
                    "(canGetAndSetFMUState, canSerializeFMUState)");
    }
    status = find_variables(g, pool, problem);
    status = status < 0 ? status : load_object(g, problem);
    if (status < 0) {
        return status;
    }
    if (!instantiate(g)) {
        return fail(g, SE3D_ERR_INVALID_ARGUMENT, problem, "it cannot be instantiated");
    }
    status = set_parameters(g, problem);
    if (status < 0) {
        return status;
    }
    /* the last step may end a little later */
    const double end = stop + g->entry->step;
    return begin(g, g->start, end) && enter(g, g->start, end)
               ? SE3D_OK
               : fail(g, SE3D_ERR_INVALID_ARGUMENT, problem, "it cannot be initialized");
}

se3d_status se3di_guests_open(se3d_model *model, const double span[2], const char *temporary,
                              bool keeps, se3di_guests **guests, char problem[SE3DI_GUEST_PROBLEM])
{
    se3di_iopool pool;
    *guests = NULL;
    se3di_iopool_init(&pool, &model->pool.allocator);
    se3di_guests *made = se3di_iopool_alloc(&pool, sizeof *made);
    guest *list = se3di_iopool_array(&pool, model->guest_count, sizeof *list);
    if (!made || !list) {
        se3di_iopool_destroy(&pool);
        snprintf(problem, SE3DI_GUEST_PROBLEM, "out of memory");
        return SE3D_ERR_NO_MEMORY;
    }
    *made = (se3di_guests){.pool = pool, .model = model, .list = list};
    se3d_status status = SE3D_OK;
    const se3di_floats host = se3di_floats_set();
    for (size_t k = 0; k < model->guest_count && status >= 0; ++k) {
        guest *g = &list[made->count++];
        memset(g, 0, sizeof *g);
        g->entry = &model->guests[k];
        g->folder = g->entry->path;
        g->keeps = keeps;
        g->start = g->time = span[0];
        status = unpack(g, &made->pool, temporary, problem);
        status = status < 0 ? status : open_guest(list, g, &made->pool, span[1], problem);
    }
    se3di_floats_restore(host);
    if (status < 0) {
        se3di_guests_close(made);
        return status;
    }
    *guests = made;
    return SE3D_OK;
}

void se3di_guests_close(se3di_guests *guests)
{
    if (!guests) {
        return;
    }
    const se3di_floats host = se3di_floats_set();
    for (size_t k = 0; k < guests->count; ++k) {
        guest *g = &guests->list[k];
        if (g->instance && g->worst < FATAL) {
            if (g->points > 0.0 && !guests->has_failed && g->worst < FAILED) {
                g->f.terminate(g->instance);
            }
            g->f.release(g->instance);
        }
        unload(g);
        if (g->made) {
            se3di_temporary_release(g->made, g->hold);
        }
    }
    se3di_floats_resume();
    se3di_floats_restore(host);
    se3di_iopool pool = guests->pool;
    se3di_iopool_destroy(&pool);
}

/* ---- communication ----------------------------------------------------------------------------*/

static double next_of(const guest *g)
{
    return g->start + g->points * g->entry->step;
}

static bool is_due(const guest *g, double time)
{
    return next_of(g) - time <= 1e-9 * g->entry->step;
}

double se3di_guests_limit(const se3di_guests *guests, double time)
{
    for (size_t k = 0; guests && k < guests->count; ++k) {
        const guest *g = &guests->list[k];
        time = is_due(g, time) ? fmin(time, next_of(g)) : time;
    }
    return time;
}

bool se3di_guests_are_due(const se3di_guests *guests, double time)
{
    bool due = false;
    for (size_t k = 0; guests && k < guests->count; ++k) {
        due = due || is_due(&guests->list[k], time);
    }
    return due;
}

bool se3di_guests_have_failed(const se3di_guests *guests)
{
    return guests->has_failed;
}

static se3d_status tell(guest *g, se3di_sample *sample, char *problem)
{
    for (size_t k = 0; k < g->entry->input_count; ++k) {
        const se3di_event_source *source = &g->entry->inputs[k].source;
        double numbers[4];
        const se3d_status status = se3di_channel_eval(&source->channel, sample, numbers);
        if (status < 0) {
            return fail(g, status, problem, g->entry->inputs[k].channel);
        }
        if (!isfinite(numbers[source->component])) {
            snprintf(g->told, sizeof g->told, "%.250s", g->entry->inputs[k].channel);
            return fail(g, SE3D_ERR_NOT_FINITE, problem, "an input is not finite");
        }
        if (!set(g, &g->inputs[k], 1, &numbers[source->component])) {
            return fail(g, SE3D_ERR_INVALID_ARGUMENT, problem, "an input is refused");
        }
    }
    return SE3D_OK;
}

static se3d_status step(guest *g, double time, char *problem)
{
    const double h = time - g->time;
    bool flags[3] = {false, false, false};
    double reached = time;
    const int status =
        g->description.version == 2
            ? g->f.step_2(g->instance, g->time, h, 1)
            : g->f.step_3(g->instance, g->time, h, true, &flags[0], &flags[1], &flags[2], &reached);
    const bool went = good(g, status);
    if (status == DISCARD || flags[1] || !(reached >= time - 1e-6 * h)) {
        return fail(g, SE3D_ERR_STEP_SIZE, problem, "it does not go on to the next point");
    }
    return went ? SE3D_OK : fail(g, SE3D_ERR_CALLBACK, problem, "its step has failed");
}

/* What it says acts on the model. */
static se3d_status act(const se3di_guests *guests, guest *g, char *problem)
{
    for (size_t k = 0; k < g->entry->output_count; ++k) {
        const se3di_guest_output *o = &g->entry->outputs[k];
        const se3d_function rate = guests->model->elements[o->index].rate;
        double said = 0.0;
        if (!get(g, k, &said) || !isfinite(said)) {
            return fail(g, SE3D_ERR_NOT_FINITE, problem, "an output cannot be had, or not finite");
        }
        const bool is_new = memcmp(&said, &g->said[k], sizeof said) != 0 || !(g->points > 0.0);
        se3d_status status = se3di_element_set(guests->model, o->index, o->component, said);
        if (status >= 0 && rate.index1 && is_new) {
            status =
                se3di_rate_get_place(guests->model, rate, &g->places[2 * k], &g->places[2 * k + 1]);
        }
        if (status < 0) {
            return fail(g, status, problem, se3d_system_get_error(guests->model->system));
        }
        g->said[k] = said;
    }
    return SE3D_OK;
}

/* To a point and told what is there; at the first one the initialization ends with it. */
static se3d_status hear(guest *g, se3di_sample *sample, double time, char *problem)
{
    const bool begins = !(g->points > 0.0);
    if (g->worst >= FAILED) { /* when its state was asked for */
        return fail(g, SE3D_ERR_CALLBACK, problem, "it cannot go on");
    }
    se3d_status status = begins ? SE3D_OK : step(g, time, problem);
    status = status < 0 ? status : tell(g, sample, problem);
    if (status >= 0 && begins && !good(g, g->f.leave(g->instance))) {
        status = fail(g, SE3D_ERR_INVALID_ARGUMENT, problem, "its initialization has failed");
    }
    g->time = time;
    return status;
}

/* All are told of the model as it is before any acts on it: their order does not matter. */
se3d_status se3di_guests_meet(se3di_guests *guests, se3di_sample *sample, double time,
                              char problem[SE3DI_GUEST_PROBLEM])
{
    se3d_status status = SE3D_OK;
    const se3di_floats host = se3di_floats_set();
    for (size_t k = 0; k < guests->count && status >= 0; ++k) {
        if (is_due(&guests->list[k], time)) {
            status = hear(&guests->list[k], sample, time, problem);
        }
    }
    for (size_t k = 0; k < guests->count && status >= 0; ++k) {
        guest *g = &guests->list[k];
        if (is_due(g, time)) {
            status = act(guests, g, problem);
            g->points += 1.0;
        }
    }
    se3di_floats_restore(host);
    guests->has_failed = status < 0;
    return status;
}

/* ---- states -----------------------------------------------------------------------------------*/

/* Bytes of a unit that is open, in memory of the pool. */
static bool write_state(guest *g, se3di_iopool *pool, const unsigned char **bytes, size_t *size)
{
    void *state = NULL;
    unsigned char *made = NULL;
    bool went = good(g, g->f.get_state(g->instance, &state));
    const bool has_state = went;
    went = went && good(g, g->f.state_size(g->instance, state, size)) && *size < STATE_MOST;
    if (went) {
        made = se3di_iopool_alloc(pool, *size + 1);
        went = made && good(g, g->f.write_state(g->instance, state, made, *size));
    }
    if (has_state && g->worst < FATAL) {
        went = good(g, g->f.free_state(g->instance, &state)) && went;
    }
    *bytes = made;
    return went;
}

static bool read_state(guest *g, const unsigned char *bytes, size_t size)
{
    void *state = NULL;
    bool went = good(g, g->f.read_state(g->instance, bytes, size, &state));
    const bool has_state = went;
    went = went && good(g, g->f.set_state(g->instance, state));
    if (has_state && g->worst < FATAL) {
        went = good(g, g->f.free_state(g->instance, &state)) && went;
    }
    return went;
}

/* One way through what is kept of a unit. */
static void pack(guest *g, se3di_coder *p, const unsigned char **bytes, size_t *size)
{
    uint64_t token =
        se3di_hash_bytes(SE3DI_HASH_START, g->description.token, strlen(g->description.token));
    const uint64_t expected = token;
    se3di_code_word(p, &token);
    p->failed = p->failed || token != expected;
    se3di_code_numbers(p, &g->time, 1);
    se3di_code_numbers(p, &g->points, 1);
    se3di_code_numbers(p, g->said, g->entry->output_count);
    se3di_code_numbers(p, g->places, 2 * g->entry->output_count);
    se3di_pack_bytes(p, bytes, size);
}

static void pack_all(se3di_guests *guests, se3di_coder *p, const unsigned char **bytes,
                     size_t *sizes)
{
    for (size_t k = 0; k < guests->count; ++k) {
        pack(&guests->list[k], p, &bytes[k], &sizes[k]);
    }
}

se3d_status se3di_guests_write(se3di_guests *guests, se3di_iopool *pool,
                               const unsigned char **bytes, size_t *size,
                               char problem[SE3DI_GUEST_PROBLEM])
{
    *bytes = NULL;
    *size = 0;
    if (!guests) {
        return SE3D_OK;
    }
    const unsigned char **states = se3di_iopool_array(pool, guests->count + 1, sizeof *states);
    size_t *sizes = se3di_iopool_array(pool, guests->count + 1, sizeof *sizes);
    for (size_t k = 0; k < guests->count && states && sizes; ++k) {
        guest *g = &guests->list[k];
        if (g->worst >= FAILED || !write_state(g, pool, &states[k], &sizes[k])) {
            return fail(g, SE3D_ERR_INVALID_ARGUMENT, problem, "its state cannot be written");
        }
    }
    se3di_coder measure = {.size = SIZE_MAX};
    unsigned char *made = NULL;
    if (states && sizes) {
        pack_all(guests, &measure, states, sizes);
        made = se3di_iopool_alloc(pool, measure.at);
    }
    if (!made) {
        snprintf(problem, SE3DI_GUEST_PROBLEM, "out of memory");
        return SE3D_ERR_NO_MEMORY;
    }
    se3di_coder p = {.out = made, .size = measure.at};
    pack_all(guests, &p, states, sizes);
    *bytes = made;
    *size = p.at;
    return SE3D_OK;
}

/* What acted at the last point acts again. The state of the system is put back afterwards. */
static se3d_status act_again(const se3d_model *model, const guest *g, char *problem)
{
    for (size_t k = 0; k < g->entry->output_count; ++k) {
        const se3di_guest_output *o = &g->entry->outputs[k];
        const se3d_function rate = model->elements[o->index].rate;
        const se3d_status status =
            rate.index1 ? se3di_rate_put_place(model, rate, g->places[2 * k], g->places[2 * k + 1],
                                               g->said[k])
                        : se3di_element_set(model, o->index, o->component, g->said[k]);
        if (status < 0) {
            return fail(g, status, problem, se3d_system_get_error(model->system));
        }
    }
    return SE3D_OK;
}

se3d_status se3di_guests_read(se3di_guests *guests, const unsigned char *bytes, size_t size,
                              char problem[SE3DI_GUEST_PROBLEM])
{
    se3di_coder p = {.in = bytes, .size = size};
    for (size_t k = 0; guests && k < guests->count; ++k) {
        guest *g = &guests->list[k];
        const unsigned char *state = NULL;
        size_t state_size = 0;
        pack(g, &p, &state, &state_size);
        if (p.failed || !(g->points > 0.0)) {
            return fail(g, SE3D_ERR_STATE, problem, "the checkpoint is of another unit");
        }
        if (!good(g, g->f.leave(g->instance)) || !read_state(g, state, state_size)) {
            return fail(g, SE3D_ERR_STATE, problem, "it refuses the state in the checkpoint");
        }
        const se3d_status status = act_again(guests->model, g, problem);
        if (status < 0) {
            return status;
        }
    }
    return SE3D_OK;
}
