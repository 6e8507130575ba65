//! The systems of the paper: the aircraft flies, the radio tunes, and both survive the death of their parts.
#![cfg(all(feature = "generate", feature = "record", feature = "run"))]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod arcade;
mod lines;
mod ospecorr;
mod processes;
mod simulated;
#[allow(dead_code, reason = "the other tests use the rest")]
#[path = "../system/mod.rs"]
mod system;
mod units;

/// The messages of the aircraft.
#[allow(deprecated, reason = "a warning about the path, which matters for packages that are published")]
mod aircraft {
    scl::topology!("../../examples/arcade/topology.yaml");
}

/// The messages of the radio.
#[allow(deprecated, reason = "a warning about the path, which matters for packages that are published")]
mod radio {
    scl::topology!("../../examples/ospecorr/topology.yaml");
}

use std::fs::File;
use std::path::PathBuf;

/// One test at a time, of this process or another one: they run in real time, and build into the same folders.
fn lock_machine() -> File {
    let folder = workspace().join("target/examples");
    std::fs::create_dir_all(&folder).unwrap();
    scl_tests::lock_file(&folder.join("tests.lock"))
}

/// The folder of an example.
fn example(name: &str) -> PathBuf {
    workspace().join("examples").join(name)
}

/// Where an example is built to.
fn built(name: &str) -> PathBuf {
    workspace().join("target/examples").join(name)
}

fn workspace() -> PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap().to_owned()
}
