"""SIGTERM and SIGINT: a request to stop, with the rules of `#[scl::main]` in Rust."""

from __future__ import annotations

import contextlib
import signal
import sys
import threading
from types import FrameType
from typing import TYPE_CHECKING, Any

from scl import _native, _stopping, _wakeup

# Imported by programs that use it.
if TYPE_CHECKING:
    import asyncio

_DEFAULTS: dict[signal.Signals, Any] = {signal.SIGTERM: signal.SIG_DFL, signal.SIGINT: signal.default_int_handler}
"""The signals that request a stop, with the handlers that Python starts with."""

_waiting: set[asyncio.Future[None]] = set()
"""The futures of tasks that wait for a stop request."""


def stop_requested() -> bool:
    """Returns true if SIGTERM or SIGINT (Ctrl-C) has asked the program to stop.

    The program handles stop requests itself from the first call on: its gates keep working after the request, for
    `SCL_STOP_WITHIN` (default `3s`). After that the program is killed, as it is by a second signal half a second or
    more after the first. A program that calls neither this nor `until_stopped` ends at its next call to any gate, which
    raises `Stopped`.
    """
    _native.stop_handle()
    return _native.stop_requested()


async def wait_for_request() -> None:
    """Waits for a stop request, which the program handles itself, as after `stop_requested`."""
    import asyncio

    loop = asyncio.get_running_loop()
    _wakeup.wake_at_signals(loop)
    request = loop.create_future()
    # Registered before checking, so that no request is missed.
    _waiting.add(request)
    try:
        if not stop_requested():
            await request
    finally:
        _waiting.discard(request)


def watch() -> None:
    """Handles SIGTERM and SIGINT from now on, unless the program does, or this is not the main thread."""
    # Raises an error if `SCL_STOP_WITHIN` is invalid, before anything is opened.
    _native.stop_within()
    if threading.current_thread() is not threading.main_thread():
        return
    for number in _DEFAULTS:
        if _is_free(number):
            _stopping.handle_uncaught()
            signal.signal(number, _stop)


def forget() -> None:
    """Leaves the signals to Python in a forked child, which has no component yet."""
    for number in _watched():
        signal.signal(number, _DEFAULTS[number])
    _wakeup.forget()


def _stop(number: int, frame: FrameType | None) -> None:
    _native.stop_request(number, _watched())
    for request in tuple(_waiting):
        # Raised if the event loop was closed.
        with contextlib.suppress(RuntimeError):
            request.get_loop().call_soon_threadsafe(_wake, request)


def _wake(request: asyncio.Future[None]) -> None:
    if not request.done():
        request.set_result(None)


def _watched() -> list[signal.Signals]:
    return [number for number in _DEFAULTS if signal.getsignal(number) is _stop]


def _is_free(number: signal.Signals) -> bool:
    """Whether the program has no handler of its own."""
    handler = signal.getsignal(number)
    if number == signal.SIGTERM:
        return handler is _DEFAULTS[number]
    # At a prompt, Ctrl-C interrupts the statement, not the program.
    is_at_prompt = hasattr(sys, "ps1") or bool(sys.flags.interactive)
    return not is_at_prompt and (handler is _DEFAULTS[number] or _is_of_asyncio(handler))


def _is_of_asyncio(handler: Any) -> bool:
    """Whether it is the handler that `asyncio.run` installs in place of Python's."""
    if "asyncio" not in sys.modules:
        return False
    import asyncio

    method = getattr(handler, "func", None)
    return isinstance(getattr(method, "__self__", None), asyncio.Runner)
