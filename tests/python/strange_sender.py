"""Plays what SCL does not expect at endpoints of `six_kinds.yaml`, with plain ZeroMQ: `strange_sender.py FOLDER WHAT`."""

import glob
import sys

import zmq

folder, what = sys.argv[1:3]
context = zmq.Context()


def endpoint(start):
    return "ipc://" + glob.glob(f"{folder}/{start}????????")[0]


if what == "multipart":
    # Three frames where one is due, then one that is sound.
    jobs = context.socket(zmq.PUSH)
    jobs.connect(endpoint("sink.jobs."))
    jobs.send_multipart([b"one", b"two", b"three"])
    jobs.send(b"\x08\x05")
    print("sent", flush=True)
elif what == "two_bodies":
    question = context.socket(zmq.DEALER)
    question.connect(endpoint("sink.answer."))
    question.send_multipart([b"", b"one", b"two"])
    question.send_multipart([b"", b"\x08\x05"])
    print(question.recv_multipart()[-1], flush=True)
elif what == "heartbeats":
    readings = context.socket(zmq.SUB)
    readings.setsockopt(zmq.HEARTBEAT_IVL, 1)
    readings.setsockopt(zmq.HEARTBEAT_TIMEOUT, 10_000)
    readings.setsockopt(zmq.SUBSCRIBE, b"")
    monitor = readings.get_monitor_socket(zmq.EVENT_DISCONNECTED)
    readings.connect(endpoint("source.readings--sink.readings."))
    for _ in range(200):
        # The number, in pieces of seven bits behind its tag; 0 is left out.
        pieces = enumerate(readings.recv()[1:])
        print(sum((piece & 127) << 7 * place for place, piece in pieces), flush=True)
    sys.stdin.readline()
    print("no" if monitor.poll(0) else "yes", flush=True)
sys.stdin.read()
