//! Compiles schema files into descriptors, and reports every wrong one.

use super::disk::{Disk, SharedSeen};
use super::entry::{Named, elsewhere, misplaced, refuse, roots_exist};
use super::folders::Folders;
use super::imports::of_entries;
use super::outline::outline;
use super::place::Texts;
use super::rust::judge_names;
use super::unlisted::unlisted;
use super::{Compiled, Schemas};
use crate::no_panic::{BUG, no_panic};
use crate::request::Request;
use protox::Compiler;
use scl_topology::check::SchemaMessages;
use scl_topology::diagnostic::{Diagnostic, Diagnostics};
use scl_topology::external::SCHEMA;
use scl_topology::model::Model;
use scl_topology::source::{Sources, Spanned};
use std::cell::OnceCell;
use std::collections::HashMap;
use std::path::Path;

/// Compiles every entry of `schemas:`, and judges the Rust names of what they declare.
pub(crate) fn compile(request: &Request, model: &Model, sources: &mut Sources, problems: &mut Diagnostics) -> Compiled {
    if model.schemas.is_empty() {
        return Compiled::default();
    }
    let folder = request.path.parent().map(Path::to_path_buf).unwrap_or_default();
    let folders = Folders::of(&folder, model, request.max_size);
    let seen = SharedSeen::default();
    let compiler = compile_entries(request, model, &folders, &seen, sources, problems);
    let seen = std::mem::take(&mut *seen.get());
    let outlines = || seen.files.iter().map(|file| outline(&file.text)).collect();
    let Some(compiler) = compiler else {
        return Compiled { outlines: outlines(), files_read: seen.into_paths(), ..Compiled::default() };
    };
    let messages = messages_by_entry(&compiler, model, &folders);
    let unlisted = unlisted(model, &messages, &folders);
    let schemas = Schemas { file_descriptor_set: compiler.file_descriptor_set(), folders: folders.shown() };
    let texts = Texts { request, folders: &folders, files: &seen.files, sources };
    let names_fit = judge_names(&schemas.file_descriptor_set.file, model, texts, problems);
    let outlines = if names_fit { Vec::new() } else { outlines() };
    let also_read = unlisted.iter().map(|schema| folders.path(Path::new(&schema.path)));
    let files_read = seen.into_paths().into_iter().chain(also_read).collect();
    let schemas = Some(schemas).filter(|_| names_fit);
    Compiled { messages: Some(messages), unlisted, schemas, outlines, files_read }
}

/// Compiles all entries, also after a wrong one, so that each is reported. Returns `None` if any is wrong.
fn compile_entries(
    request: &Request,
    model: &Model,
    folders: &Folders,
    seen: &SharedSeen,
    sources: &mut Sources,
    problems: &mut Diagnostics,
) -> Option<Compiler> {
    let disk = Disk { folders: folders.clone(), max_size: request.max_size, seen: seen.clone() };
    let mut compiler = Compiler::with_file_resolver(disk);
    compiler.include_imports(true).include_source_info(true);
    let mut named = Named::default();
    let mut told = Vec::new();
    let imported = OnceCell::new();
    let mut all_well = roots_exist(model, folders, problems);
    for schema in &model.schemas {
        problems.extend(elsewhere(schema));
        let refused = named
            .twice(schema, folders)
            .or_else(|| refuse(schema, folders, request.max_size, sources))
            .or_else(|| misplaced(schema, folders, sources, || imported.get_or_init(|| of_entries(folders))));
        let wrong = match (refused, folders.name_of_entry(&schema.value)) {
            (None, Some(name)) => match no_panic(|| compiler.open_file(&name)) {
                Ok(Ok(_)) => continue,
                Ok(Err(error)) => {
                    let mut seen = seen.get();
                    let mistakes = std::mem::take(&mut seen.mistakes);
                    let mut texts = Texts { request, folders, files: &seen.files, sources };
                    texts.what_is_wrong(&error, mistakes, &mut told, schema)
                }
                Err(text) => vec![panicked(schema, &text)],
            },
            (refused, _) => refused.into_iter().collect(),
        };
        problems.extend(wrong);
        all_well = false;
    }
    all_well.then_some(compiler)
}

/// The messages that each entry declares; those that are only imported count for the first.
fn messages_by_entry(compiler: &Compiler, model: &Model, folders: &Folders) -> Vec<SchemaMessages> {
    let pool = compiler.descriptor_pool();
    let mut by_entry = vec![SchemaMessages::default(); model.schemas.len()];
    for message in pool.all_messages().filter(|message| !message.is_map_entry()) {
        let file = message.parent_file();
        if file.package_name() == "google.protobuf" {
            continue;
        }
        if let Some(entry) = by_entry.get_mut(folders.entry(file.name())) {
            entry.names.push(message.full_name().to_owned());
        }
    }
    let mut users: HashMap<String, Vec<String>> = HashMap::new();
    for message in pool.all_messages() {
        let of_enum = message.fields().filter_map(|field| field.kind().as_enum().map(|of| of.full_name().to_owned()));
        of_enum.for_each(|name| users.entry(name).or_default().push(message.full_name().to_owned()));
    }
    for declared in pool.all_enums() {
        let file = declared.parent_file();
        let entry = by_entry.get_mut(folders.entry(file.name()));
        if let Some(entry) = entry.filter(|_| file.package_name() != "google.protobuf") {
            let name = declared.full_name();
            entry.enums.insert(name.to_owned(), users.remove(name).unwrap_or_default());
        }
    }
    for file in pool.files().filter(|file| file.package_name() != "google.protobuf") {
        if let Some(entry) = by_entry.get_mut(folders.entry(file.name())) {
            entry.packages.push(file.package_name().to_owned());
        }
    }
    by_entry
}

fn panicked(schema: &Spanned<String>, text: &str) -> Diagnostic {
    let message = format!("the schema file `{}` makes the schema compiler panic: {text}", schema.value);
    SCHEMA.at(message, schema.span, "").note(BUG)
}
