/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d new FILE: a model to begin with. */
#include <stdio.h>
#include <string.h>

#include "file.h"
#include "options.h"
#include "outcome.h"
#include "process.h"
#include "text.h"

/* clang-format off */
static const char pendulum[] =
    "# A bar that hangs on a pin and swings.\n"
    "se3d: 1\n"
    "title: Pendulum\n"
    "parameters: {L: 1 m, d: 30 mm, start: 60 deg}\n"
    "points:\n"
    "  pin: [0, 0, 0]\n"
    "  tip: \"pin + L*[sin(start), 0, -cos(start)]\"\n"
    "bodies:\n"
    "  - {name: bar, from: pin, to: tip, radius: d/2, density: 7850}\n"
    "joints:\n"
    "  - {name: pin, type: revolute, body_i: ground, body_j: bar, at: pin,\n"
    "     axis: [0, 1, 0]}\n"
    "analysis: {type: dynamics, duration: 5 s}\n"
    "output:\n"
    "  - {file: pendulum.csv, every: 10 ms, channels: [pin.angle, pin.rate, pin.force,\n"
    "     energy.total]}\n";

static const char slider_crank[] =
    "# A crank that turns at a given speed, a rod, and a slider on the x axis.\n"
    "se3d: 1\n"
    "title: Slider-crank\n"
    "parameters: {r: 50 mm, l: 150 mm, d: 12 mm, speed: 600 rpm}\n"
    "points:\n"
    "  O: [0, 0, 0]\n"
    "  A: [0, 0, r]\n"
    "  B: [sqrt(l^2 - r^2), 0, 0]\n"
    "bodies:\n"
    "  - {name: crank, from: O, to: A, radius: d/2, density: 7850}\n"
    "  - {name: rod, from: A, to: B, radius: d/2, density: 7850}\n"
    "  - name: slider\n"
    "    position: B\n"
    "    density: 7850\n"
    "    shapes: [{type: box, size: [40 mm, 30 mm, 30 mm]}]\n"
    "joints:\n"
    "  - {name: bearing, type: revolute, body_i: ground, body_j: crank, at: O,\n"
    "     axis: [0, 1, 0]}\n"
    "  - {name: crank_pin, type: spherical, body_i: crank, body_j: rod, at: A}\n"
    "  - {name: wrist_pin, type: cylindrical, body_i: rod, body_j: slider, at: B,\n"
    "     axis: [0, 1, 0]}\n"
    "  - {name: guide, type: prismatic, body_i: ground, body_j: slider, at: B,\n"
    "     axis: [1, 0, 0]}\n"
    "drivers:\n"
    "  - {name: motor, joint: bearing, value: speed*t}\n"
    "analysis: {type: inverse_dynamics, duration: 0.2 s, step: 0.5 ms}\n"
    "output:\n"
    "  - {file: slider_crank.csv, channels: [bearing.angle, slider.position,\n"
    "     slider.acceleration, motor.effort, wrist_pin.force]}\n";

static const char ball[] =
    "# Balls that fall on a table, bounce and roll.\n"
    "se3d: 1\n"
    "title: Balls on a table\n"
    "materials:\n"
    "  - {name: rubber, density: 1100, young: 5e6, poisson: 0.45, restitution: 0.7,\n"
    "     friction: 0.6}\n"
    "contact: {law: hertz_mindlin}\n"
    "bodies:\n"
    "  - name: table\n"
    "    fixed: true\n"
    "    shapes: [{type: plane, normal: [0, 0, 1], material: rubber}]\n"
    "  - name: small\n"
    "    position: [0, 0, 0.5]\n"
    "    velocity: [0.5, 0, 0]\n"
    "    shapes: [{type: sphere, radius: 30 mm, material: rubber}]\n"
    "  - name: large\n"
    "    position: [0.4, 0, 0.3]\n"
    "    shapes: [{type: sphere, radius: 50 mm, material: rubber}]\n"
    "analysis: {type: dynamics, duration: 2 s}\n"
    "output:\n"
    "  - {file: balls.csv, every: 5 ms, channels: [small.position, large.position,\n"
    "     contacts.count, energy.total]}\n";
/* clang-format on */

static const struct {
    const char *kind;
    const char *text;
} kinds[] = {{"pendulum", pendulum}, {"slider-crank", slider_crank}, {"contact", ball}};

static const char *find_kind(const char *kind)
{
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
        if (strcmp(kinds[k].kind, kind) == 0) {
            return kinds[k].text;
        }
    }
    return NULL;
}

static int write_model(const options *o, const char *text)
{
    if (!file_is_missing(o->model)) {
        report_failure(o, o->model, "is there already and stays as it is");
        return EXIT_FAILED;
    }
    FILE *file = se3di_partial_open(o->model);
    const int good = file && fputs(text, file) >= 0;
    if (!file || !file_end(file, o->model, good)) {
        return report_unwritten(o, o->model);
    }
    if (outcome_add_file(o->model, o->quiet, "")) {
        fputs("; next: se3d view ", stdout);
        text_put_plain(stdout, o->model);
        putchar('\n');
    }
    return EXIT_DONE;
}

static int command_new(int count, char *const *words)
{
    options o;
    const int code = options_read(&o, &new_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    const char *text = find_kind(o.kind ? o.kind : kinds[0].kind);
    if (!text) {
        complain("se3d new: the kind is `%s`, must be pendulum, slider-crank or contact\n", o.kind);
        return EXIT_USAGE;
    }
    const size_t length = strlen(o.model);
    if (strcmp(o.model, "-") == 0 && o.json) {
        complain("se3d new: standard output is for the model or for --json, not for both\n");
        return EXIT_USAGE;
    }
    if (strcmp(o.model, "-") == 0) {
        return fputs(text, stdout) >= 0 ? EXIT_DONE : EXIT_FAILED;
    }
    if (!path_is_model(o.model) || strcmp(o.model + length - 4, "json") == 0) {
        complain("se3d new: the file is `%s`, must end with .yaml or .yml\n", o.model);
        return EXIT_USAGE;
    }
    return write_model(&o, text);
}

const command_entry new_entry = {
    .name = "new",
    .run = command_new,
    .operands = "FILE.yaml",
    .files = "yaml yml",
    .summary = "write a model to begin with",
    .text = "Writes a small model that runs as it is, to be changed. A file that is there is left "
            "alone. With - it is printed.",
    .options = (const command_option[]){{"--kind", NULL, "K",
                                         "pendulum (default), slider-crank (a driven mechanism) or "
                                         "contact (balls on a table)"},
                                        {0}},
    .examples = (const command_example[]){{"new first.yaml", "then `se3d view first.yaml`"},
                                          {"new engine.yaml --kind slider-crank",
                                           "a mechanism with a motor"},
                                          {0}},
    .exits = "0 done; 1 the file is there or cannot be written; 2 bad usage.",
};
