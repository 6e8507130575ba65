"""Components: opened from a plan, with their gates as attributes."""

from __future__ import annotations

import keyword
import os
import warnings
from types import TracebackType
from typing import TYPE_CHECKING, Any, Literal, Self

from scl import _native, _process, codec
from scl._errors import UnknownGate
from scl._gates import Pub, Pull, Push, Rep, Req, Sub

Transport = Literal["ipc", "tcp"]

_KINDS: dict[str, type[Any]] = {"pub": Pub, "sub": Sub, "req": Req, "rep": Rep, "push": Push, "pull": Pull}


class Component:
    """A component whose gates are attributes. Generated classes derive from it, and `open` returns one."""

    def __init__(
        self,
        plan: str | _native.Plan,
        name: str,
        *,
        runtime_dir: str | os.PathLike[str] | None = None,
        system: str | None = None,
        transport: Transport | None = None,
        signals: bool = True,
    ) -> None:
        """Opens the component `name` of a plan, the JSON text of `scl plan`.

        What is not given comes from the environment: `SCL_RUNTIME_DIR`, `SCL_SYSTEM` and `SCL_TRANSPORT`. With
        `signals`, SIGTERM asks the program to stop, unless the program has a handler of its own.
        """
        plan = _native.Plan(plan) if isinstance(plan, str) else plan
        # Before anything is opened: no peer sees a component that cannot run.
        codecs = _codecs_of(plan, name)
        _process.prepare(signals)
        self._native = _native.Component.open(
            plan, name, runtime_dir=runtime_dir, system=system, transport=transport
        )
        _process.close_at_exit(self._native)
        self._gates = {
            gate.name: _KINDS[gate.kind](gate, *codecs[gate.name]) for gate in self._native.gates
        }
        for gate_name, gate in self._gates.items():
            object.__setattr__(self, attribute_of(gate_name), gate)

    def ready(self, timeout: float | None = None) -> None:
        """Waits until all required peers are connected. Raises `NotReady` after `timeout` seconds."""
        self._native.ready(timeout)

    def close(self, timeout: float | None = 1.0) -> None:
        """Waits until every peer that is running has taken all messages, then closes.

        Raises `NotFlushed` after `timeout` seconds; the component is closed then, too. Calls of other threads end with
        `Closed`, loops over gates end. Closing twice is no error.
        """
        self._native.close(timeout)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        _process.close(self._native, quietly=error is not None)

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            gates = self.__dict__.get("_gates")
            if gates is None or name.startswith("__"):
                raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)
            raise UnknownGate(_native.unknown_gate(self._native.name, name, list(gates)), name=name, obj=self)

        def __setattr__(self, name: str, value: object) -> None:
            # A misspelt gate would become an attribute of its own.
            if "_gates" in self.__dict__ and name in self._gates:
                raise AttributeError(f"gate `{self._native.name}.{name}` cannot be replaced", name=name, obj=self)
            object.__setattr__(self, name, value)

    def __reduce__(self) -> Any:
        raise TypeError("a component cannot be pickled; open it in the process that uses it")

    def __repr__(self) -> str:
        return repr(self._native)


class DynamicComponent(Component):
    """A component whose gates a type checker does not know."""

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...


def open(
    topology: str | os.PathLike[str],
    component: str,
    *,
    runtime_dir: str | os.PathLike[str] | None = None,
    system: str | None = None,
    transport: Transport | None = None,
    signals: bool = True,
) -> DynamicComponent:
    """Checks a topology file, with the words of `scl check`, and opens one of its components.

    Raises `TopologyError` if the file has errors. The other arguments are those of `Component`.
    """
    plan, found = _native.Plan.of_file(os.fspath(topology))
    for warning in found:
        warnings.warn(f"\n{warning}", stacklevel=2)
    return DynamicComponent(
        plan, component, runtime_dir=runtime_dir, system=system, transport=transport, signals=signals
    )


def open_plan(
    plan: str,
    component: str,
    *,
    runtime_dir: str | os.PathLike[str] | None = None,
    system: str | None = None,
    transport: Transport | None = None,
    signals: bool = True,
) -> DynamicComponent:
    """As `open`, with the plans that `scl plan` printed instead of the topology file."""
    return DynamicComponent(
        plan, component, runtime_dir=runtime_dir, system=system, transport=transport, signals=signals
    )


def attribute_of(gate: str) -> str:
    """Returns the attribute for a gate: its name, with an underscore where Python or `Component` uses that name."""
    name = gate.replace("-", "_")
    if keyword.iskeyword(name) or (hasattr(Component, name) and not name.startswith("_")):
        return f"{name}_"
    # Names that start with an underscore belong to the class.
    return f"gate{name}" if name.startswith("_") else name


def _codecs_of(plan: _native.Plan, component: str) -> dict[str, list[codec.Codec]]:
    """Returns the codecs of each gate: one, or those of request and reply."""
    messages = codec.messages_of_descriptors(plan.schemas) if plan.schemas else None
    codecs = {}
    for name, kind, word, types, _ in plan.gates(component):
        names = types or [None] * (2 if kind in ("req", "rep") else 1)
        codecs[name] = [codec.codec_of(f"{component}.{name}", word, it, messages) for it in names]
    return codecs
