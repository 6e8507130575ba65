"""Subscribes with plain ZeroMQ: `latched.py ADDRESS`. Prints the first byte of each message."""

import sys

import zmq

subscriber = zmq.Context().socket(zmq.SUB)
subscriber.subscribe(b"")
subscriber.connect(sys.argv[1])
while True:
    print(subscriber.recv()[0], flush=True)
