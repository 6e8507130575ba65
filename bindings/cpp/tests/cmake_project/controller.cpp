/// Turns readings into set-points until it is stopped.

#include "rover.scl.hpp"

#include <iostream>

int main() {
    rover::Controller controller;
    for (auto& measurement : controller.sensor) {
        rover::Setpoint setpoint;
        setpoint.set_throttle(measurement.speed() / 2);
        controller.actuator.send(setpoint);
        std::cout << measurement.speed() << std::endl;
    }
}
