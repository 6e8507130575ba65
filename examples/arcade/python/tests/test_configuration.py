"""The configuration daemon beside the other ends of its gates, and as a program."""

import contextlib
from collections.abc import Iterator
from pathlib import Path

import pytest

import configuration
import parameters
from arcade_scl import Configuration, ConfigurationPeer, ParameterChange, Parameters
from configuration import Store
from conftest import HANG_LIMIT, Background, RunProgram, running, until


@contextlib.contextmanager
def started(store: Store) -> Iterator[ConfigurationPeer]:
    component, peer = Configuration.test()
    with running(component, lambda: configuration.run(component, store)):
        yield peer


def published(peer: ConfigurationPeer, name: str, value: float) -> Parameters:
    def has_it(message: Parameters) -> bool:
        return parameters.values_of(message)[name] == value

    return until(lambda: peer.parameters.recv(timeout=HANG_LIMIT), has_it)


def test_all_parameters_are_published_at_the_start() -> None:
    with started(Store(None)) as peer:
        message = peer.parameters.recv(timeout=HANG_LIMIT)
        assert {it.name: it.value for it in message.parameters} == parameters.DEFAULTS


def test_a_change_is_published_and_kept(tmp_path: Path) -> None:
    file = tmp_path / "parameters.yaml"
    with started(Store(file)) as peer:
        result = peer.control.call(ParameterChange(name="fence.radius", value=42), timeout=HANG_LIMIT)
        assert (result.accepted, result.reason) == (True, "")
        published(peer, "fence.radius", 42)
    with started(Store(file)) as peer:
        published(peer, "fence.radius", 42)


def test_a_change_is_published_at_once() -> None:
    component, peer = Configuration.test()
    answer = Background(lambda: peer.control.call(ParameterChange(name="fence.radius", value=42), timeout=HANG_LIMIT))
    assert component.wait(component.control, timeout=HANG_LIMIT)
    # Without the loop, which publishes at its start.
    configuration.answer(component, Store(None))
    answer.result()
    published(peer, "fence.radius", 42)


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("fence.radus", 42, "unknown parameter `fence.radus`; did you mean `fence.radius`?"),
        ("fence.radius", 1e9, "`fence.radius: 1e+09` is out of range; it is 5 to 1000 m"),
        ("fence.radius", float("nan"), "`fence.radius: nan` is not a finite number; it is 5 to 1000 m"),
    ],
)
def test_a_bad_change_is_refused(name: str, value: float, reason: str) -> None:
    with started(Store(None)) as peer:
        result = peer.control.call(ParameterChange(name=name, value=value), timeout=HANG_LIMIT)
        assert (result.accepted, result.reason) == (False, reason)
        published(peer, "fence.radius", 100)


def test_a_file_that_cannot_be_written_is_told_in_the_reply(tmp_path: Path) -> None:
    folder = tmp_path / "gone"
    with started(Store(folder / "p.yaml")) as peer:
        result = peer.control.call(ParameterChange(name="fence.radius", value=42), timeout=HANG_LIMIT)
        assert result.reason == (
            f"cannot write {folder}/p.yaml: No such file or directory; `fence.radius` is still 100"
        )


def test_a_corrupt_file_ends_the_program_before_it_starts(tmp_path: Path, run_program: RunProgram) -> None:
    file = tmp_path / "p.yaml"
    file.write_text("fence.radius: 5000\nfence.hight: 20\n")
    finished = run_program("configuration.py", "--file", str(file))
    assert finished.returncode == 2
    assert finished.stderr.splitlines() == [
        f"error: {file}:1: `fence.radius: 5000` is out of range; it is 5 to 1000 m",
        f"error: {file}:2: unknown parameter `fence.hight`; did you mean `fence.height`?",
    ]


def test_wrong_arguments(run_program: RunProgram) -> None:
    assert run_program("configuration.py", "--fil").returncode == 2
    assert run_program("configuration.py", "--help").returncode == 0
