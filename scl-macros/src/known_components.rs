//! The components of the topologies that were expanded so far in this crate, so that `#[scl::main]` can name them when
//! it meets an unknown one.
//!
//! This affects only the wording of errors; rustc decides whether a component exists.

use std::sync::{Mutex, PoisonError};

/// A topology file as the macro read it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct KnownTopology {
    /// The path in the macro call.
    pub(crate) path: String,
    /// The components, in file order.
    pub(crate) components: Vec<KnownComponent>,
    /// Whether the file has errors, so that components may be missing.
    pub(crate) broken: bool,
    /// The name of the type that stands for what could not be read.
    pub(crate) unknown_type: String,
}

/// A component or a kind of a topology file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct KnownComponent {
    /// The name in the file.
    pub(crate) name: String,
    /// The name of its struct.
    pub(crate) rust_name: String,
    /// Whether the struct is generated, as far as `only` is concerned.
    pub(crate) included: bool,
    /// Of a kind, its components: their names in Rust.
    pub(crate) instances: Vec<String>,
}

/// The topologies of each crate. rust-analyzer expands macros of several crates in one process, so the crate's name
/// comes first.
static KNOWN: Mutex<Vec<(String, KnownTopology)>> = Mutex::new(Vec::new());

/// Number of earlier expansions that are remembered; older ones are forgotten, because an editor expands again with
/// each key.
const MOST: usize = 100;

pub(crate) fn remember(topology: KnownTopology) {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let krate = krate();
    known.retain(|(other, it)| *other != krate || it.path != topology.path);
    known.truncate(MOST);
    known.insert(0, (krate, topology));
}

/// The topologies of the crate that is compiled, the latest first.
pub(crate) fn of_crate() -> Vec<KnownTopology> {
    let krate = krate();
    let known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    known.iter().filter(|(other, _)| *other == krate).map(|(_, topology)| topology.clone()).collect()
}

fn krate() -> String {
    let variable = |name| std::env::var(name).unwrap_or_default();
    format!("{} {}", variable("CARGO_MANIFEST_DIR"), variable("CARGO_CRATE_NAME"))
}
