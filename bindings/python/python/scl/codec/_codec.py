"""What a codec is, and how it fails."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


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
    """Returns the message of a frame. Raises `DecodeError` for every frame that is not a message."""


class EncodeError(ValueError):
    """A codec cannot represent a value."""


class DecodeError(ValueError):
    """A frame is not a message of the expected type."""


class UnsupportedCodecError(Exception):
    """Python cannot read the messages of a gate, or lacks a package for it."""


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
