/* SPDX-License-Identifier: BSD-3-Clause */
/* Outputs of a model: how often they are written, and what one can ask of them. */
#include "io/channel/output.h"

#include <math.h>
#include <string.h>

#include "io/base/file.h"
#include "io/base/sized.h"
#include "io/channel/channel.h"
#include "io/channel/sample.h"
#include "io/model/model.h"

double se3di_output_count_rows(const se3di_output_entry *output,
                               const se3di_analysis_entry *analysis, double *every)
{
    const double duration = analysis->analysis.duration;
    *every = output->every > 0.0           ? output->every
             : analysis->solver.step > 0.0 ? analysis->solver.step
                                           : duration / 500.0;
    return duration > 0.0 ? ceil(duration / *every - 1e-6) : 0.0;
}

size_t se3d_model_count_outputs(const se3d_model *model)
{
    return model ? model->output_count : 0;
}

se3d_status se3d_model_get_output_sized(const se3d_model *model, size_t index,
                                        se3d_model_output *output, size_t size)
{
    if (!model || !output) {
        return SE3D_ERR_NULL;
    }
    if (index >= model->output_count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3d_model_output full = {.file = model->outputs[index].file,
                                    .every = model->outputs[index].every,
                                    .channel_count = model->outputs[index].count};
    return se3di_io_give(output, size, &full, sizeof full);
}

se3d_status se3d_model_get_channel(const se3d_model *model, size_t output, size_t k,
                                   const char **name)
{
    if (!model || !name) {
        return SE3D_ERR_NULL;
    }
    if (output >= model->output_count || k >= model->outputs[output].count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    *name = model->outputs[output].channels[k].name;
    return SE3D_OK;
}

se3d_status se3d_model_get_channel_value(const se3d_model *model, size_t output, size_t k,
                                         const se3d_solver_stats *stats, double value[4],
                                         size_t *width)
{
    if (!model || !value || !width) {
        return SE3D_ERR_NULL;
    }
    if (output >= model->output_count || k >= model->outputs[output].count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_channel *channel = &model->outputs[output].channels[k];
    *width = se3di_channel_get_width(channel);
    se3di_sample sample;
    se3di_sample_init(&sample, model->system, &model->pool.allocator);
    sample.stats = stats;
    const se3d_status status = se3di_channel_eval(channel, &sample, value);
    se3di_sample_destroy(&sample);
    return status;
}

se3di_output_format se3di_output_get_format(const se3di_output_entry *output)
{
    const char *ending = strrchr(output->file, '.');
    if (!ending || output->vtk) {
        return SE3DI_OUTPUT_CSV;
    }
    if (se3di_file_is_hdf5(output->file)) {
        return SE3DI_OUTPUT_HDF5;
    }
    const bool vtk = strcmp(ending, ".vtp") == 0 || strcmp(ending, ".vti") == 0 ||
                     strcmp(ending, ".vtkhdf") == 0;
    return output->average && vtk ? SE3DI_OUTPUT_VTK : SE3DI_OUTPUT_CSV;
}
