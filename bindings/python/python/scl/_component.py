"""Components: opened from a plan, with their gates as attributes."""

from __future__ import annotations

import keyword
import os
import time
import warnings
from collections.abc import Mapping
from types import MappingProxyType, TracebackType
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypeAlias, TypeVar

from scl import _native, _process, codec
from scl._errors import NotReady, UnknownGate
from scl._gates import Gate, Pub, Pull, Push, Rep, Req
from scl._loop import Loops
from scl._sub import Sub, SubFrom
from scl._suggest import did_you_mean

# `ipc`, `tcp` or `shm`, or a list with exceptions for single connections, like `ipc,camera.frames=shm`.
Transport: TypeAlias = str

_KINDS: dict[str, type[Any]] = {"pub": Pub, "sub": Sub, "req": Req, "rep": Rep, "push": Push, "pull": Pull}

Facts = dict[str, tuple[str, list[codec.Codec]]]
"""The attribute and the codecs of each gate."""

_FIELDS = frozenset({"_native", "_gates", "_attributes", "_loops", "_parameters", "_readiness"})
"""The attributes of a component other than its gates."""

_STEP = 0.2
"""Longest time, in seconds, for which a cancelled wait for peers still occupies a thread."""


class Component:
    """A component whose gates are attributes. Generated classes derive from it, and `open` returns one."""

    _has_own_attributes: ClassVar[bool] = False
    """Whether the class is defined by the program, so that it may have any attributes."""
    _senders: ClassVar[Mapping[str, Any]] = MappingProxyType({})
    """The enums of the senders of gates, by attribute."""

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        cls._has_own_attributes = cls.__module__.partition(".")[0] != "scl"

    def __init__(
        self,
        plan: str | _native.Plan,
        name: str,
        *,
        runtime_dir: str | os.PathLike[str] | None = None,
        system: str | None = None,
        transport: Transport | None = None,
        set: Mapping[str, str] | None = None,
        signals: bool = True,
    ) -> None:
        """Opens the component `name` of a plan, the JSON text of `scl plan`.

        If `name` is that of a kind, it is the component of the kind that `SCL_COMPONENT` names.

        Missing options come from the environment: `SCL_RUNTIME_DIR`, `SCL_SYSTEM`, `SCL_TRANSPORT` and `SCL_SET`. `set`
        has values of parameters, as in the topology file: `{"controller.period": "10ms"}`. With `signals`, SIGTERM and
        SIGINT ask the program to stop, unless the program has handlers of its own.
        """
        plan = _native.Plan(plan) if isinstance(plan, str) else plan
        name = plan.started_as(name)
        # Before opening, so that no peer sees a component that cannot run.
        facts = facts_of(plan, name)
        _process.prepare(signals)
        values = None if set is None else dict(set)
        self._adopt(
            _native.Component.open(plan, name, runtime_dir=runtime_dir, system=system, transport=transport, set=values),
            facts,
        )

    @classmethod
    def _of(cls, native: _native.Component, facts: Facts) -> Self:
        """Wraps a component that is already open."""
        component = cls.__new__(cls)
        component._adopt(native, facts)
        return component

    def _adopt(self, native: _native.Component, facts: Facts) -> None:
        self._native = native
        _process.close_at_exit(self._native)
        self._loops = loops = Loops(self._native)
        found: dict[str, Gate] = {}
        for gate in self._native.gates:
            attribute, codecs = facts[gate.name]
            if attribute in self._senders:
                made: Gate = SubFrom(gate, loops, codecs[0], self._senders[attribute])
            else:
                made = _KINDS[gate.kind](gate, loops, *codecs)
            found[gate.name] = self.__dict__[attribute] = made
        self._gates = found
        self._parameters = self._values(native.parameters)
        self._attributes = frozenset(attribute for attribute, _ in facts.values())
        self._readiness: _native.Readiness | None = None

    @classmethod
    def _values(cls, parameters: list[tuple[str, str, Any]]) -> object:
        """Returns the values of the parameters, as the component has them: here by name."""
        return MappingProxyType({name: value for name, _, value in parameters})

    @property
    def name(self) -> str:
        """The component's name in the topology file."""
        return self._native.name

    @property
    def system(self) -> str:
        """The system's name in the topology file."""
        return self._native.system

    @property
    def gates(self) -> Mapping[str, Gate]:
        """All gates by name, in the order of the topology file."""
        return MappingProxyType(self._gates)

    def update_parameters(self, timeout: float | None = 0) -> bool:
        """Takes over live parameters that have changed: `parameters` has their new values then.

        Returns whether any has changed since the component was opened, or since the last call. Waits for that up to
        `timeout` seconds, by default not at all, and without limit for `None`.
        """
        changed = self._native.update_parameters(timeout)
        if changed:
            self._parameters = self._values(self._native.parameters)
        return changed

    async def parameters_changed(self) -> None:
        """`update_parameters` for asyncio, which waits until one has changed. Cancel safe."""
        await self._loops.until(self._native.wait_parameters().poll, None, lambda: 0)
        self.update_parameters()

    def set_parameter(self, name: str, value: str) -> None:
        """Sets a live parameter, as a text like in the topology file: `10ms`. `update_parameters` takes it over.

        For unit tests, and for programs that adapt themselves. Raises `ValueError` if the component has no such live
        parameter, or it cannot have this value.
        """
        self._native.set_parameter(name, value)

    def ready(self, timeout: float | None = None) -> None:
        """Waits until all required peers are connected. Raises `NotReady` after `timeout` seconds."""
        self._native.ready(timeout)

    async def ready_async(self, timeout: float | None = None) -> None:
        """`ready` for asyncio."""
        import asyncio

        began = time.monotonic()
        while True:
            # In steps, so that a cancelled task soon frees its thread.
            waited = time.monotonic() - began
            left = _STEP if timeout is None else max(0.0, timeout - waited)
            try:
                return await asyncio.to_thread(self._native.ready, min(left, _STEP), waited)
            except NotReady:
                if left < _STEP:
                    raise

    def wait(self, *gates: Gate, timeout: float | None = None) -> list[Gate]:
        """Waits until at least one of these gates has a message or a request, and returns those that have.

        Without arguments, waits for all receiving gates. Returns an empty list after `timeout` seconds.
        """
        chosen = gates or tuple(it for it in self._gates.values() if it.kind in ("sub", "pull", "rep"))
        ready = self._native.wait([it._native for it in chosen], timeout)
        return [chosen[index] for index in ready]

    def fileno(self) -> int:
        """Returns a file descriptor for `select` and similar calls: readable while any gate has a message or a request.

        Take them with `try_recv`; do not read from the descriptor. It is closed with the component.
        """
        if self._readiness is None:
            self._readiness = self._native.readiness(True)
        return self._readiness.fileno()

    def close(self, timeout: float | None = 1.0) -> None:
        """Waits until every peer that is running has taken all messages, then closes.

        Raises `NotFlushed` after `timeout` seconds; the component is closed nevertheless. Calls in other threads raise
        `Closed`, loops over gates end. Closing twice is not an error.
        """
        self._native.close(timeout)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        _process.close(self._native, quietly=error is not None)

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        import asyncio

        await asyncio.to_thread(_process.close, self._native, quietly=error is not None)

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            gates = self.__dict__.get("_gates")
            if gates is None or name.startswith("__"):
                raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)
            calls = [it for it in dir(type(self)) if it not in self._attributes]
            if not did_you_mean(name, self._attributes) and (hint := did_you_mean(name, calls)):
                raise UnknownGate(f"component `{self.name}` has no gate `{name}`{hint}", name=name, obj=self)
            raise UnknownGate(_native.unknown_gate(self._native.name, name, list(gates)), name=name, obj=self)

        def __setattr__(self, name: str, value: object) -> None:
            if name in self.__dict__.get("_attributes", ()):
                raise AttributeError(f"gate `{self._native.name}.{name}` cannot be replaced", name=name, obj=self)
            # Otherwise a misspelt gate would become a new attribute.
            if not (self._has_own_attributes or name in _FIELDS or hasattr(type(self), name)):
                hint = did_you_mean(name, dir(self))
                raise AttributeError(f"component `{self.name}` has no attribute `{name}`{hint}", name=name, obj=self)
            object.__setattr__(self, name, value)

        def __delattr__(self, name: str) -> None:
            if name in self.__dict__.get("_attributes", ()):
                raise AttributeError(f"gate `{self._native.name}.{name}` cannot be deleted", name=name, obj=self)
            object.__delattr__(self, name)

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
    set: Mapping[str, str] | None = None,
    signals: bool = True,
) -> DynamicComponent:
    """Checks a topology file, with the same messages as `scl check`, and opens one of its components.

    The name of a kind opens the component of the kind that `SCL_COMPONENT` names. Raises `TopologyError` if the file
    has errors. The other arguments are those of `Component`.
    """
    plan, found = _native.Plan.of_file(os.fspath(topology))
    for warning in found:
        warnings.warn(f"\n{warning}", stacklevel=2)
    component = plan.started_as(component)
    return described(DynamicComponent, plan, component)(
        plan, component, runtime_dir=runtime_dir, system=system, transport=transport, set=set, signals=signals
    )


def open_plan(
    plan: str,
    component: str,
    *,
    runtime_dir: str | os.PathLike[str] | None = None,
    system: str | None = None,
    transport: Transport | None = None,
    set: Mapping[str, str] | None = None,
    signals: bool = True,
) -> DynamicComponent:
    """Like `open`, but takes the plans that `scl plan` printed instead of a topology file."""
    plans = _native.Plan(plan)
    component = plans.started_as(component)
    return described(DynamicComponent, plans, component)(
        plans, component, runtime_dir=runtime_dir, system=system, transport=transport, set=set, signals=signals
    )


C = TypeVar("C", bound=Component)


def described(base: type[C], plan: _native.Plan, component: str) -> type[C]:
    """Returns a class for one component whose documentation lists its gates and parameters, for `help`."""
    parameters = plan.parameters(component)
    lines = [f"The component `{component}` of `{plan.system}`.", "", "Gates:"]
    for name, snake_name, kind, codec_name, types, peers in plan.gates(component):
        carried = " -> ".join(f"`{it}`" for it in types) or "bytes"
        ends = ", ".join(f"`{peer}`" for peer in peers) or "no peer"
        written = "" if codec_name == "protobuf" or not types else f" as {codec_name}"
        lines.append(f"    {_attribute_of(snake_name)}: `{kind}` of {carried}{written}, connected to {ends}")
    own: dict[str, Any] = {"__module__": base.__module__}
    if parameters:
        lines += ["", "Parameters:", *(f"    {name}: {kind}" for name, kind in parameters)]
        own["parameters"] = property(lambda self: self._parameters, doc="The values of the parameters, by name.")
    return type(base.__name__, (base,), {"__doc__": "\n".join(lines), **own})


def _attribute_of(gate: str) -> str:
    """Returns the attribute for a gate's name in snake case, altered if it is a keyword or a name of the class."""
    if keyword.iskeyword(gate) or (hasattr(Component, gate) and not gate.startswith("_")):
        return f"{gate}_"
    return f"gate{gate}" if gate.startswith("_") else gate


def facts_of(plan: _native.Plan, component: str) -> Facts:
    """Returns the attribute and the codecs of each gate: one codec, or one each for request and reply."""
    messages = codec.messages_of_descriptors(plan.schemas) if plan.schemas else None
    facts = {}
    for name, snake_name, kind, word, types, peers in plan.gates(component):
        names: list[str] | list[None] = types or [None] * (2 if kind in ("req", "rep") else 1)
        codecs = [codec.codec_of(f"{component}.{name}", word, it, messages, peers) for it in names]
        facts[name] = (_attribute_of(snake_name), codecs)
    return facts
