"""Decides who commands the autopilot: carries events from the gates to the logic, and its actions to the gates."""

import asyncio
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from itertools import count
from typing import TypeVar

import scl

from arbiter_events import Answered, Ask, Event, FlightSeen, LimitsSeen, PowerSeen, Reply, Requested, Say, Tick
from arbiter_logic import Arbiter
from arcade_scl import Arbitration, Authority, Command, CommandResult, MissionArbiter
from black_box import BlackBox

T = TypeVar("T")
PERIOD = 0.1  # s, between two publications


class Program:
    """The component, its logic, and the requests that wait for their replies."""

    def __init__(self, component: MissionArbiter) -> None:
        self.component = component
        self.logic = Arbiter(time.monotonic(), component.parameters)
        self.black_box = BlackBox(component.records, "mission_arbiter")
        self.asks = asyncio.Queue[Ask]()
        self.numbers = count(1)
        self.requests: dict[int, scl.Request[Command, CommandResult]] = {}
        self.published = Arbitration()

    async def run(self) -> None:
        c = self.component
        await scl.until_stopped(
            self.listen(c.flight, FlightSeen),
            self.listen(c.power, PowerSeen),
            self.listen(c.limits, LimitsSeen),
            self.serve(c.mission, Authority.AUTHORITY_MISSION),
            self.serve(c.ground, Authority.AUTHORITY_GROUND),
            self.ask(),
            self.tick(),
        )

    async def listen(self, gate: scl.Sub[T], event: Callable[[T], Event]) -> None:
        async for message in gate:
            self.take(event(message))

    async def serve(self, gate: scl.Rep[Command, CommandResult], source: Authority) -> None:
        async for request in gate:
            number = next(self.numbers)
            self.requests[number] = request
            self.take(Requested(source, number, request.message))

    async def tick(self) -> None:
        while True:
            if self.component.update_parameters():
                self.logic.parameters = self.component.parameters
            self.take(Tick())
            self.publish()
            await asyncio.sleep(PERIOD)

    async def ask(self) -> None:
        while True:
            ask = await self.asks.get()
            try:
                answered = Answered(await self.component.autopilot.call_async(ask.command, ask.timeout))
            except (scl.Timeout, scl.PeerLost, scl.Refused, scl.DecodeError) as error:
                answered = Answered(None, str(error))
            self.take(answered)

    def take(self, event: Event) -> None:
        for action in self.logic.step(time.monotonic(), event):
            match action:
                case Ask():
                    self.asks.put_nowait(action)
                case Reply(number, result):
                    # A requester that has gone no longer waits for the reply.
                    with suppress(scl.RequesterGone):
                        self.requests.pop(number).reply(result)
                case Say(text):
                    self.black_box.note(text)
        now = self.logic.arbitration
        if (now.authority, now.reason) != (self.published.authority, self.published.reason):
            self.publish()

    def publish(self) -> None:
        self.published = self.logic.arbitration
        self.component.arbitration.send(self.published)


async def main() -> int:
    with MissionArbiter() as component:
        await Program(component).run()
    return 0


if __name__ == "__main__":
    sys.exit(asyncio.run(main()))
