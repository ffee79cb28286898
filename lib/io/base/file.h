/* SPDX-License-Identifier: BSD-3-Clause */
/* Files in folders where others may have left something: links are not followed, pipes and devices
 * not opened, and what is not whole gets no name. The program uses it, too. */
#ifndef SE3D_IO_FILE_H
#define SE3D_IO_FILE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* The path of `file`, which is relative, in `folder`. @return false: errno says why: too long, or
 * ELOOP if a symbolic link leads out of the folder. */
bool se3di_file_join(const char *folder, const char *file, char *path, size_t size);
/* Make the folders that a path of a file needs. @return false: errno says why. */
bool se3di_file_make_folders(const char *path);
/* Open a regular file for reading: a folder is EISDIR, a pipe or device EINVAL. @return NULL: errno
 * says why. */
FILE *se3di_file_open(const char *path);
/* Make a file, which must not be there, for writing. @return NULL: errno says why. */
FILE *se3di_file_create(const char *path);
/* Open a regular file, made if it is not there, for reading and writing, and lock it: if another
 * program has it open in this way it is EAGAIN. @return NULL: errno says why. */
FILE *se3di_file_continue(const char *path);
/* What errno says after one of these functions. */
const char *se3di_file_get_text(int why);
/* Whether both paths are there and lead to one file. */
bool se3di_file_is_same(const char *a, const char *b);
/* The whole path of a folder ("": the present one), without links, that ends with '/'. @return
 * false: errno says why. */
bool se3di_file_find_folder(const char *folder, char *path, size_t size);
/* Go on at a byte of an open file. @return false: errno says why. */
bool se3di_file_seek(FILE *file, uint64_t place);
/* Cut an open file to its first `size` bytes and go on there. */
bool se3di_file_cut(FILE *file, uint64_t size);
/* Whether results of this name are HDF5. */
bool se3di_file_is_hdf5(const char *name);
/* Why a file must not take this name: EISDIR, EINVAL; 0: it may. A link is replaced, not what it
 * leads to. */
int se3di_file_forbid(const char *path);
/* Open a file under a temporary name; complete it and give it its name, which a regular file may
 * have or a link, both are replaced: a folder is EISDIR, a pipe or device EINVAL. @return NULL,
 * false: errno says why, and nothing is left. */
FILE *se3di_partial_open(const char *path);
bool se3di_partial_close(FILE *file, const char *path);
/* Go on with a file that se3di_partial_open had begun, after its first `size` bytes: with the one
 * of the temporary name, or a copy of the one that has its name already, if their hash is that one.
 * @return NULL: errno says why; ESTALE: neither begins with these bytes. What is there stays. */
FILE *se3di_partial_continue(const char *path, uint64_t size, uint64_t hash);
/* Make a folder that only this user may enter, within another (NULL: /tmp); take it away with all
 * that is in it, without following links. @return false: errno says why; not on Windows. */
bool se3di_temporary_make(const char *within, char *path, size_t size);
void se3di_temporary_remove(const char *path);
/* The same for one that is held as long as this process lives: what processes that were killed have
 * left in `within` is taken away first. *hold: for se3di_temporary_release, -1 if the system cannot
 * tell who lives; then it stays if the process is killed. */
bool se3di_temporary_hold(const char *within, char *path, size_t size, int *hold);
void se3di_temporary_release(const char *path, int hold);
/* Let a file survive that the machine stops. */
bool se3di_file_sync(FILE *file);
/* Take a file away, and what was left of it under its temporary name; folders stay. */
void se3di_file_remove(const char *path);
/* Close a file that others go on with later. */
void se3di_partial_leave(FILE *file);
/* Cut the file to its first `size` bytes and give it its name, after a write has failed; if it
 * cannot have it, it keeps the temporary one. @return false: nothing is left. */
bool se3di_partial_keep(FILE *file, const char *path, uint64_t size);
/* Close without keeping anything. */
void se3di_partial_abandon(FILE *file, const char *path);

#endif
