/* SPDX-License-Identifier: BSD-3-Clause */
/* Going on after a mistake: what is wrong is put right or taken out of the tree, so that the text
 * can be read again and the next mistake be found. */
#ifndef SE3D_IO_RECOVERY_H
#define SE3D_IO_RECOVERY_H

#include "io/document/document.h"

/* What the last report was about. */
typedef struct se3di_fault {
    se3di_node *node;  /* that is wrong or incomplete; NULL: the whole, or nothing of the tree */
    const char *meant; /* in place of the node's text or key; NULL: not known */
    bool is_key;       /* the key of the node is wrong */
} se3di_fault;

/* A fault of a node, of which the report may have a copy with another place. */
se3di_fault se3di_fault_of(const se3di_node *node);

/* One search for mistakes. */
typedef struct se3di_recovery {
    se3di_iopool *pool;
    const char **lost; /* names of what was taken out */
    size_t lost_count, lost_capacity;
} se3di_recovery;

/* Whether the fault only follows from what was taken out before. */
bool se3di_recovery_expects(const se3di_recovery *recovery, const se3di_fault *fault);
/* Change the tree so that the fault does not come back. `guess`: what was meant may take the place
 * of what is wrong. @return false: the rest of the text cannot be judged, or out of memory. */
bool se3di_recovery_mend(se3di_recovery *recovery, const se3di_fault *fault, bool guess);

#endif
