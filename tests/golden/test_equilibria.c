/* SPDX-License-Identifier: BSD-3-Clause */
/* Equilibria that are far away, with freedoms that nothing holds, and with two sides. */
#include "support/text_model.h"

#include <stdlib.h>

#define CHAIN_SPAN   1.2
#define CHAIN_LENGTH 2.0
#define CHAIN_WEIGHT (5.0 * 9.81)
#define CHAIN_TEXT   65536

typedef struct writer {
    char *text;
    size_t length;
} writer;

/* Append; text that does not fit is noticed by the reader. */
#define PUT(w, ...)                                                                                \
    ((w)->length +=                                                                                \
     (size_t)snprintf((w)->text + (w)->length, CHAIN_TEXT - (w)->length, __VA_ARGS__))

/* The pull of a chain of equal links: the moments of a link about its upper end say that its slope
 * is (V - (k + 1/2) w)/H with the weight w of a link and V half the weight of the chain. */
static double chain_pull(int links)
{
    const double w = CHAIN_WEIGHT / links, l = CHAIN_LENGTH / links;
    double low = 1e-6, high = 1e4;
    for (int round = 0; round < 200; ++round) {
        const double H = 0.5 * (low + high);
        double span = 0.0;
        for (int k = 0; k < links; ++k) {
            span += l * H / hypot(H, 0.5 * CHAIN_WEIGHT - (k + 0.5) * w);
        }
        low = span < CHAIN_SPAN ? H : low;
        high = span < CHAIN_SPAN ? high : H;
    }
    return low;
}

/* Two straight halves: a V. */
static void write_chain(writer *w, int links, const char *joint)
{
    const double l = CHAIN_LENGTH / links, c = CHAIN_SPAN / CHAIN_LENGTH, s = sqrt(1.0 - c * c);
    PUT(w, "se3d: 1\nbodies:\n");
    for (int k = 0; k < links; ++k) {
        const double along = (k + 0.5) * l, side = 2 * k < links ? 1.0 : -1.0;
        const double m = 5.0 / links, depth = side > 0.0 ? along : CHAIN_LENGTH - along;
        PUT(w, "  - {name: l%d, mass: %.17g, inertia: [1.0e-6, %.17g, %.17g], ", k, m,
            m * l * l / 12.0, m * l * l / 12.0);
        PUT(w, "position: [%.17g, 0, %.17g], orientation: {axis: [0, %g, 0], angle: %.17g}}\n",
            along * c, -depth * s, side, acos(c));
    }
    PUT(w, "joints:\n");
    for (int k = 0; k <= links; ++k) {
        const double along = k * l, depth = 2 * k < links ? along : CHAIN_LENGTH - along;
        const int inside = k > 0 && k < links;
        PUT(w, "  - {name: j%d, type: %s, at: [%.17g, 0, %.17g], ", k, inside ? joint : "spherical",
            along * c, -depth * s);
        char body_i[16] = "ground", body_j[16] = "ground";
        if (k > 0) {
            (void)snprintf(body_i, sizeof body_i, "l%d", k - 1);
        }
        if (k < links) {
            (void)snprintf(body_j, sizeof body_j, "l%d", k);
        }
        PUT(w, "body_i: %s, body_j: %s%s}\n", body_i, body_j,
            inside && *joint != 's' ? ", axis: [0, 1, 0]" : "");
    }
    PUT(w, "analysis: {type: equilibrium}\n"
           "output: [{file: r.csv, channels: [j0.force]}]\n");
}

/* With spherical joints every link turns about itself as it likes. */
static void a_chain_hangs_as_the_moments_of_its_links_say(void)
{
    static const char *const joints[] = {"revolute", "spherical"};
    writer w = {.text = malloc(CHAIN_TEXT)};
    CHECK(w.text != NULL);
    for (int run = 0; run < 8 && w.text; ++run) {
        const int links = (const int[]){4, 6, 10, 50}[run / 2];
        w.length = 0;
        write_chain(&w, links, joints[run % 2]);
        text_model m = text_model_open(w.text, SE3D_METHOD_AUTO, 0, 0.0);
        CHECK(text_model_run(&m, 0.0));
        CHECK_NEAR(text_model_get(&m, 0, 0), -chain_pull(links), 1e-10);
        CHECK_NEAR(text_model_get(&m, 0, 1), 0.0, 1e-10);
        CHECK_NEAR(text_model_get(&m, 0, 2), 0.5 * CHAIN_WEIGHT, 1e-10);
        text_model_close(&m);
    }
    free(w.text);
}

#define TRUSS(load)                                                                                \
    "se3d: 1\ngravity: [0, 0, 0]\nparameters: {L: \"hypot(1, 0.2)\"}\n"                            \
    "bodies: [{name: n, mass: 1, inertia: [1, 1, 1], position: [0, 0, 0.2]}]\n"                    \
    "joints: [{name: s, type: prismatic, body_i: ground, body_j: n, at: [0, 0, 0], axis: [0, 0, "  \
    "1]}]\nforces:\n"                                                                              \
    "  - {type: tsda, body_i: ground, body_j: n, point_i: [-1, 0, 0], k: 1000, l0: L}\n"           \
    "  - {type: tsda, body_i: ground, body_j: n, point_i: [1, 0, 0], k: 1000, l0: L}\n"            \
    "  - {type: force, body: n, value: [0, 0, " load "]}\n"                                        \
    "analysis: {type: equilibrium}\noutput: [{file: r.csv, channels: [n.position]}]\n"

/* A shallow truss of two springs carries up to 3.019 N on its upper side. */
static void a_shallow_truss_snaps_through_beyond_its_limit(void)
{
    static const char *const texts[] = {TRUSS("-1"), TRUSS("-3"), TRUSS("-3.04"), TRUSS("-5")};
    static const double loads[] = {1.0, 3.0, 3.04, 5.0};
    for (int run = 0; run < 4; ++run) {
        text_model m = text_model_open(texts[run], SE3D_METHOD_AUTO, 0, 0.0);
        CHECK(text_model_run(&m, 0.0));
        const double z = text_model_get(&m, 0, 2), l = hypot(1.0, z);
        CHECK_NEAR(-2000.0 * (l - hypot(1.0, 0.2)) * z / l, loads[run], 1e-10);
        CHECK((z > 0.0) == (run < 2));
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(a_chain_hangs_as_the_moments_of_its_links_say);
    RUN(a_shallow_truss_snaps_through_beyond_its_limit);
    return check_finish();
}
