// Which requirements of an application a channel can fulfil.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

// What the link can do, whichever channel it uses.
struct Capability {
    double rate = 90'000;      // bytes a second: 1 bit/s per Hz of 1 MHz, without quiet periods and redundancy
    double shortest_gap = 0.1; // seconds that a change of the channel may take
};

// Why the requirements cannot be fulfilled; empty if they can.
inline std::string refusal(double rate, double longest_gap, Capability capability = {}) {
    char text[120] = "";
    if (!(rate > 0) || std::isinf(rate)) {
        std::snprintf(text, sizeof text, "a rate of %g bytes/s is not a positive number", rate);
    } else if (rate > capability.rate) {
        std::snprintf(text, sizeof text, "%.0f bytes/s are more than the %.0f bytes/s that a channel carries", rate,
                      capability.rate);
    } else if (!(longest_gap >= capability.shortest_gap)) {
        std::snprintf(text, sizeof text,
                      "a longest gap of %g s is shorter than the %g s that a change of the channel takes", longest_gap,
                      capability.shortest_gap);
    }
    return text;
}
