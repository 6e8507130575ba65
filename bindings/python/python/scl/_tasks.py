"""The loops of a program as asyncio tasks."""

import asyncio
from collections.abc import Coroutine
from typing import Any

from scl._errors import Stopped


async def until_stopped(*loops: Coroutine[Any, Any, object]) -> None:
    """Runs loops at the same time until one of them ends, fails or is stopped, then cancels the others.

    A stop request (SIGTERM) ends it without an exception: loops over gates end, and calls raise `Stopped`, which is an
    orderly end here. From `asyncio.gather` and `TaskGroup`, `Stopped` leaves `asyncio.run` and ends the program.

    Returns when all loops have ended. If loops fail, the exception of the first in the list is raised. Cancelling it
    cancels the loops.
    """
    tasks = [asyncio.ensure_future(_stop_in_order(loop)) for loop in loops]
    if not tasks:
        return
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        results = await asyncio.gather(*tasks, return_exceptions=True)
    for result in results:
        if isinstance(result, BaseException) and not isinstance(result, asyncio.CancelledError):
            raise result


async def _stop_in_order(loop: Coroutine[Any, Any, object]) -> None:
    try:
        await loop
    except* Stopped:
        pass
