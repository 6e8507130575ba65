"""The GPS receiver at a serial line: publishes what its NMEA sentences say."""

import argparse
import select
import sys
import time
from pathlib import Path

from arcade_scl import GpsSensor
from nmea import Receiver
from serial_source import BAUD, Source, open_source

RETRY = 0.2  # s between two attempts to open the device
REPORT = 1.0  # s between two reports of sentences that are no use


class Reader:
    """Waits for the device, reads it, and publishes fixes."""

    def __init__(self, component: GpsSensor, path: Path, baud: int) -> None:
        self.component, self.path, self.baud = component, path, baud
        self.receiver = Receiver()
        self.source: Source | None = None
        self.is_missing = False  # and that was said
        # A receiver knows the time of day, and nothing of the vehicle's clock. The newest message of the world tells that.
        self.time_us: int | None = None
        self.reported = time.monotonic()

    def step(self) -> None:
        """Waits a little for the device and the clock, and publishes what has arrived."""
        if self.source is None:
            self.open()
        files = self.source.files() if self.source else []
        select.select([self.component.fileno(), *files], [], [], RETRY)
        if world := self.component.world.latest():
            self.time_us = world.time_us
        self.component.limits.latest()  # a real receiver knows where it is
        if self.source:
            self.read(self.source)
        if time.monotonic() - self.reported >= REPORT:
            self.report()

    def open(self) -> None:
        self.source = open_source(self.path, self.baud)
        if self.source:
            print(f"reading {self.path}", flush=True)
            # The rest of a line that was cut off belongs to no line of this time.
            self.receiver = Receiver(self.receiver.problems)
        elif not self.is_missing:
            print(f"waiting for {self.path}", flush=True)
        self.is_missing = self.source is None

    def read(self, source: Source) -> None:
        data = source.read()
        if data is None:
            print(f"lost {self.path}", flush=True)
            source.close()
            self.source = None
        elif self.time_us is not None:
            for fix in self.receiver.add(data, self.time_us):
                self.component.fix.send(fix)

    def report(self) -> None:
        """One line for each kind of useless sentence of the last second."""
        for problem, count in sorted(self.receiver.problems.items()):
            print(f"{count} unusable sentence{'s' if count > 1 else ''}: {problem}", flush=True)
        self.receiver.problems.clear()
        self.reported = time.monotonic()


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--device", type=Path, required=True, help="the serial line, or a file with NMEA sentences")
    arguments.add_argument(
        "--baud", type=int, default=BAUD, help=f"bits per second of the serial line (default: {BAUD})"
    )
    given = arguments.parse_args()
    if given.baud not in (4800, 9600, 19200, 38400, 57600, 115200):
        arguments.error(f"--baud {given.baud} is not 4800, 9600, 19200, 38400, 57600 or 115200")
    with GpsSensor() as component:
        reader = Reader(component, given.device, given.baud)
        while True:
            reader.step()


if __name__ == "__main__":
    sys.exit(main())
