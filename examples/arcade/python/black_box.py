"""Gives records to the black box, and goes on without it."""

import sys

import scl

from arcade_scl import Record


class BlackBox:
    """The gate `records` of a component. Records that get lost are counted and reported."""

    def __init__(self, gate: scl.Push[Record], component: str) -> None:
        self.gate = gate
        self.component = component
        self.reported = 0  # of the lost records
        self._refused = 0
        self._losing = False

    @property
    def lost(self) -> int:
        """How many records got lost so far."""
        stats = self.gate.stats()
        return self._refused + int(stats["dropped_oldest"]) + int(stats["lost"])

    def note(self, text: str, value: float = 0.0) -> None:
        """Prints an event and records it. It never waits: no decision depends on the black box."""
        print(text, flush=True)
        before = self.lost
        self._send(text, value)
        now = self.lost
        if now > before and not self._losing:
            print("the black box does not take records; they are lost until it does", file=sys.stderr, flush=True)
        elif now == before and now > self.reported:
            report = f"records lost by {self.component}: {now - self.reported}"
            print(f"the black box takes records again; {report}", file=sys.stderr, flush=True)
            self._send(report, now - self.reported)
            self.reported = now
        self._losing = now > before

    def _send(self, text: str, value: float) -> None:
        # While the black box is away, the gate keeps the newest records for it. One that is stuck refuses them.
        try:
            self.gate.send(Record(component=self.component, text=text, value=value), timeout=0)
        except scl.Timeout:
            self._refused += 1
