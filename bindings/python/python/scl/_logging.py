"""Log records of SCL for Python's `logging`: loggers `scl.*`.

SCL's threads write into a queue and never wait for the interpreter; a daemon thread takes the records from there.
"""

from __future__ import annotations

import logging
import os
import sys
import threading
import traceback

from scl import _native
from scl._errors import Closed, OpenError, Stopped

_LEVELS = {"off": 255, "error": 40, "warn": 30, "info": 20, "debug": 10, "trace": 5}
_REFRESH = 1.0
"""How often the thread checks whether the level of the logger has changed, in seconds."""

_log = logging.getLogger("scl")
_lock = threading.Lock()
_thread: threading.Thread | None = None


def start() -> None:
    """Starts forwarding records, and sets the level of `SCL_LOG` if that variable is set."""
    global _thread
    _read_environment()
    if logging.getLevelName(_LEVELS["trace"]).startswith("Level"):
        logging.addLevelName(_LEVELS["trace"], "TRACE")
    with _lock:
        _native.log_level(_level())
        if _thread is None:
            _native.log_start()
            _thread = threading.Thread(target=_forward, name="scl-log", daemon=True)
            _thread.start()


def restart() -> None:
    """Forgets the thread, which a forked child does not have."""
    global _lock, _thread
    _lock, _thread = threading.Lock(), None


def end() -> None:
    """Ends the thread, after it has forwarded the pending records.

    The thread must not be in a handler when the interpreter ends, because the interpreter waits for the handlers'
    locks. A handler that does not return delays the end by `_REFRESH` only.
    """
    if _thread is not None:
        _native.log_end()
        _thread.join(_REFRESH)


def drain() -> None:
    """Forwards the remaining records at the end of the program, unless the thread is still in a handler."""
    if _thread is not None and not _thread.is_alive():
        _hand_over()


def _forward() -> None:
    while _native.log_wait(_REFRESH):
        _hand_over()
        _native.log_level(_level())
    _hand_over()


def _hand_over() -> None:
    records, dropped = _native.log_take()
    for level, module, text in records:
        forward(level, logging.getLogger(module.replace("::", ".")), text)
    if dropped:
        forward(logging.WARNING, _log, f"{dropped} log records were dropped")


def forward(level: int, logger: logging.Logger, text: str) -> None:
    """Logs a text, whatever the program's handlers raise."""
    if not logger.isEnabledFor(level):
        return
    try:
        logger.log(level, "%s", text)
    except (Closed, Stopped):
        # From a handler that uses gates while the program ends.
        pass
    except Exception:  # noqa: BLE001
        # A handler of the program failed. Continue with later records.
        traceback.print_exc()


def _level() -> int:
    return min(_log.getEffectiveLevel(), 255)


def _read_environment() -> None:
    word = os.environ.get("SCL_LOG", "")
    if not word:
        return
    if word not in _LEVELS:
        expected = "`error`, `warn`, `info`, `debug`, `trace` or `off`"
        raise OpenError(f"`SCL_LOG={word}` is not understood; expected {expected}")
    if _log.level == logging.NOTSET:
        _log.setLevel(_LEVELS[word])
    if not _log.hasHandlers():
        # Without a handler, `logging` prints warnings only.
        handler = logging.StreamHandler(sys.stderr)
        handler.setFormatter(logging.Formatter("%(levelname)s %(message)s"))
        _log.addHandler(handler)
