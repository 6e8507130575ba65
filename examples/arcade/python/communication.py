"""The radio link: reports what a ground station would see, and passes on its commands."""

import argparse
import asyncio
import os
import sys
import time
from collections.abc import Callable
from typing import cast

import scl

from arcade_scl import Action, Command, Communication, ParameterChange
from ground_link import GoHome, LandHere, SetParameter, Vehicle, next_id, understand

Answer = Callable[[str], None]  # takes the answer to a command


class Link:
    """The component, and the commands that wait for their answers."""

    def __init__(self, c: Communication) -> None:
        self.c = c
        self.vehicle = Vehicle()
        self.last_id = 0
        self.commands: asyncio.Queue[tuple[str, Answer]] = asyncio.Queue(maxsize=16)

    async def run(self) -> None:
        await scl.until_stopped(self.report(), self.obey())

    async def report(self) -> None:
        """One line a second, also while other components are silent."""
        while True:
            await asyncio.sleep(1.0 - time.monotonic() % 1.0)
            self.look()
            print(self.vehicle.line(time.monotonic()), flush=True)

    def look(self) -> None:
        now, vehicle, c = time.monotonic(), self.vehicle, self.c
        vehicle.flight.keep(c.flight.latest(), now)
        vehicle.fix.keep(c.fix.latest(), now)
        vehicle.power.keep(c.power.latest(), now)
        vehicle.arbitration.keep(c.arbitration.latest(), now)

    def take(self, text: str, answer: Answer) -> None:
        """Queues a command. The link does not grow without end when nobody answers."""
        try:
            self.commands.put_nowait((text, answer))
        except asyncio.QueueFull:
            answer("error: too many commands wait for an answer")

    async def obey(self) -> None:
        """One command after the other, so that each answer belongs to the one before it."""
        while True:
            text, answer = await self.commands.get()
            answer(await self.carry_out(text))

    async def carry_out(self, text: str) -> str:
        order = understand(text)
        try:
            match order:
                case GoHome():
                    return await self.command(Action.ACTION_RETURN)
                case LandHere():
                    return await self.command(Action.ACTION_LAND)
                case SetParameter(name, value):
                    result = await self.c.configuration.call_async(ParameterChange(name=name, value=value))
                    return f"{name} is {value:g}" if result.accepted else f"refused: {result.reason}"
                case problem:
                    return f"error: {problem}"
        except (scl.Timeout, scl.PeerLost, scl.Refused, scl.DecodeError) as error:
            return f"error: no answer: {error}"

    async def command(self, action: Action) -> str:
        self.look()
        flight = self.vehicle.flight.message
        # Two commands may follow each other faster than the autopilot reports the first one.
        self.last_id = max(self.last_id + 1, next_id(flight.command_id if flight else 0))
        result = await self.c.arbiter.call_async(Command(id=self.last_id, action=action))
        return "accepted" if result.accepted else f"refused: {result.reason}"


class Datagrams(asyncio.DatagramProtocol):
    """Commands and their answers as datagrams of one line."""

    def __init__(self, link: Link) -> None:
        self.link = link

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self.transport = cast(asyncio.DatagramTransport, transport)

    def datagram_received(self, data: bytes, sender: tuple[str, int]) -> None:
        text = data[:200].decode(errors="replace").strip()

        def answer(answered: str) -> None:
            print(f"{text!r}: {answered}", flush=True)
            self.transport.sendto(f"{answered}\n".encode(), sender)

        self.link.take(text, answer)


def read_terminal(link: Link, terminal: int) -> None:
    """Takes the lines that were typed; at the end of the input the link goes on without it."""
    typed = os.read(terminal, 4096)
    if not typed:
        asyncio.get_running_loop().remove_reader(terminal)
    for text in typed.decode(errors="replace").splitlines():
        link.take(text, lambda answered: print(answered, flush=True))


async def serve(c: Communication, port: int | None) -> None:
    link, loop = Link(c), asyncio.get_running_loop()
    if port is not None:
        await loop.create_datagram_endpoint(lambda: Datagrams(link), local_addr=("127.0.0.1", port))
    if sys.stdin.isatty():
        loop.add_reader(sys.stdin.fileno(), read_terminal, link, sys.stdin.fileno())
    await link.run()


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--port", type=int, help="take commands as datagrams at this UDP port of localhost")
    port: int | None = arguments.parse_args().port
    if port is not None and not 0 < port < 65536:
        arguments.error(f"--port {port} is not from 1 to 65535")
    try:
        with Communication() as c:
            asyncio.run(serve(c, port))
    except OSError as error:
        print(f"error: cannot use UDP port {port}: {error.strerror}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
