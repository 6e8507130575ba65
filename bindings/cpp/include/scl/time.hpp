/// Time limits: `std::chrono` durations as the nanoseconds of the C interface.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace scl {

/// A time limit. Any `std::chrono` duration converts to it; negative ones become 0, and durations too long for a
/// number of nanoseconds (292 years) mean no limit.
class TimeLimit {
  public:
    template <class Rep, class Period>
    constexpr TimeLimit(std::chrono::duration<Rep, Period> time) noexcept : nanoseconds_(convert(time)) {}

    /// No limit.
    static constexpr TimeLimit none() noexcept { return TimeLimit(-1); }

    /// For the C interface; negative means no limit.
    constexpr std::int64_t nanoseconds() const noexcept { return nanoseconds_; }

  private:
    constexpr explicit TimeLimit(std::int64_t nanoseconds) noexcept : nanoseconds_(nanoseconds) {}

    template <class Rep, class Period>
    static constexpr std::int64_t convert(std::chrono::duration<Rep, Period> time) noexcept {
        using Seconds = std::chrono::duration<double>;
        constexpr double longest = 9.2e9;
        if (!(time > time.zero())) {
            return 0;
        }
        if (!(std::chrono::duration_cast<Seconds>(time).count() < longest)) {
            return -1;
        }
        auto nanoseconds = std::chrono::duration_cast<std::chrono::nanoseconds>(time);
        // A positive time is never rounded to "do not wait".
        return nanoseconds.count() > 0 ? nanoseconds.count() : 1;
    }

    std::int64_t nanoseconds_;
};

} // namespace scl
