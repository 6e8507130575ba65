"""Asks `sink.answer` of `six_kinds.yaml` nonsense first and then something sensible, with plain ZeroMQ."""

import glob
import sys

import zmq

endpoint = glob.glob(f"{sys.argv[1]}/sink.answer.????????")[0]
commands = zmq.Context().socket(zmq.DEALER)
commands.connect(f"ipc://{endpoint}")
commands.send_multipart([b"", b"\xff\xff\xff"])
commands.send_multipart([b"", b"\x08\x05"])
print(commands.recv_multipart()[-1], flush=True)
