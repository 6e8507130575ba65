"""Receiving where an undecodable message is reported and skipped instead of ending the program."""

import sys
from typing import TypeVar

import scl

T = TypeVar("T")


def newest(gate: scl.Sub[T]) -> T | None:
    """The newest message that has arrived since the last call, if there is one."""
    try:
        return gate.latest()
    except scl.DecodeError as error:
        print(error, file=sys.stderr, flush=True)
        return None


def next_within(gate: scl.Sub[T], seconds: float) -> T | None:
    """Waits for a message; `None` if none arrives in time."""
    try:
        return gate.recv(timeout=seconds)
    except scl.Timeout:
        return None
    except scl.DecodeError as error:
        print(error, file=sys.stderr, flush=True)
        return None
