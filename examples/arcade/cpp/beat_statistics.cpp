#include "beat_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

void BeatStatistics::add(std::uint64_t reading_us, std::uint64_t began_ns) {
    // A clock that goes backwards belongs to another flight.
    bool follows = last_began_ns_ != 0 && reading_us > last_reading_us_ && began_ns > last_began_ns_;
    double readings = follows ? std::round(static_cast<double>(reading_us - last_reading_us_) / PERIOD_US) : 0;
    if (readings > 1) {
        missing_ += static_cast<std::uint64_t>(readings) - 1;
    } else if (follows) {
        double period_us = static_cast<double>(began_ns - last_began_ns_) / 1e3;
        auto bin = std::min(period_us / BIN_US, static_cast<double>(bins_.size() - 1));
        bins_[static_cast<std::size_t>(bin)]++;
        count_++;
        late_ += period_us > 1.5 * PERIOD_US;
        max_us_ = std::max(max_us_, period_us);
    }
    last_reading_us_ = reading_us;
    last_began_ns_ = began_ns;
}

void BeatStatistics::clear() {
    bins_ = {};
    count_ = late_ = missing_ = 0;
    max_us_ = 0;
}

double BeatStatistics::quantile_us(double part) const {
    auto wanted = static_cast<std::uint64_t>(std::ceil(part * static_cast<double>(count_)));
    std::uint64_t seen = 0;
    for (std::size_t bin = 0; bin < bins_.size() - 1; bin++) {
        seen += bins_[bin];
        if (seen >= wanted) {
            return std::min(static_cast<double>(bin + 1) * BIN_US, max_us_);
        }
    }
    return max_us_;
}

std::string BeatStatistics::to_json() const {
    char text[200];
    std::snprintf(text, sizeof text,
                  "\"periods\":%llu,\"p50_us\":%.0f,\"p99_us\":%.0f,\"max_us\":%.0f,\"late\":%llu,\"missing\":%llu",
                  static_cast<unsigned long long>(count_), quantile_us(0.5), quantile_us(0.99), max_us_,
                  static_cast<unsigned long long>(late_), static_cast<unsigned long long>(missing_));
    return text;
}
