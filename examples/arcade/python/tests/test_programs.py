"""The programs as processes: how they end, and that one that fails is started again."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from conftest import HANG_LIMIT, PYTHON_FOLDER, RunProgram

pytestmark = pytest.mark.usefixtures("own_system")

BROKEN = {
    "configuration": """
import configuration
def broken(parameters): raise RuntimeError("broken on purpose")
configuration.limits_of = broken
configuration.main()
""",
    "power_management": """
import power_management, power_monitor
def broken(monitor, now, reading): raise RuntimeError("broken on purpose")
power_monitor.Monitor.update = broken
power_management.main()
""",
    "mission_arbiter": """
import asyncio, mission_arbiter
def broken(arbiter, now, event): raise RuntimeError("broken on purpose")
mission_arbiter.Arbiter.step = broken
asyncio.run(mission_arbiter.main())
""",
}


@pytest.mark.parametrize("component", BROKEN)
def test_a_program_that_raises_fails_with_a_traceback(component: str, run_program: RunProgram) -> None:
    finished = run_program("-c", BROKEN[component])
    assert finished.returncode == 1
    assert finished.stderr.startswith("Traceback")
    assert "RuntimeError: broken on purpose" in finished.stderr


@pytest.mark.parametrize("component", BROKEN)
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_program_that_is_asked_to_stop_ends_well(component: str, number: signal.Signals) -> None:
    pipe = subprocess.PIPE
    # A shell that starts the tests in the background ignores SIGINT, and the programs would inherit that.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    command = [sys.executable, f"{component}.py"]
    with subprocess.Popen(command, cwd=PYTHON_FOLDER, stdout=pipe, stderr=pipe, text=True) as process:
        assert process.stdout is not None
        # Each prints a line once it is open, at the latest when it misses its peers.
        assert process.stdout.readline()
        process.send_signal(number)
        _, errors = process.communicate(timeout=HANG_LIMIT)
    assert process.returncode == 0
    assert "Traceback" not in errors and "never retrieved" not in errors


def test_a_program_that_raised_is_started_again(tmp_path: Path) -> None:
    (tmp_path / "broken_once.py").write_text(
        f"import pathlib, runpy, sys\nsys.path.insert(0, {str(PYTHON_FOLDER)!r})\n"
        "marker = pathlib.Path('started'); again = marker.exists(); marker.touch()\n"
        "if not again: raise RuntimeError('broken on purpose')\n"
        "print('started again', flush=True)\n"
        f"runpy.run_path({str(PYTHON_FOLDER / 'power_management.py')!r}, run_name='__main__')\n"
    )
    (tmp_path / "launch.yaml").write_text(
        f"topology: {PYTHON_FOLDER.parent / 'topology.yaml'}\n"
        "components:\n"
        f"  power_management: {{command: [{sys.executable}, broken_once.py], restart: on_failure, restart_delay: 1ms}}\n"
    )
    command = [os.environ.get("SCL", "scl"), "run", str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as run:
        assert run.stdout is not None
        assert any("started again" in line for line in run.stdout)
        run.terminate()
        _, errors = run.communicate(timeout=HANG_LIMIT)
    assert "RuntimeError: broken on purpose" in errors
