// The link optimizer: does the gates, and leaves decisions to `SpectrumMobility`.
#pragma once

#include "ospecorr.scl.hpp"

// Runs until a stop is requested; then it silences the radio.
void run(ospecorr::LinkOptimizer optimizer);
