"""Programs end, whatever their threads and handlers do: the end of the interpreter waits for no call of a gate.

`SCL_TEST_ENDS` is the number of times that each program runs.
"""

import os
import signal
import textwrap

import pytest
from conftest import System

ROUNDS = int(os.environ.get("SCL_TEST_ENDS", "2"))

HANDLER = """
    import logging

    class ToGate(logging.Handler):
        def emit(self, record):
            {send}

    source = scl.open(SIX, "source")
    logging.getLogger("scl").addHandler(ToGate())
    for value in range(3000):
        source.readings.send(source.readings.type())
        source.lossless.send(source.lossless.type(), 0) if value < 10 else None
"""
DAEMON = """
    import threading
    sink, source = scl.open(SIX, "sink"), scl.open(SIX, "source")
    def work(call):
        {work}
    calls = [
        sink.readings.recv, sink.answer.recv, lambda: sink.wait(sink.jobs), lambda: list(sink.lossless),
        lambda: source.question.call(source.question.type(), timeout=1000), lambda: sink.newest.recv(1000), source.ready,
    ]
    for call in calls:
        threading.Thread(target=work, args=(call,), daemon=True).start()
"""
PROGRAMS = {
    "a log handler sends": HANDLER.format(send="source.readings.send(source.readings.type(value=1))"),
    "a log handler waits": HANDLER.format(send="source.lossless.send(source.lossless.type(value=1))"),
    "a daemon thread waits in a handler": """
        import logging, threading
        source = scl.open(SIX, "source")
        inside = threading.Event()
        class ToGate(logging.Handler):
            def emit(self, record):
                inside.set()
                while True:
                    source.lossless.send(source.lossless.type())
        logging.getLogger("own").addHandler(ToGate())
        threading.Thread(target=logging.getLogger("own").warning, args=("full",), daemon=True).start()
        inside.wait()
    """,
    "daemon threads wait": DAEMON.format(work="call()"),
    "daemon threads call without end": DAEMON.format(work="while True: call()"),
    "daemon threads catch everything": DAEMON.format(
        work="""
        while True:
            try: call()
            except BaseException: pass"""
    ),
    "a daemon thread has an event loop": """
        import asyncio, threading
        sink = scl.open(SIX, "sink")
        began = threading.Event()
        async def main():
            asyncio.create_task(sink.jobs.recv_async())
            asyncio.get_running_loop().call_soon(began.set)
            async for message in sink.readings:
                pass
        threading.Thread(target=lambda: asyncio.run(main()), daemon=True).start()
        began.wait()
    """,
    "a pool is left open": """
        from concurrent.futures import ThreadPoolExecutor
        sink, source = scl.open(SIX, "sink"), scl.open(SIX, "source")
        pool = ThreadPoolExecutor(4)
        pool.submit(sink.jobs.recv, 0.02)
        pool.submit(lambda: [source.readings.send(source.readings.type()) for _ in range(1000)])
        pool.submit(sink.readings.recv)
        pool.submit(sink.close)
    """,
    "functions of atexit use gates": """
        import atexit, threading
        sink, source = scl.open(SIX, "sink"), scl.open(SIX, "source")
        atexit.register(lambda: source.readings.send(source.readings.type()))
        atexit.register(sink.jobs.try_recv)
        atexit.register(sink.readings.stats)
        threading.Thread(target=sink.readings.recv, daemon=True).start()
    """,
    "logging is shut down with what a call holds": """
        import logging, threading
        sink = scl.open(SIX, "sink")
        lock, waiting = threading.Lock(), threading.Event()
        class Flushes(logging.Handler):
            def flush(self):
                with lock:
                    pass
        handler = Flushes()
        def work():
            with lock:
                waiting.set()
                sink.readings.recv()
        threading.Thread(target=work, daemon=True).start()
        waiting.wait()
    """,
    "a thread exits": """
        import sys, threading
        sink = scl.open(SIX, "sink")
        def work():
            sink.readings.try_recv()
            sys.exit(5)
        thread = threading.Thread(target=work)
        thread.start()
        threading.Thread(target=sink.jobs.recv, daemon=True).start()
        thread.join()
    """,
    "a forked child ends": """
        import os, sys, threading
        sink = scl.open(SIX, "sink")
        threads = [threading.Thread(target=call, daemon=True) for call in [sink.readings.recv, sink.jobs.recv]]
        for thread in threads:
            thread.start()
        child = os.fork()
        if child:
            assert os.waitpid(child, 0)[1] == 0
        else:
            source = scl.open(SIX, "source")
            threading.Thread(target=source.ready, daemon=True).start()
            sys.exit(0)
    """,
}


@pytest.mark.parametrize("program", PROGRAMS.values(), ids=PROGRAMS.keys())
def test_a_program_ends(system: System, program: str) -> None:
    for _ in range(ROUNDS):
        code, errors = system.python(program).end()
        assert code == 0 and "Traceback" not in errors, errors


@pytest.mark.parametrize("program", ["daemon threads wait", "daemon threads call without end"])
def test_a_program_that_fails_or_exits_at_once_ends(system: System, program: str) -> None:
    for end, expected in [("1 / 0", 1), ("import os; os._exit(3)", 3), ("raise SystemExit(4)", 4)]:
        for _ in range(ROUNDS):
            code, errors = system.python(f"{textwrap.dedent(PROGRAMS[program])}\n{end}").end()
            assert code == expected and errors.count("Traceback") == (expected == 1), errors


@pytest.mark.parametrize("program", ["daemon threads wait", "daemon threads call without end", "a log handler sends"])
def test_sigterm_at_the_end_of_a_program_ends_it(system: System, program: str) -> None:
    for _ in range(ROUNDS):
        started = system.python(f"{textwrap.dedent(PROGRAMS[program])}\nprint('at its end', flush=True)")
        started.expect("at its end")
        started.send_signal(signal.SIGTERM)
        code, errors = started.end()
        # Python has given the signal its default action back when the request comes last.
        assert code in (0, -signal.SIGTERM) and "Traceback" not in errors, errors


def test_a_stop_request_ends_a_program_of_many_threads(system: System) -> None:
    sending = "while True: source.readings.send(source.readings.type())"
    for _ in range(ROUNDS):
        program = system.python(
            f"{textwrap.dedent(PROGRAMS['daemon threads wait'])}\nprint('open', flush=True)\n{sending}"
        )
        program.expect("open")
        program.send_signal(signal.SIGTERM)
        code, errors = program.end()
        assert code == 0 and "Traceback" not in errors, errors
