"""The quality of service and its clock."""

import pytest

from quality import Pace, QualityMonitor, Requirement, SpectrumClock

# 100 frames of 200 bytes a second.
REQUIRED = Requirement(rate=20_000, longest_gap=0.1)


def monitor(*times_us: int) -> QualityMonitor:
    result = QualityMonitor(REQUIRED)
    for time_us in times_us:
        result.received(time_us, 200)
    return result


def every_10_ms(begin_ms: int, end_ms: int) -> list[int]:
    return [ms * 1000 for ms in range(begin_ms, end_ms, 10)]


def test_a_steady_stream_is_served() -> None:
    quality = monitor(*every_10_ms(0, 1000)).at(1_000_000)
    # The window begins after 500 ms.
    assert quality.rate == pytest.approx(20_000, rel=0.021)
    assert quality.served


def test_nothing_is_served_before_the_first_frame() -> None:
    assert monitor().at(0).served is False
    assert monitor().at(10_000_000).rate == 0


@pytest.mark.parametrize(("frames", "served"), [(50, True), (45, True), (44, False)])
def test_nine_tenths_of_the_rate_are_required(frames: int, served: bool) -> None:
    times = [500_000 + int(500_000 * (number + 1) / frames) for number in range(frames)]
    assert monitor(*times).at(1_000_000).served is served


@pytest.mark.parametrize(("gap_ms", "served"), [(100, True), (101, False)])
def test_a_gap_may_be_as_long_as_required(gap_ms: int, served: bool) -> None:
    # The rate is sufficient all the same.
    before = [400_000 + number * 5_000 for number in range(61)]
    after = [700_000 + gap_ms * 1000 + number * 10_000 for number in range(10)]
    assert monitor(*before, *after).at(900_000).served is served


def test_the_time_since_the_last_frame_is_a_gap() -> None:
    times = [500_000 + number * 5_000 for number in range(1, 81)]
    assert monitor(*times).at(1_000_000).served
    assert not monitor(*times).at(1_000_001).served


def test_frames_after_a_restart_of_the_spectrum_count() -> None:
    late = monitor(*every_10_ms(90_000, 100_000), *every_10_ms(10, 600))
    assert late.at(600_000).served


def test_the_clock_goes_on_between_messages() -> None:
    clock = SpectrumClock()
    assert clock.now(100.0) == 0
    clock.update(5_000_000, 100.0)
    assert clock.now(100.25) == pytest.approx(5_250_000, abs=1)


def test_the_clock_follows_a_spectrum_that_is_late_or_has_been_restarted() -> None:
    clock = SpectrumClock()
    clock.update(5_000_000, 100.0)
    clock.update(5_090_000, 100.1)
    assert clock.now(100.1) == 5_090_000
    clock.update(20_000, 100.2)
    assert clock.now(100.2) == 20_000


def test_frames_are_due_by_absolute_times() -> None:
    pace = Pace(0.01, 1.0)
    assert pace.next(1.004) == pytest.approx(1.01)
    assert pace.next(1.013) == pytest.approx(1.02)


def test_a_short_delay_is_caught_up_and_a_long_one_is_not() -> None:
    pace = Pace(0.01, 1.0)
    assert pace.next(1.15) == pytest.approx(1.01)
    assert pace.next(1.15) == pytest.approx(1.02)
    assert pace.next(1.5) == pytest.approx(1.5)
    assert pace.next(1.5) == pytest.approx(1.51)
