/* Friction feedforward in C: a joint that reverses, and missing readings. */
#include <stdio.h>

#include "stribeck.h"

int main(void)
{
    static const float parameters[] = {2000.0f, 12.0f, 1.5f, 2.0f, 2.7f, 0.08f, 2.0f};
    const stribeck_settings_f32 settings = {
        .model = "lugre",
        .parameters = parameters,
        .parameter_count = sizeof parameters / sizeof parameters[0],
        .constants = NULL,
        .constant_count = 0,
        .period = 0.00025f,
        .torque_limit = 8.0f,
        .speed_limit = 6.0f,
        .held = 1,
    };
    static const float velocities[] = {0.5f, 0.01f, -0.01f, -0.02f};
    static const char *const sources[] = {"law", "limit", "last", "none"};
    stribeck_joint_f32 joint;
    stribeck_sample_f32 sample = {0};
    stribeck_source source;
    float torque;
    size_t i;

    if (stribeck_version() != STRIBECK_VERSION) {
        fprintf(stderr, "header and library have different versions\n");
        return 2;
    }
    stribeck_status status = stribeck_joint_init_f32(&joint, &settings);
    if (status != STRIBECK_STATUS_OK) {
        fprintf(stderr, "%s\n", stribeck_message(status));
        return 2;
    }
    for (i = 0; i < sizeof velocities / sizeof velocities[0]; ++i) {
        sample.velocity = velocities[i];
        stribeck_joint_next_f32(&joint, &sample, &torque, &source);
        printf("%.9g %s\n", (double)torque, sources[source]);
    }
    for (i = 0; i < 2; ++i) {
        stribeck_joint_next_f32(&joint, NULL, &torque, &source);
        printf("%.9g %s\n", (double)torque, sources[source]);
    }
    return 0;
}
