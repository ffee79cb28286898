/* SPDX-License-Identifier: BSD-3-Clause */
/* Example models whose end state or modes have a closed form: each is run to its files, then its
 * channels are compared at the end. */
#include <stdlib.h>

#include "check.h"
#include "se3d/io.h"

typedef struct example {
    se3d_model *model;
    se3d_run *run;
    se3d_status status;
} example;

static example run_by(const char *name, const char *setting, const char *value,
                      const char *formulation, const char *method)
{
    example e = {NULL, NULL, SE3D_OK};
    char path[800];
    char folder[800];
    se3d_model_error error;
    const se3d_model_setting settings[] = {{setting, value}};
    se3d_model_options options = se3d_model_options_default();
    se3d_run_options how = se3d_run_options_default();
    const char *source = getenv("SE3D_SOURCE_DIR");
    options.settings = settings;
    options.setting_count = setting ? 1 : 0;
    options.formulation = formulation;
    options.method = method;
    snprintf(path, sizeof path, "%s/examples/models/%s.yaml", source ? source : ".", name);
    snprintf(folder, sizeof folder, "%s/golden/%s", check_scratch(), name);
    how.directory = folder;
    e.status = se3d_model_read_file(path, &options, &e.model, &error);
    if (e.status >= 0) {
        CHECK(se3d_model_count_pictures(e.model) == 0); /* they run where there is no gnuplot */
        e.status = se3d_model_run(e.model, &how, &e.run, &error);
    }
    if (e.status < 0) {
        fprintf(stderr, "%s: %s\n", name, error.message);
    }
    CHECK(e.status >= 0);
    return e;
}

static example run_example(const char *name, const char *setting, const char *value,
                           const char *formulation)
{
    return run_by(name, setting, value, formulation, NULL);
}

static void close_example(example *e)
{
    se3d_run_destroy(e->run);
    se3d_model_destroy(e->model);
}

/* Component `part` of a channel of the first output, at the end. */
static double channel_of(const example *e, const char *wanted, size_t part)
{
    const char *name = "";
    double value[4] = {0.0, 0.0, 0.0, 0.0};
    size_t width = 0;
    for (size_t k = 0; se3d_model_get_channel(e->model, 0, k, &name) == SE3D_OK; ++k) {
        if (strcmp(name, wanted) == 0) {
            CHECK(se3d_model_get_channel_value(e->model, 0, k, NULL, value, &width) == SE3D_OK);
            CHECK(part < width);
            return value[part];
        }
    }
    fprintf(stderr, "no channel %s\n", wanted);
    const int channel_exists = 0;
    CHECK(channel_exists);
    return 0.0;
}

/* Number `column` of row `row` (both from 0, without the header) of the file that ends in `suffix`.
 */
static double file_number(const example *e, const char *suffix, size_t row, size_t column)
{
    char line[8000] = "";
    double value = (double)NAN;
    se3d_run_file file;
    for (size_t k = 0; se3d_run_get_file(e->run, k, &file) == SE3D_OK; ++k) {
        const size_t length = strlen(file.path);
        if (length < strlen(suffix) || strcmp(file.path + length - strlen(suffix), suffix) != 0) {
            continue;
        }
        FILE *stream = fopen(file.path, "rb");
        for (size_t i = 0; stream && i < row + 2; ++i) {
            if (!fgets(line, sizeof line, stream)) {
                line[0] = '\0';
            }
        }
        const char *at = line;
        for (size_t i = 0; at && i < column; ++i) {
            at = strchr(at, ',');
            at = at ? at + 1 : NULL;
        }
        value = at && *at ? strtod(at, NULL) : value;
        if (stream) {
            fclose(stream);
        }
    }
    return value;
}

static const char *const formulations[] = {"romega", "rp", "joint"};

/* x = 1/2 g (sin - mu cos) t^2; sliding begins within the first step, and the load follows
 * from step to step. */
static void block_above_the_friction_angle_slides_as_coulomb_says(void)
{
    for (int f = 0; f < 3; ++f) {
        example e = run_example("incline_friction", NULL, NULL, formulations[f]);
        const double slope = acos(-1.0) / 6.0;
        const double a = 9.81 * (sin(slope) - 0.3 * cos(slope));
        CHECK_NEAR(channel_of(&e, "guide.displacement", 0), 2.0 * a, 1e-4);
        CHECK_NEAR(channel_of(&e, "block.acceleration", 0), a * cos(slope), 1e-6);
        CHECK_NEAR(channel_of(&e, "block.acceleration", 2), -a * sin(slope), 1e-6);
        /* Against the motion, with mu times m g cos. */
        CHECK_NEAR(channel_of(&e, "friction.force", 0), 0.3 * 2.0 * 9.81 * cos(slope), 1e-6);
        CHECK_NEAR(channel_of(&e, "energy.dissipated", 0),
                   0.3 * 2.0 * 9.81 * cos(slope) * channel_of(&e, "guide.displacement", 0), 1e-6);
        CHECK_NEAR(channel_of(&e, "energy.balance", 0), 0.0, 1e-6);
        close_example(&e);
    }
}

static void block_below_the_friction_angle_does_not_creep(void)
{
    example e = run_example("incline_friction", "slope", "15*deg", NULL);
    CHECK_NEAR(channel_of(&e, "guide.displacement", 0), 0.0, 1e-9);
    CHECK_NEAR(channel_of(&e, "friction.force", 0), 2.0 * 9.81 * sin(acos(-1.0) / 12.0), 1e-6);
    close_example(&e);
}

/* The moment about the pin, positive turns the bar up, by its definition. */
static double bar_moment(double angle)
{
    const double tip[2] = {cos(angle), sin(angle)};
    const double d[2] = {1.5 - tip[0], 0.5 - tip[1]};
    const double l = hypot(d[0], d[1]);
    const double f = 300.0 * (l - 0.8);
    return -20.0 * angle - 10.0 * 9.81 * 0.5 * cos(angle) + f * (tip[0] * d[1] - tip[1] * d[0]) / l;
}

static void bar_comes_to_rest_where_its_moments_balance(void)
{
    example e = run_example("bar_equilibrium", NULL, NULL, NULL);
    const double h = 1e-5;
    double low = -0.5;
    double high = 0.0;
    for (int k = 0; k < 100; ++k) {
        const double middle = 0.5 * (low + high);
        *(bar_moment(middle) > 0.0 ? &low : &high) = middle;
    }
    const double angle = channel_of(&e, "pin.angle", 0);
    CHECK_NEAR(angle, low, 1e-12);
    CHECK_NEAR(channel_of(&e, "torsion.torque", 0), 20.0 * low, 1e-10);
    /* Frequency and damping from the stiffness K, the damper's lever and the inertia about the pin.
     */
    const double inertia = 10.0 / 12.0 + 10.0 * 0.25;
    const double K = -(bar_moment(low + h) - bar_moment(low - h)) / (2.0 * h);
    const double d[2] = {1.5 - cos(low), 0.5 - sin(low)};
    const double lever = (cos(low) * d[1] - sin(low) * d[0]) / hypot(d[0], d[1]);
    const double w = sqrt(K / inertia);
    const double zeta = (1.5 + 5.0 * lever * lever) / (2.0 * inertia * w);
    CHECK_NEAR(file_number(&e, "modes.csv", 0, 3), w / (2.0 * acos(-1.0)), 1e-7);
    CHECK_NEAR(file_number(&e, "modes.csv", 0, 4), zeta, 1e-8);
    CHECK_NEAR(file_number(&e, "modes.csv", 0, 1), -zeta * w, 1e-7);
    /* A and B of the one freedom; the static answer of the tip to 1 N is cos^2/K. */
    CHECK_NEAR(file_number(&e, "modes_A.csv", 1, 1), -w * w, 1e-5);
    CHECK_NEAR(file_number(&e, "modes_A.csv", 1, 2), -2.0 * zeta * w, 1e-7);
    CHECK_NEAR(file_number(&e, "modes_D.csv", 0, 1), 0.0, 0.0);
    const double s = 2.0 * acos(-1.0) * 0.1;
    const double re = w * w - s * s;
    const double im = 2.0 * zeta * w * s;
    const double answer = cos(low) * cos(low) / inertia / (re * re + im * im);
    CHECK_NEAR(file_number(&e, "modes_transfer.csv", 0, 1), answer * re, 1e-9);
    CHECK_NEAR(file_number(&e, "modes_transfer.csv", 0, 2), -answer * im, 1e-9);
    CHECK_NEAR(file_number(&e, "modes_transfer.csv", 0, 3), answer / cos(low) * re, 1e-9);
    CHECK_NEAR(file_number(&e, "modes_transfer.csv", 0, 4), -answer / cos(low) * im, 1e-9);
    CHECK_NEAR(file_number(&e, "modes_transfer.csv", 99, 0), 10.0, 0.0);
    CHECK(file_number(&e, "modes_B.csv", 1, 1) * file_number(&e, "modes_C.csv", 0, 1) > 0.0);
    CHECK(e.status == SE3D_OK);
    close_example(&e);
}

/* 0.2 T0 of load: w = 0.8 w0, and w^2 as in the head of the file. */
static void governor_finds_its_steady_motion(void)
{
    for (int f = 0; f < 3; ++f) {
        example e = run_example("flyball_governor", NULL, NULL, formulations[f]);
        const double w = channel_of(&e, "bearing.rate", 0);
        const double alpha = channel_of(&e, "pivot_right.angle", 0);
        CHECK_NEAR(w, 9.6, 2e-5);
        CHECK_NEAR(channel_of(&e, "pivot_left.angle", 0), alpha, 1e-6);
        const double balance = (1.5 * 0.3 + 3.0 * 0.2) * 9.81 * sin(alpha) /
                               (1.5 * 0.3 * cos(alpha) * (0.03 + 0.3 * sin(alpha)));
        CHECK_NEAR(w * w, balance, 2e-4);
        CHECK_NEAR(channel_of(&e, "slide.displacement", 0),
                   0.4 * (cos(acos(-1.0) / 6.0) - cos(alpha)), 1e-6);
        /* The motor has put in what the load took, the dashpot turned to heat or is stored. */
        CHECK_NEAR(channel_of(&e, "energy.balance", 0),
                   file_number(&e, "flyball_governor.csv", 0, 10), 1e-5);
        CHECK(file_number(&e, "modes.csv", 1, 1) < -0.5); /* it hunts not */
        CHECK(file_number(&e, "modes.csv", 2, 4) > 0.3);
        close_example(&e);
    }
}

/* After the bump everything is as before, the forces are the weights; the tyre never pulled. */
static void quarter_car_settles_and_its_tyre_never_pulls(void)
{
    example e = run_example("quarter_car", NULL, NULL, NULL);
    double largest = -1e9;
    double blocks = 0.0;
    for (size_t k = 0; k < 301; ++k) {
        largest = fmax(largest, file_number(&e, "quarter_car.csv", k, 9));
        blocks = fmin(blocks, file_number(&e, "quarter_car.csv", k, 10));
    }
    CHECK(!(largest > 0.0));
    CHECK_NEAR(largest, 0.0, 1e-12); /* it leaves the road */
    CHECK(blocks < -100.0);
    CHECK_NEAR(channel_of(&e, "strut.displacement", 0), 0.0, 1e-5);
    CHECK_NEAR(channel_of(&e, "spring.force", 0), -300.0 * 9.81, 1.0);
    CHECK_NEAR(channel_of(&e, "tyre.force", 0), -340.0 * 9.81, 1.0);
    CHECK_NEAR(channel_of(&e, "travel", 0), channel_of(&e, "spring.length", 0) - 0.5, 1e-15);
    CHECK_NEAR(file_number(&e, "ride.csv", 1, 3), largest, 0.0); /* max of tyre.force */
    CHECK_NEAR(file_number(&e, "ride.csv", 2, 8), channel_of(&e, "travel", 0), 1e-12);
    close_example(&e);
}

/* The tube stands still where the star is; the mount is found by its own motor. */
static void servo_finds_its_star(void)
{
    example e = run_example("servo", NULL, NULL, NULL);
    CHECK_NEAR(channel_of(&e, "pointing", 0), 0.2, 1e-6);
    CHECK_NEAR(channel_of(&e, "error", 0), 0.2 - channel_of(&e, "pointing", 0), 1e-15);
    CHECK_NEAR(channel_of(&e, "tube.eye.position.y", 0), sin(channel_of(&e, "pointing", 0)), 1e-9);
    CHECK_NEAR(channel_of(&e, "motor.effort", 0), 0.0, 1e-3);
    close_example(&e);
}

/* The cart is where it should be; without anti-windup it overshoots by a third. */
/* At 1.5 s: the cam and its torque about the crank; the angle of the shaft, whose ratio was 1, 1.5
 * on the way, and 2; the gripper, which goes with 0.5 m/s until it is 0.0625 m off. */
static void axes_follow_the_crank_as_they_are_told(void)
{
    example e = run_example("electronic_cam", NULL, NULL, NULL);
    const double lift = 0.04, w = 6.0, angle = 9.0;
    const double ram = 6.0 * (0.5 * lift * w * w * cos(angle) + 9.81);
    CHECK_NEAR(channel_of(&e, "guide.displacement", 0), 0.5 * lift * (1.0 - cos(angle)), 1e-9);
    CHECK_NEAR(channel_of(&e, "cam.effort", 0), ram, 1e-6);
    CHECK_NEAR(channel_of(&e, "motor.effort", 0), ram * 0.5 * lift * sin(angle), 1e-6);
    CHECK_NEAR(channel_of(&e, "shaft.angle", 0), w * (0.5 + 0.2 * 1.5 + 0.8 * 2.0), 1e-7);
    CHECK_NEAR(channel_of(&e, "slide.displacement", 0), 0.1 - 0.0625 * exp(-8.0 * 1.425), 1e-7);
    close_example(&e);
}

static void controller_brings_its_cart(void)
{
    example e = run_example("controller", NULL, NULL, NULL);
    CHECK_NEAR(channel_of(&e, "rail.displacement", 0), 1.0, 2e-3);
    CHECK_NEAR(channel_of(&e, "motor.value", 0), 6.0, 0.05);
    CHECK(channel_of(&e, "spent.value", 0) > 6.0); /* the work against the slope */
    CHECK(file_number(&e, "controller.csv", 151, 1) < 0.7);
    close_example(&e);
}

/* What falls comes to rest. What was dissipated is what the boxes have lost, but for the order of
 * the method; box12 lies on the floor, on four corners. */
static void heap_comes_to_rest(void)
{
    example e = run_example("heap", NULL, NULL, NULL);
    const double first = 12.0 * 0.5 * 9.81 * 0.26;
    const double now = channel_of(&e, "energy.potential", 0);
    CHECK(channel_of(&e, "energy.kinetic", 0) < 1e-12);
    CHECK(now < 0.6 * first && now > 12.0 * 0.5 * 9.81 * 0.0499);
    CHECK_NEAR(now + channel_of(&e, "energy.dissipated", 0), first, 0.02 * first);
    CHECK_NEAR(channel_of(&e, "box12.position", 2), 0.05 - 0.5 * 9.81 / 4e5, 1e-8);
    close_example(&e);
}

/* Wheel and contact point at t = 0.3 s, from the distances between the ball joints alone: eleven
 * equations for the angles of the arms and three points of the upright, by a program of its own. */
static void suspension_steers_and_travels_as_its_distances_say(void)
{
    static const double wheel[] = {-0.00957547201023548, 0.606452650033026, 0.2564663452836};
    static const double contact[] = {-0.00420306653600744, 0.607418404850378, 0.0285316954888546};
    for (int f = 0; f < 3; ++f) {
        example e = run_example("suspension", "end", "0.3", formulations[f]);
        for (size_t k = 0; k < 3; ++k) {
            CHECK_NEAR(channel_of(&e, "upright.wheel_centre.position", k), wheel[k], 1e-13);
            CHECK_NEAR(channel_of(&e, "upright.contact.position", k), contact[k], 1e-13);
        }
        /* The road's push sideways and the rig's upwards press the pushrod. */
        CHECK(channel_of(&e, "push_lower.force", 1) < -500.0);
        CHECK(channel_of(&e, "push_lower.force", 2) > 500.0);
        close_example(&e);
    }
}

/* The wheels go where the road lifts them, alike on both sides to the last bit. */
static void axle_of_one_corner_is_symmetric(void)
{
    for (int f = 0; f < 3; ++f) {
        example e = run_example("axle", NULL, NULL, formulations[f]);
        const double left[] = {channel_of(&e, "left_upright.position", 0),
                               0.0 - channel_of(&e, "left_upright.position", 1),
                               channel_of(&e, "left_upright.position", 2)};
        for (size_t k = 0; k < 3; ++k) {
            CHECK_NEAR(channel_of(&e, "right_upright.position", k), left[k], 0.0);
        }
        CHECK_NEAR(left[2], 0.25, 1e-12);
        CHECK_NEAR(channel_of(&e, "left_upper_arm_from.angle", 0),
                   channel_of(&e, "right_upper_arm_from.angle", 0), 1e-14);
        CHECK_NEAR(channel_of(&e, "left_spring.force", 0), channel_of(&e, "right_spring.force", 0),
                   1e-9);
        close_example(&e);
    }
}

/* The reference solution of the Test Set for IVP Solvers (Mazzia and Magherini 2008), which is
 * given for angles that begin with the same digits. */
static void andrews_squeezer_ends_at_the_published_angles(void)
{
    static const struct {
        const char *channel;
        double angle;
    } table[] = {{"O.angle", 15.81077119629904},   {"F.angle", -15.75637105984298},
                 {"B.angle", 0.04082224013073101}, {"H.angle", -0.5347301163226948},
                 {"A5.angle", 0.5244099658805304}, {"G.angle", 0.5347301163226948},
                 {"A7.angle", 1.048080741042263}};
    for (int f = 0; f < 3; ++f) {
        example e = run_example("andrews", NULL, NULL, formulations[f]);
        for (size_t k = 0; k < sizeof table / sizeof table[0]; ++k) {
            CHECK_NEAR(channel_of(&e, table[k].channel, 0), table[k].angle, 2e-9);
        }
        close_example(&e);
    }
}

/* After whole periods of the elliptic integral it is where it began. */
static void many_swings_end_where_they_began(void)
{
    example e = run_example("many_swings", NULL, NULL, NULL);
    CHECK_NEAR(channel_of(&e, "pin.angle", 0), 0.0, 1e-9);
    CHECK_NEAR(channel_of(&e, "pin.rate", 0), 0.0, 5e-7);
    CHECK_NEAR(channel_of(&e, "energy.total", 0), 0.0, 1e-8);
    close_example(&e);
}

/* Behind the kerb everything is as before: the tyre carries the weight and never pulled. */
static void suspension_settles_behind_the_kerb(void)
{
    example e = run_example("suspension_kerb", NULL, NULL, NULL);
    double largest = -1e9;
    double least = 0.0;
    for (size_t k = 0; k < 601; ++k) {
        const double force = file_number(&e, "suspension_kerb.csv", k, 15);
        largest = fmax(largest, force);
        least = fmin(least, force);
    }
    CHECK(largest == 0.0); /* it leaves the road */
    CHECK(least < -2500.0);
    /* nearly: it leans a little, as the wheel moves sideways */
    CHECK_NEAR(file_number(&e, "suspension_kerb.csv", 0, 15), -85.25 * 9.81, 1e-3);
    CHECK_NEAR(channel_of(&e, "tyre.force", 0), -85.25 * 9.81, 1.0);
    CHECK_NEAR(channel_of(&e, "heave.displacement", 0),
               file_number(&e, "suspension_kerb.csv", 0, 2), 2e-5);
    CHECK_NEAR(channel_of(&e, "energy.balance", 0), file_number(&e, "suspension_kerb.csv", 0, 38),
               1e-5);
    close_example(&e);
}

/* One equation is redundant at every position: the reactions of least norm do not depend on the
 * method, which would add rounding in the dependent direction, step by step. */
static void overconstrained_loop_has_the_same_reactions_by_every_method(void)
{
    static const struct {
        const char *method;
        double tolerance;
    } table[] = {{"dop853", 3e-5},
                 {"bdf", 5e-5},
                 {"rattle", 2e-3},
                 {"hht", 2e-2},
                 {"generalized_alpha", 2e-2}};
    example exact = run_example("bricard", NULL, NULL, "romega");
    for (size_t m = 0; m < sizeof table / sizeof table[0]; ++m) {
        for (int f = 0; f < 3; ++f) {
            if (!check_is_long() && f != (int)m % 3) {
                continue; /* seconds each */
            }
            example e = run_by("bricard", NULL, NULL, formulations[f], table[m].method);
            for (size_t k = 0; k < 3; ++k) {
                CHECK_NEAR(channel_of(&e, "c.force", k), channel_of(&exact, "c.force", k),
                           table[m].tolerance);
                CHECK_NEAR(channel_of(&e, "e.torque", k), channel_of(&exact, "e.torque", k),
                           table[m].tolerance);
            }
            CHECK(fabs(channel_of(&e, "violation.position", 0)) < 1e-11);
            CHECK_NEAR(channel_of(&e, "energy.balance", 0), -29.43, 1e-4);
            close_example(&e);
        }
    }
    close_example(&exact);
}

/* M x'' + c x' + k x = m e w^2 cos(angle) at constant speed; what began before has died away. */
static void rotor_whirls_as_its_imbalance_says(void)
{
    const double w = 20.0 * acos(-1.0), mass = 5.0, k = 2000.0, c = 20.0, push = 0.02 * w * w;
    const double stiff = k - mass * w * w, damp = c * w, angle = w * (12.0 - 2.0);
    const double x =
        push * (stiff * cos(angle) + damp * sin(angle)) / (stiff * stiff + damp * damp);
    for (int f = 0; f < 3; ++f) {
        example e = run_example("run_up", NULL, NULL, formulations[f]);
        CHECK_NEAR(channel_of(&e, "rail.displacement", 0), x, 1e-9);
        CHECK_NEAR(channel_of(&e, "bearing.rate", 0), w, 1e-9);
        CHECK_NEAR(channel_of(&e, "energy.balance", 0), 0.0, 1e-5);
        close_example(&e);
    }
}

/* Nothing but contact carries the motion: the angles made between 0.3 and 0.6 s, in which 5 teeth
 * pass, are as the teeth. */
static void gears_as_meshes_turn_each_other_at_their_ratio(void)
{
    example e = run_example("gear_mesh", NULL, NULL, NULL);
    double turned[2];
    for (size_t k = 0; k < 2; ++k) {
        turned[k] =
            file_number(&e, "gears.csv", 60, 1 + k) - file_number(&e, "gears.csv", 30, 1 + k);
    }
    CHECK(turned[0] > 1.8);
    CHECK_NEAR(turned[1] / turned[0], -18.0 / 27.0, 1e-3);
    close_example(&e);
}

/* Of two rows of `file` one after the other the time between them at which a column is 0, by the
 * chord; NAN: it does not change its sign there. */
static double zero_between(const example *e, const char *file, size_t row, size_t column)
{
    const double from = file_number(e, file, row, column);
    const double to = file_number(e, file, row + 1, column);
    const double begin = file_number(e, file, row, 0), end = file_number(e, file, row + 1, 0);
    return from * to < 0.0 ? begin + (end - begin) * from / (from - to) : (double)NAN;
}

/* The half period of a pendulum of inertia J about the ball, 2 pi sqrt(J/(m g l)) by the series of
 * its amplitude, hardly known to Coulomb friction. That takes 2 M/(m g l) off the amplitude a half
 * period: the ball is on a rim seen at the angle b from the axis, N = m g/cos(b) all round, and M =
 * mu R N times the mean of sqrt(1 - (sin(b) cos(s))^2) over s, without what the swing adds. */
static void socket_holds_its_ball(void)
{
    const double pi = acos(-1.0), l = 0.2, m = 2.0, g = 9.81, mu = 0.02, radius = 0.025;
    const double inertia = 0.002 + m * l * l, swing = 15.0 * pi / 180.0;
    const double half = pi * sqrt(inertia / (m * g * l)) * (1.0 + swing * swing / 16.0);
    const double sine = 0.0258 * cos(50.0 * pi / 180.0) / radius; /* of the angle b */
    double mean = 0.0, first = 0.0, last = 0.0, amplitude[2] = {0.0, 0.0};
    int swings = -1;
    for (int k = 0; k < 360; ++k) {
        const double part = sine * cos(k * pi / 180.0);
        mean += sqrt(1.0 - part * part) / 360.0;
    }
    const double loss = 2.0 * mu * radius * mean / sqrt(1.0 - sine * sine) / l;
    example e = run_example("ball_socket", NULL, NULL, NULL);
    for (size_t row = 0; row < 150; ++row) {
        const double time = zero_between(&e, "ball_socket.csv", row, 5);
        for (size_t column = 1; column < 4; ++column) {
            CHECK(fabs(file_number(&e, "ball_socket.csv", row, column)) < 4e-4); /* its play */
        }
        if (!isnan(time)) {
            first = ++swings == 0 ? time : first;
            last = time;
        }
        const double angle = asin(fabs(file_number(&e, "ball_socket.csv", row, 5)) / l);
        if (swings == 0 || swings == 4) {
            amplitude[swings / 4] = fmax(amplitude[swings / 4], angle);
        }
    }
    CHECK(swings == 6);
    CHECK_NEAR((last - first) / swings, half, 3e-3 * half);
    CHECK_NEAR((amplitude[0] - amplitude[1]) / 4.0, loss, 0.15 * loss);
    close_example(&e);
}

/* Every point of contact is a spring of 1e7 N/m: 12 of a head or nut (four of its rim, eight
 * corners of its hole), 16 between the flanges, whose middle is not quite theirs. A head bears what
 * its nut bears and the bolt's weight; all heads bear what pulls and what presses the flanges on
 * each other. */
static void bolts_bear_what_their_joint_diagram_says(void)
{
    const double k = 1e7, bolts = 12.0, head = 12.0 * k, thick = 0.015, stretch = 20e-6;
    const double weight = 3.3732724343e-4 * 7800.0 * 9.81, bolt = 0.03 * 9.81;
    example e = run_example("flange", NULL, NULL, NULL);
    for (size_t row = 35; row < 101; ++row) {
        const int is_open = row > 80;
        const double pull = (is_open ? 20e3 : 10e3) - weight, between = is_open ? 0.0 : 16.0 * k;
        const double gap =
            ((2.0 * pull / bolts - bolt) / head - stretch) / (1.0 + 2.0 * between / (bolts * head));
        if (row > 50 && !is_open) {
            continue; /* it is pulled more and more */
        }
        CHECK_NEAR(file_number(&e, "flange.csv", row, 6), thick + gap, is_open ? 1e-12 : 1e-9);
        CHECK_NEAR(file_number(&e, "flange.csv", row, 9), 0.0, 1e-11);
        CHECK_NEAR(file_number(&e, "flange.csv", row, 12), -pull, 1e-9 * pull);
        CHECK_NEAR(file_number(&e, "flange.csv", row, 18), bolt, 1e-6);
        CHECK_NEAR(file_number(&e, "flange.csv", row, 19), is_open ? 288.0 : 304.0, 0.0);
    }
    close_example(&e);
}

int main(void)
{
    RUN(block_above_the_friction_angle_slides_as_coulomb_says);
    RUN(block_below_the_friction_angle_does_not_creep);
    RUN(bar_comes_to_rest_where_its_moments_balance);
    RUN(governor_finds_its_steady_motion);
    RUN(quarter_car_settles_and_its_tyre_never_pulls);
    RUN(servo_finds_its_star);
    RUN(axes_follow_the_crank_as_they_are_told);
    RUN(controller_brings_its_cart);
    RUN(rotor_whirls_as_its_imbalance_says);
    RUN(heap_comes_to_rest);
    RUN(suspension_steers_and_travels_as_its_distances_say);
    RUN(axle_of_one_corner_is_symmetric);
    RUN(andrews_squeezer_ends_at_the_published_angles);
    RUN(suspension_settles_behind_the_kerb);
    RUN(many_swings_end_where_they_began);
    RUN(overconstrained_loop_has_the_same_reactions_by_every_method);
    RUN(gears_as_meshes_turn_each_other_at_their_ratio);
    RUN(socket_holds_its_ball);
    RUN(bolts_bear_what_their_joint_diagram_says);
    return check_finish();
}
