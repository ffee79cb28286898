/* SPDX-License-Identifier: BSD-3-Clause */
/* The bench's driver of ODE, by its public header. METHOD: direct (dWorldStep). */
#define _POSIX_C_SOURCE 200809L
#include "../driver.h"

#include <ode/ode.h>

static dBodyID add_bar(dWorldID world, int k)
{
    dMass mass;
    dBodyID body = dBodyCreate(world);
    dMassSetParameters(&mass, 19.5, 0, 0, 0, .008125, 1.6290625, 1.6290625, 0, 0, 0);
    dBodySetMass(body, &mass);
    dBodySetPosition(body, k + 0.5, 0, 0);
    return body;
}

static dBodyID build(dWorldID world, char kind, int n)
{
    dBodyID last = NULL;
    for (int k = 0; k < n; ++k) {
        dBodyID bar = add_bar(world, k);
        if (kind == 'b') {
            dJointID joint = dJointCreateBall(world, NULL);
            dJointAttach(joint, bar, last);
            dJointSetBallAnchor(joint, k, 0, 0);
            dBodySetAngularVel(bar, 1, 0, 0);
        } else {
            dJointID joint = dJointCreateHinge(world, NULL);
            dJointAttach(joint, bar, last);
            dJointSetHingeAnchor(joint, k, 0, 0);
            dJointSetHingeAxis(joint, 0, 0, 1);
        }
        last = bar;
    }
    return last;
}

static void run(const bench_request *request, bench_answer *answer)
{
    if (request->kind != 'a' && request->kind != 'b') {
        bench_fail(answer, "chains only");
        return;
    }
    dWorldID world = dWorldCreate();
    dWorldSetGravity(world, 0, -9.81, 0);
    dWorldSetCFM(world, 0);
    dBodyID last = build(world, request->kind, request->n);
    long steps = bench_steps(request->duration, request->setting);
    double begin = bench_clock();
    for (long k = 0; k < steps; ++k) {
        dWorldStep(world, request->duration / (double)steps);
    }
    answer->seconds = bench_clock() - begin;
    answer->steps = (double)steps;
    dVector3 tip;
    dBodyGetRelPointPos(last, 0.5, 0, 0, tip);
    for (int k = 0; k < 3; ++k) {
        answer->tip[k] = tip[k];
    }
    dWorldDestroy(world);
}

int main(void)
{
    dInitODE2(0);
    int result = bench_serve(run);
    dCloseODE();
    return result;
}
