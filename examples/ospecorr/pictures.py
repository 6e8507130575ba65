"""Draws a recorded session: the spectrum over time, who transmits where, and what the application got.

pictures.py session.mcap -o pictures
"""

import argparse
import sys
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

matplotlib.use("Agg")  # draws without a display

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

SLOT = 0.02  # s between two blocks
BINS = 16  # frequencies drawn for each channel
BLOCKS = 4  # blocks averaged into one, because noise hides the rest
TOPICS = {
    "samples": "/spectrum/samples",
    "truth": "/spectrum/truth",
    "service": "/application/service",
}
RADIO, TRUTH, RED, BLUE, GREY = "#ff4fa3", "white", "#c0392b", "#1f6fb4", "#8a8a8a"


@dataclass(frozen=True)
class Span:
    """A time in which something happens in a channel, in seconds."""

    channel: int
    start: float
    end: float


def read(file: Path) -> dict[str, list[Any]]:
    """The messages by the short names of their topics."""
    names = {topic: name for name, topic in TOPICS.items()}
    messages: dict[str, list[Any]] = defaultdict(list)
    with file.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        for _, channel, _, message in reader.iter_decoded_messages(topics=list(names)):
            messages[names[channel.topic]].append(message)
    missing = [topic for topic, name in names.items() if not messages[name]]
    if missing:
        raise ValueError(f"nothing was recorded of {', '.join(missing)}")
    return messages


def spans(truths: list[Any], channels: int, channel_in_use: Any) -> Iterator[Span]:
    """The times in which each channel is in use without a pause."""
    for channel in range(channels):
        start: float | None = None
        for truth in truths:
            time = truth.time_us / 1e6
            if channel_in_use(truth, channel):
                start = time if start is None else start
            elif start is not None:
                yield Span(channel, start, time)
                start = None
        if start is not None:
            yield Span(channel, start, truths[-1].time_us / 1e6 + SLOT)


def power_db(samples: list[Any], channels: int) -> Any:
    """The power in dB above the median: a row for each frequency, a column for some blocks."""
    rows = []
    for block in samples:
        iq = np.fromiter(block.iq, np.float32).view(np.complex64)
        periodogram = np.abs(np.fft.fftshift(np.fft.fft(iq * np.hanning(len(iq))))) ** 2
        rows.append(periodogram.reshape(channels * BINS, -1).mean(axis=1))
    whole = len(rows) // BLOCKS * BLOCKS
    power = np.array(rows[:whole]).reshape(-1, BLOCKS, channels * BINS).mean(axis=1)
    return 10 * np.log10(power / np.median(power)).T


def draw_spectrum(messages: dict[str, list[Any]]) -> Figure:
    """The waterfall with the radio and the primary users, and below it the service."""
    figure, (spectrum, service) = plt.subplots(
        2, figsize=(9, 5.6), sharex=True, layout="constrained", height_ratios=[3, 1]
    )
    samples, truths = messages["samples"], messages["truth"]
    channels = samples[0].channels
    draw_waterfall(spectrum, figure, samples, channels)
    for span in spans(truths, channels, lambda truth, channel: channel in truth.primary_channels):
        outline = Rectangle((span.start, span.channel - 0.46), span.end - span.start, 0.92)
        outline.set(fill=False, edgecolor=TRUTH, linewidth=0.9)
        spectrum.add_patch(outline)
    draw_radio(spectrum, list(spans(truths, channels, lambda truth, channel: transmits(truth) == channel)))
    spectrum.set(ylabel="channel (1 MHz each)", yticks=range(channels))
    spectrum.legend(
        handles=[
            Line2D([], [], color=RADIO, linewidth=3, label="own radio transmits"),
            Patch(facecolor="#5ec962", edgecolor=GREY, label="primary user transmits"),
        ],
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncols=2,
        frameon=False,
        fontsize=9,
    )
    draw_service(service, messages["service"])
    service.set_xlim(truths[0].time_us / 1e6, truths[-1].time_us / 1e6)
    return figure


def transmits(truth: Any) -> int | None:
    """The channel on which the own radio transmits."""
    return int(truth.channel) if truth.transmitting else None


def draw_waterfall(axes: Axes, figure: Figure, samples: list[Any], channels: int) -> None:
    begin, end = samples[0].time_us / 1e6, samples[-1].time_us / 1e6
    image = axes.imshow(
        power_db(samples, channels),
        origin="lower",
        aspect="auto",
        extent=(begin, end, -0.5, channels - 0.5),
        cmap="viridis",
        vmin=-3,
        vmax=14,
        interpolation="nearest",
    )
    figure.colorbar(image, ax=axes, label="power above noise (dB)", pad=0.01)


def draw_radio(axes: Axes, own: list[Span]) -> None:
    own.sort(key=lambda span: span.start)
    for span in own:
        axes.plot([span.start, span.end], [span.channel] * 2, color=RADIO, linewidth=3, solid_capstyle="butt")
    for before, after in pairwise(own):
        if before.channel != after.channel:
            axes.plot([before.end, after.start], [before.channel, after.channel], color=RADIO, linewidth=1)


def draw_service(axes: Axes, reports: list[Any]) -> None:
    reports = [report for report in reports if report.time_us > 0]
    times = [report.time_us / 1e6 for report in reports]
    axes.step(times, [report.rate / 1e3 for report in reports], where="post", color=BLUE, label="received")
    axes.axhline(reports[0].required_rate / 1e3, color=GREY, linewidth=0.9, linestyle="--", label="required")
    not_served = [report.time_us / 1e6 for report in reports if not report.served]
    for number, time in enumerate(not_served):
        axes.axvspan(time - 0.1, time, color=RED, alpha=0.35, linewidth=0, label=None if number else "not served")
    share = 100 * (1 - len(not_served) / len(reports))
    axes.set(xlabel="time (s)", ylabel="rate (kB/s)", title=f"Service: {share:.1f} % of the time")
    axes.title.set_fontsize(9)
    axes.set_ylim(bottom=0)
    axes.grid(alpha=0.3)
    axes.legend(loc="lower right", ncols=3, fontsize=8)


def main() -> int:
    """The program."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("recording", type=Path, help="what `scl record` has written")
    parser.add_argument("-o", "--output", type=Path, default=Path("pictures"), help="the folder of the picture")
    arguments = parser.parse_args()
    try:
        figure = draw_spectrum(read(arguments.recording))
        arguments.output.mkdir(parents=True, exist_ok=True)
        file = arguments.output / "spectrum.png"
        figure.savefig(file, dpi=130)
        print(file)
    except (OSError, ValueError, KeyError, McapError) as error:
        print(f"error: cannot draw {arguments.recording}: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
