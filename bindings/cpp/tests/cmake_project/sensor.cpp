#include "rover.scl.hpp"
#include "hardware.hpp"
int main() {
    rover::Sensor sensor;
    while (true) {
        rover::Measurement m;
        m.set_speed(read_hardware());
        sensor.measurements.send(m);
    }
}
