// The histogram of the control loop's periods.
#include "beat_statistics.hpp"
#include "check.hpp"

static const std::uint64_t PERIOD_NS = 3'333'333;

static std::uint64_t reading_us(std::uint64_t number) {
    return number * 1'000'000 / 300;
}

static void quantiles_count_all_periods() {
    BeatStatistics beats;
    std::uint64_t now = 1;
    beats.add(reading_us(1), now);
    for (std::uint64_t number = 2; number <= 101; number++) {
        // 97 periods of 3.33 ms, two of 4 ms, and one that is late.
        now += number <= 98 ? PERIOD_NS : number < 101 ? 4'000'000 : 7'000'000;
        beats.add(reading_us(number), now);
    }
    CHECK(beats.count() == 100);
    CHECK(beats.quantile_us(0.5) == 3340);
    CHECK(beats.quantile_us(0.97) == 3340);
    CHECK(beats.quantile_us(0.99) == 4010);
    CHECK(beats.quantile_us(1.0) == 7000);
    CHECK(beats.max_us() == 7000);
    CHECK(beats.late() == 1);
    CHECK(beats.missing() == 0);
    CHECK(beats.to_json() == "\"periods\":100,\"p50_us\":3340,\"p99_us\":4010,\"max_us\":7000,\"late\":1,\"missing\":0");
}

static void a_gap_is_counted_and_is_no_period() {
    BeatStatistics beats;
    beats.add(reading_us(1), PERIOD_NS);
    beats.add(reading_us(2), 2 * PERIOD_NS);
    beats.add(reading_us(32), 32 * PERIOD_NS);
    beats.add(reading_us(33), 33 * PERIOD_NS);
    CHECK(beats.count() == 2);
    CHECK(beats.missing() == 29);
    CHECK(beats.max_us() < 3334);
}

static void another_flight_starts_anew() {
    BeatStatistics beats;
    beats.add(reading_us(500), 500 * PERIOD_NS);
    beats.add(reading_us(1), 900 * PERIOD_NS);
    beats.add(reading_us(2), 901 * PERIOD_NS);
    CHECK(beats.count() == 1);
    CHECK(beats.missing() == 0);
    CHECK(beats.late() == 0);
}

static void a_period_beyond_the_histogram_is_the_longest() {
    BeatStatistics beats;
    beats.add(reading_us(1), 1);
    beats.add(reading_us(2), 1 + 50'000'000);
    CHECK(beats.quantile_us(0.99) == 50'000);
    CHECK(beats.late() == 1);
}

static void clearing_keeps_the_last_beat() {
    BeatStatistics beats;
    beats.add(reading_us(1), PERIOD_NS);
    beats.add(reading_us(2), 2 * PERIOD_NS);
    beats.clear();
    CHECK(beats.count() == 0);
    CHECK(beats.quantile_us(0.5) == 0);
    beats.add(reading_us(3), 3 * PERIOD_NS);
    CHECK(beats.count() == 1);
}

int main() {
    quantiles_count_all_periods();
    a_gap_is_counted_and_is_no_period();
    another_flight_starts_anew();
    a_period_beyond_the_histogram_is_the_longest();
    clearing_keeps_the_last_beat();
}
