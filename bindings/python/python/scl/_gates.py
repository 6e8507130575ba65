"""The six kinds of gate, typed: they encode what a program sends and decode what it receives."""

from __future__ import annotations

import builtins
from collections.abc import AsyncIterator, Callable, Iterator
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

from scl import _native
from scl._errors import Busy, Closed, Stopped, WrongDirection
from scl._loop import Loops

if TYPE_CHECKING:
    from scl.codec import Codec

T = TypeVar("T")
A = TypeVar("A")
B = TypeVar("B")
R = TypeVar("R")

_CALLS = ("send", "send_async", "recv", "recv_async", "try_recv", "latest", "call", "call_async")


class Gate:
    """What all gates have in common."""

    __slots__ = ("_awaited", "_loops", "_native")

    _can: ClassVar[str]

    def __init__(self, native: _native.Gate, loops: Loops) -> None:
        self._native = native
        self._loops = loops
        self._awaited = False

    @property
    def name(self) -> str:
        """The full name: `controller.sensor`."""
        return f"{self._native.component}.{self._native.name}"

    @property
    def kind(self) -> str:
        """`pub`, `sub`, `req`, `rep`, `push` or `pull`."""
        return self._native.kind

    @property
    def is_connected(self) -> bool:
        """Whether all required peers are connected, or, for `rep` and `pull`, at least one peer."""
        return self._native.is_connected

    def stats(self) -> dict[str, Any]:
        """Returns the gate's counts."""
        return self._native.stats()

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            if name not in _CALLS:
                raise AttributeError(f"{self!r} has no attribute `{name}`", name=name, obj=self)
            raise WrongDirection(
                f"gate `{self.name}` is a `{self.kind}` gate and has no `{name}`; it has {self._can} "
                f"(declared at {self._native.declared_at})",
                name=name,
                obj=self,
            )

    async def _until(
        self, poll: Callable[[_native.Readiness], R | None], timeout: float | None, last: Callable[[float], R]
    ) -> R:
        """Waits as `Loops.until` does. One task at a time may do so."""
        if self._awaited:
            raise Busy(f"gate `{self.name}` is awaited by another task; one at a time may use a gate")
        self._awaited = True
        try:
            return await self._loops.until(poll, timeout, last)
        finally:
            self._awaited = False

    def __repr__(self) -> str:
        return repr(self._native)

    def __reduce__(self) -> Any:
        raise TypeError(f"gate `{self.name}` cannot be pickled; open the component in the process that uses it")


class _Sender(Gate, Generic[T]):
    __slots__ = ("_encode", "_send", "type")

    _can = "`send`"

    def __init__(self, native: _native.Gate, loops: Loops, codec: Codec) -> None:
        super().__init__(native, loops)
        self.type: builtins.type[T] = codec.type
        """The class of the messages."""
        self._encode = codec.encode
        self._send = native.send

    def send(self, message: T, timeout: float | None = None) -> None:
        """Sends a message.

        It waits only at a gate with `backpressure: true`, for a peer with `when_full: wait` whose queue is full: no
        longer than `timeout` seconds, with 0 not at all. It raises `Full` then, and the message was sent to no peer.
        """
        self._send(self._encode(message), timeout)

    async def send_async(self, message: T, timeout: float | None = None) -> None:
        """`send` for asyncio. Cancel safe: the message was sent to all peers, or to none."""
        frame = self._encode(message)
        await self._until(
            lambda readiness: self._native.poll_send(frame, readiness) or None,
            timeout,
            lambda _waited: self._send(frame, 0) is None,
        )


class _Receiver(Gate, Generic[T]):
    __slots__ = ("_decode", "_owner", "_recv", "type")

    _can = "`recv`, `try_recv`, `latest` and iteration"

    def __init__(self, native: _native.Gate, loops: Loops, codec: Codec) -> None:
        super().__init__(native, loops)
        self.type: builtins.type[T] = codec.type
        """The class of the messages."""
        self._decode = codec.decode
        self._owner = codec.owner
        self._recv = native.recv

    def recv(self, timeout: float | None = None) -> T:
        """Waits for the next message, no longer than `timeout` seconds, with 0 not at all. Raises `Timeout` then."""
        message: T = self._decode(self._recv(timeout))
        return message

    def try_recv(self) -> T | None:
        """Returns the next message if one has arrived, else `None`."""
        frame = self._native.try_recv()
        return None if frame is None else self._decode(frame)

    def latest(self) -> T | None:
        """Returns the newest message that has arrived and discards the older ones; `None` if there is none."""
        frame = self._native.latest()
        return None if frame is None else self._decode(frame)

    async def recv_async(self, timeout: float | None = None) -> T:
        """`recv` for asyncio. Cancel safe: a call that is cancelled has taken no message."""
        message: T = self._decode(
            await self._until(self._native.poll_recv, timeout, lambda waited: self._recv(0, waited))
        )
        return message

    def __iter__(self) -> Iterator[T]:
        """Yields messages until the component is closed or SIGTERM asks the program to stop."""
        while True:
            try:
                message = self.recv()
            except (Closed, Stopped):
                return
            yield message

    async def __aiter__(self) -> AsyncIterator[T]:
        """`__iter__` for asyncio."""
        while True:
            try:
                message = await self.recv_async()
            except (Closed, Stopped):
                return
            yield message

    def stats(self) -> dict[str, Any]:
        """Returns the gate's counts."""
        return _with_rejected(super().stats(), self._owner.rejected)


class Pub(_Sender[T]):
    """Sends messages to every subscriber."""

    __slots__ = ()


class Push(_Sender[T]):
    """Hands each message to one puller."""

    __slots__ = ()


class Sub(_Receiver[T]):
    """Receives messages from one or several publishers."""

    __slots__ = ()


class Pull(_Receiver[T]):
    """Receives messages from any number of pushers."""

    __slots__ = ()


class Req(Gate, Generic[A, B]):
    """Asks a replier, one request at a time."""

    __slots__ = ("_call", "_decode", "_encode", "_owner", "reply_type", "type")

    _can = "`call`"

    def __init__(self, native: _native.Gate, loops: Loops, request: Codec, reply: Codec) -> None:
        super().__init__(native, loops)
        self.type: builtins.type[A] = request.type
        """The class of requests."""
        self.reply_type: builtins.type[B] = reply.type
        """The class of replies."""
        self._encode = request.encode
        self._decode = reply.decode
        self._owner = reply.owner
        self._call = native.call

    @property
    def timeout(self) -> float:
        """The gate's `timeout`, in seconds."""
        return self._native.timeout

    def call(self, request: A, timeout: float | None = None) -> B:
        """Sends a request and returns the reply.

        Raises `Timeout` after `timeout` seconds, by default the gate's `timeout`, and `PeerLost` if the replier disconnects after it got the request.
        """
        reply: B = self._decode(self._call(self._encode(request), timeout))
        return reply

    async def call_async(self, request: A, timeout: float | None = None) -> B:
        """`call` for asyncio. The reply to a call that is cancelled is discarded."""
        call = self._native.start_call(self._encode(request), timeout)
        try:
            # The call has a time limit of its own.
            reply = await self._until(call.poll_reply, None, lambda _waited: b"")
        finally:
            call.cancel()
        decoded: B = self._decode(reply)
        return decoded

    def stats(self) -> dict[str, Any]:
        """Returns the gate's counts."""
        return _with_rejected(super().stats(), self._owner.rejected)


class Request(Generic[A, B]):
    """A request that waits for its reply. It may be answered later, from any thread, in any order."""

    __slots__ = ("_encode", "_native", "message")

    def __init__(self, native: _native.Request, message: A, reply: Codec) -> None:
        self._native = native
        self._encode = reply.encode
        self.message = message
        """What was asked."""

    def reply(self, message: B) -> None:
        """Answers. It never waits."""
        self._native.reply(self._encode(message))

    def __repr__(self) -> str:
        return f"Request({self.message!r})"


class Rep(Gate, Generic[A, B]):
    """Answers the requests of any number of requesters."""

    __slots__ = ("_reply", "_request", "reply_type", "type")

    _can = "`recv`, `try_recv` and iteration, which give requests with `reply`"

    def __init__(self, native: _native.Gate, loops: Loops, request: Codec, reply: Codec) -> None:
        super().__init__(native, loops)
        self.type: builtins.type[A] = request.type
        """The class of requests."""
        self.reply_type: builtins.type[B] = reply.type
        """The class of replies."""
        self._request = request
        self._reply = reply

    def recv(self, timeout: float | None = None) -> Request[A, B]:
        """Waits for the next request, no longer than `timeout` seconds, with 0 not at all. Raises `Timeout` then."""
        return self._decoded(self._native.recv_request(timeout))

    def try_recv(self) -> Request[A, B] | None:
        """Returns the next request if one has arrived, else `None`."""
        request = self._native.try_recv_request()
        return None if request is None else self._decoded(request)

    async def recv_async(self, timeout: float | None = None) -> Request[A, B]:
        """`recv` for asyncio. Cancel safe: a call that is cancelled has taken no request."""
        native = self._native
        return self._decoded(
            await self._until(native.poll_recv_request, timeout, lambda waited: native.recv_request(0, waited))
        )

    def __iter__(self) -> Iterator[Request[A, B]]:
        """Yields requests until the component is closed or SIGTERM asks the program to stop."""
        while True:
            try:
                request = self.recv()
            except (Closed, Stopped):
                return
            yield request

    async def __aiter__(self) -> AsyncIterator[Request[A, B]]:
        """`__iter__` for asyncio."""
        while True:
            try:
                request = await self.recv_async()
            except (Closed, Stopped):
                return
            yield request

    def _decoded(self, request: _native.Request) -> Request[A, B]:
        return Request(request, self._request.decode(request.data), self._reply)

    def stats(self) -> dict[str, Any]:
        """Returns the gate's counts."""
        return _with_rejected(super().stats(), self._request.owner.rejected)


def _with_rejected(stats: dict[str, Any], undecodable: int) -> dict[str, Any]:
    """Adds the frames that the package could not decode: for the native part they are bytes."""
    stats["rejected"] += undecodable
    return stats
