/* SPDX-License-Identifier: BSD-3-Clause */
/* Models with known answers. A new model with a reference is a new row here. */
#ifndef SE3D_TESTS_MODEL_TABLE_H
#define SE3D_TESTS_MODEL_TABLE_H

#include <stddef.h>

typedef struct model_row {
    const char *model;       /* examples/models/<model>.yaml */
    const char *reference;   /* tests/data/<reference>.csv */
    const char *analysis;    /* NULL: as in the file */
    const char *formulation; /* NULL: both, one after the other */
    const char *method;      /* NULL: as in the file */
    const char *step;        /* NULL: as in the file */
    double tolerance;        /* relative to the largest value of the column */
    /* "channel=column", "channel=-column" or "channel+channel=column", separated by blanks */
    const char *columns;
} model_row;

/* Exact analyses: closed forms, reproduced to rounding; 1e-10 leaves room for other machines. */
#define PENDULUM_COLUMNS                                                                           \
    "bar.position.x=b1_x bar.position.y=b1_y bar.position.z=b1_z "                                 \
    "bar.orientation.e0=b1_e0 bar.orientation.e1=b1_e1 bar.orientation.e2=b1_e2 "                  \
    "bar.orientation.e3=b1_e3 bar.velocity.x=b1_vx bar.velocity.y=b1_vy bar.velocity.z=b1_vz "     \
    "bar.angular_velocity.z=b1_wx bar.acceleration.x=b1_ax bar.acceleration.y=b1_ay "              \
    "bar.acceleration.z=b1_az bar.angular_acceleration.z=b1_alx pin.force.x=RQx pin.force.y=RQy "  \
    "pin.force.z=RQz drive.effort=Tdrv_x drive.value=theta"
#define SPATIAL_COLUMNS                                                                            \
    "crank.position.y=b1_y crank.position.z=b1_z crank.orientation.e0=b1_e0 "                      \
    "crank.orientation.e1=b1_e1 crank.angular_velocity.x=b1_wx rod.position.x=b2_x "               \
    "rod.position.y=b2_y rod.position.z=b2_z rod.orientation.e0=b2_e0 rod.orientation.e1=b2_e1 "   \
    "rod.orientation.e2=b2_e2 rod.orientation.e3=b2_e3 rod.velocity.x=b2_vx rod.velocity.y=b2_vy " \
    "rod.velocity.z=b2_vz rod.acceleration.x=b2_ax rod.acceleration.y=b2_ay "                      \
    "rod.acceleration.z=b2_az slider.position.x=b3_x slider.velocity.x=b3_vx "                     \
    "slider.acceleration.x=b3_ax A.force.x=RAx A.force.y=RAy A.force.z=RAz "                       \
    "motor.effort=Tdrv_x A.torque.y=MAy A.torque.z=MAz B.force.x=RBx B.force.y=RBy B.force.z=RBz " \
    "C.force.x=RCx C.force.y=RCy C.force.z=RCz C.torque.y=MCy C.torque.z=MCz guide.force.y=RDy "   \
    "guide.force.z=RDz guide.torque.x=MDx guide.torque.y=MDy guide.torque.z=MDz"

static const model_row model_table[] = {
    {"pendulum", "pendulum_driven", NULL, NULL, NULL, NULL, 1e-10, PENDULUM_COLUMNS},
    {"spatial_slider_crank", "spatial_slider_crank_driven", NULL, NULL, NULL, NULL, 1e-9,
     SPATIAL_COLUMNS},
    {"planar_slider_crank_inverse", "planar_slider_crank_inverse", NULL, NULL, NULL, NULL, 1e-9,
     "O.angle=theta slider.position.x=slider_x motor.effort=motor_torque "
     "O.force.x=FOx_ground_on_crank O.force.y=FOy B.force.x=FBx_crank_on_rod B.force.y=FBy "
     "C.force.x=FCx_slider_on_rod C.force.y=FCy guide.force.y=N_ground_on_slider"},
    {"fourbar_kinematics", "fourbar_kinematics", NULL, NULL, NULL, NULL, 1e-9,
     "coupler.B.position.x=Bx coupler.B.position.y=By O.angle+A.angle=coupler_ang "
     "Q.angle=rocker_ang coupler.angular_velocity.z=coupler_w "
     "coupler.angular_acceleration.z=coupler_a rocker.angular_velocity.z=rocker_w "
     "rocker.angular_acceleration.z=rocker_a"},
    /* dop853 at the default tolerance; second-order methods: about twice the error at these steps.
     */
    {"pendulum_free", "pendulum_free_pi4", NULL, NULL, NULL, NULL, 2e-7,
     "pin.angle=theta pin.rate=dtheta bar.position.y=b1_y bar.velocity.z=b1_vz "
     "bar.acceleration.y=b1_ay pin.force.y=RQy pin.force.z=RQz"},
    {"pendulum_rsda", "pendulum_rsda", NULL, NULL, NULL, NULL, 2e-7,
     "pin.angle=theta pin.rate=dtheta bar.velocity.y=b1_vy pin.force.y=RQy pin.force.z=RQz "
     "spring.torque=-Trsda_x"},
    {"double_pendulum", "double_pendulum", NULL, NULL, NULL, NULL, 2e-7,
     "shoulder.angle=theta1 shoulder.angle+elbow.angle=theta2 shoulder.rate=dtheta1 "
     "upper.position.y=b1_y lower.position.y=b2_y lower.velocity.z=b2_vz "
     "upper.acceleration.y=b1_ay "
     "shoulder.force.y=R1y shoulder.force.z=R1z elbow.force.z=R2z energy.total=E"},
    {"double_pendulum", "double_pendulum", NULL, "rp", "hht", "0.0001", 6e-6,
     "shoulder.angle=theta1 shoulder.angle+elbow.angle=theta2 shoulder.rate=dtheta1 "
     "upper.position.y=b1_y lower.position.y=b2_y lower.velocity.z=b2_vz "
     "upper.acceleration.y=b1_ay "
     "shoulder.force.y=R1y shoulder.force.z=R1z elbow.force.z=R2z energy.total=E"},
    {"double_pendulum", "double_pendulum", NULL, "romega", "generalized_alpha", "0.0001", 6e-6,
     "shoulder.angle=theta1 shoulder.angle+elbow.angle=theta2 shoulder.rate=dtheta1 "
     "upper.position.y=b1_y lower.position.y=b2_y lower.velocity.z=b2_vz "
     "upper.acceleration.y=b1_ay "
     "shoulder.force.y=R1y shoulder.force.z=R1z elbow.force.z=R2z energy.total=E"},
    {"planar_slider_crank", "planar_slider_crank", NULL, NULL, NULL, NULL, 2e-7,
     "O.angle=theta O.rate=omega slider.position.x=slider_x slider.velocity.x=slider_vx"},
    {"fourbar", "A02_fourbar_N1", NULL, "romega", NULL, "0.001", 5e-4,
     "left.top.position.x=B0x left.top.position.y=B0y left.top.velocity.x=vB0x"},
    {"tsda_mass", "tsda_mass", NULL, NULL, NULL, NULL, 2e-7,
     "block.position.x=x block.velocity.x=v block.acceleration.x=a"},
    {"bar_rsda_tsda", "bar_rsda_tsda", NULL, NULL, NULL, NULL, 2e-7,
     "pin.angle=theta pin.rate=omega bar.tip.position.x=tip_x bar.tip.position.y=tip_y "
     "spring.length=spring_len"},
};

#endif
