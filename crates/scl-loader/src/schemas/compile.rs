//! Schema files become descriptors, each wrong one a problem.

use super::broken;
use super::disk::{Disk, FilesRead, SchemaFile};
use super::entry::{Named, elsewhere};
use super::outline::outline;
use super::place::Places;
use super::rust::{find_clashes, find_hidden_crates};
use super::{Compiled, Schemas};
use crate::read::{Unreadable, read_text};
use crate::request::Request;
use crate::unreadable::similar_file;
use protox::Compiler;
use scl_topology::check::SchemaMessages;
use scl_topology::diagnostic::{Diagnostic, Diagnostics};
use scl_topology::external::SCHEMA;
use scl_topology::model::Model;
use scl_topology::source::{Sources, Spanned};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Compiles every entry of `schemas:`; goes on after a wrong one, so that each is reported.
pub(crate) fn compile(request: &Request, model: &Model, sources: &mut Sources, problems: &mut Diagnostics) -> Compiled {
    if model.schemas.is_empty() {
        return Compiled::default();
    }
    let folder = request.path.parent().map(Path::to_path_buf).unwrap_or_default();
    let files = FilesRead::default();
    let disk = Disk { folders: include_folders(&folder, model), max_size: request.max_size, files: files.clone() };
    let mut compiler = Compiler::with_file_resolver(disk);
    compiler.include_imports(true).include_source_info(true);
    let mut all_well = true;
    let mut named = Named::default();
    for schema in &model.schemas {
        if let Some(problem) = named.twice(schema, &folder) {
            problems.push(problem);
            all_well = false;
            continue;
        }
        problems.extend(elsewhere(schema));
        let problem = refuse(schema, &folder, request.max_size).or_else(|| {
            let error = compiler.open_file(&schema.value).err()?;
            Some(broken::diagnose(&error, schema, &snapshot(&files), request, sources))
        });
        all_well &= problem.is_none();
        problems.extend(problem);
    }
    let files = snapshot(&files);
    let outlines = if all_well { Vec::new() } else { files.iter().map(|file| outline(&file.text)).collect() };
    let files_read = files.iter().map(|file| file.path.clone()).collect();
    if !all_well {
        return Compiled { files_read, outlines, ..Compiled::default() };
    }
    let messages = Some(messages_by_entry(&compiler, model));
    let schemas = Schemas { descriptors: compiler.file_descriptor_set() };
    let compiled = &schemas.descriptors.file;
    let mut places = Places { request, sources, files: &files, compiled, added: HashMap::new() };
    let entry = |file: &str| Some(model.schemas.get(entry_of(model, file))?.span);
    problems.extend(find_hidden_crates(compiled, request, entry, &mut places));
    let clashes = find_clashes(compiled, model, &mut places);
    if !clashes.is_empty() {
        problems.extend(clashes);
        let outlines = files.iter().map(|file| outline(&file.text)).collect();
        return Compiled { messages, files_read, outlines, schemas: None };
    }
    Compiled { messages, schemas: Some(schemas), files_read, outlines }
}

/// Imports are looked for beside the topology file, then beside the schemas that it names.
fn include_folders(folder: &Path, model: &Model) -> Vec<PathBuf> {
    let mut folders = vec![folder.to_path_buf()];
    for schema in &model.schemas {
        let beside = folder.join(&schema.value).parent().map(Path::to_path_buf).unwrap_or_default();
        if !folders.contains(&beside) {
            folders.push(beside);
        }
    }
    folders
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
    let mut problem = SCHEMA.at(format!("cannot find the schema file `{name}`"), schema.span, "");
    if let Some(near) = similar_file(&path, &[]) {
        problem = problem.help(format!("a file with a similar name exists: `{near}`"));
    }
    Some(problem.note("schemas are looked for beside the topology file"))
}

/// The messages that each entry declares; those that are only imported count for the first.
fn messages_by_entry(compiler: &Compiler, model: &Model) -> Vec<SchemaMessages> {
    let pool = compiler.descriptor_pool();
    let mut by_entry: Vec<SchemaMessages> = model.schemas.iter().map(|_| SchemaMessages::default()).collect();
    for message in pool.all_messages().filter(|message| !message.is_map_entry()) {
        let file = message.parent_file();
        if file.package_name() == "google.protobuf" {
            continue;
        }
        if let Some(entry) = by_entry.get_mut(entry_of(model, file.name())) {
            entry.names.push(message.full_name().to_owned());
        }
    }
    for file in pool.files().filter(|file| file.package_name() != "google.protobuf") {
        if let Some(entry) = by_entry.get_mut(entry_of(model, file.name())) {
            entry.packages.push(file.package_name().to_owned());
        }
    }
    by_entry
}

/// The entry of `schemas:` that names a file; the first one for a file that is only imported.
fn entry_of(model: &Model, file: &str) -> usize {
    model.schemas.iter().position(|schema| schema.value == file).unwrap_or(0)
}

fn snapshot(files: &Mutex<Vec<SchemaFile>>) -> Vec<SchemaFile> {
    files.lock().unwrap_or_else(PoisonError::into_inner).clone()
}
