// Applies each set-point.
#include "rover.scl.hpp"

#include <cstdio>

int main() {
    setlinebuf(stdout);
    rover::Actuator actuator;
    for (const auto& setpoint : actuator.setpoint) {
        std::printf("throttle %+.2f\n", setpoint.throttle());
    }
}
