//! Schema files become descriptors, each wrong one a problem.

use super::broken::Shown;
use super::disk::{Disk, SharedSeen};
use super::entry::{Named, elsewhere};
use super::folders::{Folders, Found};
use super::outline::outline;
use super::place::{Places, Texts};
use super::rust::{find_clashes, find_hidden_crates};
use super::{Compiled, Schemas};
use crate::no_panic::{BUG, no_panic};
use crate::read::{Unreadable, read_text};
use crate::request::Request;
use crate::unreadable::similar_file;
use protox::Compiler;
use scl_topology::check::SchemaMessages;
use scl_topology::diagnostic::{Diagnostic, Diagnostics};
use scl_topology::external::SCHEMA;
use scl_topology::model::Model;
use scl_topology::source::{Sources, Span, Spanned};
use std::path::Path;

/// Compiles every entry of `schemas:`; goes on after a wrong one, so that each is reported.
pub(crate) fn compile(request: &Request, model: &Model, sources: &mut Sources, problems: &mut Diagnostics) -> Compiled {
    if model.schemas.is_empty() {
        return Compiled::default();
    }
    let folder = request.path.parent().map(Path::to_path_buf).unwrap_or_default();
    let folders = Folders::of(&folder, model, request.max_size);
    let seen = SharedSeen::default();
    let disk = Disk { folders: folders.clone(), max_size: request.max_size, seen: seen.clone() };
    let mut compiler = Compiler::with_file_resolver(disk);
    compiler.include_imports(true).include_source_info(true);
    let mut named = Named::default();
    let mut told = Vec::new();
    let mut all_well = roots_exist(model, &folder, problems);
    for schema in &model.schemas {
        problems.extend(elsewhere(schema));
        let refused = named
            .twice(schema, &folder)
            .or_else(|| refuse(schema, &folder, request.max_size))
            .or_else(|| misplaced(schema, &folders));
        let wrong = match (refused, folders.name_of_entry(&schema.value)) {
            (None, Some(name)) => match no_panic(|| compiler.open_file(&name)) {
                Ok(Ok(_)) => continue,
                Ok(Err(error)) => {
                    let mut seen = seen.get();
                    let mistakes = std::mem::take(&mut seen.mistakes);
                    let mut shown = Shown(Texts { request, folders: &folders, files: &seen.files, sources });
                    shown.all(&error, mistakes, &mut told, schema)
                }
                Err(text) => vec![panicked(schema, &text)],
            },
            (refused, _) => refused.into_iter().collect(),
        };
        problems.extend(wrong);
        all_well = false;
    }
    let seen = std::mem::take(&mut *seen.get());
    let outlines = || seen.files.iter().map(|file| outline(&file.text)).collect();
    if !all_well {
        return Compiled { outlines: outlines(), files_read: seen.into_paths(), ..Compiled::default() };
    }
    let entries = Entries::of(model, &folders);
    let messages = Some(messages_by_entry(&compiler, &entries));
    let schemas = Schemas { descriptors: compiler.file_descriptor_set(), folders: folders.shown() };
    let compiled = &schemas.descriptors.file;
    let texts = Texts { request, folders: &folders, files: &seen.files, sources };
    let mut places = Places::new(texts, compiled);
    problems.extend(find_hidden_crates(compiled, request, |file| entries.span(file), &mut places));
    let clashes = find_clashes(compiled, model, &mut places);
    if !clashes.is_empty() {
        problems.extend(clashes);
        return Compiled { messages, outlines: outlines(), files_read: seen.into_paths(), schemas: None };
    }
    Compiled { messages, schemas: Some(schemas), files_read: seen.into_paths(), outlines: Vec::new() }
}

/// Reports each entry of `schema_roots` that is not a folder; returns true if all are.
fn roots_exist(model: &Model, folder: &Path, problems: &mut Diagnostics) -> bool {
    let wrong: Vec<_> = model.schema_roots.iter().filter(|root| !folder.join(&root.value).is_dir()).collect();
    for root in &wrong {
        let message = format!("cannot find the folder `{}`", root.value);
        problems.push(SCHEMA.at(message, root.span, "").note("`schema_roots` are looked for beside the topology file"));
    }
    problems.extend(model.schema_roots.iter().filter_map(elsewhere));
    wrong.is_empty()
}

/// What is wrong with the place of an entry among the roots.
fn misplaced(schema: &Spanned<String>, folders: &Folders) -> Option<Diagnostic> {
    let entry = &schema.value;
    let Some(name) = folders.name_of_entry(entry) else {
        let message = format!("the schema `{entry}` is in none of the folders of `schema_roots`");
        let beside = Path::new(entry).parent().unwrap_or(Path::new(""));
        return Some(SCHEMA.at(message, schema.span, "").help(folders.with_root(beside)));
    };
    match folders.find(&name) {
        Found::Two(one, other) if folders.are_roots() => {
            let [one, other] = [&one, &other].map(|path| folders.relative(path).display());
            let message = format!("the schema `{entry}` has the same path in its root as another file");
            let problem = SCHEMA.at(message, schema.span, format!("`{name}` can mean `{one}` and `{other}`"));
            Some(problem.help("rename one of the files, or remove its folder from `schema_roots`"))
        }
        _ => None,
    }
}

/// What is wrong with an entry that names no readable file, in SCL's own words: the compiler calls it "not included".
fn refuse(schema: &Spanned<String>, folder: &Path, max_size: u64) -> Option<Diagnostic> {
    let path = folder.join(&schema.value);
    let name = &schema.value;
    let cause = read_text(&path, max_size).err()?;
    if !matches!(cause, Unreadable::Missing) {
        let why = super::disk::why(Path::new(name), cause);
        return Some(SCHEMA.at(format!("the schema file {why}"), schema.span, ""));
    }
    let near = similar_file(&path, &[]).map(|near| format!("a file with a similar name exists: `{near}`"));
    let problem = SCHEMA.at(format!("cannot find the schema file `{name}`"), schema.span, "");
    Some(problem.helps(near).note("schemas are looked for beside the topology file"))
}

/// The messages that each entry declares; those that are only imported count for the first.
fn messages_by_entry(compiler: &Compiler, entries: &Entries<'_>) -> Vec<SchemaMessages> {
    let pool = compiler.descriptor_pool();
    let mut by_entry: Vec<SchemaMessages> = entries.names.iter().map(|_| SchemaMessages::default()).collect();
    for message in pool.all_messages().filter(|message| !message.is_map_entry()) {
        let file = message.parent_file();
        if file.package_name() == "google.protobuf" {
            continue;
        }
        if let Some(entry) = by_entry.get_mut(entries.index(file.name())) {
            entry.names.push(message.full_name().to_owned());
        }
    }
    for file in pool.files().filter(|file| file.package_name() != "google.protobuf") {
        if let Some(entry) = by_entry.get_mut(entries.index(file.name())) {
            entry.packages.push(file.package_name().to_owned());
        }
    }
    by_entry
}

fn panicked(schema: &Spanned<String>, text: &str) -> Diagnostic {
    let message = format!("the schema file `{}` makes the compiler of schemas panic: {text}", schema.value);
    SCHEMA.at(message, schema.span, "").note(BUG)
}

/// The entries of `schemas:`, by the names under which the compiler knows their files.
struct Entries<'m> {
    model: &'m Model,
    names: Vec<Option<String>>,
}

impl<'m> Entries<'m> {
    fn of(model: &'m Model, folders: &Folders) -> Self {
        Self { model, names: model.schemas.iter().map(|schema| folders.name_of_entry(&schema.value)).collect() }
    }

    /// The entry that names a file; the first one for a file that is only imported.
    fn index(&self, file: &str) -> usize {
        self.names.iter().position(|name| name.as_deref() == Some(file)).unwrap_or(0)
    }

    fn span(&self, file: &str) -> Option<Span> {
        self.model.schemas.get(self.index(file)).map(|schema| schema.span)
    }
}
