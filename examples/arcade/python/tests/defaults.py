"""What the tests fly by: the defaults of the topology."""

from arcade_scl import (
    Configuration,
    Limits,
    MissionArbiter,
    MissionArbiterParameters,
    PowerManagement,
    PowerManagementParameters,
    UavMission,
)
from configuration import limits_of


def limits(**changed: float) -> Limits:
    """The limits that `configuration` tells, and changes of them."""
    component, peer = Configuration.test()
    with component, peer:
        told = limits_of(component.parameters)
    for name, value in changed.items():
        setattr(told, name, value)
    return told


def arbiter_parameters() -> MissionArbiterParameters:
    component, peer = MissionArbiter.test()
    with component, peer:
        return component.parameters


def power_parameters(**changed: float) -> PowerManagementParameters:
    values = {f"power_management.{name}": f"{value}" for name, value in changed.items()}
    component, peer = PowerManagement.test(set=values)
    with component, peer:
        return component.parameters


def hover_current() -> float:
    component, peer = UavMission.test()
    with component, peer:
        return component.parameters.hover_current
