"""Power management beside the other ends of its gates."""

import math
from collections.abc import Callable, Iterator

import pytest

import power_management
from arcade_scl import Battery, Parameter, Parameters, Power, PowerLevel, PowerManagement, PowerManagementPeer
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


def test_parameters_take_effect(peer: PowerManagementPeer) -> None:
    peer.battery.send(reading(0.5))
    assert power(peer, lambda _: True).level == OK
    peer.parameters.send(Parameters(parameters=[Parameter(name="power.low", value=0.6)]))
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


def test_a_black_box_that_takes_nothing_delays_nobody(capsys: pytest.CaptureFixture[str]) -> None:
    component, peer = PowerManagement.test()
    black_box = BlackBox(component.records, "power_management")
    while black_box.dropped < 10:
        black_box.note("full", 1.0)
    while peer.records.try_recv() is not None:
        pass
    black_box.note("empty")
    assert black_box.dropped == 0
    # What the gate itself has kept comes first.
    texts = [until(lambda: peer.records.recv(timeout=HANG_LIMIT), lambda it: it.text != "full").text]
    assert texts == ["10 records were dropped before this one"]
    assert peer.records.recv(timeout=HANG_LIMIT).text == "empty"
    printed = capsys.readouterr()
    assert printed.err.count("the black box takes no records") == 1
    assert printed.out.count("takes records again") == 1
