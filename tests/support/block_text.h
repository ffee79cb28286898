/* SPDX-License-Identifier: BSD-3-Clause */
/* The text of a model: a block that slides along x, without gravity, for 6 s. */
#ifndef SE3D_TESTS_SUPPORT_BLOCK_TEXT_H
#define SE3D_TESTS_SUPPORT_BLOCK_TEXT_H

#define BLOCK                                                                                      \
    "se3d: 1\ngravity: [0, 0, 0]\nbodies:\n"                                                       \
    "  - {name: a, mass: 2, inertia: [1, 1, 1]}\n"                                                 \
    "joints: [{name: s, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], axis: [1, 0, "  \
    "0]}]\n"
#define OUTPUT                                                                                     \
    "analysis: {type: dynamics, duration: 6}\n"                                                    \
    "output: [{file: r.csv, channels: [a.velocity, a.position]}]\n"

#endif
