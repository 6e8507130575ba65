"""What is left in a lithium-polymer battery: coulomb counting, checked against a voltage model.

Plett, Battery Management Systems, volume 1, chapter 2: open-circuit voltage behind an internal resistance; volume 2, chapter 3:
coulomb counting, which the voltage corrects where the count started wrong.
"""

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace

from arcade_scl import Battery, PowerManagementParameters

# Open-circuit voltage of one cell at tenths of its charge, from empty to full, at room temperature.
VOLTAGES = (3.30, 3.61, 3.69, 3.71, 3.75, 3.80, 3.84, 3.91, 3.98, 4.08, 4.20)
CHARGES = tuple(tenths / 10 for tenths in range(11))
SMOOTHING = 3.0  # s, time constant: gusts change the current faster than this
DOUBT = 0.1  # V for each cell: the curve is flat, and cells of one type differ by about half of this
IDLE_CURRENT = 0.05  # A: less is noise of the sensor, and would make years of the time left


def open_circuit_voltage(charge: float) -> float:
    """The voltage of an idle cell, V."""
    return interpolate(charge, CHARGES, VOLTAGES)


def charge_by_voltage(voltage: float) -> float:
    """The charge, 0 to 1, of an idle cell. Coarse, because the curve is flat."""
    return interpolate(voltage, VOLTAGES, CHARGES)


def interpolate(x: float, xs: Sequence[float], ys: Sequence[float]) -> float:
    """Linear between the points, constant beyond them. numpy's would take half a second to import, also after a crash."""
    right = min(max(bisect_right(xs, x), 1), len(xs) - 1)
    part = (x - xs[right - 1]) / (xs[right] - xs[right - 1])
    return ys[right - 1] + (ys[right] - ys[right - 1]) * min(max(part, 0.0), 1.0)


def implausible(reading: Battery, cells: float) -> str | None:
    """Why a reading cannot be of this battery; `None` if it can."""
    limits = (
        ("voltage", reading.voltage, 2.0 * cells, 4.5 * cells, "V"),
        ("current", reading.current, -50.0, 500.0, "A"),
        ("capacity", reading.capacity, 0.01, 1000.0, "Ah"),
        ("used", reading.used, -0.1 * reading.capacity, 1.5 * reading.capacity, "Ah"),
    )
    for name, value, lowest, highest, unit in limits:
        if not (math.isfinite(value) and lowest <= value <= highest):
            return f"{name} is {value:g} {unit}, not {lowest:g} to {highest:g} {unit}"
    return None


@dataclass
class Estimate:
    """The state of the estimator after a plausible reading."""

    time_us: int
    charge: float  # 0 to 1
    capacity: float  # Ah
    voltage: float  # V, as read
    current: float  # A, smoothed
    shortfall: float  # V for each cell, smoothed: how much less there is than the counted charge would give
    count_is_wrong: bool  # the voltage contradicts the count, so the charge is that of the voltage

    @property
    def time_left(self) -> float:
        """Seconds at the present current."""
        return self.charge * self.capacity * 3600 / max(self.current, IDLE_CURRENT)


def update(last: Estimate | None, reading: Battery, parameters: PowerManagementParameters) -> Estimate:
    """The estimate after a plausible reading."""
    cells = parameters.cells
    counted = min(max(1 - reading.used / reading.capacity, 0.0), 1.0)
    idle_voltage = (reading.voltage + reading.current * parameters.resistance) / cells
    shortfall = open_circuit_voltage(counted) - idle_voltage
    current = reading.current
    if last:
        # The battery's clock stands still or starts again with the simulator.
        passed = max(reading.time_us - last.time_us, 0) / 1e6
        weight = -math.expm1(-passed / SMOOTHING)
        current = last.current + weight * (current - last.current)
        shortfall = last.shortfall + weight * (shortfall - last.shortfall)
    # The doubt ends at half of what began it, so that it does not come and go with the noise.
    count_is_wrong = shortfall > (DOUBT / 2 if last and last.count_is_wrong else DOUBT)
    charge = counted
    if count_is_wrong:
        charge = min(counted, charge_by_voltage(open_circuit_voltage(counted) - shortfall))
    return Estimate(reading.time_us, charge, reading.capacity, reading.voltage, current, shortfall, count_is_wrong)


def extrapolate(last: Estimate, seconds: float) -> Estimate:
    """The estimate when the sensor has been silent for so long: the current is taken to be as it was."""
    used = max(last.current, 0.0) * seconds / 3600 / last.capacity
    return replace(last, time_us=last.time_us + int(seconds * 1e6), charge=max(last.charge - used, 0.0))
