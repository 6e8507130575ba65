"""Faults that must make the gate red, one for each stage.

`SCL_CANARY=lints .ci/run lints` plants the fault of `lints` while that stage runs. `.ci/canaries` does so with all of them.
"""

import dataclasses
import os
from pathlib import Path

TESTS = "tests/tests/main.rs"
TESTS_WITH_TOOLS = "tests/languages/tests/main.rs"
LEFT_BEHIND = Path("tests/canary")


@dataclasses.dataclass
class Canary:
    file: str
    # Replaces `old`, or is added at the end.
    new: str
    # What the report must say.
    says: list
    old: str = ""
    # Only these tests run.
    tests: str = ""


def test(name, body, attribute=""):
    return f"\n#[test]\n{attribute}fn canary_{name}() {{\n    {body}\n}}\n"


FAULTY_TESTS = (
    test("fails", 'panic!("on purpose");')
    + test("is_ignored", "", '#[ignore = "needs nothing"]\n')
    + test("leaves_a_file", 'std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/canary"), "").unwrap();')
    + test("leaves_a_temporary_file", 'std::fs::write(std::env::temp_dir().join("canary"), "").unwrap();')
    + test("leaves_shared_memory", 'std::fs::write("/dev/shm/scl_canary", "").unwrap();')
    + test("leaves_a_process", 'std::process::Command::new("setsid").args(["sleep", "3600"]).spawn().unwrap();')
    + test("kills_itself", "std::process::abort();")
)
FOUND = ["canary_fails", "on purpose", "canary_is_ignored", "canary_kills_itself"]
LEFT = ["process", LEFT_BEHIND, "temporary canary", "shared memory scl_canary"]
FOUND += [f"left behind: {what}" for what in LEFT] + ["sleep 3600"]
HANGING_TEST = test("hangs", "loop { std::thread::park(); }")

CANARIES = {
    "packages": Canary(".ci/packages", 'packages=(no-such-package "$@" ', ["exit code"], old='packages=("$@" '),
    "tools": Canary(".ci/tools", "cargo-no-such-tool@0.0.0 ", ["exit code"], old="cargo-deny@0.20.2 "),
    "format": Canary(TESTS, "fn  canary( ) {}\n", ["exit code"]),
    "cycles": Canary("crates/scl-terminal/src/print.rs", "use crate::table::Table;\n", ["exit code"]),
    "promises": Canary("docs/shutdown.md", "exit::canary", ["exit code"], old="exit::a_panic_is_exit_code_101"),
    "style": Canary("crates/scl-terminal/src/print.rs", f"// {'word ' * 30}\n", ["exit code"]),
    "lints": Canary(TESTS, "fn canary() {}\n", ["exit code"]),
    "docs": Canary("tests/src/lib.rs", "/// [`Nothing`]\npub fn canary() {}\n", ["exit code"]),
    "dependencies": Canary("deny.toml", "", ["exit code"], old='"MIT", '),
    "features": Canary(
        "crates/scl-cli/src/main.rs", '#[cfg(not(feature = "observe"))]\ncompile_error!("on purpose");\n', ["exit code"]
    ),
    "packaging": Canary("crates/scl-terminal/Cargo.toml", 'readme = "canary"\nversion.', ["exit code"], old="version."),
    "cargo test": Canary(TESTS, FAULTY_TESTS, FOUND, tests=" -p scl-tests --test tests canary_"),
    "tests": Canary(
        TESTS_WITH_TOOLS,
        FAULTY_TESTS + HANGING_TEST,
        FOUND + ["started by the test canary_leaves_a_process", "canary_hangs"],
        tests=" -E 'test(/^canary_/)'",
    ),
    "allocations": Canary(
        "bench/tests/allocations.rs", "TOLERANCE: f64 = -1.0;", ["exit code"], old="TOLERANCE: f64 = 10.0;"
    ),
    "wheel": Canary("bindings/python/python/scl/__init__.py", 'raise ImportError("on purpose")\n', ["exit code"]),
}


def wanted():
    """The name of a stage, or `None`."""
    return os.environ.get("SCL_CANARY")


def plant(stage):
    """Changes the stage's command and a file, if its canary is wanted."""
    if wanted() != stage.name:
        return None
    stage.command += CANARIES[stage.name].tests
    return Planted(CANARIES[stage.name])


class Planted:
    """The fault is there until it is removed."""

    def __init__(self, canary):
        self.file = Path(canary.file)
        self.original = self.file.read_text()
        if canary.old not in self.original:
            raise SystemExit(f"error: `{canary.old}` is not in {canary.file}, so the canary cannot be planted")
        text = self.original.replace(canary.old, canary.new, 1) if canary.old else self.original + canary.new
        self.file.write_text(text)

    def remove(self):
        self.file.write_text(self.original)
        LEFT_BEHIND.unlink(missing_ok=True)
