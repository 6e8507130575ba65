"""Where NMEA sentences come from: a serial line, or a file in its place. Both may be missing, vanish and come back."""

import os
import time
from pathlib import Path
from typing import Protocol

import serial

BAUD = 9600  # NMEA 0183 has 4800; receivers with five fixes a second need more
BITS_PER_BYTE = 10  # with start and stop bit


class Source(Protocol):
    """An open source."""

    def files(self) -> list[int]:
        """What to wait for with `select`."""

    def read(self) -> bytes | None:
        """What has arrived, without waiting; `None` if the source has vanished."""

    def close(self) -> None: ...


class SerialLine:
    """A serial device."""

    def __init__(self, path: Path, baud: int) -> None:
        self._port = serial.Serial(str(path), baud, timeout=0)

    def files(self) -> list[int]:
        return [self._port.fileno()]

    def read(self) -> bytes | None:
        try:
            return bytes(self._port.read(4096))
        except serial.SerialException:
            return None

    def close(self) -> None:
        self._port.close()


class SentenceFile:
    """A file, read as slowly as a serial line would deliver it, so that its fixes have a distance. It may grow."""

    def __init__(self, path: Path, baud: int) -> None:
        self._path, self._rate = path, baud / BITS_PER_BYTE
        self._file = path.open("rb", buffering=0)
        self._until = time.monotonic()  # up to here, its bytes have been delivered

    def files(self) -> list[int]:
        return []

    def read(self) -> bytes | None:
        now = time.monotonic()
        due = int((now - self._until) * self._rate)
        if due == 0:
            return b""
        self._until = now
        data = self._file.read(due)
        return data if data or self._is_there() else None

    def _is_there(self) -> bool:
        """Whether the path still leads to this file, or to another one."""
        try:
            return os.path.samestat(os.fstat(self._file.fileno()), self._path.stat())
        except OSError:
            return False

    def close(self) -> None:
        self._file.close()


def open_source(path: Path, baud: int) -> Source | None:
    """The source, or `None` while it cannot be opened."""
    try:
        return SentenceFile(path, baud) if path.is_file() else SerialLine(path, baud)
    except OSError:
        # Also a `SerialException`.
        return None
