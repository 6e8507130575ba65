"""Plays `left` or `right` of `topologies/matrix/matrix.yaml` with nothing but pyzmq (and protobuf for the messages):
`main.py COMPONENT ZMQ_FILE FOLDER DESCRIPTORS`, with the file of `scl generate --for zmq` and descriptors of protoc.

The commands are those of all programs in `languages`; a plain program has no counts and does not refuse anything.
"""

import json
import select
import sys
from pathlib import Path

import zmq
from google.protobuf import descriptor_pb2, descriptor_pool, json_format, message_factory

component, file, folder, descriptors = sys.argv[1:5]
pool = descriptor_pool.DescriptorPool()
for described in descriptor_pb2.FileDescriptorSet.FromString(Path(descriptors).read_bytes()).file:
    pool.Add(described)
Sample = message_factory.GetMessageClass(pool.FindMessageTypeByName("matrix.Sample"))

REPLY = 1000
context = zmq.Context()
sockets, monitors = {}, {}


def open_gate(name, gate):
    # Of a publisher, XPUB, because it tells who has subscribed.
    kind = "XPUB" if gate["zmq_socket_type"] == "PUB" else gate["zmq_socket_type"]
    socket = sockets[name] = context.socket(getattr(zmq, kind))
    monitors[name] = socket.get_monitor_socket(zmq.EVENT_DISCONNECTED)
    # No message goes to a peer that is not there. A subscriber with this option would lose its subscription.
    socket.immediate = kind in ("PUSH", "REQ")
    socket.linger = 1000  # What is queued when the program ends is still sent to a peer that is there.
    socket.sndhwm = socket.rcvhwm = 0
    if kind == "XPUB":
        socket.xpub_verbose = True
    if kind == "SUB":
        socket.subscribe(b"")
    for endpoint in gate["zmq_endpoints"]:
        getattr(socket, gate["zmq_method"])(endpoint.replace("{folder}", folder))


def text(number):
    return f"sample {number} ü"


def encode(gate, number):
    if gate.endswith("_bytes"):
        return text(number).encode()
    sample = Sample(number=number, text=text(number))
    return json_format.MessageToJson(sample).encode() if gate.endswith("_json") else sample.SerializeToString()


def decode(gate, frame):
    if gate.endswith("_bytes"):
        number, found = int(frame.decode().split()[1]), frame.decode()
    else:
        sample = Sample()
        json_format.Parse(frame, sample) if gate.endswith("_json") else sample.ParseFromString(frame)
        number, found = sample.number, sample.text
    assert found == text(number), frame
    return number


def ranges(numbers):
    merged = []
    for number in numbers:
        if merged and merged[-1][1] == number:
            merged[-1][1] += 1
        else:
            merged.append([number, number + 1])
    return " ".join(f"{first}..{end}" for first, end in merged)


def call(gate, number):
    sockets[gate].send(encode(gate, number))
    return decode(gate, sockets[gate].recv())


def serve(gate):
    number = decode(gate, sockets[gate].recv())
    sockets[gate].send(encode(gate, number + REPLY))
    return number


def follow(command, gate="", *numbers):
    numbers = [int(number) for number in numbers]
    if command == "ready":
        # A publisher waits for a subscription at each of its gates. What connects sends as soon as it is connected.
        for publisher in (socket for socket in sockets.values() if socket.type == zmq.XPUB):
            while publisher.recv()[0] != 1:
                pass
        return "ready"
    if command == "gone":
        monitors[gate].recv_multipart()
        return "gone"
    if command == "send":
        for number in range(*numbers):
            sockets[gate].send(encode(gate, number))
        return "sent"
    if command == "garbage":
        sockets[gate].send(b"\xff\xff\xff")
        return "sent"
    if command == "call":
        return ranges([call(gate, number) for number in range(*numbers)])
    if command == "serve":
        return ranges([serve(gate) for _ in range(numbers[0])])
    return ranges([decode(gate, sockets[gate].recv()) for _ in range(numbers[0])])


def commands():
    while True:
        # libzmq renews a subscription only in a call of its socket.
        while not select.select([sys.stdin], [], [], 0.01)[0]:
            for socket in sockets.values():
                socket.get(zmq.EVENTS)
        line = sys.stdin.readline()
        if not line:
            return
        yield line


with open(file, encoding="utf-8") as document:
    for name, gate in json.load(document)["components"][component]["gates"].items():
        open_gate(name, gate)
print("open", flush=True)
for line in commands():
    print(follow(*line.split()), flush=True)
for socket in (*monitors.values(), *sockets.values()):
    socket.close()
context.term()
