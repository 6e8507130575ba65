"""Messages of all kinds of gate, between Python and Rust, and within Python."""

import contextlib
import select
import threading

from conftest import System


def test_python_sends_to_rust(each_system: System) -> None:
    sink = each_system.rust("sink")
    watcher = each_system.rust("watcher")
    source = each_system.open("source")
    source.ready(60)
    message = source.readings.type
    for value in range(3):
        source.readings.send(message(value=value, padding=b"x"))
        source.lossless.send(message(value=value))
        source.jobs.send(message(value=value))
    assert sink.ask("receive 3") == "0..3"
    assert sink.ask("receive_lossless 3") == "0..3"
    assert sink.ask("pull 3") == "0..3"
    assert watcher.ask("receive 3") == "0..3"
    sink.tell("serve 1")
    assert source.question.call(message(value=21)).value == 42
    sink.expect("served")


def test_rust_sends_to_python(each_system: System) -> None:
    source = each_system.rust("source")
    sink = each_system.open("sink")
    sink.ready(60)
    assert sink.readings.sender is None
    for command, gate in [("publish 0 3", sink.readings), ("lossless 0 3", sink.lossless), ("push 0 3", sink.jobs)]:
        assert source.ask(command) in ("published", "pushed")
        assert [gate.recv(60).value for _ in range(3)] == [0, 1, 2]
    assert sink.newest.recv(60).value == 2
    assert (sink.readings.sender, sink.newest.sender) == ("source.readings", "source.readings")
    source.tell("call 21")
    request = sink.answer.recv(60)
    assert request.message.value == 21
    request.reply(sink.answer.reply_type(value=42))
    source.expect("42")


def test_python_talks_to_python(each_system: System) -> None:
    source, sink = each_system.open("source"), each_system.open("sink")
    each_system.open("watcher")
    source.ready(60)
    sink.ready(60)
    message = source.readings.type
    assert message is sink.readings.type

    def serve() -> None:
        for request in sink.answer:
            request.reply(message(value=request.message.value * 2))

    server = threading.Thread(target=serve)
    server.start()
    assert [source.question.call(message(value=value)).value for value in range(100)] == [*range(0, 200, 2)]
    source.readings.send(message(value=7))
    assert sink.readings.recv(60).value == 7
    assert sink.readings.try_recv() is None
    sink.close()
    server.join()


def test_a_peer_that_restarts_is_found_again(each_system: System) -> None:
    source = each_system.open("source")
    message = source.readings.type
    for round in range(3):
        sink = each_system.rust("sink")
        sink.tell("serve 1")
        while True:
            with contextlib.suppress(ConnectionError):
                assert source.question.call(message(value=round), timeout=300).value == round * 2
                break
        sink.kill()


def test_several_gates_are_waited_for(system: System) -> None:
    source = system.rust("source")
    sink = system.open("sink")
    sink.ready(60)
    assert sink.wait(timeout=0) == []
    assert sink.wait(sink.readings, sink.jobs, timeout=0.01) == []
    source.ask("push 0 1")
    assert sink.wait(sink.readings, sink.jobs, timeout=300) == [sink.jobs]
    # It takes nothing.
    assert sink.wait(timeout=300) == [sink.jobs]
    assert sink.jobs.try_recv().value == 0
    source.tell("call 1")
    assert sink.wait(timeout=300) == [sink.answer]
    sink.answer.recv(0).reply(sink.answer.reply_type())


def test_the_descriptor_is_readable_while_a_gate_has_something(system: System) -> None:
    source = system.rust("source")
    sink = system.open("sink")
    sink.ready(60)
    poll = select.poll()
    poll.register(sink, select.POLLIN)
    assert poll.poll(0) == []
    source.ask("push 0 2")
    for value in range(2):
        assert poll.poll() != []
        assert sink.jobs.recv(60).value == value
    assert poll.poll(0) == []


def test_counts_are_kept(system: System) -> None:
    sink = system.rust("sink")
    source = system.open("source")
    source.ready(60)
    source.jobs.send(source.jobs.type(value=1))
    assert sink.ask("pull 1") == "1..2"
    stats = source.jobs.stats()
    assert (stats["sent"], stats["peers"], stats["bytes"]) == (1, 1, 2)
    assert stats["connections"][0]["peer"] == "sink.jobs"
    assert source.jobs.is_connected
