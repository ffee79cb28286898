/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles of a model file: fall, bounce, walls that are driven, snapshots. */
#include <stdlib.h>

#include "check.h"
#include "se3d/io.h"

#define GLASS                                                                                      \
    "se3d: 1\nmaterials: [{name: glass, density: 2500, stiffness: 1e5, restitution: 0.8}]\n"       \
    "particles: [{material: glass, radius: 0.01, count: 1, lower: [-0.011, -0.011, 0.489], "       \
    "upper: "                                                                                      \
    "[0.011, 0.011, 0.511], velocity: [0, 0, 0]}]\n"

/* Run a model; its last output stays readable through the channels. */
static se3d_model *run_model(const char *text, const char *folder, se3d_status *status)
{
    se3d_model *model = NULL;
    se3d_run *run = NULL;
    se3d_model_error error;
    se3d_run_options how = se3d_run_options_default();
    how.directory = folder;
    *status = se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, &error);
    if (*status >= 0) {
        *status = se3d_model_run(model, &how, &run, &error);
    }
    if (*status < 0) {
        fprintf(stderr, "%s\n", error.message);
    }
    se3d_run_destroy(run);
    return model;
}

static const char *results_folder(void)
{
    static char folder[800];
    snprintf(folder, sizeof folder, "%s/io-particles", check_scratch());
    return folder;
}

/* Number `column` of line `line` (0: the header) of particles.csv. */
static double particle(size_t line, size_t column)
{
    char text[1000] = "";
    snprintf(text, sizeof text, "%s/grains.csv", results_folder());
    FILE *file = fopen(text, "rb");
    for (size_t k = 0; file && k <= line; ++k) {
        if (!fgets(text, sizeof text, file)) {
            text[0] = '\0';
        }
    }
    if (file) {
        fclose(file);
    }
    const char *at = text;
    for (size_t k = 0; at && k < column; ++k) {
        at = strchr(at, ',');
        at = at ? at + 1 : NULL;
    }
    return at && *at ? strtod(at, NULL) : (double)NAN;
}

static double channel(const se3d_model *model, size_t k)
{
    double value[4] = {0.0, 0.0, 0.0, 0.0};
    size_t width = 0;
    CHECK(se3d_model_get_channel_value(model, 0, k, NULL, value, &width) == SE3D_OK);
    CHECK(width == 1);
    return value[0];
}

static double column_of(const se3d_model *model, size_t k, size_t column)
{
    double value[4] = {0.0, 0.0, 0.0, 0.0};
    size_t width = 0;
    CHECK(se3d_model_get_channel_value(model, 0, k, NULL, value, &width) == SE3D_OK);
    CHECK(width == 3 && column < width);
    return value[column];
}

#define OUTPUT                                                                                     \
    "output:\n  - {file: s.csv, every: 0.05, channels: [contacts.count, particles.count, "         \
    "particles.lost, particles.energy]}\n  - {file: grains.csv, every: 0.1, particles: true}\n"

static void particle_falls_and_bounces_with_its_restitution(void)
{
    se3d_status status = SE3D_OK;
    se3d_model *model =
        run_model(GLASS "bodies: [{name: ground, shapes: [{type: plane, material: glass}]}]\n"
                        "analysis: {type: dynamics, duration: 0.5}\n" OUTPUT,
                  results_folder(), &status);
    CHECK(status >= 0);
    const double pi = acos(-1.0);
    const double mass = 2500.0 * 4.0 / 3.0 * pi * 1e-6;
    CHECK_NEAR(particle(1, 0), 0.0, 0.0);
    CHECK_NEAR(particle(1, 2), 0.01, 0.0);
    CHECK_NEAR(particle(1, 5), 0.5, 1e-12);
    CHECK_NEAR(particle(3, 0), 0.2, 1e-12);
    CHECK_NEAR(particle(3, 5), 0.5 - 0.5 * 9.81 * 0.04, 1e-9);
    CHECK_NEAR(particle(3, 8), -9.81 * 0.2, 1e-9);
    /* The energy of the second flight is e^2 of the first: heights above the touching centre. */
    const double energy = channel(model, 3);
    CHECK_NEAR(energy, mass * 9.81 * (0.01 + 0.64 * 0.49), 5e-3 * energy);
    CHECK_NEAR(channel(model, 0), 0.0, 0.0);
    CHECK_NEAR(channel(model, 1), 1.0, 0.0);
    CHECK_NEAR(channel(model, 2), 0.0, 0.0);
    se3d_model_destroy(model);
}

/* It slides until it rolls with 5/7 of its speed, of which turning is two sevenths. */
static void kinetic_energy_of_a_ball_that_rolls(void)
{
    se3d_status status = SE3D_OK;
    se3d_model *model = run_model(
        "se3d: 1\nmaterials: [{name: glass, density: 2500, stiffness: 1e5}]\n"
        "particles: [{name: ball, material: glass, radius: 0.01, count: 1, velocity: [0.5, 0, 0], "
        "lower: [-0.011, -0.011, 0], upper: [0.011, 0.011, 0.02]}]\n"
        "bodies: [{name: ground, shapes: [{type: plane, material: glass}]}]\n"
        "analysis: {type: dynamics, duration: 0.3}\noutput:\n  - {file: s.csv, every: 0.1, "
        "channels: "
        "[particles.kinetic, particles.rotation, ball.kinetic, ball.rotation]}\n",
        results_folder(), &status);
    CHECK(status >= 0);
    const double rolls = 5.0 / 7.0 * 0.5 * 2500.0 * 4.0 / 3.0 * acos(-1.0) * 1e-6 * 0.25;
    for (size_t k = 0; k < 4; k += 2) {
        CHECK_NEAR(channel(model, k) / rolls, 1.0, 2e-3);
        CHECK_NEAR(channel(model, k + 1) / rolls, 2.0 / 7.0, 2e-3);
    }
    se3d_model_destroy(model);
}

/* A piston at 2 m/s throws a particle at rest to (1 + e) 2 m/s, within what the automatic step
 * keeps of the restitution. */
static void driven_wall_throws_a_particle(void)
{
    se3d_status status = SE3D_OK;
    se3d_model *model = run_model(
        GLASS "gravity: [0, 0, 0]\n"
              "bodies: [{name: piston, position: [0, 0, 0.3], mass: 1, inertia: [1, 1, 1], shapes: "
              "[{type: box, size: [1, 1, 0.1], material: glass}]}]\n"
              "joints: [{name: rail, type: prismatic, body_i: ground, body_j: piston, at: [0, 0, "
              "0.3], axis: [0, 0, 1]}]\n"
              "drivers: [{joint: rail, value: 2*t}]\n"
              "analysis: {type: kinematics, duration: 0.2}\n" OUTPUT,
        results_folder(), &status);
    CHECK(status >= 0);
    CHECK_NEAR(particle(2, 8), 3.6, 8e-3);
    CHECK_NEAR(particle(3, 8), 3.6, 8e-3);
    /* It was touched when the piston's face, at 0.35, had gone 0.14 m: at 0.07 s. */
    CHECK_NEAR(particle(3, 5), 0.5 + 3.6 * 0.13, 4e-3);
    se3d_model_destroy(model);
}

static void particles_that_leave_through_a_sink_are_counted(void)
{
    se3d_status status = SE3D_OK;
    se3d_model *model =
        run_model(GLASS "contact: {boundary: [open, open, sink], lower: [0, 0, 0.2], upper: [0, 0, "
                        "1]}\nanalysis: {type: dynamics, duration: 0.5}\n" OUTPUT,
                  results_folder(), &status);
    CHECK(status >= 0);
    CHECK_NEAR(channel(model, 1), 0.0, 0.0);
    CHECK_NEAR(channel(model, 2), 1.0, 0.0);
    se3d_model_destroy(model);
}

#define TWO                                                                                        \
    "se3d: 1\nmaterials: [{name: glass, density: 2500, stiffness: 1e4}, {name: steel, density: "   \
    "7800, stiffness: 1e4}]\n"                                                                     \
    "bodies: [{name: ground, shapes: [{name: floor, type: plane, material: steel}]}]\n"

static char *read_file(const char *name, char *text, size_t size)
{
    char path[1000];
    snprintf(path, sizeof path, "%s/%s", results_folder(), name);
    FILE *file = fopen(path, "rb");
    const size_t length = file ? fread(text, 1, size - 1, file) : 0;
    text[length] = '\0';
    if (file) {
        fclose(file);
    }
    return text;
}

static void write_file(const char *name, const char *text)
{
    char path[1000];
    snprintf(path, sizeof path, "%s/%s", results_folder(), name);
    FILE *file = fopen(path, "wb");
    CHECK(file && fputs(text, file) >= 0 && fclose(file) == 0);
}

/* The k-th comma of a row, from 1. */
static const char *find_comma(const char *row, size_t k)
{
    const char *at = row - 1;
    while (k-- > 0 && at) {
        at = strchr(at + 1, ',');
    }
    return at ? at : row;
}

/* Sets of two materials and sizes that meet; what is written is read back, bit by bit. */
static void tables_that_were_written_are_read_back(void)
{
    static char first[200000], second[200000];
    char text[3000];
    se3d_status status = SE3D_OK;
    se3d_model *model = run_model(
        TWO "particles:\n"
            "  - {name: sand, material: glass, radius: [0.003, 0.005], lower: [0, 0, 0], upper: "
            "[0.05, 0.05, 0.03], jitter: 3e-4, seed: 5}\n"
            "  - {name: shot, material: steel, radius: 0.01, count: 2, lower: [0, 0, 0.04], upper: "
            "[0.05, 0.05, 0.07], velocity: [0.1, 0, -1]}\n"
            "analysis: {type: dynamics, duration: 0.1}\n"
            "output: [{file: grains.csv, every: 0.05, particles: true}, {file: shot.csv, "
            "particles: shot}]\n",
        results_folder(), &status);
    CHECK(status >= 0);
    se3d_model_destroy(model);
    read_file("grains.csv", first, sizeof first);
    const char *last = strstr(first, "\n0.1");
    CHECK(last && strstr(last, ",glass,sand,") && strstr(last, ",steel,shot,"));
    double most = 0.0; /* of what contacts do to one of them */
    for (const char *at = strstr(first, ",shot,"); at; at = strstr(at + 1, ",shot,")) {
        most = fmax(most, strtod(at + 6, NULL));
    }
    CHECK(most > 1e-4);
    CHECK(strstr(read_file("shot.csv", second, sizeof second), ",steel,shot,"));
    CHECK(!strstr(second, ",glass,"));
    snprintf(text, sizeof text,
             TWO "particles: [{material: glass, file: %s/grains.csv}, {name: other, material: "
                 "glass, radius: 0.001, count: 1, lower: [1, 1, 1], upper: [2, 2, 2]}]\n"
                 "analysis: {type: dynamics, duration: 0.01, start: 0.1}\n"
                 "output: [{file: again.csv, every: 0.01, particles: true}]\n",
             results_folder());
    model = run_model(text, results_folder(), &status);
    CHECK(status >= 0);
    se3d_model_destroy(model);
    read_file("again.csv", second, sizeof second);
    const char *again = strchr(second, '\n');
    size_t rows = 0;
    /* But for the ids, which are new, sets and forces. */
    for (; last && again && last[1] && again[1]; ++rows) {
        const char *a = find_comma(last + 1, 2);
        const char *b = find_comma(again + 1, 2);
        const char *end_a = find_comma(last + 1, 13);
        CHECK((size_t)(end_a - a) == (size_t)(find_comma(again + 1, 13) - b));
        CHECK(strncmp(a, b, (size_t)(end_a - a)) == 0);
        last = strchr(end_a, '\n');
        again = strchr(b, '\n');
    }
    CHECK(rows > 20);
}

static se3d_particles *set_of(se3d_model *model)
{
    se3d_particles *set = NULL;
    CHECK(!se3d_particles_find(se3d_model_get_system(model), "particles", &set));
    return set;
}

static double kinetic_of(const se3d_particles *set)
{
    se3d_particles_energy energy;
    CHECK(!se3d_particles_get_energy(set, &energy));
    return energy.translation + energy.rotation;
}

/* Clumps, some of them scaled, and spheres, in a period that they lie across. */
static void clumps_that_were_written_are_read_back(void)
{
#define CLUMPS                                                                                     \
    TWO "clumps:\n  - {name: rod, spheres: [{position: [0, 0, 0], radius: 0.01},\n"                \
        "      {position: [0.01, 0, 0], radius: 0.008}]}\n"                                        \
        "  - {name: hook, spheres: [{position: [0, 0, 0], radius: 0.01}, {position: [0.01, 0, "    \
        "0], "                                                                                     \
        "radius: 0.01},\n      {position: [0.01, 0.012, 0.003], radius: 0.009}]}\n"                \
        "contact: {boundary: [periodic, periodic, open], lower: [0, 0, 0], upper: [0.2, 0.2, "     \
        "1]}\n"
    enum { MOST = 1000 };
    static double was[3][3 * MOST], now[3][3 * MOST];
    static uint32_t clumps[2][MOST], tags[2][MOST];
    char text[3000];
    se3d_status status = SE3D_OK;
    se3d_particles *set = NULL;
    se3d_model *model = run_model(
        CLUMPS
        "particles:\n  - {material: glass, radius: 0.01, lower: [0, 0, 0.1], upper: [0.2, 0.2, "
        "0.14]}\n"
        "  - {name: rods, clump: rod, material: steel, lower: [0, 0, 0.14], upper: [0.2, 0.2, "
        "0.2], velocity: [3, 2, -1]}\n"
        "  - {name: hooks, clump: hook, radius: [0.015, 0.02], material: glass, packing: random, "
        "count: 25, lower: [0, 0, 0.2], upper: [0.2, 0.2, 0.6], velocity: [1, 0, -4], seed: 3}\n"
        "analysis: {type: dynamics, duration: 0.02}\n"
        "output: [{file: clumps.csv, every: 0.02, particles: true}]\n",
        results_folder(), &status);
    CHECK(status >= 0 && (set = set_of(model)) != NULL);
    const size_t n = se3d_particles_count(set), clump_count = se3d_particles_count_clumps(set);
    CHECK(n > 100 && n < MOST && clump_count > 50);
    CHECK(!se3d_particles_get_all(set, n, was[0], was[1], was[2]));
    CHECK(!se3d_particles_get_clump_of(set, n, clumps[0]));
    const double energy = kinetic_of(set);
    se3d_model_destroy(model);
    snprintf(text, sizeof text,
             CLUMPS "particles: [{material: glass, name: all, file: %s/clumps.csv}]\n",
             results_folder());
    se3d_model_error error;
    CHECK(!se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, &error));
    CHECK((set = set_of(model)) != NULL && se3d_particles_count(set) == n);
    CHECK(se3d_particles_count_clumps(set) == clump_count);
    CHECK(!se3d_particles_get_all(set, n, now[0], now[1], now[2]));
    CHECK(!se3d_particles_get_clump_of(set, n, clumps[1]));
    CHECK(!se3d_particles_get_tags(set, n, tags[1]));
    for (size_t k = 0; k < 3 * n; ++k) {
        const double off = now[0][k] - was[0][k]; /* a period is no difference */
        CHECK_NEAR(k % 3 < 2 ? off - 0.2 * floor(off / 0.2 + 0.5) : off, 0.0, 1e-14);
        CHECK_NEAR(now[1][k], was[1][k], 1e-12);
        CHECK_NEAR(now[2][k], was[2][k], 1e-9);
        CHECK(clumps[0][k / 3] == clumps[1][k / 3] && tags[1][k / 3] == 1);
    }
    CHECK_NEAR(kinetic_of(set) / energy, 1.0, 1e-10);
    se3d_model_destroy(model);
#undef CLUMPS
}

static void tables_are_refused_with_line_and_column(void)
{
    static const struct {
        const char *table, *part;
    } bad[] = {
        {"x,y,z\n0,0,0\n", "column 3: `radius` is missing"},
        {"x,y,z,r\n", "line 1, column 4: `r` is not a column"},
        {"x,y,z,x,radius\n", "line 1, column 4: `x` appears twice"},
        {"x,y,z,radius\n0,0,0,0.1\n0,0,zero,0.1\n", "line 3, column 3: `zero` is not a number"},
        {"x,y,z,radius\n0,0,1e999,0.1\n", "line 2, column 3: `1e999` is not a number"},
        {"x,y,z,radius\n\n0,0,0,-0.1\n", "line 3, column 4: `-0.1` is a radius, must be > 0"},
        {"x,y,z,radius\n0,0,0\n", "line 2, column 4: `radius` is missing: the row is too short"},
        {"x,y,z,radius\n0,0,0,1,5\n", "line 2, column 5: `5` is beyond the last"},
        {"x,y,z,radius,material\n0,0,0,1,wood\n", "line 2, column 5: `wood` is not a material"},
        {"x,y,z,radius\n0,0,0,\n", "line 2, column 4: `` is not a number"},
        {"x,y,z,radius,clump\n0,0,0,1,-1\n0,0,0,1,2\n0,0,0,1,2\n0,0,0,1,3\n",
         "line 3, column 1: `clump` begins a clump of 2 spheres as no entry of `clumps` has them"}};
    char text[2000];
    for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
        se3d_model *model = NULL;
        se3d_model_error error;
        write_file("bad.csv", bad[k].table);
        snprintf(text, sizeof text, TWO "particles: [{material: glass, file: %s/bad.csv}]\n",
                 results_folder());
        CHECK(se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, &error) ==
              SE3D_ERR_MODEL);
        CHECK_CONTAINS(error.message, bad[k].part);
        CHECK_CONTAINS(error.message, "m.yaml:4:");
    }
}

/* Two particles rest on a plane, one on the other's side of a wall: contacts carry the weight. */
static void contacts_are_listed_with_their_forces(void)
{
    static char text[20000];
    se3d_status status = SE3D_OK;
    se3d_model *model = run_model(
        TWO "particles: [{name: sand, material: glass, radius: 0.01, count: 1, lower: [-0.011, "
            "-0.011, 0], upper: [0.011, 0.011, 0.022]}]\n"
            "analysis: {type: dynamics, duration: 0.5}\n"
            "output: [{file: contacts.csv, every: 1, contacts: true}]\n",
        results_folder(), &status);
    CHECK(status >= 0);
    se3d_model_destroy(model);
    read_file("contacts.csv", text, sizeof text);
    CHECK_CONTAINS(text, "time,kind,a,b,x,y,z,nx,ny,nz,overlap,fn,ftx,fty,ftz\n");
    const char *row = strstr(text, "\n0.5,wall,0,floor,");
    double v[11] = {0.0};
    CHECK(row != NULL);
    const char *at = row ? row + strlen("\n0.5,wall,0,floor,") : "";
    for (size_t k = 0; k < 11 && *at; ++k) {
        char *end;
        v[k] = strtod(at, &end);
        at = end + (*end == ',');
    }
    const double pi = acos(-1.0);
    const double weight = 9.81 * 2500.0 * 4.0 / 3.0 * pi * 1e-6;
    CHECK_NEAR(v[2], 0.0, 1e-12);  /* on the plane */
    CHECK_NEAR(v[5], -1.0, 1e-12); /* from the particle to the floor */
    CHECK_NEAR(v[7], weight, 1e-3 * weight);
    CHECK_NEAR(v[6], weight / 1e4, 1e-2 * weight / 1e4);
}

static void chute_counts_what_flows(void)
{
    se3d_status status = SE3D_OK;
    se3d_model *model = run_model(
        TWO "particles:\n"
            "  - {name: sand, material: glass, radius: 0.004, lower: [0, 0, 0.1], upper: [0.05, "
            "0.05, 0.12], source: {rate: 200*t, start: 0.1, stop: 0.5, count: 20}}\n"
            "  - {name: shot, material: steel, radius: 0.01, count: 1, lower: [1, 0, 0.3], upper: "
            "[2, 1, 1], packing: random}\n"
            "sinks: [{name: pit, lower: [0.5, -1, -1], upper: [3, 3, 0.1]}]\n"
            "analysis: {type: dynamics, duration: 0.6}\n"
            "output: [{file: s.csv, every: 0.1, channels: [sand.count, sand.inserted, "
            "sand.deferred, sand.waiting, sand.left, shot.lost, shot.left, pit.count, "
            "particles.left, sand.mass]}]\n",
        results_folder(), &status);
    CHECK(status >= 0);
    /* The integral of 200 t from 0.1 to 0.5 is 24, of which 20 are allowed. */
    const double expected[9] = {20.0, 20.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0};
    for (size_t k = 0; k < 9; ++k) {
        CHECK_NEAR(channel(model, k), expected[k], 0.0);
    }
    CHECK_NEAR(channel(model, 9), 20.0 * 2500.0 * 4.0 / 3.0 * acos(-1.0) * 6.4e-8, 1e-12);
    se3d_model_destroy(model);
}

/* A rod that stands upright and one that lies, as they are turned; the rows say which spheres are
 * together, and the energy is that of two rods and a sphere. */
static void clumps_are_read_and_written(void)
{
    static const char text[] =
        "se3d: 1\ngravity: [0, 0, -10]\n"
        "materials: [{name: m, density: 1000, stiffness: 1e4}]\n"
        "clumps:\n"
        "  - {name: rod, spheres: [{position: [-0.02, 0, 0], radius: 0.02}, {position: [0.02, 0, "
        "0], "
        "radius: 0.02}]}\n"
        "  - {name: disc, spheres: [{position: [0, 0, 0], radius: 0.01}], mass: 2, centre: [0, 0, "
        "0.005], inertia: [1e-3, 1e-3, 1e-3]}\n"
        "particles:\n"
        "  - {material: m, clump: rod, orientation: {axis: [0, 1, 0], angle: -90*deg}, count: 1, "
        "lower: [0, 0, 1], upper: [0.1, 0.1, 1.1]}\n"
        "  - {name: big, material: m, clump: rod, radius: 0.08, orientation: {rpy: [0, 0, 0]}, "
        "count: 1, lower: [0.5, 0, 1], upper: [0.7, 0.2, 1.2]}\n"
        "  - {name: one, material: m, radius: 0.01, count: 1, lower: [1, 0, 1], upper: [1.1, 0.1, "
        "1.1]}\n"
        "  - {name: heavy, material: m, clump: disc, count: 1, lower: [2, 0, 1], upper: [2.1, 0.1, "
        "1.1]}\n"
        "analysis: {type: dynamics, duration: 0.1}\n"
        "regions: [{name: box, set: big, lower: [0.4, -0.1, 0.8], upper: [0.8, 0.3, 1.2]}]\n"
        "output: [{file: s.csv, every: 0.1, channels: [big.energy, big.mass, heavy.mass, "
        "particles.count, box.count, box.solid_fraction, box.mass_flux, box.stress, "
        "box.temperature]}, {file: grains.csv, every: 0.1, particles: true}, {file: g.pvd, every: "
        "0.1}]\n";
    const double V = 4.0 / 3.0 * 3.14159265358979324 * 8e-6, fall = -0.05;
    se3d_status status;
    se3d_model *model = run_model(text, results_folder(), &status);
    CHECK(status >= 0);
    const double owners[6] = {0, 0, 2, 2, -1, 5}, radius[6] = {.02, .02, .04, .04, .01, .01};
    for (size_t k = 0; k < 6; ++k) {
        CHECK_NEAR(particle(7 + k, 0), 0.1, 1e-12);
        CHECK_NEAR(particle(7 + k, 1), (double)k, 0.0);
        CHECK_NEAR(particle(7 + k, 2), radius[k], 1e-12);
        CHECK_NEAR(particle(7 + k, 15), owners[k], 0.0);
    }
    CHECK_NEAR(particle(7, 3) - particle(8, 3), 0.0, 1e-12);
    CHECK_NEAR(particle(8, 5) - particle(7, 5), 0.04, 1e-12); /* upright */
    CHECK_NEAR(particle(10, 3) - particle(9, 3), 0.08, 1e-12);
    CHECK_NEAR(particle(7, 5), particle(1, 5) + fall, 1e-9);
    const double height = 0.5 * (particle(9, 5) + particle(10, 5)), mass = 1000.0 * 16.0 * V;
    CHECK_NEAR(channel(model, 0) / mass, 10.0 * height + 0.5, 1e-9); /* at 1 m/s */
    CHECK_NEAR(channel(model, 1), mass, 1e-12);
    CHECK_NEAR(channel(model, 2), 2.0, 1e-12);
    CHECK_NEAR(channel(model, 3), 6.0, 0.0);
    const double space = 0.4 * 0.4 * 0.4;
    CHECK_NEAR(channel(model, 4), 1.0, 0.0);
    CHECK_NEAR(channel(model, 5) * space / (16.0 * V), 1.0, 1e-9);
    CHECK_NEAR(column_of(model, 6, 2) * space / -mass, 1.0, 1e-9); /* it falls at 1 m/s */
    CHECK_NEAR(column_of(model, 7, 2), 0.0, 1e-9);
    CHECK_NEAR(channel(model, 8), 0.0, 1e-12);
    se3d_model_destroy(model);
}

/* A sphere that is free goes with the cell; then servo pulls it open, as fast as it may. */
static void cells_are_read_and_strain(void)
{
    static const char text[] =
        "se3d: 1\ngravity: [0, 0, 0]\n"
        "materials: [{name: m, density: 1000, stiffness: 1e4}]\n"
        "contact: {boundary: [periodic, periodic, periodic], lower: [0, 0, 0], upper: [1, 1, 1]}\n"
        "particles: [{name: one, material: m, radius: 0.1, count: 1, lower: [0, 0, 0], upper: "
        "[1, 1, 1]}]\n"
        "cell:\n"
        "  - {shear_rate: 0.5, flow: y, gradient: x, rate: [0, 0, 1]}\n"
        "  - {start: 0.1, servo: xz, stress: [-5, 0, 7], rate_max: [2, 9, 3], gain: [0, 0, 1]}\n"
        "analysis: {type: dynamics, duration: 0.2}\n"
        "output: [{file: s.csv, every: 0.1, channels: [cell.length, cell.strain, cell.rate, "
        "cell.stress, cell.shear, cell.shear_strain, cell.shear_rate, cell.offset, cell.volume, "
        "cell.solid_fraction, cell.kinetic, cell.work]}]\n";
    const double V = 4.0 / 3.0 * 3.14159265358979324 * 1e-3;
    se3d_status status;
    se3d_model *model = run_model(text, results_folder(), &status);
    CHECK(status >= 0);
    CHECK_NEAR(column_of(model, 0, 0), exp(0.2), 1e-3);
    CHECK_NEAR(column_of(model, 0, 1), 1.0, 1e-12);
    CHECK_NEAR(column_of(model, 1, 0), 0.2, 1e-3);
    CHECK_NEAR(column_of(model, 1, 2), 0.1 - 0.3, 1e-3);
    CHECK_NEAR(column_of(model, 2, 0), 2.0, 1e-12); /* to a stress of -5: default gain, bounded */
    CHECK_NEAR(column_of(model, 2, 2), -3.0, 1e-12);
    CHECK_NEAR(column_of(model, 3, 0), 0.0, 1e-12);
    CHECK_NEAR(column_of(model, 4, 2), 0.0, 1e-12);
    CHECK_NEAR(channel(model, 5), 0.05, 1e-4);
    CHECK_NEAR(channel(model, 6), 0.0, 0.0);
    CHECK_NEAR(channel(model, 7), 0.05, 1e-4);
    CHECK_NEAR(channel(model, 8), 1.0, 1e-3);
    CHECK_NEAR(channel(model, 9), V / channel(model, 8), 1e-12);
    CHECK_NEAR(channel(model, 10), 0.0, 1e-12);
    CHECK_NEAR(channel(model, 11), 0.0, 1e-12);
    se3d_model_destroy(model);
}

/* A pair that hangs from a ceiling by one bond, and by itself by another, which breaks. */
static void bonds_are_read_and_break(void)
{
    static const char text[] =
        "se3d: 1\ngravity: [0, 0, -10]\n"
        "materials: [{name: m, density: 1000, stiffness: 1e5}]\n"
        "bodies: [{name: top, fixed: true, shapes: [{name: roof, type: plane, normal: [0, 0, -1], "
        "material: m}]}]\n"
        "particles: [{name: two, material: m, radius: 0.1, spacing: 0.2, lower: [-0.1, -0.1, "
        "-0.4], "
        "upper: [0.1, 0.1, 0]}]\n"
        "bonds:\n"
        "  - {name: held, set: two, shape: roof, gap: 1e-6, law: parallel, normal_stiffness: 1e8, "
        "shear_stiffness: 1e8, damping: 0.3}\n"
        "  - {name: weak, pairs: [[1, 0]], law: slender, young: 1e7, radius: 0.05, "
        "tensile_strength: 1e4}\n"
        "analysis: {type: dynamics, duration: 0.2}\n"
        "output:\n"
        "  - {file: s.csv, every: 0.1, channels: [held.count, held.broken, held.tension, "
        "held.energy, "
        "weak.count, weak.broken, weak.torn, weak.sheared, weak.lost, weak.released, "
        "held.dissipated, held.shear]}\n"
        "  - {vtk: s.pvd, every: 0.1}\n";
    const double weight = 1000.0 * 4.0 / 3.0 * 3.14159265358979324 * 1e-3 * 10.0;
    const double A = 3.14159265358979324 * 1e-2;
    se3d_status status;
    se3d_model *model = run_model(text, results_folder(), &status);
    CHECK(status >= 0);
    CHECK_NEAR(channel(model, 0), 1.0, 0.0);
    CHECK_NEAR(channel(model, 1), 0.0, 0.0);
    CHECK_NEAR(channel(model, 2) / (weight / A), 1.0, 1e-3);
    CHECK_NEAR(channel(model, 3) / (weight * weight / (2.0 * 1e8 * A)), 1.0, 1e-3);
    CHECK_NEAR(channel(model, 4), 0.0, 0.0);
    CHECK_NEAR(channel(model, 5), 1.0, 0.0);
    CHECK_NEAR(channel(model, 6), 1.0, 0.0);
    CHECK_NEAR(channel(model, 7), 0.0, 0.0);
    CHECK_NEAR(channel(model, 8), 0.0, 0.0);
    CHECK(channel(model, 9) > 0.0 && channel(model, 10) > 0.0);
    CHECK_NEAR(channel(model, 11), 0.0, 1e-9);
    char path[512], head[1024] = "";
    snprintf(path, sizeof path, "%s/s/bonds_00002.vtp", results_folder());
    FILE *file = fopen(path, "rb");
    CHECK(file);
    if (file) {
        head[fread(head, 1, sizeof head - 1, file)] = '\0';
        fclose(file);
    }
    CHECK_CONTAINS(head, "NumberOfPoints=\"2\"");
    CHECK_CONTAINS(head, "NumberOfLines=\"1\"");
    CHECK_CONTAINS(head, "Name=\"tension\"");
    se3d_model_destroy(model);
}

/* A sphere between the floor and a lid that comes down to it. */
static void servo_walls_are_read_and_press(void)
{
    static const char text[] =
        "se3d: 1\ngravity: [0, 0, 0]\n"
        "materials: [{name: m, density: 1000, stiffness: 1e4}]\ncontact: {audit: true}\n"
        "bodies: [{name: ground, shapes: [{type: plane, material: m}, {type: plane, name: top, "
        "normal: [0, 0, -1], position: [0, 0, 0.21], material: m}]}]\n"
        "particles: [{material: m, radius: 0.1, packing: random, count: 1, lower: [-0.1, -0.1, 0], "
        "upper: [0.1, 0.1, 0.2]}]\n"
        "servos: [{name: lid, shape: top, axis: [0, 0, -3], stress: \"40*step(t, 0.1, 0, 0.4, "
        "1)\", area: 0.25, "
        "speed_max: 0.1, start: 0.1}]\n"
        "analysis: {type: dynamics, duration: 1}\n"
        "output: [{file: s.csv, every: 0.5, channels: [lid.position, lid.speed, lid.force, "
        "lid.wanted, lid.work, dissipation.total, dissipation.normal, dissipation.elastic, "
        "dissipation.wall_work]}]\n";
    se3d_status status;
    se3d_model *model = run_model(text, results_folder(), &status);
    CHECK(status >= 0);
    CHECK_NEAR(channel(model, 3), 10.0, 1e-2);
    CHECK_NEAR(channel(model, 2), 10.0, 0.1);
    CHECK(channel(model, 0) > 0.01 && channel(model, 0) < 0.015);
    CHECK(channel(model, 1) > 0.0 && channel(model, 1) < 0.05);
    CHECK_NEAR(channel(model, 4), 0.5 * channel(model, 2) * (channel(model, 0) - 0.01), 2e-3);
    CHECK(channel(model, 5) > 0.0);
    CHECK_NEAR(channel(model, 6), channel(model, 5), 1e-15);
    CHECK_NEAR(channel(model, 8), channel(model, 4), 1e-4);
    CHECK_NEAR(channel(model, 5) + channel(model, 7), channel(model, 8), 1e-4);
    se3d_model_destroy(model);
}

#define WITH_SET                                                                                   \
    "se3d: 1\nmaterials: [{name: m, density: 1, stiffness: 1}]\nparticles: [{material: m, "        \
    "radius: "                                                                                     \
    "0.1, lower: [0, 0, 0], upper: [1, 1, 1]}]\n"

typedef struct refusal {
    const char *text;
    size_t line;
    const char *words[2]; /* of the message */
} refusal;

static const refusal refusals[] = {
    {"se3d: 1\nregions: []\n", 2, {"regions: needs `particles`"}},
    {WITH_SET "regions: [{name: a, lower: [0, 0, 0]}]\n", 4, {"regions[0]: must have `name`"}},
    {WITH_SET "regions: [{name: a, lower: [0, 0, 0], upper: [1, 0, 1]}]\n",
     4,
     {"upper: is 0 along y, must be greater than `lower`, 0"}},
    {WITH_SET "regions: [{name: a, set: b, lower: [0, 0, 0], upper: [1, 1, 1]}]\n",
     4,
     {"no `particles` are named `b`"}},
    {WITH_SET "regions: [{name: energy, lower: [0, 0, 0], upper: [1, 1, 1]}]\n", 4, {"is taken"}},
    {"se3d: 1\nservos: [{name: a}]\n", 2, {"servos: needs `particles`"}},
    {WITH_SET "servos: [{name: a, shape: b}]\n", 4, {"servos[0]: must have `axis`"}},
    {WITH_SET "servos: [{name: a, shape: b, axis: [1, 0, 0], speed_max: 1}]\n",
     4,
     {"servos[0].shape: no shape that touches is named `b`"}},
#define LID                                                                                        \
    WITH_SET "bodies: [{name: ground, shapes: [{type: plane, name: b, material: m}]}]\n"           \
             "servos: [{name: a, shape: b, axis: [1, 0, 0], speed_max: 1"
    {LID "}]\n", 5, {"servos[0]: must have either `force` [N] or `stress` [Pa]"}},
    {LID ", stress: 1}]\n", 5, {"servos[0].stress: needs `area`"}},
    {LID ", force: 1, area: 1}]\n", 5, {"servos[0].area: needs `stress`"}},
#define CELL WITH_SET "contact: {boundary: [periodic, periodic, periodic], upper: [9, 9, 9]}\n"
    {CELL "cell: [{volume: xx}]\n", 5, {"cell[0].volume: is `xx`", "each once"}},
    {CELL "cell: [{volume: xyz}]\n", 5, {"cell[0]", "is set for all axes"}},
    {CELL "cell: [{volume: x, rate: [1, 0, 0]}]\n", 5, {"volume[0] = 1, must be 0 beside"}},
    {CELL "cell: [{shear_gain: 1}]\n", 5, {"cell[0].shear_gain", "without `shear_stress`"}},
    {CELL "cell: [{shear_stress: 1, shear_rate: 1}]\n", 5, {"cell[0]", "beside shear_servo"}},
    {WITH_SET "output: [{file: a.csv, channels: [dissipation.normal]}]\n",
     4,
     {"`dissipation.normal` is unknown", "audit: true"}},
    {WITH_SET "output: [{summary: a.csv, start: 2, stop: 1, channels: [particles.count]}]\n",
     4,
     {"stop: is 1 s, must be after `start`, 2 s"}},
    {"se3d: 1\nclumps: []\n", 2, {"clumps: needs `particles`"}},
    {WITH_SET "clumps: [{name: a}]\n", 4, {"clumps[0].spheres", "is missing"}},
    {WITH_SET "clumps: [{spheres: [{position: [0, 0, 0], radius: 1}]}]\n", 4, {"name: is missing"}},
    {WITH_SET "clumps: [{name: a, spheres: [{position: [0, 0, 0]}]}]\n", 4, {"`position` and"}},
    {WITH_SET "clumps: [{name: a, spheres: [{position: [0, 0, 0], radius: -1}]}]\n", 4, {"> 0"}},
    {WITH_SET "clumps: [{name: a, mass: 1, spheres: [{position: [0, 0, 0], radius: 1}]}]\n",
     4,
     {"inertia: is missing beside `mass`"}},
    {WITH_SET
     "clumps: [{name: a, centre: [0, 0, 0], spheres: [{position: [0, 0, 0], radius: 1}]}]\n",
     4,
     {"centre: needs `mass`"}},
    {GLASS
     "clumps: [{name: a, mass: 1, inertia: [1, 1, 3], spheres: [{position: [0, 0, 0], radius: "
     "1}]}]\n",
     4,
     {"that of no body"}},
    {WITH_SET "clumps: [{name: a, spheres: [{position: [0, 0, 0], radius: 1}]}, {name: a, spheres: "
              "[{position: [0, 0, 0], radius: 1}]}]\n",
     4,
     {"`a` is taken"}},
    {"se3d: 1\nmaterials: [{name: m, density: 1, stiffness: 1}]\nparticles: [{material: m, clump: "
     "b, "
     "lower: [0, 0, 0], upper: [1, 1, 1]}]\n",
     3,
     {"no clump is named `b`"}},
    {"se3d: 1\nmaterials: [{name: m, density: 1, stiffness: 1}]\nparticles: [{material: m, radius: "
     "0.1, "
     "orientation: {rpy: [0, 0, 0]}, lower: [0, 0, 0], upper: [1, 1, 1]}]\n",
     3,
     {"orientation: is only for a `clump`"}},
#define SINGLE                                                                                     \
    "se3d: 1\nmaterials: [{name: m, density: 1, stiffness: 1}]\n"                                  \
    "clumps: [{name: c, spheres: [{position: [0, 0, 0], radius: 1}]}]\nparticles:\n"               \
    "  - {material: m, position: [0, 0, 0], "
    {SINGLE "radius: 1, count: 3}\n", 5, {"count: has no effect with `position`", " radius "}},
    {SINGLE "radius: [1, 2]}\n", 5, {"radius: must be one number at a `position`"}},
    {SINGLE "velocity: [1, 0, 0]}\n", 5, {"radius: is missing"}},
    {SINGLE "clump: c, fixed: true}\n", 5, {"fixed: has no effect", "`clump`, which takes:"}},
    {"se3d: 1\nmaterials: [{name: m, density: 1, stiffness: 1}]\nparticles: [{material: m, radius: "
     "1, lower: [0, 0, 0], upper: [2, 2, 2], fixed: true, source: {rate: 1}}]\n",
     3,
     {"fixed: has no effect with `source`"}},
    {SINGLE "clump: c, radius: 1}\n", 5, {"radius: has no effect", "`clump`, which takes:"}},
    {"se3d: 1\nmaterials: [{name: m, density: 1, stiffness: 1}]\nparticles: [{material: m, radius: "
     "1, lower: [0, 0, 0], upper: [2, 2, 2], angular_velocity: [1, 0, 0]}]\n",
     3,
     {"angular_velocity: is only for a `position`"}},
};

/* To the bit. */
static void single_particles_are_where_they_are_said_to_be(void)
{
    static const char text[] =
        "se3d: 1\nmaterials: [{name: m, density: 1, stiffness: 1}]\n"
        "clumps: [{name: c, spheres: [{position: [0, 0, 0], radius: 0.1}, {position: [0.3, 0, 0], "
        "radius: 0.1}]}]\n"
        "particles:\n  - {name: a, material: m, radius: 0.1, position: [0.7, -0.3, 0.1], velocity: "
        "[1, 2, 3], angular_velocity: [4, 5, 6]}\n"
        "  - {name: b, material: m, radius: 0.2, position: [3, 3, 3]}\n"
        "  - {name: a, material: m, clump: c, position: [9, 8, 7], velocity: [0, 0, 1], "
        "orientation: "
        "{axis: [0, 0, 1], angle: pi/2}, angular_velocity: [0, 2, 0]}\n";
    se3d_model *model = NULL;
    se3d_model_error error;
    se3d_particles *set = NULL;
    double r[12], v[12], w[12], e[4], centre[3];
    uint32_t tags[4];
    CHECK(se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, &error) == SE3D_OK);
    CHECK(se3d_system_get_particles(se3d_model_get_system(model), 0, &set) == SE3D_OK);
    CHECK(se3d_particles_get_all(set, 4, r, v, w) == SE3D_OK);
    CHECK(se3d_particles_get_tags(set, 4, tags) == SE3D_OK);
    CHECK(se3d_particles_get_clumps(set, 1, centre, e, NULL, NULL) == SE3D_OK);
    const double expected[9] = {0.7, -0.3, 0.1, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
    for (int a = 0; a < 3; ++a) {
        CHECK_NEAR(r[a], expected[a], 0.0);
        CHECK_NEAR(v[a], expected[3 + a], 0.0);
        CHECK_NEAR(w[a], expected[6 + a], 0.0);
        CHECK_NEAR(r[3 + a], 3.0, 0.0);
        CHECK_NEAR(w[3 + a], 0.0, 0.0);
        CHECK_NEAR(centre[a], 9.0 - a, 0.0);
        CHECK_NEAR(w[6 + a], a == 1 ? 2.0 : 0.0, 1e-15);
    }
    CHECK_NEAR(fabs(r[10] - r[7]), 0.3, 1e-12); /* turned to y */
    CHECK(tags[0] == tags[2] && tags[0] == tags[3] && tags[1] != tags[0] && tags[1] != 0);
    se3d_model_destroy(model);
}

/* Of a table, a place and a region; beside one that falls. */
static void fixed_ones_stay_and_shear(void)
{
    static const char text[] =
        "se3d: 1\nmaterials: [{name: m, density: 1, stiffness: 1}]\nparticles:\n"
        "  - {material: m, file: %s/base.csv, fixed: true}\n"
        "  - {material: m, radius: 0.1, position: [5, 0, 0], velocity: [0.5, 0, 0], fixed: true}\n"
        "  - {material: m, radius: 0.1, lower: [7, 0, 0], upper: [7.2, 0.2, 0.2], fixed: true}\n"
        "  - {material: m, radius: 0.1, position: [9, 0, 0]}\n"
        "analysis: {type: dynamics, duration: 1}\n";
    char full[2000];
    se3d_particles *set = NULL;
    se3d_status status;
    double v[15];
    write_file("base.csv", "x,y,z,radius,vz\n0,0,0,.1,0\n1,0,0,.1,2\n");
    snprintf(full, sizeof full, text, results_folder());
    se3d_model *model = run_model(full, NULL, &status);
    CHECK(status >= 0);
    CHECK(se3d_system_get_particles(se3d_model_get_system(model), 0, &set) == SE3D_OK);
    CHECK(se3d_particles_get_all(set, 5, NULL, v, NULL) == SE3D_OK);
    const double expected[15] = {0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.5,  0.0,
                                 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -9.81};
    for (int k = 0; k < 15; ++k) {
        CHECK_NEAR(v[k], expected[k], k == 14 ? 0.01 : 0.0);
    }
    se3d_model_destroy(model);
}

static void clumps_and_regions_are_refused_by_name_and_line(void)
{
    for (size_t k = 0; k < sizeof refusals / sizeof *refusals; ++k) {
        const refusal *r = &refusals[k];
        se3d_model *model = NULL;
        se3d_model_error error;
        CHECK(se3d_model_read_text(r->text, strlen(r->text), "m.yaml", NULL, &model, &error) < 0);
        CHECK(!model && error.line == r->line);
        for (int w = 0; w < 2 && r->words[w]; ++w) {
            CHECK_CONTAINS(error.message, r->words[w]);
        }
    }
}

int main(void)
{
    RUN(kinetic_energy_of_a_ball_that_rolls);
    RUN(tables_that_were_written_are_read_back);
    RUN(clumps_that_were_written_are_read_back);
    RUN(tables_are_refused_with_line_and_column);
    RUN(contacts_are_listed_with_their_forces);
    RUN(chute_counts_what_flows);
    RUN(clumps_are_read_and_written);
    RUN(cells_are_read_and_strain);
    RUN(servo_walls_are_read_and_press);
    RUN(bonds_are_read_and_break);
    RUN(single_particles_are_where_they_are_said_to_be);
    RUN(fixed_ones_stay_and_shear);
    RUN(clumps_and_regions_are_refused_by_name_and_line);
    RUN(particle_falls_and_bounces_with_its_restitution);
    RUN(driven_wall_throws_a_particle);
    RUN(particles_that_leave_through_a_sink_are_counted);
    return check_finish();
}
