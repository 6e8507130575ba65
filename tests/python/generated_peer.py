"""Plays `source` or `sink` of `six_kinds.yaml` with the generated module, with the commands of `src/bin/peer.rs`."""

import sys
from collections.abc import Iterable

from six_scl import Number, Sink, Source

import scl


def say(text: object) -> None:
    print(text, flush=True)


def ranges(values: list[int]) -> str:
    merged: list[list[int]] = []
    for value in values:
        if merged and merged[-1][1] == value:
            merged[-1][1] += 1
        else:
            merged.append([value, value + 1])
    return " ".join(f"{start}..{end}" for start, end in merged)


def receive(gate: scl.Sub[Number] | scl.Pull[Number], count: int) -> str:
    return ranges([gate.recv().value for _ in range(count)])


def numbers(words: list[str]) -> Iterable[Number]:
    padding = bytes(int(words[3])) if len(words) > 3 else b""
    return (Number(value=value, padding=padding) for value in range(int(words[1]), int(words[2])))


def source(words: list[str], source: Source) -> object:
    match words[0]:
        case "ready":
            source.ready(timeout=int(words[1]) / 1000)
            return "ready"
        case "publish":
            for number in numbers(words):
                source.readings.send(number)
            return "published"
        case "lossless":
            for number in numbers(words):
                source.lossless.send(number)
            return "published"
        case "push":
            for number in numbers(words):
                source.jobs.send(number)
            return "pushed"
        case "call":
            return source.question.call(Number(value=int(words[1]))).value
    return f"unknown command `{words[0]}`"


def sink(words: list[str], sink: Sink) -> object:
    count = int(words[1]) if len(words) > 1 else 1
    match words[0]:
        case "receive":
            return receive(sink.readings, count)
        case "receive_lossless":
            return receive(sink.lossless, count)
        case "newest":
            return sink.newest.recv().value
        case "pull":
            return receive(sink.jobs, count)
        case "serve":
            for _ in range(count):
                request = sink.answer.recv()
                request.reply(Number(value=request.message.value * 2))
            return "served"
        case "rejected":
            return sink.readings.stats()["rejected"]
    return f"unknown command `{words[0]}`"


def main() -> None:
    component = Source() if sys.argv[1] == "source" else Sink()
    with component:
        say("open")
        for line in sys.stdin:
            try:
                match component:
                    case Source():
                        say(source(line.split(), component))
                    case Sink():
                        say(sink(line.split(), component))
            except scl.Error as error:
                say(f"error: {error}")


main()
