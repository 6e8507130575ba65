"""Subscribes to frames with plain ZeroMQ: `images.py ADDRESS`. Prints the number and the length of each."""

import sys

import zmq

subscriber = zmq.Context().socket(zmq.SUB)
subscriber.subscribe(b"")
subscriber.connect(sys.argv[1])
print("open", flush=True)
while True:
    frame = subscriber.recv()
    print(int.from_bytes(frame[:8], "little"), len(frame), flush=True)
