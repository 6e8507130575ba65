"""Protobuf, and canonical protobuf JSON: for the messages of `schemas:`."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, cast

from scl._errors import EncodeError
from scl.codec._codec import Codec, Owner, kind_of
from scl.codec._json_check import check
from scl.codec._text_check import wrong_text

if TYPE_CHECKING:
    from google.protobuf.descriptor import Descriptor
    from google.protobuf.message import Message


def protobuf(owner: Owner, message_class: type[Message]) -> Codec:
    """Returns the codec `protobuf` for a message class."""
    from google.protobuf import message

    name = message_class.DESCRIPTOR.full_name
    serialize, parse = message_class.SerializeToString, message_class.FromString

    def encode(value: Message) -> bytes:
        if type(value) is not message_class:
            raise wrong_class(owner.gate, name, value)
        try:
            return serialize(value)
        except message.EncodeError as error:
            # A field that proto2 requires has no value.
            raise EncodeError(f"gate `{owner.gate}` cannot send this `{name}`: {error}") from error

    def decode(frame: bytes) -> Message:
        try:
            return parse(frame)
        except message.DecodeError as error:
            field = wrong_text(cast("Descriptor", message_class.DESCRIPTOR), frame)
            reason = "" if field is None else f": its field `{field}` is not UTF-8"
            raise owner.undecodable(f"these {len(frame)} bytes do not decode as `{name}`{reason}") from error

    return Codec("protobuf", message_class, encode, decode, owner)


def canonical_json(owner: Owner, message_class: type[Message]) -> Codec:
    """Returns the codec `json` for a message class: https://protobuf.dev/programming-guides/json.

    Fields that the class does not know are skipped, as in `protobuf`: a newer program may send them.
    """
    import json

    from google.protobuf import json_format

    # Stubs of protobuf also name the class of its native part, which has the same attributes.
    descriptor = cast("Descriptor", message_class.DESCRIPTOR)
    name = descriptor.full_name
    needs_check = any(f.enum_type or f.message_type or f.type == f.TYPE_BYTES for f in descriptor.fields)
    to_dict: Callable[[Message], object] = json_format.MessageToDict
    # Made once: `json.dumps` with options would make a new one each time.
    to_text = json.JSONEncoder(separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode

    def encode(value: Message) -> bytes:
        if type(value) is not message_class:
            raise wrong_class(owner.gate, name, value)
        try:
            return to_text(to_dict(value)).encode()
        except (json_format.Error, ValueError, TypeError) as error:
            # A time outside of the years 1 to 9999, for example.
            raise EncodeError(f"gate `{owner.gate}` cannot send this `{name}` as JSON: {error}") from error

    def decode(frame: bytes) -> Message:
        try:
            text = frame.decode()
            if not text.lstrip(" \t\r\n").startswith("{"):
                # The parser accepts an empty list as a message.
                raise ValueError("it is not a JSON object")
            message = json_format.Parse(text, message_class(), ignore_unknown_fields=True)
            if needs_check:
                check(descriptor, json.loads(text))
            return message
        # The parser lets errors of its parts through, even `RecursionError` and `AttributeError`.
        except Exception as error:
            raise owner.undecodable(f"these {len(frame)} bytes are not the JSON of a `{name}`: {error}") from error

    return Codec("json", message_class, encode, decode, owner)


def wrong_class(gate: str, expected: str, value: object) -> TypeError:
    """Returns the error for a message of another class."""
    found = kind_of(value)
    if found == f"`{expected}`":
        return TypeError(
            f"gate `{gate}` carries `{expected}`, and this is a `{expected}` of another module or topology; "
            "use the class of this component's module, or `type` of the gate"
        )
    return TypeError(f"gate `{gate}` carries `{expected}`, not {found}")
