"""Reads an MCAP file in order and by its index, decodes protobuf and JSON, and prints what it counted as JSON."""

import json
import sys

from mcap.exceptions import EndOfFile
from mcap.reader import NonSeekingReader, SeekingReader
from mcap_protobuf.decoder import DecoderFactory

FIELDS = {"/source/measurements": "speed", "/source/position": "latitude"}


def read(reader, **options):
    topics = {}
    complete = True
    try:
        for schema, channel, message in reader.iter_messages(**options):
            topic = topics.setdefault(
                channel.topic,
                {
                    "count": 0,
                    "first": message.sequence,
                    "last": None,
                    "encoding": channel.message_encoding,
                    "schema": schema.name,
                    "schema_encoding": schema.encoding,
                    "sum": None,
                },
            )
            topic["count"] += 1
            topic["last"] = message.sequence
            field = FIELDS.get(channel.topic)
            if field is not None and message.data:
                topic["sum"] = (topic["sum"] or 0.0) + decode(schema, channel, message, field)
    except EndOfFile:
        complete = False
    return topics, complete


def decode(schema, channel, message, field):
    if channel.message_encoding == "json":
        return json.loads(message.data)[field]
    decoder = DECODERS.decoder_for(channel.message_encoding, schema)
    return getattr(decoder(message.data), field)


DECODERS = DecoderFactory()

with open(sys.argv[1], "rb") as file:
    # Sorting would read all of a file before the first message.
    stream, complete = read(NonSeekingReader(file), log_time_order=False)

indexed = None
if complete:
    with open(sys.argv[1], "rb") as file:
        reader = SeekingReader(file)
        indexed, _ = read(reader)
        statistics = reader.get_summary().statistics
        assert statistics.message_count == sum(topic["count"] for topic in indexed.values())
        assert {attachment.name for attachment in reader.iter_attachments()} >= {"plan.json", "topology.yaml"}
        # A recovered file has none.
        assert all(record.metadata["system"] == "rover" for record in reader.iter_metadata())

print(json.dumps({"stream": stream, "complete": complete, "indexed": indexed}))
