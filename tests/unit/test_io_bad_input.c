/* SPDX-License-Identifier: BSD-3-Clause */
/* Malformed models: each is rejected with one message that has the place, the path, the value and
 * what is allowed. */
#include "check.h"
#include "se3d/io.h"

#define BAR "bodies: [{name: bar, mass: 1, inertia: [1, 1, 1]}]\n"
#define PIN                                                                                        \
    "joints: [{name: pin, type: revolute, body_i: ground, body_j: bar, at: [0, 0, 0], axis: "      \
    "[0, 0, 1]}]\n"
#define RUN_IT  "analysis: {type: dynamics, duration: 1}\n"
#define BODY(x) "se3d: 1\nbodies:\n  - {name: bar, " x "}\n"
#define WITH(x) "se3d: 1\n" BAR PIN x "\n"

#define PARTICLES(x)                                                                               \
    "se3d: 1\nmaterials: [{name: glass, density: 2500, stiffness: 1e5}]\nparticles: [{" x "}]\n"
#define SHAPES(x)                                                                                  \
    "se3d: 1\ncontact: {}\nmaterials: [{name: glass, density: 2500, stiffness: 1e5}]\n"            \
    "bodies: [{name: b, fixed: true, shapes: [{type: sphere, " x "}]}]\n"
#define BALL_OF_M                                                                                  \
    "bodies: [{name: b, mass: 1, inertia: [1, 1, 1], shapes: [{type: sphere, radius: 1, "          \
    "material: m}]}]\n"
#define GLASS PARTICLES("material: glass, radius: 0.1, upper: [1, 1, 1]")

typedef struct bad_input {
    const char *text;
    size_t line, column; /* 0: not checked */
    const char *parts[4];
} bad_input;

static const bad_input table[] = {
    /* syntax and limits */
    {"", 1, 1, {"is empty", "se3d: 1"}},
    {"# nothing\n", 1, 1, {"is empty"}},
    {"se3d: 1\nbodies: [\n", 3, 1, {"syntax error"}},
    {"se3d: 1\n\tbodies: []\n", 2, 1, {"syntax error", "tab"}},
    {"se3d: 1\nse3d: 1\n", 2, 1, {"`se3d` is given twice"}},
    {"se3d: 1\nbodies: &a []\n", 2, 9, {"bodies", "anchors", "not allowed"}},
    {"se3d: 1\nbodies: *a\n", 2, 9, {"aliases", "not allowed"}},
    {"se3d: !!int 1\n", 1, 7, {"tags", "not allowed"}},
    {"se3d: 1\n---\nse3d: 1\n", 2, 1, {"second document"}},
    {"se3d: 1\n? [a]\n: b\n", 2, 3, {"a key must be a plain text"}},
    {"se3d: 1\ntitle: \"a\\0b\"\n", 2, 8, {"NUL"}},
    {"se3d: 1\ntitle: \xff\xfe\n", 2, 0, {"not a text in UTF-8"}},
    {"se3d: 1\ntitle: [1]\n", 2, 8, {"title: is a list, must be a text"}},
    {"- 1\n", 1, 1, {"is a list", "must be a map"}},
    {"just text\n", 1, 1, {"must be a map"}},
#include "bad_bars.inc"
#include "bad_studies.inc"
#include "bad_units.inc"
    /* head */
    {"title: x\n", 1, 1, {"se3d: is missing", "must be 1"}},
    {"se3d: 2\n", 1, 7, {"se3d: is 2", "must be 1"}},
    {"se3d: one\n", 1, 7, {"se3d: `one`"}},
    {"se3d: 1\nbodys: []\n", 2, 1, {"the key `bodys` is unknown", "did you mean `bodies`"}},
    {"se3d: 1\nzzz: 1\n", 2, 1, {"`zzz` is unknown", "allowed are", "gravity"}},
    {PARTICLES("material: sand, radius: 0.1"),
     3,
     24,
     {"particles[0].material: no material is named"}},
    {PARTICLES("radius: 0.1"), 3, 13, {"particles[0].material: is missing"}},
    {PARTICLES("material: glass, lower: [0, 0, 0]"), 3, 13, {"particles[0].radius: is missing"}},
    {PARTICLES("material: glass, radius: 0"), 3, 0, {"radius: is 0", "> 0"}},
    {PARTICLES("material: glass, radius: 1, upper: [9, 9, 9], count: 1.5"), 3, 0, {"whole number"}},
    {PARTICLES("material: glass, radius: 1, packing: dense"), 3, 0, {"lattice, random"}},
#define FED(x) PARTICLES("material: glass, radius: 0.1, upper: [1, 1, 1], source: {" x "}")
    {PARTICLES("material: glass, file: nowhere.csv"),
     3,
     0,
     {"file: `nowhere.csv`: the file cannot"}},
    {PARTICLES("material: glass, file: a.csv, radius: 1"), 3, 0, {"no effect with `file`"}},
    {PARTICLES("material: glass, name: a.b, radius: 1"), 3, 0, {"name"}},
    {PARTICLES("material: glass, name: ground, radius: 1"), 3, 0, {"`ground` is taken"}},
    {FED("rate: 1, mass_rate: 1"), 3, 0, {"source: must have either `rate`"}},
    {FED("start: 1"), 3, 0, {"source: must have either `rate`"}},
    {FED("rate: -1"), 3, 0, {"source.rate: is -1", ">= 0"}},
    {FED("rate: 2*u"), 3, 0, {"source.rate"}},
    {FED("rate: 1, until: 3"), 3, 0, {"`until` is unknown"}},
    {FED("rate: 1, every: -1"), 3, 0, {"source.every: is -1"}},
    {PARTICLES("material: glass, radius: 0.1, source: {rate: 1}, spacing: 1"),
     3,
     0,
     {"with `source`"}},
    {"se3d: 1\nsinks: [{normal: [0, 0, 1]}]\n", 2, 0, {"sinks: needs `particles`"}},
    {GLASS "sinks: [{normal: [0, 0, 1], lower: [0, 0, 0]}]\n", 4, 0, {"with `normal`"}},
    {GLASS "sinks: [{lower: [1, 0, 0], upper: [0, 1, 1]}]\n", 4, 0, {"sinks[0]", "upper"}},
    {GLASS "sinks: [{nam: a}]\n", 4, 0, {"`nam` is unknown", "`name`"}},
    {GLASS "output: [{file: a.csv, particles: sand}]\n", 4, 0, {"particles: "}},
    {GLASS "output: [{file: a.csv, particles: true, contacts: true}]\n",
     4,
     0,
     {"contacts: cannot be combined with `particles`"}},
    {GLASS "output: [{file: a.csv, contacts: true, channels: [steps]}]\n",
     4,
     0,
     {"channels: cannot be combined with `contacts`"}},
    {"se3d: 1\noutput: [{file: a.csv, contacts: true}]\n", 2, 0, {"no `contact`"}},
    {SHAPES("radius: 1, material: glass, group: 1.5"), 4, 0, {"group: is 1.5", "whole number"}},
    {SHAPES("radius: 1, material: glass, mask: -1"), 4, 0, {"mask: is -1"}},
    {SHAPES("radius: 1, material: glass, contact: 3"), 4, 0, {"shapes[0].contact"}},
    {SHAPES("radius: 1, material: steel"), 4, 0, {"shapes[0].material", "steel"}},
    {SHAPES("radius: 1, name: a}, {type: sphere, radius: 1, material: glass, name: b}, {type: "
            "sphere, radius: 1, material: glass, name: b"),
     4,
     0,
     {"shapes[2]", "taken by another shape"}},
    {"se3d: 1\ncontact: {law: hooke}\nmaterials: [{name: m, density: 1}]\n"
     "bodies: [{name: b, fixed: true, shapes: [{type: plane, material: m}]}]\n",
     3,
     0,
     {"stiffness: is missing"}},
    {GLASS "contact: {law: herz}\n", 4, 16, {"contact.law: is `herz`", "hertz_mindlin"}},
    {GLASS "contact: {boundary: [open, sink]}\n", 4, 21, {"contact.boundary: must be a list of 3"}},
    {"se3d: 1\ncontact: {}\nmaterials: [{name: m, stiffness: 1e5}]\n" BALL_OF_M,
     3,
     0,
     {"materials[0].density: is missing, must be > 0 (kg/m^3)"}},
    {"se3d: 1\ncontact: {}\nmaterials: [{name: m, density: 1}]\n" BALL_OF_M,
     3,
     0,
     {"materials[0].stiffness: is missing, must be > 0 (N/m) with `law: hooke`"}},
    {"se3d: 1\ncontact: {law: hertz_mindlin}\nmaterials: [{name: m, density: 1}]\n" BALL_OF_M,
     3,
     0,
     {"materials[0].young: is missing, must be > 0 (Pa) with `law: hertz_mindlin`"}},
    {GLASS "contact: {pairs: [{material_1: glass}]}\n", 4, 0, {"pairs[0].material_2: is missing"}},
    {GLASS "contact: {pairs: [{material_1: glass, material_2: glass, restitution: 0}]}\n",
     4,
     0,
     {"pairs[0].restitution: is 0", "from 0.01 to 1"}},
    {GLASS "contact: {pairs: [{material_1: glass, material_2: glass, friction: 0.1}, "
           "{material_1: glass, material_2: glass, friction: 0.2}]}\n",
     4,
     0,
     {"pairs[1]: is a second pair of `glass` and `glass`"}},
    {"se3d: 1\nmaterials: [{name: glass}, {name: glass}]\n",
     2,
     0,
     {"materials[1].name: `glass` is taken"}},
    {GLASS "sinks: [{name: a}]\n", 4, 0, {"sinks[0]: must have `lower` and `upper`"}},
    {GLASS "flows: [{name: a}]\n", 4, 0, {"flows[0]: must have `name` and `normal`"}},
    {"se3d: 1\ncell: [{rate: [1, 0, 0]}]\n", 2, 0, {"cell: needs `particles`"}},
    {GLASS "cell: [{rate: [1, 0, 0]}]\n", 4, 0, {"cell[0]", "not periodic along x"}},
#define CELL GLASS "contact: {boundary: [periodic, periodic, periodic], upper: [1, 1, 1]}\n"
    {CELL "cell: [{servo: xzz}]\n", 5, 16, {"cell[0].servo: is `xzz`", "each once"}},
    {CELL "cell: [{servo: up}]\n", 5, 16, {"cell[0].servo: is `up`"}},
    {CELL "cell: [{stress: [1, 1, 1]}]\n", 5, 0, {"cell[0].stress", "without `servo`"}},
    {CELL "cell: [{flow: u}]\n", 5, 15, {"cell[0].flow: is `u`", "x, y, z"}},
    {CELL "cell: [{flow: z}]\n", 5, 0, {"cell[0]", "gradient = 2"}},
    {CELL "cell: [{shear: 1}]\n", 5, 0, {"`shear` is unknown", "shear_rate"}},
    {GLASS "output: [{file: a.csv, channels: [cell.stress]}]\n",
     4,
     0,
     {"`cell.stress` is unknown", "with `cell`"}},
    {GLASS "flows: [{name: glass, normal: [0, 0, 1], width: 1, height: 1}]\n",
     4,
     0,
     {"flows[0].height: needs `along`"}},
    {GLASS
     "flows: [{name: a, normal: [0, 0, 1], radius: 1, width: 1, height: 1, along: [1, 0, 0]}]\n",
     4,
     0,
     {"flows[0].radius: and `along` exclude each other"}},
    {GLASS "flows: [{name: a, normal: [0, 0, 1], set: b}]\n",
     4,
     0,
     {"flows[0].set: no `particles` are named `b`"}},
    {GLASS "flows: [{name: a, normal: [0, 0, 1]}, {name: a, normal: [0, 0, 1]}]\n",
     4,
     0,
     {"flows[1].name: `a` is taken"}},
#include "bad_bonds.inc"
    {"se3d: 1\nflows: []\n", 2, 0, {"flows: needs `particles`"}},
#include "bad_outputs.inc"
#include "bad_shapes.inc"
    {GLASS "contact: {boundary: [open, periodic, open], upper: [1, 0.3, 1]}\n",
     0,
     0,
     {"radius: is 0.1 m", "periodic along y and only 0.3 m long"}},
    {PARTICLES("material: glass, radius: 0.1, upper: [1, 1, 1], packing: random, count: 300"),
     0,
     0,
     {"count: is 300", "the volume of 239 particles only"}},
    {GLASS "contact: {law: hertz_mindlin}\n", 2, 0, {"materials[0]", "young"}},
    {GLASS "bodies: [{name: b, mass: 1, inertia: [1, 1, 1], shapes: [{type: plane, material: "
           "glass}]}]\nanalysis: {type: equilibrium}\n",
     5,
     18,
     {"analysis.type: is `equilibrium`", "must be dynamics or kinematics"}},
    {PARTICLES(
         "material: glass, radius: 0.1, lower: [0, 0, 0], upper: [1, 1, 1]") "analysis: {type: "
                                                                             "dynamics, "
                                                                             "duration: 1, "
                                                                             "method: hht}\n",
     4,
     49,
     {"analysis.method: must be verlet"}},
    {PARTICLES("material: glass, radius: {tables: []}"), 3, 0, {"unknown", "table"}},
    {PARTICLES("material: glass, radius: {table: []}"), 3, 0, {"[[radius, frequency], ...]"}},
    {PARTICLES("material: glass, radius: {table: [[0.1]]}"), 3, 0, {"radius.table[0]"}},
    {PARTICLES("material: glass, radius: 0.1, region: cone"), 3, 0, {"region: ", "cylinder"}},
    {PARTICLES("material: glass, radius: 0.1, axis: x"),
     3,
     0,
     {"axis: is only for `region: cylinder`"}},
    {PARTICLES("material: glass, radius: {table: [[0.1, 0]]}, lower: [0, 0, 0], upper: [1, 1, 1]"),
     3,
     0,
     {"weights"}},
    {"se3d: 1\noutput: [{file: a.csv, particles: true}]\n", 2, 0, {"has no `particles`"}},
    {"se3d: 1\noutput: [{file: a.csv, channels: [particles.count]}]\n", 2, 0, {"is unknown"}},
    {"se3d: 1\ngravity: [0, 0]\n", 2, 10, {"gravity: has 2 entries", "list of 3 numbers"}},
    {"se3d: 1\ngravity: -9.81\n", 2, 10, {"gravity: is a single value", "list of 3 numbers"}},
    /* parameters and expressions */
    {"se3d: 1\nparameters: {a: b, b: a}\n", 2, 17, {"parameters.a", "a -> b -> a", "cycle"}},
    {"se3d: 1\nparameters: {a: a+1}\n", 2, 17, {"depends on itself"}},
    {"se3d: 1\nparameters: {a: 1/0}\n", 2, 0, {"parameters.a", "1/0"}},
    {"se3d: 1\nparameters: {a: 2*}\n", 2, 0, {"parameters.a", "2*"}},
    {"se3d: 1\nparameters: {t: 1}\n", 2, 14, {"name is not allowed"}},
    {"se3d: 1\nparameters: {sin: 1}\n", 2, 14, {"name is not allowed"}},
    {"se3d: 1\nparameters: {2a: 1}\n", 2, 14, {"name is not allowed"}},
    {"se3d: 1\nparameters: {len: 1, b: 2*lem}\n", 2, 27, {"parameters.b", "did you mean `len`"}},
    {"se3d: 1\nparameters: {b: \"2*(3\"}\n", 2, 0, {"parameters.b"}},
    {"se3d: 1\nparameters: {h: hypot(3, 4)}\n", 0, 0, {"needs quotes"}},
    {"se3d: 1\nparameters: [1]\n", 2, 13, {"parameters: is a list", "must be a map"}},
    /* bodies */
    {"se3d: 1\nbodies: 3\n", 2, 9, {"bodies: is a single value", "must be a list"}},
    {"se3d: 1\nbodies: [bar]\n", 2, 10, {"bodies[0]", "must be a map"}},
    {"se3d: 1\nbodies: [{mass: 1}]\n", 2, 10, {"bodies[0].name: is missing"}},
    {BODY("inertia: [1, 1, 1]"), 3, 5, {"bodies[0].mass: is missing", "must be finite and > 0"}},
    {BODY("mass: 1"), 3, 5, {"bodies[0].inertia: is missing"}},
    {BODY("mass: -1, inertia: [1, 1, 1]"), 3, 23, {"bodies[0].mass: is -1", "finite and > 0"}},
    {BODY("mass: 0, inertia: [1, 1, 1]"), 3, 23, {"bodies[0].mass: is 0", "finite and > 0"}},
    {BODY("mass: 1e308, inertia: [1, 1, 1]"), 3, 23, {"mass: is 1e308, must be at most 1e+40"}},
    {BODY("mass: 1e-320, inertia: [1, 1, 1]"), 3, 23, {"mass: is 1e-320, must be at least 1e-40"}},
    {BODY("mass: 1, inertia: [1, 1, 1], position: [-1e308, 0, 0]"),
     3,
     0,
     {"position[0]: is -1e308"}},
    {BODY("mass: .nan, inertia: [1, 1, 1]"), 3, 23, {"mass: is .nan", "finite"}},
    {BODY("mass: nan, inertia: [1, 1, 1]"), 3, 23, {"mass: is nan", "finite"}},
    {BODY("mass: .inf, inertia: [1, 1, 1]"), 3, 23, {"mass: is .inf", "finite"}},
    {BODY("mass: 1e400, inertia: [1, 1, 1]"), 3, 0, {"bodies[0].mass"}},
    {BODY("mass: heavy, inertia: [1, 1, 1]"), 3, 23, {"bodies[0].mass: `heavy`"}},
    {BODY("mass: [1], inertia: [1, 1, 1]"), 3, 23, {"mass: is a list", "must be a number"}},
    {BODY("mass: , inertia: [1, 1, 1]"), 3, 0, {"mass: is empty"}},
    {BODY("mass: 1, inertia: [1, 1, 5]"), 3, 35, {"bodies[0].inertia", "principal moments"}},
    {BODY("mass: 1, inertia: [1, 1, -1]"), 3, 35, {"bodies[0].inertia"}},
    {BODY("mass: 1, inertia: [1, 1]"), 3, 35, {"bodies[0].inertia: must be [Ixx, Iyy, Izz]"}},
    {BODY("mass: 1, inertia: [[1, 0, 0], [1, 1, 0], [0, 0, 1]]"), 3, 35, {"not symmetric"}},
    {BODY("mas: 1"), 3, 17, {"bodies[0]: the key `mas` is unknown", "did you mean `mass`"}},
    {BODY("mass: 1, inertia: [1, 1, 1], orientation: {euler_parameters: [1, 1, 0, 0]}"),
     3,
     0,
     {"orientation.euler_parameters: has the length 1.41421356", "unit"}},
    {BODY("mass: 1, inertia: [1, 1, 1], orientation: {matrix: [[1,0,0],[0,1,0],[0,0,-1]]}"),
     3,
     0,
     {"reflection", "right-handed"}},
    {BODY("mass: 1, inertia: [1, 1, 1], orientation: {matrix: [[2,0,0],[0,1,0],[0,0,1]]}"),
     3,
     0,
     {"is not a rotation"}},
    {BODY("mass: 1, inertia: [1, 1, 1], orientation: {axis: [0,0,0], angle: 1}"),
     3,
     0,
     {"orientation.axis: is [0, 0, 0]", "not zero"}},
    {BODY("mass: 1, inertia: [1, 1, 1], orientation: {axis: [0,0,1]}"),
     3,
     0,
     {"angle: is missing"}},
    {BODY("mass: 1, inertia: [1, 1, 1], orientation: {}"), 3, 0, {"exactly one of"}},
    {BODY("mass: 1, inertia: [1, 1, 1], fixed: maybe"),
     3,
     0,
     {"fixed: is `maybe`", "true or false"}},
    {BODY("shapes: [{type: ball, radius: 1}]"), 3, 0, {"`ball` is not supported", "sphere"}},
    {BODY("density: 1, shapes: [{type: sphere}]"), 3, 0, {"shapes[0].radius: is missing"}},
    {BODY("density: 1, shapes: [{type: box, size: [1, 0, 1]}]"), 3, 0, {"each edge must be > 0"}},
    {BODY("density: 1, shapes: [{type: sphere, radius: 1, position: [1, 0, 0]}]"),
     3,
     0,
     {"centre of mass at [1, 0, 0]", "origin"}},
    {BODY("shapes: [{type: sphere, radius: 1, material: steel}]"), 3, 0, {"no material is named"}},
    {BODY("shapes: [{type: sphere, radius: 1, length: 2}]"), 3, 0, {"`sphere` has no such key"}},
    {"se3d: 1\nbodies:\n  - {name: a.b, mass: 1}\n", 3, 12, {"the name `a.b` is not allowed"}},
    {"se3d: 1\nbodies:\n  - {name: energy, mass: 1}\n", 3, 12, {"taken by a channel"}},
    {"se3d: 1\nbodies: [{name: a, fixed: true}, {name: a, fixed: true}]\n",
     2,
     41,
     {"the name of two bodies"}},
    {"se3d: 1\nbodies: [{name: ground, mass: 1}]\n", 2, 31, {"ground can only have markers"}},
    {"se3d: 1\nbodies:\n  - {name: \"a\\e[2Jb\\n\", mass: 1}\n", 3, 12, {"the name `a?[2Jb?` is"}},
    /* cut in the middle of a character of two bytes */
    {"se3d: 1\nbodies: [{name: "
     "axxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx\xc3\xa4., "
     "mass: 1}]\n",
     2,
     17,
     {"xxx?` is not allowed"}},
    /* joints */
    {"se3d: 1\n" BAR
     "joints: [{type: distance, body_i: ground, body_j: bar, point_i: [1, 0, 0], point_j: [0, 0, "
     "0]}]\n",
     3,
     10,
     {"distance: is missing", "`distance` needs it"}},
    {"se3d: 1\n" BAR
     "joints: [{type: distance, body_i: ground, body_j: bar, at: [1, 0, 0], at_2: [1, 0, 0]}]\n",
     3,
     10,
     {"distance = 0"}},
    {"se3d: 1\n" BAR
     "joints: [{type: revolute_spherical, body_i: ground, body_j: bar, at: [1, 0, 0], at_2: [0, 0, "
     "0], axis: [0, 0, 1]}]\n",
     3,
     10,
     {"distance: is missing"}},
    {"se3d: 1\n" BAR "joints: [{type: hinge}]\n", 3, 17, {"`hinge` is not supported", "revolute"}},
    {"se3d: 1\n" BAR "joints: [{type: revolut}]\n", 3, 17, {"did you mean `revolute`"}},
    {"se3d: 1\n" BAR "joints: [{type: ' '}]\n", 3, 17, {"` ` is not supported, allowed are"}},
    {"se3d: 1\n" BAR "joints: [{name: a}]\n", 3, 10, {"joints[0].type: is missing"}},
    {"se3d: 1\n" BAR "joints: [{type: revolute, body_i: ground, body_j: baz, at: [0,0,0]}]\n",
     3,
     51,
     {"joints[0].body_j: no body is named `baz`", "did you mean `bar`"}},
    {"se3d: 1\n" BAR "joints: [{type: revolute, body_i: bar, body_j: bar, at: [0,0,0]}]\n",
     3,
     48,
     {"two different bodies"}},
    {"se3d: 1\n" BAR "joints: [{type: revolute, body_i: ground, body_j: bar, at: [0, 0, 0]}]\n",
     3,
     10,
     {"joints[0].axis: is missing"}},
    {"se3d: 1\n" BAR
     "joints: [{type: revolute, body_i: ground, body_j: bar, at: [0, 0, 0], axis: [0, 0, 0]}]\n",
     3,
     77,
     {"joints[0].axis: is [0, 0, 0]", "not zero"}},
    {"se3d: 1\n" BAR "joints: [{type: revolute, body_i: ground, body_j: bar, at: [0, 0, 0], axis: "
     "[0, 0, 1], point_i: [0, 0, 0]}]\n",
     3,
     0,
     {"joints[0].at", "cannot be combined with"}},
    {"se3d: 1\n" BAR "joints: [{type: spherical, body_i: ground, body_j: bar}]\n",
     3,
     10,
     {"joints[0].at: is missing"}},
    {"se3d: 1\n" BAR "joints: [{type: spherical, body_i: ground, body_j: bar, point_i: tip}]\n",
     3,
     66,
     {"`tip` is not a marker of `ground`"}},
    {"se3d: 1\n" BAR "joints: [{type: spherical, body_i: ground, body_j: bar, at: [0,0,0], break: "
     "{}}]\n",
     3,
     77,
     {"joints[0].break: has no limit, must have `force`, `moment` or both"}},
    {"se3d: 1\n" BAR "joints: [{type: spherical, body_i: ground, body_j: bar, at: [0,0,0], break: "
     "{force: 0}}]\n",
     3,
     85,
     {"joints[0].break.force: is 0, must be finite and > 0"}},
    {"se3d: 1\n" BAR "joints: [{type: spherical, body_i: ground, body_j: bar, at: [0,0,0], break: "
     "{torque: 3}}]\n",
     3,
     78,
     {"joints[0].break: the key `torque` is unknown"}},
    {"se3d: 1\n" BAR "joints: [{type: spherical, body_i: ground, body_j: bar, at: [0,0,0], pitch: "
     "1}]\n",
     3,
     0,
     {"joints[0].pitch: `spherical` has no such key"}},
    {"se3d: 1\n" BAR "joints: [{name: pin, type: revolute, body_i: ground, body_j: bar, at: [0, 0, "
     "0], axis: [0, 0, 1]}, {type: gear, joint_1: pin, joint_2: pin, ratio: 2}]\n",
     3,
     136,
     {"joints[1].joint_2: is the same as joint_1"}},
    {WITH("drivers: [{joint: pim, value: t}]"), 4, 19, {"no joint is named `pim`", "mean `pin`"}},
    {WITH("drivers: [{joint: pin}]"), 4, 11, {"drivers[0].value: is missing", "or give its rate"}},
    {WITH("drivers: [{joint: pin, value: 1, rate: 2}]"), 4, 40, {"beside value"}},
    {WITH("drivers: [{joint: pin, value: 1, start: 2}]"), 4, 41, {"for a driver with a rate"}},
    {WITH("drivers: [{joint: pin, rate: 2 mm}]"), 4, 30, {"is a length [m], must be"}},
    {WITH("drivers: [{joint: pin, rate: 2*pin.rate}]"), 4, 30, {"rate: function depends on the"}},
    {WITH("drivers: [{joint: pin, rate: 2*pin.force.x}]"), 4, 30, {"known only when the motion"}},
    {WITH("drivers: [{joint: pin, rate: pin.angle, start: 1}]"), 4, 48, {"a rate of t alone"}},
    {WITH("drivers: [{joint: pin, rate: 2*u, start: 1}]"), 4, 32, {"drivers[0].rate"}},
    {WITH("drivers: [{joint: pin, rate: 1, start: 2 kg}]"), 4, 40, {"must be an angle [rad]"}},
    {WITH("drivers: [{joint: pin, speed: 2}]"), 4, 24, {"did you mean `rate`"}},
    {WITH("drivers: [{joint: pin, value: step(t,0,0,1,1)}]"),
     4,
     31,
     {"`step(t, 0, 0, 1, 1)` is cut at its commas", "needs quotes"}},
    {WITH("parameters: {a: hypot(3, 4)}"), 4, 17, {"`hypot(3, 4)` is cut at its commas"}},
    {WITH("drivers: [{joint: pin, value: sin(t, name: x}]"), 4, 0, {"no closing parenthesis"}},
    {WITH("drivers: [{joint: pin, coordinate: displacement, value: t}]"),
     4,
     36,
     {"which this joint does not have"}},
    {WITH("drivers: [{joint: pin, value: \"sin(tt)\"}]"), 4, 36, {"drivers[0].value", "tt"}},
    {WITH("drivers: [{joint: pin, value: {spline: [[0, 0], [0, 1]]}}]"), 4, 0, {"must increase"}},
#include "bad_tables.inc"
    {WITH("drivers: [{name: pin, joint: pin, value: t}]"), 4, 18, {"name of two elements"}},
    /* constraints */
    {WITH("constraints: [{type: dp3, body_i: bar}]"), 4, 22, {"`dp3` is not supported", "dp1"}},
    {WITH("constraints: [{type: dp1, body_i: bar, body_j: ground, a_i: [1, 0, 0]}]"),
     4,
     15,
     {"constraints[0].a_j: is missing"}},
    {WITH("constraints: [{type: d, body_i: bar, body_j: ground, value: 0}]"),
     4,
     61,
     {"constraints[0].value: is 0", "must be > 0"}},
    /* forces */
    {WITH("forces: [{type: magnet}]"), 4, 17, {"`magnet` is not supported", "tsda", "stop"}},
    {WITH("forces: [{type: effort}]"), 4, 10, {"forces[0].joint: is missing"}},
    {WITH("forces: [{type: effort, joint: pin, value: s}]"), 4, 44, {"`s`", "qdot"}},
    {WITH("forces: [{type: effort, joint: pin, value: 2*pin.angel}]"),
     4,
     46,
     {"did you mean `angle`"}},
    {WITH("forces: [{type: effort, joint: pin, value: 2*pin.force.x}]"),
     4,
     44,
     {"`pin.force` is known only when the motion has been solved for"}},
    {WITH("forces: [{type: effort, joint: pin, value: -bar.acceleration.x}]"), 4, 44, {"solved"}},
    {WITH("forces: [{type: effort, joint: pin, value: 2*(pin.angle}]"), 4, 0, {"`2*(pin.angle`"}},
    {WITH("forces: [{type: effort, joint: pin, value: 2*bar.position}]"), 4, 46, {"component"}},
    {WITH("drivers: [{joint: pin, value: 2*pin.angle}]"),
     4,
     0,
     {"drivers[0].value: ", "depends on the coordinate that the driver prescribes"}},
    {WITH("drivers: [{joint: pin, value: 2*pin.rate}]"),
     4,
     0,
     {"drivers[0].value: `pin.rate` is a velocity", "`effort`"}},
    {WITH("drivers: [{joint: pin, value: s.value}]\n"
          "states: [{name: s, type: ode, rate: 1 - s.value}]"),
     4,
     0,
     {"drivers[0].value: `s.value` is integrated", "`effort`"}},
    {WITH("drivers: [{joint: pin, value: pin.force.x}]"), 4, 0, {"value: `pin.force` is known"}},
    {WITH("drivers: [{joint: pin, value: bra.position.x}]"), 4, 0, {"value", "bra", "did you"}},
    {WITH("drivers: [{joint: pin, rate: bar.acceleration.x}]"), 4, 0, {"`bar.acceleration` is"}},
    {WITH("drivers: [{joint: pin, rate: 0.5*pim.angle}]"), 4, 0, {"pim", "did you mean"}},
    {WITH("constraints: [{type: cd, body_i: bar, body_j: ground, c: [1, 0, 0], value: pin.rate}]"),
     4,
     0,
     {"value: depends on `pin.rate`"}},
    {WITH("forces: [{type: effort, joint: pin, coordinate: displacement}]"),
     4,
     49,
     {"forces[0].coordinate: is `displacement`, which this joint does not have"}},
    {WITH("forces: [{type: bushing}]"), 4, 10, {"forces[0].body_i: is missing"}},
    {WITH("forces: [{type: bushing, body_i: bar, body_j: bar}]"), 4, 47, {"two different bodies"}},
    {WITH("forces: [{type: bushing, body_i: bar, body_j: ground, K: [1, 2]}]"),
     4,
     58,
     {"forces[0].K: must be the 6 numbers", "6 rows"}},
    {WITH("forces: [{type: bushing, body_i: bar, body_j: ground, K: [[1,2,0,0,0,0], [0,1,0,0,0,0], "
          "[0,0,1,0,0,0], [0,0,0,1,0,0], [0,0,0,0,1,0], [0,0,0,0,0,1]]}]"),
     4,
     58,
     {"forces[0].K: is not symmetric", "row 1 and column 2"}},
    {WITH("forces: [{type: bushing, body_i: bar, body_j: ground, at: [0,0,0], point_i: [0,0,0]}]"),
     4,
     0,
     {"forces[0].point_i: is not allowed here", "`at`"}},
    {WITH("forces: [{type: bushing, body_i: bar, body_j: ground, orientation: {rpy: [0, 0, 0]}}]"),
     4,
     0,
     {"forces[0].orientation: is not allowed here"}},
    {WITH("forces: [{type: friction, mu: 1}]"), 4, 10, {"forces[0].joint: is missing"}},
    {WITH("forces: [{type: friction, joint: pin, mu: 1}]"), 4, 10, {"forces[0].radius: is miss"}},
    {WITH("forces: [{type: friction, joint: pin, mu: -1}]"), 4, 43, {"mu: is -1", ">= 0"}},
    {WITH("forces: [{type: friction, joint: pin, radius: 1, mu: 0.2, mu_static: 0.1}]"),
     4,
     0,
     {"forces[0].mu_static: is 0.1", "at least"}},
    {WITH("forces: [{type: friction, joint: pin, coordinate: displacement}]"),
     4,
     51,
     {"which this joint does not have"}},
    {WITH("forces: [{type: stop, joint: pin, k: 1}]"), 4, 10, {"forces[0].upper: is missing"}},
    {WITH("forces: [{type: stop, joint: pin, upper: 1}]"), 4, 10, {"forces[0].k: is missing"}},
    {WITH("forces: [{type: stop, joint: pin, lower: 2, upper: 1, k: 1}]"), 4, 0, {"below upper"}},
    {WITH("forces: [{type: stop, joint: pin, upper: 1, k: 1, restitution: 2}]"),
     4,
     0,
     {"restitution: is 2", "from 0.01 to 1"}},
    {WITH("forces: [{type: stop, joint: pin, upper: 1, k: 1, restitution: -1}]"),
     4,
     64,
     {"restitution: is -1", "from 0.01 to 1"}},
    {WITH("forces: [{type: stop, joint: pin, body_i: bar, upper: 1, k: 1}]"),
     4,
     0,
     {"forces[0].body_i: cannot be combined with `joint`"}},
    {WITH("forces: [{type: rsda, joint: pin, axis: [0, 0, 1]}]"),
     4,
     0,
     {"forces[0].axis: cannot be combined with `joint`"}},
    {WITH("forces: [{type: rsda, body_i: ground, body_j: bar}]"), 4, 10, {"axis: must be given"}},
    {WITH("forces: [{type: rsda, body_i: ground, body_j: bar, axis: [0, 0, 1], ref_i: [1,0,0]}]"),
     4,
     0,
     {"forces[0].axis: cannot be combined with ref_i"}},
    {WITH("forces: [{type: rsda}]"), 4, 10, {"forces[0].joint: is missing"}},
    {WITH("forces: [{type: rsda, joint: pin, spring: \"2*y\"}]"), 4, 0, {"forces[0].spring", "y"}},
    {WITH("forces: [{type: rsda, joint: pin, k: \"2*x\"}]"), 4, 0, {"forces[0].k", "x"}},
    {WITH("forces: [{type: rsda, joint: pin, c: {spline: [[0, 0], [1, 1]]}, damper: v}]"),
     4,
     0,
     {"forces[0].damper: cannot be combined with a table `c`"}},
    {WITH("forces: [{type: tsda, body_i: ground, body_j: bar, preload: [1]}]"),
     4,
     61,
     {"forces[0].preload: is a list"}},
    {"se3d: 1\ngravity: [0, 0, \"-9.81*u\"]\n", 2, 0, {"gravity[2]", "u"}},
    {BODY("mass: 1, inertia: [1, 1, 1], held: 2"), 3, 0, {"held: is `2`", "true or false"}},
    {WITH("forces: [{type: tsda, body_i: ground, body_j: bar, l0: -1}]"),
     4,
     56,
     {"forces[0].l0: is -1", ">= 0"}},
    {WITH("forces: [{type: force, body: bar, value: [1, 2]}]"), 4, 42, {"list of 3 numbers"}},
    {WITH("forces: [{type: force, body: bar, value: [1, 2, \"u\"]}]"), 4, 0, {"value[2]", "u"}},
    {WITH("forces: [{type: torque, body: bar, frame: world, value: [1, 2, 3]}]"),
     4,
     43,
     {"is `world`", "ground, body"}},
    /* analysis and output */
    {WITH("analysis: {duration: 1}"), 4, 11, {"analysis.type: is missing"}},
    {WITH("analysis: {type: dynamic, duration: 1}"), 4, 18, {"did you mean `dynamics`"}},
    {WITH("analysis: {type: vibration, duration: 1}"), 4, 18, {"must be one of", "modes"}},
#include "bad_modes.inc"
    {WITH("analysis: {type: dynamics}"), 4, 11, {"analysis.duration: is missing"}},
    {WITH("analysis: {type: dynamics, duration: -1}"), 4, 38, {"duration: is -1", ">= 0"}},
    {WITH("analysis: {type: dynamics, duration: 1, step: 0}"), 4, 47, {"step: is 0", "> 0"}},
    {WITH("analysis: {type: dynamics, duration: 1, method: euler}"), 4, 49, {"generalized_alpha"}},
    {WITH("analysis: {type: dynamics, duration: 1, alpha: 1}"), 4, 48, {"alpha: is 1", "from"}},
    {WITH("analysis: {type: dynamics, duration: 1, method: bdf, order: 9}"),
     4,
     61,
     {"analysis.order: is 9", "must be 0, 1, 2, 3, 4, 5 with method bdf"}},
    {WITH("analysis: {type: dynamics, duration: 1, order: 4}"), 4, 48, {"is 4", "must be 0 with"}},
    {WITH("analysis: {type: dynamics, duration: 1, order: 2.5}"), 4, 48, {"whole number"}},
    {WITH("analysis: {type: dynamics, duration: 1, iterations_max: 0}"), 4, 57, {"from 1 to"}},
    {WITH("analysis: {type: dynamics, duration: 1, tolerance: 1e-30}"),
     4,
     52,
     {"analysis.tolerance: is 1e-30", "must be from 1e-14 to 0.1"}},
    {WITH("analysis: {type: dynamics, duration: 1, tolerance: 0}"),
     4,
     52,
     {"analysis.tolerance: is 0, must be from 1e-14 to 0.1"}},
    {WITH("analysis: {type: dynamics, duration: 1, tolerance: 1e10}"), 4, 52, {"is 1e+10", "to"}},
    {WITH("analysis: {type: dynamics, duration: 1, step: 1e-20}"), 4, 47, {"at least 1e-15"}},
    {WITH("analysis: {type: dynamics, duration: 1, step: 1e-12}"),
     4,
     38,
     {"analysis.duration: is 1 s", "1e+12 steps", "at most 1e+09"}},
    {WITH("analysis: {type: dynamics, duration: 1e8, method: hht}"), 4, 38, {"1e+11 steps of 0.0"}},
    {WITH("analysis: {type: dynamics, duration: 1e20}"), 4, 38, {"at most 1e+09 [s]"}},
    {WITH("analysis: {type: dynamics, duration: 1e-320}"), 4, 38, {"must be 0 or at least 1e-15"}},
    {WITH("analysis: {type: dynamics, duration: 1e-9, start: 1e9}"), 4, 38, {"does not move"}},
    {WITH("analysis: {type: dynamics, duration: 1, start: 1e20}"), 4, 48, {"-1e+09 to 1e+09"}},
    {WITH("analysis: {type: dynamics, duration: 1, start: 1e9, step: 1e-6}"),
     4,
     59,
     {"does not move the time"}},
    {WITH("analysis: {type: kinematics, duration: 1, step: 1e-8}\n"
          "output: [{file: a.csv, every: 1e-12}]"),
     5,
     31,
     {"output[0].every: is 1e-12 s", "1e+12 rows", "at most 1e+08"}},
    {WITH("analysis: {type: kinematics, duration: 1, step: 1e-9}"), 4, 49, {"1e+09 rows", "every"}},
    {WITH("analysis: {type: kinematics, duration: 1, step: 1e-6}\noutput: [{vtk: a.pvd}]"),
     4,
     49,
     {"1e+06 files of `a.pvd`"}},
    {WITH("analysis: [{type: dynamics, duration: 1}, {type: assembly, step: x}]"),
     4,
     0,
     {"analysis[1].step"}},
    {WITH("states: [{name: z, type: lag, input: 1}]"), 4, 10, {"time_constant: is missing"}},
    {WITH("states: [{name: z, type: ode}]"), 4, 10, {"rate: is missing"}},
    {WITH("states: [{name: z, type: ode, rate: y.value}]"), 4, 37, {"`y` is unknown"}},
    {WITH("states: [{name: z, type: ode, rate: z.acceleration}]"),
     4,
     37,
     {"`z` has no channel `acceleration`"}},
    {WITH("states: [{name: pin, type: ode, rate: 1}]"), 4, 17, {"name of two elements"}},
    {WITH("states: [{name: z, type: ode, rate: pin.force.x}]"), 4, 37, {"known only when"}},
    {WITH("states: [{name: z, type: transfer, input: 1, numerator: [1], denominator: [2]}]"),
     4,
     75,
     {"must be a list of 2 to 13 numbers"}},
    {WITH("states: [{name: z, type: transfer, input: 1, numerator: [1, 2, 3], denominator: [1, "
          "2]}]"),
     4,
     57,
     {"its degree must not be above"}},
    {WITH("states: [{name: z, type: transfer, input: 1, numerator: [1], denominator: [0, 2]}]"),
     4,
     76,
     {"coefficient of s^1"}},
    {WITH("states: [{name: z, type: transfer, input: 1, numerator: [1], denominator: [-1e-310, "
          "2]}]"),
     4,
     76,
     {"-1e-310, must be at least 1e-40"}},
    {WITH("states: [{name: z, type: transfer, input: 1 - z.value, numerator: [2, 1], denominator: "
          "[1, 1]}]"),
     4,
     10,
     {"an algebraic loop"}},
    {WITH("states: [{name: z, type: pid, input: 1, kd: 1}]"), 4, 10, {"filter_time: is missing"}},
    {WITH("states: [{name: z, type: pid, input: 1, kp: 1, lower: 2, upper: 1}]"),
     4,
     55,
     {"is 2, must be below `upper` = 1"}},
    {WITH("states: [{name: z, type: pid, input: 1, ki: 1, upper: 1}]"),
     4,
     10,
     {"tracking_time: is missing"}},
    {WITH("output: [{file: a.csv, channels: [bar.pos]}]"), 4, 35, {"`bar` has no channel `pos`"}},
    {WITH("output: [{file: a.csv, channels: [baz.position]}]"), 4, 35, {"did you mean `bar`"}},
    {WITH("output: [{file: a.csv, channels: [bar.tip.position]}]"), 4, 35, {"no marker named"}},
    {WITH("output: [{file: a.csv, channels: [energy.all]}]"), 4, 35, {"kinetic"}},
    {WITH("output: [{file: a.csv, channels: [pin.displacement]}]"), 4, 35, {"it has:", "angle"}},
    {WITH("events: {name: a}"), 4, 9, {"events: is a map, must be a list"}},
    {WITH("events: [{channel: pin.angle}]"), 4, 10, {"events[0].name: is missing"}},
    {WITH("analysis: {type: equilibrium}\nevents: [{name: a, channel: pin.angle}]"),
     5,
     9,
     {"events: need an `analysis` with a motion", "equilibrium has none"}},
    {WITH("analysis: [{type: modes}]\nevents: [{name: a, channel: pin.angle}]"),
     5,
     9,
     {"events: need an `analysis` with a motion", "modes has none"}},
    {WITH("events: [{name: a, channel: pin.angle, hysteresis: 0}]"), 4, 0, {"hysteresis: is 0"}},
    {WITH("events: [{name: a}]"), 4, 10, {"events[0].channel: is missing"}},
    {WITH("events: [{name: a, channel: pi*2 m}]\n" RUN_IT),
     4,
     29,
     {"events[0].channel: `pi*2 m` is a constant, must name a channel"}},
    {WITH("events: [{name: a, channel: [pin.angle]}]"),
     4,
     29,
     {"events[0].channel: is a list, must be a text"}},
    {WITH("events: [{name: a, channel: pin.angel}]"), 4, 29, {"did you mean `angle`"}},
    {WITH("events: [{name: a, channel: bar.positon.z}]"), 4, 29, {"did you mean `position`"}},
    {WITH("events: [{name: a, channel: bra.position.z}]"), 4, 29, {"did you mean `bar`"}},
    {WITH("events: [{name: a, channel: bar.position}]"),
     4,
     29,
     {"`bar.position` is not a single number", "bar.position.z"}},
    {WITH("events: [{name: a, channel: pin.angle.x}]"), 4, 29, {"`pin.angle` has no components"}},
    {WITH("events: [{name: a, channel: bar.position.e0}]"), 4, 29, {"not a single number"}},
    {WITH("events: [{name: a, channel: 2*pin.angel}]"), 4, 31, {"did you mean `angle`"}},
    {WITH("events: [{name: a, channel: pin.angle + steps.x}]"), 4, 41, {"no components"}},
    {WITH("events: [{name: a, channel: 2*(pin.angle}]"), 4, 0, {"`2*(pin.angle`"}},
    {WITH("events: [{name: a, channel: 2 + 3}]"), 4, 29, {"names no channel"}},
    {WITH("events: [{name: a, channel: bar.position - pin.angle}]"), 4, 29, {"not a single"}},
    {WITH("output: [{file: a.csv, channels: [{a: 2*pin.angle, b: 1}]}]"), 4, 35, {"2 keys"}},
    {WITH("output: [{file: a.csv, channels: [{a: 2*pin.angle}, {a: t*pin.rate}]}]"),
     4,
     53,
     {"`a` is listed twice"}},
    {WITH("output: [{file: a.csv, channels: [{\"a,b\": 2*pin.angle}]}]"), 4, 0, {"not allowed"}},
    {WITH("output: [{file: a.csv, channels: [\"'bar.position.z\"]}]"), 4, 0, {"no second '"}},
    {WITH("output: [{file: a.csv, channels: [{time: bar.position.z}]}]"),
     4,
     0,
     {"output[0].channels[0].time", "`time` is the first column, use another name"}},
    {WITH("output: [{summary: a.csv, particles: true}]"), 4, 38, {"has no effect with `summary`"}},
    {WITH("events: [{name: a, channel: steps}]"), 4, 29, {"`steps` changes in jumps"}},
    {WITH("events: [{name: a, channel: pin.angle, value: x}]"), 4, 47, {"events[0].value"}},
    {WITH("events: [{name: a, channel: pin.angle, direction: up}]"), 4, 51, {"rising, falling"}},
    {WITH("events: [{name: a, channel: pin.angle, action: stopp}]"), 4, 48, {"mean `stop`"}},
    {WITH("events: [{name: a, channel: pin.angle, level: 1}]"), 4, 40, {"`level` is unknown"}},
    {WITH("events: [{name: a, channel: pin.angle}, {name: a, channel: pin.rate}]"),
     4,
     48,
     {"events[1].name", "there is an event named `a` already"}},
    {WITH("output: [{file: events.csv}]\nevents: [{name: a, channel: pin.angle}]"),
     5,
     9,
     {"written to `events.csv`, which is also an output"}},
    {WITH("output: [{file: a.csv, every: 0}]"), 4, 31, {"every: is 0", "> 0"}},
    {WITH("output: [{channels: []}]"), 4, 10, {"output[0].file: is missing"}},
    {WITH("output: [{file: ../a.csv}]"),
     4,
     17,
     {"`../a.csv` must be a file inside the results folder"}},
    {WITH("output: [{file: b/../../a.csv}]"), 4, 17, {"inside the results folder"}},
    {WITH("output: [{file: /tmp/a.csv}]"), 4, 17, {"inside the results folder"}},
    {WITH("output: [{file: 'c:/a.csv'}]"), 4, 17, {"inside the results folder"}},
    {WITH("output: [{file: './a.csv'}]"), 4, 17, {"inside the results folder"}},
    {WITH("output: [{file: b//a.csv}]"), 4, 17, {"inside the results folder"}},
    {WITH("output: [{file: b/}]"), 4, 17, {"inside the results folder"}},
    {WITH("output: [{file: \"a\\nb.csv\"}]"), 4, 17, {"is not a file name"}},
    {WITH("output: [{file: 'a\\b.csv'}]"), 4, 17, {"is not a file name"}},
    {WITH("output: [{file: ''}]"), 4, 17, {"is not a file name"}},
    {WITH("output: [{file: \"a\\u0085b.csv\"}]"), 4, 17, {"is not a file name"}},
    {WITH("output: [{file: \"a\\u2028b.csv\"}]"), 4, 17, {"is not a file name"}},
    {WITH("output: [{file: \"a\\u202Eb.csv\"}]"), 4, 17, {"is not a file name"}},
    {WITH("output: [{file: \"<touch PWNED; cat x.csv\"}]"), 4, 17, {"may begin with"}},
    {WITH("output: [{file: a.csv}, {plot: '| touch PWNED; cat >x.svg'}]"), 4, 32, {"may begin"}},
    {WITH("output: [{file: a/-x.csv}]"), 4, 17, {"`a/-x.csv`: no part of it may begin with `-`"}},
    {WITH("output: [{vtk: '~root.pvd'}]"), 4, 16, {"may begin with"}},
    {WITH("output: [{file: a.csv.partial}]"), 4, 17, {"must not end with .partial"}},
    {WITH("output: [{file: scene.glb}]"), 4, 17, {"is written by two outputs"}},
    {WITH("output: [{video: ../a.mp4}]"), 4, 18, {"inside the results folder"}},
    {WITH("analysis: {type: modes, file: ../m.csv}"), 4, 31, {"inside the results folder"}},
    {WITH("output: [{file: a.csv}, {file: a.csv}]"), 4, 32, {"written by two outputs"}},
    {WITH("output: [{file: a.csv, vtk: a.pvd}]"), 4, 29, {"cannot be combined with `file`"}},
    {WITH("output: [{file: a.csv}, {plot: a.svg}, {plot: a.png}]"),
     4,
     47,
     {"`a.png` is written by two outputs"}},
    {WITH("output: [{file: a.csv}, {plot: b/a.png}, {plot: b/a.svg}]"),
     4,
     49,
     {"`b/a.svg` is written by two outputs"}},
    {WITH("output: [{file: a.gp}, {plot: a.svg}]"), 4, 31, {"written by two outputs"}},
    {WITH("output: [{file: a.png}, {plot: a.svg}]"), 4, 32, {"written by two outputs"}},
    {WITH("output: [{vtk: a.vtp}]"), 4, 16, {"`a.vtp` must end with .pvd"}},
    {WITH("output: [{vtk: a.pvd, speed: 2}]"), 4, 30, {"no effect with `vtk`", "every"}},
    {WITH("output: [{plot: a.svg, every: 1}]"), 4, 31, {"no effect with `plot`"}},
    {WITH("output: [{plot: a.pdf}]"), 4, 17, {"must end with .svg or .png"}},
    {WITH("output: [{file: a.csv, channels: [bar.position]}, {plot: a.svg, channels: [bar.pos]}]"),
     4,
     76,
     {"`bar.pos` is not a channel of a.csv"}},
    {WITH("output: [{plot: a.svg, x: bar.weight}]"), 4, 27, {"is not a channel of results.csv"}},
    {WITH("output: [{plot: a.svg, from: b.csv}]"), 4, 30, {"names no results"}},
    {WITH("output: [{plot: a.svg}, {plot: a.svg}]"), 4, 32, {"written by two outputs"}},
    {WITH("output: [{scene: a.htm}]"), 4, 18, {"must end with .html or .glb"}},
    {WITH("output: [{video: a.mp4, speed: 0}]"), 4, 32, {"speed: is 0", "> 0"}},
};

static void every_bad_model_is_rejected_with_place_and_reason(void)
{
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        const bad_input *bad = &table[k];
        char place[64];
        se3d_model *model = NULL;
        se3d_model_error error;
        const se3d_status status =
            se3d_model_read_text(bad->text, strlen(bad->text), "bad.yaml", NULL, &model, &error);
        if (status != SE3D_ERR_MODEL) {
            fprintf(stderr, "accepted (%d): %s\n", (int)status, bad->text);
        }
        CHECK(status == SE3D_ERR_MODEL);
        CHECK(model == NULL);
        snprintf(place, sizeof place,
                 bad->column ? "bad.yaml:%zu:%zu: " : "bad.yaml:%zu:", bad->line, bad->column);
        CHECK_CONTAINS(error.message, bad->line ? place : "bad.yaml:");
        for (size_t i = 0; i < 4 && bad->parts[i]; ++i) {
            CHECK_CONTAINS(error.message, bad->parts[i]);
        }
        CHECK(strchr(error.message, '\n') == NULL);
        se3d_model_destroy(model);
    }
}

typedef struct mistakes {
    char text[4096];
    size_t count, line;
} mistakes;

static void note_mistake(void *ctx, const se3d_model_error *error)
{
    mistakes *m = ctx;
    const size_t used = strlen(m->text);
    snprintf(m->text + used, sizeof m->text - used, "%s\n", error->message);
    CHECK(error->line >= m->line || error->line == 0);
    m->line = error->line;
    ++m->count;
}

static mistakes find_mistakes(const char *text, se3d_model_error *error)
{
    mistakes m = {.count = 0};
    se3d_model *model = NULL;
    se3d_model_options options = se3d_model_options_default();
    options.report = note_mistake;
    options.report_ctx = &m;
    CHECK(se3d_model_read_text(text, strlen(text), "m.yaml", &options, &model, error) ==
          SE3D_ERR_MODEL);
    CHECK(model == NULL);
    return m;
}

/* Models of the table that hold a second mistake, by what is said of the first. */
static int has_two_mistakes(const bad_input *bad)
{
    static const char *const first[] = {"no effect with `file`",
                                        "`nam` is unknown",
                                        "bodies[0]: the key `mas` is unknown",
                                        "did you mean `revolute`",
                                        "joints[0].body_j: no body is named `baz`",
                                        "`dp3` is not supported",
                                        "`ball` is not supported",
                                        "`hinge` is not supported"};
    for (size_t k = 0; k < sizeof first / sizeof *first; ++k) {
        if (strcmp(bad->parts[0], first[k]) == 0) {
            return 1;
        }
    }
    return strcmp(bad->parts[0], "unknown") == 0 && strcmp(bad->parts[1], "table") == 0;
}

/* What follows from a mistake is not another one. */
static void every_mistake_is_reported_once(void)
{
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        se3d_model_error error;
        const mistakes m = find_mistakes(table[k].text, &error);
        const size_t count = has_two_mistakes(&table[k]) ? 2 : 1;
        CHECK(m.count == count);
        CHECK_CONTAINS(m.text, error.message);
        if (m.count != count) {
            fprintf(stderr, "%zu reports of\n%s%s", m.count, table[k].text, m.text);
        }
    }
}

/* A first draft with the habits of other tools: what is reported, line by line. */
static void all_mistakes_of_a_draft_are_reported(void)
{
    static const char draft[] =
        "se3d: 1\n"
        "parameters: {L: 2, half: L/2 + w}\n"
        "gravity: 9.81\n"
        "bodies:\n"
        "  - {name: crank, mas: -1, inertia: [1, 1, 1]}\n"
        "  - {name: rod, mass: 1, inertia: [1, 1]}\n"
        "  - {name: block, mass: 1, inertia: [1, 1, 1], pos: [half, 0]}\n"
        "  - {mass: 2, inertia: [1, 1, 1]}\n"
        "joints:\n"
        "  - {name: a, type: hinge, body1: ground, body2: crank, "
        "at: [0, 0, 0], axis: [0, 0, 1]}\n"
        "  - {name: b, type: revolute, body_i: crank, body_j: rod, "
        "at: [L, 0, 0], axis: [0, 0, 0]}\n"
        "  - {name: c, type: prismatic, body_i: ground, body_j: blok, "
        "at: [L, 0, 0], axis: [1, 0, 0]}\n"
        "drivers: [{name: motor, joint: a, value: \"2*pi*T\"}, "
        "{joint: c, value: step(t,0,0,1,1)}]\n"
        "forces: [{type: tsda, body_i: ground, body_j: block, k: 1e3}]\n"
        "analysis: {type: dynamic, time: 2}\n"
        "output: [{file: a.csv, channels: [block.postion, rod.position]}]\n";
    static const char *const expected[] = {":2:32: parameters.half: `L/2 + w`",
                                           ":3:10: gravity: is a single value",
                                           ":5:19: bodies[0]: the key `mas`",
                                           ":5:24: bodies[0].mass: is -1",
                                           ":6:35: bodies[1].inertia: ",
                                           ":7:48: bodies[2]: the key `pos`",
                                           ":7:53: bodies[2].position: has 2",
                                           ":8:5: bodies[3].name: is missing",
                                           ":10:21: joints[0].type: ",
                                           ":10:28: joints[0]: the key `body1`",
                                           ":10:43: joints[0]: the key `body2`",
                                           ":11:80: joints[1].axis: is [0, 0, 0]",
                                           ":12:56: joints[2].body_j: ",
                                           ":13:48: drivers[0].value: `2*pi*T`: unknown name 'T'",
                                           ":13:71: drivers[1].value: `step(t, 0, 0, 1, 1)` is",
                                           ":15:18: analysis.type: ",
                                           ":15:27: analysis: the key `time`",
                                           ":16:35: output[0].channels[0]: ",
                                           "did you mean `position`"};
    se3d_model_error error;
    const mistakes m = find_mistakes(draft, &error);
    for (size_t k = 0; k < sizeof expected / sizeof *expected; ++k) {
        CHECK_CONTAINS(m.text, expected[k]);
    }
    CHECK(m.count == sizeof expected / sizeof *expected - 1);
    CHECK_CONTAINS(m.text, error.message);
}

/* The same words do not make two mistakes one. */
static void equal_mistakes_of_different_things_are_all_reported(void)
{
    static const char text[] = "se3d: 1\n"
                               "units: mm\n"
                               "bodies:\n"
                               "  - {name: a, fixed: true}\n"
                               "  - {fixed: true}\n"
                               "  - {fixed: true}\n"
                               "  - {name: b, fixed: true, position: [w, w, w]}\n";
    se3d_model_error error;
    const mistakes m = find_mistakes(text, &error);
    CHECK_CONTAINS(m.text, ":5:5: bodies[1].name: is missing");
    CHECK_CONTAINS(m.text, ":6:5: bodies[2].name: is missing");
    CHECK_CONTAINS(m.text, ":7:39: bodies[3].position[0]: `w`");
    CHECK(m.count == 4);
}

/* An expression that is cut at a comma has two halves, not any number of them. */
static void halves_of_an_expression_are_taken_out_with_each_other_only(void)
{
    static const char text[] =
        "se3d: 1\n"
        "bodies: [{name: \"a(\", fixed: true}]\n"
        "output:\n"
        "  - {file: o.csv, channels: [\"a(.position\", \"a(.foo\", \"x)\", \"y)\"]}\n";
    se3d_model_error error;
    const mistakes m = find_mistakes(text, &error);
    CHECK_CONTAINS(m.text, "`a(` has no channel `foo`");
    CHECK_CONTAINS(m.text, "channels[3]");
    CHECK(m.count == 2);
}

static void a_report_ends_at_the_largest_number(void)
{
    char text[4096] = "se3d: 1\nbodies:\n";
    for (int k = 0; k < 30; ++k) {
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "  - {name: b%d, fixed: perhaps}\n", k);
    }
    se3d_model_error error;
    CHECK(find_mistakes(text, &error).count == SE3D_MODEL_MISTAKES_MAX);
}

static void options_are_checked_like_the_file(void)
{
    static const char text[] =
        "se3d: 1\nparameters: {L: 1}\n" BAR
        "analysis: {type: dynamics, duration: 1, start: 1e5, step: 0.01, tolerance: 1e-7}\n";
    static const struct {
        se3d_model_setting setting;
        const char *step, *duration, *tolerance, *method, *formulation, *analysis, *part;
    } cases[] = {
        {.setting = {"M", "1"}, .part = "M: the model has no such parameter"},
        {.setting = {"L", "1/"}, .part = "L: `1/`"},
        {.setting = {"bodies.bar.mass", "-1"}, .part = "bodies[0].mass: is -1"},
        {.setting = {"bodies[0].mas", "1"},
         .part = "bodies[0]: the key `mas` is unknown, allowed are"},
        {.setting = {"bodies.ber.mass", "1"}, .part = "`bodies` has no `ber`, did you mean `bar`"},
        {.setting = {"bodis.bar.mass", "1"},
         .part = "the model has no `bodis`, did you mean `bodies`"},
        {.setting = {"bodies[1].mass", "1"}, .part = "`bodies` has 1 entry, the first is [0]"},
        {.setting = {"bodies.bar.mass.x", "1"}, .part = "`bodies[0].mass` is a single value"},
        {.setting = {"bodies.bar[0]", "1"}, .part = "`bodies[0]` has 3 entries"},
        {.setting = {"bodies.new", "1"}, .part = "`bodies` has no `new`"},
        {.setting = {"bodies..mass", "1"}, .part = "is no path: names or keys"},
        {.setting = {"bodies.", "1"}, .part = "is no path: names or keys"},
        {.setting = {".mass", "1"}, .part = "is no path: names or keys"},
        {.setting = {"bodies[", "1"}, .part = "is no path: names or keys"},
        {.setting = {"bodies[-1]", "1"}, .part = "is no path: names or keys"},
        {.setting = {"bodies[0]mass", "1"}, .part = "is no path: names or keys"},
        {.setting = {"bodies[99999999999]", "1"}, .part = "is no path: names or keys"},
        {.setting = {"bodies.bar.mass", ""}, .part = "is empty, must be a value"},
        {.setting = {"bodies.bar.mass", "[1"}, .part = "bodies.bar.mass:2:1: syntax error"},
        {.setting = {"bodies.bar.mass", "[1]"}, .part = "bodies[0].mass: is a list"},
        {.setting = {"analysis.method", "euler"}, .part = "analysis.method: is `euler`"},
        {.step = "-1", .part = "--step: is -1, must be finite and > 0"},
        {.step = "1e-16", .part = "--step: is 1e-16, must be at least 1e-15"},
        {.step = "1e-10", .duration = "0.01", .part = "--step: is 1e-10 s, which does not move"},
        {.duration = "x", .part = "--duration: `x`"},
        {.duration = "2e9", .part = "--duration: is 2e+09, must be at most 1e+09"},
        {.tolerance = "0.5", .part = "--tolerance: is 0.5, must be from 1e-14 to 0.1"},
        {.tolerance = "0", .part = "--tolerance: is 0, must be from 1e-14 to 0.1"},
        {.tolerance = "-1e-6", .part = "--tolerance: is -1e-06, must be from 1e-14 to 0.1"},
        {.tolerance = "1/0", .part = "--tolerance: `1/0`"},
        {.method = "euler", .part = "--method: is `euler`"},
        {.formulation = "rq", .part = "--formulation: is `rq`"},
        {.analysis = "kinematic", .part = "did you mean `kinematics`"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        se3d_model *model = NULL;
        se3d_model_error error;
        se3d_model_options options = se3d_model_options_default();
        options.settings = &cases[k].setting;
        options.setting_count = cases[k].setting.name != NULL;
        options.step = cases[k].step;
        options.duration = cases[k].duration;
        options.tolerance = cases[k].tolerance;
        options.method = cases[k].method;
        options.formulation = cases[k].formulation;
        options.analysis = cases[k].analysis;
        CHECK(se3d_model_read_text(text, strlen(text), "m.yaml", &options, &model, &error) ==
              SE3D_ERR_MODEL);
        CHECK_CONTAINS(error.message, cases[k].part);
        CHECK(cases[k].setting.name || error.line == 0); /* the file is not to blame */
        se3d_model_destroy(model);
    }
}

int main(void)
{
    RUN(every_bad_model_is_rejected_with_place_and_reason);
    RUN(every_mistake_is_reported_once);
    RUN(all_mistakes_of_a_draft_are_reported);
    RUN(equal_mistakes_of_different_things_are_all_reported);
    RUN(halves_of_an_expression_are_taken_out_with_each_other_only);
    RUN(a_report_ends_at_the_largest_number);
    RUN(options_are_checked_like_the_file);
    return check_finish();
}
