//! Reads a topology file, the files that it includes, and the schema files they name, from disk, and has them checked.
//!
//! The macro and the command line share this crate, so that both read files in the same way and report the same
//! messages. It is the only part of SCL that reads these files; `scl-topology` judges their content.
//!
//! ```text
//! Request --read--> texts --parse, join--> Model --compile--> messages --check--> Topology --resolve--> Plan
//! ```
#![cfg_attr(test, allow(clippy::unwrap_used))]
#![deny(missing_docs)]

mod files;
mod includes;
mod name_each;
mod no_panic;
mod paths;
mod plan;
mod read;
mod request;
mod schemas;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod trial;
mod unreadable;

pub use includes::Included;
pub use no_panic::{BUG, no_panic};
pub use request::{LookedIn, Request};
pub use schemas::{Outline, Schemas, rust};
#[cfg(feature = "protobuf")]
pub use schemas::{files_for, walk};

use scl_topology::check::{Facts, check_with_parts};
use scl_topology::diagnostic::{Diagnostic, Diagnostics};
use scl_topology::model::Model;
use scl_topology::source::{FileId, Sources, Span};
use scl_topology::topology::Topology;
use std::path::{Path, PathBuf};

/// The result of reading one topology file and those that it includes. A stage that cannot continue leaves what it has.
#[derive(Debug, Default)]
pub struct Loaded {
    /// The texts that the diagnostics point into.
    pub sources: Sources,
    /// The topology file among them; `None` if it could not be read.
    pub file: Option<FileId>,
    /// The files that it includes, and those that they include, in the order in which they were read.
    pub included: Vec<Included>,
    /// The topology as written in all these files, as far as they could be read.
    pub model: Model,
    /// The checked topology; `None` if one of the diagnostics is an error, or if the file was only read, as by
    /// [`read()`].
    pub topology: Option<Topology>,
    /// What was found, sorted by position: errors, warnings and lints.
    pub diagnostics: Vec<Diagnostic>,
    /// The files that were read: a change of one of them may change the result.
    pub files_read: Vec<PathBuf>,
    /// The compiled schemas; `None` if the file names none, or if one of them is wrong.
    pub schemas: Option<Schemas>,
    /// What the schemas seem to declare if one of them is wrong; otherwise empty.
    pub outlines: Vec<Outline>,
}

impl Loaded {
    /// A place such as `topology.yaml:14:9`, for generated code. The topology file is called `main`, and a file that it
    /// includes is in the same folder or below it.
    pub fn place(&self, span: Span, main: &str) -> String {
        let at = self.sources.file(span.file).line_column(span.start);
        let included = self.included.iter().find(|included| included.file == span.file);
        let path = included.map(|included| Path::new(main).with_file_name(&included.relative).display().to_string());
        format!("{}:{}:{}", path.as_deref().unwrap_or(main), at.line, at.column)
    }
}

/// Reads, parses and checks one topology file.
///
/// Never panics and never blocks: anything but a regular file is not opened, and no file is read past its limit. All
/// problems are reported together, in [`Loaded::diagnostics`].
pub fn load(request: &Request) -> Loaded {
    checked(request, read(request))
}

/// As [`load`], with the bytes of the topology file from elsewhere, for example standard input.
///
/// The request's path is not read; it determines where schemas are searched for and the system's default name. Bytes
/// past the limit and invalid UTF-8 are refused as in a file.
pub fn load_bytes(request: &Request, bytes: Vec<u8>) -> Loaded {
    checked(request, read_bytes(request, bytes))
}

/// Reads a file of any kind without parsing it. The result contains its text, or a diagnostic if it cannot be read.
pub fn read(request: &Request) -> Loaded {
    let text = read::read_text(&request.path, request.max_size);
    let files_read = if text.is_ok() { vec![request.path.clone()] } else { Vec::new() };
    Loaded { files_read, ..with_text(request, text) }
}

/// As [`read`], with the bytes of the file from elsewhere.
pub fn read_bytes(request: &Request, bytes: Vec<u8>) -> Loaded {
    with_text(request, read::decode(bytes, request.max_size))
}

fn with_text(request: &Request, text: Result<String, read::Unreadable>) -> Loaded {
    let mut loaded = Loaded::default();
    match text {
        Ok(text) => loaded.file = Some(loaded.sources.add(&request.shown_as, text)),
        Err(cause) => loaded.diagnostics = vec![unreadable::diagnose(request, cause, &mut loaded.sources)],
    }
    loaded
}

fn checked(request: &Request, mut loaded: Loaded) -> Loaded {
    let Some(file) = loaded.file else { return loaded };
    let mut found = Diagnostics::new();
    let files = files::read(request, file, &[], &mut loaded.sources, &mut found);
    loaded.files_read.extend(files.included.iter().map(|file| file.path.clone()));
    (loaded.model, loaded.included) = (files.model, files.included);
    let mut of_schemas = Diagnostics::new();
    let compiled = schemas::compile(request, &loaded.model, &mut loaded.sources, &mut of_schemas);
    let of_schemas = of_schemas.into_sorted();
    found.extend(of_schemas.iter().cloned());
    let facts = Facts {
        default_system: request.default_system(),
        messages: compiled.messages,
        unlisted: compiled.unlisted,
        sockets: plan::socket_paths(),
    };
    loaded.files_read.extend(compiled.files_read);
    loaded.schemas = compiled.schemas;
    loaded.outlines = compiled.outlines;
    (loaded.topology, loaded.diagnostics) =
        check_with_parts(&loaded.model, &files.parts, &facts, &loaded.sources, found);
    trial::try_advice(request, &mut loaded, file, &facts, &of_schemas);
    loaded.diagnostics = includes::tell_chain(loaded.diagnostics, &loaded.included, &loaded.sources);
    loaded
}
