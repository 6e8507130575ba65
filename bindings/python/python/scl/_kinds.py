"""Kinds of components: one class for all components of a kind."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, ClassVar, Generic, TypeVar, cast

from scl._component import Component, Transport
from scl._generated import GeneratedComponent
from scl._sub import Instance

INSTANCE = TypeVar("INSTANCE", bound=Instance)


class ComponentOfKind(GeneratedComponent, Generic[INSTANCE]):
    """A component of a kind of a generated module."""

    _instances: ClassVar[type[Instance]]

    def __init_subclass__(cls, *, instances: type[Instance] | None = None, **rest: Any) -> None:
        """Takes the enum of the components. A program's own subclasses inherit it."""
        super().__init_subclass__(**rest)
        if instances is not None:
            cls._instances = instances

    def __init__(
        self,
        instance: INSTANCE | None = None,
        *,
        runtime_dir: str | os.PathLike[str] | None = None,
        system: str | None = None,
        transport: Transport | None = None,
        set: Mapping[str, str] | None = None,
        signals: bool = True,
    ) -> None:
        """Opens this component of the kind or, without `instance`, the one that `SCL_COMPONENT` names.

        Raises `OpenError` if it names none of the kind. The other arguments are those of any generated component.
        """
        name = self._component_name if instance is None else self._instances(instance).value
        Component.__init__(
            self,
            self._plan_text,
            name,
            runtime_dir=runtime_dir,
            system=system,
            transport=transport,
            set=set,
            signals=signals,
        )

    @property
    def instance(self) -> INSTANCE:
        """Which component of the kind it is."""
        # A class variable cannot have the type of a type parameter.
        return cast("INSTANCE", self._instances(self.name))
