"""SCL in Python: `scl_python.py client|echo TOPOLOGY`."""

import sys

import scl
from client import PAYLOAD, measure_batches

role, topology = sys.argv[1:]
with scl.open(topology, role) as component:
    ping, pong = component.ping, component.pong

    def exchange() -> None:
        ping.send(PAYLOAD)
        pong.recv()

    if role == "client":
        component.ready(10)
        measure_batches(exchange)
    else:
        for message in ping:
            pong.send(message)
