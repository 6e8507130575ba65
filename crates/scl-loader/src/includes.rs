//! `include:` of a topology file: reads all files of a system, and joins them. SCL1501 to SCL1506.

use crate::name_each::name_each;
use crate::paths::{plain, works_here_only};
use crate::read::{Unreadable, read_text};
use crate::request::Request;
use crate::unreadable::{file_names, is_yaml, similar_file, why};
use scl_topology::diagnostic::{Diagnostic, Diagnostics};
use scl_topology::join::{
    CIRCLE, ELSEWHERE, MOST_FILES, MOST_LEVELS, NO_EFFECT, TOO_MANY, UNREADABLE, is_without_effect, join,
};
use scl_topology::model::Model;
use scl_topology::parse::{Part, complete, parse_part};
use scl_topology::source::{FileId, Sources, Span, Spanned};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

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

/// Reads the files that a topology file includes, and returns what all of them declare. Those that are `known` are not
/// read from disk.
pub(crate) fn read(
    request: &Request,
    main: FileId,
    known: &[Included],
    sources: &mut Sources,
    problems: &mut Diagnostics,
) -> (Model, Vec<Included>) {
    let model = parse_part(sources, main, Part::Main, problems);
    let entries = model.include.clone();
    let identity = identity(&request.path);
    let known = known.iter().map(|file| (file.path.as_path(), file.file)).collect();
    let names = HashSet::from([identity.clone()]);
    let mut reader = Reader { request, known, sources, problems, model, included: Vec::new(), names };
    reader.include(&entries, Path::new(""), &mut vec![identity]);
    let Reader { mut model, included, .. } = reader;
    complete(&mut model, sources, problems);
    (model, included)
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
    /// What the files declare that were read so far.
    model: Model,
    included: Vec<Included>,
    /// The files that were read so far, as the operating system names them.
    names: HashSet<PathBuf>,
}

impl Reader<'_> {
    /// Reads the `entries` of a file in `folder`, which is relative to that of the topology file. `chain` are the files
    /// over which it was reached, and the file itself.
    fn include(&mut self, entries: &[Spanned<String>], folder: &Path, chain: &mut Vec<PathBuf>) {
        let mut named: HashMap<PathBuf, Span> = HashMap::new();
        for entry in entries {
            let relative = plain(&folder.join(&entry.value));
            self.problems.extend(elsewhere(entry, &relative));
            let path = self.request.path.parent().unwrap_or(Path::new("")).join(&relative);
            let identity = identity(&path);
            if let Some(first) = named.insert(identity.clone(), entry.span) {
                let found = NO_EFFECT.at(format!("`{}` is included twice", entry.value), entry.span, "second time");
                let found = found.label(first, "first time");
                self.problems.push(self.removing(found, "remove one of the two", entry));
            } else if chain.contains(&identity) {
                let found = circle(entry, chain.last() == Some(&identity));
                let text = "remove the entry: all files share one space of names";
                self.problems.push(self.removing(found, text, entry));
            } else if self.names.insert(identity.clone()) {
                chain.push(identity);
                self.add(entry, path, &relative, chain);
                chain.pop();
            }
        }
    }

    /// Reads one file, and those that it includes.
    fn add(&mut self, entry: &Spanned<String>, path: PathBuf, relative: &Path, chain: &mut Vec<PathBuf>) {
        // The chain begins with the topology file and ends with this one.
        if chain.len() > MOST_LEVELS + 1 || self.included.len() == MOST_FILES {
            self.model.cut_off = true;
            let message = format!("`{}` is one file too many", entry.value);
            let found = TOO_MANY.at(message, entry.span, "");
            self.problems.push(found.help(format!(
                "a system has at most {MOST_FILES} files, and each is reached over at most {MOST_LEVELS} others"
            )));
            return;
        }
        let opened = match entry.value.ends_with(".proto") {
            true => Err(schema(entry)),
            false => self.open(&path, relative).map_err(|cause| self.unreadable(entry, &path, cause)),
        };
        let file = match opened {
            Ok(file) => file,
            Err(problem) => {
                self.model.cut_off = true;
                self.problems.push(problem);
                return;
            }
        };
        self.included.push(Included { file, path, relative: relative.to_path_buf(), by: entry.span });
        let mut part = parse_part(self.sources, file, Part::Included, self.problems);
        if is_without_effect(&part) {
            let found = NO_EFFECT.at(format!("`{}` declares nothing", entry.value), entry.span, "has no effect");
            self.problems.push(self.removing(found, "remove the entry, or add components to the file", entry));
        }
        let folder = relative.parent().unwrap_or(Path::new(""));
        let entries = part.include.clone();
        for path in part.include.iter_mut().chain(&mut part.schemas).chain(&mut part.schema_roots) {
            path.value = plain(&folder.join(&path.value)).display().to_string();
        }
        join(&mut self.model, part, self.problems);
        self.include(&entries, folder, chain);
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
    fn removing(&self, found: Diagnostic, text: &'static str, entry: &Spanned<String>) -> Diagnostic {
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
