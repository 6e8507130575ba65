"""A stop request passes handlers of errors: whatever a program catches and wherever it waits, SIGTERM and SIGINT end it in order."""

import contextlib
import pickle
import signal

import pytest
import scl
from conftest import System

LOOP = """
while True:
    try:
        sink.readings.recv(0.01)
    except Exception as error:
        assert isinstance(error, scl.Timeout), error
"""

# Each has a component `sink`, and prints `open` when it may be stopped.
PROGRAMS = {
    "a loop that logs errors": f"print('open', flush=True){LOOP}",
    "suppressed errors": """
        import contextlib
        print("open", flush=True)
        while True:
            with contextlib.suppress(Exception):
                sink.readings.recv()
    """,
    "a generator": """
        def values():
            while True:
                try:
                    yield sink.readings.recv()
                except Exception:
                    yield None
        print("open", flush=True)
        for _ in values():
            pass
    """,
    "a thread": """
        import threading
        def work():
            while True:
                try:
                    sink.readings.recv()
                except Exception:
                    pass
        thread = threading.Thread(target=work)
        thread.start()
        print("open", flush=True)
        thread.join()
    """,
    "a pool": """
        from concurrent.futures import ThreadPoolExecutor
        def work(gate):
            while True:
                with __import__("contextlib").suppress(Exception):
                    gate.recv()
        print("open", flush=True)
        with ThreadPoolExecutor() as pool:
            list(pool.map(work, [sink.readings, sink.jobs]))
    """,
    "a handler of logging": """
        import logging
        class FromGate(logging.Handler):
            def emit(self, record):
                try:
                    sink.readings.recv()
                except Exception:
                    self.handleError(record)
        logging.getLogger("own").addHandler(FromGate())
        print("open", flush=True)
        while True:
            logging.getLogger("own").warning("once more")
    """,
    "a callback of a loop": """
        import asyncio
        loop = asyncio.new_event_loop()
        def look():
            sink.readings.try_recv()
            loop.call_later(0.001, look)
        loop.call_soon(look)
        print("open", flush=True)
        loop.run_forever()
    """,
    "a callback of uvloop": """
        import uvloop
        loop = uvloop.new_event_loop()
        def look():
            sink.readings.try_recv()
            loop.call_later(0.001, look)
        loop.call_soon(look)
        print("open", flush=True)
        loop.run_forever()
    """,
    "a callback of a loop in a thread": """
        import asyncio, threading
        def work():
            async def main():
                loop = asyncio.get_running_loop()
                def look():
                    sink.readings.try_recv()
                    loop.call_later(0.001, look)
                look()
                await asyncio.sleep(3600)
            with __import__("contextlib").suppress(Exception):
                asyncio.run(main())
        thread = threading.Thread(target=work)
        thread.start()
        print("open", flush=True)
        thread.join()
    """,
}

# Each has a coroutine function `wait`, which receives for ever and says when it is ended, and a component `sink`.
TASKS = {
    "main": "await wait('a', sink.readings)",
    "gather": "await asyncio.gather(wait('a', sink.readings), wait('b', sink.jobs), wait('c'))",
    "TaskGroup": """
        async with asyncio.TaskGroup() as group:
            for name, gate in [("a", sink.readings), ("b", sink.jobs), ("c", None)]:
                group.create_task(wait(name, gate))
    """,
    "nested groups": """
        async def inner():
            async with asyncio.TaskGroup() as group:
                group.create_task(wait("a", sink.readings))
                group.create_task(wait("b"))
        async with asyncio.TaskGroup() as group:
            group.create_task(inner())
            group.create_task(wait("c", sink.jobs))
    """,
    "a task that nobody awaits": """
        tasks = {asyncio.create_task(wait("a", sink.readings))}
        for task in tasks:
            task.add_done_callback(tasks.discard)
        await wait("b")
    """,
    "a task of a task that nobody awaits": """
        async def outer():
            await asyncio.create_task(wait("a", sink.readings))
        task = asyncio.create_task(outer())
        await wait("b")
    """,
    "a task beside main": """
        task = asyncio.create_task(wait("a", sink.readings))
        await wait("b", sink.jobs)
    """,
    "wait": """
        tasks = [asyncio.create_task(wait("a", sink.readings)), asyncio.create_task(wait("b"))]
        done, pending = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        for task in pending:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        tasks[0].result()
    """,
    "time limit": """
        async with asyncio.timeout(3600):
            await asyncio.wait_for(asyncio.shield(wait("a", sink.readings)), 3600)
    """,
    "a thread of the loop": "await asyncio.to_thread(sink.readings.recv)",
    "ready": "await source.ready_async()",
    "sending": """
        while True:
            await asyncio.sleep(0)
            try:
                source.readings.send(source.readings.type())
            except Exception:
                print("swallowed", flush=True)
    """,
    "until stopped": """
        async def inner():
            async with asyncio.TaskGroup() as group:
                group.create_task(wait("a", sink.readings))
                group.create_task(wait("b"))
        await scl.until_stopped(wait("c", sink.jobs), inner())
        print("after", flush=True)
    """,
}


@pytest.mark.parametrize("script", PROGRAMS.values(), ids=PROGRAMS.keys())
def test_no_handler_of_errors_keeps_a_program_running(system: System, script: str) -> None:
    program = system.python(f"sink = scl.open(SIX, 'sink')\n{_dedent(script)}")
    program.expect("open")
    program.send_signal(signal.SIGTERM)
    assert program.end() == (0, "")


@pytest.mark.parametrize("factory", ["asyncio.new_event_loop", "uvloop.new_event_loop"])
@pytest.mark.parametrize("script", TASKS.values(), ids=TASKS.keys())
def test_tasks_end_in_order(system: System, script: str, factory: str) -> None:
    loops = f"""
        import asyncio, uvloop
        began = []
        async def wait(name, gate=None):
            began.append(name)
            try:
                while gate:
                    try:
                        await gate.recv_async()
                    except Exception as error:
                        print("swallowed", error, flush=True)
                await asyncio.sleep(3600)
            except asyncio.CancelledError:
                # Also what takes some time is finished.
                await asyncio.sleep(0.2)
                raise
            finally:
                print("end of", name, flush=True)
        async def main():
            asyncio.get_running_loop().call_later(0.01, print, "open")
            async with scl.open(SIX, "sink") as sink:
                source = scl.open(SIX, "source", system="other")
                {_indented(script, 16)}
        import functools
        print = functools.partial(print, flush=True)
        with asyncio.Runner(loop_factory={factory}) as runner:
            runner.run(main())
    """
    # A program that sends may have filled a queue before it is stopped, which would be a warning.
    program = system.python(loops, SCL_STOP_WITHIN="20s", SCL_LOG="error")
    program.expect("open")
    program.send_signal(signal.SIGTERM)
    assert program.end() == (0, "")
    names = [name for name in "abc" if f'"{name}"' in script or f"'{name}'" in script]
    expected = [f"end of {name}" for name in names] + (["after"] if "after" in script else [])
    assert sorted(program.lines.queue) == sorted(expected)


# Each asks a gate or a component for something that a stop request ends.
CALLS = {
    "recv": "sink.readings.recv",
    "recv without waiting": "lambda: sink.readings.recv(0)",
    "try_recv": "sink.readings.try_recv",
    "latest": "sink.newest.latest",
    "request": "sink.answer.recv",
    "wait": "sink.wait",
    "ready": "sink.ready",
    "send": "lambda: source.readings.send(source.readings.type())",
    "call": "lambda: source.question.call(source.question.type(), timeout=1000)",
    "recv_async": "lambda: asyncio.run(sink.readings.recv_async())",
    "request in asyncio": "lambda: asyncio.run(sink.answer.recv_async())",
    "send_async": "lambda: asyncio.run(source.lossless.send_async(source.lossless.type()))",
    "call_async": "lambda: asyncio.run(source.question.call_async(source.question.type()))",
    "ready_async": "lambda: asyncio.run(sink.ready_async())",
}


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS.keys())
def test_a_stop_request_comes_before_the_end_of_the_component(system: System, call: str) -> None:
    """`Closed` is an `Exception`: a thread or task that handles those would go on, and nothing would end it."""
    program = system.python(f"""
        import asyncio, os, signal
        sink, source = scl.open(SIX, "sink"), scl.open(SIX, "source", system="other")
        call = {call}
        def attempt():
            try:
                call()
            except BaseException as error:
                print(isinstance(error, scl.Stopped), error, flush=True)
        os.kill(os.getpid(), signal.SIGTERM)
        attempt()
        sink.close(0)
        source.close(0)
        attempt()
        # What says how things are still does.
        try:
            sink.readings.stats()
        except scl.Closed as error:
            print(error, flush=True)
        # The program handles the request from here on.
        scl.stop_requested()
        attempt()
    """)
    assert program.end() == (0, "")
    stopped, closed = "True stop requested", "component `sink` is closed"
    closed_call = f"False component `{'source' if 'source' in call else 'sink'}` is closed"
    assert list(program.lines.queue) == [stopped, stopped, closed, closed_call]


@pytest.mark.parametrize("factory", ["asyncio.new_event_loop", "uvloop.new_event_loop"])
def test_the_task_that_is_stopped_first_closes_the_component(system: System, factory: str) -> None:
    """Whichever it is, the others are stopped, and not told of a closed component."""
    program = system.python(f"""
        import asyncio, os, signal, uvloop
        async def wait(gate):
            while True:
                try:
                    await gate.recv_async()
                except Exception as error:
                    print("swallowed", error, flush=True)
                finally:
                    sink.close(0)
        async def main():
            waiting = [asyncio.create_task(wait(gate)) for gate in sink.gates.values()]
            # They wait when this goes on.
            await asyncio.sleep(0)
            os.kill(os.getpid(), signal.SIGTERM)
            for ended in await asyncio.gather(*waiting, return_exceptions=True):
                print(type(ended).__name__, flush=True)
        with scl.open(SIX, "sink") as sink, asyncio.Runner(loop_factory={factory}) as runner:
            runner.run(main())
    """)
    assert program.end() == (0, "")
    assert list(program.lines.queue) == ["Stopped"] * 5


def test_the_thread_that_is_stopped_first_closes_the_component(system: System) -> None:
    program = system.python("""
        import asyncio, os, signal, threading
        def work(gate, in_loop):
            loop = asyncio.new_event_loop()
            while True:
                try:
                    loop.run_until_complete(gate.recv_async()) if in_loop else gate.recv()
                # One write for each line, because threads print at the same time.
                except Exception as error:
                    print(f"swallowed {error}\\n", end="", flush=True)
                except scl.Stopped:
                    print("Stopped\\n", end="", flush=True)
                    return
                finally:
                    sink.close(0)
        with scl.open(SIX, "sink") as sink:
            threads = [
                threading.Thread(target=work, args=(gate, number % 2))
                for number, gate in enumerate(sink.gates.values())
            ]
            for thread in threads:
                thread.start()
            os.kill(os.getpid(), signal.SIGTERM)
            for thread in threads:
                thread.join()
    """)
    assert program.end() == (0, "")
    assert list(program.lines.queue) == ["Stopped"] * 5


@pytest.mark.parametrize("factory", ["asyncio.new_event_loop", "uvloop.new_event_loop"])
@pytest.mark.parametrize("event", ["stop", "close"])
def test_no_line_of_a_call_misses_what_ends_it(system: System, event: str, factory: str) -> None:
    """A stop request, or `close` by another thread, at each line of the package that two tasks run until they wait.

    Each line has a child process of its own.
    """
    program = system.python(
        f"""
        import asyncio, os, signal, sys, threading, uvloop
        FOLDER = os.path.dirname(scl.__file__)

        def interrupt_at(count, interrupt):
            left = count
            def trace(frame, event, arg):
                nonlocal left
                if not frame.f_code.co_filename.startswith(FOLDER):
                    return None
                if event == "line":
                    left -= 1
                    if left == 0:
                        sys.settrace(None)
                        interrupt()
                return trace
            sys.settrace(trace)
            return lambda: left > 0

        # Returns true if the tasks waited before that line.
        def child(count):
            idle, ended = [], []
            sink = scl.open(SIX, "sink")
            def interrupt():
                if "{event}" == "stop":
                    os.kill(os.getpid(), signal.SIGTERM)
                else:
                    closing = threading.Thread(target=sink.close, args=(0,))
                    closing.start()
                    closing.join()
            async def wait(gate):
                try:
                    await gate.recv_async()
                except (scl.Closed, scl.Stopped) as error:
                    ended.append(type(error).__name__)
            async def main():
                has_lines_left = interrupt_at(count, interrupt)
                tasks = [asyncio.create_task(wait(gate)) for gate in [sink.readings, sink.jobs]]
                # Until both wait.
                await asyncio.sleep(0)
                await asyncio.sleep(0)
                sys.settrace(None)
                if has_lines_left():
                    idle.append(True)
                    interrupt()
                await asyncio.wait(tasks)
            with asyncio.Runner(loop_factory={factory}) as runner:
                runner.run(main())
            assert ended == ["{"Stopped" if event == "stop" else "Closed"}"] * 2, ended
            return bool(idle)

        for count in range(1, 1000):
            process = os.fork()
            if process == 0:
                code = 1
                try:
                    code = 3 if child(count) else 0
                finally:
                    os._exit(code)
            code = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
            print(code, flush=True)
            if code:
                break
        """
    )
    ended = 0
    while (code := program.next_line()) == "0":
        ended += 1
    # The lines of two calls, and the first child that waits before.
    assert (code, ended > 20, program.end()) == ("3", True, (0, "")), ended


@pytest.mark.parametrize("factory", ["asyncio.new_event_loop", "uvloop.new_event_loop"])
def test_the_end_of_the_grace_period_ends_tasks_that_wait(system: System, factory: str) -> None:
    # Connected, so that no attempt to connect wakes the task.
    system.rust("source")
    program = system.python(
        f"""
        import asyncio, os, signal, uvloop
        async def main():
            await sink.ready_async(60)
            scl.stop_requested()
            os.kill(os.getpid(), signal.SIGTERM)
            # The end of the program would hide that the call does not end.
            signal.signal(signal.SIGTERM, signal.SIG_IGN)
            try:
                await sink.readings.recv_async()
            except scl.Stopped as error:
                print(error, flush=True)
        with scl.open(SIX, "sink") as sink, asyncio.Runner(loop_factory={factory}) as runner:
            runner.run(main())
        """,
        SCL_STOP_WITHIN="10ms",
    )
    program.expect("stop requested")
    assert program.end()[0] == 0


def test_a_child_of_multiprocessing_is_stopped(system: System) -> None:
    program = system.python(f"""
        import multiprocessing
        def work():
            sink = scl.open(SIX, "sink")
            print("open", flush=True)
            {_indented(LOOP, 12)}
        child = multiprocessing.get_context("fork").Process(target=work)
        child.start()
        input()
        child.terminate()
        child.join()
        print(child.exitcode, flush=True)
    """)
    program.expect("open")
    program.tell("stop")
    program.expect("0")
    assert program.end() == (0, "")


def test_hooks_of_the_program_are_called_for_its_own_errors(system: System) -> None:
    program = system.python("""
        import sys, threading
        sys.excepthook = lambda kind, *_: print("hook", kind.__name__, flush=True)
        threading.excepthook = lambda args: print("hook of threads", args.exc_type.__name__, flush=True)
        scl.open(SIX, "sink")
        thread = threading.Thread(target=lambda: 1 / 0)
        thread.start()
        thread.join()
        raise BaseExceptionGroup("both", [scl.Stopped("stop"), ValueError("own")])
    """)
    program.expect("hook of threads ZeroDivisionError")
    program.expect("hook BaseExceptionGroup")
    assert program.end() == (1, "")


def test_a_stop_is_no_error() -> None:
    assert scl.Stopped.__mro__ == (scl.Stopped, BaseException, object)
    with pytest.raises(scl.Stopped), contextlib.suppress(Exception):
        raise scl._stopping.stopped("stop requested")
    # A process pool passes it on.
    assert type(pickle.loads(pickle.dumps(scl._stopping.StopExit("stop requested")))) is scl.Stopped


def _dedent(script: str) -> str:
    import textwrap

    return textwrap.dedent(script).strip()


def _indented(script: str, columns: int) -> str:
    return _dedent(script).replace("\n", "\n" + " " * columns)
