"""The table of parameters and its checks."""

import math

import pytest

import parameters
from arcade_scl import Parameter, Parameters


def test_names_are_unique_and_defaults_may_be_set() -> None:
    assert len(parameters.BY_NAME) == len(parameters.TABLE)
    for spec in parameters.TABLE:
        assert parameters.mistake(spec.name, spec.default) is None
        assert spec.lowest < spec.highest, spec.name
        assert spec.unit and spec.description, spec.name


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("fence.radius", 5000, "`fence.radius: 5000` is out of range; it is 5 to 1000 m"),
        ("power.low", -0.1, "`power.low: -0.1` is out of range; it is 0.05 to 0.9"),
        ("fence.radius", math.nan, "`fence.radius: nan` is not a finite number; it is 5 to 1000 m"),
        ("fence.radius", math.inf, "`fence.radius: inf` is not a finite number; it is 5 to 1000 m"),
        ("fence.radios", 50, "unknown parameter `fence.radios`; did you mean `fence.radius`?"),
        ("", 1, "unknown parameter ``"),
    ],
)
def test_mistakes_name_value_and_range(name: str, value: float, words: str) -> None:
    assert parameters.mistake(name, value) == words


def test_both_ends_of_a_range_may_be_set() -> None:
    for spec in parameters.TABLE:
        assert parameters.mistake(spec.name, spec.lowest) is None
        assert parameters.mistake(spec.name, spec.highest) is None


def test_received_values_are_checked_one_by_one() -> None:
    sent = {"fence.radius": 50.0, "power.low": math.nan, "of.the.future": 1.0}
    values = parameters.values_of(Parameters(parameters=[Parameter(name=name, value=it) for name, it in sent.items()]))
    assert values == {**parameters.DEFAULTS, "fence.radius": 50.0}
