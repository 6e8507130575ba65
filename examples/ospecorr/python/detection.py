"""Energy detection: is there more than noise in a channel?

Urkowitz, "Energy detection of unknown deterministic signals", Proc. IEEE 55(4), 1967. Here in the frequency domain: the
periodogram of a block gives the energy of all channels at once. Powers are relative to one complex sample.
"""

from collections import deque
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any

import numpy as np
from numpy.typing import NDArray

Iq = NDArray[np.complex64]
Powers = NDArray[np.float64]

# Fewer bins would make the threshold high and its approximation poor.
FEWEST_BINS = 16


class BadBlock(ValueError):
    """A block that cannot be analysed; the text says why."""


@dataclass(frozen=True)
class Channel:
    """What was found in one channel; powers in dB above the noise floor."""

    power_db: float
    threshold_db: float
    occupied: bool


def complex_samples(interleaved: Any, channels: int) -> Iq:
    """The samples of a block, checked: real and imaginary parts in turn become complex numbers."""
    values = np.fromiter(interleaved, np.float32)
    if channels == 0:
        raise BadBlock("its band has no channels")
    if len(values) % (2 * channels) != 0 or len(values) < 2 * channels * FEWEST_BINS:
        raise BadBlock(
            f"{len(values)} numbers are not a multiple of {2 * channels} (2 x {channels} channels), "
            f"at least {2 * channels * FEWEST_BINS}"
        )
    if not np.isfinite(values).all():
        raise BadBlock("not all samples are finite")
    return values.view(np.complex64)


def channel_powers(samples: Iq, channels: int) -> Powers:
    """The mean power in each channel, from the lower end of the band.

    The Hann window keeps a strong signal from leaking into other channels; without it, side lobes fall too slowly.
    """
    window = np.hanning(len(samples) + 1)[:-1]
    periodogram = np.abs(np.fft.fft(samples * window)) ** 2 / np.sum(window**2)
    return np.asarray(np.fft.fftshift(periodogram).reshape(channels, -1).mean(axis=1), np.float64)


def independent_bins(bins: int) -> float:
    """How many independent bins have a mean that scatters as that of `bins` bins under a Hann window.

    The window correlates the energies of neighbours with (2/3)^2, and of those two apart with (1/6)^2 (Welch, 1967).
    """
    return bins**2 / (bins + 2 * (bins - 1) * (2 / 3) ** 2 + 2 * (bins - 2) * (1 / 6) ** 2)


def noise_quantile(probability: float, bins: float) -> float:
    """The power that the mean of `bins` independent bins of noise with power 1 exceeds with 1 - `probability`.

    Such a mean is chi-square distributed with 2 `bins` degrees of freedom; its quantile is approximated by Wilson and
    Hilferty (1931), which is exact to 0.1 % where `bins` is 16 or more.
    """
    spread = 1 / (9 * bins)
    return float((1 - spread + NormalDist().inv_cdf(probability) * spread**0.5) ** 3)


class NoiseFloor:
    """Estimates the noise power from the newest blocks, although some channels are in use.

    A low quantile of all powers, over time and channels, is noise as long as some channel is free some of the time. Where
    noise alone would have this quantile is known, which removes the bias.
    """

    QUANTILE = 0.2

    def __init__(self, blocks: int = 100) -> None:
        self._powers: deque[Powers] = deque(maxlen=blocks)

    def update(self, powers: Powers, bins: float) -> float:
        """The noise power with one more block; the band's channels must not change."""
        self._powers.append(powers)
        return float(np.quantile(self._powers, self.QUANTILE)) / noise_quantile(self.QUANTILE, bins)


class EnergyDetector:
    """Decides for each channel of each block; `false_alarm` is the probability that noise is taken for a signal."""

    def __init__(self, false_alarm: float) -> None:
        self._false_alarm = false_alarm
        self._shape = (0, 0)
        self._floor = NoiseFloor()

    def detect(self, samples: Iq, channels: int) -> list[Channel]:
        """What is in the channels of a block."""
        if self._shape != (len(samples), channels):
            self._shape = (len(samples), channels)
            self._floor = NoiseFloor()
        bins = independent_bins(len(samples) // channels)
        powers = channel_powers(samples, channels)
        floor = self._floor.update(powers, bins)
        threshold_db = decibels(noise_quantile(1 - self._false_alarm, bins))
        # A block of zeros has no noise to compare with: its powers are those of the floor.
        levels = [decibels(power / floor) if floor > 0 else 0.0 for power in powers]
        return [Channel(level, threshold_db, level > threshold_db) for level in levels]


def decibels(ratio: float) -> float:
    """A ratio of powers in dB; zero becomes -200 dB, because messages should not carry infinities."""
    return 10 * float(np.log10(max(ratio, 1e-20)))
