/* SPDX-License-Identifier: BSD-3-Clause */
/* The bench's driver of MuJoCo, by its public header. METHOD: euler, rk4; for four-bars
 * rk4/T/S closes the loops by `connect` with time constant T steps and impedance S. */
#define _POSIX_C_SOURCE 200809L
#include "../driver.h"

#include <mujoco/mujoco.h>
#include <stdarg.h>
#include <stdlib.h>

typedef struct text {
    char *data;
    size_t size, capacity;
} text;

#define PART 60 /* bars in a file */

static void add(text *t, const char *format, ...)
{
    va_list list;
    if (t->capacity - t->size < 1024) {
        t->capacity = 2 * t->capacity + 4096;
        t->data = realloc(t->data, t->capacity);
        if (!t->data) {
            exit(1);
        }
    }
    va_start(list, format);
    t->size += (size_t)vsnprintf(t->data + t->size, 1024, format, list);
    va_end(list);
}

/* Bars first .. n - 1, nested; the XML reader takes about a hundred levels in one file, so that
 * longer chains go on in another one. */
static void write_chain(text *t, int first, int n, int ball)
{
    int end = first + PART < n ? first + PART : n;
    for (int k = first; k < end; ++k) {
        add(t, "<body pos='%d 0 0'>", k > 0);
        add(t, ball ? "<joint type='ball'/>" : "<joint type='hinge' axis='0 0 1'/>");
        add(t, "<inertial pos='.5 0 0' mass='19.5' diaginertia='.008125 1.6290625 1.6290625'/>");
    }
    if (end < n) {
        add(t, "<include file='%d.xml'/>", end);
    }
    for (int k = first; k < end; ++k) {
        add(t, "</body>");
    }
}

/* Bar k carries coupler k + 1, whose end is tied to bar k + 1. */
static void write_fourbars(text *t, int n)
{
    for (int k = 0; k <= n; ++k) {
        add(t, "<body name='b%d' pos='%d 0 0'><joint type='hinge' axis='0 0 1'/>", k, k);
        add(t, "<inertial pos='0 .5 0' mass='1' diaginertia='%.17g 1e-3 %.17g'/>", 1 / 12.0,
            1 / 12.0);
        if (k < n) {
            add(t, "<body name='c%d' pos='0 1 0'><joint type='hinge' axis='0 0 1'/>", k);
            add(t, "<inertial pos='.5 0 0' mass='1' diaginertia='1e-3 %.17g %.17g'/></body>",
                1 / 12.0, 1 / 12.0);
        }
        add(t, "</body>");
    }
}

static void write_ties(text *t, int n)
{
    add(t, "<equality>");
    for (int k = 0; k < n; ++k) {
        add(t, "<connect body1='c%d' body2='b%d' anchor='1 0 0'/>", k, k + 1);
    }
    add(t, "</equality>");
}

static text write_model(char kind, int n)
{
    text t = {NULL, 0, 0};
    add(&t,
        "<mujoco><option gravity='0 -9.81 0' solver='Newton' iterations='50' "
        "tolerance='1e-14'><flag contact='disable' %s/></option>",
        kind == 'f' ? "refsafe='disable'" : "constraint='disable'");
    add(&t, "<worldbody>");
    if (kind == 'f') {
        write_fourbars(&t, n);
    } else if (kind == 'p') {
        add(&t, "<body><joint type='hinge' axis='0 0 1'/>"
                "<inertial pos='-1 0 0' mass='1' diaginertia='4e-9 4e-9 4e-9'/></body>");
    } else {
        write_chain(&t, 0, n, kind == 'b');
    }
    add(&t, "</worldbody>");
    if (kind == 'f') {
        write_ties(&t, n);
    }
    add(&t, "</mujoco>");
    return t;
}

static void add_file(mjVFS *files, const char *name, text *t)
{
    mj_makeEmptyFileVFS(files, name, (int)t->size);
    memcpy(files->filedata[mj_findFileVFS(files, name)], t->data, t->size);
    free(t->data);
}

static mjModel *load(char kind, int n, bench_answer *answer)
{
    static mjVFS files;
    char error[160] = "";
    text t = write_model(kind, n);
    mj_defaultVFS(&files);
    add_file(&files, "0.xml", &t);
    for (int k = PART; k < n && (kind == 'a' || kind == 'b'); k += PART) {
        text part = {NULL, 0, 0};
        char name[24];
        snprintf(name, sizeof name, "%d.xml", k);
        add(&part, "<mujoco>");
        write_chain(&part, k, n, kind == 'b');
        add(&part, "</mujoco>");
        add_file(&files, name, &part);
    }
    mjModel *model = mj_loadXML("0.xml", &files, error, sizeof error);
    mj_deleteVFS(&files);
    if (!model) {
        bench_fail(answer, error);
    }
    return model;
}

static void start(const bench_request *request, const mjModel *model, mjData *data)
{
    mj_resetData(model, data);
    if (request->kind == 'b') {
        data->qvel[0] = 1.0; /* relative to the bar before: the others do not turn */
    }
    for (int k = 0; request->kind == 'f' && k < model->nv; ++k) {
        data->qvel[k] = k % 2 == 0 ? -1.0 : 1.0;
    }
    mj_forward(model, data);
}

/* Computed between the timed parts only. */
static double energy(mjModel *model, mjData *data)
{
    model->opt.enableflags |= mjENBL_ENERGY;
    mj_forward(model, data);
    model->opt.enableflags &= ~mjENBL_ENERGY;
    return data->energy[0] + data->energy[1];
}

static double gap(const mjModel *model, const mjData *data)
{
    double most = 0.0;
    for (int k = 0; k < data->nefc && model->neq > 0; ++k) {
        most = fmax(most, fabs(data->efc_pos[k]));
    }
    return most;
}

static void find_tip(const bench_request *request, const mjModel *model, const mjData *data,
                     double tip[3])
{
    int body = request->kind == 'f' || request->kind == 'p' ? 1 : model->nbody - 1;
    const double point[3] = {request->kind == 'p'   ? -1.0
                             : request->kind == 'f' ? 0.0
                                                    : 1.0,
                             request->kind == 'f', 0.0};
    const mjtNum *A = data->xmat + 9 * body;
    for (int k = 0; k < 3; ++k) {
        tip[k] = data->xpos[3 * body + k] + A[3 * k] * point[0] + A[3 * k + 1] * point[1];
    }
}

static void set_options(const bench_request *request, mjModel *model, double h)
{
    double T = 1.0, S = 0.9999;
    model->opt.timestep = h;
    model->opt.integrator = strncmp(request->method, "rk4", 3) == 0 ? mjINT_RK4 : mjINT_EULER;
    (void)sscanf(request->method, "rk4/%lf/%lf", &T, &S);
    for (int k = 0; k < model->neq; ++k) {
        model->eq_solref[mjNREF * k] = T * h;
        model->eq_solref[mjNREF * k + 1] = 1.0;
        model->eq_solimp[mjNIMP * k] = model->eq_solimp[mjNIMP * k + 1] = S;
    }
}

static void run(const bench_request *request, bench_answer *answer)
{
    static mjModel *model;
    static char kind;
    static int n;
    if (model && (kind != request->kind || n != request->n)) {
        mj_deleteModel(model);
        model = NULL;
    }
    if (!model && !(model = load(request->kind, request->n, answer))) {
        return;
    }
    kind = request->kind;
    n = request->n;
    long steps = bench_steps(request->duration, request->setting);
    set_options(request, model, request->duration / (double)steps);
    mjData *data = mj_makeData(model);
    start(request, model, data);
    double before = energy(model, data);
    long done = 0;
    for (int part = 1; part <= request->samples; ++part) {
        double begin = bench_clock();
        for (; done < steps * part / request->samples; ++done) {
            mj_step(model, data);
        }
        answer->seconds += bench_clock() - begin;
        bench_see(answer, energy(model, data) - before, gap(model, data));
    }
    find_tip(request, model, data, answer->tip);
    answer->steps = (double)steps;
    if (data->warning[mjWARN_BADQACC].number > 0 || !(fabs(answer->tip[0]) < 1e6)) {
        bench_fail(answer, "unstable");
    }
    mj_deleteData(data);
}

/* Warnings go nowhere: instability is an answer. */
static void ignore(const char *message)
{
    (void)message;
}

int main(void)
{
    mju_user_warning = ignore;
    return bench_serve(run);
}
