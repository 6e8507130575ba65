"""The six kinds of gate, typed: they encode what a program sends and decode what it receives."""

from __future__ import annotations

import builtins
from collections.abc import AsyncIterator, Callable, Iterator
from time import monotonic
from typing import TYPE_CHECKING, Any, ClassVar, Generic, NoReturn, TypeVar, overload

from scl import _native
from scl._errors import Busy, Closed, DecodeError, NoneReceived, Stopped, WrongDirection
from scl._loop import Loops
from scl._suggest import did_you_mean

if TYPE_CHECKING:
    from scl._native import Gate as NativeGate
    from scl._native import Readiness
    from scl.codec import Codec

T = TypeVar("T")
A = TypeVar("A")
B = TypeVar("B")
D = TypeVar("D")
R = TypeVar("R")

_NOT_GIVEN: Any = object()
"""Stands for a default that was not given: any other value may be one."""
_NOTHING: Any = object()
"""Stands for no message: `None` may be one."""

# How many seconds a call that does not wait may be held up by undecodable messages.
_LONGEST_SKIP = 0.01

_CALLS = (
    *("send", "send_async", "recv", "recv_async", "try_recv", "latest"),
    *("take_missed", "deadline_missed", "call", "call_async"),
)


class Gate:
    """The base of all gates."""

    __slots__ = ("_awaited", "_loops", "_native")

    _can: ClassVar[str]
    _awaited: bool
    _loops: Loops
    _native: NativeGate

    def __init__(self, native: NativeGate, loops: Loops) -> None:
        self._set(_native=native, _loops=loops, _awaited=False)

    def _set(self, **attributes: object) -> None:
        """Sets attributes, which `__setattr__` refuses to programs."""
        for name, value in attributes.items():
            object.__setattr__(self, name, value)

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
                hint = did_you_mean(name, dir(type(self)))
                raise AttributeError(f"gate `{self.name}` has no attribute `{name}`{hint}", name=name, obj=self)
            raise WrongDirection(
                f"gate `{self.name}` is a `{self.kind}` gate and has no `{name}`; it has {self._can} "
                f"(declared at {self._native.declared_at})",
                name=name,
                obj=self,
            )

        def __setattr__(self, name: str, value: object) -> NoReturn:
            if hasattr(type(self), name):
                raise AttributeError(f"`{name}` of gate `{self.name}` cannot be replaced", name=name, obj=self)
            hint = did_you_mean(name, dir(type(self)))
            raise AttributeError(f"gate `{self.name}` has no attribute `{name}`{hint}", name=name, obj=self)

    async def _until(self, poll: Callable[[Readiness], R | None], timeout: float | None, last: Callable[[], R]) -> R:
        """Waits as `Loops.until` does. One task at a time may do so."""
        if self._awaited:
            raise Busy(f"gate `{self.name}` is awaited by another task; use each gate from one task at a time")
        object.__setattr__(self, "_awaited", True)
        try:
            return await self._loops.until(poll, timeout, last)
        finally:
            object.__setattr__(self, "_awaited", False)

    def __repr__(self) -> str:
        return repr(self._native)

    def __reduce__(self) -> Any:
        raise TypeError(f"gate `{self.name}` cannot be pickled; open the component in the process that uses it")


class _Sender(Gate, Generic[T]):
    __slots__ = ("_encode", "_send", "type")

    type: builtins.type[T]
    """The class of the messages."""

    _can = "`send`"
    _encode: Callable[[T], bytes]
    _send: Callable[[bytes, float | None], object]

    def __init__(self, native: NativeGate, loops: Loops, codec: Codec) -> None:
        super().__init__(native, loops)
        self._set(type=codec.type, _encode=codec.encode, _send=native.send)

    def send(self, message: T, timeout: float | None = None) -> None:
        """Sends a message.

        It waits only at a gate with `backpressure: true`, for a peer with `when_full: wait` whose queue is full, for at
        most `timeout` seconds; 0 does not wait. After that it raises `Full`, and the message was sent to no peer.
        """
        self._send(self._encode(message), timeout)

    async def send_async(self, message: T, timeout: float | None = None) -> None:
        """`send` for asyncio. Cancel safe: the message was sent to all peers, or to none."""
        frame = self._encode(message)
        await self._until(
            lambda readiness: self._native.poll_send(frame, readiness) or None,
            timeout,
            lambda: self._send(frame, 0) is None,
        )


class _Receiving(Gate, Generic[T]):
    """The base of all gates that receive messages or requests."""

    __slots__ = ("_decode", "_poll", "_recv", "_try")

    _decode: Callable[[Any], T]
    _recv: Callable[..., Any]
    _poll: Callable[[Readiness], Any]
    _try: Callable[[], Any]

    def __init__(self, native: NativeGate, loops: Loops, decode: Callable[[Any], T]) -> None:
        super().__init__(native, loops)
        self._set(_decode=decode, _recv=native.recv, _poll=native.poll_recv, _try=native.try_recv)

    def recv(self, timeout: float | None = None) -> T:
        """Waits for the next message or request. Raises `Timeout` after `timeout` seconds; 0 does not wait.

        A frame that does not decode is counted and skipped; at a gate with `undecodable: fail` it raises `DecodeError`.
        Either way, if it was a request, the requester's call raises `Refused`.
        """
        started, received = monotonic(), self._recv(timeout)
        while True:
            try:
                return self._decode(received)
            except DecodeError as error:
                self._skip(error, received)
            received = self._recv(_rest(timeout, started), monotonic() - started)

    def _try_next(self, default: D) -> T | D:
        started = 0.0
        while (received := self._try()) is not None:
            try:
                return self._decode(received)
            except DecodeError as error:
                self._skip(error, received)
            started = started or monotonic()
            if monotonic() - started > _LONGEST_SKIP:
                break
        return default

    async def recv_async(self, timeout: float | None = None) -> T:
        """`recv` for asyncio. Cancel safe: a cancelled call has taken nothing."""
        started, rest = monotonic(), timeout
        while True:
            received = await self._until(self._poll, rest, lambda: self._recv(0, timeout))
            try:
                return self._decode(received)
            except DecodeError as error:
                self._skip(error, received)
            import asyncio

            # Lets other tasks run even during a stream of undecodable frames.
            await asyncio.sleep(0)
            rest = _rest(timeout, started)

    def _skip(self, error: DecodeError, received: Any) -> None:
        """Reports a frame that does not decode, and raises the error unless such frames are skipped."""
        request = received if isinstance(received, _native.Request) else None
        if not self._native.reject(error.reason, request):
            raise error

    def __iter__(self) -> Iterator[T]:
        """Yields what arrives until the component is closed or a stop is requested."""
        while True:
            try:
                received = self.recv()
            except (Closed, Stopped):
                return
            yield received

    async def __aiter__(self) -> AsyncIterator[T]:
        """`__iter__` for asyncio."""
        while True:
            try:
                received = await self.recv_async()
            except (Closed, Stopped):
                return
            yield received


class Receiver(_Receiving[T]):
    __slots__ = ("type",)

    type: builtins.type[T]
    """The class of the messages."""

    _can = "`recv`, `try_recv`, `latest` and iteration"

    def __init__(self, native: NativeGate, loops: Loops, codec: Codec) -> None:
        super().__init__(native, loops, codec.decode)
        self._set(type=codec.type)

    @overload
    def try_recv(self) -> T | None: ...
    @overload
    def try_recv(self, default: D) -> T | D: ...
    def try_recv(self, default: Any = _NOT_GIVEN) -> Any:
        """Returns the next message if one has arrived, else `default`, or `None`.

        Without a `default`, raises `NoneReceived` if the message itself is `None`, which only plain values can be.
        """
        return self._unambiguous("try_recv", self._try_next(_NOTHING), default)

    @overload
    def latest(self) -> T | None: ...
    @overload
    def latest(self, default: D) -> T | D: ...
    def latest(self, default: Any = _NOT_GIVEN) -> Any:
        """Returns the newest message that has arrived and discards the older ones; as `try_recv` if there is none."""
        frame, newest = self._native.latest(), _NOTHING
        if frame is not None:
            try:
                newest = self._decode(frame)
            except DecodeError as error:
                self._skip(error, frame)
        return self._unambiguous("latest", newest, default)

    def take_missed(self) -> int:
        """Returns how many messages the gate has missed since the last time: its `deadline` passed without one."""
        return self._native.take_missed()

    async def deadline_missed(self) -> int:
        """`take_missed` for asyncio, which waits for one. Cancel safe. Another task may receive meanwhile."""
        return await self._loops.until(self._native.wait_missed().poll, None, lambda: 0)

    def _unambiguous(self, call: str, received: Any, default: Any) -> Any:
        """Returns what was received, or the default."""
        if received is _NOTHING:
            return None if default is _NOT_GIVEN else default
        if received is None and default is _NOT_GIVEN:
            raise NoneReceived(
                f"gate `{self.name}` received the message `None`, which `{call}()` also returns when there is no "
                f"message; pass another default, as in `{call}(default)`"
            )
        return received


class Pub(_Sender[T]):
    """Sends messages to every subscriber."""

    __slots__ = ()


class Push(_Sender[T]):
    """Hands each message to one puller."""

    __slots__ = ()


class Pull(Receiver[T]):
    """Receives messages from any number of pushers."""

    __slots__ = ()


class Req(Gate, Generic[A, B]):
    """Sends requests to a replier.

    Several tasks and threads may call at the same time. At most `in_flight` calls of the gate are in progress, by
    default one; the others wait, within their timeouts. Each reply is matched with its request.
    """

    __slots__ = ("_call", "_decode", "_encode", "reply_type", "type")

    type: builtins.type[A]
    """The class of requests."""
    reply_type: builtins.type[B]
    """The class of replies."""

    _can = "`call`"
    _encode: Callable[[A], bytes]
    _decode: Callable[[bytes], B]
    _call: Callable[..., bytes]

    def __init__(self, native: NativeGate, loops: Loops, request: Codec, reply: Codec) -> None:
        super().__init__(native, loops)
        self._set(type=request.type, reply_type=reply.type)
        self._set(_encode=request.encode, _decode=reply.decode, _call=native.call)

    @property
    def timeout(self) -> float:
        """The gate's `timeout`, in seconds."""
        return self._native.timeout

    def call(self, request: A, timeout: float | None = None) -> B:
        """Sends a request and returns the reply.

        Raises `Timeout` after `timeout` seconds, by default the gate's `timeout`, `PeerLost` if the replier
        disconnects after the request was sent, and `Refused` if it could not decode the request.
        """
        return self._decoded(self._call(self._encode(request), timeout))

    async def call_async(self, request: A, timeout: float | None = None) -> B:
        """`call` for asyncio. The reply to a call that is cancelled is discarded."""
        call = self._native.start_call(self._encode(request), timeout)
        try:
            # The call has its own time limit.
            reply = await self._loops.until(call.poll_reply, None, lambda: b"")
        finally:
            call.cancel()
        return self._decoded(reply)

    def _decoded(self, frame: bytes) -> B:
        try:
            reply: B = self._decode(frame)
            return reply
        except DecodeError as error:
            self._native.reject(error.reason)
            raise


class Request(Generic[A, B]):
    """A request that waits for its reply. It may be answered later, from any thread, in any order."""

    __slots__ = ("_encode", "_native", "message")

    def __init__(self, native: _native.Request, message: A, reply: Codec) -> None:
        self._native = native
        self._encode = reply.encode
        self.message = message
        """The message of the request."""

    def reply(self, message: B) -> None:
        """Sends the reply. It never waits."""
        self._native.reply(self._encode(message))

    def __repr__(self) -> str:
        return f"Request({self.message!r})"


class Rep(_Receiving[Request[A, B]], Generic[A, B]):
    """Answers the requests of any number of requesters."""

    __slots__ = ("reply_type", "type")

    type: builtins.type[A]
    """The class of requests."""
    reply_type: builtins.type[B]
    """The class of replies."""

    _can = "`recv`, `try_recv` and iteration, which give requests with `reply`"

    def __init__(self, native: NativeGate, loops: Loops, request: Codec, reply: Codec) -> None:
        decode = request.decode
        super().__init__(native, loops, lambda received: Request(received, decode(received.data), reply))
        self._set(type=request.type, reply_type=reply.type)

    def try_recv(self) -> Request[A, B] | None:
        """Returns the next request if one has arrived, else `None`."""
        return self._try_next(None)


def _rest(timeout: float | None, started: float) -> float | None:
    """Returns the rest of the timeout of a call that has skipped frames."""
    return None if timeout is None else max(0.0, timeout - (monotonic() - started))
