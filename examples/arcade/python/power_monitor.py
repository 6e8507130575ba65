"""Decides what `power` says: readings of the battery and the passing of time in, messages and events out."""

from dataclasses import dataclass

from arcade_scl import Battery, Power, PowerLevel, PowerManagementParameters
from battery import Estimate, extrapolate, implausible, update

SILENT_AFTER = 1.0  # s without a plausible reading
# s after the start without any plausible reading: then nothing is known of the battery, which is as bad as an empty one.
# A vehicle on the ground does not take off then, one in the air lands. After a plausible reading, the sensor's silence alone
# is no such reason: the charge is extrapolated from the last current, and the levels follow from it as usual.
BLIND_AFTER = 5.0

NAMES = {
    PowerLevel.POWER_LEVEL_OK: "ok",
    PowerLevel.POWER_LEVEL_LOW: "low",
    PowerLevel.POWER_LEVEL_CRITICAL: "critical",
}


@dataclass(frozen=True)
class Event:
    """Something to be said once."""

    text: str
    value: float = 0.0


def level_of(charge: float, last: PowerLevel, parameters: PowerManagementParameters) -> PowerLevel:
    """The level of a charge. It gets worse at once, and better only beyond the hysteresis."""
    limits = (
        (PowerLevel.POWER_LEVEL_CRITICAL, parameters.critical),
        (PowerLevel.POWER_LEVEL_LOW, parameters.low),
    )
    for level, limit in limits:
        if charge < limit or (last >= level and charge < limit + parameters.hysteresis):
            return level
    return PowerLevel.POWER_LEVEL_OK


class Monitor:
    """Times are seconds of any clock that does not go backwards."""

    def __init__(self, now: float, parameters: PowerManagementParameters) -> None:
        self.parameters = parameters
        self.power: Power | None = None  # what is to be published; None as long as nothing is known
        self._estimate: Estimate | None = None
        self._level = PowerLevel.POWER_LEVEL_OK  # of the last estimate
        self._heard_at = now  # the last plausible reading, or the start
        self._silent = False
        self._implausible: str | None = None

    def update(self, now: float, reading: Battery | None) -> list[Event]:
        """Takes a reading, or that there was none. Returns what is to be said."""
        events = []
        problem = implausible(reading, self.parameters.cells) if reading else self._implausible
        if problem and not self._implausible:
            events.append(Event(f"ignoring readings of the battery: {problem}"))
        self._implausible = problem
        if reading and not problem:
            events += self._heard(now, reading)
        elif now - self._heard_at >= SILENT_AFTER and not self._silent:
            self._silent = True
            events.append(Event(f"no plausible reading of the battery for {SILENT_AFTER:g} s"))
        return events + self._judge(now)

    def _heard(self, now: float, reading: Battery) -> list[Event]:
        last = self._estimate
        self._estimate = update(last, reading, self.parameters)
        events = [Event(f"battery readings are back after {now - self._heard_at:.1f} s")] if self._silent else []
        if self._estimate.count_is_wrong != (last is not None and last.count_is_wrong):
            wrong, volts = self._estimate.count_is_wrong, self._estimate.shortfall
            events.append(
                Event(
                    f"the battery's voltage is {volts:.2f} V per cell below its counted charge; using the voltage",
                    volts,
                )
                if wrong
                else Event("the battery's voltage fits its counted charge again", volts)
            )
        self._heard_at, self._silent = now, False
        return events

    def _judge(self, now: float) -> list[Event]:
        said = self.power.level if self.power else None
        if self._estimate:
            # A reading that is a little late is no silence.
            silence = now - self._heard_at if self._silent else 0.0
            self.power = self._message(extrapolate(self._estimate, silence))
        elif now - self._heard_at >= BLIND_AFTER:
            self.power = Power(level=PowerLevel.POWER_LEVEL_CRITICAL)
        if self.power is None or self.power.level == said:
            return []
        text = describe(self.power) if self._estimate else "power is critical: the battery was never read"
        return [Event(text, self.power.charge_left)]

    def _message(self, estimate: Estimate) -> Power:
        self._level = level_of(estimate.charge, self._level, self.parameters)
        return Power(
            time_us=estimate.time_us,
            voltage=estimate.voltage,
            current=estimate.current,
            charge_left=estimate.charge,
            time_left=estimate.time_left,
            level=self._level,
        )


def describe(power: Power) -> str:
    """One line about the level."""
    left = f"{100 * power.charge_left:.0f} % left, {power.time_left:.0f} s at {power.current:.1f} A"
    return f"power is {NAMES[power.level]}: {left}"
