"""The process around a component: forks, the end of the interpreter, garbage collection, log records."""

import gc
import logging
import os

import pytest
import scl
from conftest import SIX, System


def test_a_forked_child_is_told_so(system: System) -> None:
    sink = system.rust("sink")
    program = system.python("""
        import os
        source = scl.open(SIX, "source")
        source.ready(60)
        child = os.fork()
        if child == 0:
            for call in [lambda: source.readings.send(source.readings.type()), source.readings.stats, source.ready]:
                try:
                    call()
                except scl.Forked as error:
                    print(error, flush=True)
            source.close()
            # It may open components of its own.
            watcher = scl.open(SIX, "watcher")
            watcher.ready(60)
            print("ready", flush=True)
        else:
            assert (code := os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])) == 0, code
            source.jobs.send(source.jobs.type(value=5))
            print("parent", flush=True)
    """)
    text = "the component was opened before a `fork` and belongs to the parent process; open it in one process only"
    for _ in range(3):
        program.expect(text)
    program.expect("ready")
    program.expect("parent")
    assert program.end() == (0, "")
    assert sink.ask("pull 1") == "5..6"


def test_a_forked_child_leaves_to_its_parent_what_it_inherits(system: System) -> None:
    program = system.python("""
        import asyncio, os, sys, threading
        from concurrent.futures import ThreadPoolExecutor
        sink, source = scl.open(SIX, "sink"), scl.open(SIX, "source")
        source.ready(60)
        # Calls of all kinds, whose threads and stacks a child does not have.
        waits = lambda: sink.wait(sink.newest)
        for call in [sink.readings.recv, sink.jobs.recv, lambda: asyncio.run(sink.lossless.recv_async()), waits]:
            threading.Thread(target=call, daemon=True).start()
        answer = ThreadPoolExecutor().submit(source.question.call, source.question.type(value=7), 1000)
        request = sink.answer.recv()
        for _ in range(20):
            child = os.fork()
            if child == 0:
                watcher = scl.open(SIX, "watcher")
                watcher.ready(60)
                sys.exit(0)
            assert (code := os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])) == 0, code
        request.reply(request.message)
        print(answer.result().value, flush=True)
    """)
    program.expect("7")
    assert program.end() == (0, "")


def test_multiprocessing_children_are_told_so(system: System) -> None:
    program = system.python("""
        import multiprocessing
        sink = scl.open(SIX, "sink")

        def work():
            try:
                sink.readings.try_recv()
            except scl.Forked:
                print("forked", flush=True)

        def wait_in_thread():
            for _ in sink.readings:
                pass

        import threading
        threading.Thread(target=wait_in_thread, daemon=True).start()
        # Also a child that was forked while another thread is in a call.
        for _ in range(20):
            child = multiprocessing.get_context("fork").Process(target=work)
            child.start()
            child.join()
            assert child.exitcode == 0
    """)
    for _ in range(20):
        program.expect("forked")
    assert program.end() == (0, "")


@pytest.mark.parametrize(
    "wait",
    [
        "sink.readings.recv()",
        "list(sink.jobs)",
        "sink.answer.recv()",
        "sink.wait()",
        "sink.ready()",
        # Calls that begin while the component is closed.
        "while True: sink.readings.try_recv()",
        "while True: sink.readings.is_connected",
    ],
)
def test_the_interpreter_ends_while_a_daemon_thread_waits(system: System, wait: str) -> None:
    program = system.python(f"""
        import threading
        sink = scl.open(SIX, "sink")
        def work():
            print("waiting", flush=True)
            {wait}
        threading.Thread(target=work, daemon=True).start()
        input()
    """)
    program.expect("waiting")
    program.tell("end")
    assert program.end() == (0, "")


def test_what_was_sent_arrives_although_nobody_closes(system: System) -> None:
    sink = system.rust("sink")
    for end in ["", "del source", "import os, signal; os.kill(os.getpid(), signal.SIGTERM)", "raise SystemExit"]:
        program = system.python(f"""
            source = scl.open(SIX, "source")
            source.ready(60)
            for value in range(500):
                source.jobs.send(source.jobs.type(value=value))
            {end}
        """)
        assert sink.ask("pull 500") == "0..500"
        assert program.end() == (0, "")


def test_a_component_that_is_collected_is_closed(system: System) -> None:
    sink = system.rust("sink")
    source = scl.open(SIX, "source", runtime_dir=system.folder)
    source.ready(60)
    jobs = source.jobs
    jobs.send(jobs.type(value=1))
    del source
    gc.collect()
    # A gate keeps its component open.
    jobs.send(jobs.type(value=2))
    assert sink.ask("pull 2") == "1..3"
    del jobs
    gc.collect()
    system.open("source")


def test_a_component_that_did_not_open_leaves_nothing(system: System) -> None:
    for _ in range(3):
        with pytest.raises(scl.UnknownComponent):
            system.open("sinc")
    with system.open("sink") as sink:
        assert not sink.readings.is_connected
    with system.open("sink"):
        pass


def test_leaving_the_block_says_what_peers_did_not_take(system: System) -> None:
    text = "1 message from `source.{0}` to `sink.{0}`, which is not running"
    with system.open("source") as source:
        source.readings.send(source.readings.type())
    # It is an error only where the topology promises that nothing is lost.
    with pytest.raises(scl.NotFlushed) as left, system.open("source") as source:
        source.jobs.send(source.jobs.type())
    assert text.format("jobs") in str(left.value)
    with pytest.raises(ZeroDivisionError), system.open("source") as source:
        source.jobs.send(source.jobs.type())
        1 / 0  # noqa: B018


def test_log_records_arrive_at_logging(system: System, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.DEBUG, logger="scl")
    source = system.open("source")
    with caplog.at_level(logging.DEBUG):
        for _ in range(2000):
            source.readings.send(source.readings.type())
        source.close()
        scl._logging._hand_over()
        _wait_for(caplog, "queue of `sink.readings` is full; dropping messages")
    record = next(record for record in caplog.records if "is full" in record.message)
    assert record.name == "scl.gate.connection" and record.levelno == logging.WARNING


def test_levels_follow_logging(system: System) -> None:
    for environment, expected in [({}, False), ({"SCL_LOG": "debug"}, True), ({"SCL_LOG": "off"}, False)]:
        program = system.python(
            """
            source = scl.open(SIX, "source")
            source.ready()
            """,
            **environment,
        )
        sink = system.rust("sink")
        code, errors = program.end()
        sink.kill()
        assert (code, "DEBUG" in errors) == (0, expected), errors


def test_a_handler_that_uses_gates_does_not_deadlock(system: System) -> None:
    program = system.python("""
        import logging

        class ToGate(logging.Handler):
            def emit(self, record):
                source.readings.send(source.readings.type(value=1))

        source = scl.open(SIX, "source")
        logging.getLogger("scl").addHandler(ToGate())
        for _ in range(5000):
            source.readings.send(source.readings.type())
            source.lossless.send(source.lossless.type(), 0) if _ < 10 else None
        print("sent", flush=True)
    """)
    program.expect("sent")
    assert program.end()[0] == 0


def test_a_handler_that_fails_is_told_and_the_next_record_goes_on(system: System) -> None:
    program = system.python("""
        import logging

        class Fails(logging.Handler):
            def emit(self, record):
                raise ValueError(f"failed on {record.levelname}")

        logging.getLogger("scl").addHandler(Fails())
        for _ in range(2):
            with scl.open(SIX, "source") as source:
                source.readings.send(source.readings.type())
    """)
    code, errors = program.end()
    assert code == 0 and errors.count("ValueError: failed on WARNING") == 2, errors


def _wait_for(caplog: pytest.LogCaptureFixture, text: str) -> None:
    while text not in caplog.text:
        scl._logging._hand_over()


def test_real_time_settings_are_applied_with_the_first_component(system: System) -> None:
    core = min(os.sched_getaffinity(0))
    script = """
        import os
        scl.open(SIX, "sink")
        print(os.sched_getaffinity(0), flush=True)
    """
    pinned = system.python(script, SCL_CPU=str(core))
    pinned.expect(f"{{{core}}}")
    assert pinned.end() == (0, "")
    code, errors = system.python(script, SCL_SCHED="fast").end()
    assert code == 1
    assert "OpenError" in errors
    assert "`SCL_SCHED=fast`" in errors
