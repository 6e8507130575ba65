"""Energy detection against noise of known power."""

from math import sqrt
from statistics import NormalDist

import numpy as np
import pytest

from detection import (
    BadBlock,
    EnergyDetector,
    Iq,
    NoiseFloor,
    channel_powers,
    complex_samples,
    decibels,
    independent_bins,
    noise_quantile,
)

CHANNELS, LENGTH = 8, 1024


def noise(random: np.random.Generator, power: float = 1.0, length: int = LENGTH) -> Iq:
    """White noise with a power for each complex sample."""
    parts = random.normal(scale=sqrt(power / 2), size=(length, 2))
    return (parts[:, 0] + 1j * parts[:, 1]).astype(np.complex64)


def noise_in_channel(random: np.random.Generator, channel: int, power: float) -> Iq:
    """Noise in one channel, with a power density of `power`."""
    spectrum = np.zeros(LENGTH, np.complex128)
    bins = LENGTH // CHANNELS
    spectrum[channel * bins : (channel + 1) * bins] = noise(random, power * LENGTH, bins)
    return np.fft.ifft(np.fft.ifftshift(spectrum)).astype(np.complex64)


def assert_binomial(count: int, trials: int, probability: float) -> None:
    """Fails for counts that are less likely than 1 in 10,000."""
    deviation = NormalDist().inv_cdf(1 - 0.5e-4) * sqrt(trials * probability * (1 - probability))
    assert abs(count - trials * probability) <= deviation + 1, f"{count} of {trials}, expected {probability:.4f}"


@pytest.mark.parametrize("false_alarm", [1e-1, 1e-2, 1e-3])
@pytest.mark.parametrize("power", [1.0, 4e-9])
def test_false_alarms_are_as_frequent_as_requested(false_alarm: float, power: float) -> None:
    random = np.random.default_rng(1)
    detector = EnergyDetector(false_alarm)
    blocks, alarms = 2000, 0
    for block in range(-100, blocks):
        found = detector.detect(noise(random, power), CHANNELS)
        # The floor of the first blocks is less certain.
        if block >= 0:
            alarms += sum(channel.occupied for channel in found)
    # The estimate of the floor scatters, too, by 0.5 %.
    assert_binomial(alarms, blocks * CHANNELS, false_alarm * 1.1)


@pytest.mark.parametrize("snr_db", [-3.0, 0.0, 3.0])
def test_a_signal_is_detected_with_the_theoretical_probability(snr_db: float) -> None:
    random = np.random.default_rng(2)
    detector = EnergyDetector(1e-2)
    blocks, trials, detected, channel, snr = 3000, 0, 0, 5, 10 ** (snr_db / 10)
    for block in range(blocks):
        # A signal that is rare, so that it does not raise the estimate of the floor.
        present = block >= 100 and block % 5 == 0
        primary = noise_in_channel(random, channel, snr) if present else 0
        found = detector.detect(np.asarray(noise(random) + primary, np.complex64), CHANNELS)
        trials += present
        detected += present and found[channel].occupied
    # With signal, the mean is that of noise times (1 + SNR); nearly normal for this number of bins.
    bins = independent_bins(LENGTH // CHANNELS)
    theory = 1 - NormalDist().cdf((noise_quantile(0.99, bins) / (1 + snr) - 1) * sqrt(bins))
    assert_binomial(detected, trials, min(theory, 1 - 1e-4))


def test_only_the_channel_of_a_strong_signal_is_occupied() -> None:
    random = np.random.default_rng(3)
    detector = EnergyDetector(1e-6)
    for block in range(200):
        channel = block % CHANNELS
        tone = np.exp(2j * np.pi * ((channel + 0.5) / CHANNELS - 0.5) * np.arange(LENGTH)) * 100
        found = detector.detect(np.asarray(noise(random) + tone, np.complex64), CHANNELS)
        assert [number for number, report in enumerate(found) if report.occupied] == [channel]
        # 40 dB above the noise of the band, of which a channel has an eighth.
        assert found[channel].power_db == pytest.approx(40 + decibels(CHANNELS), abs=0.6)


def test_powers_are_in_the_order_of_the_band() -> None:
    lowest = np.exp(2j * np.pi * -0.45 * np.arange(LENGTH)).astype(np.complex64)
    powers = channel_powers(lowest, CHANNELS)
    assert powers[0] == pytest.approx(CHANNELS, rel=1e-3)
    assert powers[1:].sum() < 1e-3


@pytest.mark.parametrize("used", [0, 4, 6])
def test_the_floor_is_found_below_used_channels(used: int) -> None:
    random = np.random.default_rng(4)
    floor, bins, estimate = NoiseFloor(), independent_bins(LENGTH // CHANNELS), 0.0
    for _ in range(100):
        powers = channel_powers(noise(random, 2.0), CHANNELS)
        powers[:used] *= 100
        estimate = floor.update(powers, bins)
    # Where channels are in use, the quantile is a higher one of the noise, which makes the floor too high.
    assert -0.1 < decibels(estimate / 2.0) < (0.1 if used == 0 else 1.0)


@pytest.mark.parametrize("bins", [16, 64, 256])
def test_quantiles_are_those_of_the_distribution(bins: int) -> None:
    random = np.random.default_rng(5)
    means = random.gamma(bins, 1 / bins, 200_000)
    for probability in (0.2, 0.9, 0.999):
        below = int((means < noise_quantile(probability, bins)).sum())
        assert_binomial(below, len(means), probability)


def test_the_window_costs_the_expected_number_of_bins() -> None:
    random = np.random.default_rng(6)
    powers = np.concatenate([channel_powers(noise(random), CHANNELS) for _ in range(1000)])
    assert 1 / powers.var() == pytest.approx(independent_bins(LENGTH // CHANNELS), rel=0.1)


@pytest.mark.parametrize(
    ("values", "channels", "reason"),
    [
        ([0.0] * 512, 0, "no channels"),
        ([0.0] * 511, 8, "511 numbers are not a multiple of 16"),
        ([], 8, "0 numbers"),
        ([0.0] * 240, 8, "at least 256"),
        ([0.0] * 511 + [float("nan")], 8, "finite"),
        ([float("inf")] + [0.0] * 511, 8, "finite"),
    ],
)
def test_a_bad_block_is_refused(values: list[float], channels: int, reason: str) -> None:
    with pytest.raises(BadBlock, match=reason):
        complex_samples(values, channels)


def test_silence_and_another_division_of_the_band_are_no_failures() -> None:
    detector = EnergyDetector(1e-3)
    for channels in (8, 4, 8):
        found = detector.detect(complex_samples([0.0] * 512, channels), channels)
        assert [channel.occupied for channel in found] == [False] * channels
