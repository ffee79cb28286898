// SPDX-License-Identifier: BSD-3-Clause
// The bench's driver of Simbody, by its public headers. METHOD: merson (RK-Merson; SETTING is the
// accuracy), merson_fixed, euler (semi-explicit; SETTING is the step).
#include "../driver.h"

#include <Simbody.h>
#include <memory>

using namespace SimTK;

namespace {
struct Chain {
    MultibodySystem system;
    SimbodyMatterSubsystem matter;
    GeneralForceSubsystem forces;
    Force::UniformGravity gravity;
    MobilizedBodyIndex tip;

    Chain(char kind, int n)
        : matter(system), forces(system), gravity(forces, matter, Vec3(0, -9.81, 0))
    {
        Body::Rigid bar(MassProperties(19.5, Vec3(0), Inertia(.008125, 1.6290625, 1.6290625)));
        tip = matter.Ground().getMobilizedBodyIndex();
        for (int k = 0; k < n; ++k) {
            MobilizedBody &before = matter.updMobilizedBody(tip);
            Transform out(k > 0 ? Vec3(.5, 0, 0) : Vec3(0)), in(Vec3(-.5, 0, 0));
            if (kind == 'b') {
                tip = MobilizedBody::Ball(before, out, bar, in).getMobilizedBodyIndex();
            } else {
                tip = MobilizedBody::Pin(before, out, bar, in).getMobilizedBodyIndex();
            }
        }
    }
};

std::unique_ptr<Integrator> choose(const bench_request *request, const MultibodySystem &system)
{
    std::unique_ptr<Integrator> integrator;
    if (strcmp(request->method, "euler") == 0) {
        integrator.reset(new SemiExplicitEulerIntegrator(system, request->setting));
    } else {
        integrator.reset(new RungeKuttaMersonIntegrator(system));
        if (strcmp(request->method, "merson") == 0) {
            integrator->setAccuracy(request->setting);
        } else {
            integrator->setFixedStepSize(request->setting);
        }
    }
    integrator->setFinalTime(request->duration);
    return integrator;
}

void simulate(const bench_request *request, bench_answer *answer)
{
    Chain chain(request->kind, request->n);
    State state = chain.system.realizeTopology();
    if (request->kind == 'b') {
        state.updU()[0] = 1;
    }
    std::unique_ptr<Integrator> integrator = choose(request, chain.system);
    TimeStepper stepper(chain.system, *integrator);
    stepper.initialize(state);
    double begin = bench_clock();
    stepper.stepTo(request->duration);
    answer->seconds = bench_clock() - begin;
    answer->steps = integrator->getNumStepsTaken();
    const State &end = stepper.getState();
    chain.system.realize(end, Stage::Position);
    Vec3 tip =
        chain.matter.getMobilizedBody(chain.tip).findStationLocationInGround(end, Vec3(.5, 0, 0));
    for (int k = 0; k < 3; ++k) {
        answer->tip[k] = tip[k];
    }
}

void run(const bench_request *request, bench_answer *answer)
{
    if (request->kind != 'a' && request->kind != 'b') {
        bench_fail(answer, "chains only");
        return;
    }
    try {
        simulate(request, answer);
    } catch (const std::exception &failure) {
        bench_fail(answer, failure.what());
    }
}
} // namespace

int main()
{
    return bench_serve(run);
}
