"""The ids of commands tell who wants them, so that a restarted arbiter finds in `Flight` what it was doing.

Missions use 1 to 9999, the ground station 10000 to 999999, safety 1000000 to 9999999. A return is made of two commands: their
ids are that of the return with `HOME` or `LANDING` added.
"""

from arcade_scl import Authority

HOME = 10_000_000  # added to the id of the flight home ...
LANDING = 20_000_000  # ... and to that of the landing after it

RANGES = {
    Authority.AUTHORITY_MISSION: range(1, 10_000),
    Authority.AUTHORITY_GROUND: range(10_000, 1_000_000),
    Authority.AUTHORITY_SAFETY: range(1_000_000, 10_000_000),
}


def split(command_id: int) -> tuple[Authority, int, int]:
    """Returns who wanted a command, the id that was asked for, and what was added to it: 0, `HOME` or `LANDING`."""
    asked = command_id % HOME
    for authority, ids in RANGES.items():
        if asked in ids:
            return authority, asked, command_id - asked
    return Authority.AUTHORITY_NOBODY, asked, command_id - asked


def next_of_safety(in_effect: int) -> int:
    """An id for a command of safety that differs from that of the command in effect."""
    authority, asked, _ = split(in_effect)
    ids = RANGES[Authority.AUTHORITY_SAFETY]
    return asked + 1 if authority == Authority.AUTHORITY_SAFETY and asked + 1 in ids else ids.start
