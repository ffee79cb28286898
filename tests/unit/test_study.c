/* SPDX-License-Identifier: BSD-3-Clause */
/* Studies: the generator, the layouts, the measures of a run that is known, and what is refused. */
#include <stdlib.h>

#include "check.h"
#include "io/study/design.h"
#include "io/study/inplace.h"
#include "io/study/quantile.h"
#include "io/study/random.h"
#include "se3d/study.h"

/* The known answers that the authors of the generator publish with it (Random123, kat_vectors). */
static void the_generator_gives_the_known_answers(void)
{
    static const struct {
        uint32_t counter[4], key[2], out[4];
    } rows[] = {
        {{0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
        {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
         {0xffffffff, 0xffffffff},
         {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
        {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
         {0xa4093822, 0x299f31d0},
         {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        uint32_t out[4];
        se3di_philox(rows[k].counter, rows[k].key, out);
        CHECK(memcmp(out, rows[k].out, sizeof out) == 0);
    }
    CHECK(se3di_random_uniform(0) > 0.0 && se3di_random_uniform(UINT64_MAX) < 1.0);
}

static void a_random_order_has_every_place_once(void)
{
    static const uint64_t counts[] = {1, 2, 3, 4, 5, 16, 17, 100, 1000, 4097};
    static unsigned char seen[5000];
    for (size_t k = 0; k < sizeof counts / sizeof *counts; ++k) {
        const uint64_t count = counts[k];
        uint64_t fixed = 0;
        memset(seen, 0, sizeof seen);
        for (uint64_t i = 0; i < count; ++i) {
            const uint64_t place = se3di_random_place(7, 3, count, i);
            CHECK(place < count && !seen[place]);
            seen[place < count ? place : 0] = 1;
            fixed += place == i;
        }
        CHECK(count < 100 || fixed < 10);
    }
}

static void quantiles_invert_their_distributions(void)
{
    for (double z = -8.0; z <= 5.0; z += 0.37) {
        const double u = 0.5 * erfc(-z * sqrt(0.5));
        CHECK_NEAR(se3di_quantile_normal(u), z, 1e-13 + 1e-15 / exp(-0.5 * z * z));
    }
    CHECK_NEAR(se3di_quantile_normal(0.975), 1.9599639845400542355, 1e-15);
    CHECK_NEAR(0.5 * erfc(-se3di_quantile_normal(1e-300) * sqrt(0.5)) * 1e300, 1.0, 1e-11);
    CHECK(!(fabs(se3di_quantile_normal(0.5)) > 0.0));
    const double a[3] = {1.0, 2.0, 5.0};
    for (double x = 1.05; x < 5.0; x += 0.21) {
        const double u =
            x < a[1] ? (x - 1.0) * (x - 1.0) / 4.0 : 1.0 - (5.0 - x) * (5.0 - x) / 12.0;
        CHECK_NEAR(se3di_quantile_triangular(a, u), x, 1e-13);
    }
    const double corner[3] = {1.0, 1.0, 2.0};
    CHECK_NEAR(se3di_quantile_triangular(corner, 0.75), 1.5, 1e-15);
    CHECK_NEAR(se3di_quantile_exponential(1.0 - exp(-2.0)), 2.0, 1e-14);
}

/* A point in each of 2^j equal parts, for every j: what makes a dimension of Sobol's sequence. In
 * the first two dimensions every box of area 2^-j has one of 2^j points. */
static void points_of_sobol_fill_every_part(void)
{
    static unsigned char seen[1024];
    for (size_t k = 0; k < 21; ++k) {
        for (uint32_t j = 1; j <= 10; ++j) {
            memset(seen, 0, sizeof seen);
            for (uint32_t i = 0; i < 1u << j; ++i) {
                unsigned char *part = &seen[se3di_design_sobol(k, i) >> (32 - j)];
                CHECK(!*part);
                *part = 1;
            }
        }
    }
    for (uint32_t j = 0; j <= 10; ++j) {
        memset(seen, 0, sizeof seen);
        for (uint32_t i = 0; i < 1024; ++i) {
            const uint64_t x = se3di_design_sobol(0, i), y = se3di_design_sobol(1, i);
            unsigned char *box = &seen[(x >> (32 - j)) << (10 - j) | y >> (22 + j)];
            CHECK(!*box);
            *box = 1;
        }
    }
}

/* Integrals of x_i x_j by 4096 points: a wrong direction number in one dimension shows here. */
static void points_of_sobol_integrate_products(void)
{
    enum { COUNT = 4096 };
    for (size_t a = 0; a < 21; ++a) {
        for (size_t b = 0; b < a; ++b) {
            double sum = 0.0;
            for (uint32_t i = 0; i < COUNT; ++i) {
                sum += (se3di_design_sobol(a, i) + 0.5) * 0x1p-32 *
                       ((se3di_design_sobol(b, i) + 0.5) * 0x1p-32);
            }
            CHECK_NEAR(sum / COUNT, 0.25, 1e-3);
        }
    }
}

/* ---- a run that is known ---------------------------------------------------------------------*/

/* A block that falls from the height h with the speed v: z = h + v t - g t^2 / 2. */
#define BLOCK                                                                                      \
    "se3d: 1\nparameters: {h: 5, v: 3, g: 10, m: 2 kg, w: 3*h}\ngravity: [0, 0, -g]\n"             \
    "bodies: [{name: block, mass: m, inertia: [1, 1, 1], position: [w, 0, h], velocity: [0, 0, "   \
    "v]}]\n"                                                                                       \
    "events: [{name: low, channel: block.position.z, value: 0, direction: falling}]\n"             \
    "analysis: [{type: assembly}, {type: dynamics, duration: 2, tolerance: 1e-10}]\n"
#define MEASURES                                                                                   \
    "  measures:\n"                                                                                \
    "    top: {max: block.position.z}\n"                                                           \
    "    bottom: {min: block.position.z}\n"                                                        \
    "    range: {range: block.position.z}\n"                                                       \
    "    mean: {mean: block.position.z}\n"                                                         \
    "    rms: {rms: block.velocity.z}\n"                                                           \
    "    area: {integral: block.position.z}\n"                                                     \
    "    begin: {initial: block.velocity.z}\n"                                                     \
    "    end: {final: block.velocity.z}\n"                                                         \
    "    early: {at: block.velocity.z, time: 100 ms}\n"                                            \
    "    hit: {at: block.velocity.z, event: low}\n"                                                \
    "    when: {time_of: low}\n"                                                                   \
    "    slow: {settling: block.velocity.z, band: 4, target: -17}\n"                               \
    "    last: {settling: block.velocity.z, band: 4}\n"                                            \
    "    sum: top + 2*bottom + w\n"                                                                \
    "    high: {max: block.position.z - h + 1 m}\n"                                                \
    "    far: {at: \"hypot(block.position.x, block.position.z)\", event: low}\n"

static se3d_model *read_model(const char *text)
{
    se3d_model *model = NULL;
    se3d_model_error error;
    if (se3d_model_read_text(text, strlen(text), "a.yaml", NULL, &model, &error) < 0) {
        fprintf(stderr, "%s\n", error.message);
    }
    return model;
}

typedef struct opened {
    se3d_model *model;
    se3d_study *study;
} opened;

static opened open_study(const char *text)
{
    opened s = {read_model(text), NULL};
    CHECK(s.model && se3d_study_create(s.model, &s.study, NULL) == SE3D_OK);
    return s;
}

static void close_study(opened s)
{
    se3d_study_destroy(s.study);
    se3d_model_destroy(s.model);
}

static void measures_are_those_of_the_motion(void)
{
    const opened s = open_study(BLOCK "study:\n  parameters: {h: [5, 6], v: {from: 2, to: 4, "
                                      "count: 3}, m: [2 kg, 3 kg]}\n" MEASURES);
    CHECK(se3d_study_count_samples(s.study) == 12 && se3d_study_count_parameters(s.study) == 3);
    CHECK(se3d_study_count_measures(s.study) == 16);
    for (uint64_t i = 0; i < 12; ++i) {
        double p[3], y[16];
        se3d_model_error error;
        CHECK(se3d_study_get_sample(s.study, i, p) == SE3D_OK);
        CHECK_NEAR(p[0], i < 6 ? 5.0 : 6.0, 0.0); /* the last one is the fastest */
        CHECK_NEAR(p[1], 2.0 + (double)(i / 2 % 3), 0.0);
        CHECK_NEAR(p[2], i % 2 ? 3.0 : 2.0, 0.0);
        CHECK(se3d_study_eval(s.study, p, y, &error) == SE3D_OK);
        const double h = p[0], v = p[1], g = 10.0, T = 2.0;
        const double end = h + v * T - 0.5 * g * T * T;
        const double hit = (v + sqrt(v * v + 2.0 * g * h)) / g;
        const double area = h * T + v * T * T / 2.0 - g * T * T * T / 6.0;
        CHECK_NEAR(y[0], h + v * v / (2.0 * g), 1e-8 + 0.5 * g * 0.002 * 0.002);
        CHECK_NEAR(y[1], end, 1e-8);
        CHECK_NEAR(y[2], y[0] - y[1], 0.0);
        CHECK_NEAR(y[3], area / T, 1e-4);
        CHECK_NEAR(y[4], sqrt((pow(v, 3.0) - pow(v - g * T, 3.0)) / (3.0 * g * T)), 1e-8);
        CHECK_NEAR(y[5], area, 1e-4);
        CHECK_NEAR(y[6], v, 1e-12);
        CHECK_NEAR(y[7], v - g * T, 1e-8);
        CHECK_NEAR(y[8], v - g * 0.1, 1e-8);
        CHECK_NEAR(y[9], v - g * hit, 1e-7);
        CHECK_NEAR(y[10], hit, 1e-8);
        CHECK_NEAR(y[11], (v + 13.0) / g, 1e-8);
        CHECK_NEAR(y[12], T - 4.0 / g, 1e-8);
        CHECK_NEAR(y[13], y[0] + 2.0 * y[1] + 3.0 * h, 1e-12);
        CHECK_NEAR(y[14], y[0] - h + 1.0, 1e-12);
        CHECK_NEAR(y[15], 3.0 * h, 1e-7);
    }
    close_study(s);
}

/* What an event or a band does not reach has no value; the others have theirs. */
static void a_measure_without_a_value_is_told(void)
{
    const opened s = open_study(BLOCK "study:\n  parameters: {h: [500]}\n" MEASURES);
    const char *row = "";
    double p[1], y[16];
    se3d_model_error error;
    CHECK(se3d_study_get_sample(s.study, 0, p) == SE3D_OK);
    CHECK(se3d_study_eval(s.study, p, y, &error) == SE3D_ERR_NOT_FINITE);
    CHECK_CONTAINS(error.message, "`hit` the event did not happen");
    CHECK(isnan(y[9]) && isnan(y[10]) && isfinite(y[0]) && isfinite(y[13]));
    CHECK(se3d_study_run_sample(s.study, 0, &row) == SE3D_ERR_NOT_FINITE);
    CHECK_CONTAINS(row, ",,,");
    CHECK_CONTAINS(row, ",\"`hit` the event did not happen\"\n");
    p[0] = (double)NAN;
    CHECK(se3d_study_eval(s.study, p, y, &error) < 0 && isnan(y[0]));
    CHECK_CONTAINS(error.message, "h = nan, must be finite");
    close_study(s);
}

/* ---- layouts ---------------------------------------------------------------------------------*/

#define LAYOUT                                                                                     \
    "%sstudy: {parameters: {h: \"~ normal(5, 0.5)\", v: \"uniform(2, 4)\", w: {from: 1, to: 2}, "  \
    "m: \"triangular(1 kg, 2 kg, 3000 g)\"}, samples: 64, method: %s, seed: %s, "                  \
    "measures: {z: {max: block.position.z}}}\n"
static const char *const methods[] = {"monte_carlo", "latin_hypercube", "sobol"};

static opened open_layout(const char *method, const char *seed)
{
    char text[2000];
    snprintf(text, sizeof text, LAYOUT, BLOCK, method, seed);
    return open_study(text);
}

/* Sample i is the same alone, in any order, and with another seed another one. */
static void a_sample_depends_on_the_seed_and_its_number_only(void)
{
    for (size_t k = 0; k < 3; ++k) {
        const opened a = open_layout(methods[k], "3"), b = open_layout(methods[k], "3"),
                     c = open_layout(methods[k], "4");
        int same = 0;
        for (uint64_t i = 0; i < 64; ++i) {
            double p[4], q[4], r[4];
            const char *row = "";
            char kept[400];
            CHECK(!se3d_study_get_sample(a.study, i, p) && !se3d_study_get_sample(c.study, i, r));
            CHECK(se3d_study_run_sample(a.study, i, &row) == SE3D_OK);
            snprintf(kept, sizeof kept, "%s", row);
            CHECK(!se3d_study_get_sample(b.study, 63 - i, q));
            CHECK(!se3d_study_run_sample(b.study, 63 - i, &row));
            CHECK(!se3d_study_get_sample(b.study, i, q) &&
                  !se3d_study_run_sample(b.study, i, &row));
            CHECK(memcmp(p, q, sizeof p) == 0 && strcmp(kept, row) == 0);
            same += memcmp(p, r, sizeof p) == 0;
        }
        CHECK(same == 0);
        close_study(a), close_study(b), close_study(c);
    }
}

/* Every stratum of a Latin hypercube, and of 64 points of Sobol, has one sample; random ones miss
 * some. Means and deviations are those asked for. */
static void layouts_fill_their_strata(void)
{
    for (size_t k = 0; k < 3; ++k) {
        const opened s = open_layout(methods[k], "3");
        int seen[64] = {0};
        double sum = 0.0, squares = 0.0;
        int missed = 0;
        for (uint64_t i = 0; i < 64; ++i) {
            double p[4];
            CHECK(!se3d_study_get_sample(s.study, i, p));
            CHECK(p[1] > 2.0 && p[1] < 4.0 && p[2] > 1.0 && p[2] < 2.0);
            CHECK(p[3] > 1.0 && p[3] < 3.0); /* kilograms, however they are written */
            ++seen[(int)((p[1] - 2.0) * 32.0)];
            sum += p[0];
            squares += (p[0] - 5.0) * (p[0] - 5.0);
        }
        for (int i = 0; i < 64; ++i) {
            missed += seen[i] == 0;
        }
        CHECK(k == 0 ? missed > 5 : missed == 0);
        CHECK_NEAR(sum / 64.0, 5.0, k == 0 ? 0.2 : 0.02);
        CHECK_NEAR(sqrt(squares / 64.0), 0.5, k == 0 ? 0.15 : 0.03);
        close_study(s);
    }
}

/* ---- what is refused -------------------------------------------------------------------------*/

#define SEEK(what) "study: {measures: {a: 1, b: 2}, optimize: {" what "}}"

static const struct {
    const char *study;
    const char *message;
} bad[] = {
    {"study: 3", "study: is a single value"},
    {"study: {measures: {a: {max: block.position.z}}}", "study.parameters: is missing"},
    {"study: {parameters: {h: [1]}}", "study.measures: is missing"},
    {"study: {parameters: {h: [1]}, measures: {}}", "study.measures: is empty"},
    {"study: {parameters: {h: [1]}, measures: [1]}", "study.measures: is a list"},
    {"study: {parameters: {}, measures: {a: {max: block.position.z}}}",
     "study.parameters: is empty"},
    {"study: {parameters: {H: [1]}, "
     "measures: {a: 1}}",
     "no parameter `H`, did you mean `h`?"},
    {"study: {parameters: {h: [1]}, measures: {a: {at: block.position.z, event: touch}}}",
     "event: no event is named `touch`; list it under `events`"},
    {"study: {parameters: {h: []}, measures: {a: 1}}", "is empty, must have at least one value"},
    {"study: {parameters: {h: 3}, measures: {a: 1}}", "must be {from: 1, to: 2}"},
    {"study: {parameters: {h: normal(2}, measures: {a: 1}}", "must be normal(mean, deviation)"},
    {"study: {parameters: {h: \"normal(2)\"}, samples: 1, measures: {a: 1}}",
     "must be normal(mean, deviation)"},
    {"study: {parameters: {h: \"normal(2, 0)\"}, samples: 1, measures: {a: 1}}",
     "the deviation must be > 0"},
    {"study: {parameters: {h: \"normal(2, 1,,)\"}, samples: 1, measures: {a: 1}}",
     "must be normal(mean, deviation)"},
    {"study: {parameters: {h: \"gauss(2, 1)\"}, samples: 1, measures: {a: 1}}", "normal(mean, dev"},
    {"study: {parameters: {h: \"uniform(2, 1)\"}, samples: 1, measures: {a: 1}}",
     "lower must be less than upper"},
    {"study: {parameters: {h: \"triangular(1, 4, 3)\"}, samples: 1, measures: {a: 1}}",
     "must be lower <= mode <= upper"},
    {"study: {parameters: {h: \"weibull(1, 0)\"}, samples: 1, measures: {a: 1}}",
     "scale and shape must be > 0"},
    {"study: {parameters: {h: \"exponential(-1)\"}, samples: 1, measures: {a: 1}}",
     "the mean must be > 0"},
    {"study: {parameters: {m: \"normal(2 kg, 1 m)\"}, samples: 1, measures: {a: 1}}", "mass"},
    {"study: {parameters: {m: \"lognormal(2 kg, 1)\"}, samples: 1, measures: {a: 1}}",
     "must have no unit"},
    {"study: {parameters: {h: \"normal(2, 1)\"}, measures: {a: 1}}", "needs `samples`"},
    {"study: {parameters: {h: \"normal(2, 1)\"}, samples: 0, measures: {a: 1}}", "is 0, must be"},
    {"study: {parameters: {h: \"normal(2, 1)\"}, samples: -1, measures: {a: 1}}", "samples: is -1"},
    {"study: {parameters: {h: \"normal(2, 1)\"}, samples: 1.5, measures: {a: 1}}",
     "must be a whole number"},
    {"study: {parameters: {h: \"normal(2, 1)\"}, samples: 1e9, measures: {a: 1}}", "to 1e+08"},
    {"study: {parameters: {h: \"normal(2, 1)\"}, method: sobol, measures: {a: 1}}",
     "samples: is missing"},
    {"study: {parameters: {h: [1]}, method: grid, samples: 3, measures: {a: 1}}", "not for a grid"},
    {"study: {parameters: {h: {from: 1, to: 2}}, measures: {a: 1}}", "needs {from, to, count}"},
    {"study: {parameters: {h: {from: 1, to: 2, count: 0}}, measures: {a: 1}}", "at least 1"},
    {"study: {parameters: {h: {from: 1}}, measures: {a: 1}}", "to: is missing"},
    {"study: {parameters: {h: {from: 1, to: 2, count: 1e6}, v: {from: 1, to: 2, count: 1e6}}, "
     "measures: {a: 1}}",
     "at most 1e+08"},
    {"study: {parameters: {h: [1]}, seed: -1, measures: {a: 1}}", "seed: is -1"},
    {"study: {parameters: {h: [1]}, analysis: 3, measures: {a: 1}}", "must be from 1 to 2"},
    {"study: {parameters: {h: [1]}, every: 0, measures: {a: 1}}", "every: is 0"},
    {"study: {parameters: {h: [1]}, table: a.csv, measures: {a: 1}}", "not for a `table`"},
    {"study: {table: /no/such.csv, measures: {a: 1}}", "cannot be opened"},
    {"study: {parameters: {h: [1]}, measures: {a: {max: blok.position.z}}}", "blok"},
    {"study: {parameters: {h: [1]}, measures: {a: {max: block.position}}}", "not a single number"},
    {"study: {parameters: {h: [1]}, measures: {a: {max: 2*blok.position.z}}}", "blok"},
    {"study: {parameters: {h: [1]}, measures: {a: {max: 2*h + 1}}}", "names no channel"},
    {"study: {parameters: {h: [1]}, measures: {a: {}}}", "must have one of max"},
    {"study: {parameters: {h: [1]}, measures: {a: {max: block.position.z, min: block.position.z}}}",
     "is there already"},
    {"study: {parameters: {h: [1]}, measures: {a: {max: block.position.z, time: 1}}}",
     "belongs to `at`, not to `max`"},
    {"study: {parameters: {h: [1]}, measures: {a: {at: block.position.z}}}", "`time` or `event`"},
    {"study: {parameters: {h: [1]}, measures: {a: {at: block.position.z, event: lo}}}",
     "did you mean `low`"},
    {"study: {parameters: {h: [1]}, measures: {a: {settling: block.position.z}}}",
     "band: is missing"},
    {"study: {parameters: {h: [1]}, measures: {a: {frequency: 0}}}", "modes are counted from 1"},
    {"study: {parameters: {h: [1]}, measures: {a: {frequency: 1}}}", "must be of type modes"},
    {"study: {parameters: {h: [1]}, measures: {a: {damping: 1, time: 1}}}",
     "belongs to `at`, not to `damping`"},

    {"study: {measures: {a: 1}, optimize: 3}", "optimize: is a single value"},
    {SEEK("minimize: a"), "parameters: is missing: which are sought"},
    {SEEK("minimize: a, parameters: {}"), "is empty, must be a map of 1 to 200"},
    {SEEK("minimize: a, parameters: {H: {from: 1, to: 9}}"), "did you mean `h`?"},
    {SEEK("minimize: a, parameters: {h: {from: 1}}"), "to: is missing"},
    {SEEK("minimize: a, parameters: {h: {from: 9, to: 1}}"), "goes from 9 to 1"},
    {SEEK("minimize: a, parameters: {h: {from: 6, to: 9}}"), "start: is 5, must be from 6 to 9"},
    {SEEK("minimize: a, parameters: {h: {from: 1, to: 9, start: 10}}"), "start: is 10, must be"},
    {SEEK("minimize: a, parameters: {m: {from: 1 kg, to: 9 m}}"), "mass"},
    {SEEK("parameters: {h: {from: 1, to: 9}}"), "`minimize` or `maximize`"},
    {SEEK("minimize: a, maximize: b, parameters: {h: {from: 1, to: 9}}"), "one of them"},
    {SEEK("minimize: c, parameters: {h: {from: 1, to: 9}}"), "no measure is named `c`"},
    {SEEK("minimize: a, parameters: {h: {from: 1, to: 9}}, method: simplex"), "slsqp"},
    {SEEK("minimize: a, parameters: {h: {from: 1, to: 9}}, evaluations: 0"), "at least 1"},
    {SEEK("minimize: a, parameters: {h: {from: 1, to: 9}}, tolerance: 0"), "tolerance: is 0"},
    {SEEK("minimize: a, parameters: {h: {from: 1, to: 9}}, constraints: {c: {to: 1}}"),
     "no measure is named `c`"},
    {SEEK("minimize: a, parameters: {h: {from: 1, to: 9}}, constraints: {b: {}}"), "or `equal`"},
    {SEEK("minimize: a, parameters: {h: {from: 1, to: 9}}, constraints: {b: {to: 1, equal: 1}}"),
     "or `equal`"},
    {SEEK("minimize: a, parameters: {h: {from: 1, to: 9}}, constraints: {b: {from: 2, to: 1}}"),
     "goes from 2 to 1"},
    {SEEK("minimize: a, parameters: {h: {from: 1, to: 9}}, constraints: {b: {to: 1}}, "
          "method: crs"),
     "crs has no constraints"},
    {SEEK("minimize: a, parameters: {h: {from: 1, to: 9}}, constraints: {b: {equal: 1}}, "
          "method: mma"),
     "mma has no constraints with `equal`"},
    {"study: {sensitivities: h, measures: {a: 1}}", "must be a list of parameters"},
    {"study: {sensitivities: [], measures: {a: 1}}", "is empty, must be a list of parameters"},
    {"study: {sensitivities: [h, h], measures: {a: 1}}", "`h` is there twice"},
    {"study: {sensitivities: [H], measures: {a: 1}}", "no parameter `H`, did you mean `h`?"},
    {"study: {sensitivities: [h], samples: 3, measures: {a: 1}}", "there are none"},
    {"study: {parameters: {h: [1]}, measures: {a: {misfit: block.position.z}}}",
     "curve: is missing"},
    {"study: {parameters: {h: [1]}, measures: {a: {misfit: block.position.z, curve: 3}}}",
     "must be {linear: [[x, y], ...]}"},
    {"study: {parameters: {h: [1]}, measures: {a: {misfit: block.position.z, "
     "curve: {linear: [[1, 2], [1, 3]]}}}}",
     "must increase"},
    {"study: {parameters: {h: [1]}, measures: {a: {misfit: block.position.z, along: blok.x.y, "
     "curve: {linear: [[1, 2], [2, 3]]}}}}",
     "blok"},
    {"study: {parameters: {h: [1]}, measures: {a: {rms: block.position.z, "
     "curve: {linear: [[1, 2], [2, 3]]}}}}",
     "belongs to `misfit`, not to `rms`"},
    {"study: {parameters: {h: [1]}, measures: {h: 1}}", "needs a name of its own"},
    {"study: {parameters: {h: [1]}, measures: {sin: 1}}", "the name is not allowed"},
    {"study: {parameters: {h: [1]}, measures: {status: 1}}", "the name is not allowed"},
    {"study: {parameters: {h: [1]}, measures: {\"a,b\": 1}}", "the name is not allowed"},
    {"study: {parameters: {h: [1]}, measures: {a: b + 1, b: 1}}", "b"},
    {"study: {parameters: {h: [1]}, measures: {a: 1, a: 2}}", "a"},
    {"study: {parameters: {h: [1]}, mesures: {a: 1}}", "did you mean `measures`"},
};

/* z = h + v t - g t^2 / 2 is off v t by h - g t^2 / 2; vz = v - g t is a line over t. */
static void misfits_are_what_is_left_of_curves(void)
{
    const opened s = open_study(
        BLOCK "study:\n  parameters: {h: [5, 6]}\n  measures:\n"
              "    a: {misfit: block.position.z, curve: {linear: [[0, 0], [1, 3], [2, 6]]}}\n"
              "    b: {misfit: block.velocity.z, curve: {linear: [[0, 3], [1, -7]]}}\n"
              "    c: {misfit: block.position.z, along: block.velocity.z,\n"
              "      curve: {linear: [[-17, 0], [3, 20]]}}\n");
    double y[3];
    const double h = 5.0, g = 10.0, T = 2.0;
    const double mean = h * h - h * g * T * T / 3.0 + g * g * pow(T, 4.0) / 20.0;
    CHECK(se3d_study_eval(s.study, &h, y, NULL) == SE3D_OK);
    CHECK_NEAR(y[0], sqrt(mean), 1e-4);
    CHECK_NEAR(y[1], 0.0, 1e-8); /* straight beyond its last point */
    double sum = 0.0;            /* z - (v_z + 17): Simpson */
    for (int k = 0; k <= 2000; ++k) {
        const double t = T * k / 2000.0, off = h + 3.0 * t - 5.0 * t * t - (20.0 - g * t);
        sum += (k == 0 || k == 2000 ? 1.0 : k % 2 ? 4.0 : 2.0) * off * off / 6000.0;
    }
    CHECK_NEAR(y[2], sqrt(sum), 1e-4);
    close_study(s);
}

/* Derivatives of fourth order at any values of what is sought, in the units of the study. */
static void what_is_sought_is_measured_with_its_derivatives(void)
{
    const opened s = open_study(
        BLOCK "study:\n  measures: {z: {initial: block.position.z}, c: \"z^3 + w\"}\n"
              "  seed: 7\n"
              "  optimize: {maximize: c, method: slsqp, evaluations: 50, tolerance: 0.01,\n"
              "    parameters: {h: {from: 1, to: 9}, m: {from: 1, to: 3000 g, start: 1500 g}},\n"
              "    constraints: {z: {to: 7}, c: {equal: 4}}}\n");
    const double at[2] = {3.0, 2.0};
    double bounds[2], start, y[2], slopes[4];
    char text[100];
    size_t measure = 9;
    se3d_study_goal goal;
    CHECK(se3d_study_get_goal(s.study, &goal) == SE3D_OK);
    CHECK(strcmp(goal.method, "slsqp") == 0 && goal.maximizes && goal.measure == 1);
    CHECK(goal.evaluations == 50 && goal.seed == 7 && goal.tolerance > 0.009);
    CHECK(se3d_study_count_unknowns(s.study) == 2 && se3d_study_count_limits(s.study) == 2);
    CHECK(strcmp(se3d_study_get_unknown_name(s.study, 1), "m") == 0);
    CHECK(se3d_study_get_unknown(s.study, 0, bounds, &start) == SE3D_OK);
    CHECK_NEAR(start, 5.0, 0.0);
    CHECK(se3d_study_get_unknown(s.study, 1, bounds, &start) == SE3D_OK);
    CHECK_NEAR(bounds[1], 3.0, 1e-15);
    CHECK_NEAR(start, 1.5, 1e-15);
    CHECK(se3d_study_write_unknown(s.study, 1, 0.5, text, sizeof text) == SE3D_OK);
    CHECK(strcmp(text, "0.5 kg") == 0);
    CHECK(se3d_study_write_unknown(s.study, 0, 0.5, text, sizeof text) == SE3D_OK);
    CHECK(strcmp(text, "0.5") == 0);
    CHECK(se3d_study_get_limit(s.study, 0, &measure, bounds) == SE3D_OK && measure == 0);
    CHECK(isinf(bounds[0]) && bounds[1] > 6.9);
    CHECK(se3d_study_get_limit(s.study, 1, &measure, bounds) == SE3D_OK && measure == 1);
    CHECK(!(bounds[0] < bounds[1]));
    CHECK(se3d_study_eval_unknowns(s.study, at, y, slopes, NULL) == SE3D_OK);
    CHECK_NEAR(y[1], 27.0 + 9.0, 1e-12);
    CHECK_NEAR(slopes[0], 1.0, 1e-12);
    CHECK_NEAR(slopes[1], 27.0 + 3.0, 1e-9); /* exact: a cubic */
    CHECK(fabs(slopes[2]) < 1e-12 && fabs(slopes[3]) < 1e-9);
    CHECK(se3d_study_count_sensitivities(s.study) == 2);
    close_study(s);
}

static void mistakes_are_refused_with_what_is_allowed(void)
{
    for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
        char text[2000];
        se3d_model *model = NULL;
        se3d_model_error error;
        snprintf(text, sizeof text, "%s%s\n", BLOCK, bad[k].study);
        const se3d_status status =
            se3d_model_read_text(text, strlen(text), "a.yaml", NULL, &model, &error);
        if (status != SE3D_ERR_MODEL) {
            fprintf(stderr, "%s\n", bad[k].study);
        }
        CHECK(status == SE3D_ERR_MODEL && model == NULL);
        CHECK_CONTAINS(error.message, bad[k].message);
        se3d_model_destroy(model);
    }
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    CHECK(file && fputs(text, file) >= 0 && fclose(file) == 0);
}

static void tables_have_a_row_for_each_sample(void)
{
    static const struct {
        const char *text, *message;
    } rows[] = {{"h,v\n1,2\n3,-4e0\n\n# x\n5,6\r\n", NULL},
                {"", "empty"},
                {"h,v\n", "has no samples"},
                {"h,h\n1,2\n", "the column `h` is there twice"},
                {"h,x\n1,2\n", "no parameter `x`"},
                {"h,v\n1\n", ":2: has 1 numbers, must have 2"},
                {"h,v\n1,2,3\n", ":2: has more than 2 numbers"},
                {"h,v\n1,nan\n", ":2: v is `nan`, must be a finite number"},
                {"h,v\n1,1e999\n", ":2: v is `1e999`"},
                {"h,v\n1,\n", ":2: v is ``"}};
    char path[800], text[2000];
    snprintf(path, sizeof path, "%s/study_table.csv", check_scratch());
    snprintf(text, sizeof text,
             "%sstudy: {table: %s, measures: {z: {initial: block.position.z}}}\n", BLOCK, path);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        se3d_model *model = NULL;
        se3d_study *study = NULL;
        se3d_model_error error;
        write_file(path, rows[k].text);
        const se3d_status status =
            se3d_model_read_text(text, strlen(text), "a.yaml", NULL, &model, &error);
        CHECK(status == (rows[k].message ? SE3D_ERR_MODEL : SE3D_OK));
        if (rows[k].message) {
            CHECK_CONTAINS(error.message, rows[k].message);
        } else if (se3d_study_create(model, &study, &error) == SE3D_OK) {
            const char *row = "";
            CHECK(se3d_study_count_samples(study) == 3);
            CHECK(se3d_study_run_sample(study, 1, &row) == SE3D_OK);
            CHECK(strcmp(row, "1,3,-4,3,ok\n") == 0);
        }
        se3d_study_destroy(study);
        se3d_model_destroy(model);
    }
    remove(path);
}

/* ---- tables that were begun ------------------------------------------------------------------*/

static se3d_status open_table(se3d_study *study, const char *path, int resume, uint32_t shard,
                              se3d_study_table **table, se3d_model_error *error)
{
    se3d_study_table_def def = se3d_study_table_def_default();
    def.path = path;
    def.resume = resume;
    def.shard = shard;
    def.shards = 2;
    return se3d_study_table_open(study, &def, table, error);
}

static void put_text(const char *path, const char *one, size_t length, const char *other)
{
    FILE *file = fopen(path, "wb");
    CHECK(file && fwrite(one, 1, length, file) == length && fputs(other, file) >= 0);
    CHECK(file && fclose(file) == 0);
}

/* What stands in a table is gone on with only if it is this study's, sample for sample. */
static void tables_of_something_else_are_not_gone_on_with(void)
{
    static const struct {
        const char *from, *to, *message;
    } changes[] = {{"# se3d", "# se4d", "is no table of a study"},
                   {"study ", "study x", "is of another model, study or version"},
                   {"shard 1/2", "shard x/2", "is of another model, study or version"},
                   {"shard 1/2", "shard 1:2", "is of another model, study or version"},
                   {"shard 1/2", "shard 1/x", "is of another model, study or version"},
                   {"shard 1/2", "shard 2/2", "is another shard"},
                   {"shard 1/2", "shard 1/3", "is another shard"},
                   {", shard 1/2", "", "is another shard"},
                   {"sample,", "simple,", "is of another model, study or version"},
                   {"\n0,", "\nx,", "has a line that is no sample of the study"},
                   {"\n0,", "\n0;", "has a line that is no sample of the study"},
                   {"\n0,", "\n4000,", "has a line that is no sample of the study"},
                   {"\n0,", "\n0,0,", "has a line that is no sample of the study"},
                   {"\n0,", "\n1,", "sample"},
                   {"\n2,", "\n0,", "sample"},
                   {",ok\n", ",\"ok\n", "has a line that is no sample of the study"}};
    char path[800], text[4000], changed[4200];
    se3d_study_table *table = NULL;
    se3d_model_error error;
    opened s =
        open_study(BLOCK "study: {samples: 4, parameters: {v: \"uniform(1, 2)\"}, measures: {z: "
                         "{initial: block.position.z}}}\n");
    snprintf(path, sizeof path, "%s/study_begun.csv", check_scratch());
    remove(path);
    CHECK(open_table(s.study, path, 0, 3, &table, &error) == SE3D_ERR_INVALID_ARGUMENT && !table);
    CHECK(open_table(s.study, path, 0, 1, &table, &error) == SE3D_OK);
    for (uint64_t k = 0; table && k < 4; k += 2) {
        const char *row = "";
        CHECK(!se3d_study_table_has(table, k));
        CHECK(se3d_study_run_sample(s.study, k, &row) == SE3D_OK);
        CHECK(se3d_study_table_append(table, row, &error) == SE3D_OK);
        CHECK(se3d_study_table_has(table, k) && !se3d_study_table_has(table, k + 1));
        CHECK(se3d_study_table_append(table, row, &error) == SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(error.message, "the row is no new sample of this table");
        CHECK(se3d_study_table_append(table, "x\n", &error) == SE3D_ERR_INVALID_ARGUMENT);
    }
    se3d_study_table_close(table);
    CHECK(open_table(s.study, path, 0, 1, &table, &error) == SE3D_ERR_STATE && !table);
    CHECK_CONTAINS(error.message, "is there already: --resume goes on with it");
    FILE *file = fopen(path, "rb");
    const size_t length = file ? fread(text, 1, sizeof text - 1, file) : 0;
    text[length] = '\0';
    CHECK(file && fclose(file) == 0 && length > 50);
    for (size_t k = 0; k < sizeof changes / sizeof *changes; ++k) {
        const char *at = strstr(text, changes[k].from);
        CHECK(at != NULL);
        if (at) {
            snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - text), text, changes[k].to,
                     at + strlen(changes[k].from));
            put_text(path, changed, strlen(changed), "");
            CHECK(open_table(s.study, path, 1, 1, &table, &error) == SE3D_ERR_STATE && !table);
            CHECK_CONTAINS(error.message, changes[k].message);
        }
    }
    /* torn anywhere: what is whole of it counts */
    for (size_t cut = 0; cut <= length; ++cut) {
        put_text(path, text, cut, "");
        const se3d_status status = open_table(s.study, path, 1, 1, &table, &error);
        CHECK(status == SE3D_OK || (status == SE3D_ERR_STATE && error.message[0]));
        if (table) {
            const int first = cut >= (size_t)(strstr(text, "\n2,") + 1 - text);
            CHECK(se3d_study_table_has(table, 0) == first);
            CHECK(se3d_study_table_has(table, 2) == (cut == length));
        }
        se3d_study_table_close(table);
        table = NULL;
    }
    put_text(path, text, length, "# \n");
    CHECK(open_table(s.study, path, 1, 1, &table, &error) == SE3D_ERR_STATE && !table);
    CHECK(remove(path) == 0);
    close_study(s);
}

/* ---- requests --------------------------------------------------------------------------------*/

static void requests_are_answered(void)
{
    static const struct {
        const char *request, *reply;
    } rows[] = {
        {"{\"id\": 7, \"parameters\": {\"h\": 4, \"w\": 1e0}}",
         "{\"id\": 7, \"measures\": {\"z\": 4"},
        {"{\"id\": \"a\\\"\\n\", \"parameters\": {}}",
         "{\"id\": \"a\\\"\\u000a\", \"measures\": {"},
        {"{\"id\": 07, \"sample\": 0}", "{\"id\": \"07\", \"measures\": {\"z\": 1"},
        {"{\"sample\": 1}", "{\"id\": null, \"measures\": {\"z\": 2"},
        {"{\"id\": 1, \"sample\": 2}", "whole number from 0 to 1"},
        {"{\"id\": 1, \"sample\": -1}", "whole number from 0 to 1"},
        {"{\"id\": 1, \"sample\": 0.5}", "whole number from 0 to 1"},
        {"{\"id\": 1, \"sample\": \"0\"}", "sample must be a finite number"},
        {"{\"id\": 1}", "{\"id\": 1, \"measures\": {\"z\": 5}"},
        {"{\"id\": 1, \"parameters\": {}}", "{\"id\": 1, \"measures\": {\"z\": 5}"},
        {"{}", "{\"id\": null, \"measures\": {\"z\": 5}"},
        {"{\"id\": 1, \"sample\": 0, \"parameters\": {}}", "`parameters` or `sample`, not both"},
        {"{\"id\": 1, \"params\": {\"h\": 4}}", "`params` is unknown"},
        {"{\"id\": 1, \"sample\": 0, \"x\": 0}", "`x` is unknown"},
        {"{\"id\": 1, \"parameters\": 3}", "parameters must be an object"},
        {"{\"id\": 1, \"parameters\": {\"q\": 3}}", "no number `q`"},
        {"{\"id\": 1, \"parameters\": {\"h\": \"3\"}}", "h must be a finite number"},
        {"{\"id\": 1, \"parameters\": {\"h\": 1e999}}", "h must be a finite number"},
        {"{\"id\": 1, \"parameters\": {\"h\": [3]}}", "h must be a finite number"},
        {"{\"id\": 1, \"parameters\": {\"m\": -3}}", "must be finite and > 0"},
        {"{\"id\": 1, \"parameters\": {\"h\": 1, \"h\": 2}}", "\"error\": "},
        {"[1, 2]", "a request is an object"},
        {"{", "\"error\": \"request:"},
        {"", "\"error\": "},
        {"\xff", "\"error\": "},
    };
    const opened s = open_study(
        BLOCK "study: {parameters: {h: [1, 2]}, measures: {z: {initial: block.position.z}}}\n");
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        const char *reply = NULL;
        CHECK(se3d_study_answer(s.study, rows[k].request, strlen(rows[k].request), &reply) ==
              SE3D_OK);
        CHECK_CONTAINS(reply, rows[k].reply);
        CHECK(reply && !strpbrk(reply, "\r\n"));
    }
    close_study(s);
}

/* Samples whose parameters are set in the system, and those whose model is read anew: the same
 * bits, the same reasons. */
static void compare_samples(se3d_model *model, uint64_t count, int kept)
{
    double measures[2][12];
    se3d_study *set = NULL, *read = NULL;
    se3d_model_error errors[2];
    CHECK(model && se3d_study_create(model, &set, NULL) == SE3D_OK);
    CHECK(model && se3d_study_create(model, &read, NULL) == SE3D_OK);
    if (!set || !read) {
        return;
    }
    const size_t size = se3d_study_count_measures(set) * sizeof **measures;
    double parameters[8];
    CHECK(size <= sizeof *measures && se3d_study_count_parameters(set) <= 8);
    read->rebuilds = true;
    for (uint64_t k = 0; k < count; ++k) {
        CHECK(se3d_study_get_sample(set, k, parameters) == SE3D_OK);
        const se3d_status one = se3d_study_eval(set, parameters, measures[0], &errors[0]);
        const se3d_status other = se3d_study_eval(read, parameters, measures[1], &errors[1]);
        CHECK(one == other && memcmp(measures[0], measures[1], size) == 0);
        CHECK(strcmp(errors[0].message, errors[1].message) == 0);
        CHECK(one < 0 || se3di_inplace_is_kept(set) == kept);
        CHECK(!se3di_inplace_is_kept(read));
    }
    se3d_study_destroy(set);
    se3d_study_destroy(read);
}

static void samples_are_set_in_place_with_the_bits_of_a_reading(void)
{
    static const struct {
        const char *file;
        uint64_t count;
        int kept;
    } files[] = {{"study/damper", 7, 1}, {"fsae/two_wheels", 2, 1}};
    static const char head[] =
        "se3d: 1\nunits: {length: mm, angle: deg}\nparameters: {a: 2, m: 3*a + b, b: 1, J: 2e4, "
        "up: 30, x: 0, block: 1}\ngravity: [0, 0, -9810]\n"
        "bodies:\n- {name: plate, mass: m, inertia: [[J, 10, 0], [10, 2*J + a, 0], [0, 0, 3e4]], "
        "position: [50, 0, %s]}\n"
        "joints: [{name: pin, type: revolute, body_i: ground, body_j: plate, at: [0, 0, 0], "
        "axis: [0, 1, 0]}]\n"
        "forces:\n- {name: coil, type: rsda, joint: pin, k: 200 + 9*a, c: 2*b, theta0: up, "
        "preload: 50*b}\n- {name: rope, type: tsda, body_i: ground, body_j: plate, at: [0, 0, "
        "200], "
        "at_2: [50, 0, 0], k: b*20 N/m, c: a, l0: 150*a}\n"
        "analysis: {type: dynamics, duration: 0.2, step: 0.01%s}\n"
        "study: {parameters: {%s}, measures: {q: {final: pin.angle}, e: {max: energy.total}, w: "
        "{final: energy.balance}, "
        "f: {min: rope.force}, t: q*a + m + %s}}\n";
    static const struct {
        const char *height, *more, *parameters, *last;
        uint64_t count;
        int kept;
    } rows[] = {{"0", "", "a: [2, 3], b: [1, 0.5]", "b", 4, 1},
                {"0", "", "a: [-5, 2, -1, 3]", "J", 4, 1}, /* no mass is below 0 */
                {"0", "", "J: [20000, -1, 3e4], up: [10, -500]", "up", 6, 1},
                {"0", ", tolerance: 1e-9", "J: [2e4, 3e4]", "1", 2, 1},
                {"10*x", "", "b: [1, 2]", "x", 2, 1},
                {"10*a", "", "a: [2, 3]", "1", 2, 1},  /* where it stands */
                {"x + m", "", "b: [1, 2]", "1", 2, 1}, /* through another parameter */
                {"0", "", "a: [2, 3]", "b, u: {max: a*pin.angle}", 2, 0}, /* what is measured */
                {"0", ", method: radau, tolerance: 1e-6*a", "a: [1, 2]", "1", 2, 0}};
    char text[3000];
    for (size_t k = 0; k < sizeof files / sizeof *files; ++k) {
        const char *source = getenv("SE3D_SOURCE_DIR");
        se3d_model *model = NULL;
        snprintf(text, sizeof text, "%s/examples/%s.yaml", source ? source : ".", files[k].file);
        CHECK(se3d_model_read_file(text, NULL, &model, NULL) == SE3D_OK);
        compare_samples(model, files[k].count, files[k].kept);
        se3d_model_destroy(model);
    }
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        snprintf(text, sizeof text, head, rows[k].height, rows[k].more, rows[k].parameters,
                 rows[k].last);
        se3d_model *model = read_model(text);
        compare_samples(model, rows[k].count, rows[k].kept);
        se3d_model_destroy(model);
    }
}

/* Two corners of a car, one of them mirrored: whatever is moved, what is made of it follows. */
static void hardpoints_are_set_in_place_with_the_bits_of_a_reading(void)
{
    static const char head[] =
        "se3d: 1\nunits: {length: mm, angle: deg}\nparameters: {y: 0, z: 0, k: 38, on: 1, drag: "
        "3}\n"
        "include:\n- {file: %s/examples/fsae/corner.yaml, prefix: l_, parameters: "
        "{%s}}\n"
        "- {file: %s/examples/fsae/corner.yaml, prefix: r_, mirror: y, parameters: {k: k}}\n"
        "bodies:\n- {name: chassis, mass: 200, inertia: [1e7, 5e7, 5e7], fixed: true, markers: "
        "[{name: eye, position: [9, y, 3]}]}\n- {name: rack, mass: 1, inertia: [1e3, 1e3, 1e3], "
        "fixed: true}\nforces:\n- {name: bar, type: rsda, body_i: r_bar, body_j: l_bar, axis: [0, "
        "1, "
        "0], ref: [1, 0, 0], k: 100}\n- {name: pull, type: force, body: l_wheel, at: [0, 600, "
        "228], "
        "value: [0, 0, drag*t]}\n- {name: mount, type: bushing, body_i: ground, body_j: r_upright, "
        "at: [0, -600, z], K: [90, 90, 110, 0, 0, 0], C: [1, 1, 1, 0, 0, 0]}\n"
        "drivers:\n- {name: l_brake, joint: l_bearing, value: 0}\n- {name: r_brake, joint: "
        "r_bearing, value: 0}\n- {name: side, joint: l_rocker_pin, value: 0.1*t}\n%s"
        "analysis: {type: dynamics, duration: 0.01, step: 5e-4, method: dop853}\n"
        "study: {parameters: {%s}, measures: {a: {final: l_hub.toe}, b: {final: l_hub.camber}, c: "
        "{final: r_hub.travel}, d: {final: l_hub.motion_ratio}, e: {final: l_hub.track_change}, f: "
        "{max: l_link_joint.force.z}, g: {final: energy.balance}, h: {final: "
        "r_hub.ackermann_error}, "
        "i: {final: %s}}}\n";
    static const struct {
        const char *given, *more, *parameters, *last;
        int kept;
    } rows[] = {
        {"link_inner: \"[68, 213 + y, 152 + z]\"", "", "y: [0, 4, -3], z: [1]", "l_spring.force",
         1},
        {"hub: \"[y, 600, 228 + z]\", k: k", "", "y: [0, 6], z: [2], k: [38, 30]", "l_hub.caster",
         1},
        {"lower_ball: \"[y, 572, 130]\"", "", "y: [4, 1]", "mount.force.z", 1},
        {"steered: on", "", "on: [1, 0]", "l_hub.toe", 0},
        {"toe: y, k: k", "", "y: [0, 1]", "l_upright.position.x", 1},
        {"", "", "z: [0, 5]", "mount.torque.x", 0}, /* about the point of the channel */
        {"", "", "y: [0, 5]", "chassis.eye.position.y", 1},
        {"", "events: [{name: up, channel: pull.force.z, value: 1, action: record}]\n",
         "drag: [2, 5]", "pull.force.z", 0},
    };
    const char *folder = getenv("SE3D_SOURCE_DIR");
    const char *source = folder ? folder : ".";
    char text[6000];
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        snprintf(text, sizeof text, head, source, rows[k].given, source, rows[k].more,
                 rows[k].parameters, rows[k].last);
        se3d_model *model = read_model(text);
        CHECK(model != NULL);
        compare_samples(model, 2, rows[k].kept);
        se3d_model_destroy(model);
    }
}

/* A pendulum and what a row adds to it: whatever is made of a, the bits are those of a reading, and
 * what cannot be set in place is read. */
static void what_depends_on_a_parameter_is_found(void)
{
    static const char head[] =
        "se3d: 1\nparameters: {a: 1, b: 2, on: 0}\npoints: {p: [a, 0, 1], o: [0, 0, 0]}\n"
        "bodies:\n- {name: bar, mass: 2, inertia: [1, 1, 1], position: [0.3, 0, 0]}\n%s"
        "joints:\n- {name: pin, type: revolute, body_i: ground, body_j: bar, at: o, axis: [0, 1, "
        "0]}\n%s"
        "analysis: {type: dynamics, duration: 0.02, method: dop853}\n"
        "study: {parameters: {a: [1, 1.5]}, measures: {m: {final: %s}, k: {max: energy.total}}}\n";
#define CONTACT "contact: {}\nmaterials: [{name: steel, density: 7800, stiffness: 1e6}]\n"
#define BALL    "shapes: [{type: sphere, radius: 0.1*a, material: steel}]"
#define FREE    "- {name: b, mass: 1, inertia: [1, 1, 1], position: [3, 0, 0]"
#define LEG(x)                                                                                     \
    "parts: {leg: {parameters: {k: 3, l: k + 1}, points: {e: [0, k, 0]}, bodies: [{name: b, "      \
    "mass: l, inertia: [1, 1, 1], position: e}], forces: [{name: s, type: tsda, body_i: ground, "  \
    "body_j: b, at: [0, 0, 1], at_2: e, k: 10*k, l0: 1}]}}\ninstances: [{part: leg, prefix: "      \
    "p_, " x "}]\n"
    static const struct {
        const char *bodies, *more, *measure;
        int kept;
    } rows[] = {
        {FREE ", velocity: [a, 0, 0]}\n", "", "b.position.x", 1},
        {FREE ", orientation: {axis: [0, 0, 1], angle: 0.1*a}}\n", "", "b.orientation.e3", 1},
        {FREE ", angular_velocity: [0, a, 0]}\n", "", "b.orientation.e2", 1},
        {FREE ", when: a > 0}\n", "", "b.position.z", 0},
        {FREE ", when: on, velocity: [a, 0, 0]}\n", "", "pin.angle", 1},
        {"- {name: ground, markers: [{name: g, position: [a, 0, 0]}]}\n", "", "ground.g.position.x",
         0},
        {"- {name: rod, from: o, to: p, radius: 0.01, density: 1000}\n", "", "rod.position.x", 0},
        {"- {name: sheet, plate: [o, p, [0, 2, 0]], thickness: 0.01, density: 1000}\n", "",
         "sheet.position.x", 0},
        /* shapes are nothing but masses without contact */
        {FREE ", " BALL "}\n", "materials: [{name: steel, density: 7800}]\n", "b.position.z", 1},
        {"- {name: b, position: [3, 0, 0], " BALL "}\n",
         "materials: [{name: steel, density: 7800}]\n", "b.position.z", 1},
        {FREE ", " BALL "}\n", CONTACT, "b.position.z", 0},
        {"- {name: b, mass: a, inertia: [1, 1, 1]}\n", CONTACT, "b.position.z", 1},
        {"- {name: b, mass: 1, inertia: [1, 1, 1], position: [3*a, 0, 0]}\n", CONTACT,
         "b.position.x", 0},
        {"", "materials: [{name: steel, density: 1000*a}]\n", "pin.angle", 0},
        {"", "gravity: [0, 0, -9.81*a]\n", "pin.angle", 0},
        {"", "states: [{name: s, type: lag, input: a*pin.angle, time_constant: 1}]\n", "s.value",
         0},
        /* an element that is left out, of a type that may be another, and a rate */
        {"", "forces: [{name: f, type: rsda, joint: pin, k: a, when: on}]\n", "pin.angle", 1},
        {"", "forces: [{name: f, type: rsda, joint: pin, k: a, when: a > 1}]\n", "pin.angle", 0},
        {"", "forces: [{name: f, type: rsda, joint: pin, k: 1, theta0: a}]\n", "f.torque", 1},
        {FREE "}\n", "drivers: [{name: d, joint: pin, rate: a}]\n", "pin.angle", 0},
        {FREE "}\n", "drivers: [{name: d, joint: pin, value: a*t}]\n", "d.effort", 1},
        /* those that name an element or a body that is read again are read again, too */
        {FREE "}\n- {name: c, mass: 1, inertia: [1, 1, 1], position: [3, 0, a]}\n",
         "forces: [{name: f, type: tsda, body_i: b, body_j: c, point_i: [0, 0, 0], point_j: [0, 0, "
         "0], k: 9, l0: 1}]\n",
         "f.force", 1},
        {"- {name: c, mass: 1, inertia: [1, 1, 1], position: [3, 0, a]}\n",
         "states: [{name: s, type: lag, input: c.position.z, time_constant: 1}]\n", "s.value", 0},
        {"", "forces: [{name: f, type: torque, body: bar, value: [0, a, 0]}]\n", "f.torque.y", 0},
        {"", "forces: [{name: f, type: torque, body: bar, value: [0, a, 0]}]\n", "pin.angle", 1},
        /* parts */
        {"", LEG("parameters: {k: a}"), "p_b.position.y", 1},
        {"", LEG("parameters: {k: 2}"), "p_b.position.y", 1},
        {"", LEG("parameters: {e: p}"), "p_b.position.x", 1},
        {"", LEG("position: [a, 0, 0]"), "p_b.position.x", 0},
        {"", LEG("when: a > 0"), "p_b.position.x", 0},
        {"", LEG("parameters: {k: a}, repeat: 1"), "p_b.position.y", 0},
        {"", LEG("parameters: {l: b}, repeat: 1"), "p_b.position.y", 1},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        char text[3000];
        snprintf(text, sizeof text, head, rows[k].bodies, rows[k].more, rows[k].measure);
        const int before = check_failures;
        se3d_model *model = read_model(text);
        compare_samples(model, 2, rows[k].kept);
        if (check_failures > before) {
            fprintf(stderr, "row %zu\n%s", k, text);
        }
        se3d_model_destroy(model);
    }
#undef CONTACT
#undef BALL
#undef FREE
#undef LEG
}

/* Channels, times, bands and curves of measures may be made of what varies: x = t. A spring that
 * does nothing lets the parameter be set in place otherwise. */
static void numbers_of_measures_are_those_of_their_sample(void)
{
    static const char text[] =
        "se3d: 1\nparameters: {T: 0.2}\ngravity: [0, 0, 0]\n"
        "bodies: [{name: b, mass: 1, inertia: [1, 1, 1]}]\n"
        "joints: [{name: s, type: prismatic, body_i: ground, body_j: b, at: [0, 0, 0], axis: [1, "
        "0, "
        "0]}]\n"
        "drivers: [{name: d, joint: s, value: t}]\n"
        "forces: [{name: f, type: tsda, body_i: ground, body_j: b, at: [0, -1, 0], at_2: [0, 0, "
        "0], "
        "k: 5*T, l0: 1}]\n"
        "analysis: {type: kinematics, duration: 1, step: 0.05}\n"
        "study: {parameters: {T: [0.1, 0.3]}, measures: {a: {at: b.position.x, time: T}, "
        "s: {settling: b.position.x, band: 2*T, target: 1}, m: {max: T*b.position.x}, "
        "w: {misfit: b.position.x, curve: {linear: [[0, T], [1, 1 + T]]}}}}\n";
    se3d_model *model = read_model(text);
    se3d_study *s = NULL;
    CHECK(model && se3d_study_create(model, &s, NULL) == SE3D_OK);
    for (uint64_t k = 0; s && k < 2; ++k) {
        double T, m[4];
        CHECK(se3d_study_get_sample(s, k, &T) == SE3D_OK);
        CHECK(se3d_study_eval(s, &T, m, NULL) == SE3D_OK);
        CHECK_NEAR(m[0], T, 1e-12);
        CHECK_NEAR(m[1], 1.0 - 2.0 * T, 1e-12);
        CHECK_NEAR(m[2], T, 1e-12);
        CHECK_NEAR(m[3], T, 1e-12);
    }
    se3d_study_destroy(s);
    se3d_model_destroy(model);
}

int main(void)
{
    RUN(the_generator_gives_the_known_answers);
    RUN(a_random_order_has_every_place_once);
    RUN(quantiles_invert_their_distributions);
    RUN(points_of_sobol_fill_every_part);
    RUN(points_of_sobol_integrate_products);
    RUN(measures_are_those_of_the_motion);
    RUN(a_measure_without_a_value_is_told);
    RUN(a_sample_depends_on_the_seed_and_its_number_only);
    RUN(layouts_fill_their_strata);
    RUN(misfits_are_what_is_left_of_curves);
    RUN(what_is_sought_is_measured_with_its_derivatives);
    RUN(mistakes_are_refused_with_what_is_allowed);
    RUN(tables_have_a_row_for_each_sample);
    RUN(tables_of_something_else_are_not_gone_on_with);
    RUN(requests_are_answered);
    RUN(samples_are_set_in_place_with_the_bits_of_a_reading);
    RUN(hardpoints_are_set_in_place_with_the_bits_of_a_reading);
    RUN(what_depends_on_a_parameter_is_found);
    RUN(numbers_of_measures_are_those_of_their_sample);
    return check_finish();
}
