"""Tells all components where home is and what the vehicle may do, and changes it for the ground station."""

import sys
from contextlib import suppress

import scl

from arcade_scl import Configuration, ConfigurationParameters, Limits, ParameterChange, ParameterResult

PERIOD = 0.1  # s until a value that `scl set` has changed is told


def limits_of(parameters: ConfigurationParameters) -> Limits:
    """The message with these values."""
    return Limits(
        home_latitude=parameters.home_latitude,
        home_longitude=parameters.home_longitude,
        home_altitude=parameters.home_altitude,
        fence_radius=parameters.fence_radius,
        fence_height=parameters.fence_height,
        speed=parameters.speed,
        climb=parameters.climb,
    )


def tell(component: Configuration) -> None:
    # The gate is latched: components that start later get it, too.
    limits = limits_of(component.parameters)
    component.limits.send(limits)
    print(f"the fence is {limits.fence_radius:g} m around home and {limits.fence_height:g} m high", flush=True)


def run(component: Configuration) -> None:
    tell(component)
    while True:
        step(component)


def step(component: Configuration) -> None:
    """Waits a little for a request, and tells what has changed."""
    try:
        request = component.control.recv(timeout=PERIOD)
    except scl.Timeout:
        request = None
    refused = change(component, request.message) if request else None
    if component.update_parameters():
        # Before the reply, so that the requester finds the value in effect.
        tell(component)
    if request:
        # A requester that has gone no longer waits for the reply.
        with suppress(scl.RequesterGone):
            request.reply(ParameterResult(accepted=refused is None, reason=refused or ""))


def change(component: Configuration, wanted: ParameterChange) -> str | None:
    """Sets a parameter. Returns the reason if it cannot."""
    try:
        component.set_parameter(wanted.name, repr(wanted.value))
    except ValueError as error:
        print(f"refused: {error}", flush=True)
        return str(error)
    return None


def main() -> int:
    with Configuration() as component:
        run(component)
    return 0


if __name__ == "__main__":
    sys.exit(main())
