"""Messages: fields of every sort."""

from array import array
from collections.abc import MutableSequence
from typing import Any, assert_type

import scl
from everything_scl import (
    Everything,
    Import,
    Job,
    Kind,
    Level,
    Old,
    Sink,
    Source,
    Word,
    class_,
    every_Status,
    second_Status,
)
from google.protobuf.duration_pb2 import Duration
from google.protobuf.message import Message
from google.protobuf.struct_pb2 import Struct
from google.protobuf.timestamp_pb2 import Timestamp

message = Everything(a_double=1, an_int32=2, a_string="a", some_bytes=b"b", level=Level.LEVEL_HIGH)
base: Message = message
frame: bytes = message.SerializeToString()
assert_type(Everything.FromString(frame), Everything)

# Singular fields.
assert_type(message.a_double, float)
assert_type(message.a_uint64, int)
assert_type(message.a_bool, bool)
assert_type(message.a_string, str)
assert_type(message.some_bytes, bytes)
message.a_float = 3
message.an_int32 = 1.5  # error: float int
message.a_string = b"bytes"  # error: bytes str
message.a_sring = "misspelt"  # error: a_sring
Everything(a_dubble=1.0)  # error: a_dubble
Everything(some_bytes="text")  # error: bytes
Everything(1.0)  # error: argument
message.maybe = 1

# Enums.
assert_type(message.level, Level)
assert_type(Level.Name(message.level), str)
assert_type(Level.Value("LEVEL_LOW"), Level)
assert_type(Level.items(), list[tuple[str, Level]])
message.level = Level.LEVEL_HIHG  # error: LEVEL_HIHG
message.level = Everything.Inner.COLOR_RED  # error: Color Level
message.level = 1  # error: Level
Level(1)  # error: Never
assert_type(Everything.Inner.COLOR_RED, Everything.Inner.Color)
number: int = message.level

# Messages inside of messages.
assert_type(message.inner, Everything.Inner)
assert_type(message.inner.outer.inner.color, Everything.Inner.Color)
message.inner.CopyFrom(Everything.Inner(text="a"))
message.inner.CopyFrom(Job())  # error: Job Inner
message.inner = Everything.Inner()  # error: inner
message.inner.texd = ""  # error: texd

# Lists and maps.
numbers: MutableSequence[int] = message.numbers
message.numbers.append(1)
message.numbers.append("1")  # error: int
message.levels.extend([Level.LEVEL_LOW])
assert_type(message.inners.add(), Everything.Inner)
assert_type(message.inners[0].text, str)
assert_type(message.by_name["a"], Everything.Inner)
message.by_name[1]  # error: str
message.by_number[1] = True
message.by_number[1] = "yes"  # error: bool
Everything(numbers=[1, 2], by_number={1: True}, inners=[Everything.Inner()])
Everything(numbers=["1"])  # error: int

# Presence.
assert_type(message.HasField("maybe"), bool)
message.HasField("choice")
message.HasField("a_double")  # error: a_double HasField
message.ClearField("numbers")
message.ClearField("number")  # error: number ClearField
choice = message.WhichOneof("choice")
if choice == "as_text":
    assert_type(message.as_text, str)
elif choice is not None:
    message.WhichOneof("other")  # error: WhichOneof
Job().HasField("number")  # error: HasField

# Well-known types.
assert_type(message.at, Timestamp)
assert_type(message.took, Duration)
assert_type(message.any_object, Struct)
message.at.GetCurrentTime()
Everything(at=Timestamp(seconds=1))
Everything(at=Duration())  # error: Duration Timestamp

# Messages of one name in two packages, and proto2.
source = Source()
assert_type(source.question.call(every_Status(is_ready=True)), second_Status)
source.question.call(second_Status())  # error: second_Status every_Status
old = Old(number=1, int="one", Kind=[Kind(name="a")])
assert_type(old.number, int)
assert_type(old.int, str)
assert_type(old.Kind[0], Kind)
assert_type(old.part.list, bool)
assert_type(old.word, Word)
assert_type(old.inner_word, Old.Word)
old.word = Old.Word.FALSE  # error: Word
class_(otherwise=True).WhichOneof("iff")  # error: iff

# Gates with names of Python and of components, and gates that Python cannot open.
other = Import()
assert_type(other.from_, scl.Pub[Job])
assert_type(other.close_, scl.Pub[Job])
assert_type(other.my_gate, scl.Sub[Job])
other.close()
source.fix_postcard.send(b"")  # error: Never

# Bytes, and plain values.
sink = Sink()
assert_type(sink.frames.recv(), bytes)
for buffer in (b"a", bytearray(b"a"), memoryview(b"a"), array("H", [1])):
    source.frames.send(buffer)
source.frames.send("text")  # error: Buffer
source.frames.send([1])  # error: list Buffer
assert_type(source.echo.call(bytearray(b"?")), bytes)
for asked in sink.echo:
    assert_type(asked.message, bytes)
    asked.reply(memoryview(b"!"))
    asked.reply("text")  # error: Buffer
assert_type(sink.fix_cbor.recv(), Any)
source.fix_json.send({"latitude": 50.7, "longitude": 10.9})
