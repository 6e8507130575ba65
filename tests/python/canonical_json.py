"""Converts between protobuf and JSON with Google's implementation, line by line.

Arguments: the name of a message and a file with a FileDescriptorSet. A line `json <hex>` or `proto <hex>` is
answered with the other encoding as `ok <hex>`, or with `error <text>`.
"""

import sys

from google.protobuf import descriptor_pb2, descriptor_pool, json_format, message_factory

files = descriptor_pb2.FileDescriptorSet.FromString(open(sys.argv[2], "rb").read())
pool = descriptor_pool.DescriptorPool()
for file in files.file:
    pool.Add(file)
message_type = message_factory.GetMessageClass(pool.FindMessageTypeByName(sys.argv[1]))

for line in sys.stdin:
    kind, _, data = line.strip().partition(" ")
    data = bytes.fromhex(data)
    try:
        if kind == "json":
            answer = json_format.Parse(data, message_type()).SerializeToString(deterministic=True)
        else:
            answer = json_format.MessageToJson(message_type.FromString(data)).encode()
    except Exception as error:
        print("error", repr(str(error)), flush=True)
        continue
    print("ok", answer.hex(), flush=True)
