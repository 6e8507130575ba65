"""The paper's Table II in Python: the time to pack and unpack a tuple of booleans, an integer, a string and a float.

    python bench/python/codecs.py [--iterations 10000] [--rounds 5]

`pack` goes from the values to a frame, `unpack` from a frame to the values, so `protobuf` and `json of a message` contain the
message between them; `(message only)` does not. Codecs take turns, and the best round of each counts. pickle and XML are for
comparison: SCL does not offer them.
"""

import argparse
import dataclasses
import math
import pickle
import time
import xml.etree.ElementTree as ET
from collections.abc import Callable
from typing import Any

from google.protobuf import descriptor_pb2
from scl.codec import codec_of, messages_of_descriptors

Record = tuple[bool, bool, int, str, float]

RECORD: Record = (True, False, 42, "gps", 3.14159)

# In the order of the record, as in the schema of a topology.
FIELDS = {
    "valid": "TYPE_BOOL",
    "differential": "TYPE_BOOL",
    "satellites": "TYPE_INT32",
    "receiver": "TYPE_STRING",
    "height": "TYPE_DOUBLE",
}

# Table II of the paper: bytes, milliseconds to encode and to decode.
PAPER = {
    "pickle": (38, 0.0048, 0.0035),
    "json": (33, 0.0080, 0.0065),
    "xml": (235, 0.0118, 0.0661),
    "protobuf": (25, 0.0139, 0.0127),
}


@dataclasses.dataclass
class Variant:
    """A way to make bytes of the record."""

    name: str
    pack: Callable[[Any], bytes]
    unpack: Callable[[bytes], Any]
    value: Any = RECORD
    best: tuple[float, float] = (math.inf, math.inf)
    """Seconds to pack and to unpack."""


def message_class() -> Any:
    """Returns the class of a message with the fields of the record."""
    file = descriptor_pb2.FileDescriptorProto(name="record.proto", package="bench", syntax="proto3")
    message = file.message_type.add(name="Record")
    for number, (name, kind) in enumerate(FIELDS.items(), 1):
        message.field.add(name=name, number=number, type=kind, label="LABEL_OPTIONAL")
    schema = descriptor_pb2.FileDescriptorSet(file=[file])
    messages = messages_of_descriptors([schema.SerializeToString()])
    return messages, messages.message("bench.Record")


def variants() -> list[Variant]:
    """Returns the codecs of SCL, and what they are compared with."""
    messages, record_class = message_class()
    found = []
    for name in ["protobuf", "json"]:
        codec = codec_of("bench.records", name, "bench.Record", messages)
        encode, decode = codec.encode, codec.decode

        def pack(record: Record, encode: Callable[[Any], bytes] = encode) -> bytes:
            valid, differential, satellites, receiver, height = record
            return encode(
                record_class(
                    valid=valid, differential=differential, satellites=satellites, receiver=receiver, height=height
                )
            )

        def unpack(frame: bytes, decode: Callable[[bytes], Any] = decode) -> Record:
            message = decode(frame)
            return message.valid, message.differential, message.satellites, message.receiver, message.height

        title = "protobuf" if name == "protobuf" else "json of a message"
        found.append(Variant(title, pack, unpack))
        message = record_class(**dict(zip(FIELDS, RECORD, strict=True)))
        found.append(Variant(f"{title} (message only)", encode, decode, message))
    for name in ["json", "cbor", "msgpack"]:
        codec = codec_of("bench.records", name, "Record", None)
        found.append(Variant(name, codec.encode, codec.decode))
    found.append(Variant("pickle", pickle.dumps, pickle.loads))
    found.append(Variant("xml", to_xml, from_xml))
    return found


def to_xml(record: Record) -> bytes:
    root = ET.Element("record")
    for name, value in zip(FIELDS, record, strict=True):
        ET.SubElement(root, name).text = str(value)
    return ET.tostring(root)


def from_xml(frame: bytes) -> Record:
    valid, differential, satellites, receiver, height = (it.text or "" for it in ET.fromstring(frame))
    return valid == "True", differential == "True", int(satellites), receiver, float(height)


def measure(call: Callable[[Any], object], argument: object, iterations: int) -> float:
    """Returns the mean duration of a call, in seconds."""
    started = time.perf_counter()
    for _ in range(iterations):
        call(argument)
    return (time.perf_counter() - started) / iterations


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--iterations", type=int, default=10_000, help="calls of each codec in each round")
    parser.add_argument("--rounds", type=int, default=5, help="how often the codecs take turns")
    options = parser.parse_args()

    all_variants = variants()
    for variant in all_variants:
        frame = variant.pack(variant.value)
        assert list(variant.unpack(frame)) == list(RECORD) if variant.value is RECORD else variant.unpack(frame)
    for _ in range(options.rounds):
        for variant in all_variants:
            frame = variant.pack(variant.value)
            packing = measure(variant.pack, variant.value, options.iterations)
            unpacking = measure(variant.unpack, frame, options.iterations)
            variant.best = (min(variant.best[0], packing), min(variant.best[1], unpacking))

    print(f"packing and unpacking {RECORD}, {options.iterations} iterations")
    print(f"{'':32}{'bytes':>8}{'pack us':>10}{'unpack us':>12}     paper: bytes, pack us, unpack us")
    for variant in all_variants:
        packing, unpacking = (seconds * 1e6 for seconds in variant.best)
        size = len(variant.pack(variant.value))
        line = f"{variant.name:32}{size:8}{packing:10.2f}{unpacking:12.2f}"
        if variant.name in PAPER:
            paper_size, paper_pack, paper_unpack = PAPER[variant.name]
            line += f"{paper_size:18}{paper_pack * 1e3:9.1f}{paper_unpack * 1e3:12.1f}"
        print(line)


if __name__ == "__main__":
    main()
