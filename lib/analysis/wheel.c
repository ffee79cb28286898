/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/wheel.h"

#include "analysis/wheel_load.h"
#include "analysis/wheel_motion.h"
#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define PARALLEL 1e-12 /* slopes of the lines that meet at the roll centre */

/* A wheel at the present pose, ground frame. */
typedef struct pose {
    double axes[9];    /* rows: vehicle axes */
    double center[3];  /* c */
    double axis[3];    /* a */
    double down[3];    /* d */
    double length;     /* of d before it was a unit vector */
    double contact[3]; /* C */
    double side;       /* s */
} pose;

static void take_pose(const se3di_model *model, const se3di_wheel *wheel, pose *p)
{
    const se3di_frame *frame = &model->frames[wheel->body];
    se3di_wheel_axes(model, wheel, p->axes);
    se3di_mul(frame->A, wheel->center, p->center);
    se3di_add(p->center, frame->r, p->center);
    se3di_mul(frame->A, wheel->axis, p->axis);
    se3di_scale(se3di_dot(wheel->road, p->axis), p->axis, p->down);
    se3di_sub(p->down, wheel->road, p->down);
    p->length = se3di_norm(p->down);
    se3di_scale(1.0 / p->length, p->down, p->down);
    se3di_copy(p->center, p->contact);
    se3di_add_scaled(wheel->radius, p->down, p->contact);
    p->side = se3di_dot(p->axis, p->axes + 3) < 0.0 ? -1.0 : 1.0;
}

static void to_vehicle(const se3di_model *model, const se3di_wheel *wheel, const pose *p,
                       const double point[3], double out[3])
{
    double arm[3];
    se3di_sub(point, model->frames[wheel->chassis].r, arm);
    for (int k = 0; k < 3; ++k) {
        out[k] = se3di_dot(p->axes + 3 * k, arm);
    }
}

void se3di_wheel_place(const se3di_model *model, const se3di_wheel *wheel, double center[3],
                       double contact[3])
{
    pose p;
    take_pose(model, wheel, &p);
    to_vehicle(model, wheel, &p, p.center, center);
    to_vehicle(model, wheel, &p, p.contact, contact);
}

static double steer_of(const pose *p)
{
    const double x = se3di_dot(p->axis, p->axes);
    const double y = se3di_dot(p->axis, p->axes + 3);
    return se3di_atan2(-p->side * x, p->side * y);
}

/* The steer angle less the one that goes with the opposite wheel's about one centre. */
static double compute_ackermann(const se3di_model *model, const se3di_wheel *wheel, const pose *p)
{
    double contact[2][3];
    pose other;
    if (wheel->opposite < 0 || !(wheel->wheelbase > 0.0)) {
        return (double)NAN;
    }
    take_pose(model, &model->wheels[wheel->opposite], &other);
    to_vehicle(model, wheel, p, p->contact, contact[0]);
    to_vehicle(model, wheel, p, other.contact, contact[1]);
    const double L = wheel->wheelbase;
    const double tangent = se3di_tan(steer_of(&other));
    const double apart = contact[1][1] - contact[0][1];
    return steer_of(p) - se3di_atan2(L * tangent, L + apart * tangent);
}

static void measure_pose(const se3di_model *model, const se3di_wheel *wheel, const pose *p,
                         double *values)
{
    double center[3];
    double contact[3];
    to_vehicle(model, wheel, p, p->center, center);
    to_vehicle(model, wheel, p, p->contact, contact);
    values[SE3D_WHEEL_CAMBER] = -se3di_asin(fmax(-1.0, fmin(1.0, se3di_dot(p->axis, p->axes + 6))));
    values[SE3D_WHEEL_INCLINATION] =
        -se3di_asin(fmax(-1.0, fmin(1.0, se3di_dot(p->axis, wheel->road))));
    values[SE3D_WHEEL_STEER] = steer_of(p);
    values[SE3D_WHEEL_TOE] = 0.0 - p->side * values[SE3D_WHEEL_STEER];
    values[SE3D_WHEEL_TRAVEL] = center[2] - wheel->center0[2];
    values[SE3D_WHEEL_WHEELBASE_CHANGE] = contact[0] - wheel->contact0[0];
    values[SE3D_WHEEL_TRACK_CHANGE] = p->side * (contact[1] - wheel->contact0[1]);
    values[SE3D_WHEEL_ACKERMANN_ERROR] = compute_ackermann(model, wheel, p);
    se3di_copy(p->contact, values + SE3D_WHEEL_CONTACT_X);
}

/* ---- The steer axis ------------------------------------------------------------------------*/

/* v of the centre and omega, ground frame, of the wheel's body in a motion. */
static void take_twist(const se3di_wheel_motion *motion, const se3di_wheel *wheel, double v[3],
                       double omega[3])
{
    const double *A = motion->model->frames[wheel->body].A;
    const double *velocity = motion->velocity + 6 * (size_t)wheel->body;
    double turning[3];
    double local[3];
    se3di_cross(velocity + 3, wheel->center, local);
    se3di_mul(A, local, turning);
    se3di_add(velocity, turning, v);
    se3di_mul(A, velocity + 3, omega);
}

/* A point of the axis and its direction from the motion in which the body turns while the spring,
 * or without one the centre's height, stays. */
static se3d_status find_axis(const se3di_model *model, const se3di_wheel *wheel, const pose *p,
                             double point[3], double k[3])
{
    se3di_wheel_motion motion = {
        .model = model,
        .wheel = wheel,
        .released = {wheel->travel, wheel->steering, -1},
        .prescribed = {{wheel, SE3DI_WHEEL_TURN, 1.0},
                       {wheel, wheel->spring >= 0 ? SE3DI_WHEEL_LENGTH : SE3DI_WHEEL_TRAVEL, 0.0}},
        .prescribed_count = 2};
    double v[3];
    SE3DI_TRY(se3di_wheel_motion_find(&motion));
    take_twist(&motion, wheel, v, k);
    const double square = se3di_dot(k, k);
    se3di_cross(k, v, point);
    se3di_scale(1.0 / square, point, point);
    se3di_add(point, p->center, point);
    if (!motion.exists || !(square > 0.0)) {
        k[0] = k[1] = k[2] = (double)NAN;
    }
    se3di_wheel_motion_destroy(&motion);
    return SE3D_OK;
}

static se3d_status measure_steering(const se3di_model *model, const se3di_wheel *wheel,
                                    const pose *p, double *values)
{
    const se3di_frame *frame = &model->frames[wheel->body];
    double k[3], point[3], out[3], ahead[3], to_ground[3];
    se3di_sub(wheel->upper, wheel->lower, out);
    if (se3di_norm(out) > 0.0) {
        se3di_mul(frame->A, out, k);
        se3di_mul(frame->A, wheel->lower, point);
        se3di_add(point, frame->r, point);
    } else {
        SE3DI_TRY(find_axis(model, wheel, p, point, k));
    }
    if (se3di_dot(k, p->axes + 6) < 0.0) {
        se3di_scale(-1.0, k, k);
    }
    const double up = se3di_dot(k, p->axes + 6);
    values[SE3D_WHEEL_CASTER] = se3di_atan2(0.0 - se3di_dot(k, p->axes), up);
    values[SE3D_WHEEL_KINGPIN_INCLINATION] =
        se3di_atan2(0.0 - p->side * se3di_dot(k, p->axes + 3), up);
    se3di_sub(p->contact, point, to_ground); /* from the contact point to the axis in the road */
    const double along = se3di_dot(to_ground, wheel->road) / se3di_dot(k, wheel->road);
    se3di_scale(-1.0, to_ground, to_ground);
    se3di_add_scaled(along, k, to_ground);
    se3di_copy(p->axis, out);
    se3di_add_scaled(-se3di_dot(p->axis, wheel->road), wheel->road, out);
    se3di_scale(1.0 / se3di_norm(out), out, out);
    se3di_cross(out, wheel->road, ahead);
    values[SE3D_WHEEL_SCRUB_RADIUS] = 0.0 - se3di_dot(to_ground, out);
    values[SE3D_WHEEL_MECHANICAL_TRAIL] = p->side * se3di_dot(to_ground, ahead);
    return SE3D_OK;
}

/* ---- Derivatives by wheel travel -----------------------------------------------------------*/

/* Velocities for a wheel travel of 1, vehicle axes. */
typedef struct ride_rates {
    double center[3];   /* of the wheel centre */
    double contact[3];  /* of the contact point */
    double material[3]; /* of the body's point there */
    double omega[3];
    double axis[3]; /* a' */
    double spring;  /* of its length */
} ride_rates;

static void to_axes(const pose *p, const double x[3], double out[3])
{
    for (int k = 0; k < 3; ++k) {
        out[k] = se3di_dot(p->axes + 3 * k, x);
    }
}

static void take_ride(const se3di_wheel_motion *motion, const se3di_wheel *wheel, const pose *p,
                      ride_rates *ride)
{
    double v[3], omega[3], turned[3], down[3], arm[3];
    take_twist(motion, wheel, v, omega);
    to_axes(p, v, ride->center);
    to_axes(p, omega, ride->omega);
    se3di_cross(omega, p->axis, turned);
    to_axes(p, turned, ride->axis);
    /* u = (n . a) a - n, d = u / |u| */
    se3di_scale(se3di_dot(wheel->road, turned), p->axis, down);
    se3di_add_scaled(se3di_dot(wheel->road, p->axis), turned, down);
    se3di_add_scaled(-se3di_dot(down, p->down), p->down, down);
    se3di_scale(wheel->radius / p->length, down, down);
    se3di_add(v, down, down);
    to_axes(p, down, ride->contact);
    se3di_scale(wheel->radius, p->down, arm);
    se3di_cross(omega, arm, down);
    se3di_add(v, down, down);
    to_axes(p, down, ride->material);
    ride->spring = se3di_wheel_spring_rate(motion, wheel);
}

/* The ride of one of the wheels of a motion. */
static void read_ride(const se3di_wheel_motion *motion, const se3di_wheel *wheel, const pose *p,
                      ride_rates *ride)
{
    take_ride(motion, wheel, p, ride);
    if (!motion->exists) {
        for (size_t k = 0; k < sizeof *ride / sizeof(double); ++k) {
            ((double *)ride)[k] = (double)NAN;
        }
    }
}

/* The ride of the opposite wheel while the own one stays: another motion, unless both wheels are
 * opposite to each other on one chassis. */
static se3d_status find_opposite_ride(se3di_wheel_motion *motion, const pose *p, ride_rates *ride)
{
    const se3di_model *model = motion->model;
    const se3di_wheel *opposite = &model->wheels[motion->wheel->opposite];
    if (opposite->chassis == motion->wheel->chassis && opposite->opposite >= 0 &&
        &model->wheels[opposite->opposite] == motion->wheel) {
        const double rates[2] = {0.0, 1.0};
        SE3DI_TRY(se3di_wheel_motion_change(motion, rates));
        read_ride(motion, opposite, p, ride);
        return SE3D_OK;
    }
    se3di_wheel_motion other;
    const double rates[2] = {1.0, 0.0};
    se3di_wheel_ride_init(&other, model, opposite, rates);
    SE3DI_TRY(se3di_wheel_motion_find(&other));
    read_ride(&other, opposite, p, ride);
    se3di_wheel_motion_destroy(&other);
    return SE3D_OK;
}

/* Height over the middle of the contact points of where the lines from them to the front centres
 * meet; without an opposite wheel, of where the line meets the plane y = 0. */
static se3d_status measure_roll_center(se3di_wheel_motion *motion, const pose *p,
                                       const ride_rates *own, double *height)
{
    const se3di_model *model = motion->model;
    const se3di_wheel *wheel = motion->wheel;
    double C[2][3];
    const double slope = -own->material[1] / own->material[2];
    to_vehicle(model, wheel, p, p->contact, C[0]);
    *height = 0.0 - slope * C[0][1];
    if (wheel->opposite < 0) {
        return SE3D_OK;
    }
    const se3di_wheel *opposite = &model->wheels[wheel->opposite];
    pose there;
    ride_rates other;
    take_pose(model, opposite, &there);
    SE3DI_TRY(find_opposite_ride(motion, &there, &other));
    to_vehicle(model, wheel, p, there.contact, C[1]);
    const double slope2 = -other.material[1] / other.material[2];
    double y = 0.5 * (C[0][1] + C[1][1]);
    if (fabs(slope - slope2) > PARALLEL) {
        y = (C[1][2] - C[0][2] + slope * C[0][1] - slope2 * C[1][1]) / (slope - slope2);
    }
    const double first = C[0][2] + slope * (y - C[0][1]);
    const double second = C[1][2] + slope2 * (y - C[1][1]);
    *height = 0.5 * (first + second - C[0][2] - C[1][2]);
    return SE3D_OK;
}

static void measure_anti(const se3di_wheel *wheel, const ride_rates *ride, double *values)
{
    const double L = wheel->wheelbase > 0.0 ? wheel->wheelbase : (double)NAN;
    const double h = wheel->cg_height > 0.0 ? wheel->cg_height : (double)NAN;
    const double braked = wheel->brake_share * L / h * ride->material[0] / ride->material[2];
    const double driven = wheel->drive_share * L / h * ride->center[0] / ride->center[2];
    values[SE3D_WHEEL_ANTI_DIVE] = braked;
    values[SE3D_WHEEL_ANTI_LIFT] = 0.0 - braked;
    values[SE3D_WHEEL_ANTI_SQUAT] = 0.0 - driven;
}

/* Of a motion with a travel of 1 that has just been found. */
static se3d_status measure_ride(se3di_wheel_motion *motion, const pose *p, double *values)
{
    ride_rates ride;
    double a[3];
    read_ride(motion, motion->wheel, p, &ride);
    to_axes(p, p->axis, a);
    const double level = a[0] * a[0] + a[1] * a[1];
    values[SE3D_WHEEL_CAMBER_GRADIENT] = -ride.axis[2] / sqrt(level);
    values[SE3D_WHEEL_TOE_GRADIENT] =
        -p->side * (a[0] * ride.axis[1] - a[1] * ride.axis[0]) / level;
    values[SE3D_WHEEL_TRACK_GRADIENT] = p->side * ride.contact[1];
    values[SE3D_WHEEL_WHEELBASE_GRADIENT] = ride.contact[0];
    values[SE3D_WHEEL_FRONT_SWING_ARM] = p->side * ride.material[2] / ride.omega[0];
    values[SE3D_WHEEL_FRONT_CENTER_HEIGHT] = ride.material[1] / ride.omega[0];
    values[SE3D_WHEEL_SIDE_SWING_ARM] = ride.material[2] / ride.omega[1];
    values[SE3D_WHEEL_SIDE_CENTER_HEIGHT] = -ride.material[0] / ride.omega[1];
    values[SE3D_WHEEL_MOTION_RATIO] = 0.0 - ride.spring;
    measure_anti(motion->wheel, &ride, values);
    return measure_roll_center(motion, p, &ride, &values[SE3D_WHEEL_ROLL_CENTER_HEIGHT]);
}

/* ---- Loads ---------------------------------------------------------------------------------*/

static se3d_status measure_loads(se3di_wheel_motion *motion, const pose *p, double *values)
{
    const se3di_model *model = motion->model;
    const se3di_wheel *wheel = motion->wheel;
    const double up[2] = {1.0, 0.0};
    SE3DI_TRY(se3di_wheel_load(motion, up, &values[SE3D_WHEEL_WHEEL_LOAD],
                               &values[SE3D_WHEEL_WHEEL_RATE]));
    values[SE3D_WHEEL_ROLL_RATE] = (double)NAN;
    if (wheel->opposite < 0) {
        return SE3D_OK;
    }
    pose other;
    double unused;
    double apart[3];
    take_pose(model, &model->wheels[wheel->opposite], &other);
    se3di_sub(p->contact, other.contact, apart);
    const double half = 0.5 * fabs(se3di_dot(apart, p->axes + 3));
    const double roll[2] = {half, -half};
    return se3di_wheel_load(motion, roll, &unused, &values[SE3D_WHEEL_ROLL_RATE]);
}

/* What needs the ride of the wheel: the equations are factored once. */
static se3d_status measure_motion(const se3di_model *model, const se3di_wheel *wheel, const pose *p,
                                  int wants_ride, int wants_loads, double *values)
{
    se3di_wheel_motion motion;
    const double rates[2] = {1.0, 0.0};
    se3di_wheel_ride_init(&motion, model, wheel, rates);
    SE3DI_TRY(se3di_wheel_motion_find(&motion));
    se3d_status status = wants_ride ? measure_ride(&motion, p, values) : SE3D_OK;
    if (wants_loads && status >= 0) {
        status = measure_loads(&motion, p, values);
    }
    se3di_wheel_motion_destroy(&motion);
    return status;
}

se3d_status se3di_wheel_measure(const se3di_model *model, uint32_t index, size_t first,
                                size_t count, double *values)
{
    const se3di_wheel *wheel = &model->wheels[index];
    const size_t end = first + count;
    pose p;
    take_pose(model, wheel, &p);
    measure_pose(model, wheel, &p, values);
    if (first < SE3D_WHEEL_CAMBER_GRADIENT && end > SE3D_WHEEL_CASTER) {
        SE3DI_TRY(measure_steering(model, wheel, &p, values));
    }
    const int wants_ride = first < SE3D_WHEEL_WHEEL_LOAD && end > SE3D_WHEEL_CAMBER_GRADIENT;
    const int wants_loads = end > SE3D_WHEEL_WHEEL_LOAD;
    return wants_ride || wants_loads
               ? measure_motion(model, wheel, &p, wants_ride, wants_loads, values)
               : SE3D_OK;
}
