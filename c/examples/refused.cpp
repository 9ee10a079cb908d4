// Messages of the library for invalid settings, and a joint in double precision.
#include <array>
#include <cmath>
#include <iostream>

#include "stribeck.h"

int main()
{
    const std::array<double, 3> parameters{1.5, 2.0, 0.05};
    stribeck_settings_f64 settings{};
    settings.model = "coulomb+load";
    settings.parameters = parameters.data();
    settings.parameter_count = 2;
    settings.period = 0.001;
    settings.torque_limit = 50.0;
    settings.speed_limit = 10.0;

    stribeck_joint_f64 joint;
    std::cout << stribeck_message(stribeck_joint_init_f64(&joint, &settings)) << '\n';
    std::size_t count = 0;
    stribeck_parameter_count(settings.model, &count);
    std::cout << count << " parameters\n";

    settings.model = "coulomb";
    if (stribeck_joint_init_f64(&joint, &settings) != STRIBECK_STATUS_OK) {
        return 2;
    }
    stribeck_sample_f64 sample{};
    double torque = 0.0;
    for (const double velocity : {-1.0, std::nan(""), 0.0}) {
        sample.velocity = velocity;
        stribeck_source source;
        stribeck_joint_next_f64(&joint, &sample, &torque, &source);
        std::cout << torque << (source == STRIBECK_SOURCE_LAW ? " law" : " none") << '\n';
    }
    return 0;
}
