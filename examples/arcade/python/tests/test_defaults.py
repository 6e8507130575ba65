"""The autopilots fly without `configuration`, with the same defaults."""

import re
from pathlib import Path

import pytest

import parameters

EXAMPLE = Path(__file__).parents[2]


@pytest.mark.parametrize(
    ("table", "entry"),
    [
        ("src/autopilot/parameters.rs", r'\w+: "([a-z_.]+)" = (-?[\d.]+)'),  # fence_radius: "fence.radius" = 100.0,
        ("c/gps_sensor.c", r'\{"([a-z_.]+)", offsetof\(.*\), (-?[\d.]+)\}'),  # {"gps.rate", offsetof(...), 5.0},
        ("c/parameters.h", r'X\(\w+, "([a-z_.]+)", (-?[\d.]+)\)'),  # X(fence_radius, "fence.radius", 100.0)
    ],
)
def test_the_autopilot_has_the_same_defaults(table: str, entry: str) -> None:
    built_in = {name: float(value) for name, value in re.findall(entry, (EXAMPLE / table).read_text())}
    assert "home.latitude" in built_in, "the table is written in another way"
    assert built_in.keys() <= parameters.DEFAULTS.keys()
    assert built_in == {name: parameters.DEFAULTS[name] for name in built_in}
