"""Receiving within a time, where silence is no error."""

from typing import TypeVar

import scl

T = TypeVar("T")


def next_within(gate: scl.Sub[T], seconds: float) -> T | None:
    """Waits for a message; `None` if none arrives in time."""
    try:
        return gate.recv(timeout=seconds)
    except scl.Timeout:
        return None
