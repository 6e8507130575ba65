"""What a stop request raises to end a program cleanly: scripts, threads, callbacks and asyncio tasks."""

from __future__ import annotations

import logging
import sys
import threading
from types import TracebackType
from typing import TYPE_CHECKING, Any

from scl import _native
from scl._errors import Stopped

# Imported by programs that use it.
if TYPE_CHECKING:
    import asyncio


class StopExit(Stopped, SystemExit):
    """`Stopped` where only a `SystemExit` ends the program: outside of tasks, also in callbacks of event loops."""

    def __init__(self, *args: object) -> None:
        super().__init__(*args)
        # `SystemExit` takes its exit code from the arguments.
        self.code = 0

    def __reduce__(self) -> Any:
        return Stopped, self.args


def stopped(text: str) -> Stopped:
    """Returns the exception for a call that a stop request ends.

    In an asyncio task it is not a `SystemExit`, which would leave the event loop while other tasks are still running:
    the code that awaits the task receives it.
    """
    loop = _running_loop()
    if loop is None:
        is_main = threading.current_thread() is threading.main_thread()
        return StopExit(text) if is_main else Stopped(text)
    asyncio = sys.modules["asyncio"]
    silence_asyncio()
    # All tasks, because one may receive the exception from another one.
    for task in asyncio.all_tasks(loop):
        task.remove_done_callback(_look_for_who_awaits)
        task.add_done_callback(_look_for_who_awaits)
    return StopExit(text) if asyncio.current_task(loop) is None else Stopped(text)


def is_orderly(error: BaseException | None) -> bool:
    """Returns true for `Stopped`, and for groups of only `Stopped`, which task groups raise."""
    if isinstance(error, BaseExceptionGroup):
        return all(is_orderly(one) for one in error.exceptions)
    return isinstance(error, Stopped)


def silence_asyncio() -> None:
    """Drops what asyncio would log about tasks ended by a stop request or by interpreter exit."""
    logging.getLogger("asyncio").addFilter(_is_about_errors)


def handle_uncaught() -> None:
    """Ends programs and threads that do not catch `Stopped` without a traceback; programs exit with code 0."""
    if getattr(sys.excepthook, "__module__", None) == __name__:
        return
    previous, previous_of_threads = sys.excepthook, threading.excepthook

    def end_program(kind: type[BaseException], error: BaseException, traceback: TracebackType | None) -> None:
        if is_orderly(error):
            raise SystemExit(0)
        previous(kind, error, traceback)

    def end_thread(args: threading.ExceptHookArgs) -> None:
        if not is_orderly(args.exc_value):
            previous_of_threads(args)

    sys.excepthook, threading.excepthook = end_program, end_thread


def _running_loop() -> asyncio.AbstractEventLoop | None:
    if "asyncio" not in sys.modules:
        return None
    import asyncio

    try:
        return asyncio.get_running_loop()
    except RuntimeError:
        return None


def _look_for_who_awaits(task: asyncio.Task[Any]) -> None:
    # After half of the grace period: awaited tasks have ended the program by then, and the rest is left for cleanup.
    task.get_loop().call_later(_native.stop_within() / 2, _leave_loop_unless_awaited, task)


def _leave_loop_unless_awaited(task: asyncio.Task[Any]) -> None:
    import asyncio

    # asyncio's flag for its message that an exception was never retrieved; reading the exception would clear it.
    is_unawaited = getattr(task, "_log_traceback", False) and is_orderly(getattr(task, "_exception", None))
    if is_unawaited and any(not other.cancelling() for other in asyncio.all_tasks(task.get_loop())):
        raise StopExit("stop requested")


def _is_about_errors(record: logging.LogRecord) -> bool:
    error = record.exc_info[1] if record.exc_info else None
    return not (isinstance(error, SystemExit) or is_orderly(error))
