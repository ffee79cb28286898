/* SPDX-License-Identifier: BSD-3-Clause */
/* The given restitution is the one that is obtained: damping from restitution, with
 * the force clipped at zero as the laws do.                         docs/theory/contact-laws.md */
#ifndef SE3DI_CONTACT_RESTITUTION_H
#define SE3DI_CONTACT_RESTITUTION_H

/* Hooke: restitution of m* x'' = -max(0, k x + 2 zeta sqrt(k m*) x'), zeta >= 0, and its inverse
 * (e in [SE3DI_RESTITUTION_MIN, 1]). */
double se3di_restitution_hooke(double zeta);
double se3di_restitution_hooke_damping(double e);

/* Hertz: restitution of m* x'' = -max(0, k x^1.5 + alpha sqrt(k m*) x^.25 x'), alpha >= 0, which
 * does not depend on the velocity, and its inverse. */
double se3di_restitution_hertz(double alpha);
double se3di_restitution_hertz_damping(double e);

#endif
