"""The application: sends a stream of frames and watches the quality of service."""

import argparse
import asyncio
import math
import sys
import time
from collections.abc import Callable
from contextlib import suppress

import scl

from ospecorr_scl import Application, Frame, LinkState, Requirements, Service
from quality import Pace, QualityMonitor, Requirement, SpectrumClock

REQUEST_PERIOD = 0.5
REPORT_PERIOD = 0.1
# About three frames collide when a primary user arrives. Nobody sends them again; in their place, a tenth more are sent
# than required, as an erasure code would do.
REDUNDANCY = 1.1
FRAMES_PER_SECOND = 100
# Bytes: 4 ms on the air, at 1 bit/s per Hz in a channel of 1 MHz.
LONGEST_FRAME = 500


class RequirementsRefused(Exception):
    """No channel can do what the application requires; the text says why."""


class Stream:
    """A stream of frames over the link, and what is known of it."""

    def __init__(self, application: Application, required: Requirement) -> None:
        self._application = application
        self._required = required
        self._frame = bytes(min(math.ceil(required.rate / FRAMES_PER_SECOND), LONGEST_FRAME))
        self._accepted = asyncio.Event()
        self._clock = SpectrumClock()
        self._monitor = QualityMonitor(required)
        self._sent = 0
        self._lost = 0

    async def run(self) -> None:
        """Until a stop is requested, or the requirements are refused."""
        tasks = (self._require(), self._send(), self._receive(), self._follow(), self._report())
        await scl.until_stopped(*tasks)

    async def _require(self) -> None:
        """Asks again and again: a link optimizer that was restarted does not know the requirements."""
        requirements = Requirements(rate=self._required.rate, longest_gap=self._required.longest_gap)
        say = on_change()
        while True:
            try:
                # If there is no link optimizer, the call waits for it, so that a new one is asked at once.
                result = await self._application.requirements.call_async(requirements)
            except (scl.Timeout, scl.PeerLost):
                say("the link optimizer does not answer")
                continue
            if not result.accepted:
                raise RequirementsRefused(result.reason)
            say(f"accepted: {self._required.rate:.0f} bytes/s, no gap above {self._required.longest_gap:g} s")
            self._accepted.set()
            await asyncio.sleep(REQUEST_PERIOD)

    async def _send(self) -> None:
        """Sends numbered frames at the required rate."""
        await self._accepted.wait()
        pace = Pace(len(self._frame) / (self._required.rate * REDUNDANCY), time.monotonic())
        while True:
            # Waits while the radio takes no frames, because it is silent or not there.
            await self._application.frames.send_async(Frame(number=self._sent, data=self._frame))
            self._sent += 1
            await asyncio.sleep(pace.next(time.monotonic()) - time.monotonic())

    async def _receive(self) -> None:
        """Counts what the far end has received."""
        expected = 0
        async for received in self._application.received:
            self._clock.update(received.time_us, time.monotonic())
            self._monitor.received(received.time_us, received.length)
            # Other numbers are those of frames sent before a restart of this program.
            if expected <= received.number <= self._sent:
                self._lost += received.number - expected
                expected = received.number + 1

    async def _follow(self) -> None:
        """Tells which channel the link uses."""
        channel: int | None = None
        async for link in self._application.link:
            if link.transmit and link.channel != channel:
                print(describe_change(channel, link))
                channel = link.channel

    async def _report(self) -> None:
        """Publishes the quality of service, and tells when it is lost and when it is back."""
        say = on_change()
        due = lost_since = time.monotonic()
        while True:
            now = time.monotonic()
            time_us = self._clock.now(now)
            quality = self._monitor.at(time_us)
            self._application.service.send(
                Service(
                    time_us=time_us,
                    required_rate=self._required.rate,
                    rate=quality.rate,
                    served=quality.served,
                )
            )
            if quality.served:
                say(f"served after {now - lost_since:.1f} s; {self._lost} frames lost so far", key="served")
                lost_since = now
            else:
                say(f"not served: {quality.rate:.0f} of {self._required.rate:.0f} bytes/s", key="not served")
            due += REPORT_PERIOD
            await asyncio.sleep(due - time.monotonic())


def describe_change(before: int | None, link: LinkState) -> str:
    """A line about a change of the channel."""
    came_from = "" if before is None else f" after {before}"
    return f"{link.time_us / 1e6:.3f} s: on channel {link.channel}{came_from}: {link.reason}"


def on_change() -> Callable[..., None]:
    """A `print` that leaves out what has the same key, or without keys the same text, as the line before."""
    last: str | None = None

    def say(text: str, key: str | None = None) -> None:
        nonlocal last
        if (key or text) != last:
            print(text)
            last = key or text

    return say


def positive(largest: float) -> Callable[[str], float]:
    """A number from the command line."""

    def parse(text: str) -> float:
        with suppress(ValueError):
            if 0 < float(text) <= largest:
                return float(text)
        raise argparse.ArgumentTypeError(f"`{text}` is not a number above 0, at most {largest:g}")

    return parse


async def run(required: Requirement) -> None:
    """Opens the component and runs the stream."""
    async with Application() as application:
        await Stream(application, required).run()


def main() -> int:
    """The program."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--rate", type=positive(1e9), default=20_000, metavar="BYTES", help="required rate per second (20000)"
    )
    parser.add_argument(
        "--longest-gap", type=positive(60), default=0.2, metavar="SECONDS", help="longest time without a frame (0.2)"
    )
    arguments = parser.parse_args()
    required = Requirement(arguments.rate, arguments.longest_gap)
    try:
        asyncio.run(run(required))
    except RequirementsRefused as error:
        print(f"error: the link optimizer refuses the requirements: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
