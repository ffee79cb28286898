/* SPDX-License-Identifier: BSD-3-Clause */
/* Reports on the constraints of a system: rank, redundant equations, contradictions, freedoms.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_CHECK_H
#define SE3D_CHECK_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The counts of a report on the constraints. Set struct_size before the call. @since 0.1 */
typedef struct se3d_check_summary {
    size_t struct_size;
    size_t bodies;       /* movable */
    size_t equations;    /* scalar constraint equations, without normalisation */
    size_t rank;         /* independent ones */
    size_t redundant;    /* equations - rank */
    size_t freedoms;     /* 6 bodies - rank */
    int64_t gruebler;    /* 6 bodies - equations */
    size_t inconsistent; /* redundant equations that contradict the others */
} se3d_check_summary;

/* Analyse the constraints: rank, redundant equations with the ones they depend on,
 * contradictions, freedoms, bodies that nothing holds. Poses that do not fit are assembled for
 * the analysis, or those of least violation are analysed, and a message says so; the state of
 * the system does not change. Destroy the report before the allocator goes. @return OK,
 * INFO_REDUNDANT, NULL, NO_MEMORY, NOT_FINITE, CALLBACK. @since 0.1 */
SE3D_API se3d_status se3d_check_create(se3d_system *system, se3d_check **out);

/* Destroy a report; NULL is fine. @since 0.1 */
SE3D_API void se3d_check_destroy(se3d_check *check);

/* Get the counts of a report. Set summary->struct_size before the call. @return OK, NULL,
 * INVALID_ARGUMENT (struct_size). @since 0.1 */
SE3D_API se3d_status se3d_check_get_summary(const se3d_check *check, se3d_check_summary *summary);

/* Count the findings of a report. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_check_count_messages(const se3d_check *check);

/* Get a finding as a sentence: "B.cd_z duplicates A.cd_z, C.cd_z".
 * @param[in] k      from 0, below se3d_check_count_messages
 * @param[out] text  owned by the report
 * @return OK, NULL, INVALID_ARGUMENT (k).
 * @since 0.1 */
SE3D_API se3d_status se3d_check_get_message(const se3d_check *check, size_t k, const char **text);

/* Name the constraint equations that the present analysis leaves out because they are redundant to
 * within the digits of their data (axes 4e-6 rad off in a planar loop, say), with the violation of
 * each at the present state: "J3.dp1_a (off by 2.1e-06), J3.cd_z (off by 1e-06 m)", "" if there is
 * none. They are chosen at the start of an analysis, which returns INFO_REDUNDANT; their
 * multipliers are zero.
 * @param[out] text  [size] bytes, cut to fit
 * @param[in] size   > 0
 * @return OK, NULL, INVALID_ARGUMENT (size).
 * @since 0.1 */
SE3D_API se3d_status se3d_system_describe_left_out(const se3d_system *system, char *text,
                                                   size_t size);

#ifdef __cplusplus
}
#endif
#endif
