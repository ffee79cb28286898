/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: linearisation and modes. */
#include "se3d/modes.h"

#include "analysis/modes_follow.h"
#include "math/elementary.h"
#include "math/vec3.h"
#include "system/system_internal.h"

#include <math.h>
#include <string.h>

enum { LOWEST_MAX = 1000000 };

#define TWO_PI 6.283185307179586476925286766559

struct se3d_modes {
    se3di_modes of;
};

void se3d_modes_def_init(se3d_modes_def *def, size_t size)
{
    se3d_modes_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

void se3d_modes_destroy(se3d_modes *modes)
{
    if (modes) {
        const se3d_allocator allocator = modes->of.allocator;
        se3di_modes_destroy(&modes->of);
        se3di_free(&allocator, modes, 1, sizeof *modes);
    }
}

/* A checked input or output; `what` names it, with room for the member. */
static se3d_status take_port(se3d_system *system, const char *what[3], se3d_body body,
                             const double point[3], const double direction[3],
                             se3di_modes_port *port)
{
    SE3DI_TRY(se3di_find_body(system, what[0], body, &port->body));
    SE3DI_TRY(se3di_check_finites(system, what[1], point, 3));
    se3di_copy(point, port->point);
    return se3di_check_direction(system, what[2], direction, port->direction);
}

/* Everything of the def is valid; `ports` and `quantity` have room for it. */
static se3d_status take_def(se3d_system *system, const se3d_modes_def *def, se3di_modes_port *ports,
                            int32_t *quantity)
{
    const char *in_names[3] = {"inputs[].body", "inputs[].point", "inputs[].direction"};
    const char *out_names[3] = {"outputs[].body", "outputs[].point", "outputs[].direction"};
    for (size_t k = 0; k < def->input_count; ++k) {
        const se3d_modes_input *in = &def->inputs[k];
        SE3DI_TRY(take_port(system, in_names, in->body, in->point, in->direction, &ports[k]));
        ports[k].turns = in->is_torque != 0;
    }
    for (size_t k = 0; k < def->output_count; ++k) {
        const se3d_modes_output *out = &def->outputs[k];
        se3di_modes_port *port = &ports[def->input_count + k];
        SE3DI_TRY(take_port(system, out_names, out->body, out->point, out->direction, port));
        if (out->quantity < SE3D_MODES_POSITION ||
            out->quantity > SE3D_MODES_ANGULAR_ACCELERATION) {
            return SE3DI_FAIL_OF(system, "outputs", SE3D_ERR_INVALID_ARGUMENT,
                                 "[%zu].quantity = %d, must be one of se3d_modes_quantity", k,
                                 (int)out->quantity);
        }
        port->turns = out->quantity >= SE3D_MODES_ROTATION;
        quantity[k] = out->quantity;
    }
    return SE3D_OK;
}

static se3d_status linearise(se3d_system *system, const se3d_modes_def *def,
                             const se3di_modes_port *ports, const int32_t *quantity,
                             se3d_modes **out)
{
    se3d_modes *modes = se3di_alloc(&system->model.allocator, 1, sizeof *modes);
    if (!modes) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for modes");
    }
    se3di_work_begin(system);
    const se3d_status status = se3di_work_end(
        system, se3di_modes_init(&modes->of, &system->model, &system->found, def->input_count,
                                 def->output_count, ports, quantity, def->lowest));
    if (status < 0) {
        se3di_free(&system->model.allocator, modes, 1, sizeof *modes);
        return status;
    }
    *out = modes;
    return SE3D_OK;
}

/* With room for ports and quantities. */
static se3d_status create(se3d_system *system, const se3d_modes_def *def, se3d_modes **out)
{
    const se3d_allocator *allocator = &system->model.allocator;
    const size_t count = def->input_count + def->output_count;
    se3di_modes_port *ports = se3di_alloc(allocator, count, sizeof *ports);
    int32_t *quantity = se3di_alloc(allocator, def->output_count, sizeof *quantity);
    se3d_status status = ports && quantity
                             ? take_def(system, def, ports, quantity)
                             : SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for modes");
    if (status >= 0) {
        status = linearise(system, def, ports, quantity, out);
    }
    se3di_free(allocator, ports, count, sizeof *ports);
    se3di_free(allocator, quantity, def->output_count, sizeof *quantity);
    return status;
}

se3d_status se3d_modes_create(se3d_system *system, const se3d_modes_def *def, se3d_modes **out)
{
    if (out) {
        *out = NULL;
    }
    SE3DI_EDIT(system);
    SE3DI_TRY(se3di_check_pointer(system, "out", out));
    se3d_modes_def full = se3d_modes_def_default();
    if (def) {
        SE3DI_TRY(se3di_check_def(system, "modes def", def, &full, sizeof full));
    }
    if ((full.input_count > 0 && !full.inputs) || (full.output_count > 0 && !full.outputs)) {
        return SE3DI_FAIL(system, SE3D_ERR_NULL, "inputs or outputs is NULL");
    }
    if (full.lowest > LOWEST_MAX || (full.lowest > 0 && full.input_count + full.output_count > 0)) {
        return SE3DI_FAIL_OF(system, "lowest", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be 0 with inputs or outputs, which need all modes, and "
                             "at most %d",
                             full.lowest, LOWEST_MAX);
    }
    return create(system, &full, out);
}

size_t se3d_modes_count(const se3d_modes *modes)
{
    return modes ? (size_t)modes->of.eigen.count : 0;
}

size_t se3d_modes_count_freedoms(const se3d_modes *modes)
{
    return modes ? modes->of.f : 0;
}

se3d_status se3d_modes_get_eigenvalue_sized(const se3d_modes *modes, size_t k,
                                            se3d_eigenvalue *eigenvalue, size_t size)
{
    if (eigenvalue) {
        (void)se3di_sized_give(eigenvalue, size, &(se3d_eigenvalue){0.0, 0.0, 0.0, 0.0},
                               sizeof *eigenvalue);
    }
    if (!modes || !eigenvalue) {
        return SE3D_ERR_NULL;
    }
    if (k >= (size_t)modes->of.eigen.count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_floats host = se3di_floats_set();
    const double modulus = se3di_hypot(modes->of.eigen.re[k], modes->of.eigen.im[k]);
    const se3d_eigenvalue full = {.real = modes->of.eigen.re[k],
                                  .imaginary = modes->of.eigen.im[k],
                                  .frequency = modulus / TWO_PI,
                                  .damping = modulus > 0.0 ? 0.0 - modes->of.eigen.re[k] / modulus
                                                           : 0.0 /* never -0 */};
    se3di_floats_restore(host);
    return se3di_sized_give(eigenvalue, size, &full, sizeof full);
}

se3d_status se3d_modes_get_shape(const se3d_modes *modes, size_t k, size_t body, double real[6],
                                 double imaginary[6])
{
    double unused[6];
    real = real ? real : unused;
    imaginary = imaginary ? imaginary : unused;
    memset(real, 0, 6 * sizeof *real);
    memset(imaginary, 0, 6 * sizeof *imaginary);
    if (!modes) {
        return SE3D_ERR_NULL;
    }
    if (k >= (size_t)modes->of.eigen.count || body >= modes->of.bodies) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    double re[6], im[6];
    const se3di_floats host = se3di_floats_set();
    se3di_modes_shape(&modes->of, k, body, re, im);
    se3di_floats_restore(host);
    memcpy(real, re, sizeof re);
    memcpy(imaginary, im, sizeof im);
    return SE3D_OK;
}

se3d_status se3d_modes_get_matrix(const se3d_modes *modes, int32_t matrix, size_t *rows,
                                  size_t *columns, double *values, size_t capacity)
{
    if (rows) {
        *rows = 0;
    }
    if (columns) {
        *columns = 0;
    }
    if (!modes || !rows || !columns) {
        return SE3D_ERR_NULL;
    }
    if (matrix < SE3D_MODES_A || matrix > SE3D_MODES_BASIS) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    size_t size[2];
    se3di_modes_size(&modes->of, matrix, size);
    *rows = modes->of.lowest > 0 ? 0 : size[0];
    *columns = modes->of.lowest > 0 ? 0 : size[1];
    if (values && capacity < *rows * *columns) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_floats host = se3di_floats_set();
    for (size_t k = 0; values && k < *rows * *columns; ++k) {
        values[k] = se3di_modes_entry(&modes->of, matrix, k / *columns, k % *columns);
    }
    se3di_floats_restore(host);
    return SE3D_OK;
}

se3d_status se3d_modes_get_transfer(const se3d_modes *modes, size_t input, size_t output,
                                    double frequency, double *real, double *imaginary)
{
    if (real) {
        *real = 0.0;
    }
    if (imaginary) {
        *imaginary = 0.0;
    }
    if (!modes || !real || !imaginary) {
        return SE3D_ERR_NULL;
    }
    if (input >= modes->of.inputs || output >= modes->of.outputs || !isfinite(frequency)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_floats host = se3di_floats_set();
    double h[2];
    const se3d_status status =
        se3di_modes_transfer(&modes->of, input, output, TWO_PI * frequency, h);
    se3di_floats_restore(host);
    *real = h[0];
    *imaginary = h[1];
    return status;
}

se3d_status se3d_modes_follow(const se3d_modes *modes, se3d_system *system, size_t count,
                              double *real, double *imaginary)
{
    SE3DI_EDIT(system);
    SE3DI_TRY(se3di_check_pointer(system, "modes", modes));
    SE3DI_TRY(se3di_check_pointer(system, "real", real));
    SE3DI_TRY(se3di_check_pointer(system, "imaginary", imaginary));
    if (count != (size_t)modes->of.eigen.count) {
        return SE3DI_FAIL_OF(system, "count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be the number of the modes, %d", count,
                             (int)modes->of.eigen.count);
    }
    for (size_t k = 0; k < count; ++k) {
        real[k] = imaginary[k] = (double)NAN;
    }
    se3di_work_begin(system);
    return se3di_work_end(
        system, se3di_modes_follow(&modes->of, &system->model, &system->found, real, imaginary));
}
