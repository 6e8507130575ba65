/// Unit tests of a component of `testable.yaml`, as its generated header makes them possible.

#include "testable.scl.hpp"

#include <chrono>
#include <cstdlib>
#include <future>
#include <iostream>
#include <string>
#include <thread>

using namespace std::chrono_literals;
using testable::Command;
using testable::Controller;
using testable::ControllerPeer;
using testable::Reading;
using testable::Setpoint;
using testable::Status;

#define CHECK(condition)                                                                                               \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            std::cerr << __FILE__ << ":" << __LINE__ << ": not true: " #condition "\n";                              \
            std::exit(1);                                                                                              \
        }                                                                                                              \
    } while (false)

static Reading reading(double speed) {
    Reading reading;
    reading.set_speed(speed);
    return reading;
}

static Command command(double speed) {
    Command command;
    command.set_target_speed(speed);
    return command;
}

template <class Call> static std::string error_of(Call&& call) {
    try {
        call();
    } catch (const scl::Error& error) {
        return error.what();
    }
    return "nothing was thrown";
}

static void messages_go_both_ways() {
    auto [controller, peer] = Controller::test();
    static_assert(std::is_same_v<decltype(peer), ControllerPeer>);
    // `setpoints` has two peers in the topology, and all of them are the one counterpart.
    controller.ready(0s);
    peer.ready(0s);
    CHECK(controller.name() == "controller" && peer.name() == "controller's peers");
    CHECK(peer.readings.name() == "controller's peers.readings" && peer.readings.is_connected());

    peer.readings.send(reading(0.25));
    CHECK(controller.readings.try_recv()->speed() == 0.25);
    Setpoint setpoint;
    setpoint.set_throttle(0.75);
    controller.setpoints.send(setpoint);
    CHECK(scl::wait(0s, peer.setpoints, peer.log).to_ulong() == 1);
    CHECK(peer.setpoints.recv().throttle() == 0.75);
    controller.log.send("a line");
    CHECK(peer.log.recv().to_string() == "a line");
    peer.class_.send("a note");
    CHECK(controller.class_.recv().to_string() == "a note");
    peer.jobs.send(reading(2));
    CHECK(controller.jobs.recv().speed() == 2);
}

static void the_newest_reading_counts() {
    for (int round = 0; round < 20; ++round) {
        auto [controller, peer] = Controller::test();
        for (int part = 0; part < 3; ++part) {
            for (int speed = 0; speed < 100; ++speed) {
                peer.readings.send(reading(speed));
            }
            auto newest = part == 0   ? controller.readings.recv(300s)
                          : part == 1 ? controller.readings.try_recv()
                                      : controller.readings.latest();
            CHECK(newest && newest->speed() == 99);
        }
    }
}

static void missed_messages_are_told() {
    auto [controller, peer] = Controller::test();
    std::uint64_t told = 0;
    for (int count = 0; count < 3; ++count) {
        // Nothing is sent, so the deadline passes.
        std::uint64_t missed = 0;
        while ((missed = controller.readings.take_missed()) == 0) {
        }
        told += missed;
    }
    const std::string stats = controller.readings.stats(), key = "\"missed\":";
    CHECK(std::stoull(stats.substr(stats.find(key) + key.size())) >= told);
    CHECK(error_of([&] { controller.jobs.take_missed(); }).find("`controller.jobs` has no `deadline`") != std::string::npos);
    std::error_code error;
    CHECK(controller.jobs.take_missed(error) == 0 && error == scl::Errc::failed);
    (void)controller.readings.take_missed(error);
    CHECK(!error);
}

static void requests_are_answered() {
    auto [controller, peer] = Controller::test();
    for (int speed = 1; speed < 3; ++speed) {
        auto reply =
            std::async(std::launch::async, [&peer = peer, speed] { return peer.commands.call(command(speed)); });
        auto request = controller.commands.recv();
        Status status;
        status.set_accepted(request->target_speed() < 2);
        request.reply(status);
        CHECK(reply.get().accepted() == (speed < 2));
    }
    auto error = error_of([&controller = controller] { controller.limits.call(command(1)); });
    CHECK(error.find("gate `controller.limits` got no reply from `world.limits` within ") == 0);
}

static void closing_ends_calls_that_wait() {
    auto [controller, peer] = Controller::test();
    auto ended = std::async(std::launch::async, [&controller = controller] {
        return error_of([&] { controller.readings.recv(); });
    });
    // The call may not have begun yet; then it is refused.
    controller.close();
    CHECK(ended.get() != "nothing was thrown");
    CHECK(!peer.setpoints.recv(10ms));
    auto error = error_of([&peer = peer] { peer.ready(10ms); });
    CHECK(error.find("component `controller's peers` is not ready") == 0);
    peer.close();
}

/// Neither time nor warnings for what a test leaves unread.
static void what_nobody_reads_is_no_problem() {
    auto [controller, peer] = Controller::test();
    for (int count = 0; count < 50; ++count) {
        peer.readings.send(reading(1));
        controller.setpoints.send(Setpoint());
        controller.spare.send(reading(1));
    }
    CHECK(!peer.spare.try_recv());
}

static void components_are_moved_and_stand_alone() {
    auto pair = Controller::test();
    Controller controller = std::move(pair.first);
    std::thread([peer = std::move(pair.second)]() mutable { peer.readings.send(reading(1)); }).join();
    CHECK(controller.readings.recv().speed() == 1);

    auto [first, first_peer] = Controller::test();
    auto [second, second_peer] = Controller::test();
    first_peer.readings.send(reading(1));
    second_peer.readings.send(reading(2));
    CHECK(first.readings.recv().speed() == 1 && second.readings.recv().speed() == 2);
    auto [empty, empty_peer] = testable::Empty::test();
    empty.close();
}

/// A program may open no component at all, and then its errors are its own.
static void a_test_leaves_the_terminate_handler_alone() {
    auto before = std::get_terminate();
    auto [controller, peer] = Controller::test();
    CHECK(std::get_terminate() == before);
}

int main() {
    messages_go_both_ways();
    the_newest_reading_counts();
    missed_messages_are_told();
    requests_are_answered();
    closing_ends_calls_that_wait();
    what_nobody_reads_is_no_problem();
    components_are_moved_and_stand_alone();
    a_test_leaves_the_terminate_handler_alone();
    std::cout << "done" << std::endl;
}
