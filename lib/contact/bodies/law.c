/* SPDX-License-Identifier: BSD-3-Clause */
#include "contact/bodies/law.h"

#include "contact/bodies/restitution.h"

#include <math.h>

#define PI 3.1415926535897932384626433832795

/* Damping of rolling: about critical for a sphere on a sphere, above for one on a wall. */
#define ROLLING_DAMPING 1.2

static double choose(double given, double mixed)
{
    return given < 0.0 ? mixed : given;
}

/* What a material says, where 0 is what the law has and less is none. */
static double own(double given, double law)
{
    return given > 0.0 ? given : given < 0.0 ? 0.0 : law;
}

static int is_given(double a, double b)
{
    return a > 0.0 || a < 0.0 || b > 0.0 || b < 0.0;
}

double se3di_material_restitution(se3di_contact_law law, const se3di_material *material)
{
    const double ratio = own(material->damping_ratio, 0.0);
    if (!is_given(material->damping_ratio, 0.0)) {
        return material->restitution;
    }
    return law == SE3DI_LAW_HERTZ_MINDLIN ? se3di_restitution_hertz(sqrt(6.0) * ratio)
                                          : se3di_restitution_hooke(ratio);
}

static void hooke(const se3di_material *a, const se3di_material *b, const se3di_override *o,
                  double e, se3di_pair *pair)
{
    double zeta = se3di_restitution_hooke_damping(e);
    double ratio = choose(o->tangential_ratio, sqrt(a->tangential_ratio * b->tangential_ratio));
    pair->kn = o->stiffness < 0.0
                   ? 2.0 * a->stiffness * b->stiffness / (a->stiffness + b->stiffness)
                   : o->stiffness;
    pair->kt = ratio * pair->kn;
    pair->dn = 2.0 * zeta * sqrt(pair->kn);
    pair->dt = ratio; /* over dn; with 2/7: the same damping ratio as the normal direction */
}

/* kt/kn between two of a material, of this Poisson's ratio. */
static double hertz_ratio(const se3di_material *a, double poisson)
{
    return own(a->tangential_ratio_hertz, 3.0 * (1.0 - poisson) / (2.0 - poisson));
}

static void hertz(const se3di_material *a, const se3di_material *b, const se3di_override *o,
                  double e, se3di_pair *pair)
{
    const double E[2] = {choose(o->young, a->young), choose(o->young, b->young)};
    const double nu[2] = {choose(o->poisson, a->poisson), choose(o->poisson, b->poisson)};
    double compliance = (1.0 - nu[0] * nu[0]) / E[0] + (1.0 - nu[1] * nu[1]) / E[1];
    double shear =
        2.0 * (2.0 - nu[0]) * (1.0 + nu[0]) / E[0] + 2.0 * (2.0 - nu[1]) * (1.0 + nu[1]) / E[1];
    pair->kn = 4.0 / (3.0 * compliance);
    pair->kt = is_given(a->tangential_ratio_hertz, b->tangential_ratio_hertz)
                   ? sqrt(hertz_ratio(a, nu[0]) * hertz_ratio(b, nu[1])) * pair->kn
                   : 8.0 / shear;
    pair->kt = o->tangential_ratio < 0.0 ? pair->kt : o->tangential_ratio * pair->kn;
    pair->dn = se3di_restitution_hertz_damping(e) * sqrt(pair->kn);
    /* Over dn: the damping ratio of the tangent stiffnesses, 3/2 kn s and kt s. */
    pair->dt = sqrt(pair->kt / (1.5 * pair->kn));
}

/* Damping over the mass, of particles: less than 0 if neither says so. */
static double mean_rate(double a, double b)
{
    if (!is_given(a, b)) {
        return -1.0;
    }
    const double one = is_given(a, 0.0) ? a : b, other = is_given(b, 0.0) ? b : a;
    return sqrt(own(one, 0.0) * own(other, 0.0));
}

/* A stiffness in place of what the law makes of a ratio, `ratio` of the pair, or below 0. Of two in
 * series. @return whether there is one */
static int in_place(double one, double other, double of_pair, double ratio, double *stiffness)
{
    if (!(of_pair >= 0.0) && (ratio >= 0.0 || !is_given(one, other))) {
        return 0;
    }
    const double k = own(is_given(one, 0.0) ? one : other, 0.0);
    const double l = own(is_given(other, 0.0) ? other : one, 0.0);
    *stiffness = choose(of_pair, k > 0.0 && l > 0.0 ? 2.0 * k * l / (k + l) : 0.0);
    return 1;
}

/* Damping along the tangent, from what it is over that along the normal. */
static void drag(const se3di_material *a, const se3di_material *b, const se3di_override *o,
                 se3di_pair *pair)
{
    if (o->tangential_damping >= 0.0) {
        pair->dt = o->tangential_damping;
    } else if (is_given(a->tangential_damping, b->tangential_damping)) {
        pair->dt =
            sqrt(own(a->tangential_damping, pair->dt) * own(b->tangential_damping, pair->dt));
    }
    pair->rt = pair->dt * fmax(pair->rn, 0.0);
    pair->dt *= pair->dn;
}

static void roll(const se3di_material *a, const se3di_material *b, const se3di_override *o,
                 se3di_pair *pair)
{
    const double damping = ROLLING_DAMPING;
    pair->kr =
        choose(o->rolling_ratio, sqrt(own(a->rolling_ratio, 1.0) * own(b->rolling_ratio, 1.0)));
    pair->kr *= pair->kt;
    pair->kr_constant = in_place(a->rolling_stiffness, b->rolling_stiffness, o->rolling_stiffness,
                                 o->rolling_ratio, &pair->kr) &&
                        se3di_pair_is_hertz(pair);
    pair->dr = o->rolling_damping >= 0.0 ? o->rolling_damping
               : is_given(a->rolling_damping, b->rolling_damping)
                   ? sqrt(own(a->rolling_damping, damping) * own(b->rolling_damping, damping))
                   : damping;
    pair->dr *= sqrt(pair->kr);
}

se3di_contact_law se3di_pair_law(se3di_contact_law of_all, const se3di_override *over)
{
    return over->law < 0 || of_all == SE3DI_LAW_CALLBACK ? of_all : (se3di_contact_law)over->law;
}

static double restitution(se3di_contact_law law, const se3di_material *a, const se3di_material *b,
                          const se3di_override *o)
{
    const se3di_material both = {.damping_ratio = o->damping_ratio > 0.0 ? o->damping_ratio : -1.0};
    return o->damping_ratio >= 0.0
               ? se3di_material_restitution(law, &both)
               : choose(o->restitution, sqrt(se3di_material_restitution(law, a) *
                                             se3di_material_restitution(law, b)));
}

void se3di_pair_mix(se3di_contact_law of_all, const se3di_material *a, const se3di_material *b,
                    const se3di_override *over, se3di_pair *pair)
{
    const se3di_override none = SE3DI_OVERRIDE_NONE;
    const se3di_override *o = over ? over : &none;
    const se3di_contact_law law = se3di_pair_law(of_all, o);
    const double e = restitution(law, a, b, o);
    if (law == SE3DI_LAW_HOOKE) {
        hooke(a, b, o, e, pair);
    } else if (law == SE3DI_LAW_CALLBACK) {
        *pair = (se3di_pair){.kn = 0.0}; /* the user knows */
    } else {
        hertz(a, b, o, e, pair);
    }
    pair->law = (int32_t)law;
    pair->kt_constant = pair->kr_constant = 0;
    pair->restitution = e;
    pair->friction = choose(o->friction, sqrt(a->friction * b->friction));
    if (law == SE3DI_LAW_CALLBACK) {
        return;
    }
    pair->rolling = choose(o->rolling_friction, sqrt(a->rolling_friction * b->rolling_friction));
    pair->torsion =
        choose(o->torsional_friction, sqrt(a->torsional_friction * b->torsional_friction));
    pair->cohesion = 2.0 * PI * choose(o->cohesion, sqrt(a->cohesion * b->cohesion));
    pair->pull_off = 1.5 * PI * choose(o->adhesion, sqrt(a->adhesion * b->adhesion));
    pair->rn = o->damping_rate >= 0.0 ? o->damping_rate
               : o->restitution < 0.0 && o->damping_ratio < 0.0
                   ? mean_rate(a->damping_rate, b->damping_rate)
                   : -1.0;
    drag(a, b, o, pair);
    roll(a, b, o, pair);
    pair->kt_constant = in_place(a->tangential_stiffness, b->tangential_stiffness,
                                 o->tangential_stiffness, o->tangential_ratio, &pair->kt) &&
                        se3di_pair_is_hertz(pair); /* rolling is over the stiffness of the law */
}

void se3di_pair_mix_all(se3di_model *model)
{
    size_t n = model->material_slots.count;
    for (size_t a = 0; a < n; ++a) {
        for (size_t b = 0; b <= a; ++b) {
            se3di_pair *pair = &model->pairs[a * n + b];
            se3di_pair_mix((se3di_contact_law)model->contact.law, &model->materials[a],
                           &model->materials[b], &model->overrides[a * n + b], pair);
            model->pairs[b * n + a] = *pair;
        }
    }
}

const se3di_pair *se3di_pair_of(const se3di_model *model, uint32_t i, uint32_t j)
{
    const size_t first = (size_t)model->shapes[i].material;
    return &model->pairs[first * model->material_slots.count + (size_t)model->shapes[j].material];
}

double se3di_pair_step(const se3di_material *a, const se3di_override *over, const se3di_pair *pair,
                       double radius, double mass, double reduced_mass)
{
    if (pair->law == SE3DI_LAW_CALLBACK) {
        return HUGE_VAL;
    }
    const double tangent = pair->kt_constant ? 0.0 : pair->kt;
    const double turn = pair->kr_constant ? 0.0 : pair->kr;
    const double stiffest = fmax(tangent, turn) / pair->kn;
    if (pair->law == SE3DI_LAW_HOOKE) {
        double rate = sqrt(pair->kn * fmax(1.0, stiffest) / reduced_mass);
        const double damping = pair->rn < 0.0 ? pair->dn / sqrt(reduced_mass) : pair->rn;
        return 0.02 * PI / (rate + damping);
    }
    double density = mass / (4.0 / 3.0 * PI * radius * radius * radius);
    const double young = choose(over->young, a->young), nu = choose(over->poisson, a->poisson);
    double shear_modulus = young / (2.0 * (1.0 + nu));
    double rayleigh = PI * radius * sqrt(density / shear_modulus) / (0.1631 * nu + 0.8766);
    /* Mindlin's springs have 1.5 at most */
    const double step = 0.025 * rayleigh * sqrt(2.0 * reduced_mass / mass) /
                        (stiffest > 1.5001 ? sqrt(stiffest / 1.5) : 1.0);
    const double circle = 0.3 * radius; /* of contact, at a tenth of the radius on a wall */
    const double alone = step / (1.0 + step * fmax(pair->rn, 0.0) * circle / (0.02 * PI));
    const double constant =
        fmax(pair->kt_constant ? pair->kt : 0.0, pair->kr_constant ? pair->kr : 0.0);
    return constant > 0.0 ? fmin(alone, 0.02 * PI * sqrt(reduced_mass / constant)) /* as of hooke */
                          : alone;
}
