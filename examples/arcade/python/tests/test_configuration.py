"""The configuration daemon beside the other ends of its gates, and as a program."""

import pytest

import configuration
from arcade_scl import Configuration, ConfigurationPeer, ParameterChange, ParameterResult
from conftest import HANG_LIMIT, Background, running
from defaults import limits

CANNOT = "parameter `configuration.fence_radius` cannot have this value: "


def change(peer: ConfigurationPeer, name: str, value: float) -> ParameterResult:
    return peer.control.call(ParameterChange(name=name, value=value), timeout=HANG_LIMIT)


def test_all_limits_are_told_at_the_start_and_when_one_changes() -> None:
    component, peer = Configuration.test()
    with running(component, lambda: configuration.run(component)):
        assert peer.limits.recv(timeout=HANG_LIMIT) == limits()
        # As `scl set` does.
        component.set_parameter("fence_radius", "42")
        assert peer.limits.recv(timeout=HANG_LIMIT) == limits(fence_radius=42)
        result = change(peer, "climb", 2.5)
        assert (result.accepted, result.reason) == (True, "")
        assert peer.limits.recv(timeout=HANG_LIMIT) == limits(fence_radius=42, climb=2.5)


def test_a_change_is_told_before_the_reply() -> None:
    component, peer = Configuration.test()
    answer = Background(lambda: change(peer, "fence_radius", 42))
    assert component.wait(component.control, timeout=HANG_LIMIT)
    # Without the loop, which tells them at its start.
    configuration.step(component)
    answer.result()
    assert peer.limits.recv(timeout=0) == limits(fence_radius=42)


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("fence_radus", 42, "component `configuration` has no parameter `fence_radus`; did you mean `fence_radius`?"),
        ("fence_radius", 1e9, f"{CANNOT}`1000000000.0` is not from 5 to 1000"),
        ("fence_radius", float("nan"), f"{CANNOT}expected a finite number, found `nan`"),
    ],
)
def test_a_bad_change_is_refused(name: str, value: float, reason: str) -> None:
    component, peer = Configuration.test()
    with running(component, lambda: configuration.run(component)):
        result = change(peer, name, value)
        assert (result.accepted, result.reason) == (False, reason)
        assert change(peer, "fence_radius", 50).accepted
        told = [peer.limits.recv(timeout=HANG_LIMIT) for _ in range(2)]
        assert told == [limits(), limits(fence_radius=50)]
