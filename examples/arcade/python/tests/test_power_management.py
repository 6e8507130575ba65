"""Power management beside the other ends of its gates."""

import math
from collections.abc import Callable, Iterator

import pytest

import power_management
from arcade_scl import Battery, Blackbox, Power, PowerLevel, PowerManagement, PowerManagementPeer
from battery import open_circuit_voltage
from black_box import BlackBox
from conftest import HANG_LIMIT, running, until

OK, LOW, CRITICAL = PowerLevel.POWER_LEVEL_OK, PowerLevel.POWER_LEVEL_LOW, PowerLevel.POWER_LEVEL_CRITICAL


@pytest.fixture
def peer() -> Iterator[PowerManagementPeer]:
    component, peer = PowerManagement.test()
    with running(component, lambda: power_management.run(component)):
        yield peer


def reading(charge: float, time: float = 1.0) -> Battery:
    voltage = 3 * open_circuit_voltage(charge) - 12 * 0.02
    return Battery(time_us=round(time * 1e6), voltage=voltage, current=12, used=2.2 * (1 - charge), capacity=2.2)


def power(peer: PowerManagementPeer, wanted: Callable[[Power], bool]) -> Power:
    return until(lambda: peer.power.recv(timeout=HANG_LIMIT), wanted)


def test_each_reading_makes_a_message_and_a_new_level_a_record(peer: PowerManagementPeer) -> None:
    for charge, level, text in [
        (0.8, OK, "power is ok"),
        (0.25, LOW, "power is low"),
        (0.1, CRITICAL, "power is critical"),
    ]:
        peer.battery.send(reading(charge))
        message = power(peer, lambda it, level=level: it.level == level)  # type: ignore[misc]
        assert message.charge_left == pytest.approx(charge)
        assert message.time_left == pytest.approx(charge * 2.2 * 3600 / 12)
        record = peer.records.recv(timeout=HANG_LIMIT)
        assert record.component == "power_management"
        assert record.text.startswith(text)
        assert record.value == pytest.approx(charge)


def test_parameters_take_effect() -> None:
    component, peer = PowerManagement.test()
    with running(component, lambda: power_management.run(component)):
        peer.battery.send(reading(0.5))
        assert power(peer, lambda _: True).level == OK
        component.set_parameter("low", "0.6")
        # Without a further reading: the level is judged again all the time.
        power(peer, lambda it: it.level == LOW)


def test_a_reading_of_nan_is_reported_and_changes_nothing(peer: PowerManagementPeer) -> None:
    peer.battery.send(reading(0.5))
    power(peer, lambda _: True)
    peer.battery.send(Battery(voltage=math.nan, current=math.nan, used=math.nan, capacity=math.nan))
    texts = [peer.records.recv(timeout=HANG_LIMIT).text for _ in range(3)]
    assert texts[1:] == [
        "ignoring readings of the battery: voltage is nan V, not 6 to 13.5 V",
        "no plausible reading of the battery for 1 s",
    ]
    assert power(peer, lambda _: True).level == OK


@pytest.mark.usefixtures("own_system")
def test_a_black_box_that_is_stuck_delays_nobody(capsys: pytest.CaptureFixture[str]) -> None:
    # A counterpart would take everything.
    with PowerManagement(signals=False) as component, Blackbox(signals=False) as stuck:
        black_box = BlackBox(component.records, "power_management")
        black_box.note("first")
        assert stuck.records.recv(timeout=HANG_LIMIT).text == "first"
        while black_box.lost < 10:
            black_box.note("full")
        # What the gates have kept comes first. A note can be two records, so more than that are taken.
        while black_box.reported < black_box.lost:
            for _ in range(3):
                stuck.records.recv(timeout=HANG_LIMIT)
            black_box.note("full")
        found = 0.0
        while found < black_box.lost:
            report = until(lambda: stuck.records.recv(timeout=HANG_LIMIT), lambda it: it.text != "full")
            assert report.text == f"records lost by power_management: {report.value:g}"
            found += report.value
        assert found == black_box.lost
    assert capsys.readouterr().err.startswith("the black box does not take records; they are lost until it does")


@pytest.mark.usefixtures("own_system")
def test_a_black_box_that_is_away_delays_nobody(capsys: pytest.CaptureFixture[str]) -> None:
    with PowerManagement(signals=False) as component:
        black_box = BlackBox(component.records, "power_management")
        for number in range(110):
            black_box.note(f"{number}")
        assert capsys.readouterr().err == "the black box does not take records; they are lost until it does\n"
        with Blackbox(signals=False) as restarted:
            assert restarted.records.recv(timeout=HANG_LIMIT).text == "10"
            black_box.note("again")
            until(lambda: restarted.records.recv(timeout=HANG_LIMIT), lambda it: it.text == "again")
            report = restarted.records.recv(timeout=HANG_LIMIT)
            assert (report.text, report.value) == ("records lost by power_management: 10", 10)
