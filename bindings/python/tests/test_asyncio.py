"""Gates in asyncio, and in uvloop."""

import asyncio
import signal
from collections.abc import Callable, Coroutine
from typing import Any

import pytest
import scl
import uvloop
from conftest import SIX, System

Run = Callable[[Coroutine[Any, Any, None]], None]


@pytest.fixture(params=["asyncio", "uvloop"])
def run(request: pytest.FixtureRequest) -> Run:
    """Runs a coroutine in each event loop."""

    def run(main: Coroutine[Any, Any, None]) -> None:
        factory = uvloop.new_event_loop if request.param == "uvloop" else None
        with asyncio.Runner(loop_factory=factory) as runner:
            runner.run(asyncio.wait_for(main, 60))

    return run


def test_rust_sends_to_tasks(each_system: System, run: Run) -> None:
    source = each_system.rust("source")

    async def main() -> None:
        async with each_system.open("sink") as sink:
            await sink.ready_async(60)
            source.tell("publish 0 3")
            values = []
            async for message in sink.readings:
                values.append(message.value)
                if len(values) == 3:
                    break
            assert values == [0, 1, 2]
            source.tell("call 21")
            request = await sink.answer.recv_async()
            request.reply(sink.answer.reply_type(value=42))
            source.expect("published")
            await asyncio.to_thread(source.expect, "42")

    run(main())


def test_tasks_send_to_rust(each_system: System, run: Run) -> None:
    sink = each_system.rust("sink")

    async def main() -> None:
        async with each_system.open("source") as source:
            await source.ready_async(60)
            message = source.jobs.type
            sink.tell("lossless_up_to 499")
            for value in range(500):
                await source.lossless.send_async(message(value=value))
            await asyncio.to_thread(sink.expect, "0..500")
            sink.tell("serve 2")
            for value in [1, 2]:
                assert (await source.question.call_async(message(value=value))).value == 2 * value

    run(main())


def test_many_tasks_wait_for_different_gates(system: System, run: Run) -> None:
    async def main() -> None:
        source, sink = system.open("source"), system.open("sink")
        await asyncio.gather(source.ready_async(60), sink.ready_async(60))
        message = source.readings.type

        async def serve() -> None:
            async for request in sink.answer:
                request.reply(message(value=request.message.value + 1))

        async def count(gate: Any, expected: int) -> int:
            received = 0
            async for _ in gate:
                received += 1
                if received == expected:
                    break
            return received

        async def ask() -> int:
            value = 0
            for _ in range(100):
                value = (await source.question.call_async(message(value=value))).value
            return value

        async def send(gate: Any) -> int:
            for value in range(200):
                await gate.send_async(message(value=value))
            return 0

        serving = asyncio.create_task(serve())
        results = await asyncio.gather(
            count(sink.readings, 200),
            count(sink.lossless, 200),
            count(sink.jobs, 200),
            ask(),
            send(source.readings),
            send(source.lossless),
            send(source.jobs),
        )
        assert results == [200, 200, 200, 100, 0, 0, 0]
        # Closing ends the loop.
        sink.close()
        await serving

    run(main())


def test_a_call_that_is_cancelled_loses_no_message(system: System, run: Run) -> None:
    async def main() -> None:
        source, sink = system.open("source"), system.open("sink")
        await asyncio.gather(source.ready_async(60), sink.ready_async(60))
        message, received = source.jobs.type, []
        for value in range(1000):
            task = asyncio.create_task(sink.jobs.recv_async())
            for _ in range(value % 3):
                await asyncio.sleep(0)
            source.jobs.send(message(value=value))
            for _ in range(value % 5):
                await asyncio.sleep(0)
            task.cancel()
            try:
                received.append((await task).value)
            except asyncio.CancelledError:
                pass
        while len(received) < 1000:
            received.append((await sink.jobs.recv_async(60)).value)
        assert received == [*range(1000)]

    run(main())


def test_a_cancelled_request_gives_the_gate_back(system: System, run: Run) -> None:
    async def main() -> None:
        source, sink = system.open("source"), system.open("sink")
        await source.ready_async(60)
        message = source.question.type
        for value in range(20):
            asking = asyncio.create_task(source.question.call_async(message(value=value)))
            request = await sink.answer.recv_async()
            asking.cancel()
            with pytest.raises(asyncio.CancelledError):
                await asking
            request.reply(message(value=99))
        answering = asyncio.create_task(sink.answer.recv_async())
        asking = asyncio.create_task(source.question.call_async(message(value=1)))
        (await answering).reply(message(value=2))
        assert (await asking).value == 2

    run(main())


def test_time_limits(system: System, run: Run) -> None:
    async def main() -> None:
        source, sink = system.open("source"), system.open("sink")
        for gate in [sink.readings, sink.answer]:
            for timeout in [0, 0.02]:
                with pytest.raises(scl.Timeout, match=f"gate `{gate.name}`.* received nothing from"):
                    await gate.recv_async(timeout)
        with pytest.raises(scl.Timeout, match="got no reply"):
            await source.question.call_async(source.question.type(), timeout=0.02)
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(0.02):
                await sink.readings.recv_async()
        with pytest.raises(scl.Full, match="queue of `sink.lossless` is full"):
            while True:
                await source.lossless.send_async(source.lossless.type(), 0.02)

    run(main())


def test_one_task_at_a_time_awaits_a_gate(system: System, run: Run) -> None:
    async def main() -> None:
        sink = system.open("sink")
        first = asyncio.create_task(sink.readings.recv_async())
        await asyncio.sleep(0)
        with pytest.raises(scl.Busy, match="gate `sink.readings` is awaited by another task"):
            await sink.readings.recv_async()
        first.cancel()
        with pytest.raises(asyncio.CancelledError):
            await first
        with pytest.raises(scl.Timeout):
            await sink.readings.recv_async(0.01)

    run(main())


def test_closing_ends_what_tasks_wait_for(system: System, run: Run) -> None:
    async def main() -> None:
        # Its requests reach nobody.
        source, sink = scl.open(SIX, "source", runtime_dir=system.folder, system="other"), system.open("sink")
        waiting = [
            asyncio.create_task(sink.readings.recv_async()),
            asyncio.create_task(sink.answer.recv_async()),
            asyncio.create_task(source.question.call_async(source.question.type())),
        ]
        # They wait when this goes on.
        await asyncio.sleep(0)
        sink.close()
        source.close()
        for error in await asyncio.gather(*waiting, return_exceptions=True):
            assert isinstance(error, scl.Closed)

    run(main())


def test_a_component_outlives_its_event_loop(system: System, run: Run) -> None:
    source, sink = system.open("source"), system.open("sink")

    async def main() -> None:
        source.jobs.send(source.jobs.type(value=1))
        assert (await sink.jobs.recv_async()).value == 1

    run(main())
    asyncio.run(main())
    source.jobs.send(source.jobs.type(value=2))
    assert sink.jobs.recv(60).value == 2


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
@pytest.mark.parametrize("factory", ["None", "uvloop.new_event_loop"])
def test_signals_end_a_program_of_tasks(system: System, number: signal.Signals, factory: str) -> None:
    program = system.python(f"""
        import asyncio, uvloop
        async def main():
            async with scl.open(SIX, "sink") as sink:
                print("open", flush=True)
                async for message in sink.readings:
                    pass
            print("closed", flush=True)
        with asyncio.Runner(loop_factory={factory}) as runner:
            runner.run(main())
    """)
    program.expect("open")
    program.wait_until_asleep()
    program.send_signal(number)
    program.expect("closed")
    assert program.end() == (0, "")


def test_a_stop_request_ends_all_loops_in_order(system: System) -> None:
    program = system.python("""
        import asyncio
        import os
        import signal
        from contextlib import asynccontextmanager

        @asynccontextmanager
        async def told(name):
            try:
                yield
            finally:
                print(name, "ends", flush=True)

        async def send(source):
            async with told("sending"):
                while True:
                    source.readings.send(source.readings.type(value=1))
                    await asyncio.sleep(0.001)

        async def sleep():
            async with told("sleeping"):
                await asyncio.sleep(3600)

        async def stop():
            os.kill(os.getpid(), signal.SIGTERM)
            await asyncio.sleep(3600)

        async def main():
            async with scl.open(SIX, "source") as source:
                await scl.until_stopped(sleep(), send(source), stop())

        asyncio.run(main())
        print("closed", flush=True)
    """)
    assert program.end() == (0, "")
    # A loop that was about to run is cancelled before one that sleeps.
    assert {program.next_line(), program.next_line()} == {"sleeping ends", "sending ends"}
    program.expect("closed")


def test_the_loop_that_fails_ends_the_others(run: Run) -> None:
    ended = []

    async def wait() -> None:
        try:
            await asyncio.sleep(3600)
        finally:
            ended.append("waiting")

    async def fail() -> None:
        raise ValueError("failed")

    async def main() -> None:
        with pytest.raises(ValueError, match="failed"):
            await scl.until_stopped(wait(), fail())
        assert ended == ["waiting"]
        await scl.until_stopped(wait(), asyncio.sleep(0))
        assert ended == ["waiting"] * 2
        # Without loops, it waits for a stop request.
        with pytest.raises(asyncio.TimeoutError):
            await asyncio.wait_for(scl.until_stopped(), 0.001)
        with pytest.raises(asyncio.TimeoutError):
            await asyncio.wait_for(scl.until_stopped(wait()), 0.001)
        assert ended == ["waiting"] * 3

    run(main())
