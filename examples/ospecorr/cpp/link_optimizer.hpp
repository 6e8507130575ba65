// The link optimizer: does the gates, and leaves decisions to `SpectrumMobility`.
#pragma once

#include "ospecorr.scl.hpp"

#include <functional>

// Runs until it is stopped; then it silences the radio.
void run(ospecorr::LinkOptimizer optimizer, const std::function<bool()> &is_stopped);
