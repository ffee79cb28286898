/* SPDX-License-Identifier: BSD-3-Clause */
/* Symbols of a sketch, after ISO 3952: pins as circles where their axis points to the eye and as
 * bearings along it elsewhere, slides as blocks on rails, balls in sockets. Numbers are pixels. */
#include <math.h>

#include "io/base/elementary.h"
#include "io/write/sketch_view.h"

#define DEGREE 0.017453292519943295 /* [rad] */
#define HIDDEN 0.35                 /* of an axis that points to the eye */

static se3di_spot shift(const se3di_symbol *s, double along, double across)
{
    const se3di_spot spot = {s->at.x + along * s->along.x - across * s->along.y,
                             s->at.y + along * s->along.y + across * s->along.x};
    return spot;
}

static void put_block(const se3di_symbol *s, const char *kind, double length, double width)
{
    const se3di_spot corners[4] = {shift(s, -length, -width), shift(s, length, -width),
                                   shift(s, length, width), shift(s, -length, width)};
    se3di_svg_path(s->file, kind, corners, 4, true);
}

static void put_along(const se3di_symbol *s, const char *kind, double from, double to)
{
    se3di_svg_line(s->file, kind, shift(s, from, 0.0), shift(s, to, 0.0));
}

/* A part of a circle, angles [degrees] from the right, downwards. */
static void put_arc(FILE *file, const char *kind, se3di_spot at, double radius, double from,
                    double to)
{
    se3di_spot points[19];
    for (int k = 0; k < 19; ++k) {
        const double angle = (from + (to - from) * k / 18.0) * DEGREE;
        points[k].x = at.x + radius * io_cos(angle);
        points[k].y = at.y + radius * io_sin(angle);
    }
    se3di_svg_path(file, kind, points, 19, false);
}

static void put_pin(const se3di_symbol *s)
{
    if (s->seen < HIDDEN) {
        se3di_svg_circle(s->file, "open", s->at, 6.0);
        se3di_svg_circle(s->file, "full", s->at, 1.5);
    } else {
        put_along(s, "axis", -22.0, 22.0);
        put_block(s, "open", 9.0, 5.0);
        put_along(s, "thin", -9.0, 9.0);
    }
}

static void put_slide(const se3di_symbol *s, bool is_round, bool is_screw)
{
    if (s->seen < HIDDEN) {
        if (is_round) {
            se3di_svg_circle(s->file, "open", s->at, 7.0);
        } else {
            put_block(s, "open", 7.0, 7.0);
        }
        se3di_svg_circle(s->file, "full", s->at, 3.0);
        return;
    }
    put_along(s, "thick", -28.0, 28.0);
    put_block(s, "open", 12.0, is_round ? 6.0 : 8.0);
    if (is_round) {
        put_along(s, "axis", -12.0, 12.0);
    }
    for (int k = -2; is_screw && k < 2; ++k) {
        se3di_svg_line(s->file, "thin", shift(s, 6.0 * k, 6.0), shift(s, 6.0 * k + 6.0, -6.0));
    }
}

static void put_plane(const se3di_symbol *s, double half)
{
    se3di_svg_line(s->file, "thick", shift(s, 0.0, -half), shift(s, 0.0, half));
    for (double y = -half; y <= half - 4.0; y += 6.0) {
        se3di_svg_line(s->file, "hatch", shift(s, -5.0, y), shift(s, 0.0, y + 5.0));
    }
}

void se3di_symbol_put_joint(const se3di_symbol *s, se3di_joint_look look)
{
    switch (look) {
    case SE3DI_JOINT_BLOCK:
        put_block(s, "full", 5.0, 5.0);
        break;
    case SE3DI_JOINT_PIN:
        put_pin(s);
        break;
    case SE3DI_JOINT_SLIDER:
    case SE3DI_JOINT_SLEEVE:
    case SE3DI_JOINT_SCREW:
        put_slide(s, look != SE3DI_JOINT_SLIDER, look == SE3DI_JOINT_SCREW);
        break;
    case SE3DI_JOINT_CROSS:
        se3di_svg_circle(s->file, "open", s->at, 8.0);
        put_along(s, "thick", -8.0, 8.0);
        se3di_svg_line(s->file, "thick", shift(s, 0.0, -8.0), shift(s, 0.0, 8.0));
        break;
    case SE3DI_JOINT_PLATE:
    case SE3DI_JOINT_ON_PLANE:
        put_plane(s, 18.0);
        se3di_svg_circle(s->file, look == SE3DI_JOINT_PLATE ? "open" : "full", s->at, 4.5);
        break;
    case SE3DI_JOINT_ON_LINE:
        put_along(s, "thick", -28.0, 28.0);
        se3di_svg_circle(s->file, "full", s->at, 4.5);
        break;
    case SE3DI_JOINT_BALL:
        put_arc(s->file, "thick", s->at, 8.0, 30.0, 330.0);
        se3di_svg_circle(s->file, "full", s->at, 4.5);
        break;
    default: /* it has no point */
        break;
    }
}

void se3di_symbol_put_ground(FILE *file, se3di_spot at)
{
    const double y = at.y + 17.0;
    se3di_svg_line(file, "thin", at, (se3di_spot){at.x - 8.0, y});
    se3di_svg_line(file, "thin", at, (se3di_spot){at.x + 8.0, y});
    se3di_svg_line(file, "thick", (se3di_spot){at.x - 13.0, y}, (se3di_spot){at.x + 13.0, y});
    for (int k = 0; k < 5; ++k) {
        const double x = at.x - 9.0 + 5.0 * k;
        se3di_svg_line(file, "hatch", (se3di_spot){x, y}, (se3di_spot){x - 4.0, y + 6.0});
    }
}

void se3di_symbol_put_driver(FILE *file, se3di_spot at)
{
    const se3di_spot tip = {at.x + 15.0 * io_cos(-20.0 * DEGREE),
                            at.y + 15.0 * io_sin(-20.0 * DEGREE)};
    const se3di_spot head[3] = {{tip.x - 5.0, tip.y - 3.0}, tip, {tip.x + 3.0, tip.y - 6.0}};
    put_arc(file, "thick", at, 15.0, -160.0, -20.0);
    se3di_svg_path(file, "thick", head, 3, false);
}

/* A symbol in the middle of the line from a to b. @return the length of the line. */
static double lie_between(se3di_symbol *s, FILE *file, se3di_spot a, se3di_spot b)
{
    const double x = b.x - a.x;
    const double y = b.y - a.y;
    const double length = sqrt(x * x + y * y);
    s->file = file;
    s->at = (se3di_spot){0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
    s->along = length > 0.0 ? (se3di_spot){x / length, y / length} : (se3di_spot){1.0, 0.0};
    s->seen = 1.0;
    return length;
}

void se3di_symbol_put_spring(FILE *file, se3di_spot a, se3di_spot b, double beside)
{
    se3di_symbol s;
    se3di_spot points[16];
    const double half = 0.5 * lie_between(&s, file, a, b);
    const double coil = fmax(half - 10.0, 0.6 * half);
    points[0] = a;
    points[1] = shift(&s, -coil, beside);
    for (int k = 0; k < 12; ++k) {
        points[2 + k] =
            shift(&s, -coil + coil * (2.0 * k + 1.0) / 12.0, beside + (k % 2 ? -6.0 : 6.0));
    }
    points[14] = shift(&s, coil, beside);
    points[15] = b;
    se3di_svg_path(file, "thin", points, 16, false);
}

void se3di_symbol_put_damper(FILE *file, se3di_spot a, se3di_spot b, double beside)
{
    se3di_symbol s;
    const double half = 0.5 * lie_between(&s, file, a, b);
    const double box = fmin(12.0, 0.4 * half);
    const se3di_spot cup[4] = {shift(&s, box, beside - 6.0), shift(&s, -box, beside - 6.0),
                               shift(&s, -box, beside + 6.0), shift(&s, box, beside + 6.0)};
    const se3di_spot from[3] = {a, shift(&s, -fmax(half - 10.0, box), beside),
                                shift(&s, -box, beside)};
    const se3di_spot to[3] = {shift(&s, 0.0, beside), shift(&s, fmax(half - 10.0, box), beside), b};
    se3di_svg_path(file, "thin", cup, 4, false);
    se3di_svg_path(file, "thin", from, 3, false);
    se3di_svg_path(file, "thin", to, 3, false);
    se3di_svg_line(file, "thick", shift(&s, 0.0, beside - 4.0), shift(&s, 0.0, beside + 4.0));
}
