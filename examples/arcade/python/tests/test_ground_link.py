"""What the ground station sees and types."""

import pytest

from arcade_scl import Arbitration, Authority, Fix, FixQuality, Flight, Mode, Power, PowerLevel, Vector
from ground_link import GoHome, LandHere, SetParameter, Vehicle, next_id, understand

FLIGHT = Flight(time_us=12_340_000, mode=Mode.MODE_FLYING, position=Vector(x=1.26, y=-2, z=5), position_valid=True)


def test_nothing_is_known_at_first() -> None:
    nothing = "time -, mode -, east -, north -, height -, battery -, commanded by -, satellites -"
    assert Vehicle().line(now=100) == nothing


def test_a_line_has_everything() -> None:
    vehicle = Vehicle()
    vehicle.flight.keep(FLIGHT, 100)
    vehicle.fix.keep(Fix(quality=FixQuality.FIX_QUALITY_3D, satellites=9), 100)
    vehicle.power.keep(Power(charge_left=0.284, level=PowerLevel.POWER_LEVEL_LOW), 100)
    vehicle.arbitration.keep(Arbitration(authority=Authority.AUTHORITY_SAFETY, reason="power is low"), 100)
    assert vehicle.line(now=101) == (
        "time 12.3 s, mode flying, east 1.3, north -2.0, height 5.0 m, battery 28% low, "
        "commanded by safety (power is low), satellites 9"
    )


def test_what_is_old_is_not_shown() -> None:
    vehicle = Vehicle()
    vehicle.flight.keep(FLIGHT, 100)
    vehicle.fix.keep(Fix(satellites=3), 101)
    vehicle.flight.keep(None, 102)
    line = vehicle.line(now=102.5)
    assert line.startswith("time -, mode -")
    assert line.endswith("satellites 3 (no fix)")


def test_a_position_that_is_not_valid_is_not_shown() -> None:
    vehicle = Vehicle()
    vehicle.flight.keep(Flight(position=Vector(x=1, z=2)), 100)
    assert "mode grounded, east -, north -, height 2.0 m" in vehicle.line(now=100)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("return", GoHome()),
        ("  land ", LandHere()),
        ("set speed 2.5", SetParameter("speed", 2.5)),
        ("set speed fast", "`fast` is not a number"),
        ("set speed nan", "`nan` is not a number"),
        ("set speed", "wrong arguments of `set`; commands are `return`, `land` and `set NAME VALUE`"),
        ("land now", "wrong arguments of `land`; commands are `return`, `land` and `set NAME VALUE`"),
        ("retrun", "unknown command `retrun`; did you mean `return`?"),
        ("\x00", "unknown command `\\x00`; commands are `return`, `land` and `set NAME VALUE`"),
        ("", "commands are `return`, `land` and `set NAME VALUE`"),
    ],
)
def test_commands_are_understood_or_explained(text: str, expected: object) -> None:
    assert understand(text) == expected


@pytest.mark.parametrize(
    ("in_effect", "expected"),
    [(0, 10_000), (105, 10_000), (10_000, 10_001), (999_999, 10_000), (1_000_007, 10_000), (20_010_000, 10_001)],
)
def test_an_id_differs_from_the_one_in_effect(in_effect: int, expected: int) -> None:
    assert next_id(in_effect) == expected
