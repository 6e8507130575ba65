"""What a codec is, and how it fails."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from scl._errors import DecodeError


@dataclass(frozen=True, slots=True)
class Codec:
    """Encodes the messages of one gate into frames and decodes them."""

    name: str
    """As in the topology file: `json`."""
    type: type[Any]
    """The class of the messages: a protobuf message class, `bytes`, or `object` for plain values."""
    encode: Callable[[Any], bytes]
    """Returns the frame of a message.

    Raises `TypeError` for a message of another class, and `EncodeError` for a value that the codec cannot represent.
    """
    decode: Callable[[bytes], Any]
    """Returns the message of a frame. Raises `DecodeError` for every frame that is not a message, and counts it."""
    owner: Owner
    """The gate."""


@dataclass(slots=True)
class Owner:
    """The gate for which a codec works."""

    gate: str
    """As messages name it: `controller.sensor`."""
    peers: Sequence[str] = ()
    """The gates from which frames arrive."""
    rejected: int = 0
    """How many frames were not messages."""

    def undecodable(self, reason: object) -> DecodeError:
        """Counts a frame, and returns the error that names the gate and its peers."""
        self.rejected += 1
        senders = f" from {', '.join(f'`{peer}`' for peer in self.peers)}" if self.peers else ""
        return DecodeError(f"gate `{self.gate}` received an undecodable message{senders}: {reason}")


def kind_of(value: object) -> str:
    """Returns the class of a value as messages name it: of a protobuf message, its full name."""
    descriptor = getattr(value, "DESCRIPTOR", None)
    name = getattr(descriptor, "full_name", None)
    if isinstance(value, type):
        return f"the class `{name or value.__qualname__}` itself"
    return f"`{name or type(value).__qualname__}`"


def is_protobuf_message(value: object) -> bool:
    """Returns true for protobuf messages, without importing protobuf for other values."""
    return hasattr(value, "DESCRIPTOR") and hasattr(value, "SerializeToString")
