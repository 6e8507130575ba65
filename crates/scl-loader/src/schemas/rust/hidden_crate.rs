//! SCL0418: a package whose Rust module hides a crate.

use super::names::snake_case;
use super::paths::package_parts;
use crate::request::Request;
use crate::schemas::place::Places;
use crate::schemas::walk::FILE_PACKAGE;
use prost_types::FileDescriptorProto;
use scl_topology::diagnostic::Diagnostic;
use scl_topology::external::HIDDEN_CRATE;
use scl_topology::source::Span;
use std::collections::HashSet;

/// Reports the packages whose outermost module has the name of a crate. `entry` returns the entry of `schemas:` that
/// leads to a file.
pub(in crate::schemas) fn find_hidden_crates(
    files: &[FileDescriptorProto],
    request: &Request,
    entry: impl Fn(&str) -> Option<Span>,
    places: &mut Places<'_>,
) -> Vec<Diagnostic> {
    let mut told = HashSet::new();
    let mut found = Vec::new();
    for file in files.iter().filter(|file| file.package() != "google.protobuf") {
        let Some(module) = package_parts(file.package()).next().map(snake_case) else { continue };
        let name = module.trim_start_matches("r#");
        let Some(entry) = entry(file.name()).filter(|_| request.crates.contains(name)) else { continue };
        if !told.insert(module.clone()) {
            continue;
        }
        let package = file.package();
        let headline = format!(
            "the package `{package}` becomes the Rust module `{module}`, which hides the crate `{name}` where the macro is called"
        );
        let place = places.of(file.name(), &[FILE_PACKAGE]);
        let call = "mod wiring { ::scl::topology!(\"..\"); }";
        found.push(
            HIDDEN_CRATE
                .at(headline, entry, "declared because of this line")
                .labels(place.map(|span| (span, format!("becomes `{module}`"))))
                .help(format!("call the macro in a separate module: `{call}`; or choose another package"))
                .note(format!("if it is in one already, allow this: `# scl: allow({})`", HIDDEN_CRATE.code)),
        );
    }
    found
}
