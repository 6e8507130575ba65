// A wheel: it follows the set-point, and stops when none comes.
#include "drive.scl.hpp"

#include <chrono>
#include <thread>

int main() {
    drive::Wheel wheel;
    drive::Record record;
    record.set_component(wheel.name());
    record.set_text("runs in C++");
    wheel.log.send(record);

    double target = 0, speed = 0;
    while (true) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        if (wheel.setpoint.take_missed() > 0) {
            target = 0;
        }
        if (const auto setpoint = wheel.setpoint.latest()) {
            target = setpoint->speed();
        }
        speed += (target - speed) * wheel.parameters.response;
        drive::WheelState state;
        state.set_speed(speed);
        state.set_language("C++");
        wheel.state.send(state);
    }
}
