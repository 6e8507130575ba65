//! The folders in which schemas are looked for, and the files that a name can mean there.

use crate::paths::plain;
use crate::read::read_text;
use crate::unreadable::file_names;
use scl_topology::diagnostic::{Diagnostic, appended, new_list};
use scl_topology::model::Model;
use scl_topology::source::{Sources, Spanned};
use std::path::{Component, Path, PathBuf};

/// Maximum number of schema files that are looked at because a name may be declared in one of them.
pub(super) const MOST_FILES: usize = 64;

/// Where imports are looked for: in the folders of `schema_roots`, or else beside the topology file and beside the
/// schemas that it names.
#[derive(Debug, Clone, Default)]
pub(super) struct Folders {
    topology: PathBuf,
    /// The folders as the topology file names them; an empty path is its own folder.
    all: Vec<PathBuf>,
    /// Whether the topology file declares them.
    pub(super) are_roots: bool,
    /// The entries of `schemas`, in their order: the name under which the compiler knows each, and its path.
    entries: Vec<(Option<String>, PathBuf)>,
    schemas: Vec<Spanned<String>>,
    roots: Vec<Spanned<String>>,
    max_size: u64,
}

/// The files that a name can mean.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// None.
    Missing,
    /// One file, or several with the same content.
    One(Vec<PathBuf>),
    /// Two files with different content; there may be more.
    Two(PathBuf, PathBuf),
}

impl Folders {
    pub(super) fn of(topology: &Path, model: &Model, max_size: u64) -> Self {
        let roots = model.schema_roots.iter().map(|root| plain(Path::new(&root.value)));
        let beside = model.schemas.iter().filter_map(|schema| Path::new(&schema.value).parent().map(plain));
        let are_roots = !model.schema_roots.is_empty();
        let wanted: Vec<PathBuf> =
            if are_roots { roots.collect() } else { std::iter::once(PathBuf::new()).chain(beside).collect() };
        let mut folders = Self {
            topology: topology.to_path_buf(),
            are_roots,
            schemas: model.schemas.clone(),
            roots: model.schema_roots.clone(),
            max_size,
            ..Self::default()
        };
        for folder in wanted {
            if !folders.all.contains(&folder) {
                folders.all.push(folder);
            }
        }
        let entries = model.schemas.iter().map(|schema| &schema.value);
        folders.entries = entries.map(|entry| (folders.name_of_entry(entry), topology.join(entry))).collect();
        folders
    }

    /// The folders as entries of `schema_roots` name them.
    pub(super) fn shown(&self) -> Vec<String> {
        self.all.iter().map(|folder| as_root(folder)).collect()
    }

    /// Suggests adding a folder to `schema_roots`.
    pub(super) fn suggest_root(&self, problem: Diagnostic, folder: &Path, sources: &Sources) -> Diagnostic {
        let root = as_root(folder);
        let known = self.all.iter().filter(|_| self.are_roots).map(|known| as_root(known));
        let roots: Vec<String> = known.chain([root.clone()]).collect();
        let text = format!("name the folder in which imports begin: `schema_roots: [{}]`", roots.join(", "));
        let edit = self.schemas.first().and_then(|schema| {
            let source = sources.file(schema.span.file);
            match self.are_roots {
                true => appended(source, "schema_roots", &self.roots, &root),
                false => new_list(source, "schemas", schema.span, "schema_roots", &root),
            }
        });
        match edit {
            Some((_, edit)) => {
                problem.suggest(text, [edit]).otherwise("`schema_roots` lists the folders in which imports begin")
            }
            None => problem.help(text),
        }
    }

    /// Whether an import names an entry of `schemas` that is in none of the roots.
    pub(super) fn is_misplaced(&self, import: &str) -> bool {
        self.entries.iter().any(|(known, path)| known.is_none() && path.ends_with(import))
    }

    /// The paths of the entries of `schemas`.
    pub(super) fn entries(&self) -> impl Iterator<Item = &Path> {
        self.entries.iter().map(|(_, path)| path.as_path())
    }

    /// The schema files in the folders where imports are looked for and beside the topology file: at most
    /// [`MOST_FILES`].
    pub(super) fn schema_files(&self) -> Vec<PathBuf> {
        let folders =
            [PathBuf::new()].into_iter().chain(self.all.iter().filter(|it| !it.as_os_str().is_empty()).cloned());
        let folders = folders.map(|folder| self.topology.join(folder));
        let files = folders.flat_map(|folder| file_names(&folder).into_iter().map(move |name| folder.join(name)));
        files.filter(|path| path.extension().is_some_and(|ending| ending == "proto")).take(MOST_FILES).collect()
    }

    /// The text of a file, if it can be read.
    pub(super) fn read(&self, path: &Path) -> Option<String> {
        read_text(path, self.max_size).ok()
    }

    /// The name under which the compiler knows an entry of `schemas`; `None` if it is in none of the roots.
    pub(super) fn name_of_entry(&self, entry: &str) -> Option<String> {
        if self.are_roots { self.import_name(&self.topology.join(entry)) } else { Some(entry.to_owned()) }
    }

    /// The entry of `schemas` that names a file; the first one for a file that is only imported.
    pub(super) fn entry(&self, name: &str) -> usize {
        self.entries.iter().position(|(known, _)| known.as_deref() == Some(name)).unwrap_or(0)
    }

    /// The name by which an import reaches a file from the first folder that contains it.
    pub(super) fn import_name(&self, path: &Path) -> Option<String> {
        self.all.iter().find_map(|folder| below(&self.topology.join(folder), path))
    }

    /// The files that `name` means in an import. Files with the same bytes mean the same, so that a copy does no harm.
    pub(super) fn find(&self, name: &str) -> Found {
        let mut found: Vec<PathBuf> = Vec::new();
        for path in self.candidates(name).filter(|path| path.is_file()) {
            match found.first() {
                Some(first) if !self.has_same_content(first, &path) => return Found::Two(first.clone(), path),
                _ => found.push(path),
            }
        }
        if found.is_empty() { Found::Missing } else { Found::One(found) }
    }

    /// Returns the path of the entry of `schemas` with this name, if there is one, then the paths where other files of
    /// this name may be.
    pub(super) fn paths(&self, name: &str) -> Vec<PathBuf> {
        let entry = self.entries.iter().rev().find(|(known, _)| known.as_deref() == Some(name));
        entry.map(|(_, path)| path.clone()).into_iter().chain(self.candidates(name)).collect()
    }

    /// The entry of `schemas` that is this file and has another name.
    pub(super) fn entry_with_other_name(&self, name: &str, path: &Path) -> Option<&str> {
        let path = path.canonicalize().ok()?;
        let is_same =
            |entry: &Path| entry.file_name() == path.file_name() && entry.canonicalize().is_ok_and(|it| it == path);
        let others = self.entries.iter().filter(|(known, entry)| known.as_deref() != Some(name) && is_same(entry));
        others.filter_map(|(known, _)| known.as_deref()).min()
    }

    /// The path of a file that the topology file would name like this.
    pub(super) fn path(&self, relative: &Path) -> PathBuf {
        self.topology.join(relative)
    }

    /// A path of a file as the topology file would name it.
    pub(super) fn relative<'p>(&self, path: &'p Path) -> &'p Path {
        path.strip_prefix(&self.topology).unwrap_or(path)
    }

    /// Where a file of this name may be.
    pub(super) fn candidates(&self, name: &str) -> impl Iterator<Item = PathBuf> {
        self.all.iter().map(move |folder| self.topology.join(folder).join(name))
    }

    fn has_same_content(&self, one: &Path, other: &Path) -> bool {
        let is_same_file = || one.canonicalize().ok() == other.canonicalize().ok();
        let has_same_text = || self.read(one).is_some_and(|one| self.read(other) == Some(one));
        is_same_file() || has_same_text()
    }
}

/// The path of a file from a folder, as an import has it; `None` if the file is not below the folder.
fn below(folder: &Path, path: &Path) -> Option<String> {
    let as_written = || from(&plain(folder), &plain(path));
    let on_disk = || from(&folder.canonicalize().ok()?, &path.canonicalize().ok()?);
    as_written().or_else(on_disk)
}

fn from(folder: &Path, path: &Path) -> Option<String> {
    let parts = path.strip_prefix(folder).ok()?.components();
    let names: Option<Vec<&str>> =
        parts.map(|part| if let Component::Normal(it) = part { it.to_str() } else { None }).collect();
    names.map(|names| names.join("/"))
}

/// A folder as an entry of `schema_roots`.
fn as_root(folder: &Path) -> String {
    if folder.as_os_str().is_empty() { ".".to_owned() } else { folder.display().to_string() }
}
