"""Draws a recorded flight: track over ground, height, battery, and the period of the control loop.

    pictures.py flight.mcap --kills kills.json -o pictures

The kills are a list such as [{"component": "autopilot", "time_us": 21500000}].
"""

import argparse
import json
import math
import sys
from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib
from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

matplotlib.use("Agg")  # draws without a display

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.ticker import MultipleLocator

RATE = 300  # beats per second
TOPICS = {
    "world": "/simulator/world",
    "fix": "/gps_sensor/fix",
    "flight": "/autopilot/flight",
    "beats": "/autopilot/beats",
    "battery": "/simulator/battery",
    "power": "/power_management/power",
}
MODE_FLYING = 2
BLUE, ORANGE, GREY, RED = "#1f6fb4", "#e07b1a", "#8a8a8a", "#c0392b"


@dataclass(frozen=True)
class Kill:
    component: str
    time: float  # s of the vehicle's clock


@dataclass(frozen=True)
class Recording:
    """Messages by the short names of their topics."""

    messages: dict[str, list[Any]]
    kills: list[Kill]

    def values(self, name: str, value: Callable[[Any], float]) -> list[float]:
        return [value(message) for message in self.messages[name]]

    def times(self, name: str) -> list[float]:
        return self.values(name, lambda message: message.time_us / 1e6)


def read(file: Path, kills: Path | None) -> Recording:
    names = {topic: name for name, topic in TOPICS.items()}
    messages: dict[str, list[Any]] = defaultdict(list)
    with file.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        for _, channel, _, message in reader.iter_decoded_messages(topics=list(names)):
            messages[names[channel.topic]].append(message)
    missing = [topic for topic, name in names.items() if not messages[name]]
    if missing:
        raise ValueError(f"nothing was recorded of {', '.join(missing)}")
    return Recording(messages, read_kills(kills) if kills else [])


def read_kills(file: Path) -> list[Kill]:
    try:
        return [Kill(kill["component"], kill["time_us"] / 1e6) for kill in json.loads(file.read_text())]
    except (ValueError, KeyError, TypeError) as error:
        raise ValueError(f"{file} is not a list of objects with `component` and `time_us`: {error}") from error


def draw_track(recording: Recording) -> Figure:
    figure, axes = plt.subplots(figsize=(6, 5.6), layout="constrained")
    for number, (east, north) in enumerate(waypoints(recording.messages["flight"]), start=1):
        label = "within 1 m of a waypoint" if number == 1 else None
        axes.add_patch(Circle((east, north), 1.0, color=ORANGE, alpha=0.25, linewidth=0, label=label))
        axes.annotate(str(number), (east, north), xytext=(10, 10), textcoords="offset points", color=ORANGE)
    plot_track(axes, recording, "flight", "estimate of the autopilot", color=BLUE, linewidth=1, linestyle="--")
    plot_track(axes, recording, "world", "true position", color="black", linewidth=1.3)
    axes.plot(0, 0, marker="+", color=RED, markersize=14, linestyle="none", label="home")
    axes.set(xlabel="east of home (m)", ylabel="north of home (m)", title="Track over ground", aspect="equal")
    axes.margins(0.08)
    axes.xaxis.set_major_locator(MultipleLocator(5))
    axes.yaxis.set_major_locator(MultipleLocator(5))
    axes.grid(alpha=0.3)
    axes.legend(loc="center", fontsize=8)
    return figure


def waypoints(flights: list[Any]) -> list[tuple[float, float]]:
    """Where the vehicle was sent, in this order; home aside."""
    flying = [flight for flight in flights if flight.mode == MODE_FLYING]
    targets = dict.fromkeys((round(flight.target.x, 1), round(flight.target.y, 1)) for flight in flying)
    return [target for target in targets if math.hypot(*target) > 1.0]


def plot_track(axes: Axes, recording: Recording, name: str, label: str, **style: Any) -> None:
    east = recording.values(name, lambda message: message.position.x)
    axes.plot(east, recording.values(name, lambda message: message.position.y), label=label, **style)


def draw_height(recording: Recording) -> Figure:
    figure, axes = plt.subplots(figsize=(8, 3.6), layout="constrained")
    set_point = recording.values("flight", lambda flight: flight.target.z if flight.mode else 0.0)
    axes.step(recording.times("flight"), set_point, where="post", color=ORANGE, linewidth=1.2, label="set-point")
    true = recording.values("world", lambda world: world.position.z)
    axes.plot(recording.times("world"), true, color="black", linewidth=1.3, label="true height")
    axes.set(xlabel="time since the start (s)", ylabel="height above home (m)", title="Height")
    axes.set_ylim(top=1.75 * max(true))  # room for the names of the kills
    axes.legend(loc="lower center", fontsize=8)
    mark_kills(axes, recording)
    return figure


def draw_battery(recording: Recording) -> Figure:
    figure, (charge, current) = plt.subplots(2, figsize=(8, 4.4), sharex=True, layout="constrained")
    left = recording.values("power", lambda power: 100 * power.charge_left)
    charge.plot(recording.times("power"), left, color=BLUE)
    charge.set(ylabel="charge left (%)", title="Battery")
    times = recording.times("battery")
    current.plot(times, recording.values("battery", lambda battery: battery.current), color=ORANGE)
    current.set(xlabel="time since the start (s)", ylabel="current (A)")
    current.yaxis.label.set_color(ORANGE)
    voltage = current.twinx()
    voltage.plot(times, recording.values("battery", lambda battery: battery.voltage), color=BLUE)
    voltage.set_ylabel("voltage (V)", color=BLUE)
    charge.grid(alpha=0.3)
    current.grid(alpha=0.3)
    return figure


def draw_periods(recording: Recording) -> Figure:
    figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
    beats = list(periods(recording.messages["beats"]))
    axes.plot(*zip(*beats, strict=True), marker=".", markersize=1.5, linestyle="none", color=BLUE, rasterized=True)
    axes.axhline(1e3 / RATE, color=GREY, linewidth=0.8)
    late = 1.5e3 / RATE
    axes.axhline(late, color=ORANGE, linewidth=0.8, linestyle="--")
    axes.annotate(
        "late", (1, late), xycoords=("axes fraction", "data"), xytext=(4, -3), textcoords="offset points", color=ORANGE
    )
    top = 1.5 * max(late, *(period for _, period in beats))
    for begin, end in pauses(recording.messages["beats"]):
        # At least as wide as a line, because most of them are short.
        axes.axvspan(begin, end, facecolor=ORANGE, edgecolor=ORANGE, linewidth=0.8, alpha=0.4)
        axes.annotate(
            f"no beats for {1e3 * (end - begin):.0f} ms",
            (end, 0.4 * top),  # below the names of the killed parts
            xytext=(3, 0),
            textcoords="offset points",
            color=ORANGE,
            fontsize=7.5,
        )
    axes.set(xlabel="time since the start (s)", ylabel="period (ms)", title="Control loop: the period before each beat")
    axes.set_ylim(0, top)
    mark_kills(axes, recording)
    return figure


def periods(beats: list[Any]) -> Iterator[tuple[float, float]]:
    """Times in s and periods in ms of consecutive beats; the autopilot was not started again between them."""
    for before, beat in pairwise(beats):
        if follows(before, beat):
            yield beat.time_us / 1e6, (beat.began_ns - before.began_ns) / 1e6


def pauses(beats: list[Any]) -> Iterator[tuple[float, float]]:
    """Begins and ends in s of the times without recorded beats: the autopilot was started again."""
    for before, beat in pairwise(beats):
        if not follows(before, beat):
            yield before.time_us / 1e6, beat.time_us / 1e6


def follows(before: Any, beat: Any) -> bool:
    return beat.time_us - before.time_us < 1.5e6 / RATE


def mark_kills(axes: Axes, recording: Recording) -> None:
    axes.grid(alpha=0.3)
    for kill in recording.kills:
        axes.axvline(kill.time, color=RED, linewidth=0.8, linestyle=":")
        axes.annotate(
            kill.component,
            (kill.time, 0.98),
            xycoords=("data", "axes fraction"),
            xytext=(-2, 0),
            textcoords="offset points",
            rotation=90,
            ha="right",
            va="top",
            color=RED,
            fontsize=7.5,
        )


PICTURES = {"track": draw_track, "height": draw_height, "battery": draw_battery, "period": draw_periods}


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("recording", type=Path, help="what `scl record` has written")
    parser.add_argument("--kills", type=Path, help="a JSON file that says what was killed when")
    parser.add_argument("-o", "--output", type=Path, default=Path("pictures"), help="the folder of the pictures")
    arguments = parser.parse_args()
    try:
        recording = read(arguments.recording, arguments.kills)
        arguments.output.mkdir(parents=True, exist_ok=True)
        for name, draw in PICTURES.items():
            file = arguments.output / f"{name}.png"
            draw(recording).savefig(file, dpi=130)
            print(file)
    except (OSError, ValueError, McapError) as error:
        print(f"error: cannot draw {arguments.recording}: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
