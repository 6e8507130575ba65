/// Plays `left` of `twins.yaml` until a signal ends it: `signalled TASK`. `guarded` tells that destructors were run.

#include "support.hpp"
#include "twins.scl.hpp"

#include <poll.h>

#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <thread>

using support::say;
using test::Number;

static constexpr std::uint64_t motors_off = 4242;

static Number number(std::uint64_t value) {
    Number number;
    number.set_value(value);
    return number;
}

struct Guard {
    ~Guard() { say("unwound"); }
};

static void play(const std::string& task) {
    if (task == "own_handler") {
        std::set_terminate([] {
            say("the handler of the program");
            std::_Exit(7);
        });
    }
    twins::Left left;
    Guard guard;
    if (task == "handled") {
        left.ready(std::chrono::seconds(30));
        scl::handle_stop();
    }
    say("running");
    if (task == "send") {
        for (std::uint64_t value = 0;; ++value) {
            left.values.send(number(value));
        }
    } else if (task == "try_send") {
        for (std::uint64_t value = 0;; ++value) {
            (void)left.values.try_send(number(value));
        }
    } else if (task == "receive") {
        left.values_in.recv();
    } else if (task == "receive_within") {
        left.values_in.recv(std::chrono::hours(1));
    } else if (task == "log_errors") {
        while (true) {
            try {
                left.values_in.recv();
            } catch (const std::exception& error) {
                support::say_error(error);
            }
        }
    } else if (task == "pull") {
        left.jobs_in.recv();
    } else if (task == "call") {
        // A replier that is stopped first is no failure of this program.
        std::error_code error;
        while (error != scl::Errc::stopped) {
            left.question.call(number(1), error);
        }
    } else if (task == "serve") {
        left.answer.recv();
    } else if (task == "wait") {
        scl::wait(scl::TimeLimit::none(), left.values_in, left.jobs_in, left.answer);
    } else if (task == "for_messages") {
        for (auto& message : left.values_in) {
            (void)message;
        }
    } else if (task == "for_requests") {
        for (auto& request : left.answer) {
            request.reply(*request);
        }
    } else if (task == "poll") {
        pollfd readable{left.fd(), POLLIN, 0};
        while (!scl::stop_requested()) {
            ::poll(&readable, 1, -1);
        }
    } else if (task == "thread") {
        // Nobody catches what the thread throws.
        std::thread([&] { left.values_in.recv(); }).join();
    } else if (task == "ready_never") {
        left.ready();
        left.values_in.recv();
    } else if (task == "burst") {
        left.ready(std::chrono::seconds(30));
        say("ready");
        support::Command().read();
        for (std::uint64_t value = 0; value < 100; ++value) {
            left.jobs.send(number(value));
        }
        throw scl::Timeout("after a burst");
    } else if (task == "other_exception" || task == "own_handler") {
        throw std::logic_error("not of SCL");
    } else if (task == "handled") {
        for (std::uint64_t value = 0; !scl::stop_requested(); ++value) {
            left.values.send(number(value));
        }
        left.jobs.send(number(motors_off));
    }
}

int main(int, char** arguments) {
    std::string task = arguments[1];
    if (task.rfind("guarded_", 0) == 0) {
        try {
            play(task.substr(8));
        } catch (const scl::Stopped&) {
            say("stopped");
        }
        return 0;
    }
    play(task);
}
