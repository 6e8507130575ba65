"""Gives records to the black box, and goes on without it."""

import sys

import scl

from arcade_scl import Record


class BlackBox:
    """The gate `records` of a component. Records that the black box cannot take are counted and reported."""

    def __init__(self, gate: scl.Push[Record], component: str) -> None:
        self.gate = gate
        self.component = component
        self.dropped = 0

    def note(self, text: str, value: float = 0.0) -> None:
        """Prints an event and records it. It never waits: no decision depends on the black box."""
        print(text, flush=True)
        if self.dropped:
            missed = f"{self.dropped} records were dropped before this one"
            if self._sent(missed, self.dropped):
                print(f"the black box takes records again; {missed}", flush=True)
                self.dropped = 0
        if not self._sent(text, value):
            if self.dropped == 0:
                print("the black box takes no records; dropping them until it does", file=sys.stderr, flush=True)
            self.dropped += 1

    def _sent(self, text: str, value: float) -> bool:
        try:
            # The gate itself keeps some records for a black box that is being restarted.
            self.gate.send(Record(component=self.component, text=text, value=value), timeout=0)
        except scl.Timeout:
            return False
        return True
