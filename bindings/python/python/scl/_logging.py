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
from scl._errors import OpenError

_LEVELS = {"off": 255, "error": 40, "warn": 30, "info": 20, "debug": 10, "trace": 5}
_REFRESH = 1.0
"""How often the thread looks whether the level of the logger has changed, in seconds."""

_log = logging.getLogger("scl")
_lock = threading.Lock()
_handing_over = threading.Lock()
_started = False


def start() -> None:
    """Starts to forward records. Sets the level that `SCL_LOG` says, if it is set."""
    global _started
    _read_environment()
    if logging.getLevelName(_LEVELS["trace"]).startswith("Level"):
        logging.addLevelName(_LEVELS["trace"], "TRACE")
    with _lock:
        _native.log_level(_level())
        if not _started:
            _native.log_start()
            threading.Thread(target=_forward, name="scl-log", daemon=True).start()
            _started = True


def restart() -> None:
    """Forgets the thread, which a forked child does not have."""
    global _handing_over, _lock, _started
    _handing_over, _lock = threading.Lock(), threading.Lock()
    _started = False


def drain() -> None:
    """Forwards what is left, at the end of the program."""
    if _started:
        _hand_over()


def _forward() -> None:
    while True:
        _native.log_wait(_REFRESH)
        _hand_over()
        _native.log_level(_level())


def _hand_over() -> None:
    # The end of the program waits for records that the thread has taken, but not for a handler that never returns.
    locked = _handing_over.acquire(timeout=_REFRESH)
    try:
        _hand_over_now()
    finally:
        if locked:
            _handing_over.release()


def _hand_over_now() -> None:
    records, dropped = _native.log_take()
    for level, module, text in records:
        logger = logging.getLogger(module.replace("::", "."))
        if logger.isEnabledFor(level):
            try:
                logger.log(level, "%s", text)
            except Exception:  # noqa: BLE001
                # A handler of the program failed. Later records go on.
                traceback.print_exc()
    if dropped:
        _log.warning("%d log records were dropped", dropped)


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
