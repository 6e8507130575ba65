// Plays a motor of `motors.yaml` as `motors.rs` does: the one that SCL_COMPONENT names, or `motor left_motor`. `motor
// controller` and `motor display` play these, and `motor test` tests itself.
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

// Follows commands such as `left 1`, and says which motor has answered.
void control() {
    motors::Controller controller;
    if (controller.states.sender()) {
        throw std::logic_error("nothing was received yet");
    }
    std::cout << "open" << std::endl;
    std::string side, value;
    while (std::cin >> side >> value) {
        controller.ready();
        (side == "left" ? controller.left : controller.right).send(value);
        const auto [motor, state] = controller.states.recv_from();
        std::cout << (motor == MotorInstance::LeftMotor ? "left_motor " : "right.motor ") << state << std::endl;
    }
}

// Says every number and where it comes from.
void display() {
    using Sender = motors::DisplayNumbersSender;
    motors::Display display;
    std::cout << "open" << std::endl;
    for (const auto& number : display.numbers) {
        switch (*display.numbers.sender()) {
        case Sender::LeftMotor:
            std::cout << "LeftMotor ";
            break;
        case Sender::RightMotor:
            std::cout << "RightMotor ";
            break;
        case Sender::ControllerLeft:
            std::cout << "ControllerLeft ";
            break;
        case Sender::ControllerRight:
            std::cout << "ControllerRight ";
            break;
        }
        std::cout << number << std::endl;
    }
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
    if (chosen == "controller") {
        control();
        return 0;
    }
    if (chosen == "display") {
        display();
        return 0;
    }
    Motor motor = open(chosen);
    motor.ready();
    std::cout << (motor.instance() == MotorInstance::LeftMotor ? "left_motor" : "right.motor") << std::endl;
    while (true) {
        answer(motor);
    }
} catch (const std::exception& error) {
    std::cerr << error.what() << std::endl;
    return 1;
}
