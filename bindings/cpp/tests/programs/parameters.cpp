/// The parameters of `controls.yaml`. The environment has `SCL_SET=controller.gain=1.5,left_motor.pin=3`.

#include "controls.scl.hpp"

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

using namespace std::chrono_literals;
using controls::Controller;
using controls::ControllerMode;
using controls::Motor;
using controls::MotorDirection;
using controls::MotorInstance;

#define CHECK(condition)                                                                                               \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            std::cerr << __FILE__ << ":" << __LINE__ << ": not true: " #condition "\n";                              \
            std::exit(1);                                                                                              \
        }                                                                                                              \
    } while (false)

/// Returns the error that a call throws.
template <class Call> static scl::Error error_of(Call call) {
    try {
        call();
    } catch (const scl::Error& error) {
        return error;
    }
    std::cerr << "nothing was thrown\n";
    std::exit(1);
}

static bool has(const scl::Error& error, scl::Errc kind, const std::string& words) {
    const bool found = error.code() == kind && std::string(error.what()).find(words) != std::string::npos;
    if (!found) {
        std::cerr << error.what() << "\n";
    }
    return found;
}

static void every_type_has_its_default() {
    auto [controller, peer] = Controller::test();
    const auto& found = controller.parameters;
    CHECK(found.gain == 0.8 && found.ratio == 0.5f && found.period == 10ms);
    CHECK(found.label == "left \"front\"" && found.enabled && !found.class_);
    CHECK(found.mode == ControllerMode::Manual);
    CHECK(found.offsets[0] == 0 && found.offsets[1] == 0.5 && found.offsets[2] == -1);
    CHECK((found.names == std::vector<std::string>{"a", "b, c"}));
    CHECK((found.delays == std::vector<std::chrono::nanoseconds>{1ms, 2s}));
    CHECK(found.flags[0] && !found.flags[1] && found.limits.empty());
    CHECK(found.corners[0] == "north" && found.corners[1] == "south");
    CHECK(found.i8 == -8 && found.i16 == -16 && found.i32 == -32 && found.i64 == INT64_MIN);
    CHECK(found.u8 == 8 && found.u16 == 16 && found.u32 == 32 && found.u64 == UINT64_MAX);
    CHECK(found.list.size() == 2 && found.list[1] == 2);
    // They are the program's own.
    Controller moved = std::move(controller);
    CHECK(moved.parameters.label == "left \"front\"");
}

static void values_are_set() {
    scl::Options options;
    options.set = {{"controller.mode", "auto"}, {"controller.label", "\"a\\b\"\n"}, {"left_motor.pin", "9"}};
    Controller controller(options);
    CHECK(controller.parameters.gain == 1.5 && controller.parameters.mode == ControllerMode::Auto);
    CHECK(controller.parameters.label == "\"a\\b\"\n");
    Motor motor(MotorInstance::LeftMotor);
    CHECK(motor.parameters.pin == 3 && motor.parameters.direction == MotorDirection::ClockWise);
}

static void a_unit_test_sets_values() {
    CHECK(has(error_of([] { Motor::test(); }), scl::Errc::environment, "`left_motor.pin` (u8) has no value"));
    scl::Options options;
    options.set["left_motor.pin"] = "256";
    CHECK(has(error_of([&] { Motor::test(options); }), scl::Errc::environment, "from 0 to 255, found `256`"));
    options.set["left_motor.pin"] = "4";
    auto [motor, peer] = Motor::test(options);
    CHECK(motor.parameters.pin == 4);
}

/// What programs without generated code do.
static void values_are_read_by_name() {
    auto [controller, peer] = Controller::test();
    const scl::Component& component = controller;
    CHECK(scl::parameter<double>(component, "gain") == 0.8);
    CHECK(scl::parameter<float>(component, "gain") == 0.8f);
    CHECK(scl::parameter<std::string>(component, "mode") == "manual");
    CHECK(scl::parameter<std::chrono::nanoseconds>(component, "period") == 10ms);
    CHECK(scl::parameter<int>(component, "u16") == 16 && scl::parameter<unsigned>(component, "u8") == 8);
    CHECK(scl::parameter<std::vector<float>>(component, "offsets").back() == -1);
}

static void live_parameters_are_taken_over() {
    auto [controller, peer] = Controller::test();
    CHECK(!controller.update_parameters());
    controller.set_parameter("gain", "2.5");
    controller.set_parameter("names", "[\"a\"]");
    CHECK(controller.parameters.gain == 0.8);
    CHECK(controller.update_parameters() && !controller.update_parameters());
    CHECK(controller.parameters.gain == 2.5 && controller.parameters.names == std::vector<std::string>{"a"});
    CHECK(controller.parameters.mode == ControllerMode::Manual);
    CHECK(scl::parameter<double>(controller, "gain") == 2.5);
    CHECK(!controller.update_parameters(1us));
    std::thread setter([&component = controller] { component.set_parameter("gain", "4"); });
    CHECK(controller.update_parameters(scl::TimeLimit::none()) && controller.parameters.gain == 4);
    setter.join();
    auto set = [&component = controller](const char* name, const char* value) {
        return error_of([&] { component.set_parameter(name, value); });
    };
    CHECK(has(set("gian", "1"), scl::Errc::name, "did you mean `gain`?"));
    CHECK(has(set("u8", "1"), scl::Errc::argument, "is fixed while its program runs"));
    CHECK(has(set("gain", "11"), scl::Errc::argument, "`11` is not from 0 to 10"));
}

static void wrong_reads_are_explained() {
    auto [controller, peer] = Controller::test();
    const scl::Component& component = controller;
    auto read = [&](auto type, const char* name) {
        return error_of([&] { scl::parameter<decltype(type)>(component, name); });
    };
    CHECK(has(read(0.0, "gian"), scl::Errc::name, "no parameter `gian`; did you mean `gain`?"));
    CHECK(has(read(0, "gain"), scl::Errc::kind, "`controller.gain` (f64) is not a whole number"));
    CHECK(has(read(std::int8_t(), "i64"), scl::Errc::kind, "is -9223372036854775808, which the type of the program"));
    CHECK(has(read(std::int64_t(), "u64"), scl::Errc::kind, "is not a whole number that an int64_t holds"));
    CHECK(has(read(std::uint8_t(), "i8"), scl::Errc::kind, "is not a whole number that a uint64_t holds"));
    CHECK(has(read(std::string(), "enabled"), scl::Errc::kind, "(bool) is not a text"));
}

int main() {
    every_type_has_its_default();
    values_are_set();
    a_unit_test_sets_values();
    values_are_read_by_name();
    wrong_reads_are_explained();
    live_parameters_are_taken_over();
    std::cout << "done" << std::endl;
}
