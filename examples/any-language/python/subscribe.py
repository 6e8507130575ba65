"""Receives what `station` publishes for `heater`, beside it or in its place, with pyzmq alone."""

import json
import os
import tempfile
from pathlib import Path

import zmq


def system_folder(system: str) -> str:
    session = os.environ.get("XDG_RUNTIME_DIR")
    usual = f"{session}/scl" if session else f"{tempfile.gettempdir()}/scl-{os.getuid()}"
    return f"{os.environ.get('SCL_RUNTIME_DIR') or usual}/{os.environ.get('SCL_SYSTEM') or system}"


config = json.loads((Path(__file__).parents[1] / "greenhouse.zmq.json").read_text())
gate = config["components"]["heater"]["gates"]["heating"]
folder = system_folder(config["system"])
socket = zmq.Context().socket(zmq.SUB)
socket.subscribe(b"")
for endpoint in gate["zmq_endpoints"]:
    socket.connect(endpoint.replace("{folder}", folder))
while True:
    # Canonical protobuf JSON leaves out what is false or zero.
    heating = json.loads(socket.recv()).get("on", False)
    print("heating on" if heating else "heating off", flush=True)
