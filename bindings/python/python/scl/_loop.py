"""Waiting for gates in asyncio: one reader per component and event loop, and no thread."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from scl import _native, _wakeup

# Imported only where it is used: the import is slow, and most programs do not need it.
if TYPE_CHECKING:
    import asyncio

R = TypeVar("R")


class Waiters:
    """The tasks of one event loop that wait for gates of one component."""

    def __init__(self, component: _native.Component, loop: asyncio.AbstractEventLoop) -> None:
        self.readiness = component.readiness(False)
        self._component = weakref.ref(component)
        self._loop = weakref.ref(loop)
        self._waiting: set[asyncio.Future[None]] = set()
        loop.add_reader(self.readiness.fileno(), self._wake)
        _wakeup.wake_at_signals(loop)

    async def changed(self) -> None:
        """Waits until the next event. The caller must have polled the gate before, without an `await` in between."""
        import asyncio

        event = asyncio.get_running_loop().create_future()
        self._waiting.add(event)
        try:
            await event
        finally:
            self._waiting.discard(event)

    def _wake(self) -> None:
        self.readiness.acknowledge()
        # All are woken, because an event does not say which gate it belongs to. Each task polls its own gate again.
        for event in self._waiting:
            if not event.done():
                event.set_result(None)
        component, loop = self._component(), self._loop()
        if loop is not None and (component is None or component.is_closed):
            loop.remove_reader(self.readiness.fileno())


class Loops:
    """The event loops in which tasks wait for gates of a component."""

    def __init__(self, component: _native.Component) -> None:
        self._component = component
        self._waiters: weakref.WeakKeyDictionary[asyncio.AbstractEventLoop, Waiters] = weakref.WeakKeyDictionary()

    async def until(
        self, poll: Callable[[_native.Readiness], R | None], timeout: float | None, last: Callable[[], R]
    ) -> R:
        """Polls until there is a result; after `timeout`, makes a last attempt, which may raise `Timeout`.

        Cancel safe: what a poll has taken is returned without an `await` in between.
        """
        import asyncio

        loop = asyncio.get_running_loop()
        waiters = self._waiters.get(loop)
        if waiters is None:
            waiters = self._waiters[loop] = Waiters(self._component, loop)
        found = poll(waiters.readiness)
        if found is not None:
            return found
        if timeout is not None and timeout <= 0:
            return last()
        try:
            async with asyncio.timeout(timeout) as limit:
                while found is None:
                    await waiters.changed()
                    found = poll(waiters.readiness)
                return found
        except TimeoutError:
            if not limit.expired():
                raise
        return last()
