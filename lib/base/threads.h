/* SPDX-License-Identifier: BSD-3-Clause */
/* The threads that share work: those of OpenMP, or the caller alone. */
#ifndef SE3DI_BASE_THREADS_H
#define SE3DI_BASE_THREADS_H

/* In a parallel region: which thread this is, from 0, and how many there are. */
int se3di_threads_get_own(void);
int se3di_threads_count(void);

#endif
