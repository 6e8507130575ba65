//! What can be wrong with an entry of `schemas:` or `schema_roots:` before its file is compiled.

use super::folders::{Folders, Found};
use super::outline::{Outline, outline};
use crate::name_each::name_each;
use crate::paths::{plain, works_here_only};
use crate::read::{Unreadable, read_text};
use crate::unreadable::{file_names, similar_file, why};
use scl_topology::diagnostic::{Diagnostic, Diagnostics, Edit};
use scl_topology::external::{SCHEMA, SCHEMA_ELSEWHERE, SCHEMA_TWICE};
use scl_topology::model::Model;
use scl_topology::source::{Sources, Span, Spanned};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// The files that earlier entries lead to.
#[derive(Default)]
pub(super) struct Named(HashMap<PathBuf, (String, Span)>);

impl Named {
    /// `SCL0416`: an earlier entry leads to the same file.
    pub(super) fn twice(&mut self, schema: &Spanned<String>, folders: &Folders) -> Option<Diagnostic> {
        // A file that does not exist is reported elsewhere, under each name.
        let path = folders.path(Path::new(&schema.value)).canonicalize().ok()?;
        let Some((first, span)) = self.0.get(&path) else {
            self.0.insert(path, (schema.value.clone(), schema.span));
            return None;
        };
        let name = &schema.value;
        let headline = match first == name {
            true => format!("the schema `{name}` is named twice"),
            false => format!("the schemas `{first}` and `{name}` are the same file"),
        };
        Some(
            SCHEMA_TWICE.at(headline, schema.span, "second time").label(*span, "first time").help("remove one of them"),
        )
    }
}

/// `SCL0415`: a path that does not exist on other machines.
pub(super) fn elsewhere(schema: &Spanned<String>) -> Option<Diagnostic> {
    let path = Path::new(&schema.value);
    let message = format!("the schema path {}", works_here_only(path)?);
    let found = SCHEMA_ELSEWHERE.at(message, schema.span, "");
    Some(found.help("keep the schema beside the topology file, or in a folder below it"))
}

/// Reports each entry of `schema_roots` that is not a folder; returns true if all are.
pub(super) fn roots_exist(model: &Model, folders: &Folders, problems: &mut Diagnostics) -> bool {
    let wrong: Vec<_> =
        model.schema_roots.iter().filter(|root| !folders.path(Path::new(&root.value)).is_dir()).collect();
    for root in &wrong {
        let message = format!("cannot find the folder `{}`", root.value);
        problems.push(SCHEMA.at(message, root.span, "").note("`schema_roots` are looked for beside the topology file"));
    }
    problems.extend(model.schema_roots.iter().filter_map(elsewhere));
    wrong.is_empty()
}

/// Reports an entry that is in none of the roots, or that has the same path in its root as another file. `imports` are
/// what all entries import.
pub(super) fn misplaced<'i>(
    schema: &Spanned<String>,
    folders: &Folders,
    sources: &Sources,
    imports: impl FnOnce() -> &'i HashSet<String>,
) -> Option<Diagnostic> {
    let entry = &schema.value;
    let Some(name) = folders.name_of_entry(entry) else {
        let message = format!("the schema `{entry}` is in none of the folders of `schema_roots`");
        let path = Path::new(entry);
        let imports = imports();
        let is_imported = |root: &&Path| {
            path.strip_prefix(root).ok().and_then(Path::to_str).is_some_and(|name| imports.contains(name))
        };
        let beside = path.parent().unwrap_or(Path::new(""));
        let root = path.ancestors().skip(1).find(is_imported).unwrap_or(beside);
        return Some(folders.suggest_root(SCHEMA.at(message, schema.span, ""), root, sources));
    };
    match folders.find(&name) {
        Found::Two(one, other) if folders.are_roots => {
            let [one, other] = [&one, &other].map(|path| folders.relative(path).display());
            let message = format!("the schema `{entry}` has the same path in its root as another file");
            let problem = SCHEMA.at(message, schema.span, format!("`{name}` can mean `{one}` or `{other}`"));
            Some(problem.help("rename one of the files, or remove its folder from `schema_roots`"))
        }
        _ => None,
    }
}

/// Reports an entry that names no readable file, in SCL's own words: the compiler calls it "not included".
pub(super) fn refuse(
    schema: &Spanned<String>,
    folders: &Folders,
    max_size: u64,
    sources: &Sources,
) -> Option<Diagnostic> {
    let name = as_written(schema, sources);
    let path = folders.path(Path::new(&schema.value));
    let beside = |other: String| Path::new(name).with_file_name(other).display().to_string();
    let (headline, near) = match read_text(&path, max_size) {
        Ok(text) if is_schema(&path) || outline(&text) != Outline::default() => return None,
        Ok(_) => (format!("`{name}` is not a `.proto` file"), generated_from(&path)),
        Err(Unreadable::Missing) => {
            let near = generated_from(&path).or_else(|| similar_file(&path, &[]));
            (format!("cannot find the schema file `{name}`"), near.filter(|near| is_schema(Path::new(near))))
        }
        Err(cause) => {
            let found = SCHEMA.at(format!("the schema file {}", why(Path::new(name), cause)), schema.span, "");
            let inside: Vec<String> =
                schemas_in(&path).map(|file| format!("{}/{file}", name.trim_end_matches('/'))).collect();
            return Some(match inside.as_slice() {
                [] => found,
                files => found.did_you_mean(name, files.get(..MOST_INSIDE).unwrap_or(files)),
            });
        }
    };
    let problem = SCHEMA.at(headline, schema.span, label_of(&path));
    let problem = match name.contains('*') {
        true => with_files_of_pattern(problem, schema, &path, sources),
        false => match near.is_none().then(|| renamed(&path)).flatten().map(beside) {
            Some(other) => {
                let edit = Edit::new(schema.span, other.clone());
                problem.suggest(format!("did you mean `{other}`?"), [edit])
            }
            None => problem.did_you_mean(name, near.map(beside).as_slice()),
        },
    };
    if name.starts_with("google/protobuf/") {
        let text = "remove it: protobuf's own schemas are imported without an entry here";
        return Some(problem.suggest_removal(text, sources.file(schema.span.file), schema.span));
    }
    Some(match is_schema(&path) {
        true if name != schema.value => problem.note("paths start at the folder of the file that contains them"),
        true => problem.note("schemas are looked for beside the topology file"),
        false => problem.note("`schemas` names the `.proto` files that declare the messages"),
    })
}

/// An entry as its file has it: in an included file, its path starts at another folder than that of the topology file.
fn as_written<'s>(schema: &'s Spanned<String>, sources: &'s Sources) -> &'s str {
    let written = sources.snippet(schema.span).trim_matches(['"', '\'']);
    if Path::new(&schema.value).ends_with(plain(Path::new(written))) { written } else { &schema.value }
}

/// The only schema in the folder with the name of this one as a part of its own, or the only schema.
fn renamed(path: &Path) -> Option<String> {
    let stem = path.file_stem()?.to_str()?;
    let files: Vec<String> = schemas_in(path.parent()?).collect();
    let mut longer = files.iter().filter(|file| file.contains(stem));
    match (longer.next(), longer.next(), files.as_slice()) {
        (Some(one), None, _) | (None, _, [one]) => Some(one.clone()),
        _ => None,
    }
}

/// Maximum number of files of a folder that a message names.
const MOST_INSIDE: usize = 3;

/// Adds what to write in the place of `messages/*.proto`.
fn with_files_of_pattern(problem: Diagnostic, schema: &Spanned<String>, path: &Path, sources: &Sources) -> Diagnostic {
    let Some(folder) = path.parent().filter(|_| schema.value.ends_with("*.proto")) else { return problem };
    let before = as_written(schema, sources).trim_end_matches("*.proto");
    let files: Vec<String> = schemas_in(folder).map(|file| format!("{before}{file}")).collect();
    name_each(problem, schema, &files, sources, "each schema is named, without patterns")
}

fn is_schema(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "proto")
}

fn schemas_in(folder: &Path) -> impl Iterator<Item = String> {
    file_names(folder).into_iter().filter(|name| is_schema(Path::new(name)))
}

/// What a file is that `protoc` generates, or in which another tool declares messages.
fn label_of(path: &Path) -> &'static str {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("msg" | "srv" | "action") => "a definition of ROS",
        Some("py" | "pyi" | "h" | "hpp" | "cc" | "cpp" | "c" | "rs" | "go" | "java" | "js" | "ts") => {
            "code, not a schema"
        }
        _ => "",
    }
}

/// The `.proto` file beside a file that `protoc` makes of it: `tide.proto` for `tide_pb2.py` and `tide.pb.h`.
fn generated_from(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_str()?.to_lowercase();
    let stem = name.split('.').next().unwrap_or_default();
    let stem = ["_pb2_grpc", "_pb2", "_pb"].iter().find_map(|end| stem.strip_suffix(end)).unwrap_or(stem);
    let folder = path.parent().filter(|_| !is_schema(path))?;
    schemas_in(folder).find(|other| other.to_lowercase().strip_suffix(".proto") == Some(stem))
}
