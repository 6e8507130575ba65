"""What a stage leaves behind: processes, files that git does not ignore, temporary files, shared memory."""

import os
import re
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import processes

SHARED_MEMORY = "/dev/shm"
# What SCL, the library below it and libfaketime create there: other programs of the machine use it, too.
OURS = re.compile(r"(sem\.)?(scl|iox2|faketime)_")
# Of temporary files: what pytest keeps of its last runs, and the runtime folder of a user.
MEANT_TO_STAY = re.compile(r"pytest-of-|scl-\d+$")


class Leftovers:
    """Begins before the stage, which gets a folder for temporary files of its own."""

    def __init__(self):
        self.changed = changed_files()
        self.shared = shared_memory()
        self.shared_left = []
        self.temporary = Path(tempfile.mkdtemp(prefix="scl-"))
        # As the usual one: some tests have programs of another user.
        self.temporary.chmod(0o1777)

    def find(self):
        problems = processes_left()
        problems += [file[3:] for file in sorted(changed_files() - self.changed)]
        self.shared_left = shared_memory_left(self.shared)
        problems += [f"shared memory {name}" for name in self.shared_left]
        for path in sorted(self.temporary.iterdir()):
            if not MEANT_TO_STAY.match(path.name):
                names = sorted(str(inside.relative_to(path)) for inside in path.rglob("*"))
                problems.append(f"temporary {path.name}" + (f" with {', '.join(names[:5])}" if names else ""))
        return [f"left behind: {problem}" for problem in problems]

    def remove(self):
        processes.kill_all()
        for name in self.shared_left:
            Path(SHARED_MEMORY, name).unlink(missing_ok=True)
        shutil.rmtree(self.temporary, ignore_errors=True)


def processes_left():
    processes.reap()
    left = []
    for process in processes.descendants():
        what = processes.describe(process)
        # Cargo and compilers' servers may take a moment to end.
        deadline = time.monotonic() + 10
        while Path(f"/proc/{process}").exists() and time.monotonic() < deadline:
            time.sleep(0.1)
            processes.reap()
        if what and Path(f"/proc/{process}").exists():
            left.append(what)
    processes.kill_all()
    return left


def shared_memory_left(before):
    """Files that no program uses. Those of another gate's programs belong to no program for a moment when it kills some."""
    deadline = time.monotonic() + 10
    while True:
        left = sorted(shared_memory() - before - in_use())
        if not left or time.monotonic() > deadline:
            return left
        time.sleep(0.1)


def shared_memory():
    return {name for name in os.listdir(SHARED_MEMORY) if OURS.match(name)}


def in_use():
    used = set()
    for maps in Path("/proc").glob("[0-9]*/maps"):
        try:
            used |= set(re.findall(f"{SHARED_MEMORY}/(\\S+)", maps.read_text()))
        # It has ended.
        except OSError:
            pass
    return used


def changed_files():
    """What git would commit."""
    output = subprocess.run(["git", "status", "--porcelain", "--untracked-files=all"], capture_output=True, text=True)
    return set(output.stdout.splitlines())
