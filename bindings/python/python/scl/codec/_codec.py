"""The interface of codecs, and their errors."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from scl._errors import DecodeError


class Codec:
    """Encodes the messages of one gate into frames and decodes them."""

    __slots__ = ("decode", "encode", "name", "owner", "type")

    def __init__(
        self,
        name: str,
        type: type[Any],
        encode: Callable[[Any], bytes],
        decode: Callable[[bytes], Any],
        owner: Owner,
    ) -> None:
        self.name = name
        """As in the topology file: `json`."""
        self.type = type
        """The class of the messages: a protobuf message class, `bytes`, or `object` for plain values."""
        self.encode = encode
        """Returns the frame of a message.

        Raises `TypeError` for a message of another class, and `EncodeError` for a value that the codec cannot represent.
        """
        self.decode = decode
        """Returns the message of a frame. Raises `DecodeError` for every frame that is not a message, and counts it."""
        self.owner = owner
        """The gate."""


class Owner:
    """The gate that a codec belongs to."""

    __slots__ = ("gate", "peers", "rejected")

    def __init__(self, gate: str, peers: Sequence[str] = ()) -> None:
        self.gate = gate
        """Its name, for messages: `controller.sensor`."""
        self.peers = peers
        """The gates from which frames arrive."""
        self.rejected = 0
        """How many frames were not messages."""

    def undecodable(self, reason: object) -> DecodeError:
        """Counts a frame, and returns the error that names the gate and its peers."""
        self.rejected += 1
        senders = f" from {', '.join(f'`{peer}`' for peer in self.peers)}" if self.peers else ""
        error = DecodeError(f"gate `{self.gate}` received an undecodable message{senders}: {reason}")
        error.reason = str(reason)
        return error


def kind_of(value: object) -> str:
    """Returns the class of a value, for messages: for a protobuf message, its full name."""
    descriptor = getattr(value, "DESCRIPTOR", None)
    name = getattr(descriptor, "full_name", None)
    if isinstance(value, type):
        return f"the class `{name or value.__qualname__}` itself"
    return f"`{name or type(value).__qualname__}`"
