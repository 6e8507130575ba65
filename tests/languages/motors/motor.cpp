// Plays a motor of `motors.yaml` as `motors.rs` does: the one that SCL_COMPONENT names, or `motor left_motor`. With `motor
// test`, it tests itself.
#include "motors.scl.hpp"

#include <iostream>
#include <stdexcept>
#include <string>

using motors::Motor;
using motors::MotorInstance;

namespace {

void answer(Motor& motor) { motor.state.send(motor.setpoint.recv() + "0"); }

void test() {
    auto [motor, peer] = Motor::test();
    if (motor.instance() != MotorInstance::LeftMotor) {
        throw std::logic_error("a test opens the first component");
    }
    peer.setpoint.send("7");
    answer(motor);
    std::cout << peer.state.recv() << std::endl;
}

Motor open(const std::string& chosen) {
    if (chosen == "left_motor") {
        return Motor(MotorInstance::LeftMotor);
    }
    return chosen == "neither" ? Motor(static_cast<MotorInstance>(2)) : Motor();
}

} // namespace

int main(int count, char** arguments) try {
    const std::string chosen = count > 1 ? arguments[1] : "";
    if (chosen == "test") {
        test();
        return 0;
    }
    Motor motor = open(chosen);
    motor.ready();
    std::cout << (motor.instance() == MotorInstance::LeftMotor ? "left_motor" : "right_motor") << std::endl;
    while (true) {
        answer(motor);
    }
} catch (const std::exception& error) {
    std::cerr << error.what() << std::endl;
    return 1;
}
