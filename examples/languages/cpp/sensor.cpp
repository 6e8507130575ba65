// Publishes a made-up speed ten times a second.
#include "rover.scl.hpp"

#include <cmath>
#include <cstdio>
#include <thread>

int main() {
    setlinebuf(stdout);
    rover::Sensor sensor;
    for (int step = 0;; step++) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        rover::Measurement measurement;
        measurement.set_speed(1.0 + std::sin(step));
        std::printf("speed %.2f m/s\n", measurement.speed());
        sensor.measurements.send(measurement);
    }
}
