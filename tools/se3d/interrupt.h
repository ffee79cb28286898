/* SPDX-License-Identifier: BSD-3-Clause */
/* Ctrl-C, or a request to end: a run stops at its next row and completes its files. A second one
 * ends the program at once. */
#ifndef SE3D_TOOLS_INTERRUPT_H
#define SE3D_TOOLS_INTERRUPT_H

/* Listen from now on; a reader of our output that goes away does not end the run either. */
void interrupt_begin(void);
/* From now on also a second request is only remembered: programs that run beside this one must be
 * ended first. */
void interrupt_hold(void);
/* @return not 0: the user wants an end. */
int interrupt_came(void);

#endif
