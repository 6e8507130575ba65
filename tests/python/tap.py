"""Observes one message at a tap with plain ZeroMQ: `tap.py ADDRESS`."""

import sys

import zmq

observer = zmq.Context().socket(zmq.SUB)
observer.subscribe(b"")
observer.connect(sys.argv[1])
payload, meta = observer.recv_multipart()
print(f"{payload.hex()} {len(meta)} bytes", flush=True)
