/// Plays `leaver` of `exits.yaml`: sends numbers, and the last ones while the process or a thread ends: `exits HOW`.

#include "exits.scl.hpp"

#include <cstdlib>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include <pthread.h>
#include <unistd.h>

using exits::Leaver;

static void send(Leaver& leaver, std::uint64_t first, std::uint64_t end) {
    for (std::uint64_t value = first; value < end; ++value) {
        test::Number number;
        number.set_value(value);
        leaver.jobs.send(number);
    }
}

/// Sends the last numbers when it is destroyed.
struct Last {
    Leaver leaver;

    Last() {
        leaver.ready();
        send(leaver, 0, 100);
    }

    ~Last() {
        try {
            send(leaver, 100, 200);
            leaver.close(std::chrono::minutes(1));
            std::cout << "closed" << std::endl;
        } catch (const scl::Error& error) {
            std::cout << "error: " << error.what() << std::endl;
        }
    }
};

static std::unique_ptr<Last> of_program;
thread_local std::unique_ptr<Last> of_thread;

/// A static object of a function.
static Last& local() {
    static Last last;
    return last;
}

static void end() { of_program.reset(); }

int main(int count, char** arguments) {
    std::string how = count > 1 ? arguments[1] : "";
    if (how == "static object") {
        of_program = std::make_unique<Last>();
    } else if (how == "static object of a function") {
        local();
    } else if (how == "atexit") {
        of_program = std::make_unique<Last>();
        std::atexit(end);
    } else if (how == "quick_exit") {
        of_program = std::make_unique<Last>();
        std::at_quick_exit(end);
        std::quick_exit(0);
    } else if (how == "thread-local object") {
        // Made before the thread-local values of the library, so destroyed after them; in the other thread, the other way round.
        of_thread.reset();
        of_thread = std::make_unique<Last>();
    } else if (how == "thread-local object of a thread") {
        std::thread([] { of_thread = std::make_unique<Last>(); }).join();
    } else if (how == "exit of another thread") {
        Last& last = local();
        std::thread([] { std::exit(0); }).detach();
        try {
            last.leaver.answer.recv();
        } catch (const scl::Error&) {
            ::pause();
        }
    } else if (how == "end of the main thread") {
        local();
        std::thread([] { std::exit(0); }).detach();
        ::pthread_exit(nullptr);
    } else if (how == "uncaught error") {
        // It closes all components that are open, so the numbers that were sent arrive.
        static Leaver leaver;
        leaver.ready();
        send(leaver, 0, 200);
        throw scl::Error(scl::Errc::failed, "closed");
    }
    return 0;
}
