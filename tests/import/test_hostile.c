/* SPDX-License-Identifier: BSD-3-Clause */
/* Files of other formats that are malformed or meant to harm: each ends in one message that says
 * where and what, whatever memory there is. */
#include <stdlib.h>

#include "check.h"
#include "se3d/import.h"

#define ROBOT(x) "<robot name=\"r\">\n" x "</robot>"
#define LINKS    "<link name=\"a\"/><link name=\"b\"/>\n"
#define JOINT(x)                                                                                   \
    ROBOT(LINKS "<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/>" x    \
                "</joint>")

#define CHRONO(x) "chrono-version: 10.0\nmodel:\n " x
#define CHRONO_BODY(name)                                                                          \
    "bodies:\n  - {name: " name ", location: [0, 0, 0], mass: 1, inertia: {moments: [1, 1, 1]}}\n"
#define MOTOR(function)                                                                            \
    CHRONO(CHRONO_BODY(                                                                            \
        "a") "  - {name: b, location: [0, 0, 0], fixed: true}\n motors:\n  - {name: m, "           \
             "type: LINEAR, body1: a, body2: b, location: [0, 0, 0], axis: [1, 0, 0], "            \
             "actuation_type: SPEED, actuation_function: " function "}\n")

#define SDF(x) "<sdf version=\"1.10\">\n<model name=\"m\"><link name=\"a\"/>" x "</model></sdf>"
#define SDF_JOINT(type, x)                                                                         \
    SDF("\n<joint name=\"j\" type=\"" type "\"><parent>world</parent><child>a</child>" x "</"      \
        "joint>")

#define SDF_SHAPE(x)                                                                               \
    SDF("<link name=\"b\">\n<visual name=\"v\"><geometry>" x "</geometry></visual></link>")

#define MUJOCO(x) "<mujoco><worldbody><body>" x "</body></worldbody></mujoco>"

#define MDL(x)                                                                                     \
    "{\"constraints\": [], \"bodies\": [{\"id\": 1, \"mass\": 1, \"jbar\": [1, 1, 1]}],\n" x "}\n"

typedef struct bad_file {
    const char *name, *text;
    size_t line;
    const char *parts[2];
} bad_file;

static const bad_file table[] = {
    {"a.urdf", "", 0, {"no format that is known", NULL}},
    {"a.urdf", "  \n", 0, {"no format that is known", NULL}},
    {"a.txt", "hello", 0, {"no format that is known", NULL}},
    {"a.adm", "", 0, {"no PART that moves", NULL}},
    {"a.adm", "title\nPART/1, GROUND\n", 0, {"no PART that moves", NULL}},
    {"a.adm", "title\n\nTHING/1\n", 3, {"THING/1", "no statement"}},
    {"a.adm", "title\nPART/2, MASS=1\nPART/2\n", 3, {"PART/2", "twice"}},
    {"a.adm", "title\nPART/2, MASS=x\n", 2, {"MASS = x", "numbers"}},
    {"a.adm", "title\nPART/2, QG=1,2,3,4\n", 2, {"QG", "at most 3"}},
    {"a.adm", "title\nPART/2, CM=7\n", 2, {"CM", "MARKER"}},
    {"a.adm", "title\nMARKER/2\n", 2, {"on no PART", NULL}},
    {"a.adm", "title\nPART/2, MASS=1, ZG=0,0,0\n", 2, {"give no axes", NULL}},
    {"a.adm", "title\nUNITS/LENGTH=ELL\n", 2, {"ELL", "not known"}},
    {"a.adm", "title\nUNITS/SYSTEM=ELL\n", 2, {"ELL", "not known"}},
    {"a.adm", "title\nUNITS/FORCE=ELL\n", 2, {"ELL", "not known"}},
    {"a.adm", "title\nUNITS/MASS=ELL\n", 2, {"ELL", "not known"}},
    {"a.adm", "title\nUNITS/TIME=ELL\n", 2, {"ELL", "not known"}},
    {"a.adm", "title\nPART/2\nJOINT/1, REVOLUTE, I=1, J=2\n", 3, {"JOINT/1", "MARKER"}},
    {"a.adm", "title\nPART/2\nMARKER/1\nJOINT/1, REVOLUTE, I=1, J=1\n", 4, {"one part", NULL}},
    {"a.adm", "title\nPART/2\nMOTION/1, JOINT=7, FUNCTION=1\n", 3, {"no JOINT/7", NULL}},
    {"a.mdl",
     MDL("\"TSDAs\": [{\"bodyi\": \"1\", \"bodyj\": \"0\", \"l0\": -1}]"),
     2,
     {"number >= 0", NULL}},
    {"a.mdl", "{\"constraints\": [], \"bodies\": [7]}", 1, {"a body", NULL}},
    {"a.mdl", "{\"constraints\": [], \"bodies\": 7}", 1, {"list", NULL}},
    {"a.mdl", "{\"constraints\": [7], \"bodies\": []}", 1, {"a constraint", NULL}},
    {"a.mdl", "{\"constraints\": 7, \"bodies\": []}", 1, {"list", NULL}},
    {"a.mdl", MDL("\"gravity\": [1, 2]"), 2, {"3 numbers", NULL}},
    {"a.mdl", MDL("\"gravity\": \"down\""), 2, {"3 numbers", NULL}},
    {"a.mdl",
     "{\"constraints\": [], \"bodies\": [{\"id\": 1, \"mass\": 1, \"jbar\": [1, 1, 1],\n"
     "\"q0\": [0, 0, 0, 0, 0, 0, 0]}]}",
     1,
     {"the Euler parameters of `body1` are 0", NULL}},
    {"a.mdl",
     MDL("\"simulation\": {\"tend\": 1, \"outputSteps\": 1e9}"),
     2,
     {"at most 1e8 rows", NULL}},
    {"a.yaml", "se3d: 1\n", 1, {"model file already", NULL}},
    {"a.yaml", "a: 1\n", 1, {"chrono-version", NULL}},
    {"a.yaml", "a: [1\n", 0, {"a.yaml", NULL}},
    {"a.yaml", "chrono-version: 10.0\n", 1, {"no key `model`", NULL}},
    {"a.yaml", "chrono-version: 10.0\nmodel: [1]\n", 2, {"must be a map", NULL}},
    {"a.yaml", "chrono-version: 10.0\ntype: FSI\nmodel: b.yaml\n", 2, {"FSI", "MBS"}},
    {"a.yaml", "chrono-version: 10.0\ntype: MBS\nmodel: none.yaml\n", 0, {"none.yaml", NULL}},
    {"a.yaml", CHRONO("bodies: 7\n"), 3, {"must be a list", NULL}},
    {"a.yaml", CHRONO("bodies:\n  - 7\n"), 4, {"no key `name`", NULL}},
    {"a.yaml", CHRONO("bodies:\n  - {name: a}\n"), 4, {"no key `location`", NULL}},
    {"a.yaml", CHRONO("bodies:\n  - {name: a, location: [0, 0]}\n"), 4, {"3 numbers", NULL}},
    {"a.yaml",
     CHRONO("bodies:\n  - {name: a, location: [0, 0, 0], fixed: perhaps}\n"),
     4,
     {"true or false", NULL}},
    {"a.yaml",
     CHRONO("bodies:\n  - {name: a, location: [0, 0, 0], orientation: [0, 0, 0, 0], mass: 1}\n"),
     4,
     {"Euler parameters that are not 0", NULL}},
    {"a.yaml",
     CHRONO(CHRONO_BODY("a") " joints:\n  - {name: j, type: REVOLUTE, location: [0, 0, 0], axis: "
                             "[0, 0, 0], body1: a, body2: a}\n"),
     6,
     {"a direction that is not 0", NULL}},
    {"a.yaml", MOTOR("[1]"), 7, {"no key `type`", NULL}},
    {"a.yaml", MOTOR("{type: POLYNOMIAL, coefficients: 7}"), 7, {"1 to 9 numbers", NULL}},
    {"a.yaml", MOTOR("{type: POLYNOMIAL, coefficients: []}"), 7, {"1 to 9 numbers", NULL}},
    {"a.yaml", MOTOR("{type: DATA, data: 7}"), 7, {"list", NULL}},
    {"a.yaml", MOTOR("{type: DATA, data: [[0, 1], [2]]}"), 7, {"must be two numbers", NULL}},
    {"a.yaml", MOTOR("{type: DATA, data: [[0, 1], 2]}"), 7, {"must be two numbers", NULL}},
    {"a.yaml", CHRONO("bodies:\n  - {name: a, location: [0, 0, 1e99]}\n"), 4, {"number", NULL}},
    {"a.yaml", CHRONO("bodies:\n  - {name: a, location: [0, 0, 0]}\n"), 4, {"no key `mass`", NULL}},
    {"a.yaml",
     CHRONO(CHRONO_BODY("a") "  - {name: a, location: [0, 0, 0], fixed: true}\n"),
     5,
     {"two bodies `a`", NULL}},
    {"a.yaml",
     CHRONO(CHRONO_BODY("a") " joints:\n  - {name: j, type: HINGE}\n"),
     6,
     {"HINGE", "REVOLUTE"}},
    {"a.yaml",
     CHRONO(
         CHRONO_BODY("a") " joints:\n  - {name: j, type: LOCK, location: [0, 0, 0], body1: z}\n"),
     6,
     {"no body `z`", NULL}},
    {"a.yaml", MOTOR("{type: COSINE}"), 7, {"COSINE", "SINE"}},
    {"a.yaml", MOTOR("{type: DATA, data: [[0, 1], [0, 2]]}"), 7, {"ascending", NULL}},
    {"a.yaml", MOTOR("{type: DATA, data: []}"), 7, {"no point", NULL}},
    {"a.yaml", MOTOR("{type: RAMP, slope: 1, repeat: {width: 0}}"), 7, {"width", NULL}},
#if defined(SE3D_HAS_EXPAT)
    {"a.urdf", "<robot>", 1, {"no valid XML", NULL}},
    {"a.urdf", "<robot></robots>", 1, {"no valid XML", "mismatched"}},
    {"a.urdf", "<robot/><robot/>", 1, {"no valid XML", NULL}},
    {"a.urdf", "<html/>", 1, {"<html>", "<robot>"}},
    {"a.sdf", "<sdf/>", 1, {"no <model>", NULL}},
    {"a.sdf", "<sdf><model/></sdf>", 1, {"<model> has no `name`", NULL}},
    {"a.sdf", "<sdf><model name=\"m\"/></sdf>", 1, {"no <link>", NULL}},
    {"a.sdf", "<sdf><world>\n<include/></world></sdf>", 2, {"<include>", "not followed"}},
    {"a.sdf", SDF("\n<include/>"), 3, {"<include>", "gz sdf -p"}},
    {"a.sdf", SDF("\n<model name=\"n\"/>"), 3, {"a model in a model", "`m`"}},
    {"a.sdf", SDF("\n<link name=\"a\"/>"), 3, {"`a` is taken", NULL}},
    {"a.sdf", SDF("\n<link name=\"world\"/>"), 3, {"`world` is taken", NULL}},
    {"a.sdf", SDF("\n<frame name=\"__x\"/>"), 3, {"`__x` is taken", NULL}},
    {"a.sdf", SDF("\n<link name=\"b\"><pose>1 2</pose></link>"), 3, {"6 numbers", NULL}},
    {"a.sdf",
     SDF("<link name=\"b\">\n<pose rotation_format=\"x\">1</pose></link>"),
     3,
     {"quat_xyzw", NULL}},
    {"a.sdf",
     SDF("<link name=\"b\">\n<pose rotation_format=\"quat_xyzw\">1 2 3 0 0 0 0</pose></link>"),
     3,
     {"no length", NULL}},
    {"a.sdf",
     SDF("\n<frame name=\"f\"><pose relative_to=\"g\"/></frame>"),
     3,
     {"no link, joint or frame `g`", NULL}},
    {"a.sdf",
     SDF("\n<frame name=\"f\"><pose relative_to=\"n::g\"/></frame>"),
     3,
     {"`n::g`", "nested"}},
    {"a.sdf",
     SDF("\n<frame name=\"f\"><pose relative_to=\"f\"/></frame>"),
     3,
     {"`f` is relative to itself", NULL}},
    {"a.sdf",
     SDF("\n<frame name=\"f\" attached_to=\"g\"/><frame name=\"g\" attached_to=\"f\"/>"),
     3,
     {"in a circle", NULL}},
    {"a.sdf",
     SDF("\n<frame name=\"f\" attached_to=\"g\"><pose relative_to=\"a\"/></frame><frame name=\"g\" "
         "attached_to=\"f\"><pose relative_to=\"a\"/></frame>"),
     3,
     {"attached to itself", NULL}},
    {"a.sdf",
     SDF("<link name=\"b\">\n<inertial><mass>-1</mass></inertial></link>"),
     3,
     {"-1 kg", "negative"}},
    {"a.sdf",
     SDF("<link name=\"b\">\n<inertial><mass>x</mass></inertial></link>"),
     3,
     {"1 number", NULL}},
    {"a.sdf", SDF_JOINT("hinge", ""), 3, {"hinge", "revolute"}},
    {"a.sdf", SDF_JOINT("revolute", ""), 3, {"no <axis>", NULL}},
    {"a.sdf", SDF_JOINT("revolute", "<axis><xyz>0 0 0</xyz></axis>"), 3, {"axis", "zero"}},
    {"a.sdf",
     SDF_JOINT("revolute", "<axis><xyz expressed_in=\"q\">0 0 1</xyz></axis>"),
     3,
     {"`q`", NULL}},
    {"a.sdf",
     SDF_JOINT("revolute", "<axis><limit><lower>low</lower></limit></axis>"),
     3,
     {"1 number", NULL}},
    {"a.sdf",
     SDF_JOINT("revolute", "<axis><mimic joint=\"k\"/></axis>"),
     3,
     {"no joint `k`", NULL}},
    {"a.sdf", SDF_JOINT("universal", "<axis/>"), 3, {"no <axis2>", NULL}},
    {"a.sdf",
     SDF_JOINT("screw",
               "<axis/><thread_pitch>inf</thread_pitch><screw_thread_pitch>0</screw_thread_pitch>"),
     3,
     {"pitch", NULL}},
    {"a.sdf",
     SDF_JOINT("screw", "<axis/><thread_pitch>0</thread_pitch>"),
     3,
     {"the pitch of `j` is 0", NULL}},
    {"a.sdf",
     SDF("\n<joint name=\"j\" type=\"fixed\"><child>a</child></joint>"),
     3,
     {"no <parent>", NULL}},
    {"a.sdf",
     SDF("\n<joint name=\"j\" type=\"fixed\"><parent>a</parent></joint>"),
     3,
     {"no <child>", NULL}},
    {"a.sdf",
     SDF("\n<joint name=\"j\" type=\"fixed\"><parent>a</parent><child>world</child></joint>"),
     3,
     {"child", "is the world"}},
    {"a.sdf",
     SDF("\n<joint name=\"j\" type=\"fixed\"><parent>b</parent><child>a</child></joint>"),
     3,
     {"`b`", NULL}},
    {"a.sdf",
     "<sdf><model name=\"m\" canonical_link=\"z\"><link name=\"a\"/></model></sdf>",
     1,
     {"`z`", NULL}},
    {"a.sdf",
     "<sdf><model name=\"m\"><pose relative_to=\"z\"/><link name=\"a\"/></model></sdf>",
     1,
     {"`z`", "world"}},
    {"a.sdf",
     "<sdf><world><gravity>1</gravity><model name=\"m\"/></world></sdf>",
     1,
     {"3 numbers", NULL}},
    {"a.sdf", SDF_SHAPE("<box><size>1 2</size></box>"), 3, {"3 numbers", NULL}},
    {"a.sdf", SDF_SHAPE("<sphere><radius>r</radius></sphere>"), 3, {"1 number", NULL}},
    {"a.sdf", SDF_SHAPE("<cylinder><length>l</length></cylinder>"), 3, {"1 number", NULL}},
    {"a.sdf", SDF_SHAPE("<ellipsoid><radii>1</radii></ellipsoid>"), 3, {"3 numbers", NULL}},
    {"a.sdf", SDF_SHAPE("<plane><normal>up</normal></plane>"), 3, {"3 numbers", NULL}},
    {"a.sdf", SDF_SHAPE("<mesh/>"), 3, {"<mesh> has no <uri>", NULL}},
    {"a.sdf", SDF_SHAPE("<mesh><uri/></mesh>"), 3, {"<mesh> has no <uri>", NULL}},
    {"a.sdf", SDF_SHAPE("<mesh><uri>a</uri><scale>1</scale></mesh>"), 3, {"3 numbers", NULL}},
    {"a.sdf",
     SDF("<link name=\"b\">\n<inertial><inertia><ixx>i</ixx></inertia></inertial></link>"),
     3,
     {"1 number", NULL}},
    {"a.sdf",
     SDF_JOINT("revolute", "<axis><dynamics><damping>d</damping></dynamics></axis>"),
     3,
     {"1 number", NULL}},
    {"a.sdf",
     SDF_JOINT("revolute", "<axis><dynamics><friction>f</friction></dynamics></axis>"),
     3,
     {"1 number", NULL}},
    {"a.sdf",
     SDF_JOINT("revolute",
               "<axis><dynamics><spring_stiffness>k</spring_stiffness></dynamics></axis>"),
     3,
     {"1 number", NULL}},
    {"a.sdf",
     SDF_JOINT("revolute",
               "<axis><dynamics><spring_reference>q</spring_reference></dynamics></axis>"),
     3,
     {"1 number", NULL}},
    {"a.sdf",
     SDF_JOINT("screw", "<axis/><screw_thread_pitch>p</screw_thread_pitch>"),
     3,
     {"1 number", NULL}},
    {"a.sdf", SDF_JOINT("screw", "<axis/><thread_pitch>p</thread_pitch>"), 3, {"1 number", NULL}},
    {"a.sdf",
     SDF_JOINT("universal", "<axis/><axis2><xyz>0 0 0</xyz></axis2>"),
     3,
     {"axis", "zero"}},
    {"a.sdf",
     SDF_JOINT("revolute2", "<axis/><axis2><limit><upper>u</upper></limit></axis2>"),
     3,
     {"1 number", NULL}},
    {"a.xml", "<mujoco/>", 1, {"no <body>", NULL}},
    {"a.xml", "<mujoco><include file=\"none.xml\"/></mujoco>", 0, {"none.xml", NULL}},
    {"a.xml", "<mujoco><include/></mujoco>", 1, {"file", NULL}},
    {"a.xml", "<mujoco><compiler eulerseq=\"abc\"/></mujoco>", 1, {"eulerseq", NULL}},
    {"a.xml", "<mujoco><compiler coordinate=\"global\"/></mujoco>", 1, {"coordinate", "local"}},
    {"a.xml", MUJOCO("<joint type=\"screw\"/>"), 1, {"screw", "hinge"}},
    {"a.xml", MUJOCO("<joint axis=\"0 0 0\"/>"), 1, {"axis", "zero"}},
    {"a.xml", MUJOCO("<joint axis=\"0 0 nan\"/>"), 1, {"axis", "numbers"}},
    {"a.xml", MUJOCO("<inertial pos=\"0 0 0\"/>"), 1, {"mass", NULL}},
    {"a.xml", MUJOCO("<inertial pos=\"0 0 0\" mass=\"1\"/>"), 1, {"diaginertia", NULL}},
    {"a.xml", MUJOCO("<geom quat=\"0 0 0 0\"/>"), 1, {"quat", NULL}},
    {"a.xml", MUJOCO("<geom fromto=\"0 0 0 0 0 0\"/>"), 1, {"fromto", NULL}},
    {"a.xml",
     "<mujoco><worldbody><body/></worldbody><equality><connect body1=\"z\"/></equality></mujoco>",
     1,
     {"no `z`", NULL}},
    {"a.urdf", "<robot/>", 1, {"no <link>", NULL}},
    {"a.urdf", JOINT("<origin xyz=\"0 0 0\" quat_xyzw=\"1 0\"/>"), 3, {"must be 4 numbers", NULL}},
    {"a.urdf", JOINT("<dynamics friction=\"f\"/>"), 3, {"friction", "must be 1 number"}},
    {"a.urdf", JOINT("<dynamics damping=\"d\"/>"), 3, {"damping", "must be 1 number"}},
    {"a.urdf", JOINT("<limit upper=\"up\"/>"), 3, {"upper", "must be 1 number"}},
    {"a.urdf", JOINT("<mimic/>"), 3, {"<mimic> has no `joint`", NULL}},
    {"a.urdf", JOINT("<mimic joint=\"j\" multiplier=\"m\"/>"), 3, {"multiplier", NULL}},
    {"a.urdf", JOINT("<mimic joint=\"j\" offset=\"o\"/>"), 3, {"offset", NULL}},
    {"a.urdf",
     ROBOT("<link name=\"a\"><visual><geometry>\n<box size=\"1 2\"/></geometry></visual></link>"),
     3,
     {"size", "3 numbers"}},
    {"a.urdf",
     ROBOT("<link name=\"a\"><visual><geometry>\n<cylinder length=\"l\"/></geometry></visual>"
           "</link>"),
     3,
     {"1 number", NULL}},
    {"a.urdf",
     ROBOT("<link name=\"a\"><visual><geometry>\n<mesh filename=\"a.stl\" scale=\"1\"/>"
           "</geometry></visual></link>"),
     3,
     {"scale", "3 numbers"}},
    {"a.urdf",
     "<!DOCTYPE r [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;&a;\">]>\n<robot name=\"&b;\"/>",
     1,
     {"entities are not allowed", NULL}},
    {"a.urdf",
     "<!DOCTYPE r [<!ENTITY x SYSTEM \"file:///etc/passwd\">]>\n<robot>&x;</robot>",
     1,
     {"entities are not allowed", NULL}},
    {"a.urdf",
     "<!DOCTYPE r [<!ENTITY % p \"x\"> %p;]>\n<robot/>",
     1,
     {"entities are not allowed", NULL}},
    {"a.urdf", ROBOT("<link/>"), 2, {"<link> has no `name`", NULL}},
    {"a.urdf", ROBOT("<link name=\"a\"/>\n<link name=\"a\"/>"), 3, {"two links `a`", NULL}},
    {"a.urdf", ROBOT("<xacro:macro name=\"a\"/>"), 2, {"expand", NULL}},
    {"a.urdf",
     "<robot xmlns:xacro=\"x\"><link name=\"a\"/>\n<xacro:macro name=\"a\"/></robot>",
     2,
     {"xacro:macro", "expand"}},
    {"a.urdf", ROBOT(LINKS "<joint name=\"j\"/>"), 3, {"<joint> has no `type`", NULL}},
    {"a.urdf", ROBOT(LINKS "<joint name=\"j\" type=\"hinge\"/>"), 3, {"hinge", "revolute"}},
    {"a.urdf", ROBOT(LINKS "<joint name=\"j\" type=\"fixed\"/>"), 3, {"no <parent>", NULL}},
    {"a.urdf",
     ROBOT(LINKS "<joint name=\"j\" type=\"fixed\"><parent link=\"c\"/></joint>"),
     3,
     {"no link `c`", NULL}},
    {"a.urdf", JOINT("<axis xyz=\"0 0 0\"/>"), 3, {"axis", "zero"}},
    {"a.urdf", JOINT("<axis xyz=\"1 0\"/>"), 3, {"must be 3 numbers", NULL}},
    {"a.urdf", JOINT("<axis xyz=\"1 0 nan\"/>"), 3, {"must be 3 numbers", NULL}},
    {"a.urdf", JOINT("<axis xyz=\"1 0 1e999\"/>"), 3, {"must be 3 numbers", NULL}},
    {"a.urdf", JOINT("<axis xyz=\"1 0 0x10\"/>"), 3, {"must be 3 numbers", NULL}},
    {"a.urdf", JOINT("<origin xyz=\"1,0,0\"/>"), 3, {"must be 3 numbers", NULL}},
    {"a.urdf", JOINT("<origin quat_xyzw=\"0 0 0 0\"/>"), 3, {"quat_xyzw", NULL}},
    {"a.urdf", JOINT("<limit lower=\"low\"/>"), 3, {"lower", "must be 1 number"}},
    {"a.urdf", JOINT("<mimic joint=\"k\"/>"), 3, {"no joint `k`", NULL}},
    {"a.urdf", JOINT("<mimic joint=\"j\"/>"), 3, {"mimics itself", NULL}},
    {"a.urdf",
     ROBOT("<link name=\"a\"><inertial><mass value=\"-1\"/></inertial></link>"),
     2,
     {"-1 kg", "negative"}},
    {"a.urdf",
     ROBOT(LINKS
           "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>"
           "<joint name=\"k\" type=\"fixed\"><parent link=\"b\"/><child link=\"a\"/></joint>"),
     3,
     {"circle", NULL}},
    {"a.urdf",
     ROBOT(LINKS
           "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>\n"
           "<joint name=\"k\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>"),
     4,
     {"child of two joints", NULL}},
#else
    {"a.urdf", "<robot/>", 0, {"expat", NULL}},
#endif
};

static void every_bad_file_gets_a_message(void)
{
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        const bad_file *bad = &table[k];
        se3d_model_import *import = NULL;
        se3d_model_error error;
        const se3d_status status =
            se3d_model_import_text(bad->text, strlen(bad->text), bad->name, NULL, &import, &error);
        if (status != SE3D_ERR_MODEL || import) {
            fprintf(stderr, "row %zu was taken: %s\n", k, bad->text);
        }
        CHECK(status == SE3D_ERR_MODEL && !import);
        CHECK(bad->line == 0 || error.line == bad->line);
        for (int p = 0; p < 2 && bad->parts[p]; ++p) {
            if (!strstr(error.message, bad->parts[p])) {
                fprintf(stderr, "row %zu: `%s` lacks `%s`\n", k, error.message, bad->parts[p]);
            }
            CHECK(strstr(error.message, bad->parts[p]) != NULL);
        }
    }
}

#define CRANK                                                                                      \
    "title\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n"  \
    "MARKER/3, PART=2\nJOINT/1, REVOLUTE, I=3, J=1\n"
#define MOTION(x) CRANK "MOTION/1, ROTATIONAL, JOINT=1, FUNCTION=" x "\n"
#define BODY(mass, ixx, more)                                                                      \
    "<link name=\"time\"><inertial><mass value=\"" mass "\"/><inertia ixx=\"" ixx                  \
    "\" iyy=\"1\" izz=\"1\"/></inertial>" more "</link>"
#define ARM(body, more)                                                                            \
    ROBOT("<link name=\"ground\"/>" body                                                           \
          "<joint name=\"time\" type=\"revolute\"><parent link=\"ground\"/>"                       \
          "<child link=\"time\"/>" more "</joint>")

/* Files that are strange, and how much of each is not carried: what is made of them can be read. */
typedef struct strange_file {
    const char *name, *text;
    size_t lost;
} strange_file;

static const strange_file strange[] = {
    {"a.adm", CRANK, 0},
    {"a.adm", "title\n!   adams_view_name='time'\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2\n", 0},
    {"a.adm", "title\nPART/2, MASS=1e-300, CM=2, IP=1e-300,1,1\nMARKER/2\n", 0},
    {"a.adm", MOTION("TIME"), 0},
    {"a.mdl", MDL("\"TSDAs\": [7]"), 1},
    {"a.yaml", MOTOR("{type: CONTROLLER}"), 0},
    {"a.adm", MOTION(""), 1},
    {"a.adm", MOTION("1+"), 1},
    {"a.adm", MOTION("1 2"), 1},
    {"a.adm", MOTION("1)"), 1},
    {"a.adm", MOTION("1/0"), 1},
    {"a.adm", MOTION("SQRT(-1)"), 1},
    {"a.adm", MOTION("2**99999"), 1},
    {"a.adm", MOTION("1E40*1E40"), 1},
    {"a.adm", MOTION("STEP(TIME,1,0,1,1)"), 1},
    {"a.adm", CRANK "SFORCE/1, ROTATIONAL, I=3, J=1, FUNCTION=AZ(3,1)*\n", 1},
    {"a.adm", CRANK "SFORCE/1, ROTATIONAL, I=3, J=1, FUNCTION=-AZ(3,1)-WZ(3,1)\n", 0},
    {"a.adm", CRANK "COUPLER/1, JOINTS=1,1, SCALES=1,-1\n", 1},
    {"a.adm", CRANK "JOINT/2, REVOLUTE, I=2, J=1\nCOUPLER/1, JOINTS=1,2, SCALES=0,1\n", 1},
    {"a.adm", CRANK "JOINT/2, SCREW, I=2, J=1, PITCH=0\n", 1},
    {"a.adm", CRANK "JOINT/2, TRANSLATIONAL, I=2, J=1\nJOINT/3, RACKPIN, I=3, J=1, PD=0\n", 1},
    {"a.adm", CRANK "SPRINGDAMPER/1, TRANSLATION, I=3, J=1, K=1, LENGTH=-1\n", 1},
    {"a.adm", CRANK "GRAPHICS/1, BOX, CORNER=3, X=1e20, Y=1e-3, Z=1\n", 0},
    {"a.adm", CRANK "MOTION/1, ROTATIONAL, JOINT=1, FUNCTION=1, ICDISP=0.5\n", 0},
    {"a.adm", MOTION("30d*TIME"), 0},
    {"a.adm", MOTION("min(TIME,2)+MAX(TIME,0.5)"), 0},
    {"a.adm", MOTION("VARVAL(7)"), 1},
    {"a.adm", MOTION("VARVAL(x)"), 1},
    {"a.adm", MOTION("TIME#2"), 1},
#if defined(SE3D_HAS_EXPAT)
    {"a.sdf", SDF_SHAPE("<empty/>"), 0},
    {"a.sdf", SDF_SHAPE("<box><size>0 1 1</size></box>"), 1},
    {"a.sdf", SDF_SHAPE("<box><size>1 0 1</size></box>"), 1},
    {"a.sdf", SDF_SHAPE("<box><size>1 1 0</size></box>"), 1},
    {"a.sdf", SDF_SHAPE("<sphere><radius>0</radius></sphere>"), 1},
    {"a.sdf", SDF_SHAPE("<sphere><radius>1</radius></sphere>"), 0},
    {"a.sdf", SDF_SHAPE("<capsule><radius>1</radius><length>2</length></capsule>"), 0},
    {"a.sdf", SDF_SHAPE("<capsule><radius>1</radius><length>0</length></capsule>"), 1},
    {"a.sdf", SDF_SHAPE("<cylinder><radius>1</radius><length>2</length></cylinder>"), 0},
    {"a.sdf", SDF_SHAPE("<ellipsoid><radii>1 1 0</radii></ellipsoid>"), 1},
    {"a.sdf", SDF_SHAPE("<ellipsoid><radii>1 0 1</radii></ellipsoid>"), 1},
    {"a.sdf", SDF_SHAPE("<ellipsoid><radii>0 1 1</radii></ellipsoid>"), 1},
    {"a.sdf", SDF_SHAPE("<plane><normal>0 0 0</normal></plane>"), 1},
    {"a.sdf", SDF_SHAPE("<mesh><uri>none.stl</uri><submesh><name>a</name></submesh></mesh>"), 2},
    {"a.sdf", SDF_SHAPE("<heightmap><uri>a.png</uri></heightmap>"), 1},
    {"a.sdf", SDF("<link name=\"b\"><inertial auto=\"true\"><mass>1</mass></inertial></link>"), 1},
    {"a.sdf", SDF("<link name=\"b\"><inertial auto=\"1\"><mass>1</mass></inertial></link>"), 1},
    {"a.sdf", SDF("<link name=\"b\"><inertial auto=\"no\"><mass>1</mass></inertial></link>"), 0},
    {"a.sdf",
     SDF("<link name=\"b\"><velocity_decay><linear>0</linear><angular>0</angular></velocity_decay>"
         "</link>"),
     0},
    {"a.sdf",
     SDF("<link name=\"b\"><velocity_decay><linear>0</linear><angular>1</angular></velocity_decay>"
         "</link>"),
     1},
    {"a.sdf", SDF("<link name=\"b\"><gravity>false</gravity></link>"), 1},
    {"a.sdf", SDF("<link name=\"b\"><gravity>1</gravity></link>"), 0},
    {"a.sdf", SDF("<link name=\"b\"><kinematic>true</kinematic></link>"), 1},
    {"a.sdf", SDF("<link name=\"b\"><kinematic>0</kinematic></link>"), 0},
    {"a.sdf", SDF("<gripper name=\"g\"/>"), 1},
    {"a.sdf", SDF_JOINT("revolute", "<axis><limit><effort>5</effort></limit></axis>"), 0},
    {"a.sdf", SDF_JOINT("revolute", "<axis><limit><velocity>5</velocity></limit></axis>"), 0},
    {"a.sdf",
     SDF_JOINT("revolute",
               "<axis><limit><lower>-INF</lower><upper> infinity </upper></limit></axis>"),
     0},
    {"a.urdf", ARM(BODY("1", "1", ""), ""), 0},
    {"a.urdf", ARM(BODY("1e-300", "1e-300", ""), ""), 0},
    {"a.urdf",
     ARM(BODY("1", "1", "<visual><geometry><box size=\"1e20 1 1e-3\"/></geometry></visual>"), ""),
     0},
    {"a.urdf",
     ARM(BODY("1", "1", "<visual><geometry><sphere radius=\"1e-300\"/></geometry></visual>"), ""),
     1},
    {"a.urdf",
     ROBOT("<link name=\"a\"/>" BODY(
         "1", "1",
         "") "<link name=\"b\"/>"
             "<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"time\"/>"
             "<mimic joint=\"k\" multiplier=\"0\" offset=\"1\"/></joint>"
             "<joint name=\"k\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/></joint>"),
     0},
#endif
};

static void what_is_made_of_strange_files_can_be_read(void)
{
    for (size_t k = 0; k < sizeof strange / sizeof *strange; ++k) {
        const strange_file *file = &strange[k];
        se3d_model_import *import = NULL;
        se3d_model *model = NULL;
        se3d_model_error error;
        CHECK(se3d_model_import_text(file->text, strlen(file->text), file->name, NULL, &import,
                                     &error) == SE3D_OK);
        const char *text = se3d_model_import_get_text(import, NULL);
        const size_t lost = se3d_model_import_count_lost(import);
        const se3d_status status =
            se3d_model_read_text(text, strlen(text), "a.yaml", NULL, &model, &error);
        if (status < 0 || lost != file->lost) {
            fprintf(stderr, "row %zu, %zu lost: %s\n%s", k, lost, error.message, text);
        }
        CHECK(status == SE3D_OK);
        CHECK(lost == file->lost);
        se3d_model_destroy(model);
        se3d_model_import_destroy(import);
    }
}

#if defined(SE3D_HAS_EXPAT)
/* The comment of the joint has what the file has. */
static void only_bounds_that_are_given_are_told(void)
{
    static const struct {
        const char *name, *text, *comment;
    } rows[] = {
        {"a.sdf", SDF_JOINT("revolute", "<axis><limit><effort>5</effort></limit></axis>"),
         "# effort up to 5\n"},
        {"a.sdf", SDF_JOINT("revolute", "<axis><limit><velocity>3</velocity></limit></axis>"),
         "# rate up to 3\n"},
        {"a.sdf",
         SDF_JOINT("revolute",
                   "<axis><limit><effort>5</effort><velocity>3</velocity></limit></axis>"),
         "# effort up to 5, rate up to 3\n"},
        {"a.urdf", ARM(BODY("1", "1", ""), "<limit effort=\"5\"/>"), "# drive: at most 5 N m\n"},
        {"a.urdf", ARM(BODY("1", "1", ""), "<limit velocity=\"3\"/>"),
         "# drive: at most 3 rad/s\n"},
        {"a.urdf", ARM(BODY("1", "1", ""), "<limit effort=\"5\" velocity=\"3\"/>"),
         "# drive: at most 5 N m, 3 rad/s\n"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        se3d_model_import *import = NULL;
        CHECK(se3d_model_import_text(rows[k].text, strlen(rows[k].text), rows[k].name, NULL,
                                     &import, NULL) == SE3D_OK);
        CHECK_CONTAINS(se3d_model_import_get_text(import, NULL), rows[k].comment);
        se3d_model_import_destroy(import);
    }
}
#endif

/* Memory that ends after some allocations. */
typedef struct purse {
    size_t left;
} purse;

static void *take(void *ctx, size_t size)
{
    purse *p = ctx;
    return p->left > 0 ? (--p->left, malloc(size)) : NULL;
}

static void *retake(void *ctx, void *block, size_t old, size_t size)
{
    purse *p = ctx;
    (void)old;
    return p->left > 0 ? (--p->left, realloc(block, size)) : NULL;
}

static void give(void *ctx, void *block, size_t size)
{
    (void)ctx, (void)size;
    free(block);
}

static void sweep(const char *name)
{
    char path[1024];
    const char *source = getenv("SE3D_SOURCE_DIR");
    snprintf(path, sizeof path, "%s/tests/import/%s", source ? source : ".", name);
    se3d_status status = SE3D_ERR_NO_MEMORY;
    size_t allowed = 0;
    while (status == SE3D_ERR_NO_MEMORY && allowed < 100000) {
        purse p = {allowed++};
        const se3d_allocator allocator = {take, retake, give, &p};
        se3d_model_import_options how = se3d_model_import_options_default();
        se3d_model_import *import = NULL;
        se3d_model_error error;
        how.allocator = &allocator;
        status = se3d_model_import_file(path, &how, &import, &error);
        CHECK((status >= 0) == (import != NULL));
        CHECK(status >= 0 || strstr(error.message, "out of memory"));
        se3d_model_import_destroy(import);
    }
    CHECK(status == SE3D_OK);
    CHECK(allowed > 2);
}

static void memory_may_end_anywhere(void)
{
    sweep("crank.adm");
#if defined(SE3D_HAS_EXPAT)
    sweep("arm.urdf");
#endif
}

#if defined(SE3D_HAS_EXPAT)
static void depth_and_number_of_elements_are_bounded(void)
{
    enum { DEPTH = 100000 };
    char *text = malloc(3 * DEPTH + 100);
    se3d_model_import *import = NULL;
    se3d_model_error error;
    CHECK(text != NULL);
    for (size_t k = 0; k < DEPTH; ++k) {
        memcpy(text + 3 * k, "<a>", 4);
    }
    CHECK(se3d_model_import_text(text, 3 * DEPTH, "a.urdf", NULL, &import, &error) ==
          SE3D_ERR_MODEL);
    CHECK(strstr(error.message, "deeper than 64") != NULL);
    strcpy(text, "<a>");
    for (size_t k = 1; k < 3 * DEPTH / 4; ++k) {
        memcpy(text + 4 * k - 1, "<b/>", 5);
    }
    CHECK(se3d_model_import_text(text, strlen(text), "a.urdf", NULL, &import, &error) ==
          SE3D_ERR_MODEL);
    CHECK(strstr(error.message, "no valid XML") != NULL); /* 75,000 are fine, but not closed */
    free(text);
}
#endif

static void what_was_imported_can_be_asked(void)
{
#if defined(SE3D_HAS_EXPAT)
    static const char text[] = ROBOT(
        "<link name=\"a.b\"/><link name=\"c\"><inertial><mass value=\"1\"/></inertial>"
        "<visual><geometry><mesh filename=\"none.dae\"/></geometry></visual></link>"
        "<joint name=\"j\" type=\"revolute\"><parent link=\"a.b\"/><child link=\"c\"/></joint>");
    se3d_model_import *import = NULL;
    se3d_model_import_note note;
    se3d_model *model = NULL;
    size_t length = 0;
    CHECK(se3d_model_import_text(text, strlen(text), "x/a.urdf", NULL, &import, NULL) == SE3D_OK);
    CHECK(strcmp(se3d_model_import_get_format(import), "URDF") == 0);
    CHECK(se3d_model_import_count_lost(import) == 1);
    CHECK(se3d_model_import_count_notes(import) == 3);
    CHECK(se3d_model_import_get_note(import, 0, &note) == SE3D_OK);
    CHECK(note.kind == SE3D_IMPORT_LOST && note.line == 2 && strstr(note.message, "assimp"));
    CHECK(se3d_model_import_get_note(import, 3, &note) == SE3D_ERR_INVALID_ARGUMENT);
    const char *made = se3d_model_import_get_text(import, &length);
    CHECK(strlen(made) == length);
    CHECK(se3d_model_read_text(made, length, "a.yaml", NULL, &model, NULL) == SE3D_OK);
    se3d_model_destroy(model);
    se3d_model_import_destroy(import);
#endif
}

static void arguments_are_checked(void)
{
    se3d_model_import *import = NULL;
    se3d_model_import_note note;
    se3d_model_error error;
    se3d_model_import_options how = {.struct_size = 3};
    CHECK(se3d_model_import_text(NULL, 0, "a", NULL, &import, &error) == SE3D_ERR_NULL);
    CHECK(se3d_model_import_text("", 0, NULL, NULL, &import, &error) == SE3D_ERR_NULL);
    CHECK(se3d_model_import_text("", 0, "a", NULL, NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_model_import_text("", 0, "a", &how, &import, &error) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_model_import_file(NULL, NULL, &import, &error) == SE3D_ERR_NULL);
    CHECK(se3d_model_import_file("/none", NULL, &import, &error) == SE3D_ERR_IO);
    CHECK(se3d_model_import_file("/", NULL, &import, &error) == SE3D_ERR_IO);
    CHECK(se3d_model_import_file("a", &how, &import, &error) == SE3D_ERR_INVALID_ARGUMENT);
    how = se3d_model_import_options_default();
    how.format = "dwg";
    CHECK(se3d_model_import_text("<a/>", 4, "a", &how, &import, &error) == SE3D_ERR_MODEL);
    CHECK(strstr(error.message, "`dwg` is not known") != NULL);
    CHECK(se3d_model_import_get_note(NULL, 0, &note) == SE3D_ERR_NULL);
    CHECK(se3d_model_import_count_notes(NULL) == 0 && se3d_model_import_count_lost(NULL) == 0);
    CHECK(se3d_model_import_get_text(NULL, NULL)[0] == '\0');
    CHECK(se3d_model_import_get_format(NULL)[0] == '\0');
    se3d_model_import_destroy(NULL);
}

int main(void)
{
    RUN(every_bad_file_gets_a_message);
    RUN(what_is_made_of_strange_files_can_be_read);
#if defined(SE3D_HAS_EXPAT)
    RUN(only_bounds_that_are_given_are_told);
#endif
    RUN(memory_may_end_anywhere);
#if defined(SE3D_HAS_EXPAT)
    RUN(depth_and_number_of_elements_are_bounded);
#endif
    RUN(what_was_imported_can_be_asked);
    RUN(arguments_are_checked);
    return check_finish();
}
