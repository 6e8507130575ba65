"""Steers towards the speed that the user interface asks for."""

import asyncio
from contextlib import suppress

import scl
from rover_scl import Controller, Event, Setpoint, Status


async def main() -> None:
    target_speed = 1.0
    with Controller() as c:

        async def steer() -> None:
            async for measured in c.sensor:
                throttle = max(-1.0, min(target_speed - measured.speed, 1.0))
                c.actuator.send(Setpoint(throttle=throttle))

        async def obey() -> None:
            nonlocal target_speed
            async for command in c.commands:
                target_speed = command.message.target_speed
                c.events.send(Event(text=f"target is now {target_speed:.1f} m/s"))
                # A user interface that has been stopped no longer waits for the reply.
                with suppress(scl.RequesterGone):
                    command.reply(Status(accepted=True))

        await scl.until_stopped(steer(), obey())


asyncio.run(main())
