"""Runs a stage: its output is shown and kept, what it leaves behind is found and removed."""

import dataclasses
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import canaries
import processes
import stages
import tests

# Everything is built once, so nothing is kept to speed up the next build, and nothing is stored for debuggers: a panic names
# its line without.
BUILD = {"CARGO_INCREMENTAL": "0", "CARGO_PROFILE_DEV_DEBUG": "0", "CARGO_TERM_COLOR": "never", "RUST_BACKTRACE": "1"}


@dataclasses.dataclass
class Result:
    name: str
    log: Path
    seconds: float
    problems: list
    failed: list = dataclasses.field(default_factory=list)
    flaky: list = dataclasses.field(default_factory=list)


class Runner:
    def __init__(self, which):
        self.which = which
        self.planted = None
        self.logs = Path("target/gate/canary" if canaries.wanted() else "target/gate")
        self.logs.mkdir(parents=True, exist_ok=True)
        processes.adopt_orphans()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, self.interrupted)

    def interrupted(self, number, _frame):
        signal.signal(number, signal.SIG_IGN)
        processes.kill_all()
        self.remove_canary()
        print(f"error: interrupted by {signal.Signals(number).name}", file=sys.stderr)
        os._exit(128 + number)

    def run(self, stage):
        self.planted = canaries.plant(stage)
        try:
            result = self.run_once(stage)
            if stage.name == "cargo test" and result.failed and self.which == "gate":
                self.try_again(result)
            return result
        finally:
            self.remove_canary()

    def remove_canary(self):
        if self.planted:
            self.planted.remove()
            self.planted = None

    def run_once(self, stage):
        print(f"\n==== {stage.name}: {stage.command}", flush=True)
        before, started = changed_files(), time.monotonic()
        junit = tests.junit_of(stage.command)
        if junit:
            junit.unlink(missing_ok=True)
        code, log = self.execute(stage)
        problems = [] if code == 0 else [f"exit code {code}" if code is not None else f"hangs: over {stage.minutes} minutes"]
        problems += left_behind(before)
        result = Result(stage.name, self.log_of(stage), time.monotonic() - started, problems)
        result.failed, result.flaky, ignored = tests.read(stage, junit, log)
        problems += [f"ignored: {name}" for name in ignored]
        print(f"==== {stage.name}: {'FAILED' if problems else 'passed'} after {result.seconds:.0f} s", flush=True)
        return result

    def log_of(self, stage):
        return self.logs / f"{stage.name.replace(' ', '-')}.log"

    def execute(self, stage):
        """The exit code, `None` if it hangs, and the output."""
        tools = Path("target/tools/bin").absolute()
        environment = {**os.environ, **BUILD, **stage.environment, "PATH": f"{os.environ['PATH']}:{tools}"}
        process = subprocess.Popen(
            ["bash", "-c", stage.command],
            env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True, errors="replace", start_new_session=True,
        )
        lines = []

        def read():
            with open(self.log_of(stage), "w") as file:
                for line in process.stdout:
                    lines.append(line)
                    file.write(line)
                    sys.stdout.write(line)
                    sys.stdout.flush()

        reader = threading.Thread(target=read)
        reader.start()
        try:
            code = process.wait(stage.minutes * 60)
        except subprocess.TimeoutExpired:
            code = None
            processes.kill_all()
        # What keeps the output open is left behind, and is found below.
        reader.join(10)
        return code, "".join(lines)

    def try_again(self, result):
        """Tests that failed in `cargo test` get the same two more tries as those under nextest, which does not know examples in
        documentation."""
        if any(binary.startswith(tests.DOCUMENTATION) for binary, _ in result.failed):
            return
        again = self.run_once(stages.again(result.failed))
        result.seconds += again.seconds
        if again.problems:
            result.problems += again.problems
            result.failed += [test for test in again.failed if test not in result.failed]
        else:
            result.flaky = [f"{binary} {name}" for binary, name in result.failed]
            result.failed = []
            result.problems = [problem for problem in result.problems if not problem.startswith("exit code")]


def changed_files():
    """What git would commit, without what it ignores."""
    output = subprocess.run(["git", "status", "--porcelain", "--untracked-files=all"], capture_output=True, text=True)
    return set(output.stdout.splitlines())


def left_behind(before):
    processes.reap()
    problems = []
    for process in processes.descendants():
        what = processes.describe(process)
        # Cargo and compilers' servers may take a moment to end.
        deadline = time.monotonic() + 10
        while Path(f"/proc/{process}").exists() and time.monotonic() < deadline:
            time.sleep(0.1)
            processes.reap()
        if what and Path(f"/proc/{process}").exists():
            problems.append(f"left behind: {what}")
    processes.kill_all()
    return problems + [f"left behind: {file[3:]}" for file in sorted(changed_files() - before)]
