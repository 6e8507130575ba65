"""What the tests share: a folder in which components meet, Rust programs as peers, and Python programs of their own."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import textwrap
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from queue import Empty, Queue
from typing import Any

import pytest
import scl

TOPOLOGIES = Path(__file__).parents[3] / "tests" / "topologies"
SIX = TOPOLOGIES / "six_kinds.yaml"
# A shell that starts the tests in the background ignores SIGINT, and the programs under test would inherit that.
signal.signal(signal.SIGINT, signal.default_int_handler)

HANG_LIMIT = 60.0
"""How long a test waits for an expected event, in seconds. Only a test that would hang otherwise ever reaches it."""


NEVER = "1000s"
"""The grace period of programs after a stop request: longer than a test waits, so that no program that hangs, or that a busy
machine delays, is ended by it."""


class Program:
    """A program under test: controlled through its input, observed through its output."""

    def __init__(self, arguments: list[str], environment: dict[str, str]) -> None:
        self.process = subprocess.Popen(
            arguments,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, **environment},
        )
        self.lines: Queue[str] = Queue()
        self.errors: list[str] = []
        self._readers = [
            threading.Thread(target=self._read, args=(self.process.stdout, self.lines.put), daemon=True),
            threading.Thread(target=self._read, args=(self.process.stderr, self.errors.append), daemon=True),
        ]
        for reader in self._readers:
            reader.start()

    @staticmethod
    def _read(stream: Any, put: Callable[[str], None]) -> None:
        for line in stream:
            put(line.rstrip("\n"))

    def tell(self, command: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(f"{command}\n")
        self.process.stdin.flush()

    def next_line(self) -> str:
        try:
            return self.lines.get(timeout=HANG_LIMIT)
        except Empty:
            raise AssertionError(f"the program prints nothing; its errors: {self.errors}") from None

    def expect(self, line: str) -> None:
        found = self.next_line()
        assert found == line, self.errors

    def ask(self, command: str) -> str:
        self.tell(command)
        return self.next_line()

    def wait_until_asleep(self) -> None:
        """Waits until the main thread waits for something."""
        while Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()[0] != "S":
            assert self.process.poll() is None, self.errors

    def send_signal(self, number: signal.Signals) -> None:
        self.process.send_signal(number)

    def end(self) -> tuple[int, str]:
        """Waits for the end. Returns the exit code and what was written to standard error."""
        code = self.process.wait(HANG_LIMIT)
        for reader in self._readers:
            reader.join(HANG_LIMIT)
        return code, "\n".join(self.errors)

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()
        for reader in self._readers:
            reader.join(HANG_LIMIT)
        for stream in [self.process.stdin, self.process.stdout, self.process.stderr]:
            assert stream is not None
            stream.close()


class System:
    """A runtime folder for one test."""

    def __init__(self, folder: str, transport: str) -> None:
        self.folder = folder
        self.transport = transport
        self._programs: list[Program] = []
        self._components: list[scl.Component] = []

    def open(self, component: str, topology: Path = SIX) -> scl.DynamicComponent:
        # Ctrl-C ends the tests.
        opened = scl.open(topology, component, runtime_dir=self.folder, transport=self.transport, signals=False)
        self._components.append(opened)
        return opened

    def rust(self, component: str) -> Program:
        """Starts a component of `six_kinds.yaml` in Rust."""
        program = self._start([str(Path(os.environ["SCL_TEST_PROGRAMS"]) / "peer"), component])
        program.expect("open")
        return program

    def python(self, script: str, *arguments: str, **environment: str) -> Program:
        """Starts a Python program. It finds the path of the topology in `SIX`."""
        text = f"import scl\nSIX = {str(SIX)!r}\n{textwrap.dedent(script)}"
        return self._start([sys.executable, "-c", text, *arguments], environment)

    def _start(self, arguments: list[str], environment: dict[str, str] | None = None) -> Program:
        own = {"SCL_RUNTIME_DIR": self.folder, "SCL_TRANSPORT": self.transport, "SCL_STOP_WITHIN": NEVER}
        own |= environment or {}
        program = Program(arguments, own)
        self._programs.append(program)
        return program

    def end(self) -> None:
        for program in self._programs:
            program.kill()
        for component in self._components:
            with contextlib.suppress(scl.NotFlushed):
                component.close(0)


@pytest.fixture(params=["ipc", "tcp"])
def each_system(request: pytest.FixtureRequest) -> Iterator[System]:
    """On each transport."""
    yield from _system(request.param)


@pytest.fixture
def system() -> Iterator[System]:
    yield from _system("ipc")


def _system(transport: str) -> Iterator[System]:
    with tempfile.TemporaryDirectory(prefix="scl") as folder:
        system = System(folder, transport)
        try:
            yield system
        finally:
            system.end()
