"""The receiver at its serial line, beside the other ends of its gates."""

import os
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from arcade_scl import Fix, GpsSensor, World
from gps_nmea import Reader
from nmea_sentences import GGA, RMC
from serial_source import BAUD

HANG_LIMIT = 60.0  # s; only a test that would hang otherwise ever reaches it


class Bench:
    """A reader, and what it publishes."""

    def __init__(self, path: Path) -> None:
        component, self.peer = GpsSensor.test()
        self.path, self.reader = path, Reader(component, path, BAUD)

    def set_time(self, time_us: int) -> None:
        self.peer.world.send(World(time_us=time_us))
        while self.reader.time_us != time_us:
            self.reader.step()

    def next_fix(self) -> Fix:
        deadline = time.monotonic() + HANG_LIMIT
        while (fix := self.peer.fix.try_recv()) is None:
            assert time.monotonic() < deadline, "no fix"
            self.reader.step()
        return fix

    def connect(self) -> tuple[int, int]:
        """A serial line, which the reader opens: the receiver's end, and the one that keeps it open."""
        receiver, line = os.openpty()
        self.path.unlink(missing_ok=True)
        self.path.symlink_to(os.ttyname(line))
        # What is sent before is dropped: it may be the rest of a line.
        while self.reader.source is None:
            self.reader.step()
        return receiver, line

    def disconnect(self, ends: tuple[int, int]) -> None:
        for end in ends:
            os.close(end)
        while self.reader.source:
            self.reader.step()


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Bench]:
    bench = Bench(tmp_path / "gps")
    with bench.reader.component, bench.peer:
        yield bench
    if bench.reader.source:
        bench.reader.source.close()


def test_a_serial_line_that_appears_vanishes_and_comes_back(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    bench.set_time(7)
    ends = bench.connect()
    os.write(ends[0], GGA + RMC + GGA[:20])
    assert bench.next_fix().time_us == 7
    bench.set_time(8)
    os.write(ends[0], GGA[20:] + RMC + GGA[:20])
    assert bench.next_fix().time_us == 8
    bench.disconnect(ends)
    ends = bench.connect()
    os.write(ends[0], GGA + RMC)
    assert bench.next_fix().satellites == 8
    bench.disconnect(ends)
    path = bench.path
    expected = [f"waiting for {path}", f"reading {path}", f"lost {path}", f"reading {path}", f"lost {path}"]
    assert capsys.readouterr().out.splitlines() == expected


def test_without_the_vehicles_clock_nothing_is_published(bench: Bench) -> None:
    ends = bench.connect()
    os.write(ends[0], GGA + RMC)
    bench.reader.step()
    assert bench.peer.fix.try_recv() is None
    bench.set_time(9)
    os.write(ends[0], GGA + RMC)
    assert bench.next_fix().time_us == 9
    bench.disconnect(ends)


def test_a_file_may_grow_and_be_replaced(bench: Bench) -> None:
    bench.set_time(7)
    bench.path.write_bytes(GGA)
    bench.reader.step()
    with bench.path.open("ab") as file:
        file.write(RMC)
    assert bench.next_fix().satellites == 8
    other = bench.path.with_suffix(".new")
    other.write_bytes(GGA.replace(b",08,", b",09,").replace(GGA[-4:-2], b"%02X" % (int(GGA[-4:-2], 16) ^ 1)) + RMC)
    other.replace(bench.path)
    assert bench.next_fix().satellites == 9


def test_problems_are_reported_once_a_second(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    bench.set_time(7)
    ends = bench.connect()
    os.write(ends[0], 3 * b"hello\n" + GGA[:-4] + b"00\r\n" + GGA + RMC)
    bench.next_fix()
    bench.reader.report()
    bench.reader.report()
    said = capsys.readouterr().out.splitlines()
    assert said[2:] == ["3 unusable sentences: not a sentence", "1 unusable sentence: wrong checksum"]
    bench.disconnect(ends)
