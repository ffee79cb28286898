/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files of the public layer share: the system itself and the checks of arguments. Every
 * check records a message that names the value, the place and what is allowed. */
#ifndef SE3DI_SYSTEM_INTERNAL_H
#define SE3DI_SYSTEM_INTERNAL_H

#include "base/busy.h"
#include "base/floats.h"
#include "base/log.h"
#include "base/pending.h"
#include "base/sized.h"
#include "model/model.h"
#include "se3d/se3d.h"

struct se3d_system {
    se3di_model model;
    se3di_error error; /* of the last public call that failed */
    se3di_error found; /* of the work under way: it may be mended, and is no call's then */
    se3di_logger log;
    se3di_busy busy;                      /* the model points to it, */
    se3di_pending pending;                /* and to this */
    se3di_floats host;                    /* how the host of the call at work rounds */
    struct se3d_solver *solvers;          /* that live, in a chain */
    struct se3d_coordinates *coordinates; /* that live, in a chain */
    struct se3d_particles *copies;        /* clones of particle sets that live, in a chain */
    int32_t kept;                         /* its owner alone may destroy it */
    int32_t reserved;
};

/* Record an error on the system, log it, and return its status. */
#define SE3DI_FAIL(system, ...)                                                                    \
    se3di_log_error(&(system)->error, se3di_error_set(&(system)->error, __VA_ARGS__))

/* The same about an argument or a member `field`, with which the message begins. */
#define SE3DI_FAIL_OF(system, field, ...)                                                          \
    se3di_log_error(&(system)->error, se3di_error_set_of(&(system)->error, field, __VA_ARGS__))

/* What a public function that changes something begins with: `system` is not NULL, and not at work
 * unless with what allows `most`. A refusal leaves a message that names `function`. */
se3d_status se3di_enter(se3d_system *system, se3di_busy_level most, const char *function);
/* The same, but what the last step has left to be computed (base/pending.h) is left still: the call
 * changes nothing that it depends on. */
se3d_status se3di_enter_past(se3d_system *system, se3di_busy_level most, const char *function);
/* It changes the structure, or works for long: not from callbacks. */
#define SE3DI_EDIT(system) SE3DI_TRY(se3di_enter(system, SE3DI_BUSY_FREE, __func__))
/* It creates an element, whose handle is null until it exists. */
#define SE3DI_CREATE(system, handle)                                                               \
    do {                                                                                           \
        if (handle) {                                                                              \
            (handle)->index1 = (handle)->generation = 0;                                           \
        }                                                                                          \
        SE3DI_EDIT(system);                                                                        \
        SE3DI_TRY(se3di_check_pointer(system, #handle, handle));                                   \
    } while (0)
/* It sets values or the state: also from the callbacks of events. */
#define SE3DI_SET(system) SE3DI_TRY(se3di_enter(system, SE3DI_BUSY_EVENT, __func__))
/* The same through an owner that belongs to a system (a solver, particles). */
#define SE3DI_EDIT_OF(owner)                                                                       \
    do {                                                                                           \
        SE3DI_OWNED(owner);                                                                        \
        SE3DI_EDIT((owner)->system);                                                               \
    } while (0)
#define SE3DI_SET_OF(owner)                                                                        \
    do {                                                                                           \
        SE3DI_OWNED(owner);                                                                        \
        SE3DI_SET((owner)->system);                                                                \
    } while (0)
/* The same with se3di_enter_past. */
#define SE3DI_EDIT_PAST_OF(owner)                                                                  \
    do {                                                                                           \
        SE3DI_OWNED(owner);                                                                        \
        SE3DI_TRY(se3di_enter_past((owner)->system, SE3DI_BUSY_FREE, __func__));                   \
    } while (0)
/* `owner` is not NULL and its system lives. */
#define SE3DI_OWNED(owner)                                                                         \
    do {                                                                                           \
        if (!(owner) || !(owner)->system) {                                                        \
            return (owner) ? SE3D_ERR_STATE : SE3D_ERR_NULL;                                       \
        }                                                                                          \
    } while (0)

/* Around the work of a call that evaluates callbacks or solves, which may record its failures in
 * `found`; the end makes that of `status` the call's, and passes the status on. */
void se3di_work_begin(se3d_system *system);
se3d_status se3di_work_end(se3d_system *system, se3d_status status);

/* Around what a reader evaluates by callbacks. @return OK, STATE (from within one). */
se3d_status se3di_read_begin(const se3d_system *system, se3di_reading *reading);
/* Passes `status` on. */
se3d_status se3di_read_end(se3di_reading *reading, se3d_status status);
/* Whether the state is one that may be copied: not that of a trial. */
int se3di_is_settled(const se3d_system *system);

/* Accelerations and multipliers are there.
 * @return OK, or STATE: the last run was asked for the motion alone, without them. */
static inline se3d_status se3di_check_solved(const se3d_system *system)
{
    se3di_pending_complete(system->model.pending);
    return system->model.settled & SE3DI_LACKING ? SE3D_ERR_STATE : SE3D_OK;
}

/* `value` is finite; `what` names it ("mass"). */
se3d_status se3di_check_finite(se3d_system *system, const char *what, double value);
/* All of `values` are finite: "position[1] = nan, must be finite". */
se3d_status se3di_check_finites(se3d_system *system, const char *what, const double *values,
                                int count);
/* `value` is finite and in [low, high]. */
se3d_status se3di_check_range(se3d_system *system, const char *what, double value, double low,
                              double high);
/* Rows of a frame: x along `forward` as far as that is not along `up`, y to the left, z along `up`,
 * which `what` names. Axes that have been written are taken as they are. */
se3d_status se3di_check_axes(se3d_system *system, const double forward[3], const char *what,
                             const double up[3], double axes[9]);
/* `values` is finite and not zero; writes the unit vector. */
se3d_status se3di_check_direction(se3d_system *system, const char *what, const double values[3],
                                  double unit[3]);
/* `p` has unit length to 1e-6; writes it normalised. */
se3d_status se3di_check_orientation(se3d_system *system, const char *what, const double p[4],
                                    double unit[4]);
/* A mass > 0 and the inertia of some body. */
se3d_status se3di_check_mass(se3d_system *system, double mass, const double inertia[6]);
/* `pointer` is not NULL. */
se3d_status se3di_check_pointer(se3d_system *system, const char *what, const void *pointer);
/* A def struct: copies its struct_size bytes over the defaults already in `copy`; fails if def is
 * NULL, struct_size is too small, or something is set beyond what this library knows. */
se3d_status se3di_check_def(se3d_system *system, const char *what, const void *def, void *copy,
                            size_t full_size);

/* What every public _def_init does: the first `size` bytes of `defaults` (of `full` bytes), zeros
 * beyond them. Nothing happens if def is NULL or too small for its struct_size. */
void se3di_def_init(void *def, size_t size, const void *defaults, size_t full);

/* Dense index of a handle: se3di_find_body(system, "body", body, &index) and its like; fails with
 * STALE_HANDLE and a message. Of elements whose handles name nothing else; a state is a force. */
#define SE3DI_PLAIN_LIST(X) X(body) X(marker) X(constraint) X(material) X(wheel) X(road)
#define SE3DI_FIND_PLAIN(kind)                                                                     \
    se3d_status se3di_find_##kind(se3d_system *system, const char *what, se3d_##kind handle,       \
                                  uint32_t *index);
SE3DI_PLAIN_LIST(SE3DI_FIND_PLAIN)
se3d_status se3di_find_force(se3d_system *system, const char *what, se3d_force force,
                             uint32_t *index);
se3d_status se3di_find_state(se3d_system *system, const char *what, se3d_state state,
                             uint32_t *index);
/* A null handle gives -1; a function of other than `variables` variables is an error. */
se3d_status se3di_find_law(se3d_system *system, const char *what, se3d_function function,
                           uint32_t variables, int32_t *index);
se3d_status se3di_find_function(se3d_system *system, const char *what, se3d_function function,
                                uint32_t variables, int32_t *index);

/* The audit of energy over a change of values: what it makes of the energies is work of actuators.
 * Before the change: the energy that it may change (0 if nothing is audited, not a number if
 * a callback fails: then the audit begins anew); after it. Of a force element alone; of bodies,
 * gravity and all elements; of contacts. */
double se3di_audit_force(const se3di_model *model, const se3di_force *force);
void se3di_audit_force_change(se3di_model *model, const se3di_force *force, double before);
double se3di_audit_forces(const se3di_model *model);
void se3di_audit_change(se3di_model *model, double before);
double se3di_audit_contacts(const se3di_model *model);
void se3di_audit_contacts_change(se3di_model *model, double before);

/* Say why an element was not added: no memory, or another kind of element has its name. */
se3d_status se3di_fail_added(se3d_system *system, se3d_status added, const char *what);

/* `name` (not NULL) is well formed. */
se3d_status se3di_check_name(se3d_system *system, const char *name);
/* `name` is well formed and free among the elements of `slots`, of which it would be another
 * `what`; markers: among those of `owner`, others: 0. NULL always is. */
se3d_status se3di_check_new_name(se3d_system *system, const se3di_slots *slots, uint32_t owner,
                                 const char *what, const char *name);
/* Readers record no message. SLOTS are those of a kind of elements, NULL if `system` is; `handle`
 * points to a public one, which is null on failure.
 * @return OK, NULL (slots, handle, name, out), STALE_HANDLE, INVALID_ARGUMENT (no such element) */
#define SE3DI_SLOTS(system, kind) ((system) ? &(system)->model.kind##_slots : NULL)
se3d_status se3di_read_named(const se3di_slots *slots, const char *name, void *handle);
se3d_status se3di_read_handle(const se3di_slots *slots, size_t index, void *handle);
/* The dense index of an element, to write something of it to `out`. */
se3d_status se3di_read_index(const se3di_slots *slots, se3di_handle handle, const void *out,
                             uint32_t *index);

/* The end of a getter of a name: *name = `own`, "" for none, NULL if nothing was found. */
static inline se3d_status se3di_give_name(se3d_status found, const char *own, const char **name)
{
    if (name) {
        *name = found < 0 ? NULL : own ? own : "";
    }
    return found;
}

/* The end of what creates an element: its handle to the public `handle`, or "no memory for a ...".
 * @return OK, NO_MEMORY */
se3d_status se3di_give_created(se3d_system *system, se3d_status added, const char *what,
                               se3di_handle created, void *handle);

/* A public handle as an internal one. */
#define SE3DI_HANDLE(handle) ((se3di_handle){(handle).index1, (handle).generation})

#endif
