"""What the tests share."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

PYTHON_FOLDER = Path(__file__).parents[1]
HANG_LIMIT = 60.0  # s; only a test that would hang otherwise ever reaches it

RunProgram = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture
def run_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> RunProgram:
    """Runs a program of this folder to its end, apart from systems that run on the same machine."""
    monkeypatch.setenv("SCL_RUNTIME_DIR", str(tmp_path / "run"))
    (tmp_path / "run").mkdir(mode=0o700)

    def run(*arguments: str) -> "subprocess.CompletedProcess[str]":
        command = [sys.executable, *arguments]
        return subprocess.run(
            command, check=False, cwd=PYTHON_FOLDER, capture_output=True, text=True, timeout=HANG_LIMIT
        )

    return run
