"""What is left in the battery, and what `power` says of it."""

import math
from collections.abc import Callable

import pytest

from arcade_scl import Battery, PowerLevel
from battery import charge_by_voltage, extrapolate, implausible, open_circuit_voltage, update
from defaults import power_parameters
from power_monitor import BLIND_AFTER, Event, Monitor, level_of

OK, LOW, CRITICAL = PowerLevel.POWER_LEVEL_OK, PowerLevel.POWER_LEVEL_LOW, PowerLevel.POWER_LEVEL_CRITICAL
PARAMETERS = power_parameters()


def reading(time: float, charge: float, current: float = 12.0, sag: float = 0.0) -> Battery:
    """A healthy battery of 3 cells, or one whose voltage is lower by `sag` per cell."""
    voltage = 3 * (open_circuit_voltage(charge) - sag) - current * PARAMETERS.resistance
    return Battery(time_us=round(time * 1e6), voltage=voltage, current=current, used=2.2 * (1 - charge), capacity=2.2)


def test_the_curve_is_its_own_inverse() -> None:
    assert open_circuit_voltage(2.0) == pytest.approx(4.20)
    assert open_circuit_voltage(-1.0) == pytest.approx(3.30)
    for percent in range(101):
        assert charge_by_voltage(open_circuit_voltage(percent / 100)) == pytest.approx(percent / 100)


def test_charge_is_counted_and_load_does_not_matter() -> None:
    for current in [0.0, 12.0, 40.0]:
        estimate = update(None, reading(0, 0.62, current), PARAMETERS)
        assert estimate.charge == pytest.approx(0.62)
        assert not estimate.count_is_wrong


def test_time_left_follows_the_smoothed_current() -> None:
    estimate = update(None, reading(0, 0.5), PARAMETERS)
    assert estimate.time_left == pytest.approx(0.5 * 2.2 * 3600 / 12)
    estimate = update(estimate, reading(0.1, 0.5, 36.0), PARAMETERS)
    assert 12 < estimate.current < 13
    for step in range(2, 300):
        estimate = update(estimate, reading(step / 10, 0.5, 36.0), PARAMETERS)
    assert estimate.time_left == pytest.approx(0.5 * 2.2 * 3600 / 36, rel=1e-3)
    idle = update(None, reading(0, 0.5, 0.0), PARAMETERS)
    assert math.isfinite(idle.time_left)


def test_the_voltage_corrects_a_count_that_began_wrong() -> None:
    # The sensor believes in a full battery, but the voltage is that of one with 30 %.
    count = Battery(time_us=0, voltage=3 * open_circuit_voltage(0.3), current=0, used=0, capacity=2.2)
    estimate = update(None, count, PARAMETERS)
    assert estimate.count_is_wrong
    assert estimate.charge == pytest.approx(0.3)


def test_a_short_dip_of_the_voltage_is_no_contradiction() -> None:
    estimate = update(None, reading(0, 0.6), PARAMETERS)
    for step in range(1, 4):
        estimate = update(estimate, reading(step / 10, 0.6, sag=0.3), PARAMETERS)
    assert not estimate.count_is_wrong
    for step in range(4, 40):
        estimate = update(estimate, reading(step / 10, 0.6, sag=0.3), PARAMETERS)
    assert estimate.count_is_wrong


def test_a_contradiction_does_not_come_and_go() -> None:
    estimate = update(None, reading(0, 0.6, sag=0.11), PARAMETERS)
    estimate = update(estimate, reading(99, 0.6, sag=0.09), PARAMETERS)
    assert estimate.count_is_wrong
    estimate = update(estimate, reading(199, 0.6, sag=0.04), PARAMETERS)
    assert not estimate.count_is_wrong
    assert estimate.charge == pytest.approx(0.6)
    estimate = update(estimate, reading(299, 0.6, sag=0.09), PARAMETERS)
    assert not estimate.count_is_wrong


def test_extrapolation_takes_the_last_current() -> None:
    estimate = extrapolate(update(None, reading(0, 0.5), PARAMETERS), 66.0)
    assert estimate.charge == pytest.approx(0.5 - 12 * 66 / 3600 / 2.2)
    assert estimate.time_us == 66_000_000
    assert extrapolate(estimate, 1e6).charge == 0


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"voltage": math.nan}, "voltage is nan V, not 6 to 13.5 V"),
        ({"voltage": 0.0}, "voltage is 0 V"),
        ({"voltage": 25.2}, "voltage is 25.2 V"),
        ({"current": math.inf}, "current is inf A"),
        ({"current": -80.0}, "current is -80 A"),
        ({"capacity": 0.0}, "capacity is 0 Ah"),
        ({"capacity": math.nan}, "capacity is nan Ah"),
        ({"used": math.nan}, "used is nan Ah"),
        ({"used": 5.0}, "used is 5 Ah, not -0.22 to 3.3 Ah"),
    ],
)
def test_implausible_readings(change: dict[str, float], words: str) -> None:
    battery = reading(0, 0.5)
    assert implausible(battery, 3) is None
    for name, value in change.items():
        setattr(battery, name, value)
    assert (implausible(battery, 3) or "").startswith(words)


@pytest.mark.parametrize(
    ("charge", "last", "level"),
    [
        (0.30, OK, OK),
        (0.29, OK, LOW),
        (0.14, OK, CRITICAL),
        (0.31, LOW, LOW),
        (0.36, LOW, OK),
        (0.16, CRITICAL, CRITICAL),
        (0.21, CRITICAL, LOW),
        (0.34, CRITICAL, LOW),
        (0.36, CRITICAL, OK),
        (0.00, LOW, CRITICAL),
    ],
)
def test_levels_have_hysteresis(charge: float, last: PowerLevel, level: PowerLevel) -> None:
    assert level_of(charge, last, PARAMETERS) == level


def texts(events: list[Event]) -> list[str]:
    return [event.text for event in events]


def feed(monitor: Monitor, times: range, of: Callable[[float], Battery | None]) -> list[str]:
    """Feeds tenths of seconds."""
    return [text for tenth in times for text in texts(monitor.update(tenth / 10, of(tenth / 10)))]


def test_each_level_is_said_once() -> None:
    monitor = Monitor(0, PARAMETERS)
    said = feed(monitor, range(1, 1001), lambda time: reading(time, 1 - time / 100))
    assert [text.split(",")[0] for text in said] == [
        "power is ok: 100 % left",
        "power is low: 30 % left",
        "power is critical: 15 % left",
    ]


def test_parameters_change_the_levels() -> None:
    monitor = Monitor(0, PARAMETERS)
    monitor.update(0.1, reading(0.1, 0.5))
    monitor.parameters = power_parameters(low=0.6)
    assert texts(monitor.update(0.2, reading(0.2, 0.5))) == ["power is low: 50 % left, 330 s at 12.0 A"]


def test_bad_readings_are_reported_once_and_do_not_count() -> None:
    monitor = Monitor(0, PARAMETERS)
    monitor.update(0.1, reading(0.1, 0.5))
    bad = Battery(voltage=math.nan, current=math.nan, used=math.nan, capacity=math.nan)
    said = feed(monitor, range(2, 20), lambda _time: bad)
    assert said == [
        "ignoring readings of the battery: voltage is nan V, not 6 to 13.5 V",
        "no plausible reading of the battery for 1 s",
    ]
    assert monitor.power is not None
    assert math.isfinite(monitor.power.charge_left) and math.isfinite(monitor.power.voltage)
    assert texts(monitor.update(2.0, reading(2.0, 0.49))) == ["battery readings are back after 1.9 s"]


def test_a_silent_sensor_is_extrapolated_down_to_the_landing() -> None:
    monitor = Monitor(0, PARAMETERS)
    monitor.update(0.0, reading(0.0, 0.5))
    said = feed(monitor, range(1, 3300), lambda _time: None)
    assert said[0] == "no plausible reading of the battery for 1 s"
    assert [text.split(",")[0] for text in said[1:]] == ["power is low: 30 % left", "power is critical: 15 % left"]


def test_a_battery_that_was_never_read_is_critical_after_a_while() -> None:
    monitor = Monitor(0, PARAMETERS)
    said = feed(monitor, range(1, 50), lambda _time: None)
    assert said == ["no plausible reading of the battery for 1 s"]
    assert monitor.power is None
    assert texts(monitor.update(BLIND_AFTER, None)) == ["power is critical: the battery was never read"]
    assert monitor.power is not None and monitor.power.level == CRITICAL
    # The first reading ends that, whatever the hysteresis.
    assert texts(monitor.update(6.0, reading(6.0, 0.32)))[-1] == "power is ok: 32 % left, 211 s at 12.0 A"


def test_a_full_battery_with_a_low_voltage_is_called_low() -> None:
    monitor = Monitor(0, PARAMETERS)
    battery = Battery(time_us=0, voltage=3 * open_circuit_voltage(0.25), current=0, used=0, capacity=2.2)
    said = texts(monitor.update(0.1, battery))
    assert said[0] == "the battery's voltage is 0.50 V per cell below its counted charge; using the voltage"
    assert said[1].startswith("power is low: 25 % left")
