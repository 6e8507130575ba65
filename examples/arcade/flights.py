"""Flies many times in simulated time, each time through other kills, and draws how well.

    flights.py --seeds 1..1000 -o pictures

Each flight is noted in `flights.csv` beside the picture when it ends, so a run that was stopped goes on where it was;
remove that file after a change to the aircraft. Build the aircraft first, with optimizations:
`EXAMPLES_PROFILE=release scl simulate examples/arcade --until 1s`.
"""

import argparse
import csv
import math
import os
import subprocess
import sys
from bisect import bisect_right
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from pathlib import Path
from queue import SimpleQueue
from tempfile import TemporaryDirectory
from typing import Any

import matplotlib
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

matplotlib.use("Agg")  # draws without a display

import matplotlib.pyplot as plt

EXAMPLE = Path(__file__).parent
# The autopilot in the air, and others at any time.
SCENARIO = """\
until: 45s
faults:
  - {at: 5s..15s, kill: autopilot}
  - {every: 2s..6s, kill: any, except: [simulator, uav_mission]}
"""
TOPICS = ["/simulator/world", "/autopilot/flight", "/autopilot/beats"]
MODE_GROUNDED = 0
BLUE, ORANGE = "#1f6fb4", "#e07b1a"


@dataclass(frozen=True)
class Flown:
    seed: int
    position_error: float  # greatest distance in m between the autopilot's estimate and the truth, in the air
    gap: float  # longest time in ms between two beats of the control loop
    landed: float | None  # m from home; None if it has not landed


class Notes:
    """The flights so far, in a file with one line for each."""

    def __init__(self, file: Path) -> None:
        self.file = file
        rows = csv.reader(file.read_text().splitlines()) if file.exists() else []
        flights = [Flown(int(it[0]), float(it[1]), float(it[2]), float(it[3]) if it[3] else None) for it in rows]
        self.flights = {it.seed: it for it in flights}

    def add(self, it: Flown) -> None:
        self.flights[it.seed] = it
        with self.file.open("a") as file:
            csv.writer(file).writerow([it.seed, it.position_error, it.gap, "" if it.landed is None else it.landed])


def fly(seed: int, processors: "SimpleQueue[int]", folder: Path) -> Flown:
    """Flies once, on a processor of its own."""
    recording, processor = folder / f"{seed}.mcap", processors.get()
    command = ["scl", "simulate", EXAMPLE, "--no-build", "--profile", "hop", "--scenario", folder / "kills.yaml"]
    try:
        subprocess.run(
            [*command, "--seed", str(seed), "--output", recording],
            check=True,
            capture_output=True,
            preexec_fn=partial(os.sched_setaffinity, 0, {processor}),
        )
        return judge(seed, recording)
    finally:
        processors.put(processor)
        recording.unlink(missing_ok=True)


def judge(seed: int, recording: Path) -> Flown:
    messages: dict[str, list[Any]] = {topic: [] for topic in TOPICS}
    with recording.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        for _, channel, _, message in reader.iter_decoded_messages(topics=TOPICS):
            messages[channel.topic].append(message)
    world, flight, beats = (messages[topic] for topic in TOPICS)
    times = [state.time_us for state in world]
    errors = [
        distance(it.position, world[bisect_right(times, it.time_us) - 1].position)
        for it in flight
        if it.mode != MODE_GROUNDED
    ]
    gap = max((after.time_us - before.time_us) / 1e3 for before, after in pairwise(beats))
    last = world[-1]
    landed = math.hypot(last.position.x, last.position.y) if last.on_ground and len(errors) > 0 else None
    return Flown(seed, max(errors, default=0.0), gap, landed)


def distance(one: Any, other: Any) -> float:
    return math.dist((one.x, one.y, one.z), (other.x, other.y, other.z))


def draw(flights: list[Flown], file: Path) -> None:
    figure, (error, gap) = plt.subplots(1, 2, figsize=(8, 3.4), layout="constrained")
    error.hist([it.position_error for it in flights], bins=40, color=BLUE)
    error.set(xlabel="greatest error of the estimated position (m)", ylabel="flights")
    gap.hist([it.gap for it in flights], bins=40, color=ORANGE)
    gap.set(xlabel="longest time without a beat (ms)")
    figure.suptitle(f"{len(flights)} flights, each with other kills")
    figure.savefig(file, dpi=130)


def seeds_of(text: str) -> Iterable[int]:
    first, _, last = text.partition("..")
    return range(int(first), int(last or first) + 1)


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seeds", type=seeds_of, default=range(1, 101), help="for example 1..1000; default: 1..100")
    parser.add_argument("-o", "--output", type=Path, default=Path("pictures"), help="the folder of the picture")
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    notes = Notes(arguments.output / "flights.csv")
    processors: SimpleQueue[int] = SimpleQueue()
    for processor in (allowed := os.sched_getaffinity(0)):
        processors.put(processor)
    with TemporaryDirectory() as temporary, ThreadPoolExecutor(len(allowed)) as pool:
        folder = Path(temporary)
        (folder / "kills.yaml").write_text(SCENARIO)
        try:
            missing = [seed for seed in arguments.seeds if seed not in notes.flights]
            for flown in pool.map(lambda seed: fly(seed, processors, folder), missing):
                notes.add(flown)
        except subprocess.CalledProcessError as error:
            print(f"error: {error}\n{error.stderr.decode(errors='replace')}", file=sys.stderr)
            return 2
    flights = [notes.flights[seed] for seed in arguments.seeds]
    lost = [it.seed for it in flights if it.landed is None]
    if lost:
        print(f"not landed with the seeds {lost}", file=sys.stderr)
    landed = [it.landed for it in flights if it.landed is not None]
    print(f"{len(flights)} flights, {len(landed)} landed, at most {max(landed, default=0):.2f} m from home")
    print(f"greatest error of the estimated position: {max(it.position_error for it in flights):.2f} m")
    print(f"longest time without a beat: {max(it.gap for it in flights):.1f} ms")
    draw(flights, arguments.output / "flights.png")
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main())
