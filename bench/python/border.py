"""What a call of the package costs, beside pyzmq, and what a cold start costs that checks a topology.

border.py: the fastest of many rounds, because everything else of the machine only adds to a call.
"""

from __future__ import annotations

import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import scl
import zmq

ROOT = Path(__file__).resolve().parents[2]
QUICKSTART = ROOT / "examples/quickstart/topology.yaml"
RAW = "components: [{name: a, gates: [x: push]}, {name: b, gates: [y: {pull: , queue: 100000}]}]\nconnections: [[a.x, b.y]]\n"


def best(call: Callable[[], object], calls: int = 2000, rounds: int = 200) -> float:
    """Returns the nanoseconds of a call in the fastest round."""
    found = float("inf")
    for _ in range(rounds):
        began = time.perf_counter_ns()
        for _ in range(calls):
            call()
        found = min(found, (time.perf_counter_ns() - began) / calls)
    return found


def pair(library: str, send: Callable[[], object], receive: Callable[[], object]) -> None:
    """Shows the medians of single calls: SCL writes some messages of a burst together, and those wait."""
    sent, received = [], []
    for _ in range(20_000):
        began = time.perf_counter_ns()
        send()
        between = time.perf_counter_ns()
        receive()
        ended = time.perf_counter_ns()
        sent.append(between - began)
        received.append(ended - between)
    show(f"{library}: send, 20 bytes, connected", statistics.median(sent))
    show(f"{library}: recv after that", statistics.median(received))


def show(what: str, nanoseconds: float) -> None:
    print(f"{what:60} {nanoseconds:9.0f} ns", flush=True)


def calls(folder: str) -> None:
    file = Path(folder) / "raw.yaml"
    file.write_text(RAW)
    a, b = (
        scl.open(file, "a", runtime_dir=folder),
        scl.open(file, "b", runtime_dir=folder),
    )
    message = b"x" * 20
    native_kind = a._native
    show(
        "an attribute of a native object (crosses the border)",
        best(lambda: native_kind.is_closed),
    )
    show("the loop and the lambda themselves", best(lambda: native_kind))
    show("scl: try_recv, nothing there", best(b.y.try_recv))

    a.ready(10)
    pair("scl", lambda: a.x.send(message), b.y.recv)

    quick = scl.open(QUICKSTART, "controller", runtime_dir=folder)
    setpoint = quick.actuator.type(throttle=0.5)
    show(
        "scl: send, protobuf, nobody connected",
        best(lambda: quick.actuator.send(setpoint)),
    )
    show("google.protobuf alone: SerializeToString", best(setpoint.SerializeToString))

    context = zmq.Context()
    push, pull = context.socket(zmq.PUSH), context.socket(zmq.PULL)
    pull.bind(f"ipc://{folder}/pull")
    push.connect(f"ipc://{folder}/pull")

    def nothing_zmq() -> None:
        try:
            pull.recv(zmq.NOBLOCK)
        except zmq.Again:
            pass

    show("pyzmq: recv(NOBLOCK), nothing there", best(nothing_zmq, 500))
    pair("pyzmq", lambda: push.send(message), pull.recv)
    context.destroy(linger=0)


def cold_starts(folder: str) -> None:
    for what, program in [
        ("python -c pass", "pass"),
        ("python -c 'import scl'", "import scl"),
        (
            "python -c 'import google.protobuf.message_factory'",
            "import google.protobuf.message_factory",
        ),
        (
            "scl.open of the quick start: checked, opened, closed",
            f"import scl; scl.open({str(QUICKSTART)!r}, 'controller')",
        ),
    ]:
        environment = {
            "SCL_RUNTIME_DIR": folder,
            "PYTHONPATH": str(Path(scl.__file__).parents[1]),
        }
        times, processor = [], []
        for _ in range(20):
            began, before = (
                time.perf_counter(),
                resource.getrusage(resource.RUSAGE_CHILDREN),
            )
            subprocess.run([sys.executable, "-c", program], env=environment, check=True)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            times.append(time.perf_counter() - began)
            processor.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        print(f"{what:60} {min(times) * 1e3:9.1f} ms, {min(processor) * 1e3:5.1f} ms of processor time")


with tempfile.TemporaryDirectory(prefix="scl") as folder:
    calls(folder)
with tempfile.TemporaryDirectory(prefix="scl") as folder:
    cold_starts(folder)
