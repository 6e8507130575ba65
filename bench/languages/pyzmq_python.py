"""Raw pyzmq: `pyzmq_python.py client|echo FOLDER`, over sockets in that folder."""

import sys

import zmq
from client import PAYLOAD, measure_batches


def main() -> None:
    role, folder = sys.argv[1:]
    context = zmq.Context()
    sending, receiving = context.socket(zmq.XPUB), context.socket(zmq.SUB)
    sends, receives = ("ping", "pong") if role == "client" else ("pong", "ping")
    sending.bind(f"ipc://{folder}/{sends}")
    receiving.subscribe(b"")
    receiving.connect(f"ipc://{folder}/{receives}")
    # A subscription that has arrived is the first message of an XPUB socket.
    sending.recv()

    def exchange() -> None:
        sending.send(PAYLOAD)
        receiving.recv()

    if role == "client":
        measure_batches(exchange)
    else:
        while True:
            sending.send(receiving.recv())


main()
