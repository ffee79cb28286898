/* SPDX-License-Identifier: BSD-3-Clause */
/* The sections of the file, one function each, in the order in which load.c calls them. */
#ifndef SE3D_IO_SECTIONS_H
#define SE3D_IO_SECTIONS_H

#include "io/document/reader.h"

bool se3di_read_materials(se3di_reader *reader, const se3di_node *root);
bool se3di_read_bodies(se3di_reader *reader, const se3di_node *root);
bool se3di_read_joints(se3di_reader *reader, const se3di_node *root);
bool se3di_read_constraints(se3di_reader *reader, const se3di_node *root);
/* Those of the time; se3di_read_followers, after the forces: those of channels;
 * se3di_read_rate_followers, after the laws of states: those whose rates follow channels. */
bool se3di_read_drivers(se3di_reader *reader, const se3di_node *root);
bool se3di_read_followers(se3di_reader *reader, const se3di_node *root);
bool se3di_read_rate_followers(se3di_reader *reader, const se3di_node *root);
/* Makes the states, before the forces; se3di_read_state_laws, after them: what they depend on. */
bool se3di_read_states(se3di_reader *reader, const se3di_node *root);
bool se3di_read_state_laws(se3di_reader *reader);
/* Before the forces, which are on them. */
bool se3di_read_roads(se3di_reader *reader, const se3di_node *root);
bool se3di_read_forces(se3di_reader *reader, const se3di_node *root);
bool se3di_read_wheels(se3di_reader *reader, const se3di_node *root);
/* Bodies and elements of `reader->again`, in the model that they are in already; states, roads and
 * drivers that have rates are none of them. */
bool se3di_read_mechanism_again(se3di_reader *reader, const se3di_node *root);
bool se3di_read_analyses(se3di_reader *reader, const se3di_node *root);
/* `contact` and `particles`, after the analyses. */
bool se3di_read_contact(se3di_reader *reader, const se3di_node *root);
bool se3di_read_particles(se3di_reader *reader, const se3di_node *root);
bool se3di_read_outputs(se3di_reader *reader, const se3di_node *root);
bool se3di_read_events(se3di_reader *reader, const se3di_node *root);
/* Units of other programs, after the elements that they act on. */
bool se3di_read_guests(se3di_reader *reader, const se3di_node *root);
bool se3di_read_study(se3di_reader *reader, const se3di_node *root);
/* What the sources of a study are in the model. */
bool se3di_read_measured(se3di_reader *reader, const struct se3di_study_entry *study);

#endif
