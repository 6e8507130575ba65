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
pub use system::{Choice, ChoiceValue, Component, Gate, Instance, MessageUse, Parameter, SenderValue, Senders, System};
pub use zmq::Format;

use clash::Declaration;
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

/// What the module of a language provides.
struct Language {
    /// The names that its files declare, so that clashes are reported.
    declarations: fn(&System) -> Vec<Declaration>,
    /// The contents of its files.
    files: fn(&System) -> Vec<File>,
}

impl Target {
    fn language(self) -> Language {
        let sockets = |files| Language { declarations: |_| Vec::new(), files };
        match self {
            Target::Zmq(Format::Json) => sockets(zmq::json),
            Target::Zmq(Format::Yaml) => sockets(zmq::yaml),
            Target::C => Language { declarations: c::declarations, files: c::files },
            Target::Cpp => Language { declarations: cpp::declarations, files: cpp::files },
            Target::Python => Language { declarations: python::declarations, files: python::files },
        }
    }
}

/// Makes the files for one language.
///
/// # Errors
/// What [`find_clashes`] finds.
pub fn generate(system: &System, target: Target) -> Result<Vec<File>, Vec<Diagnostic>> {
    match find_clashes(system, target) {
        clashes if clashes.is_empty() => Ok((target.language().files)(system)),
        clashes => Err(clashes),
    }
}

/// Finds names of the topology that would clash or be invalid in that language, each with its places in the topology
/// file.
pub fn find_clashes(system: &System, target: Target) -> Vec<Diagnostic> {
    let mut clashes = clash::find(&(target.language().declarations)(system));
    if target == Target::Cpp {
        clashes.extend(cpp::unwritable(system));
    }
    clashes
}
