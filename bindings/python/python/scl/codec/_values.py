"""JSON, CBOR and MessagePack for types that are not in `schemas:`: plain Python values.

Values to send may contain dataclasses, which become maps of their fields, like structs in serde. Received values
consist of `dict`, `list`, `str`, `int`, `float`, `bool`, `None`, and for CBOR and MessagePack `bytes`.
"""

from __future__ import annotations

import importlib
import io
from typing import Any, NoReturn

from scl._errors import EncodeError, UnsupportedCodecError
from scl.codec import _plain
from scl.codec._codec import Codec, Owner, kind_of


def json_values(owner: Owner, name: str) -> Codec:
    """Returns the codec `json` for plain values."""
    import json

    def plain(value: object) -> object:
        # As in serde: JSON has no bytes.
        return list(value) if isinstance(value, bytes | bytearray) else _fields(value)

    # Made once: `json.dumps` and `json.loads` with options would make new ones each time.
    to_text = json.JSONEncoder(separators=(",", ":"), ensure_ascii=False, allow_nan=False, default=plain).encode
    from_text = json.JSONDecoder(parse_constant=_no_constant).decode

    def encode(value: object) -> bytes:
        _plain.check(owner.gate, name, "JSON", value)
        try:
            return to_text(value).encode()
        except (TypeError, ValueError, RecursionError) as error:
            raise _refused(owner.gate, name, "JSON", value, error) from error

    def decode(frame: bytes) -> object:
        try:
            return from_text(frame.decode())
        except (ValueError, RecursionError) as error:
            raise owner.undecodable(f"these {len(frame)} bytes are not JSON: {error}") from error

    return Codec("json", object, encode, decode, owner)


def cbor(owner: Owner, name: str) -> Codec:
    """Returns the codec `cbor`. Needs the package `cbor2`."""
    cbor2 = _extra("cbor2", "cbor", owner.gate)

    def encode(value: object) -> bytes:
        _plain.check(owner.gate, name, "CBOR", value)
        try:
            frame: bytes = cbor2.dumps(value, default=fields)
        except (TypeError, ValueError, RecursionError, cbor2.CBOREncodeError) as error:
            raise _refused(owner.gate, name, "CBOR", value, error) from error
        return frame

    def fields(encoder: Any, value: object) -> None:
        encoder.encode(_fields(value))

    def decode(frame: bytes) -> object:
        input = io.BytesIO(frame)
        try:
            value: object = cbor2.CBORDecoder(input).decode()
        # Tags make the decoder build dates, regular expressions and more, whose errors it lets through.
        except Exception as error:
            raise owner.undecodable(f"these {len(frame)} bytes are not CBOR: {error}") from error
        if input.tell() != len(frame):
            raise owner.undecodable(f"data follows the CBOR item in this {len(frame)}-byte frame")
        return value

    return Codec("cbor", object, encode, decode, owner)


def msgpack(owner: Owner, name: str) -> Codec:
    """Returns the codec `msgpack`. Needs the package `msgpack`."""
    library = _extra("msgpack", "msgpack", owner.gate)

    # A named tuple and another class of the library; both become extensions.
    refused = (library.ExtType, library.Timestamp)

    def encode(value: object) -> bytes:
        _plain.check(owner.gate, name, "MessagePack", value, refused)
        try:
            frame: bytes = library.packb(value, default=_fields)
        except (TypeError, ValueError, OverflowError, RecursionError) as error:
            raise _refused(owner.gate, name, "MessagePack", value, error) from error
        return frame

    def decode(frame: bytes) -> object:
        try:
            # Maps of serde may have any key.
            value: object = library.unpackb(frame, strict_map_key=False)
        except Exception as error:
            reason = str(error) or type(error).__name__
            raise owner.undecodable(f"these {len(frame)} bytes are not MessagePack: {reason}") from error
        return value

    return Codec("msgpack", object, encode, decode, owner)


def _fields(value: object) -> dict[str, object]:
    """Returns the fields of a dataclass; values inside of them are encoded in turn."""
    import dataclasses

    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}
    raise TypeError(f"{kind_of(value)} is neither a plain value nor a dataclass")


def _refused(gate: str, name: str, format: str, value: object, error: Exception) -> Exception:
    _plain.raise_refusal(gate, name, format, value)
    text = f"gate `{gate}` cannot send this value as the {format} of `{name}`: {error}"
    return TypeError(text) if isinstance(error, TypeError) else EncodeError(text)


def _no_constant(constant: str) -> NoReturn:
    raise ValueError(f"`{constant}` is not JSON")


def _extra(package: str, extra: str, gate: str) -> Any:
    try:
        return importlib.import_module(package)
    except ImportError as error:
        raise UnsupportedCodecError(
            f"gate `{gate}` uses the codec `{extra}`, which needs the package `{package}`: pip install 'scl[{extra}]'"
        ) from error
