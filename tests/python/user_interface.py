"""Plays `user_interface` of Listing 1 with plain ZeroMQ sockets and nothing but the endpoints' names."""

import glob
import sys
import time

import zmq

FOLDER = sys.argv[1]


def endpoint(name):
    """The one socket with this name, whatever its contract, as soon as it is there."""
    while True:
        found = glob.glob(f"{FOLDER}/{name}.????????")
        if found:
            return f"ipc://{found[0]}"
        time.sleep(0.01)


context = zmq.Context()
events = context.socket(zmq.SUB)
events.connect(endpoint("controller.events--user_interface.events"))
events.subscribe(b"")

commands = context.socket(zmq.REQ)
commands.connect(endpoint("controller.commands"))
commands.send(b"faster")
print(commands.recv(), flush=True)
print(events.recv(), flush=True)
