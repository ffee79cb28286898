/* SPDX-License-Identifier: BSD-3-Clause */
/* libse3d-record: write every call that a program makes of libse3d to a file, which `se3d replay
 * FILE` makes again. The program is linked to it before libse3d, or started with it:
 *
 *     SE3D_RECORD=FILE LD_PRELOAD=libse3d-record.so PROGRAM
 *
 * docs/recording.md */
#ifndef SE3D_RECORD_H
#define SE3D_RECORD_H

#ifdef __cplusplus
extern "C" {
#endif

/* Write the calls from now on to a new file. Objects that were made before are not known to it.
 * @return 0; -1: the file cannot be written, or another recording goes on. @since 0.1 */
__attribute__((visibility("default"))) int se3d_record_begin(const char *path);

/* End the recording. @return 0; -1: there was none, or it is not whole. @since 0.1 */
__attribute__((visibility("default"))) int se3d_record_end(void);

#ifdef __cplusplus
}
#endif
#endif
