/* SPDX-License-Identifier: BSD-3-Clause */
/* What an import cannot carry, or carries in another way, is noted with its line and the reason;
 * the rest of the model can be read. */
#include "check.h"
#include "se3d/import.h"

/* What goes on has line 8. */
#define CRANK                                                                                      \
    "title\nPART/1, GROUND\nMARKER/1, PART=1\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n"  \
    "MARKER/3, PART=2\nJOINT/1, REVOLUTE, I=3, J=1\n"
/* A second part, with the joint 2; what goes on has line 12. */
#define ARM                                                                                        \
    CRANK "PART/3, MASS=1, CM=4, IP=1,1,1\nMARKER/4, PART=3\nMARKER/5, PART=3, QP=1,0,0\n"         \
          "JOINT/2, TRANSLATIONAL, I=4, J=2\n"
#define MOTION(x) CRANK "MOTION/1, ROTATIONAL, JOINT=1, FUNCTION=" x "\n"
#define PULL(x)   ARM "SFORCE/1, TRANSLATION, I=4, J=2, FUNCTION=" x "\n"

#define MDL(x)                                                                                     \
    "{\"bodies\": [{\"id\": 1, \"mass\": 1, \"jbar\": [1, 1, 1]}, {\"id\": 2, \"mass\": 1, "       \
    "\"jbar\": [1, 1, 1]}], \"constraints\": [],\n" x "}\n"
#define CHRONO(x)                                                                                  \
    "chrono-version: 10.0\nmodel:\n bodies:\n  - {name: a, location: [0, 0, 0], mass: 1, "         \
    "inertia: {moments: [1, 1, 1]}}\n" x

#define WEIGHT "<inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial>"
#define ROBOT(x)                                                                                   \
    "<robot name=\"r\"><link name=\"a\"/><link name=\"b\">" WEIGHT                                 \
    "</link><joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/>"         \
    "</joint>\n" x "</robot>"

#define SDF_LINK(name, x)                                                                          \
    "<link name=\"" name "\"><inertial><mass>1</mass>\n<inertia><ixx>1</ixx><iyy>1</iyy>"          \
    "<izz>1</izz></inertia></inertial>" x "</link>"
#define SDF(x) "<sdf version=\"1.10\"><model name=\"m\">" SDF_LINK("a", "") x "</model></sdf>"
#define SDF_JOINT(name, type, parent, child, x)                                                    \
    "<joint name=\"" name "\" type=\"" type "\"><parent>" parent "</parent><child>" child          \
    "</child>" x "</joint>"

#define GEOM            "<geom type=\"sphere\" size=\"0.1\"/>"
#define BODY(x)         "<body name=\"a\">" GEOM x "</body>"
#define MUJOCO(body, x) "<mujoco><worldbody>" BODY(body) "</worldbody>\n" x "</mujoco>"

typedef struct noted {
    const char *name, *text;
    size_t line; /* 0: none, or that of a file within */
    se3d_model_import_note_kind kind;
    const char *part; /* of the message */
    const char *made; /* what the model has instead; NULL: nothing to look for */
    int merges;       /* links on fixed joints are one body */
} noted;

static const noted adams[] = {
    {"a.adm", ARM "SFORCE/1, TRANSLATION, I=4, J=2\n", 12, SE3D_IMPORT_LOST, "it has no FUNCTION",
     NULL, 0},
    {"a.adm", CRANK "SFORCE/1, TRANSLATION, I=3, J=2, FUNCTION=1\n", 8, SE3D_IMPORT_LOST,
     "acts on one part only", NULL, 0},
    {"a.adm", CRANK "SFORCE/1, TRANSLATION, ACTIONONLY, I=3, J=1, FUNCTION=1\n", 8,
     SE3D_IMPORT_LOST, "acts on one part only", NULL, 0},
    {"a.adm", CRANK "SPRINGDAMPER/1, TRANSLATION, I=3, J=2, K=1\n", 8, SE3D_IMPORT_LOST,
     "both markers are on one part", NULL, 0},
    {"a.adm", CRANK "SPRINGDAMPER/1, TRANSLATION, I=3, J=1, K=1, LENGTH=-1\n", 8, SE3D_IMPORT_LOST,
     "its LENGTH is negative", NULL, 0},
    {"a.adm", CRANK "BUSHING/1, I=3, J=2, K=1,1,1, KT=1,1,1\n", 8, SE3D_IMPORT_LOST,
     "both markers are on one part", NULL, 0},
    {"a.adm", CRANK "BUSHING/1, I=3, J=1, K=1,1,1, KT=1,1,1, FORCE=1,0,0\n", 8, SE3D_IMPORT_LOST,
     "a bushing with a preload", NULL, 0},
    {"a.adm", CRANK "BUSHING/1, I=3, J=1, K=1,1,1, KT=1,1,1, TORQUE=0,1,0\n", 8, SE3D_IMPORT_LOST,
     "a bushing with a preload", NULL, 0},
    {"a.adm", ARM "GFORCE/1, I=4, JFLOAT=2, FX=1\n", 12, SE3D_IMPORT_LOST,
     "it acts between two parts that move", NULL, 0},
    {"a.adm", ARM "GFORCE/1, I=1, JFLOAT=1, FX=1\n", 12, SE3D_IMPORT_LOST,
     "it acts between two parts that move", NULL, 0},
    {"a.adm", ARM "GFORCE/1, I=4, JFLOAT=1, RM=2, FX=1\n", 12, SE3D_IMPORT_LOST,
     "its RM is on a third part", NULL, 0},
    {"a.adm", ARM "GFORCE/1, I=4, JFLOAT=1, FX=FOO(1)\n", 12, SE3D_IMPORT_LOST, "FOO", NULL, 0},
    {"a.adm", CRANK "JOINT/2, SCREW, I=2, J=1\n", 8, SE3D_IMPORT_LOST, "a screw without PITCH",
     NULL, 0},
    {"a.adm", CRANK "JOINT/2, TRANSLATIONAL, I=2, J=1, IC=1,0\n", 8, SE3D_IMPORT_LOST,
     "its initial conditions", "type: prismatic", 0},
    {"a.adm", CRANK "JOINT/2, REVOLUTE, I=2, J=1, ICROT=1,0\n", 8, SE3D_IMPORT_LOST,
     "its initial conditions", NULL, 0},
    {"a.adm", CRANK "JOINT/2, CONVEL, I=2, J=1\n", 8, SE3D_IMPORT_LOST, "a joint of this type",
     NULL, 0},
    {"a.adm", CRANK "JPRIM/1, SOME, I=2, J=1\n", 8, SE3D_IMPORT_LOST, "a primitive of this type",
     NULL, 0},
    {"a.adm", CRANK "GCON/1, I=2, FUNCTION=1\n", 8, SE3D_IMPORT_LOST, "no distance DM", NULL, 0},
    {"a.adm", CRANK "GCON/1, I=2\n", 8, SE3D_IMPORT_LOST, "no distance DM", NULL, 0},
    {"a.adm", CRANK "GCON/1, I=2, FUNCTION=DM(2,3)-1\n", 8, SE3D_IMPORT_LOST, "no distance DM",
     NULL, 0},
    {"a.adm", CRANK "GCON/1, I=2, FUNCTION=DM(2,1)-0\n", 8, SE3D_IMPORT_LOST, "no distance DM",
     NULL, 0},
    {"a.adm", CRANK "GCON/1, I=2, FUNCTION=DM(2,1)-x\n", 8, SE3D_IMPORT_LOST, "no distance DM",
     NULL, 0},
    {"a.adm", CRANK "GCON/1, I=2, FUNCTION=DM(2,9)-1\n", 8, SE3D_IMPORT_LOST, "no distance DM",
     NULL, 0},
    {"a.adm", CRANK "MOTION/1, ROTATIONAL, JOINT=1\n", 8, SE3D_IMPORT_LOST, "it has no FUNCTION",
     NULL, 0},
    {"a.adm", CRANK "MOTION/1, ROTATIONAL, JOINT=1, ACCELERATION, FUNCTION=1\n", 8,
     SE3D_IMPORT_LOST, "an acceleration", NULL, 0},
    {"a.adm", MOTION("POLY(TIME,0)"), 8, SE3D_IMPORT_LOST, "too few arguments", NULL, 0},
    {"a.adm", MOTION("FORSIN(TIME,0)"), 8, SE3D_IMPORT_LOST, "too few arguments", NULL, 0},
    {"a.adm", MOTION("SQRT(1,2)"), 8, SE3D_IMPORT_LOST, "a call with other arguments", NULL, 0},
    {"a.adm", MOTION("VARVAL(9)"), 8, SE3D_IMPORT_LOST, "VARVAL of no function", NULL, 0},
    {"a.adm", MOTION("1 & 2"), 8, SE3D_IMPORT_LOST, "a sign that is not known", NULL, 0},
    {"a.adm", MOTION("SOME(TIME)"), 8, SE3D_IMPORT_LOST, "SOME", NULL, 0},
    {"a.adm", MOTION("DM(3,1)"), 8, SE3D_IMPORT_LOST, "no quantity between its markers", NULL, 0},
    {"a.adm", PULL("DM(5,2)"), 12, SE3D_IMPORT_LOST, "DM of other markers", NULL, 0},
    {"a.adm", PULL("DX(4,2)"), 12, SE3D_IMPORT_LOST, "DX", NULL, 0},
    {"a.adm", CRANK "PART/3\nMARKER/4, PART=3\n", 8, SE3D_IMPORT_CHANGED,
     "has no mass; it gets 1e-9 kg", "mass: 1e-09", 0},
};

static const noted trees[] = {
    {"a.mdl", MDL("\"TSDAs\": [{\"bodyi\": 1}]"), 2, SE3D_IMPORT_LOST, "does not name two bodies",
     NULL, 0},
    {"a.mdl", MDL("\"RSDAs\": [{\"bodyi\": 1, \"bodyj\": 2}]"), 2, SE3D_IMPORT_LOST,
     "it has no axis `aiBAR`", NULL, 0},
    {"a.mdl", MDL("\"forces\": [{\"type\": \"wind\", \"bodyi\": 1}]"), 2, SE3D_IMPORT_LOST,
     "its `type` must be TSDA, RSDA, force or torque", NULL, 0},
    {"a.mdl", MDL("\"TSDAs\": [7]"), 2, SE3D_IMPORT_LOST, "its `type` must be", NULL, 0},
    {"a.mdl", MDL("\"someForce\": {\"a\": 1}"), 2, SE3D_IMPORT_LOST, "`someForce` is not read",
     NULL, 0},
    {"a.mdl", MDL("\"colour\": 3"), 2, SE3D_IMPORT_NOTE, "`colour` is not read", NULL, 0},
};

#if defined(SE3D_HAS_EXPAT)
static const noted robots[] = {
    {"a.urdf", ROBOT("<gazebo reference=\"b\"><mu1>0.4</mu1></gazebo>"), 2, SE3D_IMPORT_NOTE,
     "gives `b` mu1 = 0.4", NULL, 0},
    {"a.urdf", ROBOT("<gazebo><mu2>0.4</mu2></gazebo>"), 2, SE3D_IMPORT_NOTE,
     "gives `all` mu2 = 0.4", NULL, 0},
    {"a.sdf",
     SDF(SDF_LINK("b", "") SDF_JOINT("f", "fixed", "a", "b", "")
             SDF_JOINT("j", "revolute", "a", "b", "<axis><xyz>0 0 1</xyz></axis>")),
     3, SE3D_IMPORT_LOST, "both links of `j` are one body", NULL, 1},
    {"a.sdf",
     "<sdf version=\"1.10\"><world name=\"w\">\n<state/><model name=\"m\">" SDF_LINK(
         "a", "") "</model></world></sdf>",
     2, SE3D_IMPORT_LOST, "<state> of the world", NULL, 0},
    {"a.sdf",
     SDF("<link name=\"b\"><inertial>\n<mass>1</mass><fluid_added_mass/></inertial></link>"), 2,
     SE3D_IMPORT_LOST, "the added mass of the fluid", NULL, 0},
    {"a.sdf",
     SDF(SDF_JOINT("j", "revolute", "world", "a",
                   "<axis><xyz>0 0 1</xyz><dynamics><friction>-1</friction></dynamics></axis>")),
     2, SE3D_IMPORT_LOST, "the friction -1 of `j` is negative", NULL, 0},
    {"a.sdf", SDF(SDF_JOINT("j", "gearbox", "world", "a", "")), 2, SE3D_IMPORT_LOST,
     "the gearbox `j`", NULL, 0},
    {"a.sdf",
     SDF("<link name=\"b\"><collision name=\"c\"><geometry>\n<box><size>1 0 1</size></box>"
         "</geometry></collision></link>"),
     3, SE3D_IMPORT_LOST, "the <box> has a size that is not > 0", NULL, 0},
    {"a.sdf",
     SDF("<link name=\"b\"><collision name=\"c\"><geometry>\n<ellipsoid><radii>1 1 0</radii>"
         "</ellipsoid></geometry></collision></link>"),
     3, SE3D_IMPORT_LOST, "the <ellipsoid> has a size that is not > 0", NULL, 0},
    {"a.sdf",
     SDF("<link name=\"b\"><collision name=\"c\"><geometry>\n<heightmap/></geometry></collision>"
         "</link>"),
     3, SE3D_IMPORT_LOST, "the geometry <heightmap>", NULL, 0},
    {"a.xml", MUJOCO("", "<compiler boundmass=\"1\"/>"), 2, SE3D_IMPORT_LOST,
     "boundmass of the compiler", NULL, 0},
    {"a.xml", MUJOCO("", "<compiler balanceinertia=\"true\"/>"), 2, SE3D_IMPORT_LOST,
     "balanceinertia of the compiler", NULL, 0},
    {"a.xml",
     MUJOCO("<freejoint/>",
            "<equality><connect body1=\"a\" body2=\"a\" anchor=\"0 0 0\"/></equality>"),
     2, SE3D_IMPORT_LOST, "both ends are on one body", NULL, 0},
    {"a.xml",
     MUJOCO("<freejoint/>",
            "<equality><connect body1=\"a\" anchor=\"0 0 0\" active=\"false\"/></equality>"),
     2, SE3D_IMPORT_NOTE, "<connect> is not active", NULL, 0},
    {"a.xml", MUJOCO("<freejoint/>", "<equality><flex/></equality>"), 2, SE3D_IMPORT_LOST,
     "an equality of this type", NULL, 0},
    {"a.xml",
     MUJOCO("<freejoint/><site name=\"s\"/><site name=\"t\" pos=\"0 0 1\"/>",
            "<tendon><spatial stiffness=\"9\"><site site=\"s\"/><site site=\"t\"/></spatial>"
            "</tendon>"),
     2, SE3D_IMPORT_LOST, "both of its sites are on one body", NULL, 0},
    {"a.xml",
     MUJOCO("<freejoint/><site name=\"s\"/>",
            "<tendon><spatial stiffness=\"9\"><site site=\"s\"/></spatial></tendon>"),
     2, SE3D_IMPORT_LOST, "no spring between two sites", NULL, 0},
    {"a.xml",
     MUJOCO("<joint name=\"b\" type=\"ball\"/>", "<actuator><motor joint=\"b\"/></actuator>"), 2,
     SE3D_IMPORT_LOST, "it acts on no hinge or slide", NULL, 0},
    {"a.xml", MUJOCO("<freejoint/><geom size=\"1\" shellinertia=\"true\"/>", ""), 1,
     SE3D_IMPORT_LOST, "shellinertia: the geom weighs as a solid", NULL, 0},
    {"a.xml", MUJOCO("<freejoint/><replicate/>", ""), 1, SE3D_IMPORT_LOST, "<replicate>", NULL, 0},
    {"a.xml", MUJOCO("<body name=\"b\" gravcomp=\"1\"><joint type=\"hinge\"/>" GEOM "</body>", ""),
     1, SE3D_IMPORT_LOST, "gravcomp of `b`", NULL, 0},
};
#endif

/* The note that the row asks for, or NULL. */
static const char *find_note(const se3d_model_import *import, const noted *row)
{
    for (size_t k = 0; k < se3d_model_import_count_notes(import); ++k) {
        se3d_model_import_note note;
        CHECK(!se3d_model_import_get_note(import, k, &note));
        if (note.kind == (int32_t)row->kind && note.line == row->line &&
            strstr(note.message, row->part)) {
            return note.message;
        }
    }
    return NULL;
}

static void show_notes(const se3d_model_import *import, const noted *row)
{
    fprintf(stderr, "no note `%s`: %s\n", row->part, row->text);
    for (size_t k = 0; k < se3d_model_import_count_notes(import); ++k) {
        se3d_model_import_note note;
        CHECK(!se3d_model_import_get_note(import, k, &note));
        fprintf(stderr, "    line %zu, kind %d: %s\n", note.line, note.kind, note.message);
    }
}

static void check_row(const noted *row)
{
    se3d_model_import *import = NULL;
    se3d_model *model = NULL;
    se3d_model_error error = {.message = ""};
    se3d_model_import_options how = se3d_model_import_options_default();
    how.merge_fixed = row->merges;
    CHECK(!se3d_model_import_text(row->text, strlen(row->text), row->name, &how, &import, &error));
    if (!import) {
        fprintf(stderr, "%s: %s\n", row->text, error.message);
        return;
    }
    const char *made = se3d_model_import_get_text(import, NULL);
    const char *note = find_note(import, row);
    CHECK(note != NULL);
    if (!note) {
        show_notes(import, row);
    }
    CHECK(!row->made || strstr(made, row->made));
    CHECK(!se3d_model_read_text(made, strlen(made), "a.yaml", NULL, &model, &error));
    se3d_model_destroy(model);
    se3d_model_import_destroy(import);
}

#define CHECK_ROWS(table)                                                                          \
    for (size_t k = 0; k < sizeof(table) / sizeof *(table); ++k) {                                 \
        check_row(&(table)[k]);                                                                    \
    }

static void what_adams_has_besides_is_noted(void)
{
    CHECK_ROWS(adams)
}

static void what_other_trees_have_besides_is_noted(void)
{
    CHECK_ROWS(trees)
}

#if defined(SE3D_HAS_EXPAT)
static void what_robots_have_besides_is_noted(void)
{
    CHECK_ROWS(robots)
}
#endif

int main(void)
{
    RUN(what_adams_has_besides_is_noted);
    RUN(what_other_trees_have_besides_is_noted);
#if defined(SE3D_HAS_EXPAT)
    RUN(what_robots_have_besides_is_noted);
#endif
    return check_finish();
}
