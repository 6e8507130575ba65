"""Takes the place of `probe` with pyzmq alone: `publish.py CELSIUS`."""

import json
import os
import sys
import tempfile
import time
from pathlib import Path

import zmq


def system_folder(system: str) -> str:
    session = os.environ.get("XDG_RUNTIME_DIR")
    usual = f"{session}/scl" if session else f"{tempfile.gettempdir()}/scl-{os.getuid()}"
    folder = f"{os.environ.get('SCL_RUNTIME_DIR') or usual}/{os.environ.get('SCL_SYSTEM') or system}"
    os.makedirs(folder, mode=0o700, exist_ok=True)
    return folder


config = json.loads((Path(__file__).parents[1] / "greenhouse.zmq.json").read_text())
gate = config["components"]["probe"]["gates"]["temperature"]
folder = system_folder(config["system"])
socket = zmq.Context().socket(zmq.PUB)
for endpoint in gate["zmq_endpoints"]:
    socket.bind(endpoint.replace("{folder}", folder))
while True:
    socket.send_string(json.dumps({"celsius": float(sys.argv[1])}))
    time.sleep(0.1)
