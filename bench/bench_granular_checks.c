/* SPDX-License-Identifier: BSD-3-Clause */
/* Long checks of granular beds, of which the tests hold short versions; what they tell is recorded
 * in granular/README.md.
 *
 *     bench_granular_checks WHAT [NAME=VALUE...]
 *
 *     static     edge=20 settle=150000 seconds=10: a settled box; who carries its weight, and does
 *                any sphere creep?
 *     avalanche  edge=16 steps=1e6: gravity turns about a closed box; is every sphere inside, and
 *                does a snapshot from the middle, on another number of threads, end with the same
 *                bits?
 *     hopper     opening=6 d=0.006: discharge through a circular hole of so many diameters,
 *                beside Beverloo's law
 *     drum       edge=16 rate=2: the slope in a drum that turns by so many rad/s
 *
 * law=hooke|hertz, friction=0.5, rolling=0, threads=1 if it matters. */
#define _POSIX_C_SOURCE 200809L
#include "se3d/se3d.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define G  9.81

#define HOLE_SIDES  48
#define DRUM_PLANES 24

typedef struct bed {
    se3d_system *system;
    se3d_particles *particles;
    se3d_material material;
    size_t count;
    double *r, *old; /* [3 * count] */
    int hertz, threads;
    double edge, settle, seconds, steps, opening, d, rate, friction, rolling;
} bed;

static void must(const bed *b, se3d_status status)
{
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(b->system));
        exit(1);
    }
}

static void open_bed(bed *b, double stiffness, double restitution)
{
    se3d_particles_def def = se3d_particles_def_default();
    se3d_contact_settings contact = se3d_contact_settings_default();
    se3d_material_def stuff = se3d_material_def_default();
    must(b, se3d_system_create(NULL, &b->system));
    contact.law = b->hertz ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE;
    must(b, se3d_system_set_contact(b->system, &contact));
    def.threads = b->threads;
    must(b, se3d_particles_create(b->system, &def, &b->particles));
    stuff.density = 2500.0;
    stuff.stiffness = stiffness;
    stuff.young = 1e8;
    stuff.friction = b->friction;
    stuff.rolling_friction = b->rolling;
    stuff.restitution = restitution;
    must(b, se3d_material_create(b->system, &stuff, &b->material));
}

static void add_plane(bed *b, se3d_body body, const double point[3], const double normal[3])
{
    se3d_shape_def wall = se3d_shape_def_default();
    se3d_shape handle;
    wall.body = body;
    wall.material = b->material;
    memcpy(wall.normal, normal, sizeof wall.normal);
    memcpy(wall.position, point, sizeof wall.position);
    must(b, se3d_shape_create_plane(b->system, &wall, &handle));
}

/* Planes at lower (sides 0..2) and upper (3..5) of a box from 0 to width; the bits of `sides` say
 * which. */
static void add_box(bed *b, unsigned sides, double width, double height)
{
    const se3d_body ground = {0, 0};
    for (int k = 0; k < 6; ++k) {
        double normal[3] = {0.0, 0.0, 0.0};
        double point[3] = {0.0, 0.0, 0.0};
        normal[k % 3] = k < 3 ? 1.0 : -1.0;
        point[k % 3] = k < 3 ? 0.0 : k == 5 ? height : width;
        if (sides >> k & 1U) {
            add_plane(b, ground, point, normal);
        }
    }
}

static void fill(bed *b, double width, double depth, double height, double low, double spread)
{
    se3d_fill_def def = se3d_fill_def_default();
    def.material = b->material;
    def.lower[2] = low;
    def.upper[0] = width;
    def.upper[1] = depth;
    def.upper[2] = low + height;
    def.radius_min = 0.5 * b->d * (1.0 - spread);
    def.radius_max = 0.5 * b->d * (1.0 + spread);
    def.jitter = 0.04 * b->d;
    def.spacing = 1.1 * b->d * (1.0 + spread);
    def.seed = 1;
    must(b, se3d_particles_fill_lattice(b->particles, &def, &b->count));
    b->r = calloc(3 * b->count, sizeof *b->r);
    b->old = calloc(3 * b->count, sizeof *b->old);
}

static void close_bed(bed *b)
{
    free(b->r);
    free(b->old);
    se3d_particles_destroy(b->particles);
    se3d_system_destroy(b->system);
}

static double mass_of(double radius)
{
    return 2500.0 * 4.0 / 3.0 * PI * radius * radius * radius;
}

/* --- static --- */

static void check_static(bed *b)
{
    const double up[3] = {0.0, 0.0, 1.0};
    double width = 1.1 * b->d * b->edge;
    open_bed(b, 2.5e4, 0.3);
    add_box(b, 033, width, 0.0); /* x and y */
    se3d_body_def def = se3d_body_def_default();
    se3d_body floor_body, ground;
    def.mass = def.inertia[0] = def.inertia[1] = def.inertia[2] = 1.0;
    must(b, se3d_body_create(b->system, &def, &floor_body));
    must(b, se3d_system_get_ground(b->system, &ground));
    add_plane(b, floor_body, def.position, up);
    fill(b, width, width, width, 0.0, 0.0);
    must(b, se3d_particles_step(b->particles, (size_t)b->settle));
    double weight = (double)b->count * mass_of(0.5 * b->d) * G;
    for (int part = 0; part <= 10; ++part) {
        double on_floor[3], on_walls[3], torque[3], drift = 0.0, time;
        size_t moved = 0;
        must(b, se3d_particles_get_all(b->particles, b->count, b->r, NULL, NULL));
        if (part == 0) {
            memcpy(b->old, b->r, 3 * b->count * sizeof *b->r);
        } else {
            must(b, se3d_particles_get_time(b->particles, &time));
            must(b, se3d_particles_run(b->particles, time + 0.1 * b->seconds));
            must(b, se3d_particles_get_all(b->particles, b->count, b->r, NULL, NULL));
        }
        for (size_t k = 0; k < b->count; ++k) {
            double far =
                hypot(hypot(b->r[3 * k] - b->old[3 * k], b->r[3 * k + 1] - b->old[3 * k + 1]),
                      b->r[3 * k + 2] - b->old[3 * k + 2]);
            drift = fmax(drift, far);
            moved += far > 1e-4 * b->d;
        }
        must(b, se3d_particles_get_wrench(b->particles, floor_body, on_floor, torque));
        must(b, se3d_particles_get_wrench(b->particles, ground, on_walls, torque));
        printf(
            "%s %zu, %4.1f s: floor %.6f of the weight, walls %.6f, missing %.1e; farthest drift "
            "%.1e m, %zu spheres by more than 1e-4 d\n",
            b->hertz ? "hertz" : "hooke", b->count, 0.1 * part * b->seconds, -on_floor[2] / weight,
            -on_walls[2] / weight, (on_floor[2] + on_walls[2]) / weight + 1.0, drift, moved);
        fflush(stdout);
    }
}

/* --- avalanche --- */

/* Half a radian to either side, a swing in a second, so that the bed never comes to rest. */
static void swing(bed *b, double *done, double stop)
{
    while (*done < stop) {
        double batch = fmin(1000.0, stop - *done), time;
        must(b, se3d_particles_get_time(b->particles, &time));
        double angle = 0.25 * PI * sin(2.0 * PI * time);
        const double g[3] = {G * sin(angle), G * 0.5 * sin(angle), -G * cos(angle)};
        must(b, se3d_system_set_gravity(b->system, g));
        must(b, se3d_particles_step(b->particles, (size_t)batch));
        *done += batch;
    }
}

static size_t outside(bed *b, double width, double height)
{
    size_t out = b->count - se3d_particles_count(b->particles);
    must(b, se3d_particles_get_all(b->particles, b->count - out, b->r, NULL, NULL));
    for (size_t k = 0; k < b->count - out; ++k) {
        for (int a = 0; a < 3; ++a) {
            double x = b->r[3 * k + (size_t)a];
            if (!(x > 0.3 * b->d && x < (a == 2 ? height : width) - 0.3 * b->d)) {
                ++out;
                break;
            }
        }
    }
    return out;
}

static void check_avalanche(bed *b)
{
    double width = 1.1 * b->d * b->edge * 1.5, height = 1.1 * b->d * b->edge;
    double done = 0.0, half = floor(0.5 * b->steps);
    se3d_particles *copy;
    se3d_particles_stats stats;
    open_bed(b, 2.5e4, 0.5);
    must(b, se3d_particles_set_step(b->particles, 1e-5));
    add_box(b, 077, width, height);
    fill(b, width, width, 0.45 * width, 0.0, 0.1);
    swing(b, &done, half);
    must(b, se3d_particles_clone(b->particles, &copy));
    size_t middle = outside(b, width, height);
    swing(b, &done, b->steps);
    size_t end = outside(b, width, height);
    uint64_t hash = se3d_particles_hash(b->particles);
    must(b, se3d_particles_get_stats(b->particles, &stats));
    must(b, se3d_particles_restore(b->particles, copy));
    se3d_particles_destroy(copy);
    done = half;
    swing(b, &done, b->steps);
    printf("avalanche %s %zu: %llu steps, %llu rebuilds, outside the box %zu (middle), %zu (end); "
           "from the snapshot in the middle: %s\n",
           b->hertz ? "hertz" : "hooke", b->count, (unsigned long long)stats.steps,
           (unsigned long long)stats.rebuilds, middle, end,
           se3d_particles_hash(b->particles) == hash ? "the same bits" : "DIFFERENT BITS");
}

/* --- hopper --- */

/* A square plate with a circular hole: triangles between a circle and the square's border. */
static void add_holed_plate(bed *b, double half, double hole)
{
    double vertices[6 * HOLE_SIDES];
    uint32_t triangles[6 * HOLE_SIDES];
    for (uint32_t k = 0; k < HOLE_SIDES; ++k) {
        double c = cos(2.0 * PI * k / HOLE_SIDES), s = sin(2.0 * PI * k / HOLE_SIDES);
        double far = half / fmax(fabs(c), fabs(s)); /* multiples of 45 degrees are corners */
        const double at[6] = {hole * c, hole * s, 0.0, far * c, far * s, 0.0};
        memcpy(vertices + 6 * k, at, sizeof at);
        uint32_t next = (k + 1) % HOLE_SIDES;
        const uint32_t two[6] = {2 * k, 2 * k + 1, 2 * next + 1, 2 * k, 2 * next + 1, 2 * next};
        memcpy(triangles + 6 * k, two, sizeof two);
    }
    se3d_shape_def plate = se3d_shape_def_default();
    se3d_shape handle;
    plate.material = b->material;
    plate.position[0] = plate.position[1] = half;
    plate.vertices = vertices;
    plate.vertex_count = 2 * HOLE_SIDES;
    plate.triangles = triangles;
    plate.triangle_count = 2 * HOLE_SIDES;
    must(b, se3d_shape_create_mesh(b->system, &plate, &handle));
}

/* Mass between two heights; radii are read anew. */
static double mass_between(bed *b, double low, double high)
{
    double mass = 0.0;
    size_t n = se3d_particles_count(b->particles);
    must(b, se3d_particles_get_all(b->particles, n, b->r, NULL, NULL));
    must(b, se3d_particles_get_radii(b->particles, n, b->old));
    for (size_t k = 0; k < n; ++k) {
        double z = b->r[3 * k + 2];
        mass += z > low && z < high ? mass_of(b->old[k]) : 0.0;
    }
    return mass;
}

static void run_to(bed *b, double time)
{
    must(b, se3d_particles_run(b->particles, time));
}

static void check_hopper(bed *b)
{
    double d = b->d, D = b->opening * d, half = fmax(9.0, 1.2 * b->opening) * d;
    double unit = sqrt(d / G); /* so long a sphere falls by half its diameter */
    const se3d_body ground = {0, 0};
    const double point[3] = {0.0, 0.0, 0.0}, up[3] = {0.0, 0.0, 1.0};
    open_bed(b, 1000.0 * d / 0.006, 0.3);
    add_box(b, 033, 2.0 * half, 0.0);
    add_holed_plate(b, half, 0.5 * D);
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape gate;
    def.material = b->material;
    memcpy(def.position, point, sizeof def.position);
    memcpy(def.normal, up, sizeof def.normal);
    def.body = ground;
    must(b, se3d_shape_create_plane(b->system, &def, &gate));
    fill(b, 2.0 * half, 2.0 * half, 38.0 * d, 0.0, 0.1);
    run_to(b, 14.0 * unit);
    double bulk = mass_between(b, 2.0 * d, 12.0 * d) / (4.0 * half * half * 10.0 * d);
    must(b, se3d_shape_destroy(b->system, gate));
    run_to(b, 22.0 * unit);
    double before = mass_between(b, -0.5 * d, 1e3);
    run_to(b, 32.0 * unit);
    double rate = (before - mass_between(b, -0.5 * d, 1e3)) / (10.0 * unit);
    double law = 0.58 * bulk * sqrt(G) * pow(D - 1.4 * d, 2.5);
    printf("hopper, %zu spheres of %.1f mm, friction %.2f, rolling %.2f, circle of %.1f d: %.4f "
           "kg/s, Beverloo %.4f kg/s, ratio %.3f, bulk %.0f kg/m^3, %.3f kg left above 6 d\n",
           b->count, 1e3 * d, b->friction, b->rolling, b->opening, rate, law, rate / law, bulk,
           mass_between(b, 6.0 * d, 1e3));
}

/* --- drum --- */

static void check_drum(bed *b)
{
    double width = 1.1 * b->d * b->edge, R = 0.75 * width, turned = 0.0, sum = 0.0, steep = 0.0;
    const se3d_body ground = {0, 0};
    se3d_body drum;
    open_bed(b, 2.5e4, 0.5);
    for (int k = 0; k < 2; ++k) {
        const double point[3] = {0.0, k ? 0.5 * width : 0.0, 0.0};
        const double normal[3] = {0.0, k ? -1.0 : 1.0, 0.0};
        add_plane(b, ground, point, normal);
    }
    se3d_body_def def = se3d_body_def_default();
    def.mass = def.inertia[0] = def.inertia[1] = def.inertia[2] = 1.0;
    def.position[0] = def.position[2] = 0.5 * width;
    def.angular_velocity[1] = b->rate;
    must(b, se3d_body_create(b->system, &def, &drum));
    for (int k = 0; k < DRUM_PLANES; ++k) {
        double angle = 2.0 * PI * k / DRUM_PLANES;
        const double normal[3] = {-cos(angle), 0.0, -sin(angle)};
        const double point[3] = {-R * normal[0], 0.0, -R * normal[2]};
        add_plane(b, drum, point, normal);
    }
    fill(b, width, 0.5 * width, 0.9 * width, 0.0, 0.1);
    must(b, se3d_particles_set_step(b->particles, 2e-5));
    double total = fmax(1.5 * PI / b->rate, 2.0), samples = 0.0;
    for (double t = 0.0; t < total; t += 20 * 2e-5) {
        turned += b->rate * 20 * 2e-5;
        const double p[4] = {cos(0.5 * turned), 0.0, sin(0.5 * turned), 0.0};
        const double w[3] = {0.0, b->rate, 0.0};
        must(b, se3d_body_set_orientation(b->system, drum, p));
        must(b, se3d_body_set_angular_velocity(b->system, drum, w));
        must(b, se3d_particles_step(b->particles, 20));
        if (t > 0.5 * total) {
            double x = 0.0, z = 0.0;
            must(b, se3d_particles_get_all(b->particles, b->count, b->r, NULL, NULL));
            for (size_t k = 0; k < b->count; ++k) {
                x += b->r[3 * k] - 0.5 * width;
                z += b->r[3 * k + 2] - 0.5 * width;
            }
            double angle = atan2(fabs(x), -z) * 180.0 / PI;
            sum += angle;
            steep = fmax(steep, angle);
            samples += 1.0;
        }
    }
    printf("drum, %zu spheres, R = %.0f d, friction %.2f, rolling %.2f, %.2f rad/s, Froude number "
           "%.5f: slope %.1f degrees, at most %.1f\n",
           b->count, R / b->d, b->friction, b->rolling, b->rate, b->rate * b->rate * R / G,
           sum / samples, steep);
}

static int parse(bed *b, const char *text)
{
    const struct {
        const char *name;
        double *value;
    } numbers[] = {{"edge", &b->edge},   {"settle", &b->settle},     {"seconds", &b->seconds},
                   {"steps", &b->steps}, {"opening", &b->opening},   {"d", &b->d},
                   {"rate", &b->rate},   {"friction", &b->friction}, {"rolling", &b->rolling}};
    const char *equals = strchr(text, '=');
    size_t length = equals ? (size_t)(equals - text) : 0;
    for (size_t k = 0; equals && k < sizeof numbers / sizeof numbers[0]; ++k) {
        if (strlen(numbers[k].name) == length && strncmp(text, numbers[k].name, length) == 0) {
            *numbers[k].value = atof(equals + 1);
            return 1;
        }
    }
    b->hertz = strcmp(text, "law=hertz") == 0 || b->hertz;
    if (strncmp(text, "threads=", 8) == 0) {
        b->threads = atoi(text + 8);
    } else if (strncmp(text, "law=", 4) != 0) {
        fprintf(stderr, "what is %s?\n", text);
        return 0;
    }
    return 1;
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*check)(bed *b);
    } checks[] = {{"static", check_static},
                  {"avalanche", check_avalanche},
                  {"hopper", check_hopper},
                  {"drum", check_drum}};
    bed b = {.threads = 1,
             .edge = 20,
             .settle = 150000,
             .seconds = 10,
             .steps = 1e6,
             .opening = 6,
             .d = 0.01,
             .rate = 2,
             .friction = 0.5};
    for (int k = 2; k < argc; ++k) {
        if (!parse(&b, argv[k])) {
            return 2;
        }
    }
    for (size_t k = 0; argc > 1 && k < sizeof checks / sizeof checks[0]; ++k) {
        if (strcmp(argv[1], checks[k].name) == 0) {
            checks[k].check(&b);
            close_bed(&b);
            return 0;
        }
    }
    fprintf(stderr, "usage: %s static|avalanche|hopper|drum [NAME=VALUE...]\n", argv[0]);
    return 2;
}
