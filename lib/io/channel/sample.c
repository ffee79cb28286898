/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/channel/sample.h"

#include <string.h>

void se3di_sample_init(se3di_sample *sample, const se3d_system *system,
                       const se3d_allocator *allocator)
{
    memset(sample, 0, sizeof *sample);
    sample->system = system;
    se3di_iopool_init(&sample->pool, allocator);
    se3di_iopool_init(&sample->listing, allocator);
}

static void forget_contacts(se3di_sample *sample)
{
    se3di_iopool_destroy(&sample->listing);
    sample->contacts = (se3di_particle_contacts){NULL, 0};
    sample->contacts_state = 0;
}

void se3di_sample_destroy(se3di_sample *sample)
{
    forget_contacts(sample);
    se3di_iopool_destroy(&sample->pool);
}

void se3di_sample_renew(se3di_sample *sample, const se3d_solver_stats *stats)
{
    forget_contacts(sample);
    sample->stats = stats;
    ++sample->state;
}

static se3d_status list_contacts(se3di_sample *sample, const se3d_particles *set)
{
    se3d_particles_stats stats = {.steps = 0};
    const se3d_status status = se3d_particles_get_stats(set, &stats);
    size_t count = (size_t)stats.contacts;
    for (int tries = 0; tries < 2 && status >= 0; ++tries) {
        se3d_particles_contact *list =
            se3di_iopool_array(&sample->listing, count + 1, sizeof *list);
        if (!list) {
            return SE3D_ERR_NO_MEMORY;
        }
        if (se3d_particles_get_contacts(set, count, list) >= 0) {
            sample->contacts = (se3di_particle_contacts){list, count};
            return SE3D_OK;
        }
        count = se3d_particles_count_contacts(set);
    }
    return status < 0 ? status : SE3D_ERR_STATE;
}

se3d_status se3di_sample_list_contacts(se3di_sample *sample, const se3d_particles *set,
                                       se3di_particle_contacts *contacts)
{
    if (sample->state == 0 || sample->contacts_state != sample->state) {
        forget_contacts(sample);
        const se3d_status status = list_contacts(sample, set);
        if (status < 0) {
            return status;
        }
        sample->contacts_state = sample->state;
    }
    *contacts = sample->contacts;
    return SE3D_OK;
}

se3di_answer *se3di_sample_make(se3di_sample *sample, se3di_question question, size_t index)
{
    while (index >= sample->capacity[question]) {
        const size_t count = sample->capacity[question];
        se3di_answer *grown = se3di_iopool_grow(&sample->pool, sample->answers[question], count,
                                                &sample->capacity[question], sizeof *grown);
        if (!grown) {
            return NULL;
        }
        sample->answers[question] = grown;
    }
    return &sample->answers[question][index];
}
