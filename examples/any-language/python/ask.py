"""Asks `station` for another temperature in the place of `panel`, with pyzmq alone: `ask.py CELSIUS`."""

import json
import os
import sys
import tempfile
from pathlib import Path

import zmq


def system_folder(system: str) -> str:
    session = os.environ.get("XDG_RUNTIME_DIR")
    usual = f"{session}/scl" if session else f"{tempfile.gettempdir()}/scl-{os.getuid()}"
    return f"{os.environ.get('SCL_RUNTIME_DIR') or usual}/{os.environ.get('SCL_SYSTEM') or system}"


config = json.loads((Path(__file__).parents[1] / "greenhouse.zmq.json").read_text())
gate = config["components"]["panel"]["gates"]["target"]
folder = system_folder(config["system"])
socket = zmq.Context().socket(zmq.REQ)
socket.linger = 0
socket.connect(gate["zmq_endpoints"][0].replace("{folder}", folder))
socket.send_string(json.dumps({"celsius": float(sys.argv[1])}))
if not socket.poll(timeout=gate["timeout_ns"] // 1_000_000):
    sys.exit("no answer")
print("before:", json.loads(socket.recv()).get("previousCelsius", 0.0), flush=True)
