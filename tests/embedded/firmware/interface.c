/* The C interface in firmware: what the linker keeps of the static library. */
#include "stribeck.h"

static const float parameters[] = {2000.0f, 12.0f, 1.5f, 2.0f, 2.7f, 0.08f, 2.0f};
static stribeck_joint_f32 joint;
volatile float velocity;
volatile float command;

void reset(void)
{
    const stribeck_settings_f32 settings = {
        .model = "lugre",
        .parameters = parameters,
        .parameter_count = sizeof parameters / sizeof parameters[0],
        .period = 0.00025f,
        .torque_limit = 8.0f,
        .speed_limit = 6.0f,
        .held = 8,
    };
    if (stribeck_version() != STRIBECK_VERSION
        || stribeck_joint_init_f32(&joint, &settings) != STRIBECK_STATUS_OK) {
        return;
    }
    for (;;) {
        const stribeck_sample_f32 sample = {.velocity = velocity};
        float torque = 0.0f;
        (void)stribeck_joint_next_f32(&joint, &sample, &torque, NULL);
        command = torque;
    }
}
