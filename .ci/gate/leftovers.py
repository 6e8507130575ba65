"""What a stage leaves behind: processes, files that git does not ignore, temporary files."""

import re
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import processes

# Of temporary files: what pytest keeps of its last runs, and the runtime folder of a user.
MEANT_TO_STAY = re.compile(r"pytest-of-|scl-\d+$")


class Leftovers:
    """Begins before the stage, which gets a folder for temporary files of its own."""

    def __init__(self):
        self.changed = changed_files()
        self.temporary = Path(tempfile.mkdtemp(prefix="scl-"))
        # As the usual one: some tests have programs of another user.
        self.temporary.chmod(0o1777)

    def find(self):
        problems = processes_left()
        problems += [file[3:] for file in sorted(changed_files() - self.changed)]
        for path in sorted(self.temporary.iterdir()):
            if not MEANT_TO_STAY.match(path.name):
                names = sorted(str(inside.relative_to(path)) for inside in path.rglob("*"))
                problems.append(f"temporary {path.name}" + (f" with {', '.join(names[:5])}" if names else ""))
        return [f"left behind: {problem}" for problem in problems]

    def remove(self):
        processes.kill_all()
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


def changed_files():
    """What git would commit."""
    output = subprocess.run(["git", "status", "--porcelain", "--untracked-files=all"], capture_output=True, text=True)
    return set(output.stdout.splitlines())
