//! What all files of a system declare together, and what each file declares that becomes a group.

use crate::includes::{self, Included};
use crate::request::Request;
use scl_topology::check::without_repeats;
use scl_topology::diagnostic::Diagnostics;
use scl_topology::groups::{Scope, flatten};
use scl_topology::model::Model;
use scl_topology::parse::complete;
use scl_topology::source::{FileId, Sources};
use std::collections::HashSet;

/// What the files of a system declare.
#[derive(Debug, Clone)]
pub(crate) struct Files {
    /// All of them together.
    pub(crate) model: Model,
    /// The files that become groups, each by itself with what it includes.
    pub(crate) parts: Vec<Model>,
    /// The files beside the topology file.
    pub(crate) included: Vec<Included>,
}

/// Reads a topology file and those that it includes. Those that are `known` are not read from disk.
pub(crate) fn read(
    request: &Request,
    main: FileId,
    known: &[Included],
    sources: &mut Sources,
    problems: &mut Diagnostics,
) -> Files {
    let (scope, included) = includes::read(request, main, known, sources, problems);
    let (mut parts, mut of_parts, mut is_cut_off) = (Vec::new(), Diagnostics::new(), false);
    find_parts(&scope, &mut HashSet::new(), &mut |part| {
        // Of what a broken part is in, nothing can be said.
        if is_cut_off {
            return;
        }
        let mut part = part.clone();
        (part.model.system, part.model.codec) = (scope.model.system.clone(), scope.model.codec.clone());
        let part = written_out(part, sources, &mut of_parts);
        is_cut_off = part.cut_off;
        parts.push(part);
    });
    let mut found = Diagnostics::new();
    let model = match is_cut_off {
        true => Model { cut_off: true, ..scope.model },
        false => written_out(scope, sources, &mut found),
    };
    without_repeats(&mut found, &mut of_parts, &parts);
    problems.append(of_parts);
    problems.append(found);
    // Each part is checked with the messages of all.
    for part in &mut parts {
        (part.schemas, part.schema_roots) = (model.schemas.clone(), model.schema_roots.clone());
    }
    Files { model, parts, included }
}

/// What a scope stands for: each component with its gates, and each connection.
fn written_out(scope: Scope, sources: &Sources, problems: &mut Diagnostics) -> Model {
    let mut model = flatten(scope, sources, problems);
    complete(&mut model, sources, problems);
    model
}

/// Calls `add` with each file that becomes a group, once, the inner ones first.
fn find_parts(scope: &Scope, seen: &mut HashSet<FileId>, add: &mut impl FnMut(&Scope)) {
    for group in &scope.groups {
        if seen.insert(group.file) {
            find_parts(&group.scope, seen, add);
            add(&group.scope);
        }
    }
}
