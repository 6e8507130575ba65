"""Components opened beside their counterparts: what unit tests of programs do."""

from __future__ import annotations

import asyncio
import gc
import importlib.util
import os
import sys
import threading
import weakref
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
import scl
from conftest import SIX, Program, System

GENERATED = Path(__file__).parents[3] / "crates" / "scl-generate" / "tests" / "python" / "expected" / "testable_scl.py"
TOPOLOGY = Path(__file__).parents[3] / "crates" / "scl-generate" / "tests" / "topologies" / "testable.yaml"
LONG = 60.0


def _generated() -> ModuleType:
    spec = importlib.util.spec_from_file_location("testable_scl", GENERATED)
    assert spec is not None and spec.loader is not None
    module = sys.modules["testable_scl"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


testable: Any = _generated()


@pytest.fixture(autouse=True)
def no_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setenv("SCL_RUNTIME_DIR", str(tmp_path / "runtime"))
    yield
    assert not (tmp_path / "runtime").exists()


def _pairs() -> list[Any]:
    return [testable.Controller.test, lambda: scl.test(TOPOLOGY, "controller")]


@pytest.mark.parametrize("open_pair", _pairs(), ids=["generated", "dynamic"])
def test_messages_go_both_ways(open_pair: Any) -> None:
    controller, peer = open_pair()
    with controller, peer:
        # `setpoints` has two peers in the topology, and all of them are the one counterpart.
        controller.ready(0)
        peer.ready(0)
        assert (controller.name, peer.name, peer.system) == ("controller", "controller's peers", "testable")
        assert [*peer.gates] == [*controller.gates]
        peer.readings.send(peer.readings.type(speed=0.25))
        assert controller.readings.try_recv().speed == 0.25
        controller.setpoints.send(controller.setpoints.type(throttle=0.75))
        assert peer.wait(timeout=0) == [peer.setpoints]
        assert peer.setpoints.recv(0).throttle == 0.75
        controller.log.send(b"a line")
        peer.class_.send(b"a note")
        assert (peer.log.recv(LONG), controller.class_.recv(LONG)) == (b"a line", b"a note")
        peer.jobs.send(peer.jobs.type(speed=2))
        assert controller.jobs.recv(LONG).speed == 2
        assert controller.readings.type is peer.readings.type


@pytest.mark.parametrize("open_pair", _pairs(), ids=["generated", "dynamic"])
def test_missed_messages_are_told(open_pair: Any) -> None:
    controller, peer = open_pair()
    with controller, peer:
        told = 0
        for _ in range(3):
            # Nothing is sent, so the deadline passes.
            while (missed := controller.readings.take_missed()) == 0:
                pass
            told += missed
        assert told <= controller.readings.stats()["missed"]
        with pytest.raises(scl.Error, match="`controller.jobs` has no `deadline`; declare one in the topology"):
            controller.jobs.take_missed()
        with pytest.raises(scl.WrongDirection, match="has no `take_missed`"):
            controller.setpoints.take_missed()


@pytest.mark.parametrize("open_pair", _pairs(), ids=["generated", "dynamic"])
def test_a_task_waits_for_messages_that_do_not_come(open_pair: Any) -> None:
    async def main() -> None:
        controller, peer = open_pair()
        async with asyncio.timeout(LONG):
            with controller, peer:
                # Another task receives meanwhile.
                missed = asyncio.ensure_future(controller.readings.deadline_missed())
                received = asyncio.ensure_future(controller.readings.recv_async())
                assert await missed > 0
                peer.readings.send(peer.readings.type(speed=0.25))
                assert (await received).speed == 0.25
                # A wait that is cancelled has told nothing.
                with pytest.raises(TimeoutError):
                    await asyncio.wait_for(controller.readings.deadline_missed(), 0)
                assert await controller.readings.deadline_missed() > 0
                with pytest.raises(scl.Error, match="`controller.jobs` has no `deadline`"):
                    await controller.jobs.deadline_missed()
                rest = asyncio.ensure_future(_all_missed(controller))
                await controller.readings.deadline_missed()
            with pytest.raises(scl.Closed):
                await rest

    asyncio.run(main())


async def _all_missed(controller: Any) -> None:
    while True:
        await controller.readings.deadline_missed()


def test_generated_classes() -> None:
    class Own(testable.Controller):
        """A program's own subclass."""

    for tested in (testable.Controller, Own):
        component, peer = tested.test()
        with component, peer:
            assert type(component) is tested
            assert type(peer) is testable.ControllerPeer
    with pytest.raises(TypeError, match="ControllerPeer is opened together with its component, by `test"):
        testable.ControllerPeer()


@pytest.mark.parametrize("number", range(20))
def test_the_newest_reading_counts(number: int) -> None:
    controller, peer = testable.Controller.test()
    with controller, peer:
        for take in (controller.readings.recv, controller.readings.try_recv, controller.readings.latest):
            for speed in range(100):
                peer.readings.send(testable.Reading(speed=speed))
            assert take().speed == 99


def test_requests_are_answered() -> None:
    controller, peer = testable.Controller.test()

    def serve() -> None:
        for request in controller.commands:
            request.reply(testable.Status(accepted=request.message.target_speed < 2))

    with peer, controller:
        server = threading.Thread(target=serve)
        server.start()
        assert peer.commands.call(testable.Command(target_speed=1)).accepted
        assert not peer.commands.call(testable.Command(target_speed=3)).accepted
    # Closing the component has ended its loop.
    server.join()


def test_a_full_queue_makes_the_counterpart_wait() -> None:
    controller, peer = testable.Controller.test()
    with controller, peer:
        sent = 0
        with pytest.raises(scl.Full, match="gate `controller's peers.jobs`"):
            while True:
                peer.jobs.send(testable.Reading(speed=sent), timeout=0.05)
                sent += 1
        assert [controller.jobs.recv(LONG).speed for _ in range(sent)] == [*range(sent)]


def _fill(jobs: Any) -> None:
    with pytest.raises(scl.Full):
        while True:
            jobs.send(testable.Reading(), timeout=0)


def test_what_nobody_reads_is_no_problem(caplog: pytest.LogCaptureFixture) -> None:
    controller, peer = testable.Controller.test()
    with controller, peer:
        for _ in range(50):
            peer.readings.send(testable.Reading())
            controller.setpoints.send(testable.Setpoint())
            controller.spare.send(testable.Reading())
            controller.log.send(b"line")
        _fill(peer.jobs)
        assert peer.spare.try_recv() is None
    controller.close()
    assert caplog.records == []
    # A program may want to know, if it closes by itself what promises to lose nothing.
    controller, peer = testable.Controller.test()
    with controller:
        _fill(peer.jobs)
        with pytest.raises(scl.NotFlushed, match="from `controller's peers.jobs` to `controller.jobs`"):
            peer.close(0.01)


def test_components_need_no_gates() -> None:
    for name in ("empty", "recorder"):
        component, peer = scl.test(TOPOLOGY, name)
        with component, peer:
            assert [*component.gates] == [*peer.gates]


def test_closing_ends_calls_that_wait() -> None:
    controller, peer = testable.Controller.test()
    ended: list[type[BaseException]] = []
    waits = threading.Event()

    def receive(gate: Any) -> None:
        waits.set()
        try:
            gate.recv()
        except scl.Error as error:
            ended.append(type(error))

    for closed, gate in [(controller, controller.readings), (peer, peer.setpoints)]:
        waits.clear()
        thread = threading.Thread(target=receive, args=(gate,))
        thread.start()
        waits.wait()
        closed.close()
        thread.join()
    assert ended == [scl.Closed, scl.Closed]
    # The other end is gone, which is no reason to fail.
    controller, peer = testable.Controller.test()
    controller.setpoints.send(testable.Setpoint(throttle=1))
    controller.close()
    assert peer.setpoints.recv(LONG).throttle == 1
    with pytest.raises(
        scl.Timeout, match="`controller's peers.setpoints` received nothing from `controller.setpoints`"
    ):
        peer.setpoints.recv(0.01)
    peer.close()


def test_asyncio() -> None:
    async def steer(controller: Any) -> None:
        async for reading in controller.readings:
            controller.setpoints.send(testable.Setpoint(throttle=1 - reading.speed))

    async def obey(controller: Any) -> None:
        async for request in controller.commands:
            request.reply(testable.Status(accepted=True))

    async def main() -> None:
        controller, peer = testable.Controller.test()
        async with peer, controller:
            tasks = [asyncio.create_task(steer(controller)), asyncio.create_task(obey(controller))]
            for speed in range(100):
                peer.readings.send(testable.Reading(speed=speed))
                assert (await peer.setpoints.recv_async(LONG)).throttle == 1 - speed
            assert (await peer.commands.call_async(testable.Command())).accepted
            with pytest.raises(scl.Timeout, match="`controller.limits` got no reply from `world.limits`"):
                await controller.limits.call_async(testable.Command())
        await asyncio.gather(*tasks)

    asyncio.run(main())


def test_mistakes_are_explained() -> None:
    controller, peer = testable.Controller.test()
    with controller, peer:
        with pytest.raises(scl.UnknownGate, match="component `controller's peers` has no gate `reading`; did you mean"):
            peer.reading  # noqa: B018
        with pytest.raises(scl.WrongDirection, match="`controller's peers.readings` is a `pub` gate and has no `recv`"):
            peer.readings.recv()
        with pytest.raises(TypeError, match="`controller's peers.readings` carries `testable.Reading`, not"):
            peer.readings.send(testable.Setpoint())
        with pytest.raises(scl.Timeout, match="`controller.readings` received nothing from `world.readings` within"):
            controller.readings.recv(0.01)
    with pytest.raises(scl.UnknownComponent, match="did you mean `controller`"):
        scl.test(TOPOLOGY, "controler")
    with pytest.raises(scl.TopologyError, match="nowhere"):
        scl.test("nowhere.yaml", "controller")


def test_pairs_do_not_meet() -> None:
    first, second = testable.Controller.test(), testable.Controller.test()
    with first[0], first[1], second[0], second[1]:
        first[1].readings.send(testable.Reading(speed=1))
        second[1].readings.send(testable.Reading(speed=2))
        assert (first[0].readings.recv(LONG).speed, second[0].readings.recv(LONG).speed) == (1, 2)


def test_a_pair_that_is_not_closed_is_collected() -> None:
    controller, peer = testable.Controller.test()
    peer.readings.send(testable.Reading())
    watched = [weakref.ref(controller), weakref.ref(peer)]
    del controller, peer
    gc.collect()
    assert [it() for it in watched] == [None, None]


def test_a_test_leaves_signals_alone_and_ends_quietly(system: System) -> None:
    program: Program = system.python(
        f"""
        import signal
        before = signal.getsignal(signal.SIGTERM)
        source, peer = scl.test({str(SIX)!r}, "source")
        assert signal.getsignal(signal.SIGTERM) is before
        for _ in range(50):
            source.readings.send(source.readings.type(value=1))
        print("done", flush=True)
        """
    )
    program.expect("done")
    assert program.end() == (0, "")
    assert os.listdir(system.folder) == []


def test_pytest_does_not_collect_the_function() -> None:
    assert not vars(scl.test)["__test__"]
