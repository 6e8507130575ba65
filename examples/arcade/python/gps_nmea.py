"""The GPS receiver at a serial line: publishes what its NMEA sentences say."""

import argparse
import os
import select
import stat
import sys
import time
import tty
from contextlib import suppress
from pathlib import Path

from arcade_scl import GpsSensor
from nmea import Receiver

RETRY = 0.2  # s between two attempts to open the device, or to read on at the end of a file
REPORT = 1.0  # s between two reports of sentences that are no use


def open_device(path: Path) -> int | None:
    """The device, or `None` while there is none."""
    try:
        # A terminal without a carrier would not open otherwise, and must not become the one that controls this program.
        device = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY)
    except OSError:
        return None
    if os.isatty(device):
        # Bytes as they come: no echo, and no waiting for the end of a line.
        tty.setraw(device)
    return device


def read_device(device: int, path: Path) -> bytes | None:
    """What has arrived, or `None` if the device has vanished or was replaced."""
    try:
        data = os.read(device, 4096)
        if data:
            return data
        # The end of a file, which may grow; a device at its end has gone.
        here, there = os.fstat(device), path.stat()
        same = (here.st_dev, here.st_ino) == (there.st_dev, there.st_ino) and stat.S_ISREG(here.st_mode)
        return b"" if same else None
    except BlockingIOError:
        return b""
    except OSError:
        return None


class Reader:
    """The loop: waits for the device, reads it, and publishes."""

    def __init__(self, c: GpsSensor, path: Path) -> None:
        self.c, self.path = c, path
        self.receiver = Receiver()
        self.device: int | None = None
        self.waiting = False
        # The vehicle's clock is that of the world's newest message: a receiver knows the time of day, and nothing else of it.
        self.time_us: int | None = None
        self.reported = time.monotonic()

    def step(self) -> None:
        """Waits a little for bytes or for the clock, and publishes what has become of them."""
        if self.device is None:
            self.reopen()
        files = [self.c.fileno()] + ([] if self.device is None else [self.device])
        readable, _, _ = select.select(files, [], [], RETRY)
        world = self.c.world.latest()
        if world is not None:
            self.time_us = world.time_us
        self.c.parameters.latest()
        if self.device in readable:
            self.read()
        if time.monotonic() - self.reported >= REPORT:
            self.report()

    def reopen(self) -> None:
        self.device = open_device(self.path)
        if self.device is None and not self.waiting:
            print(f"waiting for {self.path}", flush=True)
        elif self.device is not None:
            print(f"reading {self.path}", flush=True)
            self.receiver = Receiver(self.receiver.problems)
        self.waiting = self.device is None

    def read(self) -> None:
        assert self.device is not None
        data = read_device(self.device, self.path)
        if data is None:
            print(f"lost {self.path}", flush=True)
            os.close(self.device)
            self.device = None
        elif not data:
            time.sleep(RETRY)
        elif self.time_us is not None:
            for fix in self.receiver.add(data, self.time_us):
                self.c.fix.send(fix)

    def report(self) -> None:
        """One line for each kind of useless sentence of the last second."""
        for problem, count in sorted(self.receiver.problems.items()):
            print(f"{count} sentence{'s' if count > 1 else ''} of no use: {problem}", flush=True)
        self.receiver.problems.clear()
        self.reported = time.monotonic()


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--device", type=Path, required=True, help="the serial line, or a file with NMEA sentences")
    path: Path = arguments.parse_args().device
    with GpsSensor() as c:
        reader = Reader(c, path)
        while True:
            reader.step()


if __name__ == "__main__":
    with suppress(KeyboardInterrupt):
        sys.exit(main())
