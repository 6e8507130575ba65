// Asks for another speed every second and shows what happens.
#include "rover.scl.hpp"

#include <cstdio>
#include <thread>

int main() {
    setlinebuf(stdout);
    rover::UserInterface ui;
    for (double target_speed = 0.5;; target_speed = 2.0 - target_speed) {
        std::this_thread::sleep_for(std::chrono::seconds(1));
        rover::Command command;
        command.set_target_speed(target_speed);
        std::error_code error;
        auto status = ui.commands.call(command, error);
        if (error == scl::Errc::timeout || error == scl::Errc::peer_lost) {
            // The controller is not running, or is being replaced.
            std::printf("asked for %.1f m/s: no answer\n", target_speed);
            continue;
        }
        if (!status) {
            return error == scl::Errc::stopped ? 0 : 1;
        }
        std::printf("asked for %.1f m/s: %s\n", target_speed, status->accepted() ? "accepted" : status->reason().c_str());
        std::printf("event: %s\n", ui.events.recv().text().c_str());
    }
}
