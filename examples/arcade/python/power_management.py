"""Tells how long the battery lasts."""

import sys
import time

from arcade_scl import PowerManagement
from black_box import BlackBox
from gates import next_within
from power_monitor import Monitor

PERIOD = 0.1  # s: the battery is read ten times a second


def run(component: PowerManagement) -> None:
    monitor = Monitor(time.monotonic(), component.parameters)
    black_box = BlackBox(component.records, "power_management")
    while True:
        # Readings set the pace; without them, `power` goes on a little slower.
        reading = next_within(component.battery, 1.5 * PERIOD)
        if component.update_parameters():
            monitor.parameters = component.parameters
        for event in monitor.update(time.monotonic(), reading):
            black_box.note(event.text, event.value)
        if monitor.power:
            component.power.send(monitor.power)


def main() -> int:
    with PowerManagement() as component:
        run(component)
    return 0


if __name__ == "__main__":
    sys.exit(main())
