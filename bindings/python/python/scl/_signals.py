"""SIGTERM: a request to stop, with the rules of `#[scl::main]` in Rust. SIGINT stays Python's."""

from __future__ import annotations

import logging
import os
import signal
import threading
import time
from types import FrameType

from scl import _native

_LAST_FLUSH = 0.5
_EXIT_CODE = 128 + signal.SIGTERM

_log = logging.getLogger("scl")
_grace_period = 0.0


def stop_requested() -> bool:
    """Returns true if SIGTERM has asked the program to stop.

    The program handles stop requests itself from the first call on: its gates go on working after the request, for
    `SCL_STOP_WITHIN` (default `3s`). After that the program is ended with exit code 143; a second SIGTERM ends it at
    once. A program that never calls this ends at its next call to any gate, which raises `Stopped`.
    """
    _native.stop_handle()
    return _native.stop_requested()


def watch() -> None:
    """Handles SIGTERM from now on, unless the program does, or this is not the main thread."""
    global _grace_period
    _grace_period = _native.stop_grace_period()
    if threading.current_thread() is threading.main_thread() and signal.getsignal(signal.SIGTERM) is signal.SIG_DFL:
        signal.signal(signal.SIGTERM, _stop)


def _stop(number: int, frame: FrameType | None) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    _native.stop_request()
    threading.Thread(target=_end_overdue_program, name="scl-stop", daemon=True).start()


def _end_overdue_program() -> None:
    time.sleep(_grace_period)
    _log.error("the program is still running %gs after SIGTERM; exiting with code %d", _grace_period, _EXIT_CODE)
    if _native.stop_overdue():
        time.sleep(_LAST_FLUSH)
    os._exit(_EXIT_CODE)
