/* SPDX-License-Identifier: BSD-3-Clause */
/* The search for what was meant: edit distances. */
#include "io/document/guess.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum { GUESS_LENGTH_MAX = 63 };

static size_t smallest(size_t a, size_t b, size_t c)
{
    const size_t ab = a < b ? a : b;
    return ab < c ? ab : c;
}

/* Edit distance with swaps of neighbours counted as one; both texts at most GUESS_LENGTH_MAX. */
static size_t edit_distance(const char *a, size_t na, const char *b, size_t nb)
{
    size_t rows[3][GUESS_LENGTH_MAX + 1];
    for (size_t j = 0; j <= nb; ++j) {
        rows[0][j] = j;
        rows[1][j] = j;
        rows[2][j] = j;
    }
    for (size_t i = 1; i <= na; ++i) {
        size_t *now = rows[i % 3];
        const size_t *above = rows[(i + 2) % 3];
        const size_t *before = rows[(i + 1) % 3];
        now[0] = i;
        for (size_t j = 1; j <= nb; ++j) {
            now[j] = smallest(above[j] + 1, now[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] &&
                before[j - 2] + 1 < now[j]) {
                now[j] = before[j - 2] + 1;
            }
        }
    }
    return rows[na % 3][nb];
}

/* Words of other programs for ours: " word=ours ". A word may have several. */
static const char synonyms[] =
    " hinge=revolute pin=revolute continuous=revolute slider=prismatic slide=prismatic "
    "translational=prismatic ball=spherical weld=fixed rigid=fixed lock=fixed hooke=universal "
    "cardan=universal helical=screw inline=point_on_line inplane=point_on_plane "
    "rod=distance link=distance spring=tsda spring_damper=tsda torsion_spring=rsda "
    "rotational_spring=rsda moment=torque cuboid=box block=box ball=sphere stl=mesh "
    "body1=body_i body_1=body_i bodyA=body_i body_a=body_i parent=body_i from=body_i "
    "body2=body_j body_2=body_j bodyB=body_j body_b=body_j child=body_j to=body_j "
    "pos=position location=position origin=position com=position center=position at=position "
    "xyz=position rot=orientation rotation=orientation quat=orientation quaternion=orientation "
    "attitude=orientation quat=euler_parameters quaternion=euler_parameters euler=rpy vel=velocity "
    "linear_velocity=velocity omega=angular_velocity angvel=angular_velocity m=mass I=inertia "
    "J=inertia inertias=inertia anchor=at location=at position=at point=at pos=at pivot=at "
    "direction=axis dir=axis p1=point_i p2=point_j point1=point_i point2=point_j "
    "speed=rate velocity=rate rpm=rate omega=rate initial=start stiffness=k rate=k damping=c "
    "damper=c rest_length=l0 free_length=l0 length0=l0 "
    "time=duration end=duration t_end=duration end_time=duration stop_time=duration tend=duration "
    "dt=step timestep=step time_step=step h=step hmax=step integrator=method solver=method "
    "tol=tolerance rtol=tolerance function=value motion=value expression=value law=value "
    "parts=bodies links=bodies body=bodies connections=joints motors=drivers motions=drivers "
    "drives=drivers springs=forces loads=forces params=parameters variables=parameters "
    "constants=parameters outputs=output results=output simulation=analysis solver=analysis "
    "run=analysis columns=channels signals=channels requests=channels interval=every "
    "sampling=every filename=file path=file geometry=shapes visual=shapes geoms=shapes "
    "dynamic=dynamics kinematic=kinematics transient=dynamics static=equilibrium "
    "statics=equilibrium eigen=modes modal=modes linear=modes ground_frame=ground world=ground ";

/* Types that are looked for in the wrong list, and keys that are taken for types. */
static const struct {
    const char *types, *place;
} places[] = {
    {" fixed revolute prismatic cylindrical spherical universal planar screw point_on_line "
     "point_on_plane revolute_spherical revolute_cylindrical parallel perpendicular orientation "
     "distance gear rack_pinion coupler ",
     "a type of `joints`"},
    {" dp1 dp2 d cd perpendicular1 perpendicular2 ", "a type of `constraints`"},
    {" tsda rsda bushing friction stop effort force torque tyre armature ", "a type of `forces`"},
    {" ode integrator lag transfer pid ", "a type of `states`"},
    {" driver ", "an entry of `drivers`"},
    {" gravity ", "a key of the model"}};

const char *se3di_guess_place(const char *word)
{
    const size_t length = strlen(word);
    for (size_t k = 0; k < sizeof places / sizeof *places; ++k) {
        for (const char *at = places[k].types; length > 0 && (at = strstr(at, word)); ++at) {
            if (at > places[k].types && at[-1] == ' ' && at[length] == ' ') {
                return places[k].place;
            }
        }
    }
    return NULL;
}

/* Equal but for capitals. */
static bool differ_in_case(const char *a, const char *b)
{
    while (*a && (*a == *b || ((*a ^ *b) == 32 && (*a | 32) >= 'a' && (*a | 32) <= 'z'))) {
        ++a;
        ++b;
    }
    return *a == *b;
}

static bool is_synonym(const char *word, const char *candidate)
{
    const size_t nw = strlen(word);
    const size_t nc = strlen(candidate);
    for (const char *at = synonyms + 1; nw > 0 && (at = strstr(at, word)) != NULL; ++at) {
        if (at[-1] == ' ' && at[nw] == '=' && strncmp(at + nw + 1, candidate, nc) == 0 &&
            at[nw + 1 + nc] == ' ') {
            return true;
        }
    }
    return false;
}

se3di_guess se3di_guess_begin(const char *word)
{
    const se3di_guess guess = {word, NULL, SIZE_MAX};
    return guess;
}

void se3di_guess_offer(se3di_guess *guess, const char *candidate)
{
    const size_t na = strlen(guess->word);
    const size_t nb = strlen(candidate);
    if (na > GUESS_LENGTH_MAX || nb > GUESS_LENGTH_MAX || na == 0) {
        return;
    }
    const size_t distance =
        is_synonym(guess->word, candidate) ? 0 : edit_distance(guess->word, na, candidate, nb);
    if (distance < guess->distance ||
        (distance == guess->distance && differ_in_case(guess->word, candidate))) {
        guess->distance = distance;
        guess->best = candidate;
    }
}

const char *se3di_guess_get(const se3di_guess *guess)
{
    const size_t length = strlen(guess->word);
    const size_t allowed = length <= 3 ? 1 : length <= 6 ? 2 : length / 3;
    return guess->best && guess->distance <= allowed ? guess->best : NULL;
}
