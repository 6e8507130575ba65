"""Wrong programs and wrong input: what, where, and what to do."""

import array
import asyncio
import json
import pickle
import pydoc
import re
import threading
import warnings
from pathlib import Path
from typing import Any

import numpy
import pytest
import scl
from conftest import SIX, TOPOLOGIES, System


def refused(error: type[BaseException], call: Any, *arguments: Any) -> str:
    with pytest.raises(error) as raised:
        call(*arguments)
    return str(raised.value)


def test_a_misspelt_gate_is_named_with_a_suggestion(system: System) -> None:
    source = system.open("source")
    text = refused(scl.UnknownGate, lambda: source.reading)
    assert text == "component `source` has no gate `reading`; did you mean `readings`?"
    assert issubclass(scl.UnknownGate, AttributeError)
    assert not hasattr(source, "nothing_like_it")


def test_the_wrong_direction_says_what_the_gate_can_do(system: System) -> None:
    source, sink = system.open("source"), system.open("sink")
    place = f"(declared at {SIX}:"
    for gate, call, words in [
        (sink.readings, "send", "is a `sub` gate and has no `send`; it has `recv`, `try_recv`, `latest` and iteration"),
        (source.readings, "recv", "is a `pub` gate and has no `recv`; it has `send`"),
        (source.question, "send", "is a `req` gate and has no `send`; it has `call`"),
        (sink.answer, "call", "is a `rep` gate and has no `call`; it has `recv`, `try_recv` and iteration"),
        (source.jobs, "latest", "is a `push` gate and has no `latest`; it has `send`"),
        (sink.jobs, "send_async", "is a `pull` gate and has no `send_async`; it has `recv`"),
    ]:
        text = refused(scl.WrongDirection, getattr, gate, call)
        assert words in text and place in text


def test_a_message_of_another_class_is_a_type_error(system: System) -> None:
    source = system.open("source")
    shapes = system.open("sensor", TOPOLOGIES / "shapes" / "original.yaml")
    position = shapes.position.type(lat=1.0)
    for wrong, words in [
        ("text", "gate `source.readings` carries `test.Number`, not `str`"),
        (b"bytes", "gate `source.readings` carries `test.Number`, not `bytes`"),
        (position, "gate `source.readings` carries `test.Number`, not `nav.Position`"),
        (None, "gate `source.readings` carries `test.Number`, not `NoneType`"),
        (source.readings.type, "gate `source.readings` carries `test.Number`, not the class `test.Number` itself"),
    ]:
        assert refused(TypeError, source.readings.send, wrong) == words
    assert source.readings.stats()["connections"][0]["published"] == 0


def test_bytes_gates_take_every_buffer(system: System) -> None:
    giver = system.open("giver", TOPOLOGIES / "limits.yaml")
    taker = system.open("taker", TOPOLOGIES / "limits.yaml")
    giver.ready(60)
    for message in [b"one", bytearray(b"two"), memoryview(b"three"), array.array("I", [4]), numpy.arange(5)[::2]]:
        giver.jobs.send(message)
        assert taker.jobs.recv(60) == memoryview(message).tobytes()
    assert "carries bytes, not `str`" in refused(TypeError, giver.jobs.send, "text")


@pytest.mark.parametrize("codec", ["json", "cbor", "msgpack"])
def test_none_is_a_message(system: System, tmp_path: Path, codec: str) -> None:
    file = tmp_path / "values.yaml"
    file.write_text(
        "system: values\ncomponents:\n"
        f"  - {{name: giver, gates: [values: {{push: a.Message, codec: {codec}}}]}}\n"
        f"  - {{name: taker, gates: [values: {{pull: a.Message, codec: {codec}}}]}}\n"
        "connections: [[giver.values, taker.values]]\n"
    )
    giver, taker = system.open("giver", file), system.open("taker", file)
    giver.ready(60)
    nothing = object()
    assert taker.values.try_recv(nothing) is taker.values.latest(nothing) is nothing
    assert taker.values.try_recv() is taker.values.latest() is None
    for take in [lambda: taker.values.recv(60), lambda: next(iter(taker.values))]:
        giver.values.send(None)
        assert take() is None
    for call in [taker.values.try_recv, taker.values.latest]:
        giver.values.send(None)
        taker.wait(taker.values)
        text = f"gate `taker.values` received the message `None`, which `{call.__name__}()` also returns when there is "
        assert refused(scl.NoneReceived, call).startswith(text)
        giver.values.send(None)
        taker.wait(taker.values)
        assert call(nothing) is None

    async def asynchronous() -> None:
        giver.values.send(None)
        assert await taker.values.recv_async(60) is None
        giver.values.send(None)
        async for message in taker.values:
            assert message is None
            break

    asyncio.run(asynchronous())


def test_a_message_that_is_too_long_is_sent_to_nobody(system: System) -> None:
    giver = system.open("giver", TOPOLOGIES / "limits.yaml")
    for call, limit in [(giver.values.send, 2048), (giver.jobs.send, 3072), (giver.question.call, 4096)]:
        text = refused(scl.TooLong, call, bytes(limit + 1))
        assert f"of {limit + 1} bytes" in text and f"accepts at most {limit}; raise its `max_size`" in text
    assert issubclass(scl.TooLong, ValueError)


def test_a_topology_with_errors_is_refused_with_the_words_of_the_checker(tmp_path: Path) -> None:
    file = tmp_path / "topology.yaml"
    file.write_text("components:\n  - name: a\n    gates:\n      - x: {pup: nav.Position}\n      - y: {sup: }\n")
    text = refused(scl.TopologyError, scl.open, file, "a")
    assert "SCL" in text and "pup" in text and "sup" in text and f"{file}:4" in text
    missing = refused(scl.TopologyError, scl.open, tmp_path / "missing.yaml", "a")
    assert "missing.yaml" in missing


def test_warnings_of_the_checker_are_python_warnings(system: System, tmp_path: Path) -> None:
    file = tmp_path / "warned.yaml"
    file.write_text("components:\n  - name: a\n    gates:\n      - x: pub\n")
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        scl.open(file, "a", runtime_dir=system.folder).close()
    assert ["[SCL0206]" in str(warned[0].message), "[SCL0701]" in str(warned[1].message)] == [True, True]
    assert Path(warned[0].filename).name == "test_errors.py"


def test_an_unknown_component_is_suggested() -> None:
    text = refused(scl.UnknownComponent, scl.open, SIX, "sinc")
    assert text == "system `six` has no component `sinc`; did you mean `sink`?"


def test_a_damaged_plan_is_refused(system: System) -> None:
    plan = scl._native.Plan.of_file(str(SIX))[0].to_json()
    opened = scl.open_plan(plan, "sink", runtime_dir=system.folder)
    opened.close()
    for wrong, words in [
        (plan.replace('"version": 1', '"version": 9'), "version 9"),
        (plan.replace('"kind": "pub"', '"kind": "pup"', 1), "components[0].gates[0].kind"),
        ("nonsense", "JSON"),
        (json.dumps({"version": 1}), "system"),
    ]:
        assert words in refused(scl.PlanError, scl.open_plan, wrong, "sink")


def test_a_component_runs_once(system: System) -> None:
    first = system.rust("sink")
    text = refused(scl.OpenError, system.open, "sink")
    assert "component `sink` is already running" in text and str(first.process.pid) in text
    first.kill()
    system.open("sink").close()
    system.open("sink")
    assert "already running in this process" in refused(scl.OpenError, system.open, "sink")


def test_another_contract_is_refused_with_both_names(system: System, tmp_path: Path) -> None:
    other = tmp_path / "six.yaml"
    other.write_text(re.sub(r"test\.Number([,}])", r"test.Number, codec: json\1", SIX.read_text()))
    (tmp_path / "test.proto").write_text((TOPOLOGIES / "test.proto").read_text())
    system.rust("source")
    sink = system.open("sink", other)
    text = refused(scl.NotReady, sink.ready, 0.3)
    assert "`source.readings`" in text and "`json`" in text and "`protobuf`" in text


def test_other_messages_are_refused_with_the_difference(system: System) -> None:
    system.open("sensor", TOPOLOGIES / "shapes" / "original.yaml")
    viewer = system.open("viewer", TOPOLOGIES / "shapes" / "swapped.yaml")
    text = refused(scl.NotReady, viewer.ready, 0.3)
    assert "nav.Position" in text and "`lat`" in text and "`lon`" in text


def test_a_time_limit_raises_python_s_own_error(system: System) -> None:
    source, sink = system.open("source"), system.open("sink")
    text = refused(TimeoutError, sink.readings.recv, 0.05)
    assert text.startswith("gate `sink.readings` received nothing from `source.readings` within 50ms")
    assert refused(scl.Timeout, sink.readings.recv, 0).startswith("gate `sink.readings` has received nothing from")
    assert "received nothing from" in refused(scl.Timeout, sink.answer.recv, 0.05)
    source.ready(60)
    assert "got no reply from `sink.answer`" in refused(scl.Timeout, source.question.call, source.question.type(), 0.05)
    for seconds in [-1, float("nan")]:
        assert "expected seconds" in refused(ValueError, sink.readings.recv, seconds)
    # What is too long for the operating system has no limit.
    source.readings.send(source.readings.type(value=1))
    assert sink.readings.recv(float("inf")).value == 1
    assert source.question.timeout == 10


def test_components_that_do_not_run_are_named(system: System) -> None:
    source = system.open("source")
    text = refused(scl.NotReady, source.ready, 0.05)
    assert text.startswith("component `source` is not ready after 50ms: `sink.readings` is not running")
    # The whole time, not that of the last step.
    waited = refused(scl.NotReady, lambda: asyncio.run(source.ready_async(0.5)))
    assert re.search(r" is not ready after ([5-9]\d\dms|[\d.]+s): ", waited), waited
    assert " is not ready after " in refused(scl.NotReady, source.ready, 0)


def test_a_full_queue_is_named(system: System) -> None:
    source = system.open("source")
    message = source.lossless.type()
    with pytest.raises(scl.Full) as full:
        while True:
            source.lossless.send(message, 0)
    assert "the queue of `sink.lossless` is full" in str(full.value)
    assert "`sink.lossless` is full" in refused(scl.Full, source.lossless.send, message, 0.05)
    # The others wait for nobody.
    for _ in range(10_000):
        source.readings.send(message)


def test_a_frame_that_is_no_message_is_skipped(system: System, tmp_path: Path) -> None:
    plan = json.loads(scl._native.Plan.of_file(str(SIX))[0].to_json())
    for component in plan["components"]:
        for gate in component["gates"]:
            if gate["name"] in ("jobs", "question"):
                gate["payload"] = None
    raw = scl.open_plan(json.dumps(plan), "source", runtime_dir=system.folder)
    with raw:
        sink = system.open("sink")
        raw.jobs.send(b"\xff\xff")
        raw.jobs.send(sink.jobs.type(value=5).SerializeToString())
        assert sink.jobs.recv(60).value == 5
        assert (sink.jobs.stats()["rejected"], sink.jobs.stats()["undecodable"]) == (1, 1)


def test_a_request_is_answered_once(system: System) -> None:
    source, sink = system.open("source"), system.open("sink")
    answers: list[int] = []
    asking = threading.Thread(target=lambda: answers.append(source.question.call(source.question.type()).value))
    asking.start()
    request = sink.answer.recv(60)
    assert "carries `test.Number`, not `int`" in refused(TypeError, request.reply, 7)
    request.reply(sink.answer.reply_type(value=7))
    assert refused(scl.Answered, request.reply, sink.answer.reply_type()) == "this request was already answered"
    asking.join()
    assert answers == [7]


def test_a_closed_component_says_so(system: System) -> None:
    sink, source = system.open("sink"), system.open("source")
    sink.close()
    sink.close()
    source.close()
    for call in [
        sink.readings.recv,
        sink.readings.try_recv,
        sink.readings.latest,
        sink.readings.stats,
        sink.answer.recv,
        sink.ready,
        lambda: sink.readings.is_connected,
        lambda: source.readings.send(source.readings.type()),
        lambda: source.question.call(source.question.type()),
        lambda: sink.fileno(),
        lambda: sink.wait(),
    ]:
        assert refused(scl.Closed, call) in ("component `sink` is closed", "component `source` is closed")
    assert list(sink.readings) == []
    assert repr(sink) == "<component sink of six>"


def test_gates_and_components_cannot_be_pickled_or_replaced(system: System) -> None:
    sink = system.open("sink")
    assert "cannot be pickled" in refused(TypeError, pickle.dumps, sink)
    assert "cannot be pickled" in refused(TypeError, pickle.dumps, sink.readings)
    assert "cannot be replaced" in refused(AttributeError, setattr, sink, "readings", 1)
    assert "cannot be replaced" in refused(AttributeError, setattr, sink.readings, "recv", 1)
    assert "cannot be deleted" in refused(AttributeError, delattr, sink, "readings")


def test_misspelt_attributes_are_suggested(system: System) -> None:
    source, sink = system.open("source"), system.open("sink")
    for owner, name, words in [
        (source, "reading", "component `source` has no attribute `reading`; did you mean `readings`?"),
        (source, "anything_else", "component `source` has no attribute `anything_else`"),
        (source.question, "timout", "gate `source.question` has no attribute `timout`; did you mean `timeout`?"),
        (sink.readings, "anything_else", "gate `sink.readings` has no attribute `anything_else`"),
    ]:
        assert refused(AttributeError, setattr, owner, name, 1) == words
    assert refused(AttributeError, getattr, sink.readings, "tryrecv").endswith("; did you mean `try_recv`?")
    assert refused(scl.UnknownGate, getattr, source, "redy") == (
        "component `source` has no gate `redy`; did you mean `ready`?"
    )

    class Own(scl.Component):
        """A class of the program, which has attributes of its own."""

    plan = scl._native.Plan.of_file(str(SIX))[0].to_json()
    own = Own(plan, "watcher", runtime_dir=system.folder)
    own.anything_else = 1
    own.close()


def test_programs_see_gates_messages_and_names(system: System) -> None:
    source = system.open("source")
    assert {"readings", "question", "ready", "close"} <= set(dir(source))
    assert {"send", "send_async", "type", "stats"} <= set(dir(source.readings))
    text = pydoc.plain(pydoc.render_doc(source))
    assert "readings: `pub` of `test.Number`, connected to `sink.readings`, `sink.newest`" in text
    assert "question: `req` of `test.Number` -> `test.Number`, connected to `sink.answer`" in text
    text = pydoc.plain(pydoc.render_doc(source.readings))
    assert "Pub in module scl" in text and "send(self, message" in text
    assert repr(source.readings) == "<pub gate source.readings of test.Number>"
    assert repr(source) == "<component source of six>"
    assert repr(scl.NotReady("text")) == "NotReady('text')"
    for name in set(scl.__all__) - {"__version__", "codec", "Transport", "Buffer"}:
        assert getattr(scl, name).__module__ == "scl", name


def test_codecs_of_other_languages_are_refused_before_anything_is_opened(system: System, tmp_path: Path) -> None:
    for codec, words in [
        ("postcard", "`postcard` is for Rust programs"),
        ("raw", "memory layout"),
        ("a::B", "Rust code"),
    ]:
        file = tmp_path / "codecs.yaml"
        gates = f"[x: {{pub: a.Message, codec: {codec}}}]", f"[y: {{sub: a.Message, codec: {codec}}}]"
        file.write_text(
            f"system: codecs\ncomponents:\n  - {{name: a, gates: {gates[0]}}}\n"
            f"  - {{name: b, gates: {gates[1]}}}\nconnections: [[a.x, b.y]]\n"
        )
        text = refused(scl.UnsupportedCodecError, scl.open, file, "a")
        assert "gate `a.x`" in text and words in text
    assert not (Path(system.folder) / "codecs").exists()


def test_options_are_checked(system: System, monkeypatch: pytest.MonkeyPatch) -> None:
    text = refused(ValueError, lambda: scl.open(SIX, "sink", transport="udp"))
    assert text.startswith('transport="udp": `udp` is not understood; expected `ipc`, `tcp` or `shm`, ')
    for name, value, words in [
        ("SCL_TRANSPORT", "udp", "expected `ipc`, `tcp` or `shm`"),
        ("SCL_LOG", "loud", "expected `error`, `warn`"),
        ("SCL_STOP_WITHIN", "3", "expected a duration"),
    ]:
        with monkeypatch.context() as environment:
            environment.setenv(name, value)
            text = refused(scl.OpenError, lambda: scl.open(SIX, "sink", runtime_dir=system.folder))
            assert f"`{name}={value}`" in text and words in text


def test_two_systems_with_the_same_message_names_do_not_clash(system: System, tmp_path: Path) -> None:
    (tmp_path / "original.proto").write_text('syntax = "proto3"; package nav; message Position { string name = 1; }')
    other = tmp_path / "other.yaml"
    other.write_text((TOPOLOGIES / "shapes" / "original.yaml").read_text().replace("system: shapes", "system: other"))
    first = system.open("sensor", TOPOLOGIES / "shapes" / "original.yaml")
    second = system.open("sensor", other)
    assert first.position.type(lat=1.0).lat == 1.0
    assert second.position.type(name="x").name == "x"
    text = refused(TypeError, first.position.send, second.position.type())
    assert "of another module or topology" in text
