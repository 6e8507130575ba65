"""Quality of service: what the application gets, compared with what it requires. Times are microseconds."""

from collections import deque
from dataclasses import dataclass
from itertools import pairwise

WINDOW_US = 500_000
# A rate is measured in whole frames, and a change of the channel may delay some.
SUFFICIENT = 0.9


@dataclass(frozen=True)
class Requirement:
    """Bytes a second, and the longest time without a frame in seconds."""

    rate: float
    longest_gap: float


@dataclass(frozen=True)
class Quality:
    """The rate of the last half second in bytes a second, and whether that and the gaps meet the requirement."""

    rate: float
    served: bool


class QualityMonitor:
    """Measures the quality from the frames that have been received."""

    def __init__(self, required: Requirement) -> None:
        self._required = required
        self._received: deque[tuple[int, int]] = deque()  # time and length

    def received(self, time_us: int, length: int) -> None:
        """Counts a frame; times do not decrease, unless the spectrum has been restarted."""
        if self._received and time_us < self._received[-1][0]:
            self._received.clear()
        self._received.append((time_us, length))

    def at(self, time_us: int) -> Quality:
        """The quality in the half second before a time."""
        begin_us = time_us - WINDOW_US
        while self._received and self._received[0][0] <= begin_us:
            self._received.popleft()
        rate = sum(length for _, length in self._received) / (WINDOW_US / 1e6)
        times = [begin_us, *(at for at, _ in self._received), time_us]
        longest_gap = max(later - earlier for earlier, later in pairwise(times)) / 1e6
        required = self._required
        return Quality(rate, rate >= SUFFICIENT * required.rate and longest_gap <= required.longest_gap)


class SpectrumClock:
    """The time of the simulated spectrum, which is known when a message arrives, and then goes on as the local clock does.

    It may fall behind the local clock, where the simulation is paused, so the newest message always sets it.
    """

    def __init__(self) -> None:
        self._newest: tuple[int, float] | None = None

    def update(self, time_us: int, local: float) -> None:
        """A message was sent at `time_us`, and arrived at a local time in seconds."""
        self._newest = (time_us, local)

    def now(self, local: float) -> int:
        """The time at a local time in seconds; 0 before the first message."""
        if self._newest is None:
            return 0
        time_us, arrived = self._newest
        return time_us + int((local - arrived) * 1e6)


class Pace:
    """When frames are due: at a steady rate, by absolute times.

    After a pause, frames that would have been sent meanwhile are sent late, but not those of a long one: a stream wants
    to be up to date, rather than complete.
    """

    LONGEST_DELAY = 0.2

    def __init__(self, period: float, now: float) -> None:
        self._period = period
        self._due = now

    def next(self, now: float) -> float:
        """When the next frame is due; all times in seconds."""
        self._due += self._period
        if now - self._due > self.LONGEST_DELAY:
            self._due = now
        return self._due
