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
from leftovers import Leftovers

# Everything is built once, so nothing is kept to speed up the next build, and nothing is stored for debuggers: a panic names
# its line without.
BUILD = {"CARGO_INCREMENTAL": "0", "CARGO_PROFILE_DEV_DEBUG": "0", "CARGO_TERM_COLOR": "never", "RUST_BACKTRACE": "1"}
FAILED = "exit code "


@dataclasses.dataclass
class Result:
    name: str
    logs: list
    seconds: float
    problems: list
    failed: list = dataclasses.field(default_factory=list)
    flaky: list = dataclasses.field(default_factory=list)


class Runner:
    def __init__(self):
        # The fault and the leftovers of the stage that runs.
        self.planted = self.leftovers = None
        self.logs = Path("target/gate/canary" if canaries.wanted() else "target/gate")
        self.logs.mkdir(parents=True, exist_ok=True)
        # The tools of `.ci/tools`, if the machine has none of its own.
        os.environ.update(BUILD, PATH=f"{os.environ['PATH']}:{Path('target/tools/bin').absolute()}")
        processes.adopt_orphans()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, self.interrupted)

    def interrupted(self, number, _frame):
        signal.signal(number, signal.SIG_IGN)
        self.clean_up()
        print(f"error: interrupted by {signal.Signals(number).name}", file=sys.stderr)
        os._exit(128 + number)

    def run(self, stage):
        started = time.monotonic()
        try:
            self.planted = canaries.plant(stage)
            result = self.run_once(stage)
            if stage.tried_again and result.failed:
                self.try_again(result)
        # Such as a full disk.
        except OSError as error:
            print(f"==== {stage.name}: {error}", flush=True)
            result = Result(stage.name, [], time.monotonic() - started, [str(error)])
        finally:
            self.clean_up()
        return result

    def clean_up(self):
        for what in (self.leftovers, self.planted):
            if what:
                what.remove()
        self.planted = self.leftovers = None

    def run_once(self, stage):
        print(f"\n==== {stage.name}: {stage.command}", flush=True)
        started = time.monotonic()
        junit = tests.junit_of(stage.command)
        if junit:
            junit.unlink(missing_ok=True)
        self.leftovers = Leftovers()
        problems = self.execute(stage) + self.leftovers.find()
        self.leftovers.remove()
        log = self.log_of(stage)
        result = Result(stage.name, [log], time.monotonic() - started, problems)
        result.failed, result.flaky, ignored = tests.read(stage, junit, log.read_text(errors="replace"))
        problems += [f"ignored: {name}" for name in ignored]
        print(f"==== {stage.name}: {'FAILED' if problems else 'passed'} after {result.seconds:.0f} s", flush=True)
        return result

    def log_of(self, stage):
        return self.logs / f"{stage.name.replace(' ', '-')}.log"

    def execute(self, stage):
        """Problems, none if the command succeeds."""
        problems = []
        with open(self.log_of(stage), "wb", buffering=0) as log:
            process = subprocess.Popen(
                ["bash", "-c", stage.command],
                env={**os.environ, "TMPDIR": str(self.leftovers.temporary), **stage.environment},
                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True,
            )
            reader = threading.Thread(target=keep_output, args=(process.stdout, log, problems))
            reader.start()
            try:
                code = process.wait(stage.minutes * 60)
                if code != 0:
                    problems.append(f"{FAILED}{code}")
            except subprocess.TimeoutExpired:
                problems.append(f"hangs: over {stage.minutes} minutes")
                processes.kill_all()
            # What keeps the output open is left behind, and is found.
            reader.join(10)
        return problems

    def try_again(self, result):
        """Tests that failed in `cargo test` get the same two more tries as those under nextest, which does not know examples in
        documentation."""
        if any(binary.startswith(tests.DOCUMENTATION) for binary, _ in result.failed):
            return
        again = self.run_once(stages.again(result.failed))
        result.seconds += again.seconds
        result.logs += again.logs
        if again.problems:
            result.problems += again.problems
            result.failed += [test for test in again.failed if test not in result.failed]
        else:
            result.flaky = [f"{binary} {name}" for binary, name in result.failed]
            result.failed = []
            result.problems = [problem for problem in result.problems if not problem.startswith(FAILED)]


def keep_output(output, log, problems):
    """Reads all of it, also while the disk is full, because a full pipe stops the stage."""
    incomplete = None
    for line in output:
        try:
            log.write(line)
            sys.stdout.buffer.write(line)
            sys.stdout.flush()
        except (OSError, ValueError) as error:
            incomplete = error
    if incomplete:
        problems.append(f"its output is incomplete: {incomplete}")
