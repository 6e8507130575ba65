"""Signals wake the event loop in which tasks wait for gates or for a stop request.

Python runs signal handlers between two steps of Python code. A signal that arrives just before an event loop starts to
wait is noticed only when the wait ends, unless a file descriptor that the loop watches becomes readable at once.
"""

from __future__ import annotations

import contextlib
import os
import signal
import threading
import weakref
from typing import TYPE_CHECKING

# Imported by programs that use it.
if TYPE_CHECKING:
    import asyncio

_pipe: tuple[int, int] | None = None
"""The end that loops watch, and the end that Python writes to when a signal arrives. Open until the process ends."""

_woken: weakref.WeakSet[asyncio.AbstractEventLoop] = weakref.WeakSet()
"""The event loops that watch the pipe."""


def wake_at_signals(loop: asyncio.AbstractEventLoop) -> None:
    """Lets signals wake the running event loop. Does nothing outside the main thread, where no handlers run."""
    global _pipe
    if threading.current_thread() is not threading.main_thread() or loop in _woken:
        return
    if _pipe is None:
        _pipe = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
    read, write = _pipe
    other = signal.set_wakeup_fd(write, warn_on_full_buffer=False)
    if other in (-1, write):
        loop.add_reader(read, _drain, read)
        _woken.add(loop)
        return
    # Restored: uvloop always sets its own descriptor, asyncio's loops do after `add_signal_handler`.
    signal.set_wakeup_fd(other)
    arrived = _drain(read)
    if arrived:
        with contextlib.suppress(BlockingIOError):
            os.write(other, arrived)


def forget() -> None:
    """Leaves the pipe to the parent in a forked child: each would read the other's signals from it."""
    global _pipe
    if _pipe is not None:
        other = signal.set_wakeup_fd(-1)
        if other not in (-1, _pipe[1]):
            signal.set_wakeup_fd(other)
        for end in _pipe:
            os.close(end)
    _pipe = None
    _woken.clear()


def _drain(read: int) -> bytes:
    try:
        return os.read(read, 4096)
    except BlockingIOError:
        return b""
