"""What the package does in a process apart from calls: stop requests, log records, forks, interpreter exit."""

from __future__ import annotations

import atexit
import contextlib
import logging
import os
import weakref

from scl import _logging, _native, _signals, _stopping
from scl._errors import NotFlushed

_LINGER = 1.0
"""How long the end of a program waits for its peers to receive what was sent, in seconds."""
_LAST_FLUSH = 0.5
"""The same after a stop request, when all programs are stopping."""

_log = logging.getLogger("scl")
_open: weakref.WeakSet[_native.Component] = weakref.WeakSet()


def prepare(signals: bool) -> None:
    """Prepares the process for its first component, or for another one."""
    _logging.start()
    if signals:
        _signals.watch()


def close_at_exit(component: _native.Component) -> None:
    """Closes a component at the end of the program, unless it is closed before."""
    _open.add(component)


def close(component: _native.Component, *, quietly: bool) -> None:
    """Closes a component; `quietly` if an exception is in flight, which says more than a failed flush."""
    stopping = _native.stop_requested()
    linger = _LAST_FLUSH if stopping else _LINGER
    try:
        component.close(0.0 if component.is_test else linger)
    except NotFlushed as error:
        # Messages that a unit test leaves unread are neither waited for nor reported.
        if component.is_test:
            return
        if not (quietly or stopping):
            raise
        _logging.forward(logging.WARNING, _log, str(error))


@atexit.register
def _at_exit() -> None:
    # First, while handlers of log records can still use gates.
    with contextlib.suppress(KeyboardInterrupt):
        _logging.end()
    # All threads but this one are daemon threads; from now on, their calls end them.
    _stopping.silence_asyncio()
    _native.exiting()
    for component in list(_open):
        with contextlib.suppress(KeyboardInterrupt):
            close(component, quietly=True)
    _logging.drain()


os.register_at_fork(before=_native.log_hold, after_in_parent=_native.log_release, after_in_child=_native.forked)
os.register_at_fork(after_in_child=_logging.restart)
os.register_at_fork(after_in_child=_signals.forget)
