/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies by their names, and points of them. */
#ifndef SE3D_IO_BODIES_H
#define SE3D_IO_BODIES_H

#include "io/document/reader.h"
#include "io/model/model.h"

/* The body whose name stands under `key`; entry NULL: only the handle is wanted. */
bool se3di_read_key_body(se3di_reader *reader, const se3di_node *map, const char *key,
                         const se3di_body_entry **entry);
/* body_i and body_j, which must differ; `what` is "a spring", ... */
bool se3di_read_bodies_ij(se3di_reader *reader, const se3di_node *node, const char *what,
                          const se3di_body_entry *bodies[2]);
/* A point of a body: three coordinates or the name of one of its markers; left alone if there is
 * none. */
bool se3di_read_key_point(se3di_reader *reader, const se3di_node *map, const char *key,
                          const se3di_body_entry *body, double point[3]);

/* A point or direction of the part's ground frame, where the part is put; left alone if there is
 * none. An axial direction is one by which angles count. */
bool se3di_read_key_ground_point(se3di_reader *reader, const se3di_node *map, const char *key,
                                 double point[3]);
bool se3di_read_key_ground_direction(se3di_reader *reader, const se3di_node *map, const char *key,
                                     bool is_axial, double v[3]);
/* The same in the frame of a body. */
bool se3di_read_key_body_direction(se3di_reader *reader, const se3di_node *map, const char *key,
                                   const se3di_body_entry *body, bool is_axial, double v[3]);
/* What is said in the frame of a body: of another part it is an error in one that is mirrored. */
bool se3di_check_frame(se3di_reader *reader, const se3di_node *node, const se3di_body_entry *body);
bool se3di_place_on_body(se3di_reader *reader, const se3di_node *node, const se3di_body_entry *body,
                         double point[3]);
/* A point, or a direction, of the ground frame in the frame of a body, as it stands. */
bool se3di_ground_to_body(se3di_reader *reader, se3d_body body, const double ground[3],
                          double local[3]);
bool se3di_ground_to_body_direction(se3di_reader *reader, se3d_body body, const double ground[3],
                                    double local[3]);
/* The point under `key`, in the frame of a body, or under `at`, in the ground frame. */
bool se3di_read_key_place(se3di_reader *reader, const se3di_node *map, const char *key,
                          const char *at, const se3di_body_entry *body, double point[3]);

#endif
