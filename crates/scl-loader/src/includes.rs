//! `include:` of a topology file: reads all files of a system, and joins them. SCL1501 to SCL1506.

use crate::name_each::name_each;
use crate::paths::{plain, works_here_only};
use crate::read::{Unreadable, read_text};
use crate::request::Request;
use crate::unreadable::{file_names, is_yaml, similar_file, why};
use scl_topology::diagnostic::{Diagnostic, Diagnostics, Told};
use scl_topology::groups::{Group, Scope};
use scl_topology::join::{
    CIRCLE, ELSEWHERE, MOST_FILES, MOST_LEVELS, NO_EFFECT, TOO_MANY, UNREADABLE, is_without_effect, join,
};
use scl_topology::model::{IncludeModel, Model};
use scl_topology::parse::{Part, parse_part};
use scl_topology::source::{FileId, Sources, Span, Spanned};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A file that belongs to a topology because another file includes it.
#[derive(Debug, Clone)]
pub struct Included {
    /// The file in [`Loaded::sources`](crate::Loaded::sources).
    pub file: FileId,
    /// Its path on disk.
    pub path: PathBuf,
    /// Its path from the folder of the topology file.
    pub relative: PathBuf,
    /// The entry of `include` that names it: the first, if there are several.
    pub by: Span,
}

/// Reads a topology file and those that it includes. Those that are `known` are not read from disk.
pub(crate) fn read(
    request: &Request,
    main: FileId,
    known: &[Included],
    sources: &mut Sources,
    problems: &mut Diagnostics,
) -> (Scope, Vec<Included>) {
    let model = parse_part(sources, main, Part::Main, problems);
    let identity = identity(&request.path);
    let known = known.iter().map(|file| (file.path.as_path(), file.file)).collect();
    let mut reader = Reader {
        request,
        known,
        sources,
        problems,
        parsed: HashMap::new(),
        told: Told::default(),
        included: Vec::new(),
        scopes: HashMap::new(),
    };
    let scope = reader.scope(model, Path::new(""), &mut vec![identity]);
    (scope, reader.included)
}

/// Says of each problem in an included file which other files include it.
pub(crate) fn tell_chain(problems: Vec<Diagnostic>, included: &[Included], sources: &Sources) -> Vec<Diagnostic> {
    let by: HashMap<FileId, Span> = included.iter().map(|file| (file.file, file.by)).collect();
    let chain = |problem: &Diagnostic| {
        let mut file = problem.primary.as_ref()?.span.file;
        let mut text = format!("`{}` is included at ", sources.file(file).path());
        let mut by_files = Vec::new();
        while let Some(at) = by.get(&file) {
            by_files.push(sources.place(*at));
            file = at.file;
        }
        text.push_str(&by_files.join(", which is included at "));
        (!by_files.is_empty()).then_some(text)
    };
    problems.into_iter().map(|problem| chain(&problem).into_iter().fold(problem, Diagnostic::note)).collect()
}

struct Reader<'r> {
    request: &'r Request,
    known: HashMap<&'r Path, FileId>,
    sources: &'r mut Sources,
    problems: &'r mut Diagnostics,
    /// What each file declares that was read so far, by what the operating system calls it.
    parsed: HashMap<PathBuf, (FileId, Model)>,
    /// What is reported already: a file that becomes several groups has each problem once.
    told: Told,
    included: Vec<Included>,
    /// What the groups of a file contain.
    scopes: HashMap<PathBuf, Arc<Scope>>,
}

/// An entry of `include`, and the file that it names.
struct Named<'e> {
    entry: &'e IncludeModel,
    path: PathBuf,
    /// Its path from the folder of the topology file.
    relative: PathBuf,
    /// What the operating system calls it.
    identity: PathBuf,
}

impl Reader<'_> {
    /// Joins a file in `folder`, which is relative to that of the topology file, with those that it includes. `chain`
    /// are the files over which it was reached, and the file itself.
    fn scope(&mut self, model: Model, folder: &Path, chain: &mut Vec<PathBuf>) -> Scope {
        let mut model = model;
        let entries = take_entries(&mut model, folder);
        let mut names = HashSet::from_iter(chain.last().cloned());
        let mut scope = Scope { model, groups: Vec::new() };
        self.include(&entries, folder, chain, &mut scope, &mut names);
        scope
    }

    /// Reads the `entries` of a file. `names` are the files that the scope has already.
    fn include(
        &mut self,
        entries: &[IncludeModel],
        folder: &Path,
        chain: &mut Vec<PathBuf>,
        scope: &mut Scope,
        names: &mut HashSet<PathBuf>,
    ) {
        let mut named: HashMap<PathBuf, Span> = HashMap::new();
        for entry in entries {
            let file = &entry.file;
            let relative = plain(&folder.join(&file.value));
            self.report(elsewhere(file, &relative));
            let path = self.request.path.parent().unwrap_or(Path::new("")).join(&relative);
            let found = Named { entry, identity: identity(&path), path, relative };
            let is_group = entry.group.is_some();
            if chain.contains(&found.identity) {
                let problem = circle(file, chain.last() == Some(&found.identity));
                let text = match is_group {
                    true => "remove the entry: a file cannot be a group in itself",
                    false => "remove the entry: all files share one space of names",
                };
                self.report(Some(self.removing(problem, text, entry).otherwise(text)));
                // What names the group is not wrong.
                scope.model.components_unread |= is_group;
            } else if is_group {
                self.add_group(&found, chain, scope);
            } else if let Some(first) = named.insert(found.identity.clone(), file.span) {
                let problem = NO_EFFECT.at(format!("`{}` is included twice", file.value), file.span, "second time");
                let problem = problem.label(first, "first time");
                self.report(Some(self.removing(problem, "remove one of the two", entry)));
            } else if names.insert(found.identity.clone()) {
                self.add(&found, chain, scope, names);
            }
        }
    }

    /// Adds what a file declares, and those that it includes, to those of the scope.
    fn add(&mut self, named: &Named<'_>, chain: &mut Vec<PathBuf>, scope: &mut Scope, names: &mut HashSet<PathBuf>) {
        let Some((_, mut part)) = self.parsed(named, chain, &mut scope.model) else { return };
        let entries = take_entries(&mut part, parent(&named.relative));
        join(&mut scope.model, part, self.problems);
        chain.push(named.identity.clone());
        self.include(&entries, parent(&named.relative), chain, scope, names);
        chain.pop();
    }

    /// Adds a file as a group.
    fn add_group(&mut self, named: &Named<'_>, chain: &mut Vec<PathBuf>, scope: &mut Scope) {
        let Some(name) = named.entry.group.clone() else { return };
        let Some((file, part)) = self.parsed(named, chain, &mut scope.model) else { return };
        let inner = match self.scopes.get(&named.identity) {
            Some(known) => Arc::clone(known),
            None => {
                chain.push(named.identity.clone());
                let inner = Arc::new(self.scope(part, parent(&named.relative), chain));
                chain.pop();
                self.scopes.insert(named.identity.clone(), Arc::clone(&inner));
                inner
            }
        };
        scope.groups.push(Group { name, file, stem: stem(&named.relative), scope: inner });
    }

    /// What a file declares, whose paths start at the folder of the topology file. `None` if it cannot be read, which
    /// is reported: anything may be missing in `model`.
    fn parsed(&mut self, named: &Named<'_>, chain: &[PathBuf], model: &mut Model) -> Option<(FileId, Model)> {
        let entry = named.entry;
        let name = &entry.file;
        let is_known = self.parsed.contains_key(&named.identity);
        // The chain begins with the topology file.
        if chain.len() > MOST_LEVELS || self.included.len() == MOST_FILES && !is_known {
            model.cut_off = true;
            let found = TOO_MANY.at(format!("`{}` is one file too many", name.value), name.span, "");
            self.report(Some(found.help(format!(
                "a system has at most {MOST_FILES} files, and each is reached over at most {MOST_LEVELS} others"
            ))));
            return None;
        }
        if let Some(known) = self.parsed.get(&named.identity) {
            return Some(known.clone());
        }
        let opened = match name.value.ends_with(".proto") {
            true => Err(schema(name)),
            false => self.open(&named.path, &named.relative).map_err(|cause| self.unreadable(name, &named.path, cause)),
        };
        let file = match opened {
            Ok(file) => file,
            Err(problem) => {
                model.cut_off = true;
                self.report(Some(problem));
                return None;
            }
        };
        let Named { path, relative, .. } = named;
        self.included.push(Included { file, path: path.clone(), relative: relative.clone(), by: entry.span });
        let mut part = parse_part(self.sources, file, Part::Included, self.problems);
        if is_without_effect(&part) {
            let found = NO_EFFECT.at(format!("`{}` declares nothing", name.value), name.span, "has no effect");
            let text = "remove the entry, or add components to the file";
            self.report(Some(self.removing(found, text, entry)));
        }
        for path in part.schemas.iter_mut().chain(&mut part.schema_roots) {
            path.value = plain(&parent(relative).join(&path.value)).display().to_string();
        }
        self.parsed.insert(named.identity.clone(), (file, part.clone()));
        Some((file, part))
    }

    fn report(&mut self, problem: Option<Diagnostic>) {
        if let Some(problem) = problem {
            self.told.push(problem, self.problems);
        }
    }

    /// The text of a file: as it was read before, in place of that on disk, or from disk.
    fn open(&mut self, path: &Path, relative: &Path) -> Result<FileId, Unreadable> {
        if let Some(known) = self.known.get(path) {
            return Ok(*known);
        }
        let text = match self.request.texts.get(path) {
            Some(text) => text.clone(),
            None => read_text(path, self.request.max_size)?,
        };
        Ok(self.sources.add(self.shown_as(relative), text))
    }

    fn unreadable(&self, entry: &Spanned<String>, path: &Path, cause: Unreadable) -> Diagnostic {
        let name = &entry.value;
        let missing = || UNREADABLE.at(format!("cannot find the included file `{name}`"), entry.span, "");
        match cause {
            Unreadable::Missing if name.contains('*') => {
                let folder = path.parent().unwrap_or(Path::new(""));
                let inside = Path::new(name).parent().unwrap_or(Path::new(""));
                self.naming_each(missing(), entry, folder, inside).note("a pattern names no file")
            }
            Unreadable::Missing => {
                let near = similar_file(path, &[]);
                let near = near.map(|near| Path::new(name).with_file_name(near).display().to_string());
                let found = missing().did_you_mean(name, near.as_slice());
                found.note("paths start at the folder of the file that contains them")
            }
            cause => {
                let is_folder = path.is_dir();
                let message = format!("the included file {}", why(Path::new(name), cause));
                let found = UNREADABLE.at(message, entry.span, "");
                if is_folder { self.naming_each(found, entry, path, Path::new(name)) } else { found }
            }
        }
    }

    /// Suggests the topology files in a folder, which the entry calls `inside`.
    fn naming_each(&self, found: Diagnostic, entry: &Spanned<String>, folder: &Path, inside: &Path) -> Diagnostic {
        let names = file_names(folder).into_iter().filter(|name| is_yaml(name));
        let names: Vec<String> = names.map(|name| inside.join(name).display().to_string()).collect();
        name_each(found, entry, &names, self.sources, "name each of the files")
    }

    /// Suggests to remove an entry.
    fn removing(&self, found: Diagnostic, text: &'static str, entry: &IncludeModel) -> Diagnostic {
        found.suggest_removal(text, self.sources.file(entry.span.file), entry.span)
    }

    /// How messages name a file: as the topology file, in its folder.
    fn shown_as(&self, relative: &Path) -> String {
        let folder = Path::new(&self.request.shown_as).parent().unwrap_or(Path::new(""));
        folder.join(relative).display().to_string()
    }
}

/// The path of a file by which it is recognized under another one.
fn identity(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_path_buf())
}

/// The entries of `include` of a file in `folder`. Those that stay in the model start at the folder of the topology
/// file.
fn take_entries(model: &mut Model, folder: &Path) -> Vec<IncludeModel> {
    let entries = model.include.clone();
    for entry in &mut model.include {
        entry.file.value = plain(&folder.join(&entry.file.value)).display().to_string();
    }
    entries
}

fn parent(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// The name of a file without its extension, as it stands before those of kinds.
fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let stem: String = stem.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' }).collect();
    if stem.starts_with(|letter: char| letter.is_ascii_digit()) { format!("_{stem}") } else { stem }
}

fn elsewhere(entry: &Spanned<String>, relative: &Path) -> Option<Diagnostic> {
    let why = works_here_only(relative)?;
    let found = ELSEWHERE.at(format!("the path of an included file {why}"), entry.span, "");
    Some(found.help("keep the file beside the topology file, or in a folder below it"))
}

fn circle(entry: &Spanned<String>, is_itself: bool) -> Diagnostic {
    let message = match is_itself {
        true => format!("`{}` includes itself", entry.value),
        false => format!("`{}` is included by a file that it includes", entry.value),
    };
    CIRCLE.at(message, entry.span, "")
}

fn schema(entry: &Spanned<String>) -> Diagnostic {
    let message = format!("`{}` is a schema, not a topology file", entry.value);
    UNREADABLE.at(message, entry.span, "").help("`schemas` names the `.proto` files that declare the messages")
}
