/// The hardware of the example.
#pragma once

#include <chrono>
#include <thread>

inline double read_hardware() {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return 1.5;
}
