"""Gates: their names, directions and messages."""

from typing import assert_type

from rover_scl import Actuator, Command, Controller, Event, Measurement, Sensor, Setpoint, Status, UserInterface
from rover_scl import Sensr  # error: Sensr

sensor = Sensor(runtime_dir="/tmp/rover", system="rover", transport="ipc", signals=False)
controller = Controller()
actuator = Actuator()
user_interface = UserInterface()
Sensor(transport=1)  # error: str
Sensor("sensor")  # error: argument

# Sending.
sensor.measurements.send(Measurement(speed=1.5))
sensor.measurements.send(Measurement(speed=1), timeout=0.5)
sensor.measurement.send(Measurement())  # error: measurement
sensor.measurements.send(Setpoint())  # error: Setpoint Measurement
sensor.measurements.send(Measurement)  # error: type[Measurement]
sensor.measurements.send({"speed": 1.5})  # error: dict Measurement
sensor.measurements.send(None)  # error: None Measurement
sensor.measurements.send()  # error: message
sensor.measurements.recv()  # error: recv
sensor.measurements = controller.actuator  # error: Measurement Setpoint
controller.actuator.send(controller.actuator.type(throttle=0.5))

# Receiving.
assert_type(controller.sensor.recv(), Measurement)
assert_type(controller.sensor.recv(timeout=1), Measurement)
assert_type(controller.sensor.try_recv(), Measurement | None)
assert_type(controller.sensor.latest(), Measurement | None)
controller.sensor.latest().speed  # error: None speed
assert_type(controller.sensor.try_recv(default=0), Measurement | int)
assert_type(controller.sensor.latest(Measurement()), Measurement)
controller.sensor.send(Measurement())  # error: send
for event in user_interface.events:
    assert_type(event, Event)
for event in actuator.setpoint.recv():  # error: Setpoint __iter__
    pass

# Requests and replies.
status = user_interface.commands.call(Command(target_speed=2.0))
assert_type(status, Status)
user_interface.commands.call(Status())  # error: Status Command
user_interface.commands.call(Command()).acepted  # error: acepted
for request in controller.commands:
    assert_type(request.message, Command)
    request.reply(Status(accepted=True))
    request.reply(Command())  # error: Command Status
controller.commands.call(Command())  # error: call
