/* SPDX-License-Identifier: BSD-3-Clause */
/* A user's program, compiled against the installed headers as C and as C++. */
#include <se3d/se3d.h>
#ifdef CONSUMER_IO
#include <se3d/io.h>
#endif

#include <stdio.h>
#include <string.h>

#ifdef CONSUMER_IO
/* A model from text: pulls in the reader and libyaml. */
static int read_model(void)
{
    const char *text = "se3d: 1\n"
                       "bodies:\n"
                       "  - {name: bar, mass: 1, inertia: [1, 1, 1], position: [0, 0, 0]}\n";
    se3d_model_options options = se3d_model_options_default();
    se3d_model *model = NULL;
    se3d_status status =
        se3d_model_read_text(text, strlen(text), "consumer", &options, &model, NULL);
    se3d_model_destroy(model);
    return SE3D_FAILED(status);
}
#else
static int read_model(void)
{
    return 0;
}
#endif

int main(void)
{
    se3d_system *sys = NULL;
    se3d_body_def def = se3d_body_def_default();
    se3d_body body;
    char expected[32];
    snprintf(expected, sizeof expected, "%d.%d.%d", SE3D_VERSION_MAJOR, SE3D_VERSION_MINOR,
             SE3D_VERSION_PATCH);
    if (strcmp(se3d_version_get_text(), expected) != 0) {
        return 1;
    }
    if (SE3D_FAILED(se3d_system_create(NULL, &sys))) {
        return 2;
    }
    def.mass = 1.0;
    def.inertia[0] = def.inertia[1] = def.inertia[2] = 1.0;
    if (SE3D_FAILED(se3d_body_create(sys, &def, &body))) {
        return 3;
    }
    se3d_system_destroy(sys);
    if (read_model() != 0) {
        return 4;
    }
    printf("consumer: se3d %s\n", expected);
    return 0;
}
