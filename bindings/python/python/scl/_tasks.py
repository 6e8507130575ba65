"""The loops of a program as asyncio tasks."""

import asyncio
from collections.abc import Coroutine
from typing import Any

from scl import _signals
from scl._errors import Stopped


async def until_stopped(*loops: Coroutine[Any, Any, object]) -> None:
    """Runs loops concurrently until one of them ends or fails or a stop is requested, then cancels the others.

    Without loops, it waits for a stop request. The program handles stop requests (SIGTERM and SIGINT) itself, as after
    `stop_requested`: the code that follows can still use gates, for `SCL_STOP_WITHIN`. With `asyncio.gather` and
    `TaskGroup`, `Stopped` leaves `asyncio.run` and ends the program.

    Returns when all loops have ended. If loops fail, raises the exception of the first of them in the list. Cancelling
    this call cancels the loops.
    """
    tasks = [asyncio.ensure_future(_stop_in_order(loop)) for loop in (*loops, _signals.wait_for_request())]
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
