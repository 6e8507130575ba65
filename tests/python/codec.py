"""Converts frames with the codecs of the package `scl`, line by line.

Arguments: a codec and a type; for a message of schemas, also a file with a FileDescriptorSet. Each line is answered with
`ok <hex>` or `error <text>`:

- `json <hex>`: decodes a frame and answers with the message's protobuf encoding; `proto <hex>` the other way round.
- `again <hex>`: decodes a frame and encodes the value.
"""

import sys
from pathlib import Path

from scl.codec import codec_of, messages_of_descriptors

messages = messages_of_descriptors([Path(sys.argv[3]).read_bytes()]) if len(sys.argv) > 3 else None
codec = codec_of("there.gate", sys.argv[1], sys.argv[2], messages, peers=["here.gate"])

for line in sys.stdin:
    kind, _, digits = line.strip().partition(" ")
    frame = bytes.fromhex(digits)
    try:
        if kind == "json":
            answer = codec.decode(frame).SerializeToString(deterministic=True)
        elif kind == "proto":
            answer = codec.encode(codec.type.FromString(frame))
        else:
            answer = codec.encode(codec.decode(frame))
    except ValueError as error:
        print("error", repr(str(error)), codec.owner.rejected, flush=True)
        continue
    print("ok", answer.hex(), flush=True)
