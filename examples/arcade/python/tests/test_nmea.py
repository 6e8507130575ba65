"""Fixes of NMEA sentences, and sentences that are no use."""

import math

import pytest

from arcade_scl import Fix, FixQuality
from nmea import Receiver
from nmea_sentences import GGA, RMC, sentence


def fixes(data: bytes, receiver: Receiver | None = None) -> list[Fix]:
    return list((receiver or Receiver()).add(data, 7))


@pytest.mark.parametrize("data", [GGA + RMC, RMC + GGA])
def test_a_fix_is_made_of_position_and_velocity_in_either_order(data: bytes) -> None:
    (fix,) = fixes(data)
    assert (fix.time_us, fix.quality, fix.satellites) == (7, FixQuality.FIX_QUALITY_3D, 8)
    assert (round(fix.latitude, 6), round(fix.longitude, 6), fix.altitude) == (50.6866, 10.919, 485.4)
    assert math.isclose(fix.east_speed, 10 * 1852 / 3600)
    assert abs(fix.north_speed) < 1e-9


def test_southern_and_western_positions_are_negative() -> None:
    south = sentence("GPGGA,123519.20,3351.0000,S,07030.0000,W,1,08,0.9,485.4,M,46.9,M,,")
    (fix,) = fixes(south + RMC)
    assert (fix.latitude, fix.longitude) == (-33.85, -70.5)


def test_bytes_may_arrive_one_by_one() -> None:
    receiver = Receiver()
    found = [fix for byte in GGA + RMC for fix in receiver.add(bytes([byte]), 7)]
    assert found == fixes(GGA + RMC)
    assert not receiver.problems


def test_sentences_of_other_times_do_not_make_a_fix() -> None:
    assert fixes(GGA + sentence("GPRMC,123519.40,A,5041.1960,N,01055.1400,E,010.0,090.0,230394,,")) == []


def test_a_2d_fix_is_told_by_its_gsa() -> None:
    (fix,) = fixes(sentence("GPGSA,A,2,01,02,03,,,,,,,,,,2.0,2.0,2.0") + GGA + RMC)
    assert fix.quality == FixQuality.FIX_QUALITY_2D


def test_without_a_fix_there_is_no_position() -> None:
    receiver = Receiver()
    no_fix = sentence("GPGGA,123519.20,,,,,0,03,,,M,,M,,") + sentence("GPRMC,123519.20,V,,,,,,,230394,,")
    assert fixes(no_fix, receiver) == [Fix(time_us=7, satellites=3)]
    assert receiver.problems == {"no fix": 1}


def test_a_velocity_without_a_fix_makes_the_position_worthless() -> None:
    (fix,) = fixes(GGA + RMC.replace(b",A,", b",V,").replace(RMC[-4:-2], b"%02X" % (int(RMC[-4:-2], 16) ^ 65 ^ 86)))
    assert fix == Fix(time_us=7, satellites=8)


@pytest.mark.parametrize(
    ("data", "problem"),
    [
        (GGA[:-4] + b"00\r\n", "wrong checksum"),
        (GGA[:40] + b"\r\n", "cut"),
        (GGA[20:], "not a sentence"),
        (b"\xff\x00\xfe\r\n", "not text"),
        (b"hello\r\n", "not a sentence"),
        (b"$*\r\n", "not a sentence"),
        (b"$GPGGA," + 100 * b"1" + b"\r\n", "too long"),
        (sentence("GPXYZ,1,2"), "unknown sentence"),
        (sentence("GPGGA"), "not a sentence"),
        (sentence("GPGGA,123519.20,5041.1960,N,01055.1400,E,q,08,0.9,485.4,M,46.9,M,,"), "wrong field"),
        (sentence("GPGGA,,5041.1960,N,01055.1400,E,1,08,0.9,485.4,M,46.9,M,,") + RMC, "wrong field"),
        (sentence("GPGGA,123519.20,9541.1960,N,01055.1400,E,1,08,0.9,485.4,M,46.9,M,,") + RMC, "wrong field"),
        (sentence("GPGGA,123519.20,5041.1960,N,01055.1400,E,1,08,0.9,nan,M,46.9,M,,") + RMC, "wrong field"),
        (sentence("GPGGA,123519.20,,,,,1,08,0.9,485.4,M,46.9,M,,") + RMC, "wrong field"),
    ],
)
def test_what_is_no_use_is_counted_and_the_next_fix_is_made(data: bytes, problem: str) -> None:
    receiver = Receiver()
    assert fixes(data, receiver) == []
    assert receiver.problems == {problem: 1}
    assert len(fixes(GGA + RMC, receiver)) == 1


def test_a_stream_without_ends_of_lines_takes_no_memory() -> None:
    receiver = Receiver()
    for _ in range(100):
        assert fixes(bytes(1000), receiver) == []
        assert len(receiver.lines.rest) < 100
    assert len(fixes(b"\n" + GGA + RMC, receiver)) == 1
    assert receiver.problems == {"too long": 1}


def test_sentences_that_say_nothing_for_a_fix_are_no_problem() -> None:
    receiver = Receiver()
    assert fixes(sentence("GPVTG,054.7,T,034.4,M,005.5,N,010.2,K"), receiver) == []
    assert not receiver.problems
