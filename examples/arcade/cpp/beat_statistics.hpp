/// How punctual the control loop is: a histogram of the times between its beats.
#pragma once

#include <array>
#include <cstdint>
#include <string>

class BeatStatistics {
  public:
    /// Takes the time of an inertial reading by the vehicle's clock, and when the control loop received it.
    void add(std::uint64_t reading_us, std::uint64_t began_ns);
    /// Starts a new histogram; the next period is counted from the last beat.
    void clear();

    /// Periods between two consecutive readings.
    std::uint64_t count() const { return count_; }
    /// The period that this part of all periods does not exceed, in us, with the resolution of the histogram.
    double quantile_us(double part) const;
    double max_us() const { return max_us_; }
    /// Periods that were more than half a period too long.
    std::uint64_t late() const { return late_; }
    /// Readings without a beat: the autopilot was not running, or beats were lost on their way.
    std::uint64_t missing() const { return missing_; }

    /// Such as `"periods":300,"p50_us":3330,"p99_us":3410,"max_us":3522,"late":0,"missing":0`.
    std::string to_json() const;

    static constexpr double PERIOD_US = 1e6 / 300;

  private:
    static constexpr double BIN_US = 10;

    std::array<std::uint32_t, 2000> bins_{}; // up to 20 ms; the last one also has everything longer
    std::uint64_t count_ = 0, late_ = 0, missing_ = 0;
    double max_us_ = 0;
    std::uint64_t last_reading_us_ = 0, last_began_ns_ = 0; // 0 before the first beat
};
