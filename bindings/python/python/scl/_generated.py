"""The base of the classes that `scl generate --for python` writes."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import ClassVar

from scl._component import Component, Transport
from scl._sub import Instance, Sender


class GeneratedComponent(Component):
    """A component of a generated module: its gates are declared as attributes, with their types."""

    _plan_text: ClassVar[str]
    _component_name: ClassVar[str]

    def __init_subclass__(
        cls,
        *,
        plan: str | None = None,
        component: str | None = None,
        senders: Mapping[str, type[Instance | Sender]] | None = None,
    ) -> None:
        """Takes the plan, the name, and the enums of the senders of gates. A program's own subclasses inherit them."""
        super().__init_subclass__()
        if senders is not None:
            cls._senders = senders
        if plan is not None and component is not None:
            cls._plan_text = plan
            cls._component_name = component
            cls._has_own_attributes = False

    def __init__(
        self,
        *,
        runtime_dir: str | os.PathLike[str] | None = None,
        system: str | None = None,
        transport: Transport | None = None,
        set: Mapping[str, str] | None = None,
        signals: bool = True,
    ) -> None:
        """Opens the component.

        Missing options come from the environment: `SCL_RUNTIME_DIR`, `SCL_SYSTEM`, `SCL_TRANSPORT` and `SCL_SET`. `set`
        has values of parameters, as in the topology file: `{"controller.period": "10ms"}`. With `signals`, SIGTERM and
        SIGINT ask the program to stop, unless the program has handlers of its own.
        """
        super().__init__(
            self._plan_text,
            self._component_name,
            runtime_dir=runtime_dir,
            system=system,
            transport=transport,
            set=set,
            signals=signals,
        )
