"""Stop requests that a program handles itself, and processes in which signals stay Python's."""

import signal
import textwrap
import time

import pytest
from conftest import System

# Each has a component `source`, prints `open` when it may be stopped, and sends a last message after the stop request.
LAST_WORDS = {
    "a loop that asks": """
        while not scl.stop_requested():
            print("open", flush=True)
            time.sleep(0.01)
        source.jobs.send(off)
    """,
    "a loop in asyncio that asks": """
        async def main():
            while not scl.stop_requested():
                print("open", flush=True)
                await asyncio.sleep(0.01)
            await source.jobs.send_async(off)
        asyncio.run(main())
    """,
    "loops": """
        async def send():
            while True:
                source.readings.send(source.readings.type())
                await asyncio.sleep(0.01)
        async def main():
            asyncio.get_running_loop().call_soon(functools.partial(print, "open", flush=True))
            await scl.until_stopped(send(), asyncio.sleep(3600))
            source.jobs.send(off)
        asyncio.run(main())
    """,
    "nothing but the request": """
        async def main():
            # Opened in the loop, which has a handler of SIGINT of its own.
            other = scl.open(SIX, "sink", system="other")
            asyncio.get_running_loop().call_soon(functools.partial(print, "open", flush=True))
            await scl.until_stopped()
            await source.jobs.send_async(off)
        asyncio.run(main())
    """,
    "a loop of uvloop": """
        import uvloop
        async def main():
            asyncio.get_running_loop().call_soon(functools.partial(print, "open", flush=True))
            await scl.until_stopped(asyncio.sleep(3600))
            source.jobs.send(off)
        uvloop.run(main())
    """,
    "a loop in a thread": """
        async def main():
            asyncio.get_running_loop().call_soon(functools.partial(print, "open", flush=True))
            await scl.until_stopped()
            source.jobs.send(off)
        thread = threading.Thread(target=asyncio.run, args=(main(),))
        thread.start()
        # Python misses a signal that arrives just before a wait without a limit begins.
        while thread.is_alive():
            thread.join(0.01)
    """,
}
# What follows within half a second belongs to the first.
REQUESTS = [[signal.SIGTERM], [signal.SIGINT], [signal.SIGTERM, signal.SIGINT, signal.SIGTERM]]


@pytest.mark.parametrize("request_signals", REQUESTS, ids=["SIGTERM", "SIGINT", "several"])
@pytest.mark.parametrize("script", LAST_WORDS.values(), ids=LAST_WORDS.keys())
def test_a_program_that_handles_the_request_can_still_send(
    system: System, script: str, request_signals: list[signal.Signals]
) -> None:
    sink = system.rust("sink")
    program = system.python(f"""
        import asyncio, functools, threading, time
        with scl.open(SIX, "source") as source:
            off = source.jobs.type(value=4242)
            source.ready(60)
            {textwrap.indent(textwrap.dedent(script), " " * 12)}
    """)
    program.expect("open")
    sink.tell("pull 1")
    for number in request_signals:
        program.send_signal(number)
    assert program.end() == (0, "")
    assert sink.next_line() == "4242..4243"


@pytest.mark.parametrize(
    ("place", "wait"),
    [
        ("a program", "scl.until_stopped()"),
        ("a program", "sink.readings.recv_async()"),
        ("a loop with handlers of its own", "sink.readings.recv_async()"),
        ("a forked child", "scl.until_stopped()"),
    ],
)
def test_a_signal_just_before_a_wait_wakes_the_event_loop(system: System, place: str, wait: str) -> None:
    program = system.python(f"""
        import asyncio, os, selectors, signal, sys

        class Selector(selectors.DefaultSelector):
            is_first = True
            def select(self, timeout=None):
                if timeout is not None or not self.is_first:
                    return super().select(timeout)
                self.is_first = False
                # All that Python does when a signal arrives, if no more of its steps follow.
                wakeup = signal.set_wakeup_fd(-1)
                signal.set_wakeup_fd(wakeup)
                os.write(wakeup, bytes(1))
                events = super().select(timeout)
                print("woken", flush=True)
                os.kill(os.getpid(), signal.SIGTERM)
                return events

        async def main():
            with scl.open(SIX, "sink") as sink:
                if {place == "a loop with handlers of its own"}:
                    asyncio.get_running_loop().add_signal_handler(signal.SIGUSR1, print)
                await {wait}

        def run():
            with asyncio.Runner(loop_factory=lambda: asyncio.SelectorEventLoop(Selector())) as runner:
                runner.run(main())

        async def look():
            await asyncio.wait([asyncio.ensure_future(scl.until_stopped())], timeout=0)

        if {place == "a forked child"}:
            asyncio.run(look())
            if child := os.fork():
                sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
            # Only a child that hangs reaches it; the test would wait for its output.
            signal.alarm(60)
        run()
    """)
    program.expect("woken")
    assert program.end() == (0, "")


@pytest.mark.parametrize("number", REQUESTS[0] + REQUESTS[1])
def test_a_second_signal_ends_a_program_between_no_steps_of_python(system: System, number: signal.Signals) -> None:
    program = system.python("""
        import time
        source = scl.open(SIX, "source")
        while not scl.stop_requested():
            print("open", flush=True)
            time.sleep(0.01)
        print("requested", flush=True)
        sum(range(10**12))
    """)
    program.expect("open")
    program.send_signal(signal.SIGTERM)
    while program.next_line() != "requested":
        pass
    # Those that follow at once belong to the first.
    while program.process.poll() is None:
        program.send_signal(number)
        time.sleep(0.01)
    assert program.end() == (-number, "")


def test_a_child_without_components_has_the_handlers_of_python(system: System) -> None:
    program = system.python("""
        import os, signal, time
        source = scl.open(SIX, "source")
        for number in [signal.SIGTERM, signal.SIGINT]:
            child = os.fork()
            if child == 0:
                try:
                    os.kill(os.getpid(), number)
                    time.sleep(3600)
                except KeyboardInterrupt:
                    os._exit(3)
            print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
    """)
    program.expect(str(-signal.SIGTERM))
    program.expect("3")
    assert program.end() == (0, "")


def test_ctrl_c_at_a_prompt_ends_a_statement(system: System) -> None:
    program = system.python("""
        import os, signal, sys
        sys.ps1 = ">>> "
        sink = scl.open(SIX, "sink")
        try:
            os.kill(os.getpid(), signal.SIGINT)
            sink.readings.recv()
        except KeyboardInterrupt:
            print(sink.readings.try_recv(), flush=True)
    """)
    program.expect("None")
    assert program.end() == (0, "")
