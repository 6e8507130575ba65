"""Finds the text of a protobuf frame that is not UTF-8: the parser refuses the whole message and does not say why."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from google.protobuf.descriptor import Descriptor

# Length-delimited, the wire type of texts and messages.
_LENGTH = 2


def wrong_text(descriptor: Descriptor, frame: bytes) -> str | None:
    """Returns the path of the first text that is not UTF-8; `None` if there is none or damage before it."""
    at = 0
    try:
        while at < len(frame):
            key, at = _varint(frame, at)
            kind = key & 7
            if kind == _LENGTH:
                length, at = _varint(frame, at)
                end = at + length
                if end > len(frame):
                    return None
                found = _wrong_field(descriptor, key >> 3, frame[at:end])
                if found is not None:
                    return found
                at = end
            elif kind == 0:
                _, at = _varint(frame, at)
            elif kind in (1, 5):
                at += 8 if kind == 1 else 4
            else:
                return None
    except IndexError:
        pass
    return None


def _wrong_field(descriptor: Descriptor, number: int, content: bytes) -> str | None:
    field = descriptor.fields_by_number.get(number)
    if field is None:
        return None
    name: str = field.name
    if field.message_type is not None:
        inner = wrong_text(field.message_type, content)
        return None if inner is None else f"{name}.{inner}"
    if field.type == field.TYPE_STRING:
        try:
            content.decode()
        except UnicodeDecodeError:
            return name
    return None


def _varint(frame: bytes, at: int) -> tuple[int, int]:
    number = shift = 0
    while True:
        byte = frame[at]
        number |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80:
            return number, at
