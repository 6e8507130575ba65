"""Makes fixes of NMEA 0183 sentences, as receivers send them over a serial line, and counts those that are no use."""

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import time

import pynmea2

from arcade_scl import Fix, FixQuality

LONGEST = 82  # characters of a sentence, with its end (NMEA 0183, section 5.3)
KNOT = 1852 / 3600  # m/s


@dataclass
class Lines:
    """Cuts the stream of bytes into lines. What has no end in time is dropped up to the next one."""

    rest: bytes = b""
    too_long: bool = False

    def add(self, data: bytes) -> Iterator[bytes | None]:
        """Yields complete lines, and `None` for one that is too long."""
        *lines, self.rest = (self.rest + data).split(b"\n")
        for line in lines:
            yield None if self.too_long or len(line) + 1 > LONGEST else line.strip()
            self.too_long = False
        if len(self.rest) >= LONGEST:
            self.rest, self.too_long = b"", True


@dataclass
class Receiver:
    """Collects the sentences of one measurement: position (GGA), velocity (RMC) and whether the height counts (GSA)."""

    problems: Counter[str] = field(default_factory=Counter)  # how many sentences were no use, by kind of problem
    lines: Lines = field(default_factory=Lines)
    position: pynmea2.GGA | None = None
    velocity: pynmea2.RMC | None = None
    flat: bool = False  # whether the last GSA told a 2D fix

    def add(self, data: bytes, time_us: int) -> Iterator[Fix]:
        """Takes what the receiver has sent, and yields fixes, measured at `time_us`."""
        for line in self.lines.add(data):
            if line is None:
                self.problems["too long"] += 1
            elif line and (fix := self.sentence(line, time_us)) is not None:
                yield fix

    def sentence(self, line: bytes, time_us: int) -> Fix | None:
        try:
            text = line.decode("ascii")
        except UnicodeDecodeError:
            self.problems["not text"] += 1
            return None
        try:
            sentence = pynmea2.parse(text, check=True)
        except pynmea2.ChecksumError:
            # A sentence that was cut has none.
            self.problems["wrong checksum" if "*" in text else "cut"] += 1
        except pynmea2.SentenceTypeError:
            self.problems["unknown sentence"] += 1
        except (pynmea2.ParseError, ValueError):
            self.problems["not a sentence"] += 1
        else:
            try:
                return self.take(sentence, time_us)
            except (ValueError, TypeError, AttributeError):
                # The checksum is right, and yet a field is not what it has to be.
                self.problems["wrong field"] += 1
        return None

    def take(self, sentence: pynmea2.NMEASentence, time_us: int) -> Fix | None:
        """Takes a sentence of a known kind; most kinds say nothing that a fix needs."""
        if isinstance(sentence, pynmea2.GSA):
            self.flat = sentence.mode_fix_type == "2"
        elif isinstance(sentence, pynmea2.GGA):
            if not int(sentence.gps_qual or 0):
                self.problems["no fix"] += 1
                return Fix(time_us=time_us, satellites=int(sentence.num_sats or 0))
            self.position = sentence
            return self.combine(time_us)
        elif isinstance(sentence, pynmea2.RMC):
            self.velocity = sentence
            return self.combine(time_us)
        return None

    def combine(self, time_us: int) -> Fix | None:
        """A fix, as soon as position and velocity of one time have arrived, in either order."""
        position, velocity = self.position, self.velocity
        if position is None or velocity is None or clock(position) != clock(velocity):
            return None
        self.position = self.velocity = None
        if velocity.status != "A":
            self.problems["no fix"] += 1
            return Fix(time_us=time_us, satellites=int(position.num_sats or 0))
        if not (position.lat and position.lon):
            raise ValueError("no position")
        # A receiver that stands still knows no course.
        speed, course = float(velocity.spd_over_grnd) * KNOT, math.radians(float(velocity.true_course or 0))
        fix = Fix(
            time_us=time_us,
            quality=FixQuality.FIX_QUALITY_2D if self.flat else FixQuality.FIX_QUALITY_3D,
            latitude=position.latitude,
            longitude=position.longitude,
            altitude=float(position.altitude),
            east_speed=speed * math.sin(course),
            north_speed=speed * math.cos(course),
            satellites=int(position.num_sats or 0),
        )
        numbers = (fix.latitude, fix.longitude, fix.altitude, fix.east_speed, fix.north_speed)
        if not all(math.isfinite(number) for number in numbers) or abs(fix.latitude) > 90 or abs(fix.longitude) > 180:
            raise ValueError("not a position on Earth")
        return fix


def clock(sentence: pynmea2.NMEASentence) -> time:
    """When it was measured, by the receiver's own clock (UTC)."""
    if not isinstance(sentence.timestamp, time):
        raise TypeError("no time")
    return sentence.timestamp
