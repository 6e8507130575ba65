"""Unit tests of components: a component, and the other ends of its gates."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Self, TypeVar, cast

from scl import _native, _process
from scl._component import Component, DynamicComponent, described, facts_of
from scl._generated import GeneratedComponent

PEER = TypeVar("PEER", bound="Counterpart")


class Counterpart(Component):
    """The other ends of a component's gates, for its unit tests. `test()` of the component returns it."""

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        # Generated classes are derived directly.
        cls._has_own_attributes = cls._has_own_attributes and Counterpart not in cls.__bases__

    if not TYPE_CHECKING:

        def __init__(self) -> None:
            raise TypeError(f"a {type(self).__name__} is opened together with its component, by `test()` of its class")


class DynamicCounterpart(Counterpart):
    """A counterpart whose gates a type checker does not know."""

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...


class TestableComponent(GeneratedComponent, Generic[PEER]):
    """A component of a module that `scl generate --testable` wrote."""

    _counterpart: ClassVar[type[Counterpart]]

    def __init_subclass__(cls, *, counterpart: type[Counterpart] | None = None, **rest: Any) -> None:
        """Takes the counterpart from the generated module. A program's own subclasses inherit it."""
        super().__init_subclass__(**rest)
        if counterpart is not None:
            cls._counterpart = counterpart

    @classmethod
    def test(cls, *, set: Mapping[str, str] | None = None) -> tuple[Self, PEER]:
        """Opens the component for a unit test, together with the other ends of its gates.

        There are no processes, sockets or files, and signals are left alone. Queues, policies and timeouts are those of
        the topology. Closing with unread messages is not an error. Parameters have their defaults, or the values of
        `set`: `{"controller.period": "10ms"}`.
        """
        # A class variable cannot have the type of a type parameter.
        counterpart = cast("type[PEER]", cls._counterpart)
        return _open(_native.Plan(cls._plan_text), cls._component_name, cls, counterpart, set)


def test(
    topology: str | os.PathLike[str], component: str, *, set: Mapping[str, str] | None = None
) -> tuple[DynamicComponent, DynamicCounterpart]:
    """Checks a topology file, and opens one of its components for a unit test, as `test()` of a generated class does.

    The name of a kind opens its first component. Raises `TopologyError` if the file has errors.
    """
    plan, found = _native.Plan.of_file(os.fspath(topology))
    for warning in found:
        warnings.warn(f"\n{warning}", stacklevel=2)
    counterpart = plan.counterpart(component)
    return _open(
        plan,
        component,
        described(DynamicComponent, plan, component),
        described(DynamicCounterpart, counterpart, counterpart.components[0]),
        set,
    )


# Otherwise pytest would collect it in modules that import it by name.
test.__test__ = False  # type: ignore[attr-defined]

TESTED = TypeVar("TESTED", bound=Component)
OTHER = TypeVar("OTHER", bound=Component)


def _open(
    plan: _native.Plan, name: str, tested: type[TESTED], other: type[OTHER], values: Mapping[str, str] | None
) -> tuple[TESTED, OTHER]:
    counterpart = plan.counterpart(name)
    # Before anything is opened, as for other components.
    facts, other_facts = facts_of(plan, name), facts_of(counterpart, counterpart.components[0])
    _process.prepare(False)
    component, peer = _native.Component.open_test(plan, name, set=None if values is None else dict(values))
    return tested._of(component, facts), other._of(peer, other_facts)
