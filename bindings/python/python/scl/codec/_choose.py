"""Chooses the codec of a gate."""

from __future__ import annotations

from collections.abc import Sequence

from scl._buffer import Buffer
from scl._errors import UnsupportedCodecError
from scl.codec import _protobuf, _values
from scl.codec._codec import Codec, Owner, kind_of
from scl.codec._messages import MessageClasses

_VALUES = {"json": _values.json_values, "cbor": _values.cbor, "msgpack": _values.msgpack}


def codec_of(
    gate: str, codec: str, name: str | None, messages: MessageClasses | None, peers: Sequence[str] = ()
) -> Codec:
    """Returns the codec for one direction of a gate.

    `gate` is `component.gate`, for errors. `codec` and `name` come from the plan: the codec's name, and the type, or
    `None` for bytes. `messages` are the schemas, if the component has any. `peers` are the gates from which frames
    arrive.

    Raises `UnsupportedCodecError` for messages that Python cannot read.
    """
    owner = Owner(gate, peers)
    if name is None:
        return _bytes(owner)
    message_class = messages.find(name) if messages else None
    if message_class is not None:
        if codec == "protobuf":
            return _protobuf.protobuf(owner, message_class)
        if codec == "json":
            return _protobuf.canonical_json(owner, message_class)
    elif codec in _VALUES:
        return _VALUES[codec](owner, name)
    raise _unsupported(gate, codec, name, is_message=message_class is not None)


def _bytes(owner: Owner) -> Codec:
    def encode(value: Buffer) -> bytes:
        if type(value) is bytes:
            return value
        try:
            view = memoryview(value)
        except (TypeError, ValueError, BufferError) as error:
            raise refused(value, error) from error
        if "O" in view.format:
            raise TypeError(f"gate `{owner.gate}` carries bytes, not {kind_of(value)} of Python objects")
        # Non-contiguous elements are copied in index order, as by an array's `tobytes`.
        return view.tobytes()

    def refused(value: object, error: Exception) -> TypeError:
        if isinstance(value, str):
            hint = "; use its method `encode` first"
        else:
            # A buffer that cannot give its bytes.
            hint = "" if isinstance(error, TypeError) else f": {error}"
        return TypeError(f"gate `{owner.gate}` carries bytes, not {kind_of(value)}{hint}")

    return Codec("bytes", bytes, encode, lambda frame: frame, owner)


def _unsupported(gate: str, codec: str, name: str, *, is_message: bool) -> UnsupportedCodecError:
    if is_message:
        reason = f"the codec `{codec}` does not carry messages of schemas; use `protobuf` or `json`"
    elif codec == "protobuf":
        reason = f"the type `{name}` is not in `schemas:`, so Python has no description of it"
    elif codec == "raw":
        reason = "`raw` is the memory layout of a Rust type; use `json`, `cbor` or `msgpack` between languages"
    elif codec == "postcard":
        reason = "`postcard` is for Rust programs; use `json`, `cbor` or `msgpack` between languages"
    else:
        reason = f"the codec `{codec}` is Rust code; use `protobuf`, `json`, `cbor` or `msgpack` between languages"
    return UnsupportedCodecError(f"Python cannot open gate `{gate}`: {reason}")
