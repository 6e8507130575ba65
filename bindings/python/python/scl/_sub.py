"""The `sub` gate, and who has sent a message to it."""

from __future__ import annotations

import enum
from typing import TYPE_CHECKING, Generic, TypeVar

from scl._gates import Receiver

if TYPE_CHECKING:
    from scl._loop import Loops
    from scl._native import Gate as NativeGate
    from scl.codec import Codec


S = TypeVar("S", bound=enum.StrEnum)
T = TypeVar("T")


class Sub(Receiver[T]):
    """Receives messages from one or several publishers."""

    __slots__ = ()

    @property
    def latched_age(self) -> float | None:
        """The age in seconds of the message received last, if its publisher has `latched: true` and had sent it before this
        gate was connected to it; `None` for every other message."""
        return self._native.latched_age

    @property
    def sender(self) -> str | None:
        """The gate that sent the message received last, as `component.gate`: its connection tells. `None` before the first
        message."""
        return self._native.sender


class Instance(enum.StrEnum):
    """The components of a kind. Generated enums derive from it; each member is the name in the topology file."""


class Sender(enum.StrEnum):
    """The gates that send to a gate. Generated enums derive from it; each member is a gate, as `component.gate`."""


class SubFrom(Sub[T], Generic[S, T]):
    """A `Sub` with several publishers, of a generated module."""

    __slots__ = ("_senders",)

    _senders: type[S]

    def __init__(self, native: NativeGate, loops: Loops, codec: Codec, senders: type[S]) -> None:
        super().__init__(native, loops, codec)
        self._set(_senders=senders)

    @property
    def sender(self) -> S | None:
        """Who sent the message received last, whichever call that was: its connection tells. `None` before the first message."""
        gate = super().sender
        return None if gate is None else self._sender_of(gate)

    def recv_from(self, timeout: float | None = None) -> tuple[S, T]:
        """`recv` that also returns who sent the message."""
        message = self.recv(timeout)
        return self._last(), message

    async def recv_from_async(self, timeout: float | None = None) -> tuple[S, T]:
        """`recv_from` for asyncio. Cancel safe: a cancelled call has taken nothing."""
        message = await self.recv_async(timeout)
        return self._last(), message

    def _last(self) -> S:
        return self._sender_of(super().sender or "")

    def _sender_of(self, gate: str) -> S:
        return self._senders(gate.rpartition(".")[0] if issubclass(self._senders, Instance) else gate)
