/* SPDX-License-Identifier: BSD-3-Clause */
/* Granular beds: million particle-steps per second, rebuilds of the lists included.
 *
 *     bench_granular NAME=VALUE...
 *
 *     edge=20       edge^3 spheres          law=hooke|hertz        threads=1
 *     settle=60000  steps until they lie    lead=300               steps before the clock starts
 *     steps=3000    steps that are timed    repeats=1              so often, the best is told
 *     tilt=0        degrees that gravity turns by before the lead: an avalanche
 *     drum=0        rad/s: the box is a drum of 24 planes about the y axis instead
 *     mesh=0        1: these planes are 48 triangles
 *     funnel=0      1: the box is a conical hopper of 192 triangles, opened below before the lead
 *     gate=0        1: it stays shut, a silo
 *     drain=0       1: spheres that have left the hopper are taken away and counted
 *     clump=0       1: edge^3/2 dimers instead, two of these spheres half a diameter apart, from a
 *                   lattice above the box; without a state
 *     state=FILE    the settled state as a LAMMPS data file: read if there is one, written
 *                   otherwise, so that others start from the same
 *     tiles=1       the state is one of (edge/tiles)^3 spheres, put side by side and on top of each
 *                   other so many times, and settles from there: for sets that would take hours
 *
 * A last line tells bytes and flops per particle-step and the share of what the memory can do; see
 * granular/README.md. */
#define _POSIX_C_SOURCE 200809L
#include "clock.h"
#include "se3d/se3d.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DIAMETER 0.01
#define SPACING  (1.1 * DIAMETER)

#define DRUM_PLANES 24
#define DRUM_RADIUS 0.75 /* of the width: the box fits in */
#define PI          3.14159265358979323846

/* A cylinder around the box, a cone below it and a short tube, of so many sides. */
enum { FUNNEL_SIDES = 32, FUNNEL_RINGS = 4 };
static const double funnel[FUNNEL_RINGS][2] = {
    {0.75, 1.5}, {0.75, 0.0}, {0.15, -0.6}, {0.15, -0.7}}; /* radius and height over the width */
#define DRAIN 0.8 /* below the tube: how deep over the width */

typedef struct bench {
    se3d_system *system;
    se3d_particles *particles;
    se3d_body drum;
    size_t edge, count;
    double *state; /* r, v, w [count * 3] each */
    double turned; /* angle of the drum */
    int hertz, reserved;
    double threads, settle, lead, steps, repeats, tilt, drum_rate, tiles, funnel;
    double mesh, shut, clump, drain;
    uint32_t sink;
    uint32_t reserved_sink;
    se3d_shape gate;
    const char *file;
} bench;

static void must(const bench *b, se3d_status status)
{
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(b->system));
        exit(1);
    }
}

static double width_of(const bench *b)
{
    return (double)b->edge * SPACING;
}

static se3d_shape add_plane(bench *b, se3d_body body, se3d_material material, const double point[3],
                            const double normal[3])
{
    se3d_shape_def wall = se3d_shape_def_default();
    se3d_shape handle;
    wall.body = body;
    wall.material = material;
    memcpy(wall.normal, normal, sizeof wall.normal);
    memcpy(wall.position, point, sizeof wall.position);
    must(b, se3d_shape_create_plane(b->system, &wall, &handle));
    return handle;
}

static void add_mesh(bench *b, se3d_body body, se3d_material material, const double *vertices,
                     size_t vertex_count, const uint32_t *triangles, size_t triangle_count)
{
    se3d_shape_def wall = se3d_shape_def_default();
    se3d_shape handle;
    wall.body = body;
    wall.material = material;
    wall.vertices = vertices;
    wall.vertex_count = vertex_count;
    wall.triangles = triangles;
    wall.triangle_count = triangle_count;
    must(b, se3d_shape_create_mesh(b->system, &wall, &handle));
}

/* The rings of the funnel, two triangles a side, and a gate below it. */
static void add_funnel(bench *b, se3d_material material)
{
    const double width = width_of(b);
    double vertices[FUNNEL_RINGS * FUNNEL_SIDES][3];
    uint32_t triangles[2 * (FUNNEL_RINGS - 1) * FUNNEL_SIDES][3];
    for (uint32_t ring = 0, t = 0; ring < FUNNEL_RINGS; ++ring) {
        for (uint32_t k = 0; k < FUNNEL_SIDES; ++k) {
            const double angle = 2.0 * PI * k / FUNNEL_SIDES;
            const uint32_t at = ring * FUNNEL_SIDES + k;
            const uint32_t next = ring * FUNNEL_SIDES + (k + 1) % FUNNEL_SIDES;
            vertices[at][0] = width * (0.5 + funnel[ring][0] * cos(angle));
            vertices[at][1] = width * (0.5 + funnel[ring][0] * sin(angle));
            vertices[at][2] = width * funnel[ring][1];
            if (ring + 1 < FUNNEL_RINGS) {
                memcpy(triangles[t++], (uint32_t[3]){at, next, next + FUNNEL_SIDES},
                       sizeof *triangles);
                memcpy(triangles[t++], (uint32_t[3]){at, next + FUNNEL_SIDES, at + FUNNEL_SIDES},
                       sizeof *triangles);
            }
        }
    }
    add_mesh(b, (se3d_body){0, 0}, material, vertices[0], sizeof vertices / sizeof *vertices,
             triangles[0], sizeof triangles / sizeof *triangles);
    b->gate = add_plane(b, (se3d_body){0, 0}, material,
                        (double[3]){0.0, 0.0, width * funnel[FUNNEL_RINGS - 1][1]},
                        (double[3]){0.0, 0.0, 1.0});
}

/* The planes of the drum, two triangles each, a little longer than it is. */
static void add_shell(bench *b, se3d_material material)
{
    const double corner = DRUM_RADIUS * width_of(b) / cos(PI / DRUM_PLANES);
    const double ends[2] = {-0.009, 1.2 * width_of(b)};
    double vertices[2 * DRUM_PLANES][3];
    uint32_t triangles[2 * DRUM_PLANES][3];
    for (uint32_t k = 0; k < DRUM_PLANES; ++k) {
        const double angle = 2.0 * PI * (k + 0.5) / DRUM_PLANES;
        const uint32_t at = 2 * k, next = 2 * ((k + 1) % DRUM_PLANES);
        for (uint32_t end = 0; end < 2; ++end) {
            vertices[at + end][0] = corner * cos(angle);
            vertices[at + end][1] = ends[end];
            vertices[at + end][2] = corner * sin(angle);
        }
        memcpy(triangles[at], (uint32_t[3]){at, next, next + 1}, sizeof *triangles);
        memcpy(triangles[at + 1], (uint32_t[3]){at, next + 1, at + 1}, sizeof *triangles);
    }
    add_mesh(b, b->drum, material, vertices[0], sizeof vertices / sizeof *vertices, triangles[0],
             sizeof triangles / sizeof *triangles);
}

/* A floor and four sides; or planes around the y axis through the middle, on a body that turns,
 * and two ends. */
static void add_walls(bench *b, se3d_material material)
{
    static const double normals[5][3] = {
        {0.0, 1.0, 0.0}, {0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
    double width = width_of(b);
    const se3d_body ground = {0, 0};
    if (b->funnel > 0.0) {
        add_funnel(b, material);
        return;
    }
    for (int k = 0; k < (b->drum_rate != 0.0 ? 2 : 5); ++k) {
        const double point[3] = {k == 3 ? width : 0.0, k == 1 ? width : 0.0, 0.0};
        add_plane(b, ground, material, point, normals[k]);
    }
    if (b->drum_rate == 0.0) {
        return;
    }
    se3d_body_def def = se3d_body_def_default();
    def.mass = def.inertia[0] = def.inertia[1] = def.inertia[2] = 1.0;
    def.position[0] = def.position[2] = 0.5 * width;
    def.angular_velocity[1] = b->drum_rate;
    must(b, se3d_body_create(b->system, &def, &b->drum));
    if (b->mesh > 0.0) {
        add_shell(b, material);
    }
    for (int k = 0; k < DRUM_PLANES && !(b->mesh > 0.0); ++k) {
        double angle = 2.0 * PI * k / DRUM_PLANES;
        const double normal[3] = {-cos(angle), 0.0, -sin(angle)};
        const double point[3] = {-DRUM_RADIUS * width * normal[0], 0.0,
                                 -DRUM_RADIUS * width * normal[2]};
        add_plane(b, b->drum, material, point, normal);
    }
}

/* As many layers as it takes. */
static void use_dimers(bench *b, se3d_fill_def *fill)
{
    const double r[6] = {-0.25 * DIAMETER, 0.0, 0.0, 0.25 * DIAMETER, 0.0, 0.0};
    const double radius[2] = {0.5 * DIAMETER, 0.5 * DIAMETER};
    se3d_clump_def def = se3d_clump_def_default();
    uint32_t index;
    def.count = 2;
    def.r = r;
    def.radius = radius;
    must(b, se3d_particles_add_clump_template(b->particles, &def, &index));
    fill->clump = 1 + index;
    fill->radius_min = fill->radius_max = 0.75 * DIAMETER;
    fill->spacing = 1.5 * SPACING;
    const double side = floor(width_of(b) / fill->spacing);
    const double layers = ceil(0.5 * (double)(b->edge * b->edge * b->edge) / (side * side));
    fill->upper[2] = (layers + 0.01) * fill->spacing;
}

static void build(bench *b)
{
    must(b, se3d_system_create(NULL, &b->system));
    se3d_particles_def def = se3d_particles_def_default();
    se3d_contact_settings contact = se3d_contact_settings_default();
    contact.law = b->hertz ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE;
    must(b, se3d_system_set_contact(b->system, &contact));
    def.threads = (int32_t)b->threads;
    def.step = 1e-5;
    must(b, se3d_particles_create(b->system, &def, &b->particles));
    se3d_material_def stuff = se3d_material_def_default();
    stuff.density = 2500.0;
    stuff.stiffness = 2.5e4;
    stuff.young = 1e8;
    stuff.restitution = 0.7;
    se3d_material material;
    must(b, se3d_material_create(b->system, &stuff, &material));
    add_walls(b, material);
    se3d_fill_def fill = se3d_fill_def_default();
    fill.material = material;
    fill.upper[0] = fill.upper[1] = fill.upper[2] = width_of(b);
    fill.radius_min = fill.radius_max = 0.5 * DIAMETER;
    fill.jitter = 0.045 * DIAMETER;
    fill.spacing = SPACING;
    fill.seed = 1;
    if (b->clump > 0.0) {
        use_dimers(b, &fill);
    }
    must(b, se3d_particles_fill_lattice(b->particles, &fill, &b->count));
    b->count = se3d_particles_count(b->particles);
    b->state = calloc(9 * b->count, sizeof *b->state);
}

/* Steps; a drum turns a little every 20 of them. */
static void go(bench *b, size_t steps)
{
    size_t batch = b->drum_rate != 0.0 ? 20 : steps;
    for (size_t done = 0; done < steps; done += batch) {
        if (b->drum_rate != 0.0) {
            b->turned += b->drum_rate * 20 * 1e-5;
            const double p[4] = {cos(0.5 * b->turned), 0.0, sin(0.5 * b->turned), 0.0};
            const double w[3] = {0.0, b->drum_rate, 0.0};
            must(b, se3d_body_set_orientation(b->system, b->drum, p));
            must(b, se3d_body_set_angular_velocity(b->system, b->drum, w));
        }
        must(b, se3d_particles_step(b->particles, batch));
    }
}

/* Let it fall, with velocities that decay. */
static void settle(bench *b)
{
    double *v = b->state + 3 * b->count;
    if (b->clump > 0.0) {
        must(b, se3d_particles_step(b->particles, (size_t)b->settle));
        return;
    }
    for (double k = 0; k < b->settle; k += 50) {
        must(b, se3d_particles_step(b->particles, 50));
        must(b, se3d_particles_get_all(b->particles, b->count, NULL, v, v + 3 * b->count));
        for (size_t n = 0; n < 6 * b->count; ++n) {
            v[n] *= 0.995;
        }
        must(b, se3d_particles_set_all(b->particles, b->count, NULL, v, v + 3 * b->count));
    }
}

/* The axis of a drum is z in the file and runs through the origin: others know no other. */
static void swap_axes(const bench *b, double x[3], int to_file)
{
    double middle = 0.5 * width_of(b);
    if (b->drum_rate != 0.0) {
        const double from[3] = {x[0], x[1], x[2]};
        x[0] = from[0] + (to_file ? -middle : middle);
        x[1] = to_file ? from[2] - middle : from[2];
        x[2] = to_file ? from[1] : from[1] + middle;
    }
}

static void write_state(bench *b)
{
    FILE *file = fopen(b->file, "w");
    double width = width_of(b);
    double low = b->drum_rate != 0.0 ? -0.8 * width : b->funnel > 0.0 ? -0.5 * width : 0.0;
    double high = b->drum_rate != 0.0 ? 0.8 * width : b->funnel > 0.0 ? 1.5 * width : width;
    if (!file) {
        return;
    }
    must(b, se3d_particles_get_all(b->particles, b->count, b->state, NULL, NULL));
    fprintf(file, "settled bed\n\n%zu atoms\n1 atom types\n\n", b->count);
    fprintf(file, "%.17g %.17g xlo xhi\n%.17g %.17g ylo yhi\n", low, high, low, high);
    fprintf(file, "%.17g %.17g zlo zhi\n\nAtoms # sphere\n\n",
            b->funnel > 0.0 ? -4.0 * width : -0.01, 1.5 * width);
    for (size_t k = 0; k < b->count; ++k) {
        double x[3] = {b->state[3 * k], b->state[3 * k + 1], b->state[3 * k + 2]};
        swap_axes(b, x, 1);
        fprintf(file, "%zu 1 %.17g 2500 %.17g %.17g %.17g\n", k + 1, DIAMETER, x[0], x[1], x[2]);
    }
    fclose(file);
}

/* Copies of the first `n` spheres fill the other places. */
static void copy_tiles(bench *b, size_t n)
{
    double pitch[3] = {width_of(b) / b->tiles, width_of(b) / b->tiles, 0.0};
    for (size_t k = 0; k < n; ++k) {
        pitch[2] = fmax(pitch[2], b->state[3 * k + 2] + 0.5 * DIAMETER);
    }
    size_t across = (size_t)b->tiles;
    for (size_t tile = 1; tile < across * across * across; ++tile) {
        const size_t at[3] = {tile % across, tile / across % across, tile / across / across};
        for (size_t k = 0; k < 3 * n; ++k) {
            b->state[3 * n * tile + k] = b->state[k] + (double)at[k % 3] * pitch[k % 3];
        }
    }
}

/* Returns 0 if there is no such file. */
static int read_state(bench *b)
{
    FILE *file = b->file ? fopen(b->file, "r") : NULL;
    char line[256];
    size_t k = 0, n = b->count / (size_t)(b->tiles * b->tiles * b->tiles);
    while (file && k < n && fgets(line, sizeof line, file)) {
        unsigned long id;
        double *x = b->state + 3 * k;
        int found = sscanf(line, "%lu %*d %*f %*f %lf %lf %lf", &id, &x[0], &x[1], &x[2]);
        if (found == 4) {
            swap_axes(b, x, 0);
            ++k;
        }
    }
    if (file) {
        fclose(file);
    }
    if (k == n && k > 0) {
        copy_tiles(b, n);
        must(b, se3d_particles_set_all(b->particles, b->count, b->state, NULL, NULL));
        return 1;
    }
    return 0;
}

static void tilt(bench *b)
{
    if (b->funnel > 0.0 && !(b->shut > 0.0)) {
        must(b, se3d_shape_destroy(b->system, b->gate));
    }
    if (b->drain > 0.0) {
        se3d_particles_sink_def def = se3d_particles_sink_def_default();
        def.point[2] = -DRAIN * width_of(b);
        def.normal[2] = 1.0;
        must(b, se3d_particles_add_sink(b->particles, &def, &b->sink));
    }
    double angle = b->tilt * PI / 180.0;
    const double g[3] = {9.81 * sin(angle), 0.0, -9.81 * cos(angle)};
    must(b, se3d_system_set_gravity(b->system, g));
}

/* Bytes per second of a[k] = b[k] + s c[k] over arrays that no cache holds. */
static double triad(void)
{
    const size_t n = (size_t)1 << 24;
    double *a = calloc(3 * n, sizeof *a);
    double best = 0.0;
    for (int turn = 0; a && turn < 6; ++turn) {
        double start = bench_clock();
        for (size_t k = 0; k < n; ++k) {
            a[k] = a[n + k] + 3.0 * a[2 * n + k];
        }
        double rate = 24.0 * (double)n / (bench_clock() - start);
        best = turn > 0 && rate > best ? rate : best; /* the first one touches the pages */
        a[n] = a[0];
    }
    free(a);
    return best;
}

/* What passes between processor and memory if nothing stays in a cache, and what is computed,
 * for each particle and step: the records of a particle twice, once to move it and once for its
 * forces; the blocks of its pairs (8 of 256 bytes), of which the springs are written. */
static void roofline(double contacts, double rate)
{
    const double move = 2.0 * (64.0 + 32.0 + 64.0); /* particle, spin and load, read and written */
    const double force = 64.0 + 32.0 + 2.0 * 64.0;
    const double pair = (256.0 + 192.0) / 8.0;
    double bytes = move + force + contacts * pair;
    double flops = 44.0 + contacts * 148.0; /* a root is one */
    double limit = triad();
    printf(
        "  %.0f bytes and %.0f flops per particle-step: %.1f GB/s of %.1f GB/s (triad), %.0f %%; "
        "%.1f Gflop/s\n",
        bytes, flops, 1e-9 * rate * bytes, 1e-9 * limit, 100.0 * rate * bytes / limit,
        1e-9 * rate * flops);
}

static void measure(bench *b)
{
    se3d_particles_stats before, after;
    double work = (double)b->count * b->steps;
    double cpu_rate = 0.0;
    double rate = 0.0;
    uint64_t rebuilds = 0;
    go(b, (size_t)b->lead);
    for (double turn = 0; turn < b->repeats; ++turn) {
        must(b, se3d_particles_get_stats(b->particles, &before));
        double cpu = bench_clock();
        double wall = bench_clock_of(CLOCK_MONOTONIC);
        go(b, (size_t)b->steps);
        cpu_rate = fmax(cpu_rate, work / (bench_clock() - cpu));
        rate = fmax(rate, work / (bench_clock_of(CLOCK_MONOTONIC) - wall));
        must(b, se3d_particles_get_stats(b->particles, &after));
        rebuilds = after.rebuilds - before.rebuilds;
    }
    double contacts = (double)after.contacts / (double)b->count;
    printf("se3d %s %zu, %d threads: %.2f M particle-steps per CPU second, %.2f per second; %.2f "
           "contacts and %.0f bytes per sphere, %llu rebuilds, %llu lost\n",
           b->hertz ? "hertz" : "hooke", b->count, (int)after.threads, 1e-6 * cpu_rate, 1e-6 * rate,
           contacts, (double)after.bytes / (double)b->count, (unsigned long long)rebuilds,
           (unsigned long long)after.lost);
    if (b->tilt != 0.0 || b->drum_rate != 0.0 || b->funnel > 0.0) {
        se3d_particles_energy energy;
        must(b, se3d_particles_get_energy(b->particles, &energy));
        printf("  kinetic energy %.4g J\n", energy.translation);
    }
    if (b->drain > 0.0) {
        uint64_t gone;
        must(b, se3d_particles_get_sink_count(b->particles, b->sink, &gone));
        printf("  %llu spheres have left the hopper\n", (unsigned long long)gone);
    }
    if (after.threads == 1) {
        roofline(contacts, cpu_rate);
    }
}

static int parse(bench *b, const char *text)
{
    const struct {
        const char *name;
        double *value;
    } numbers[] = {{"threads", &b->threads}, {"settle", &b->settle},   {"lead", &b->lead},
                   {"steps", &b->steps},     {"repeats", &b->repeats}, {"tilt", &b->tilt},
                   {"drum", &b->drum_rate},  {"tiles", &b->tiles},     {"funnel", &b->funnel},
                   {"mesh", &b->mesh},       {"gate", &b->shut},       {"clump", &b->clump},
                   {"drain", &b->drain}};
    const char *equals = strchr(text, '=');
    size_t length = equals ? (size_t)(equals - text) : 0;
    for (size_t k = 0; equals && k < sizeof numbers / sizeof numbers[0]; ++k) {
        if (strlen(numbers[k].name) == length && strncmp(text, numbers[k].name, length) == 0) {
            *numbers[k].value = atof(equals + 1);
            return 1;
        }
    }
    if (strncmp(text, "edge=", 5) == 0) {
        b->edge = (size_t)atol(text + 5);
    } else if (strncmp(text, "law=", 4) == 0) {
        b->hertz = strcmp(text, "law=hertz") == 0;
    } else if (strncmp(text, "state=", 6) == 0) {
        b->file = text + 6;
    } else {
        fprintf(stderr, "what is %s?\n", text);
        return 0;
    }
    return 1;
}

int main(int argc, char **argv)
{
    bench b = {.edge = 20,
               .threads = 1,
               .settle = 60000,
               .lead = 300,
               .steps = 3000,
               .repeats = 1,
               .tiles = 1};
    for (int k = 1; k < argc; ++k) {
        if (!parse(&b, argv[k])) {
            return 2;
        }
    }
    double start = bench_clock_of(CLOCK_MONOTONIC);
    build(&b);
    must(&b, se3d_particles_step(b.particles, 1));
    printf("ready after %.2f s\n", bench_clock_of(CLOCK_MONOTONIC) - start);
    int found = read_state(&b);
    if (!found || b.tiles > 1) {
        settle(&b);
    }
    if (!found && b.file) {
        write_state(&b);
    }
    tilt(&b);
    measure(&b);
    free(b.state);
    se3d_particles_destroy(b.particles);
    se3d_system_destroy(b.system);
    return 0;
}
