"""What the tests share."""

import contextlib
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from pathlib import Path
from typing import TypeVar

import pytest
import scl

PYTHON_FOLDER = Path(__file__).parents[1]
HANG_LIMIT = 60.0  # s; only a test that would hang otherwise ever reaches it

T = TypeVar("T")
Finished = subprocess.CompletedProcess[str]
RunProgram = Callable[..., Finished]


@pytest.fixture
def own_system(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Keeps programs apart from systems that run on the same machine."""
    # The paths of sockets are short, and those of pytest's folders are long.
    with tempfile.TemporaryDirectory(prefix="scl") as folder:
        monkeypatch.setenv("SCL_RUNTIME_DIR", folder)
        monkeypatch.setenv("PYTHONUNBUFFERED", "1")
        yield


@pytest.fixture
def run_program(own_system: None) -> RunProgram:
    """Runs Python in the folder of the programs, until it ends."""

    def run(*arguments: str) -> Finished:
        command = [sys.executable, *arguments]
        return subprocess.run(
            command, check=False, cwd=PYTHON_FOLDER, capture_output=True, text=True, timeout=HANG_LIMIT
        )

    return run


@contextlib.contextmanager
def running(component: scl.Component, loop: Callable[[], object]) -> Iterator[None]:
    """Runs the loop of a component that was opened by `test()`, until the block ends; then nothing else may have ended it."""
    ended = Background(loop)
    try:
        yield
        assert not ended.outcome.done(), ended.outcome.exception()
    finally:
        # What the test did not receive is left over.
        with contextlib.suppress(scl.NotFlushed):
            component.close(0)
        with contextlib.suppress(scl.Closed):
            ended.result()


class Background:
    """A call in a thread of its own, because it waits for what the test does next."""

    def __init__(self, call: Callable[[], object]) -> None:
        self.outcome: Future[object] = Future()
        self._thread = threading.Thread(target=self._run, args=(call,), daemon=True)
        self._thread.start()

    def _run(self, call: Callable[[], object]) -> None:
        try:
            self.outcome.set_result(call())
        except BaseException as error:  # noqa: BLE001
            self.outcome.set_exception(error)

    def result(self) -> object:
        return self.outcome.result(HANG_LIMIT)


def until(receive: Callable[[], T], wanted: Callable[[T], bool]) -> T:
    """Receives until the wanted message arrives; `receive` has a time limit."""
    while not wanted(message := receive()):
        pass
    return message
