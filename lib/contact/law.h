/* SPDX-License-Identifier: BSD-3-Clause */
/* Penalty laws: what two materials become when they touch.         docs/theory/contact-laws.md */
#ifndef SE3DI_CONTACT_LAW_H
#define SE3DI_CONTACT_LAW_H

typedef enum se3di_law { SE3DI_LAW_HOOKE = 0, SE3DI_LAW_HERTZ_MINDLIN = 1 } se3di_law;

typedef struct se3di_material {
    double density;
    double young, poisson; /* hertz_mindlin */
    double friction;
    double restitution;
    double rolling_friction, torsional_friction; /* times R*: the arm of the resisting moment */
    double stiffness, tangential_ratio;          /* hooke: kn of two spheres of it, kt/kn */
} se3di_material;

/* Coefficients of one pair of materials; with s = 1 (hooke) or sqrt(R* delta) (hertz_mindlin):
 *
 *     Fn = max(0, kn s delta - dn sqrt(m* s) vn)      Ft = -kt s xi - dt sqrt(m* s) vt
 *
 * dr: damping of rolling and torsion, like dt. */
typedef struct se3di_pair {
    double kn, kt, dn, dt;
    double friction, rolling, torsion, dr;
} se3di_pair;

#define SE3DI_PAIR_SIZE 8 /* doubles in an se3di_pair */

/* What a user may say of a pair; negative: by the mixing rules. */
typedef struct se3di_override {
    double friction, restitution, rolling_friction, torsional_friction, stiffness;
} se3di_override;

/* Mix two materials: geometric means of friction and restitution, springs in series for stiffness
 * (twice, so that equal ones give themselves). `over` may be NULL. */
void se3di_pair_mix(se3di_law law, const se3di_material *a, const se3di_material *b,
                    const se3di_override *over, se3di_pair *pair);

/* The longest time of a step that resolves a contact of two spheres (a wall: radius_b and mass_b
 * infinite): 1/50 of the contact's time (hooke), 1/20 of Rayleigh's time (hertz_mindlin). */
double se3di_pair_step(se3di_law law, const se3di_material *a, const se3di_pair *pair,
                       double radius, double mass, double reduced_mass);

#endif
