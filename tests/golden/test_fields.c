/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields of particles on a grid: their sums are what there is, and one cell is the average. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/particle_worlds.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

enum { CELLS_MOST = 2000 };

static double fields[CELLS_MOST * SE3D_FIELD_VALUES];

static se3d_field_grid grid_of(int32_t x, int32_t y, int32_t z, double width)
{
    se3d_field_grid grid = se3d_field_grid_default();
    grid.lower[0] = grid.lower[1] = -0.1;
    grid.upper[0] = grid.upper[1] = 0.1;
    grid.lower[2] = -0.02;
    grid.upper[2] = 0.4;
    grid.cells[0] = x;
    grid.cells[1] = y;
    grid.cells[2] = z;
    grid.width = width;
    return grid;
}

/* Of all cells times their volume; returns the number of cells. */
static size_t add_up(const se3d_particles *set, const se3d_field_grid *grid,
                     double sum[SE3D_FIELD_VALUES])
{
    const size_t cells = (size_t)grid->cells[0] * (size_t)grid->cells[1] * (size_t)grid->cells[2];
    double volume = 1.0 / (double)cells;
    for (int a = 0; a < 3; ++a) {
        volume *= grid->upper[a] - grid->lower[a];
    }
    memset(sum, 0, SE3D_FIELD_VALUES * sizeof *sum);
    CHECK(cells <= CELLS_MOST);
    CHECK(!se3d_particles_get_fields(set, grid, cells * SE3D_FIELD_VALUES, fields));
    for (size_t k = 0; k < cells; ++k) {
        double *f = fields + k * SE3D_FIELD_VALUES;
        const double *u = f + SE3D_FIELD_VELOCITY;
        sum[SE3D_FIELD_DENSITY] += volume * f[SE3D_FIELD_DENSITY];
        sum[SE3D_FIELD_SOLID_FRACTION] += volume * f[SE3D_FIELD_SOLID_FRACTION];
        for (int a = 0; a < 3; ++a) {
            const double p = f[SE3D_FIELD_DENSITY] * u[a];
            sum[SE3D_FIELD_VELOCITY + a] += volume * p;
            sum[SE3D_FIELD_KINETIC_STRESS + a] +=
                volume * (f[SE3D_FIELD_KINETIC_STRESS + a] + p * u[a]);
        }
        for (int c = 0; c < 6; ++c) {
            sum[SE3D_FIELD_CONTACT_STRESS + c] += volume * f[SE3D_FIELD_CONTACT_STRESS + c];
        }
    }
    return cells;
}

static se3d_system *run_world(int kind, int32_t threads, se3d_particles **set)
{
    se3d_system *system = particle_world(kind, threads);
    CHECK(!se3d_system_get_particles(system, 0, set));
    CHECK(!se3d_particles_run(*set, 0.06));
    return system;
}

/* Of one cell that holds them all, from the average over its box. */
static void get_average(const se3d_particles *set, const se3d_field_grid *grid,
                        double sum[SE3D_FIELD_VALUES])
{
    se3d_average average;
    double volume = 1.0;
    for (int a = 0; a < 3; ++a) {
        volume *= grid->upper[a] - grid->lower[a];
    }
    CHECK(!se3d_particles_get_average(set, grid->lower, grid->upper, grid->tag, &average));
    sum[SE3D_FIELD_DENSITY] = average.mass;
    sum[SE3D_FIELD_SOLID_FRACTION] = average.solid_fraction * volume;
    for (int a = 0; a < 3; ++a) {
        sum[SE3D_FIELD_VELOCITY + a] = average.mass * average.velocity[a];
        sum[SE3D_FIELD_KINETIC_STRESS + a] =
            volume * average.kinetic_stress[a] +
            average.mass * average.velocity[a] * average.velocity[a];
    }
    for (int c = 0; c < 6; ++c) {
        sum[SE3D_FIELD_CONTACT_STRESS + c] = volume * average.contact_stress[c];
    }
}

static void sums_are_what_there_is(void)
{
    static const int kinds[3] = {PARTICLES_HEAP, PARTICLES_PERIOD, PARTICLES_CLUMPS};
    for (int k = 0; k < 3; ++k) {
        se3d_particles *set;
        se3d_system *system = run_world(kinds[k], 1, &set);
        const int periodic = kinds[k] == PARTICLES_PERIOD;
        const se3d_field_grid grids[4] = {grid_of(1, 1, 1, 0.02), grid_of(7, 9, 20, 0.03),
                                          grid_of(10, 10, 12, 0.001), grid_of(10, 10, 20, 0.12)};
        for (int g = 0; g < 4; ++g) {
            double sum[SE3D_FIELD_VALUES], all[SE3D_FIELD_VALUES] = {0.0};
            const size_t cells = add_up(set, &grids[g], sum);
            get_average(set, &grids[g], all);
            CHECK(all[SE3D_FIELD_DENSITY] > 0.1);
            CHECK_NEAR(sum[0], all[0], 1e-12 * all[0]);
            for (int c = SE3D_FIELD_VELOCITY; c < SE3D_FIELD_TEMPERATURE; ++c) {
                CHECK_NEAR(sum[c], all[c], 1e-12);
            }
            for (int c = SE3D_FIELD_KINETIC_STRESS; c < SE3D_FIELD_KINETIC_STRESS + 3; ++c) {
                CHECK_NEAR(sum[c], all[c], 1e-12);
            }
            /* what of spheres and branches is outside differs: it is cut off there */
            const int cut = !periodic;
            CHECK_NEAR(sum[1], all[1], (cut ? 2e-2 : 1e-12) * all[1]);
            for (int c = SE3D_FIELD_CONTACT_STRESS; c < SE3D_FIELD_VALUES; ++c) {
                CHECK_NEAR(sum[c], all[c], (cut ? 2e-2 : 1e-9) * (fabs(all[14]) + 1e-3));
            }
            for (size_t i = 0; i < cells && g == 1; ++i) {
                CHECK(fields[SE3D_FIELD_VALUES * i] >= 0.0 &&
                      fields[SE3D_FIELD_VALUES * i + SE3D_FIELD_TEMPERATURE] >= 0.0);
            }
        }
        se3d_system_destroy(system);
    }
}

/* A lattice in a period all of whose particles move as one: the same everywhere. */
static void uniform_beds_are_uniform(void)
{
    se3d_system *system;
    se3d_material_def stuff = se3d_material_def_default();
    se3d_material material;
    se3d_particles_def def = se3d_particles_def_default();
    se3d_particles *set;
    double sum[SE3D_FIELD_VALUES];
    CHECK(!se3d_system_create(NULL, &system));
    stuff.density = 2000.0;
    stuff.stiffness = 1e4;
    CHECK(!se3d_material_create(system, &stuff, &material));
    for (int a = 0; a < 3; ++a) {
        def.boundary[a] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
        def.upper[a] = 0.1;
    }
    CHECK(!se3d_particles_create(system, &def, &set));
    for (int k = 0; k < 1000; ++k) {
        const double r[3] = {0.005 + 0.01 * (k % 10), 0.005 + 0.01 * (k / 10 % 10),
                             0.005 + 0.01 * (k / 100)};
        const double radius = 0.004, v[3] = {0.2, -0.1, 0.4};
        CHECK(!se3d_particles_add(set, material, 1, r, &radius, v, NULL, NULL));
    }
    se3d_field_grid grid = grid_of(8, 8, 8, 0.035);
    for (int a = 0; a < 3; ++a) {
        grid.lower[a] = 0.02; /* not the domain's: what leaves it on one side comes back */
        grid.upper[a] = 0.12;
    }
    const size_t cells = add_up(set, &grid, sum);
    const double solid = 4.0 / 3.0 * PI * 64e-9 / 1e-6;
    CHECK_NEAR(sum[SE3D_FIELD_SOLID_FRACTION], solid * 1e-3, 1e-15);
    for (size_t k = 0; k < cells; ++k) {
        const double *f = fields + k * SE3D_FIELD_VALUES;
        CHECK_NEAR(f[SE3D_FIELD_SOLID_FRACTION], solid, 0.03 * solid);
        CHECK_NEAR(f[SE3D_FIELD_DENSITY], 2000.0 * f[SE3D_FIELD_SOLID_FRACTION], 1e-9);
        CHECK_NEAR(f[SE3D_FIELD_VELOCITY], 0.2, 1e-12);
        CHECK_NEAR(f[SE3D_FIELD_VELOCITY + 2], 0.4, 1e-12);
        CHECK_NEAR(f[SE3D_FIELD_TEMPERATURE], 0.0, 1e-13);
    }
    grid.tag = 3;
    (void)add_up(set, &grid, sum);
    CHECK(!(sum[SE3D_FIELD_DENSITY] > 0.0));
    se3d_system_destroy(system);
}

/* The kernel as it is written down, over one cell after the other; with few cells in reach, with
 * more than are kept at once, and with rows that are longer than what is taken at once. */
static void each_cell_gets_the_part_of_the_kernel(void)
{
    const se3d_field_grid grids[4] = {grid_of(7, 9, 20, 0.03), grid_of(10, 10, 20, 0.12),
                                      grid_of(100, 4, 5, 0.08), grid_of(100, 4, 5, 0.3)};
    const double x[3] = {0.0131, -0.0722, 0.1047}, v[3] = {0.3, -0.5, 0.7}, radius = 0.004;
    se3d_system *system;
    se3d_material_def stuff = se3d_material_def_default();
    se3d_material material;
    se3d_particles *set;
    double sum[SE3D_FIELD_VALUES];
    CHECK(!se3d_system_create(NULL, &system));
    stuff.density = 2000.0;
    stuff.stiffness = 1e4;
    CHECK(!se3d_material_create(system, &stuff, &material));
    CHECK(!se3d_particles_create(system, NULL, &set));
    CHECK(!se3d_particles_add(set, material, 1, x, &radius, v, NULL, NULL));
    for (int n = 0; n < 4; ++n) {
        const se3d_field_grid *g = &grids[n];
        const size_t cells = add_up(set, g, sum);
        double *phi = calloc(cells, sizeof *phi), whole = 0.0;
        CHECK(phi);
        for (size_t k = 0; phi && k < cells; ++k) {
            const size_t nx = (size_t)g->cells[0], ny = (size_t)g->cells[1];
            const size_t at[3] = {k % nx, k / nx % ny, k / nx / ny};
            double square = 0.0;
            for (int a = 0; a < 3; ++a) {
                const double step = (g->upper[a] - g->lower[a]) / g->cells[a];
                const double d = g->lower[a] + ((double)at[a] + 0.5) * step - x[a];
                square += d * d;
            }
            const double part = sqrt(square) / g->width;
            phi[k] = part < 1.0 ? (1.0 + 3.0 * part) * pow(1.0 - part, 3.0) : 0.0;
            whole += phi[k];
        }
        const double mass = 2000.0 * 4.0 / 3.0 * PI * radius * radius * radius;
        const double volume = 0.2 * 0.2 * 0.42 / (double)cells;
        for (size_t k = 0; phi && k < cells; ++k) {
            const double *f = fields + k * SE3D_FIELD_VALUES;
            const double density = mass / volume * phi[k] / whole;
            CHECK_NEAR(f[SE3D_FIELD_DENSITY], density, 1e-12 * mass / volume);
            CHECK_NEAR(f[SE3D_FIELD_SOLID_FRACTION], density / 2000.0, 1e-12 * mass / volume);
            CHECK_NEAR(f[SE3D_FIELD_VELOCITY + 1], phi[k] > 0.0 ? v[1] : 0.0, 1e-12);
        }
        free(phi);
    }
    se3d_system_destroy(system);
}

static void fields_do_not_depend_on_threads(void)
{
    static double first[CELLS_MOST * SE3D_FIELD_VALUES];
    const se3d_field_grid grid = grid_of(5, 6, 7, 0.04);
    for (int32_t threads = 1; threads <= 3; threads += 2) {
        double sum[SE3D_FIELD_VALUES];
        se3d_particles *set;
        se3d_system *system = run_world(PARTICLES_HEAP, threads, &set);
        const size_t cells = add_up(set, &grid, sum);
        if (threads == 1) {
            memcpy(first, fields, cells * SE3D_FIELD_VALUES * sizeof *first);
        }
        CHECK(memcmp(first, fields, cells * SE3D_FIELD_VALUES * sizeof *first) == 0);
        se3d_system_destroy(system);
    }
}

/* On the triangle it is on, a sphere presses with its weight and drags by friction while it slips
 * ever slower: v - 7/2 mu g t. */
static void triangles_know_who_slides_on_them(void)
{
    static const double corners[12] = {-1.0, -1.0, 0.0, 1.0,  -1.0, 0.0,
                                       1.0,  1.0,  0.0, -1.0, 1.0,  0.0};
    static const uint32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    const double R = 0.01, mass = 2500.0 * 4.0 / 3.0 * PI * R * R * R, weight = 9.81 * mass;
    const double t = 0.03, mu = 0.4, area = 2.0, z = 0.2 + R - weight / 2e4;
    const double r[6] = {3.5, -0.5, z, 2.5, 0.5, z}, v[6] = {0.6, 0.8, 0.0, 0.0, 0.0, 0.0};
    const double radius[2] = {R, R};
    enum { NUMBERS = 2 * SE3D_WALL_VALUES };
    double values[NUMBERS];
    size_t count = 0;
    se3d_system *system = NULL;
    se3d_particles *set = NULL;
    se3d_material material;
    se3d_shape mesh;
    se3d_material_def stuff = se3d_material_def_default();
    se3d_shape_def def = se3d_shape_def_default();
    CHECK(!se3d_system_create(NULL, &system));
    CHECK(!se3d_particles_create(system, NULL, &set));
    stuff.density = 2500.0;
    stuff.stiffness = 2e4;
    stuff.friction = mu;
    CHECK(!se3d_material_create(system, &stuff, &material));
    def.vertices = corners;
    def.vertex_count = 4;
    def.triangles = triangles;
    def.triangle_count = 2;
    def.material = material;
    def.position[0] = 3.0;
    def.position[2] = 0.2;
    CHECK(!se3d_shape_create_mesh(system, &def, &mesh));
    CHECK(!se3d_particles_add(set, material, 2, r, radius, v, NULL, NULL));
    CHECK(!se3d_particles_get_wall_map(set, mesh, NUMBERS, values, &count) && count == NUMBERS);
    CHECK_NEAR(values[SE3D_WALL_PRESSURE], 0.0, 0.0); /* nobody has looked yet */
    CHECK(se3d_particles_run(set, t) >= 0);
    CHECK(!se3d_particles_get_wall_map(set, mesh, NUMBERS, values, &count) && count == NUMBERS);
    for (size_t k = 0; k < 2; ++k) {
        const double *f = values + k * SE3D_WALL_VALUES;
        const int slides = f[SE3D_WALL_PLACE] > 3.0;
        const double side = slides ? 1.0 / 3.0 : -1.0 / 3.0, drag = slides ? mu * weight : 0.0;
        CHECK_NEAR(f[SE3D_WALL_PLACE], 3.0 + side, 1e-12);
        CHECK_NEAR(f[SE3D_WALL_PLACE + 1], -side, 1e-12);
        CHECK_NEAR(f[SE3D_WALL_PLACE + 2], 0.2, 1e-12);
        CHECK_NEAR(f[SE3D_WALL_AREA], area, 1e-12);
        CHECK_NEAR(f[SE3D_WALL_PRESSURE] * area / weight, 1.0, 1e-3);
        CHECK_NEAR(f[SE3D_WALL_SHEAR] * area / weight, 0.6 * drag / weight, 1e-3);
        CHECK_NEAR(f[SE3D_WALL_SHEAR + 1] * area / weight, 0.8 * drag / weight, 1e-3);
        CHECK_NEAR(f[SE3D_WALL_SHEAR + 2] * area / weight, 0.0, 1e-6);
        CHECK_NEAR(f[SE3D_WALL_SLIDING] * area / weight, slides ? 1.0 - 3.5 * mu * 9.81 * t : 0.0,
                   5e-3);
    }
    se3d_particles_destroy(set);
    se3d_system_destroy(system);
}

/* A ball at rest in a tube whose axis is level: all its weight is on one patch, which has its
 * place, and the patches together are the tube. */
static void patches_of_a_funnel_know_who_rests_on_them(void)
{
    const double R = 0.01, tube = 0.1, mass = 2500.0 * 4.0 / 3.0 * PI * R * R * R;
    const double weight = 9.81 * mass, radius[1] = {R};
    const double r[3] = {0.037, 0.0, R - tube - weight / 2e4};
    enum { PATCHES = 24 * 13, NUMBERS = PATCHES * SE3D_WALL_VALUES };
    static double values[NUMBERS], corners[PATCHES * SE3D_WALL_CORNERS];
    size_t count = 0, pressed = PATCHES;
    se3d_system *system = NULL;
    se3d_particles *set = NULL;
    se3d_material material;
    se3d_shape wall;
    se3d_material_def stuff = se3d_material_def_default();
    se3d_shape_def def = se3d_shape_def_default();
    double area = 0.0;
    CHECK(!se3d_system_create(NULL, &system));
    CHECK(!se3d_particles_create(system, NULL, &set));
    stuff.density = 2500.0;
    stuff.stiffness = 2e4;
    CHECK(!se3d_material_create(system, &stuff, &material));
    def.bottom_radius = def.top_radius = tube;
    def.length = 0.34;
    def.material = material;
    def.orientation[0] = def.orientation[2] = sqrt(0.5); /* its z is x of the ground */
    CHECK(!se3d_shape_create_funnel(system, &def, &wall));
    CHECK(!se3d_particles_add(set, material, 1, r, radius, NULL, NULL, NULL));
    CHECK(se3d_particles_run(set, 0.02) >= 0);
    CHECK(!se3d_particles_get_wall_map(set, wall, NUMBERS, values, &count) && count == NUMBERS);
    CHECK(
        !se3d_particles_get_wall_corners(set, wall, PATCHES * SE3D_WALL_CORNERS, corners, &count) &&
        count == PATCHES * SE3D_WALL_CORNERS);
    for (size_t k = 0; k < PATCHES; ++k) {
        const double *f = values + k * SE3D_WALL_VALUES, *c = corners + k * SE3D_WALL_CORNERS;
        area += f[SE3D_WALL_AREA];
        pressed = f[SE3D_WALL_PRESSURE] > 0.0 ? (CHECK(pressed == PATCHES), k) : pressed;
        for (int a = 0; a < 4; ++a) { /* on the tube, and around the middle */
            double way[3] = {c[3 * a] - f[0], c[3 * a + 1] - f[1], c[3 * a + 2] - f[2]};
            CHECK_NEAR(c[3 * a + 1] * c[3 * a + 1] + c[3 * a + 2] * c[3 * a + 2], tube * tube,
                       1e-15);
            CHECK_NEAR(fabs(way[0]), 0.17 / 13.0, 1e-12);
            CHECK_NEAR(way[1] * way[1] + way[2] * way[2], pow(2.0 * tube * sin(PI / 48.0), 2.0),
                       1e-12);
        }
    }
    CHECK_NEAR(area, 2.0 * PI * tube * 0.34, 1e-12);
    CHECK(pressed < PATCHES);
    const double *f = values + pressed * SE3D_WALL_VALUES;
    CHECK_NEAR(f[SE3D_WALL_PRESSURE] * f[SE3D_WALL_AREA] / weight, 1.0, 1e-3);
    CHECK(fabs(f[0] - r[0]) < 0.17 / 13.0 && fabs(f[1]) <= 0.14 * tube && f[2] < 0.0);
    se3d_particles_destroy(set);
    se3d_system_destroy(system);
}

int main(void)
{
    RUN(sums_are_what_there_is);
    RUN(uniform_beds_are_uniform);
    RUN(triangles_know_who_slides_on_them);
    RUN(patches_of_a_funnel_know_who_rests_on_them);
    RUN(each_cell_gets_the_part_of_the_kernel);
    RUN(fields_do_not_depend_on_threads);
    return check_finish();
}
