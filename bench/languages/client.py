"""What the clients in Python share: `run` writes a number of messages to standard input and expects the time of each
round trip, in nanoseconds, as one line."""

import sys
from collections.abc import Callable
from time import perf_counter_ns

PAYLOAD = bytes(20)


def measure_batches(exchange: Callable[[], None]) -> None:
    """Measures batches until standard input ends."""
    for line in sys.stdin:
        count = int(line)
        # The other programs have had their turns since, so the first tenth warms the caches.
        for _ in range(count // 10):
            exchange()
        durations = []
        for _ in range(count):
            started = perf_counter_ns()
            exchange()
            durations.append(perf_counter_ns() - started)
        print(*durations, flush=True)
