"""Calls that wait: signals, other threads, and components that are closed meanwhile."""

import signal
import textwrap
import threading
import time
from pathlib import Path

import pytest
import scl
from conftest import SIX, Program, System

# Each opens a component with `OPTIONS`.
WAITS = {
    "recv": 'scl.open(SIX, "sink", **OPTIONS).readings.recv()',
    "iteration": 'next(iter(scl.open(SIX, "sink", **OPTIONS).readings))',
    "request": 'scl.open(SIX, "sink", **OPTIONS).answer.recv()',
    "call": 'c = scl.open(SIX, "source", **OPTIONS); c.question.call(c.question.type(), timeout=1000)',
    "send": """
        c = scl.open(SIX, "source", **OPTIONS)
        while True:
            c.lossless.send(c.lossless.type())
    """,
    "ready": 'scl.open(SIX, "sink", **OPTIONS).ready()',
    "wait": 'scl.open(SIX, "sink", **OPTIONS).wait()',
    "join": """
        import threading
        c = scl.open(SIX, "sink", **OPTIONS)
        with c:
            waiting = threading.Thread(target=lambda: list(c.readings))
            waiting.start()
            waiting.join()
    """,
    "two threads": """
        import threading
        c = scl.open(SIX, "sink", **OPTIONS)
        with c:
            threading.Thread(target=lambda: list(c.jobs)).start()
            c.readings.recv()
    """,
    "asyncio": """
        import asyncio
        c = scl.open(SIX, "sink", **OPTIONS)
        asyncio.run(c.readings.recv_async())
    """,
}


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
@pytest.mark.parametrize("script", WAITS.values(), ids=WAITS.keys())
def test_a_stop_signal_ends_the_program_in_order(system: System, script: str, number: signal.Signals) -> None:
    program = system.python(f"OPTIONS = {{}}\nprint('open', flush=True)\n{_dedent(script)}")
    program.expect("open")
    _wait_until_open(system, program)
    program.send_signal(number)
    code, errors = program.end()
    assert (code, errors) in [(0, ""), (1, _stop_iteration(errors))], errors


@pytest.mark.parametrize("script", WAITS.values(), ids=WAITS.keys())
def test_without_signals_ctrl_c_raises_keyboard_interrupt(system: System, script: str) -> None:
    program = system.python(f"OPTIONS = dict(signals=False)\nprint('open', flush=True)\n{_dedent(script)}")
    program.expect("open")
    _wait_until_open(system, program)
    program.send_signal(signal.SIGINT)
    code, errors = program.end()
    assert code == -signal.SIGINT, errors
    assert "KeyboardInterrupt" in errors.splitlines()


def test_sigterm_ends_a_loop_and_what_follows_runs(system: System) -> None:
    program = system.python("""
        with scl.open(SIX, "sink") as sink:
            print("open", flush=True)
            for message in sink.readings:
                pass
            print("after the loop", flush=True)
            try:
                sink.readings.recv()
            except scl.Stopped as stopped:
                print(stopped, flush=True)
            print(scl.stop_requested(), flush=True)
            # From now on the program handles the request itself, and its gates work.
            print(sink.readings.try_recv(), flush=True)
    """)
    program.expect("open")
    program.send_signal(signal.SIGTERM)
    for line in ["after the loop", "stop requested", "True", "None"]:
        program.expect(line)
    assert program.end() == (0, "")


def test_a_program_that_sends_and_sleeps_ends_at_its_next_send(system: System) -> None:
    program = system.python("""
        import time
        source = scl.open(SIX, "source")
        print("open", flush=True)
        while True:
            source.readings.send(source.readings.type())
            time.sleep(0.01)
    """)
    program.expect("open")
    program.send_signal(signal.SIGTERM)
    assert program.end()[0] == 0


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_program_that_does_not_end_is_ended_after_the_grace_period(system: System, number: signal.Signals) -> None:
    for handles in ["", "scl.stop_requested()"]:
        program = system.python(
            f"""
            import time
            sink = scl.open(SIX, "sink")
            {handles}
            print("open", flush=True)
            while True:
                time.sleep(0.1)
            """,
            SCL_STOP_WITHIN="200ms",
        )
        program.expect("open")
        program.send_signal(number)
        code, errors = program.end()
        assert code == -number
        assert errors == f"the program is still running 200ms after {number.name}; ending it"


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_handler_of_the_program_s_own_is_kept(system: System, number: signal.Signals) -> None:
    program = system.python(f"""
        import signal, sys
        signal.signal({number}, lambda *_: sys.exit(7))
        sink = scl.open(SIX, "sink")
        print("open", flush=True)
        sink.readings.recv()
    """)
    program.expect("open")
    program.send_signal(number)
    assert program.end() == (7, "")


def test_without_signals_sigterm_kills(system: System) -> None:
    program = system.python("""
        sink = scl.open(SIX, "sink", signals=False)
        print("open", flush=True)
        sink.readings.recv()
    """)
    program.expect("open")
    program.send_signal(signal.SIGTERM)
    assert program.end() == (-signal.SIGTERM, "")


def test_an_exception_in_the_middle_of_a_loop_closes_the_component(system: System) -> None:
    source = system.rust("source")
    sink = system.open("sink")
    with pytest.raises(ZeroDivisionError), sink:
        sink.ready(60)
        source.tell("publish 0 1")
        for message in sink.readings:
            1 / message.value
    system.open("sink")


def test_a_handler_that_raises_ends_the_wait(system: System) -> None:
    program = system.python("""
        import signal
        def handle(*_):
            raise ValueError("from the handler")
        signal.signal(signal.SIGUSR1, handle)
        sink = scl.open(SIX, "sink")
        print("open", flush=True)
        try:
            sink.readings.recv()
        except ValueError as error:
            print(error, flush=True)
        print(sink.readings.try_recv(), flush=True)
    """)
    program.expect("open")
    program.wait_until_asleep()
    program.send_signal(signal.SIGUSR1)
    program.expect("from the handler")
    program.expect("None")
    assert program.end() == (0, "")


def test_closing_ends_calls_of_other_threads(system: System) -> None:
    # Its requests reach nobody.
    source, sink = scl.open(SIX, "source", runtime_dir=system.folder, system="other"), system.open("sink")
    calls = [
        sink.readings.recv,
        sink.answer.recv,
        lambda: sink.wait(sink.jobs),
        lambda: source.question.call(source.question.type(), timeout=1000),
        lambda: _send_until_full(source),
    ]
    results: list[object] = []

    def record(call: object) -> None:
        try:
            results.append(call())  # type: ignore[operator]
        except scl.Closed:
            results.append("closed")

    threads = [threading.Thread(target=record, args=(call,)) for call in calls]
    threads.append(threading.Thread(target=lambda: results.append(list(sink.newest))))
    for thread in threads:
        thread.start()
    sink.close()
    with pytest.raises(scl.NotFlushed):
        source.close(0)
    for thread in threads:
        thread.join()
    assert results.count("closed") == 5 and results.count([]) == 1


def test_a_gate_is_used_by_one_thread_at_a_time(system: System) -> None:
    sink = system.open("sink")
    ended = threading.Event()

    def receive() -> None:
        for _ in sink.readings:
            pass
        ended.set()

    waiting = threading.Thread(target=receive)
    waiting.start()
    busy = ""
    while not busy:
        try:
            # It has nothing, so the other thread can begin to wait.
            sink.readings.try_recv()
            time.sleep(0)
        except scl.Busy as error:
            busy = str(error)
    assert busy.startswith("gate `sink.readings` is in use by another thread")
    # Other gates, and looking at this one, are free.
    assert sink.jobs.try_recv() is None
    assert sink.readings.stats()["received"] == 0
    assert not sink.readings.is_connected
    sink.close()
    assert ended.wait(60)
    waiting.join()


def test_threads_share_a_sending_gate_that_never_waits(system: System) -> None:
    sink, source = system.rust("sink"), system.open("source")
    source.ready(60)

    def send() -> None:
        for _ in range(200):
            source.jobs.send(source.jobs.type())

    threads = [threading.Thread(target=send) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sink.ask("pull 800").startswith("0..1")


def _send_until_full(source: scl.DynamicComponent) -> None:
    while True:
        source.lossless.send(source.lossless.type())


def _wait_until_open(system: System, program: Program) -> None:
    """Waits until the component is open and the main thread waits."""
    while not list(Path(system.folder).glob("six/*")):
        assert program.process.poll() is None, program.errors
    program.wait_until_asleep()


def _dedent(script: str) -> str:
    return textwrap.dedent(script).strip()


def _stop_iteration(errors: str) -> str:
    """`next` of a loop that a stop request has ended."""
    return errors if errors.endswith("StopIteration") else "not this"
