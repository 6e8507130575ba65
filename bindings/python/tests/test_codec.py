"""Codecs: what they accept, what they refuse, and in which words."""

import array
import builtins
import collections
import ctypes
import dataclasses
import datetime
import decimal
import enum
import fractions
import ipaddress
import json
import math
import mmap
import re
import struct
import sys
import uuid
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypedDict

import cbor2
import msgpack
import numpy
import pytest
import scl
from google.protobuf import descriptor_pb2, timestamp_pb2
from scl.codec import Codec, MessageClasses, codec_of, messages_of_descriptors

VALUES = ["json", "cbor", "msgpack"]


def schema(package: str = "nav", *, fields: Sequence[str] = ("number",), imports: Sequence[str] = ()) -> bytes:
    """Returns a descriptor set with a message `Fix` that has these fields, all of them `int64`."""
    file = descriptor_pb2.FileDescriptorProto(name="nav.proto", package=package, syntax="proto3", dependency=imports)
    message = file.message_type.add(name="Fix")
    for number, name in enumerate(fields, 1):
        message.field.add(name=name, number=number, type="TYPE_INT64", label="LABEL_OPTIONAL")
    files = [file]
    if imports:
        message.field.add(
            name="at", number=100, type="TYPE_MESSAGE", type_name=".google.protobuf.Timestamp", label="LABEL_OPTIONAL"
        )
        well_known = descriptor_pb2.FileDescriptorProto()
        timestamp_pb2.DESCRIPTOR.CopyToProto(well_known)
        files.insert(0, well_known)
    return descriptor_pb2.FileDescriptorSet(file=files).SerializeToString()


MESSAGES: MessageClasses = messages_of_descriptors([schema()])
Fix: Any = MESSAGES.message("nav.Fix")


def codec(name: str, type: str | None = "Position", messages: MessageClasses | None = None) -> Codec:
    return codec_of("gps.position", name, type, messages, peers=["hub.a", "hub.b"])


@dataclasses.dataclass
class Position:
    latitude: float
    tags: list[str]
    inner: "Position | None" = None
    raw: bytes = b""


class Plain(TypedDict):
    latitude: float


class Mode(enum.StrEnum):
    FAST = "fast"


@pytest.mark.parametrize("name", VALUES)
def test_values_come_back_as_plain_values(name: str) -> None:
    values: list[object] = [
        None,
        True,
        -1,
        2**63,
        0.1,
        "läuft 😀\n\0",
        [],
        {},
        {"a": [1, {"b": None}]},
        [1, [2, [3]]],
        Plain(latitude=1.5),
    ]
    for value in values:
        frame = codec(name).encode(value)
        assert codec(name).decode(frame) == value
    assert codec(name).decode(codec(name).encode((1, 2))) == [1, 2]
    assert codec(name).decode(codec(name).encode(Mode.FAST)) == "fast"


@pytest.mark.parametrize("name", VALUES)
def test_dataclasses_are_maps_of_their_fields(name: str) -> None:
    value = Position(0.5, ["a"], Position(1.5, []), b"\xff")
    found = codec(name).decode(codec(name).encode([value]))
    raw, empty = ([255], []) if name == "json" else (b"\xff", b"")
    inner = {"latitude": 1.5, "tags": [], "inner": None, "raw": empty}
    assert found == [{"latitude": 0.5, "tags": ["a"], "inner": inner, "raw": raw}]


@pytest.mark.parametrize("name", ["cbor", "msgpack"])
def test_binary_codecs_carry_every_float(name: str) -> None:
    values: list[float] = [math.nan, math.inf, -math.inf, 0.1, -0.0]
    frame = codec(name).encode({"values": values})
    found = codec(name).decode(frame)["values"]
    assert math.isnan(found[0]) and found[1:] == values[1:]
    assert codec(name).decode(codec(name).encode({1: "one"})) == {1: "one"}


@pytest.mark.parametrize("value", [math.nan, math.inf, {"a": [-math.inf]}])
def test_json_has_no_nan(value: object) -> None:
    with pytest.raises(scl.EncodeError, match=r"gate `gps.position` cannot send .* JSON of `Position`"):
        codec("json").encode(value)
    for text in [b"NaN", b"[Infinity]", b'{"a": -Infinity}']:
        with pytest.raises(scl.DecodeError):
            codec("json").decode(text)


class Pair(NamedTuple):
    left: object
    right: object


UNDOCUMENTED: list[object] = [
    {1, 2},
    frozenset([1]),
    decimal.Decimal("1.5"),
    fractions.Fraction(1, 2),
    complex(1, 2),
    datetime.datetime(2026, 11, 23, tzinfo=datetime.UTC),
    datetime.date(2026, 11, 23),
    uuid.UUID(int=1),
    re.compile("a"),
    ipaddress.ip_address("127.0.0.1"),
    cbor2.CBORTag(1, 2),
    cbor2.CBORSimpleValue(9),
    cbor2.undefined,
    msgpack.ExtType(1, b"a"),
    msgpack.Timestamp(1, 2),
    range(3),
    collections.deque([1]),
    memoryview(b"a"),
    numpy.int64(1),
    numpy.zeros(2),
    enum.Enum("Color", "RED")["RED"],
    ...,
]


@pytest.mark.parametrize("name", VALUES)
@pytest.mark.parametrize("value", UNDOCUMENTED, ids=lambda value: type(value).__name__)
def test_what_is_not_documented_is_refused_with_its_path(name: str, value: object) -> None:
    if name != "msgpack" and isinstance(value, msgpack.ExtType):
        # For the others it is a named tuple.
        assert codec("json").encode(Pair(1, [2])) == b"[1,[2]]"
        return
    places: list[tuple[object, str]] = [
        (value, ""),
        ([0, value], " at `message[1]`"),
        ({"a": [{"b": (value,)}]}, " at `message['a'][0]['b'][0]`"),
        (Pair(1, value), " at `message[1]`"),
        ([Position(1.5, [], value)], " at `message[0].inner`"),  # type: ignore[arg-type]
    ]
    for message, place in places:
        with pytest.raises(TypeError) as error:
            codec(name).encode(message)
        assert f"`{place} is neither a plain value nor a dataclass" in str(error.value), error.value
        assert str(error.value).startswith("gate `gps.position` cannot send this value as the ")


@pytest.mark.parametrize("name", VALUES)
def test_integers_have_64_bits(name: str) -> None:
    one = codec(name)
    for value in [-(2**63), 2**64 - 1, enum.IntEnum("Level", {"HIGH": 2**64 - 1})["HIGH"], True]:
        assert one.decode(one.encode({"a": value})) == {"a": value}
    for value in [-(2**63) - 1, 2**64, 2**70, enum.IntEnum("Level", {"HIGH": 2**64})["HIGH"]]:
        with pytest.raises(scl.EncodeError, match="the integer at `message\\['a'\\]` is not between -2\\*\\*63 and 2"):
            one.encode({"a": value})


def test_keys_of_json_are_texts() -> None:
    assert codec("json").encode({1: "a", "b": Mode.FAST, Mode.FAST: 1}) == b'{"1":"a","b":"fast","fast":1}'
    for key in [None, 1.5, (1, 2)]:
        with pytest.raises(TypeError, match="a key at `message\\[0\\]` is .*; JSON keys must be `str` or `int`"):
            codec("json").encode([{key: 1}])
    with pytest.raises(scl.EncodeError, match="`nan` at `message\\['a'\\]` is not a JSON number"):
        codec("json").encode({"a": math.nan})
    for name in ["cbor", "msgpack"]:
        with pytest.raises(TypeError, match="`Fraction` at `message.keys\\(\\)` is neither"):
            codec(name).encode({fractions.Fraction(1, 2): 1})


class Other:
    pass


@pytest.mark.parametrize("name", VALUES)
@pytest.mark.parametrize("value", [Other(), {"a": Other()}, Position, object()])
def test_other_objects_are_refused(name: str, value: object) -> None:
    with pytest.raises(TypeError) as error:
        codec(name).encode(value)
    assert "gate `gps.position` cannot send this value" in str(error.value)
    assert "neither a plain value nor a dataclass" in str(error.value)


@pytest.mark.parametrize("name", VALUES)
def test_values_too_deep_or_circular_are_refused(name: str) -> None:
    circle: list[object] = []
    circle.append(circle)
    with pytest.raises(scl.EncodeError):
        codec(name).encode(circle)


@pytest.mark.parametrize("name", VALUES)
def test_protobuf_messages_are_not_values(name: str) -> None:
    with pytest.raises(TypeError, match=r"`nav.Fix` is neither a plain value nor a dataclass"):
        codec(name).encode(Fix(number=1))


UNDECODABLE: Mapping[str, list[bytes]] = {
    "json": [b"", b"{", b"1 2", b"\xff", b"[" * 100_000, b'"\xed\xa0\x80"', b"\xef\xbb\xbf1", '"a"'.encode("utf-16")],
    "cbor": [
        b"",
        b"\x82\x01",
        b"\x01\x02",
        b"\xff",
        b"\x81" * 100_000,
        bytes.fromhex("9b0fffffffffffffff"),
        b"\xc1\xff",
    ],
    "msgpack": [
        b"",
        b"\x92\x01",
        b"\x01\x02",
        b"\xc1",
        b"\x91" * 100_000,
        bytes.fromhex("df80000000"),
        b"\x81\x90\x01",
    ],
}


@pytest.mark.parametrize("name", VALUES)
def test_undecodable_frames_are_counted_and_name_gate_and_senders(name: str) -> None:
    one = codec(name)
    for count, frame in enumerate(UNDECODABLE[name], 1):
        with pytest.raises(scl.DecodeError) as error:
            one.decode(frame)
        text = str(error.value)
        assert text.startswith(
            f"gate `gps.position` received an undecodable message from `hub.a`, `hub.b`: these {len(frame)}"
        ) or ("data follows" in text)
        assert one.owner.rejected == count


@pytest.mark.parametrize("name", ["protobuf", "json"])
def test_messages_of_schemas(name: str) -> None:
    one = codec(name, "nav.Fix", MESSAGES)
    assert one.type is Fix
    message = Fix(number=2**62)
    assert one.decode(one.encode(message)) == message
    if name == "json":
        assert one.encode(message) == b'{"number":"4611686018427387904"}'
        assert one.decode(b'{"number": 5, "added": {}}') == Fix(number=5)
    other = messages_of_descriptors([schema(fields=["number", "more"])])
    refused: list[tuple[object, str]] = [
        (3, "gate `gps.position` carries `nav.Fix`, not `int`"),
        (None, "not `NoneType`"),
        ({"number": 3}, "not `dict`"),
        (Fix, "not the class `nav.Fix` itself"),
        (timestamp_pb2.Timestamp(), "not `google.protobuf.Timestamp`"),
        (other.message("nav.Fix")(), "this is a `nav.Fix` of another module or topology"),
    ]
    for value, words in refused:
        with pytest.raises(TypeError) as error:
            one.encode(value)
        assert words in str(error.value)
    for frame in [b"\x08", b"\xff" * 20]:
        with pytest.raises(scl.DecodeError, match=r"gate `gps.position` received an undecodable message from `hub.a`"):
            one.decode(frame)
    assert one.owner.rejected == 2


def test_a_text_that_is_not_utf_8_is_named() -> None:
    file = descriptor_pb2.FileDescriptorProto(name="log.proto", package="log", syntax="proto3")
    event = file.message_type.add(name="Event")
    event.field.add(name="raw", number=1, type="TYPE_BYTES", label="LABEL_OPTIONAL")
    event.field.add(name="text", number=2, type="TYPE_STRING", label="LABEL_REPEATED")
    event.field.add(name="inner", number=3, type="TYPE_MESSAGE", type_name=".log.Event", label="LABEL_OPTIONAL")
    messages = messages_of_descriptors([descriptor_pb2.FileDescriptorSet(file=[file]).SerializeToString()])
    one = codec("protobuf", "log.Event", messages)
    assert one.decode(b"\x0a\x01\xff\x12\x02\xc3\xa4").text == ["ä"]
    for frame, field in [
        (b"\x12\x01\xff", "text"),
        (b"\x0a\x01\xff\x12\x01a\x12\x01\xc3", "text"),
        (b"\x1a\x05\x1a\x03\x12\x01\xff", "inner.inner.text"),
        (b"\x20\x85\x02\x29\0\0\0\0\0\0\0\0\x1a\x03\x12\x01\xff", "inner.text"),
    ]:
        with pytest.raises(scl.DecodeError, match=f"do not decode as `log.Event`: its field `{field}` is not UTF-8"):
            one.decode(frame)
    for frame in [b"\x12\x05\xff", b"\x12", b"\xff" * 20, b"\x1a\x7f\x12\x01\xff"]:
        with pytest.raises(scl.DecodeError, match="do not decode as `log.Event`$"):
            one.decode(frame)


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b"[]",
        b"null",
        b"{} {}",
        b"\xff",
        b'{"number": NaN}',
        b'{"number": 1.5}',
        b'{"number": "one"}',
        b'{"number": 9223372036854775808}',
        b'{"number": {}}',
        b'{"x": ' + b"[" * 100_000,
    ],
)
def test_texts_that_are_not_canonical_json_are_refused(text: bytes) -> None:
    with pytest.raises(scl.DecodeError, match="received an undecodable message"):
        codec("json", "nav.Fix", MESSAGES).decode(text)


def test_every_buffer_is_bytes() -> None:
    one = codec("raw", None)
    assert one.type is bytes
    grid = numpy.arange(6, dtype="<u2").reshape(2, 3)
    values: list[tuple[Any, bytes]] = [
        (b"a", b"a"),
        (bytearray(b"a"), b"a"),
        (memoryview(b"a"), b"a"),
        (memoryview(b""), b""),
        (array.array("H", [1, 2]), struct.pack("=HH", 1, 2)),
        ((ctypes.c_uint8 * 2)(1, 2), b"\1\2"),
        (mmap.mmap(-1, 3), bytes(3)),
        (grid, struct.pack("<6H", *range(6))),
        (numpy.float32(1.5), struct.pack("=f", 1.5)),
        # What is not contiguous is copied, element by element in the order of the indices.
        (memoryview(b"abcdef")[::2], b"ace"),
        (grid[:, 1], struct.pack("<2H", 1, 4)),
        (grid.T, struct.pack("<6H", 0, 3, 1, 4, 2, 5)),
        (numpy.asfortranarray(grid), struct.pack("<6H", *range(6))),
    ]
    for value, expected in values:
        assert one.encode(value) == expected and type(one.encode(value)) is bytes
    released = memoryview(b"a")
    released.release()
    refused: list[tuple[object, str]] = [
        ("a", "not `str`; use its method `encode` first"),
        (3, "not `int`"),
        ([1], "not `list`"),
        (None, "not `NoneType`"),
        (numpy.array([object()]), "not `ndarray` of Python objects"),
        (numpy.array(["2026-11-23"], dtype="datetime64[D]"), "not `ndarray`: "),
        (released, "not `memoryview`: "),
    ]
    for value, words in refused:
        with pytest.raises(TypeError, match="gate `gps.position` carries bytes") as error:
            one.encode(value)
        assert words in str(error.value)


@pytest.mark.parametrize(
    ("name", "type", "words"),
    [
        ("postcard", "Position", "`postcard` is for Rust programs; use `json`, `cbor` or `msgpack`"),
        ("raw", "Position", "`raw` is the memory layout of a Rust type"),
        ("my_crate::Flat", "Position", "the codec `my_crate::Flat` is Rust code"),
        ("protobuf", "nav.Position", "the type `nav.Position` is not in `schemas:`"),
        ("cbor", "nav.Fix", "the codec `cbor` does not carry messages of schemas"),
    ],
)
def test_codecs_of_rust_are_refused(name: str, type: str, words: str) -> None:
    with pytest.raises(scl.UnsupportedCodecError) as error:
        codec(name, type, MESSAGES)
    assert "Python cannot open gate `gps.position`" in str(error.value)
    assert words in str(error.value)


@pytest.mark.parametrize(("name", "package"), [("cbor", "cbor2"), ("msgpack", "msgpack")])
def test_a_missing_package_names_the_extra(name: str, package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(scl.UnsupportedCodecError) as error:
        codec(name)
    assert f"needs the package `{package}`: pip install 'scl[{name}]'" in str(error.value)


def test_equal_schemas_have_equal_classes() -> None:
    assert messages_of_descriptors([schema()]).message("nav.Fix") is Fix
    # Files of one name in two systems may differ.
    other = messages_of_descriptors([schema(fields=["a", "b"])])
    assert other.message("nav.Fix") is not Fix
    with pytest.raises(scl.UnsupportedCodecError, match=r"the schemas do not declare the message `nav.Fxi`"):
        other.message("nav.Fxi")


def test_well_known_types_are_those_of_protobuf() -> None:
    imports = ["google/protobuf/timestamp.proto"]
    first, second = (
        messages_of_descriptors([schema("clock", fields=fields, imports=imports)]).message("clock.Fix")
        for fields in [["a"], ["b"]]
    )
    message: Any = first(a=1, at=timestamp_pb2.Timestamp(seconds=5))
    assert type(message.at) is timestamp_pb2.Timestamp
    # The second has a file and a message of the same names, so protobuf's own pool does not take it.
    again: Any = second(b=1)
    again.at.FromSeconds(5)
    assert again.at.ToSeconds() == 5


def test_bytes_need_no_protobuf(monkeypatch: pytest.MonkeyPatch) -> None:
    real: Callable[..., Any] = builtins.__import__

    def refuse(name: str, *arguments: Any, **more: Any) -> Any:
        assert not name.startswith("google"), name
        return real(name, *arguments, **more)

    monkeypatch.setattr(builtins, "__import__", refuse)
    assert codec("raw", None).decode(b"a") == b"a"
    assert json.loads(codec("json").encode([1])) == [1]
    assert cbor2.loads(codec("cbor").encode([1])) == [1]
