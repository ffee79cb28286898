/* SPDX-License-Identifier: BSD-3-Clause */
/* Recursions over a tree that are not in the innermost loops; the state has been placed. What needs
 * articulated inertias says so.                              docs/theory/joint_coordinates.md */
#ifndef SE3DI_TREE_RECURSION_H
#define SE3DI_TREE_RECURSION_H

#include "tree/tree.h"

/* c of a node, with the acceleration of a prescribed coordinate. */
void se3di_tree_bias(const se3di_tree *tree, uint32_t node, double bias[6]);

/* x: the velocities that y = D^-1 times what is added to each freedom gives, without biases, by
 * articulated inertias; x may be y. Prescribed coordinates: 0. */
void se3di_tree_spread(const se3di_tree *tree, const double *y, double *x);
/* x = M^-1 effort; x may be effort. Prescribed coordinates: 0. */
void se3di_tree_solve(se3di_tree *tree, const double *effort, double *x);

/* out = M x, armature included. */
void se3di_tree_mul(se3di_tree *tree, const double *x, double *out);
/* M [velocities x velocities], row-major, both triangles, armature included. */
void se3di_tree_mass_matrix(se3di_tree *tree, double *M);

#define SE3DI_TREE_CHANGES_ROOM 24

/* The largest squares over all bodies of what two small changes of q and qdot [positions +
 * velocities] are for a body: of the way of its centre of mass, of half the turn, of the changes of
 * its velocities; and of states, relative to their sizes, the largest change. `room`:
 * SE3DI_TREE_CHANGES_ROOM numbers for each node. */
void se3di_tree_measure(const se3di_tree *tree, const double *const change[2], double *room,
                        double parts[2][4], double states[2]);

/* out[v] = what acts along each freedom: S^T of `wrench` [nodes * 6] about P and of the nodes
 * beyond; the forces of joints do no work. */
void se3di_tree_project(se3di_tree *tree, const double *wrench, double *out);

/* Efforts that give the links' accelerations (se3di_tree_propagate) against tree->wrench, armature
 * times qddot included; `joint` [nodes * 6]: what each joint exerts on its node. */
void se3di_tree_efforts(const se3di_tree *tree, const double *qddot, double *joint, double *effort);

/* Multipliers of the joints on the tree and of drivers of its coordinates, into `lambda` [rows of
 * the model], from what the joints exert. `effort` (NULL: none): the part along the freedoms that
 * is neither theirs nor an armature's. driven: only of the drivers, from driven nodes. */
void se3di_tree_multipliers(const se3di_tree *tree, const double *joint, const double *effort,
                            int driven, double *lambda);

/* A point of a body, ground frame. */
void se3di_tree_point(const se3di_tree *tree, uint32_t body, const double local[3],
                      double point[3]);
/* Velocity of what moves with `body` at `point` (ground frame), from the velocities: J [6 *
 * velocities] row-major: angular velocity, velocity, ground axes; and its rate. */
void se3di_tree_jacobian(const se3di_tree *tree, uint32_t body, const double point[3], double *J);
void se3di_tree_jacobian_rate(const se3di_tree *tree, uint32_t body, const double point[3],
                              double *rate);
/* out [velocities] += J^T (torque, force), ground axes. */
void se3di_tree_add_transposed(const se3di_tree *tree, uint32_t body, const double point[3],
                               const double wrench[6], double *out);
/* Momentum about `point` (ground frame) from the velocities: H [6 x velocities], row-major:
 * angular, linear. */
void se3di_tree_momentum_matrix(se3di_tree *tree, const double point[3], double *H);
/* Mass of the nodes and their common centre of mass, ground frame; 0 if there are none. */
double se3di_tree_centre(const se3di_tree *tree, double centre[3]);

#endif
