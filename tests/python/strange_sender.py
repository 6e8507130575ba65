"""Plays what SCL does not expect at endpoints of `six_kinds.yaml`, with plain ZeroMQ: `strange_sender.py FOLDER WHAT`."""

import glob
import sys

import zmq

folder, what = sys.argv[1:3]
context = zmq.Context()


def endpoint(start):
    return "ipc://" + glob.glob(f"{folder}/{start}*")[0]


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
    readings.setsockopt(zmq.HEARTBEAT_IVL, 100)
    readings.setsockopt(zmq.SUBSCRIBE, b"")
    monitor = readings.get_monitor_socket(zmq.EVENT_DISCONNECTED)
    readings.connect(endpoint("source.readings--sink.readings."))
    monitor.recv_multipart()
    print("disconnected", flush=True)
    # Until the test ends, it connects again, sends its heartbeat, and is disconnected again.
    readings.recv()
    print("received", flush=True)
sys.stdin.read()
