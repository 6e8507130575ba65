"""Plays `right` of `twins.yaml` with plain ZeroMQ sockets: `twin.py HEARTBEAT_MS NAME=ADDRESS...`.

`values`, `jobs_in` and `answer` listen; `values_in`, `jobs` and `question` connect. A socket that listens at `tcp:PATH`
chooses a port and writes it to `PATH.tcp`. Commands come line by line.
"""

import queue
import sys
import threading
import time

import zmq

LISTENING = {"values": zmq.PUB, "jobs_in": zmq.PULL, "answer": zmq.REP}
CONNECTING = {"values_in": zmq.SUB, "jobs": zmq.PUSH, "question": zmq.REQ}

heartbeat = int(sys.argv[1])
addresses = dict(argument.split("=", 1) for argument in sys.argv[2:])
context = zmq.Context()
monitors = []


def open_socket(name):
    listens = name in LISTENING
    socket = context.socket(LISTENING[name] if listens else CONNECTING[name])
    socket.linger = 0
    if heartbeat:
        socket.heartbeat_ivl = heartbeat
        socket.heartbeat_timeout = 1000
        socket.heartbeat_ttl = 2000
    if name == "values_in":
        socket.subscribe(b"")
    monitors.append(socket.get_monitor_socket(zmq.EVENT_DISCONNECTED))
    if listens and addresses[name].startswith("tcp:"):
        socket.bind("tcp://127.0.0.1:*")
        with open(addresses[name].removeprefix("tcp:") + ".tcp", "w") as file:
            file.write(socket.last_endpoint.decode().removeprefix("tcp://"))
    elif listens:
        socket.bind(addresses[name])
    else:
        socket.connect(addresses[name])
    return socket


def number(value):
    """A `test.Number` in protobuf: the field 1, in pieces of seven bits."""
    pieces = []
    while value > 127:
        pieces.append(value & 127 | 128)
        value >>= 7
    return bytes([8, *pieces, value])


def value(message):
    return sum((piece & 127) << 7 * index for index, piece in enumerate(message[1:]))


def ranges(values):
    merged = []
    for item in values:
        if merged and merged[-1][1] == item:
            merged[-1][1] += 1
        else:
            merged.append([item, item + 1])
    return " ".join(f"{start}..{end}" for start, end in merged)


def receive_up_to(socket, last):
    values = [value(socket.recv())]
    while values[-1] < last:
        values.append(value(socket.recv()))
    say(ranges(values))


def serve(socket):
    while True:
        socket.send(number(2 * value(socket.recv())))


def say(line):
    print(line, flush=True)


def read_commands(commands):
    for line in sys.stdin:
        commands.put(line.split())
    commands.put(["end"])


sockets = {name: open_socket(name) for name in addresses}
commands = queue.Queue()
threading.Thread(target=read_commands, args=[commands], daemon=True).start()
threading.Thread(target=serve, args=[sockets["answer"]], daemon=True).start()
say("open")
while True:
    command, *numbers = commands.get()
    numbers = [int(item) for item in numbers]
    if command == "stream":
        # A publisher does not know when its first subscriber is there.
        item = 0
        while commands.empty():
            sockets["values"].send(number(item))
            item += 1
            time.sleep(0.001)
    elif command == "stop":
        sockets["values"].send(number(1_000_000))
        say("stopped")
    elif command == "push":
        for item in range(*numbers):
            sockets["jobs"].send(number(item))
        say("pushed")
    elif command == "call":
        sockets["question"].send(number(numbers[0]))
        say(value(sockets["question"].recv()))
    elif command == "values":
        receive_up_to(sockets["values_in"], numbers[0])
    elif command == "jobs":
        receive_up_to(sockets["jobs_in"], numbers[0])
    elif command == "connected":
        lost = [monitor for monitor in monitors if monitor.poll(0)]
        say(f"{len(lost)} lost")
    elif command == "end":
        break
