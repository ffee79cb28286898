/* SPDX-License-Identifier: BSD-3-Clause */
/* What channels and files have asked of a system in one state: each question is answered once,
 * however many columns of however many files its answer has. */
#ifndef SE3D_IO_SAMPLE_H
#define SE3D_IO_SAMPLE_H

#include "io/channel/channel.h"

enum { SE3DI_ANSWER_NUMBERS = 22 };

typedef struct se3di_answer {
    uint64_t state;     /* that it is of; 0: none */
    uint32_t which;     /* of its numbers some has been asked for, if it is made of these alone, */
    uint32_t is_listed; /* of a tyre: it is among these */
    double numbers[SE3DI_ANSWER_NUMBERS];
} se3di_answer;

/* Contacts of particles, as the library lists them. */
typedef struct se3di_particle_contacts {
    const se3d_particles_contact *list;
    size_t count;
} se3di_particle_contacts;

/* Tyres that channels have asked about, in this order. */
enum { SE3DI_SAMPLE_TYRES = 16 };

typedef struct se3di_sample {
    const se3d_system *system;
    const se3d_solver_stats *stats; /* NULL: unknown */
    se3di_iopool pool;              /* of the answers, which are kept by their element */
    se3di_answer *answers[SE3DI_QUESTION_COUNT];
    size_t capacity[SE3DI_QUESTION_COUNT];
    uint64_t state;       /* number of the state, from 1; 0: nothing is kept */
    se3di_iopool listing; /* of the contacts of this state */
    se3di_particle_contacts contacts;
    uint64_t contacts_state;
    se3d_force tyres[SE3DI_SAMPLE_TYRES];
    size_t tyre_count;
} se3di_sample;

/* Answers are kept from the first se3di_sample_renew on; before it each question is asked anew. */
void se3di_sample_init(se3di_sample *sample, const se3d_system *system,
                       const se3d_allocator *allocator);
void se3di_sample_destroy(se3di_sample *sample);
/* The state of the system has changed. */
void se3di_sample_renew(se3di_sample *sample, const se3d_solver_stats *stats);
/* List the contacts of a set: in one pass over its forces if their number is that of the end of the
 * last step, which is usual. The list is valid until the state changes. */
se3d_status se3di_sample_list_contacts(se3di_sample *sample, const se3d_particles *set,
                                       se3di_particle_contacts *contacts);
/* A place for the answer to a question about element `index`, which is made if it is not there.
 * @return NULL: out of memory */
se3di_answer *se3di_sample_make(se3di_sample *sample, se3di_question question, size_t index);
static inline se3di_answer *se3di_sample_find(se3di_sample *sample, se3di_question question,
                                              size_t index)
{
    return index < sample->capacity[question] ? &sample->answers[question][index]
                                              : se3di_sample_make(sample, question, index);
}

#endif
