"""The paper's Table III in Python: the delay of 20 bytes at 1000 Hz between two programs, beside pyzmq.

    python bench/python/delay.py [--seconds 5]

Three situations: idle, under load, and under load with real-time priority for both programs. SCL and pyzmq take turns in
batches of 200 messages between the same two processes. The load is one process per processor that computes, and one that
writes a file. Real-time priority takes root, or the limit `rtprio`; without it, the last situation is left out with a note.
"""

import argparse
import contextlib
import os
import statistics
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import scl
import zmq

HERE = Path(__file__).parent
PERIOD = 1_000_000
"""Between two messages, in nanoseconds."""
BATCH = 200
"""Messages of SCL before it is the turn of pyzmq, and so on."""
PRIORITY = 80
PADDING = bytes(12)
TIMESTAMP = struct.Struct("q")

# Table III of the paper, on a processor of 500 MHz: minimum, median, mean, maximum, in milliseconds.
PAPER = {"idle": (0.36, 0.42, 0.44, 1.0), "load": (0.33, 0.55, 0.71, 7.7), "real-time": (0.39, 0.45, 0.48, 1.6)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=5, help="how long each line is measured")
    parser.add_argument("--role", choices=["source", "sink", "compute", "write"], help=argparse.SUPPRESS)
    parser.add_argument("--folder", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--rounds", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    match options.role:
        case "source":
            run_source(options.folder, options.rounds)
        case "sink":
            run_sink(options.folder, options.rounds)
        case "compute":
            compute()
        case "write":
            write()
        case _:
            measure_all(options.seconds)


def measure_all(seconds: float) -> None:
    rounds = max(1, round(seconds * 1e9 / PERIOD / BATCH))
    print("delay of 20 bytes at 1000 Hz between two Python programs, in us")
    print(f"{'':20}{'min':>9}{'median':>9}{'mean':>9}{'max':>10}{'stddev':>10}     paper: min, median, mean, max")
    measure("idle", rounds, [])
    with load():
        measure("load", rounds, [])
        launcher = ["chrt", "-f", str(PRIORITY)]
        if is_permitted(launcher):
            measure("real-time", rounds, launcher)
        else:
            print("real-time priority was not measured: run as root, or raise `rtprio` (`ulimit -r 80`)")
    print("`load` has the load only, `real-time` the load and real-time priority for both programs")


def measure(situation: str, rounds: int, launcher: list[str]) -> None:
    with tempfile.TemporaryDirectory(prefix="scl") as folder:
        programs = [
            subprocess.Popen([*launcher, *program(role), "--folder", folder, "--rounds", str(rounds)], stdout=output)
            for role, output in [("sink", subprocess.PIPE), ("source", None)]
        ]
        printed, _ = programs[0].communicate()
        if any(it.wait() for it in programs):
            sys.exit(f"a program of the situation `{situation}` failed")
    for line in printed.decode().splitlines():
        name, *texts = line.split()
        delays = [int(it) / 1000 for it in texts]
        shown = [min(delays), statistics.median(delays), statistics.fmean(delays), max(delays)]
        spread = statistics.pstdev(delays)
        paper = "".join(f"{it * 1000:8.0f}" for it in PAPER[situation])
        columns = "".join(f"{it:{width}.1f}" for it, width in zip([*shown, spread], (9, 9, 9, 10, 10), strict=True))
        print(f"{name + ', ' + situation:20}{columns}{paper if name == 'SCL' else ''}", flush=True)


def program(role: str) -> list[str]:
    return [sys.executable, __file__, "--role", role]


def is_permitted(launcher: list[str]) -> bool:
    try:
        return subprocess.run([*launcher, "true"], stderr=subprocess.DEVNULL, check=False).returncode == 0
    except FileNotFoundError:
        return False


def run_source(folder: Path, rounds: int) -> None:
    with scl.open(HERE / "delay.yaml", "source", runtime_dir=folder) as source, zmq.Context() as context:
        socket = context.socket(zmq.XPUB)
        socket.bind(f"ipc://{folder}/zmq")
        socket.recv()
        source.ready()
        send = source.samples.send
        time.sleep(0.2)
        due = time.monotonic_ns()
        for turn in range(2 * rounds):
            for _ in range(BATCH):
                due += PERIOD
                # A source that was late sends no burst.
                due = max(due, time.monotonic_ns() - PERIOD)
                time.sleep(max(0, due - time.monotonic_ns()) / 1e9)
                if turn % 2 == 0:
                    send(TIMESTAMP.pack(time.monotonic_ns()) + PADDING)
                else:
                    socket.send(TIMESTAMP.pack(time.monotonic_ns()) + PADDING)
        socket.close(linger=5000)
        source.close(timeout=5)


def run_sink(folder: Path, rounds: int) -> None:
    delays: dict[str, list[int]] = {"SCL": [], "pyzmq": []}
    with scl.open(HERE / "delay.yaml", "sink", runtime_dir=folder) as sink, zmq.Context() as context:
        socket = context.socket(zmq.SUB)
        socket.connect(f"ipc://{folder}/zmq")
        socket.subscribe(b"")
        receivers = {"SCL": sink.samples.recv, "pyzmq": socket.recv}
        for _ in range(rounds):
            for name, receive in receivers.items():
                found = delays[name]
                for _ in range(BATCH):
                    frame = receive()
                    found.append(time.monotonic_ns() - TIMESTAMP.unpack_from(frame)[0])
        socket.close()
    for name, found in delays.items():
        print(name, *found)


@contextlib.contextmanager
def load() -> Iterator[None]:
    """Keeps every processor busy, and a disk."""
    roles = ["compute"] * len(os.sched_getaffinity(0)) + ["write"]
    programs = [subprocess.Popen(program(role)) for role in roles]
    try:
        yield
    finally:
        for it in programs:
            it.kill()
            it.wait()


def compute() -> None:
    value = 1
    while True:
        value = value * 6_364_136_223_846_793_005 % 2**64 + 1


def write() -> None:
    block = bytes(1 << 20)
    with tempfile.TemporaryFile() as file:
        while True:
            file.seek(0)
            file.write(block)
            os.fsync(file.fileno())


if __name__ == "__main__":
    main()
