"""The signal detector: finds out which channels are in use."""

import argparse
import time
from contextlib import suppress

from detection import BadBlock, EnergyDetector, complex_samples
from ospecorr_scl import Occupancy, SignalDetector


class RareMessages:
    """Prints a message at most once a second, with the number of those that it replaces."""

    def __init__(self) -> None:
        self._printed_at = float("-inf")
        self._more = 0

    def print(self, text: str, now: float) -> None:
        """Prints `text`, unless the last message was less than a second ago; `now` in seconds."""
        if now - self._printed_at < 1:
            self._more += 1
            return
        print(f"{text} ({self._more} more since the last message)" if self._more else text)
        self._printed_at, self._more = now, 0


def run(detector: SignalDetector, false_alarm: float) -> None:
    """Publishes what is in each block, until a stop is requested."""
    energy_detector = EnergyDetector(false_alarm)
    messages = RareMessages()
    for block in detector.samples:
        try:
            found = energy_detector.detect(complex_samples(block.iq, block.channels), block.channels)
        except BadBlock as error:
            messages.print(f"skipped the block of {block.time_us / 1e6:.3f} s: {error}", time.monotonic())
            continue
        channels = [
            Occupancy.Channel(power_db=it.power_db, occupied=it.occupied, threshold_db=it.threshold_db) for it in found
        ]
        detector.occupancy.send(Occupancy(time_us=block.time_us, channels=channels))


def probability(text: str) -> float:
    """A probability of false alarm from the command line."""
    with suppress(ValueError):
        if 0 < float(text) < 0.5:
            return float(text)
    raise argparse.ArgumentTypeError(f"`{text}` is not a number between 0 and 0.5")


def main() -> None:
    """The program."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--false-alarm",
        type=probability,
        default=1e-3,
        metavar="PROBABILITY",
        help="probability that noise in a channel of a block is taken for a signal (default: %(default)s)",
    )
    arguments = parser.parse_args()
    with SignalDetector() as detector:
        run(detector, arguments.false_alarm)


if __name__ == "__main__":
    main()
