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
    # Tests that fail get two more tries, as nextest gives them to its own.
    tried_again: bool = False


# With the features that take long to compile, and so with the same dependencies.
EVERYTHING = "--workspace --locked --features scl-cli/gateway,scl-cli/shm"
COMPILED_BY_LINTS = "--exclude-features default,nightly,libzmq,gateway,shm"
ALL_TESTS = "--lib --bins --test '*'"
# The packages with tests that `cargo test` does not run. Their features decide how dependencies are compiled, so stages that
# share these share a build. What the tests build themselves shares it, too, where `SCL_TEST_PACKAGES` says so.
NEED_MORE = "--features scl-cli/bench " + " ".join(
    f"-p {package}"
    for package in ["scl-c", "scl-cli", "scl-generate", "scl-tests"]
    + ["any-language", "arcade", "ospecorr", "scl-bench", "scl-foxglove", "scl-gateway", "scl-python", "tls-listener"]
)


def stages(which):
    return GATE if which == "gate" else FULL


def clippy(targets):
    return f"cargo clippy {EVERYTHING} {targets} -- -D warnings"


def nextest(profile, *options):
    return f"cargo nextest run --profile {profile} --locked {ALL_TESTS} {' '.join(options)}"


def again(failed):
    """Two more tries of tests that failed in `cargo test`, by the names of their binaries."""
    return Stage("again", nextest("default", "--retries 1 -E", shlex.quote(" + ".join(map(filter_of, failed)))), 30)


def filter_of(failed):
    binary, name = failed
    # Cargo names the file of a binary with underscores.
    binary = f"binary(/^{binary.replace('_', '[-_]')}$/)"
    return binary if name == tests.ALL else f"({binary} & test(={name}))"


def features(*packages_and_features):
    return " && ".join(f"cargo hack check --quiet --locked {options}" for options in packages_and_features)


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
    Stage("style", ".ci/style"),
    Stage("promises", ".ci/promises"),
    # `--all-targets` leaves out the tests that `cargo test` leaves out.
    Stage("lints", f"{clippy('--all-targets')} && {clippy(ALL_TESTS)}"),
    # Without tests that are libraries only to be compiled.
    Stage("docs", f"cargo doc {EVERYTHING} --no-deps --exclude scl-name-tests --exclude scl-ui-tests", environment={"RUSTDOCFLAGS": "-D warnings"}),
    Stage("dependencies", ".ci/dependencies"),
    # Every crate can be packaged: its dependencies have versions, and what its manifest names is inside its folder. Without
    # compiling the packages, which would build every crate a second time (`cargo package --workspace` does, in some minutes).
    Stage("packaging", "cargo package --workspace --no-verify --locked --allow-dirty --quiet --exclude-lockfile"),
]

WHOLE_WORKSPACE = "--workspace --features scl-cli/bench"
BUSY = f".ci/packages stress-ng && .ci/busy {nextest('busy', WHOLE_WORKSPACE)}"
ALLOCATIONS = Stage("allocations", f"cargo test --locked {NEED_MORE} --test allocations")

GATE = [
    *CHECKS,
    # `.ci/full` has the rest.
    Stage("features", features("--no-default-features -p scl-gates -p scl-cli -p scl-loader -p scl-macros")),
    Stage("cargo test", second_command(), 40, tried_again=True),
    # The other languages, editors, the gateway, the benchmarks: what `cargo test` alone does not run.
    Stage("tests", nextest("gate", NEED_MORE), 40, {"SCL_TEST_PACKAGES": NEED_MORE}),
    ALLOCATIONS,
    Stage("wheel", ".ci/wheel"),
]

FULL = [
    *CHECKS,
    # Every feature compiles by itself, and those of the macro in pairs.
    Stage(
        "features",
        features(
            f"--each-feature {COMPILED_BY_LINTS} -p scl-cli -p scl-gates",
            f"--feature-powerset --depth 2 {COMPILED_BY_LINTS} -p scl-loader -p scl-macros",
        ),
    ),
    Stage("rust-analyzer", ".ci/rust-analyzer", 40),
    Stage("cargo test", second_command(), 60, {"SCL_TEST_SCHEMAS": "500"}),
    # Their builds select one package each, as a user's do.
    Stage("tests", nextest("full", NEED_MORE), 90, {"SCL_TEST_LONG": "1", "SCL_TEST_SCHEMAS": "500"}),
    ALLOCATIONS,
    Stage("wheel", ".ci/wheel"),
    Stage("canaries", ".ci/canaries", 60),
    *(Stage(f"busy {run}", BUSY, 120, {"SCL_TEST_PACKAGES": WHOLE_WORKSPACE}) for run in (1, 2, 3)),
]
