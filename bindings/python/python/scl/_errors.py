"""Exceptions. Every text names the component, the gate and the peer, and says what to do."""

from __future__ import annotations

__all__ = [
    "Answered",
    "Busy",
    "Closed",
    "DecodeError",
    "EncodeError",
    "Error",
    "Forked",
    "Full",
    "InternalError",
    "NoneReceived",
    "NotFlushed",
    "NotReady",
    "OpenError",
    "PeerLost",
    "PlanError",
    "Refused",
    "RequesterGone",
    "Stopped",
    "Timeout",
    "TooLong",
    "TopologyError",
    "UnknownComponent",
    "UnknownGate",
    "UnsupportedCodecError",
    "WrongDirection",
]


class Error(Exception):
    """The base of all exceptions of this package except `Stopped`."""


class TopologyError(Error):
    """The topology file has errors. The text is that of `scl check`."""


class PlanError(Error):
    """The plan is damaged, has another format version, or contradicts itself."""


class UnknownComponent(Error, LookupError):
    """The system has no component with this name."""


class OpenError(Error):
    """The component cannot be opened: it is already running, or the runtime folder cannot be used."""


class UnsupportedCodecError(OpenError):
    """Python cannot read the messages of a gate, or lacks a package for it."""


class UnknownGate(Error, AttributeError):
    """The component has no gate with this name."""


class WrongDirection(Error, AttributeError):
    """A gate of this kind has no such call."""


class Timeout(Error, TimeoutError):
    """The time limit of a call has expired."""


class NotReady(Timeout):
    """Not all required peers connected in time."""


class NotFlushed(Timeout):
    """Not all peers took all messages in time."""


class Full(Timeout):
    """A peer's queue is full. The message was sent to no peer."""


class TooLong(Error, ValueError):
    """The message is longer than a peer accepts. It was sent to no peer."""


class EncodeError(Error, ValueError):
    """A codec cannot represent a value."""


class DecodeError(Error, ValueError):
    """A frame is not a message of the expected type. The next call returns the next message."""

    reason: str = ""
    """Why, without the names of the gate and its peers."""


class Refused(Error, ValueError):
    """The replier could not decode the request, so it did not act on it."""


class NoneReceived(Error, ValueError):
    """`try_recv` or `latest` took the message `None`, which also stands for no message. Give them another default."""


class PeerLost(Error, ConnectionError):
    """The replier disconnected after the request was sent; whether it acted on the request is unknown."""


class RequesterGone(Error, ConnectionError):
    """The requester has disconnected and does not wait for the reply any more."""


class Answered(Error, RuntimeError):
    """The request was already answered."""


class Busy(Error, RuntimeError):
    """Another thread or task uses the gate."""


class Closed(Error, RuntimeError):
    """The component is closed."""


class Forked(Error, RuntimeError):
    """The component belongs to the parent process."""


class Stopped(BaseException):
    """SIGTERM or SIGINT asked the program to stop. Where nothing catches it, the program ends with exit code 0.

    It is neither an `Error` nor an `Exception`, so that a loop that logs errors and continues does not swallow it.
    """


class InternalError(Error):
    """A bug in SCL."""
