"""Publishes a made-up speed ten times a second."""

from itertools import count
from math import sin
from time import sleep

from rover_scl import Measurement, Sensor

with Sensor() as sensor:
    for step in count():
        sleep(0.1)
        speed = 1.0 + sin(step)
        print(f"speed {speed:.2f} m/s")
        sensor.measurements.send(Measurement(speed=speed))
