//! Code and configuration for other languages, made from a checked topology: what `scl generate` writes.
//!
//! ```text
//! Loaded --System::of--> System --find clashes--> names that work --generate--> files --write--> folder
//! ```
//!
//! Each language is one module with two functions: `declarations` lists the names that its files declare, so that
//! clashes are reported with their places in the topology file, and `files` generates the texts.
#![cfg_attr(test, allow(clippy::unwrap_used))]
#![deny(missing_docs)]

mod c;
mod clash;
mod comment;
mod cpp;
mod identifier;
mod output;
mod python;
mod system;
mod writer;
mod zmq;

pub use output::{File, Outcome, OutputError, is_current, write};
pub use system::{Component, Gate, MessageUse, System};
pub use zmq::Format;

use scl_topology::diagnostic::Diagnostic;

/// What to generate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// The sockets of the system, for programs with only a ZeroMQ library.
    Zmq(Format),
    /// A C header and source over `scl.h`.
    C,
    /// A C++ header over `scl.hpp`.
    Cpp,
    /// A Python module over the package `scl`.
    Python,
}

/// Makes the files for one language.
///
/// # Errors
/// What [`find_clashes`] finds.
pub fn generate(system: &System, target: Target) -> Result<Vec<File>, Vec<Diagnostic>> {
    let clashes = find_clashes(system, target);
    if !clashes.is_empty() {
        return Err(clashes);
    }
    Ok(match target {
        Target::Zmq(format) => zmq::files(system, format),
        Target::C => c::files(system),
        Target::Cpp => cpp::files(system),
        Target::Python => python::files(system),
    })
}

/// Finds names of the topology that would clash or be invalid in that language, each with its places in the topology
/// file.
pub fn find_clashes(system: &System, target: Target) -> Vec<Diagnostic> {
    let declarations = match target {
        Target::Zmq(_) => Vec::new(),
        Target::C => c::declarations(system),
        Target::Cpp => cpp::declarations(system),
        Target::Python => python::declarations(system),
    };
    let mut clashes = clash::find(&declarations);
    if target == Target::Cpp {
        clashes.extend(cpp::unwritable(system));
    }
    clashes
}
