/* SPDX-License-Identifier: BSD-3-Clause */
/* What bench_query measures, by Pinocchio: the articulated body algorithm and recursive
 * Newton-Euler of the same robots. Its free base has velocities in the frame of the body, where
 * this library and MuJoCo have the linear one in the ground's: accelerations of free robots are
 * others, those of the arm are the same. */
#include "../clock.h"
#include "../robots.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/joint-configuration.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/multibody/data.hpp>
#include <pinocchio/multibody/model.hpp>

namespace {

enum { ROUNDS = 15, QUERIES = 2000 };

struct Robot {
    bench_robot of;
    pinocchio::Model model;
    std::unique_ptr<pinocchio::Data> data;
    Eigen::VectorXd q, qdot, effort, qddot;
};

pinocchio::JointIndex add_joint(Robot &r, int k, pinocchio::JointIndex parent)
{
    const bench_link &l = r.of.link[k];
    const pinocchio::SE3 at(Eigen::Matrix3d::Identity(),
                            Eigen::Vector3d(l.at[0], l.at[1], l.at[2]));
    const std::string name = "link" + std::to_string(k);
    if (r.of.is_free && k == 0) {
        return r.model.addJoint(parent, pinocchio::JointModelFreeFlyer(), at, name);
    }
    if (l.axis[0] > 0.5) {
        return r.model.addJoint(parent, pinocchio::JointModelRX(), at, name);
    }
    if (l.axis[1] > 0.5) {
        return r.model.addJoint(parent, pinocchio::JointModelRY(), at, name);
    }
    return r.model.addJoint(parent, pinocchio::JointModelRZ(), at, name);
}

void begin(Robot &r, int which)
{
    pinocchio::JointIndex joint[BENCH_ROBOT_LINKS];
    r.of = bench_make_robot(which);
    r.model.gravity.linear() = Eigen::Vector3d(0.0, 0.0, -9.81);
    for (int k = 0; k < r.of.count; ++k) {
        const bench_link &l = r.of.link[k];
        joint[k] = add_joint(r, k, r.of.parent[k] < 0 ? 0 : joint[r.of.parent[k]]);
        const Eigen::Vector3d moments(l.inertia[0], l.inertia[1], l.inertia[2]);
        r.model.appendBodyToJoint(
            joint[k], pinocchio::Inertia(
                          l.mass, Eigen::Vector3d(l.centre[0], l.centre[1], l.centre[2]),
                          Eigen::Matrix3d(moments.asDiagonal())));
    }
    r.data = std::make_unique<pinocchio::Data>(r.model);
    r.q = pinocchio::neutral(r.model);
    r.qdot.resize(r.model.nv);
    r.effort.resize(r.model.nv);
    for (int k = r.of.is_free ? 7 : 0; k < r.model.nq; ++k) {
        r.q[k] = 0.1 * (k % 7) - 0.3;
    }
    for (int k = 0; k < r.model.nv; ++k) {
        r.qdot[k] = 0.1 * (k % 5) - 0.2;
        r.effort[k] = 0.2 * (k % 3);
    }
}

void forward(Robot &r)
{
    r.qddot = pinocchio::aba(r.model, *r.data, r.q, r.qdot, r.effort);
}

void inverse(Robot &r)
{
    pinocchio::rnea(r.model, *r.data, r.q, r.qdot, r.qddot);
}

double measure(Robot &r, void (*ask)(Robot &))
{
    double least = HUGE_VAL;
    for (int round = 0; round < ROUNDS; ++round) {
        const double start = bench_clock();
        for (int k = 0; k < QUERIES / ROUNDS; ++k) {
            ask(r);
        }
        least = std::fmin(least, bench_clock() - start);
    }
    return 1e9 * least / (QUERIES / ROUNDS);
}

} // namespace

int main()
{
    for (int which = 0; which < 3; ++which) {
        Robot r;
        begin(r, which);
        forward(r);
        const int n = r.model.nv;
        std::printf("Pinocchio %-10s qddot %.7g %.7g %.7g;", r.of.name, r.qddot[0], r.qddot[n / 2],
                    r.qddot[n - 1]);
        const double f = measure(r, forward), i = measure(r, inverse);
        std::printf(" forward %7.0f ns, inverse %7.0f ns\n", f, i);
    }
    return 0;
}
