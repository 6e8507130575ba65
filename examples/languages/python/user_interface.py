"""Asks for another speed every second and shows what happens."""

from itertools import cycle
from time import sleep

import scl
from rover_scl import Command, UserInterface

with UserInterface() as ui:
    for target_speed in cycle([0.5, 1.5]):
        sleep(1.0)
        try:
            status = ui.commands.call(Command(target_speed=target_speed))
        except (scl.Timeout, scl.PeerLost):
            # The controller is not running, or is being replaced.
            print(f"asked for {target_speed:.1f} m/s: no answer")
            continue
        print(f"asked for {target_speed:.1f} m/s: {'accepted' if status.accepted else status.reason}")
        print(f"event: {ui.events.recv().text}")
