"""What is checked, in order."""

import dataclasses
import re
import shlex
from pathlib import Path

import tests


@dataclasses.dataclass
class Stage:
    """A command of the shell in the top folder, and the minutes after which it counts as hanging."""

    name: str
    command: str
    minutes: int = 20
    environment: dict = dataclasses.field(default_factory=dict)


# With the features that take long to compile, and so with the same dependencies.
EVERYTHING = "--workspace --locked --features scl-cli/gateway,scl-cli/shm"
# The tests of all packages, also those that `cargo test` alone does not run.
ALL_TESTS = "--workspace --locked --lib --bins --test '*'"


def stages(which):
    return GATE if which == "gate" else FULL


def nextest(profile, *options):
    return f"cargo nextest run --profile {profile} {ALL_TESTS} --no-fail-fast {' '.join(options)}"


def again(failed):
    """Two more tries of tests that failed in `cargo test`, by the names of their binaries."""
    return Stage("again", nextest("again", "--retries 1 -E", shlex.quote(" + ".join(map(filter_of, failed)))), 30)


def filter_of(failed):
    binary, name = failed
    # Cargo names the file of a binary with underscores.
    binary = f"binary(/^{binary.replace('_', '[-_]')}$/)"
    return binary if name == tests.ALL else f"({binary} & test(={name}))"


def second_command():
    """The second command of README.md, which ends at the first binary with a failure if it is not told otherwise."""
    readme = Path("README.md").read_text()
    if not re.search(r"^cargo test$", readme, re.M):
        return "echo 'error: README.md does not show `cargo test` on a line of its own' >&2; exit 1"
    return "cargo test --no-fail-fast"


CHECKS = [
    Stage("packages", ".ci/packages"),
    Stage("tools", ".ci/tools"),
    Stage("format", "cargo fmt --all --check"),
    Stage("cycles", ".ci/cycles"),
    Stage("lints", f"cargo clippy {EVERYTHING} --all-targets --test with_tools --test examples -- -D warnings"),
    Stage("docs", f"cargo doc {EVERYTHING} --no-deps", environment={"RUSTDOCFLAGS": "-D warnings"}),
    Stage("dependencies", ".ci/dependencies"),
    # Every feature compiles by itself, and those of the macro in pairs, except the two that the lints have compiled.
    Stage(
        "features",
        "check='cargo hack check --quiet --locked --exclude-features default,nightly,libzmq,gateway,shm'; "
        "$check --each-feature -p scl-cli -p scl-gates && $check --feature-powerset --depth 2 -p scl-loader -p scl-macros",
    ),
    # Every crate can be packaged: its dependencies have versions, and what its manifest names is inside its folder. Without
    # compiling the packages, which would build every crate a second time (`cargo package --workspace` does, in some minutes).
    Stage("packaging", "cargo package --workspace --no-verify --locked --allow-dirty --quiet --exclude-lockfile"),
]

GATE = [
    *CHECKS,
    Stage("cargo test", second_command(), 40),
    # The other languages, editors, the gateway, the benchmarks: what `cargo test` alone does not run.
    Stage("tests", nextest("gate"), 40),
    Stage("allocations", "cargo test --workspace --locked --test allocations"),
    Stage("wheel", ".ci/wheel"),
]

FULL = [
    *CHECKS,
    Stage("rust-analyzer", ".ci/rust-analyzer", 40),
    Stage("cargo test", second_command(), 60),
    Stage("tests", nextest("full"), 90, {"SCL_TEST_LONG": "1"}),
    Stage("allocations", "cargo test --workspace --locked --test allocations"),
    Stage("wheel", ".ci/wheel"),
    Stage("canaries", ".ci/canaries", 60),
    *(Stage(f"busy {run}", f".ci/packages stress-ng && .ci/busy {nextest('busy')}", 120) for run in (1, 2, 3)),
]
