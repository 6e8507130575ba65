"""The signal detector beside the other ends of its gates."""

import threading
from collections.abc import Iterator

import numpy as np
import pytest

from ospecorr_scl import Samples, SignalDetector, SignalDetectorPeer
from signal_detector import RareMessages, probability, run

CHANNELS, LENGTH = 8, 1024


@pytest.fixture
def peer() -> Iterator[SignalDetectorPeer]:
    """The other ends of a running detector's gates."""
    detector, peer = SignalDetector.test()
    # A false alarm once in a million.
    running = threading.Thread(target=run, args=(detector, 1e-6))
    running.start()
    yield peer
    detector.close()
    running.join()


def block(time_us: int, signal: int | None = None) -> Samples:
    """Noise, with a tone in one channel."""
    samples = np.random.default_rng(time_us).normal(size=2 * LENGTH).astype(np.float32).view(np.complex64)
    if signal is not None:
        samples = samples + 10 * np.exp(2j * np.pi * ((signal + 0.5) / CHANNELS - 0.5) * np.arange(LENGTH))
    iq = samples.astype(np.complex64).view(np.float32)
    return Samples(time_us=time_us, sample_rate=8e6, channels=CHANNELS, iq=iq.tolist())


def test_a_signal_is_published_with_its_power(peer: SignalDetectorPeer) -> None:
    for number in range(20):
        peer.samples.send(block(number, signal=5 if number % 4 == 3 else None))
        occupancy = peer.occupancy.recv(timeout=60)
        assert occupancy.time_us == number
        occupied = [channel for channel, found in enumerate(occupancy.channels) if found.occupied]
        assert occupied == ([5] if number % 4 == 3 else [])
        for channel in occupancy.channels:
            assert channel.occupied == (channel.power_db > channel.threshold_db)


def test_bad_blocks_are_skipped_and_reported(peer: SignalDetectorPeer, capsys: pytest.CaptureFixture[str]) -> None:
    # The gate keeps four.
    good = block(5_000_000)
    peer.samples.send(Samples(time_us=1_250_000, channels=0, iq=good.iq))
    peer.samples.send(Samples(time_us=2, channels=8, iq=[*good.iq[:-1], float("nan")]))
    peer.samples.send(Samples(time_us=3, channels=8, iq=good.iq[:-1]))
    peer.samples.send(good)
    assert peer.occupancy.recv(timeout=60).time_us == 5_000_000
    assert capsys.readouterr().out == "skipped the block of 1.250 s: its band has no channels\n"


def test_messages_are_rare(capsys: pytest.CaptureFixture[str]) -> None:
    messages = RareMessages()
    for now in (10.0, 10.5, 10.9, 11.1, 12.2):
        messages.print(f"at {now}", now)
    assert capsys.readouterr().out == "at 10.0\nat 11.1 (2 more since the last message)\nat 12.2\n"


@pytest.mark.parametrize("text", ["0", "0.5", "-1", "nan", "often", ""])
def test_a_probability_is_checked(text: str) -> None:
    with pytest.raises(Exception, match="is not a number between 0 and 0.5"):
        probability(text)
