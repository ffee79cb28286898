// SPDX-License-Identifier: BSD-3-Clause
// The bench's driver of Bullet's reduced-coordinate multibodies, by its public headers. METHOD:
// euler, rk4.
#include "../driver.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

namespace {
btMultiBody *build(char kind, int n)
{
    const btVector3 inertia(.008125, 1.6290625, 1.6290625), half(.5, 0, 0), zero(0, 0, 0);
    const btQuaternion straight = btQuaternion::getIdentity();
    btMultiBody *chain = new btMultiBody(n, 0, zero, true, false);
    for (int k = 0; k < n; ++k) {
        const btVector3 &from = k > 0 ? half : zero;
        if (kind == 'b') {
            chain->setupSpherical(k, 19.5, inertia, k - 1, straight, from, half, true);
        } else {
            chain->setupRevolute(k, 19.5, inertia, k - 1, straight, btVector3(0, 0, 1), from, half,
                                 true);
        }
    }
    chain->finalizeMultiDof();
    chain->setLinearDamping(0);
    chain->setAngularDamping(0);
    chain->setCanSleep(false);
    chain->setHasSelfCollision(false);
    chain->setMaxCoordinateVelocity(1e12);
    if (kind == 'b') {
        btScalar spin[3] = {1, 0, 0};
        chain->setJointVelMultiDof(0, spin);
    }
    return chain;
}

void run(const bench_request *request, bench_answer *answer)
{
    if (request->kind != 'a' && request->kind != 'b') {
        bench_fail(answer, "chains only");
        return;
    }
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btMultiBodyConstraintSolver solver;
    btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
    world.setGravity(btVector3(0, -9.81, 0));
    btMultiBody *chain = build(request->kind, request->n);
    chain->useRK4Integration(strcmp(request->method, "rk4") == 0);
    world.addMultiBody(chain);
    long steps = bench_steps(request->duration, request->setting);
    double h = request->duration / static_cast<double>(steps);
    double begin = bench_clock();
    for (long k = 0; k < steps; ++k) {
        world.stepSimulation(h, 0);
    }
    answer->seconds = bench_clock() - begin;
    answer->steps = static_cast<double>(steps);
    btVector3 tip = chain->localPosToWorld(request->n - 1, btVector3(.5, 0, 0));
    for (int k = 0; k < 3; ++k) {
        answer->tip[k] = tip[k];
    }
    world.removeMultiBody(chain);
    delete chain;
}
} // namespace

int main()
{
    return bench_serve(run);
}
