// Steers towards the speed that the user interface asks for.
#include "rover.scl.hpp"

#include <algorithm>
#include <cstdio>

int main() {
    rover::Controller c;
    double target_speed = 1.0;
    while (true) {
        scl::wait(scl::TimeLimit::none(), c.sensor, c.commands);
        if (auto measured = c.sensor.try_recv()) {
            rover::Setpoint setpoint;
            setpoint.set_throttle(std::clamp(target_speed - measured->speed(), -1.0, 1.0));
            c.actuator.send(setpoint);
        }
        if (auto command = c.commands.try_recv()) {
            target_speed = (*command)->target_speed();
            char text[60];
            std::snprintf(text, sizeof text, "target is now %.1f m/s", target_speed);
            rover::Event event;
            event.set_text(text);
            c.events.send(event);
            rover::Status status;
            status.set_accepted(true);
            // A user interface that has been stopped no longer waits for the reply.
            std::error_code gone;
            command->reply(status, gone);
        }
    }
}
