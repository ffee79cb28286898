# SPDX-License-Identifier: BSD-3-Clause
# Units that misbehave: a unit of another program that does what it is told, every function of it failing with every
# status, is reported with its name and what it said; nothing of it is called any more once it is broken.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
. "$source/tests/support/fmi.sh"
case ${ASAN_OPTIONS:-}${UBSAN_OPTIONS:-} in ?*) exit 0 ;; esac # the object has none of the sanitizer

# PUPPET="FUNCTION STATUS N": its call N returns this status, after the unit has told why. PUPPET_CALLS: a file that gets
# a line for each call. Its outputs: force = -100 x, an integer that counts the steps.
cat >"$dir/puppet.c" <<'END_OF_C'
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#define NAME(version, name) fmi##version##name

typedef void (*log_2)(void *, const char *, int, const char *, const char *, ...);
typedef void (*log_3)(void *, int, const char *, const char *);
static struct { log_2 log; void *(*a)(size_t, size_t); void (*f)(void *); void *done, *environment; } host_2;
static log_3 host_3;
static void *environment_3;
static int before; /* calls of the function that fails */
typedef struct unit { double x, gain; int32_t steps; } unit;
static unit one;
static const char *wrong = "";

static int called(const char *name)
{
    char which[60] = "";
    int status = 0, number = 1;
    const char *path = getenv("PUPPET_CALLS"), *how = getenv("PUPPET");
    FILE *file = path ? fopen(path, "a") : NULL;
    if (file) {
        fprintf(file, "%s\n", name);
        fclose(file);
    }
    if (!how || sscanf(how, "%59s %d %d", which, &status, &number) < 2 || strcmp(which, name) != 0 ||
        ++before != number) {
        return 0;
    }
    wrong = name;
    if (host_2.log) {
        host_2.log(host_2.environment, "unit", status, "all", "%s was told to fail", name);
    } else if (host_3) {
        host_3(environment_3, status, "all", "it was told to fail");
    }
    return status;
}

static int get_value(const char *name, const uint32_t *at, size_t n, double *values)
{
    const int status = called(name);
    for (size_t k = 0; k < n; ++k) {
        values[k] = getenv("PUPPET_NAN") ? (double)NAN : at[k] == 1 ? -one.gain * one.x : one.x;
    }
    return status;
}

static int set_value(const char *name, const uint32_t *at, size_t n, const double *values)
{
    const int status = called(name);
    for (size_t k = 0; k < n; ++k) {
        *(at[k] == 3 ? &one.gain : &one.x) = values[k];
    }
    return status;
}

static int get_whole(const char *name, size_t n, int32_t *values)
{
    values[0] = one.steps;
    return called(name) + 0 * (int)n;
}

static void *make(const char *name)
{
    one = (unit){0.0, 100.0, 0};
    return called(name) ? NULL : &one;
}

void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const void *calls, int visible,
                      int logging)
{
    memcpy(&host_2, calls, sizeof host_2);
    return make("Instantiate");
}
void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible, bool logging,
                                  bool events, bool early, const uint32_t *more, size_t count, void *environment,
                                  log_3 log, void *update)
{
    host_3 = log;
    environment_3 = environment;
    return make("InstantiateCoSimulation");
}
int fmi2SetupExperiment(void *c, int t, double tolerance, double start, int s, double stop) { return called("SetupExperiment"); }
int fmi2EnterInitializationMode(void *c) { return called("EnterInitializationMode"); }
int fmi3EnterInitializationMode(void *c, bool t, double tolerance, double start, bool s, double stop)
{
    return called("EnterInitializationMode");
}
int fmi2GetReal(void *c, const uint32_t *at, size_t n, double *values) { return get_value("GetReal", at, n, values); }
int fmi2SetReal(void *c, const uint32_t *at, size_t n, const double *values) { return set_value("SetReal", at, n, values); }
int fmi2GetInteger(void *c, const uint32_t *at, size_t n, int32_t *values) { return get_whole("GetInteger", n, values); }
int fmi3GetFloat64(void *c, const uint32_t *at, size_t n, double *values, size_t m) { return get_value("GetFloat64", at, n, values); }
int fmi3SetFloat64(void *c, const uint32_t *at, size_t n, const double *values, size_t m) { return set_value("SetFloat64", at, n, values); }
int fmi3GetInt32(void *c, const uint32_t *at, size_t n, int32_t *values, size_t m) { return get_whole("GetInt32", n, values); }
int fmi2DoStep(void *c, double t, double h, int no) { ++one.steps; return called("DoStep"); }
int fmi3DoStep(void *c, double t, double h, bool no, bool *event, bool *ends, bool *early, double *reached)
{
    ++one.steps;
    *ends = getenv("PUPPET_ENDS") != NULL;
    *reached = getenv("PUPPET_EARLY") ? t + 0.5 * h : t + h;
    return called("DoStep");
}
#define BOTH(v, State, De)                                                                                              \
    int NAME(v, ExitInitializationMode)(void *c) { return called("ExitInitializationMode"); }                           \
    int NAME(v, Terminate)(void *c) { return called("Terminate"); }                                                     \
    void NAME(v, FreeInstance)(void *c) { (void)called("FreeInstance"); }                                               \
    int NAME(v, Get##State)(void *c, void **state) { *state = &one; return called("GetState"); }                        \
    int NAME(v, Set##State)(void *c, void *state) { return called("SetState"); }                                        \
    int NAME(v, Free##State)(void *c, void **state) { *state = NULL; return called("FreeState"); }                      \
    int NAME(v, Serialized##State##Size)(void *c, void *state, size_t *size)                                            \
    {                                                                                                                   \
        *size = getenv("PUPPET_HUGE") ? SIZE_MAX / 2 : sizeof one;                                                      \
        return called("StateSize");                                                                                     \
    }                                                                                                                   \
    int NAME(v, Serialize##State)(void *c, void *state, unsigned char *bytes, size_t size)                              \
    {                                                                                                                   \
        memcpy(bytes, &one, sizeof one);                                                                                \
        return called("WriteState");                                                                                    \
    }                                                                                                                   \
    int NAME(v, De)(void *c, const unsigned char *bytes, size_t size, void **state)                                     \
    {                                                                                                                   \
        memcpy(&one, bytes, sizeof one);                                                                                \
        *state = &one;                                                                                                  \
        return called("ReadState");                                                                                     \
    }
BOTH(2, FMUstate, DeSerializeFMUstate)
BOTH(3, FMUState, DeserializeFMUState)
END_OF_C
case $(uname -m) in
x86_64) folder2=linux64 folder3=x86_64-linux ;;
*) folder2=linux$(uname -m) folder3=$(uname -m)-linux ;;
esac
mkdir -p "$dir/unit.2/binaries/$folder2" "$dir/unit.3/binaries/$folder3"
object2=$dir/unit.2/binaries/$folder2/puppet.so
object3=$dir/unit.3/binaries/$folder3/puppet.so
expect 'the puppet' 0 "${CC:-cc}" -shared -fPIC -o "$object2" "$dir/puppet.c"
cp "$object2" "$object3"
cat >"$dir/unit.2/modelDescription.xml" <<'END_OF_XML'
<fmiModelDescription fmiVersion="2.0" guid="{p}"><CoSimulation modelIdentifier="puppet" canGetAndSetFMUstate="true"
  canSerializeFMUstate="1"/><ModelVariables>
<ScalarVariable name="x" valueReference="0" causality="input"><Real/></ScalarVariable>
<ScalarVariable name="force" valueReference="1" causality="output"><Real/></ScalarVariable>
<ScalarVariable name="steps" valueReference="2" causality="output"><Integer/></ScalarVariable>
<ScalarVariable name="gain" valueReference="3" causality="parameter"><Real/></ScalarVariable>
</ModelVariables></fmiModelDescription>
END_OF_XML
cat >"$dir/unit.3/modelDescription.xml" <<'END_OF_XML'
<fmiModelDescription fmiVersion="3.0" instantiationToken="{p}"><CoSimulation modelIdentifier="puppet"
  canGetAndSetFMUState="true" canSerializeFMUState="true"/><ModelVariables>
<Float64 name="x" valueReference="0" causality="input"/><Float64 name="force" valueReference="1" causality="output"/>
<Int32 name="steps" valueReference="2" causality="output"/><Float64 name="gain" valueReference="3" causality="parameter"/>
</ModelVariables></fmiModelDescription>
END_OF_XML

# host FMI [OUTPUT]: a block that the puppet pushes
host() {
    cat <<END_OF_YAML
se3d: 1
gravity: [0, 0, 0]
bodies: [{name: block, mass: 1, inertia: [1, 1, 1], velocity: [1, 0, 0]}]
joints: [{name: rail, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], axis: [1, 0, 0]}]
forces: [{name: push, type: effort, joint: rail, value: 0}]
fmus:
  - {name: puppet, file: unit.$1, step: 0.01, inputs: [{variable: x, channel: rail.displacement}],
     outputs: [{variable: ${2:-force}, element: push}], parameters: [{variable: gain, value: 400}]}
analysis: {type: dynamics, duration: 0.1}
output: [{file: a.csv, every: 0.01, channels: [rail.displacement, push.effort]}]
END_OF_YAML
}

# run CASE CODE OPTION...: the host in $dir/host.yaml
run() {
    rm -f "$dir/calls"
    case=$1
    expected=$2
    shift 2
    PUPPET_CALLS="$dir/calls" expect "$case" "$expected" "$program" run "$dir/host.yaml" -o "$dir/run" "$@"
}

# fails FUNCTION STATUS N TEXT [OPTION...]: the program says so, and what it may still call of the unit is called only
fails() {
    what="FMI $fmi, call $3 of $1 is $2"
    why=$4
    export PUPPET="$1 $2 $3"
    shift 4
    run "$what" 1 "$@"
    unset PUPPET
    says 'fmu `puppet`: '"$why: "
    says 'was told to fail'
    case $what in
    *' is 4') is "$what, then $(tail -1 "$dir/calls")" "$what, then $(echo "$what" | sed 's/.* of \(.*\) is.*/\1/')" ;;
    *) is "$what, then $(tail -1 "$dir/calls")" "$what, then FreeInstance" ;;
    esac
    holds "$what: a unit that has failed is terminated" sh -c "! grep -q Terminate '$dir/calls'"
}

for fmi in 2 3; do
    case $fmi in
    2) get=GetReal set=SetReal whole=GetInteger instance=Instantiate object=$object2 state=FMUstate de=DeSerialize ;;
    3) get=GetFloat64 set=SetFloat64 whole=GetInt32 instance=InstantiateCoSimulation object=$object3 state=FMUState
        de=Deserialize ;;
    esac
    host $fmi >"$dir/host.yaml"
    rm -rf "$dir/run"
    run 'in peace' 0
    is "$(tail -2 "$dir/calls" | tr '\n' ' ')" 'Terminate FreeInstance '
    holds 'the puppet does not push' awk -F, 'NR > 1 && $1 > 0.015 { n += $3 < -400 * 0.9 * $1 * cos(20 * $1) } END { exit !n }' \
        "$dir/run/a.csv"
    cp "$dir/run/a.csv" "$dir/peace.csv"
    for each in "$get 3" "$set 3" 'DoStep 3' 'ExitInitializationMode 1' 'EnterInitializationMode 1'; do
        PUPPET="${each% *} 1 ${each#* }" run "a warning of $each" 0
        holds "a warning of $each changes the motion" cmp "$dir/run/a.csv" "$dir/peace.csv"
    done
    for status in 3 4; do
        fails $set $status 1 'a parameter is refused'
        fails $set $status 2 'an input is refused'
        fails $set $status 4 'an input is refused'
        [ $fmi = 3 ] || fails SetupExperiment $status 1 'it cannot be initialized'
        fails EnterInitializationMode $status 1 'it cannot be initialized'
        fails ExitInitializationMode $status 1 'its initialization has failed'
        fails $get $status 1 'an output cannot be had, or not finite'
        fails $get $status 5 'an output cannot be had, or not finite'
        fails DoStep $status 1 'its step has failed'
        fails DoStep $status 4 'its step has failed'
        holds 'nothing of what went well is there' awk -F, 'NR > 1 && $1 > 0.025 { n = 1 } END { exit !n }' "$dir/run/a.csv"
    done
    fails DoStep 2 3 'it does not go on to the next point'
    PUPPET='DoStep -1 3' run 'a status that does not exist' 1
    says 'fmu `puppet`: its step has failed'
    export PUPPET_NAN=1
    run 'NaN' 1
    says 'fmu `puppet`: an output cannot be had, or not finite'
    unset PUPPET_NAN
    PUPPET="$instance 3 1" run 'no instance' 1
    says 'fmu `puppet`: it cannot be instantiated'
    is "$(tr '\n' ' ' <"$dir/calls")" "$instance "
    host $fmi steps >"$dir/host.yaml"
    run 'a whole number' 0
    is "$(awk -F, 'END { print $3 + 0 }' "$dir/run/a.csv")" 10
    fails $whole 3 2 'an output cannot be had, or not finite'
    host $fmi >"$dir/host.yaml"

    # What a run with checkpoints needs, and goes on from.
    for each in GetState StateSize WriteState FreeState; do
        for status in 3 4; do
            fails $each $status 2 'it cannot go on' --checkpoint 0
            says 'run.checkpoint cannot be written: fmu `puppet`: its state cannot be written: '
            rm -rf "$dir/run"
        done
    done
    PUPPET_HUGE=1 run 'a state larger than memory' 0 --checkpoint 0
    says 'fmu `puppet`: its state cannot be written'
    PUPPET='DoStep 3 6' run 'half a run' 1 --checkpoint 0
    holds 'no checkpoint is left' test -e "$dir/run/run.checkpoint"
    cp -r "$dir/run" "$dir/half"
    for each in ExitInitializationMode ReadState SetState FreeState; do
        for status in 3 4; do
            rm -rf "$dir/run"
            cp -r "$dir/half" "$dir/run"
            fails $each $status 1 'it refuses the state in the checkpoint' --resume
        done
    done
    rm -rf "$dir/run"
    mv "$dir/half" "$dir/run"
    run 'the other half' 0 --resume
    holds 'resumed otherwise' cmp "$dir/run/a.csv" "$dir/peace.csv"
    rm -rf "$dir/run"

    # A function that is not there is named.
    cp "$object" "$dir/whole.so"
    for each in ExitInitializationMode Terminate FreeInstance $instance EnterInitializationMode $whole $get $set DoStep \
        Get$state Set$state Free$state Serialized${state}Size Serialize$state ${de}$state $([ $fmi = 3 ] || echo SetupExperiment); do
        other=$(echo "$each" | sed 's/.$/_/')
        LC_ALL=C sed "s/fmi$fmi$each\\x00/fmi$fmi$other\\x00/g" "$dir/whole.so" >"$object"
        run "without $each" 2 --checkpoint 1
        says 'fmu `puppet`: is not a whole unit: '"fmi$fmi$each is missing"
    done
    cp "$dir/whole.so" "$object"
done
PUPPET_ENDS=1 run 'it ends the simulation' 1
says 'fmu `puppet`: it does not go on to the next point'
PUPPET_EARLY=1 run 'it returns early' 1
says 'fmu `puppet`: it does not go on to the next point'

# Descriptions of something else.
describes() {
    sed "$1" "$dir/unit.3/modelDescription.xml" >"$dir/changed.xml"
    cp -r "$dir/unit.3" "$dir/unit.4"
    cp "$dir/changed.xml" "$dir/unit.4/modelDescription.xml"
    host 4 >"$dir/host.yaml"
    run "$1" "$3"
    says "$2"
    rm -r "$dir/unit.4"
}
none='is no description of a unit of FMI 2.0 or 3.0 for co-simulation'
describes 's/fmiVersion="3.0"//' "$none" 2
describes 's/fmiVersion="3.0"/fmiVersion="1.0"/' "$none" 2
describes 's/instantiationToken="{p}"//' "$none" 2
describes 's/modelIdentifier="puppet"//' "$none" 2
describes 's/CoSimulation/ModelExchange/' "$none" 2
describes 's/<ModelVariables>/<Model/' 'line 3:' 1
describes 's/name="x" valueReference="0"/name="x"/' 'it has no variable `x`' 1
describes 's/valueReference="0" causality="input"/valueReference="0"/' '`x` is local Float64, must be input Float64' 1
finish
