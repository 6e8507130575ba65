"""Receiving where an undecodable message is reported and skipped instead of ending the program."""

import sys
from collections.abc import AsyncIterator
from typing import TypeVar

import scl

A = TypeVar("A")
B = TypeVar("B")
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


async def messages(gate: scl.Sub[T]) -> AsyncIterator[T]:
    """All messages until the component is closed or the program is asked to stop."""
    while True:
        try:
            message = await gate.recv_async()
        except scl.DecodeError as error:
            print(error, file=sys.stderr, flush=True)
        except (scl.Closed, scl.Stopped):
            return
        else:
            yield message


async def requests(gate: scl.Rep[A, B]) -> AsyncIterator[scl.Request[A, B]]:
    """All requests until the component is closed or the program is asked to stop."""
    while True:
        try:
            request = await gate.recv_async()
        except scl.DecodeError as error:
            print(error, file=sys.stderr, flush=True)
        except (scl.Closed, scl.Stopped):
            return
        else:
            yield request
