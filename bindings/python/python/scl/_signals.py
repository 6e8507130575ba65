"""SIGTERM: a request to stop, with the rules of `#[scl::main]` in Rust. SIGINT stays Python's."""

from __future__ import annotations

import signal
import threading
from types import FrameType

from scl import _native, _stopping


def stop_requested() -> bool:
    """Returns true if SIGTERM has asked the program to stop.

    The program handles stop requests itself from the first call on: its gates go on working after the request, for
    `SCL_STOP_WITHIN` (default `3s`). After that the program is ended, as by a second SIGTERM at any time. A program that
    never calls this ends at its next call to any gate, which raises `Stopped`.
    """
    _native.stop_handle()
    return _native.stop_requested()


def watch() -> None:
    """Handles SIGTERM from now on, unless the program does, or this is not the main thread."""
    # Fails if it is not understood, before anything is opened.
    _native.stop_within()
    if threading.current_thread() is threading.main_thread() and signal.getsignal(signal.SIGTERM) is signal.SIG_DFL:
        _stopping.handle_uncaught()
        signal.signal(signal.SIGTERM, _stop)


def _stop(number: int, frame: FrameType | None) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    _native.stop_request()
