"""The processes that a stage starts. Whose parent ends becomes a child of the gate, so none gets lost."""

import ctypes
import os
import signal
from pathlib import Path

PR_SET_CHILD_SUBREAPER = 36


def adopt_orphans():
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def descendants():
    """The running ones of this process."""
    parents = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            # The name of the program, in parentheses, may contain anything.
            state, parent = stat.read_text().rpartition(")")[2].split()[:2]
        except (OSError, ValueError):
            continue
        if state not in "ZX":
            parents[int(stat.parent.name)] = int(parent)
    found, added = set(), {os.getpid()}
    while added:
        added = {process for process, parent in parents.items() if parent in added} - found
        found |= added
    return sorted(found)


def describe(process):
    """What it is, and the test that started it, which nextest tells its tests in their environment."""
    try:
        command = Path(f"/proc/{process}/cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace").strip()
        environment = Path(f"/proc/{process}/environ").read_bytes().decode(errors="replace").split("\0")
    except OSError:
        return None
    test = [value for variable in environment for name, _, value in [variable.partition("=")] if name == "NEXTEST_TEST_NAME"]
    return f"process {process}: {command[:200]}" + (f", started by the test {test[0]}" if test else "")


def kill_all():
    """Ends what is left. Killed processes leave children, which are killed the next time."""
    while left := descendants():
        for process in left:
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                pass
        reap()
    reap()


def reap():
    try:
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    except ChildProcessError:
        pass
