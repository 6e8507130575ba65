//! SCL0417: declarations of the schemas that would get the same Rust name, or none.

use super::declared::{Declared, Origin, of_components, of_schema};
use crate::schemas::place::Places;
use crate::schemas::unlisted::payloads;
use crate::schemas::walk::{NAME, messages};
use prost_types::FileDescriptorProto;
use scl_topology::diagnostic::Diagnostic;
use scl_topology::external::SCHEMA_NAME;
use scl_topology::model::Model;
use scl_topology::source::Span;
use std::collections::{HashMap, HashSet};

/// Reports declarations whose names clash in one scope, and declarations without a usable name.
pub(in crate::schemas) fn find_clashes(
    files: &[FileDescriptorProto],
    model: &Model,
    places: &mut Places<'_>,
) -> Vec<Diagnostic> {
    let own = files.iter().filter(|file| file.package() != "google.protobuf");
    let all: Vec<Declared<'_>> = own.flat_map(of_schema).collect();
    let (named, nameless): (Vec<_>, Vec<_>) = all.iter().partition(|declared| is_identifier(&declared.name));
    let mut told = HashSet::new();
    let nameless = nameless.into_iter().filter(|declared| told.insert(declared.what.as_str()));
    let mut found: Vec<Diagnostic> = nameless.map(|declared| report_nameless(declared, places)).collect();

    // Two components with the same name are reported by another rule.
    let components: Vec<Declared<'_>> = of_components(model).collect();
    let key = |declared: &'_ Declared<'_>| (declared.scope.clone(), declared.name.clone());
    let mut first: HashMap<_, &Declared<'_>> = components.iter().map(|component| (key(component), component)).collect();
    let mut told = HashSet::new();
    // The declarations whose names clash: what is inside of them then clashes, too.
    let mut outer: HashSet<(&str, &[i32])> = HashSet::new();
    let in_use = in_use(files, model);
    for declared in named {
        let other = *first.entry(key(declared)).or_insert(declared);
        // Packages with the same module name share the module, and several files may declare one package: no clash.
        let is_one = other.what == declared.what || is_package(other) && is_package(declared);
        // One declaration may produce several clashing names; report only the first.
        if is_one || is_inside(declared, &outer) || !told.insert((&other.origin, &declared.origin)) {
            continue;
        }
        if let Origin::Schema { file, path } = &declared.origin {
            outer.insert((file, path.strip_suffix(&[NAME]).unwrap_or(path)));
        }
        found.push(report(other, declared, &in_use, places));
    }
    found
}

/// Whether a declaration is inside of one of these, given by their files and paths.
fn is_inside(declared: &Declared<'_>, outer: &HashSet<(&str, &[i32])>) -> bool {
    let Origin::Schema { file, path } = &declared.origin else { return false };
    // Each level has the number of a list and an index.
    (2..path.len().saturating_sub(1))
        .step_by(2)
        .any(|end| path.get(..end).is_some_and(|of| outer.contains(&(*file, of))))
}

/// The full names of the messages and enums that gates carry, or that fields have.
fn in_use(files: &[FileDescriptorProto], model: &Model) -> HashSet<String> {
    let fields = files.iter().flat_map(messages).flat_map(|(_, message)| &message.field);
    let of_fields = fields.map(|field| field.type_name().trim_start_matches('.').to_owned());
    payloads(model).map(str::to_owned).chain(of_fields).collect()
}

/// The message or enum that a declaration is, if nothing uses it.
fn unused<'d>(declared: &'d Declared<'_>, in_use: &HashSet<String>) -> Option<&'d str> {
    let name = ["message", "enum"].iter().find_map(|kind| declared.what.strip_prefix(kind)?.strip_prefix(" `"))?;
    name.strip_suffix('`').filter(|name| !in_use.contains(*name))
}

fn is_package(declared: &Declared<'_>) -> bool {
    declared.what.starts_with("package ")
}

/// Whether a name can be used in Rust. prost gives an empty name to a declaration whose name consists of underscores,
/// and its derive macro cannot name the methods of a map of enums whose field is a keyword.
fn is_identifier(name: &str) -> bool {
    !name.is_empty() && !name.trim_start_matches("r#").contains('#')
}

fn report_nameless(declared: &Declared<'_>, places: &mut Places<'_>) -> Diagnostic {
    let what = &declared.what;
    let headline = match declared.name.as_str() {
        "" => format!("{what} has no name in Rust, because it has neither letters nor digits"),
        name => format!("{what} would get the method `{name}`, which is not a name in Rust"),
    };
    at(declared, headline, "", places).help("choose another name").note(NOT_IN_BYTES)
}

fn report(
    first: &Declared<'_>,
    second: &Declared<'_>,
    in_use: &HashSet<String>,
    places: &mut Places<'_>,
) -> Diagnostic {
    let Declared { scope, name, what, .. } = second;
    let headline = format!("{} and {what} would both become `{name}` {scope}", first.what);
    let problem = at(second, headline, &format!("also becomes `{name}`"), places);
    let problem = problem.labels(span(first, places).map(|span| (span, format!("becomes `{name}`"))));
    match first.origin {
        Origin::Topology(_) => problem.help("rename the component, or give the schema a `package`"),
        Origin::Schema { .. } => match (unused(first, in_use), unused(second, in_use)) {
            (Some(name), None) | (None, Some(name)) => {
                problem.help(format!("remove `{name}`, which nothing uses, or rename it")).note(NOT_IN_BYTES)
            }
            _ => problem.help("rename one of them").note(NOT_IN_BYTES),
        },
    }
}

fn at(declared: &Declared<'_>, headline: String, label: &str, places: &mut Places<'_>) -> Diagnostic {
    match span(declared, places) {
        Some(span) => SCHEMA_NAME.at(headline, span, label),
        None => SCHEMA_NAME.without_place(headline),
    }
}

fn span(declared: &Declared<'_>, places: &mut Places<'_>) -> Option<Span> {
    match &declared.origin {
        Origin::Topology(span) => Some(*span),
        Origin::Schema { file, path } => places.of(file, path),
    }
}

const NOT_IN_BYTES: &str = "names are part of a message's JSON, but not of its protobuf bytes";
