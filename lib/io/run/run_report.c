/* SPDX-License-Identifier: BSD-3-Clause */
/* What a run tells of itself. */
#include <string.h>

#include "io/base/sized.h"
#include "io/run/runner.h"

void se3d_run_options_init(se3d_run_options *options, size_t size)
{
    if (options && size >= sizeof options->struct_size) {
        memset(options, 0, size);
        options->struct_size = size;
    }
}

void se3d_run_destroy(se3d_run *run)
{
    if (run) {
        se3di_iopool pool = run->pool; /* the run itself lies in it */
        se3di_iopool_destroy(&pool);
    }
}

size_t se3d_run_count_analyses(const se3d_run *run)
{
    return run ? run->analysis_count : 0;
}

se3d_status se3d_run_get_analysis_sized(const se3d_run *run, size_t index,
                                        se3d_run_analysis *analysis, size_t size)
{
    return SE3DI_IO_GIVE_ENTRY(analysis, size, run, index, analysis_count, analyses[index]);
}

size_t se3d_run_count_particles(const se3d_run *run)
{
    return run ? run->particles_count : 0;
}

se3d_status se3d_run_get_particles_sized(const se3d_run *run, size_t index,
                                         se3d_run_particles *particles, size_t size)
{
    return SE3DI_IO_GIVE_ENTRY(particles, size, run, index, particles_count, particles[index]);
}

size_t se3d_run_count_files(const se3d_run *run)
{
    return run ? run->file_count : 0;
}

se3d_status se3d_run_get_file_sized(const se3d_run *run, size_t index, se3d_run_file *file,
                                    size_t size)
{
    return SE3DI_IO_GIVE_ENTRY(file, size, run, index, file_count, files[index]);
}

size_t se3d_run_count_events(const se3d_run *run)
{
    return run ? run->events.count : 0;
}

se3d_status se3d_run_get_event_sized(const se3d_run *run, size_t index, se3d_run_event *event,
                                     size_t size)
{
    return SE3DI_IO_GIVE_ENTRY(event, size, run, index, events.count, events.list[index]);
}

size_t se3d_run_count_summaries(const se3d_run *run)
{
    return run ? run->summary_count : 0;
}

se3d_status se3d_run_get_summary_sized(const se3d_run *run, size_t index, se3d_run_summary *summary,
                                       size_t size)
{
    return SE3DI_IO_GIVE_ENTRY(summary, size, run, index, summary_count, summaries[index]);
}
