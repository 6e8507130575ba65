// Keeps what happened in a log of limited size: the flight, the battery, records of the others, and how punctual the control loop was.
#include "black_box.hpp"
#include "options.hpp"

#include <chrono>
#include <cstdio>

using namespace std::chrono_literals;

int main(int count, char** arguments) {
    setlinebuf(stdout);
    auto options = read_options(count, arguments);
    arcade::Blackbox component;
    RingLog log(options.folder, options.size);
    BlackBox black_box(log);
    // After a stop request the gates keep working, so that the last records are not lost.
    scl::handle_stop();
    auto next_flush = std::chrono::steady_clock::now();
    while (!scl::stop_requested()) {
        // Records wake it, because their senders wait when the queue is full. For the others, ten times a second saves processor time.
        scl::wait(100ms, component.records);
        black_box.drain(component);
        if (auto now = std::chrono::steady_clock::now(); now >= next_flush) {
            black_box.flush();
            next_flush = now + 1s;
        }
    }
    black_box.drain(component);
    black_box.flush();
    std::printf("%s\n", black_box.summary().c_str());
}
