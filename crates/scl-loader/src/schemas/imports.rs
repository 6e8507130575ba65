//! Imports that do not name exactly one file.

use super::folders::{Folders, Found};
use super::lexemes::{Lexemes, is_string};
use super::mistake::Mistake;
use super::outline::outline;
use crate::unreadable::similar_file;
use protox::file::{FileResolver, GoogleFileResolver};
use std::collections::HashSet;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

/// `import "name";`.
struct Import<'t> {
    name: &'t str,
    /// The whole statement.
    at: Range<usize>,
}

/// A schema file and its imports.
struct Importer<'f> {
    /// As the topology file would name it.
    file: &'f Path,
    folders: &'f Folders,
}

/// How many folders above that of the topology file are searched for an import.
const MOST_ABOVE: usize = 4;

/// What the imports of a schema lead to.
#[derive(Default)]
pub(super) struct Imported {
    pub(super) mistakes: Vec<Mistake>,
    /// The files that the names can mean: a change of one of them can change the meaning.
    pub(super) files: Vec<PathBuf>,
}

/// Looks at the imports of the schema at `path`.
pub(super) fn look_up(text: &str, path: &Path, folders: &Folders) -> Imported {
    let importer = Importer { file: folders.relative(path), folders };
    let mut imported = Imported::default();
    for import in imports(text) {
        imported.files.extend(folders.candidates(import.name).filter(|path| path.is_file()));
        imported.mistakes.extend(importer.judge(&import));
    }
    imported
}

/// What the entries of `schemas` import.
pub(super) fn of_entries(folders: &Folders) -> HashSet<String> {
    let texts = folders.entries().filter_map(|path| folders.read(path));
    texts.flat_map(|text| imports(&text).into_iter().map(|import| import.name.to_owned()).collect::<Vec<_>>()).collect()
}

/// Whether this is one of protobuf's own files, which are built into every implementation.
pub(super) fn is_built_in(name: &str) -> bool {
    name.starts_with("google/protobuf/") && GoogleFileResolver::new().open_file(name).is_ok()
}

impl Importer<'_> {
    fn judge(&self, import: &Import<'_>) -> Option<Mistake> {
        let name = import.name;
        if !is_portable(name) {
            return Some(self.unportable(import));
        }
        if is_built_in(name) {
            return None;
        }
        match self.folders.find(name) {
            Found::Missing => Some(self.missing(import)),
            Found::Two(one, other) => Some(self.ambiguous(import, [one, other])),
            Found::One(paths) => {
                let path = paths.first()?;
                let entry = self.folders.entry_with_other_name(name, path)?;
                Some(self.renamed(import, entry))
            }
        }
    }

    fn mistake(&self, import: &Import<'_>, message: String, help: Option<String>, note: &str) -> Mistake {
        let label = "imported here".to_owned();
        let file = self.file.display().to_string();
        let at = import.at.clone();
        Mistake { file, at, message, label, help, note: Some(note.to_owned()), ..Mistake::default() }
    }

    /// Reports a path that protobuf does not allow: `import "../a.proto";`.
    fn unportable(&self, import: &Import<'_>) -> Mistake {
        let message =
            format!("the import `{}` in `{}` is not a path below an import folder", import.name, self.shown());
        let meant = self.file.parent().unwrap_or(Path::new("")).join(import.name.replace('\\', "/"));
        let meant = self.folders.path(&meant);
        let help = meant.canonicalize().ok().and_then(|_| self.folders.import_name(&meant)).map(write_import);
        self.mistake(import, message, help, "protobuf does not allow `.`, `..`, `\\` or absolute paths in imports")
    }

    fn missing(&self, import: &Import<'_>) -> Mistake {
        let message = format!("cannot find `{}`, which `{}` imports", import.name, self.shown());
        let above = self.above().find(|folder| self.folders.path(&folder.join(import.name)).is_file());
        if let Some(folder) = above {
            let in_roots = || self.folders.import_name(&self.folders.path(&folder.join(import.name)));
            let name = if self.folders.are_roots { in_roots() } else { None };
            let root = name.is_none().then_some(folder);
            return Mistake { root, ..self.mistake(import, message, name.map(write_import), self.where_imports_are()) };
        }
        let help = || {
            let near = self.folders.candidates(import.name).find_map(|path| similar_file(&path, &[]))?;
            let near = Path::new(import.name).with_file_name(near);
            // The file with the similar name may be the importing file itself.
            let is_itself =
                self.folders.candidates(near.to_str()?).any(|path| self.folders.relative(&path) == self.file);
            (!is_itself).then(|| format!("a file with a similar name exists: `{}`", near.display()))
        };
        let follows = self.folders.is_misplaced(import.name);
        Mistake { follows, ..self.mistake(import, message, help(), self.where_imports_are()) }
    }

    fn ambiguous(&self, import: &Import<'_>, found: [PathBuf; 2]) -> Mistake {
        let name = import.name;
        let [one, other] = found.each_ref().map(|path| self.folders.relative(path).display());
        let message = format!("the import `{name}` in `{}` can mean two files: `{one}` and `{other}`", self.shown());
        // Prefer the file next to the importing one: it is more likely meant.
        let [first, second] = &found;
        let is_beside = |path: &Path| self.folders.relative(path).parent() == self.file.parent();
        let in_order = if is_beside(second) { [second, first] } else { [first, second] };
        let longer = in_order.into_iter().filter_map(|path| self.folders.import_name(path)).find(|path| path != name);
        let help = match (self.first_difference(&found), longer) {
            (Some(line), _) => {
                format!("both declare the same messages, and differ in line {line}: make them equal, or keep only one")
            }
            (None, Some(longer)) => {
                format!("rename one of the files, or write a path that only one has: `import \"{longer}\";`")
            }
            (None, None) => "rename one of the files, or remove its folder from `schema_roots`".to_owned(),
        };
        let subject = Some(name.to_owned());
        Mistake { subject, ..self.mistake(import, message, Some(help), self.where_imports_are()) }
    }

    /// The first line that differs in two files that declare messages of the same names: they are copies.
    fn first_difference(&self, files: &[PathBuf; 2]) -> Option<usize> {
        let [one, other] = files.each_ref().map(|path| self.folders.read(path));
        let (one, other) = (one?, other?);
        let names = |text: &str| outline(text).full_names().collect::<HashSet<_>>();
        if names(&one).is_disjoint(&names(&other)) {
            return None;
        }
        let same = one.lines().zip(other.lines()).take_while(|(one, other)| one == other);
        Some(same.count() + 1)
    }

    /// An import of a file that is also an entry of `schemas`, under another name.
    fn renamed(&self, import: &Import<'_>, entry: &str) -> Mistake {
        let name = import.name;
        let message = format!("`{name}`, which `{}` imports, is the schema `{entry}` under another name", self.shown());
        let root = entry.strip_suffix(name).and_then(|root| root.strip_suffix('/'));
        let root = root.filter(|_| !self.folders.are_roots).map(PathBuf::from);
        let help = if root.is_some() { None } else { Some(write_import(entry.to_owned())) };
        let note = "protobuf knows a file by its name: its messages would be declared twice";
        Mistake { root, ..self.mistake(import, message, help, note) }
    }

    /// The folder of the file and those above it, as the topology file would name them.
    fn above(&self) -> impl Iterator<Item = PathBuf> {
        let folder = self.file.parent().unwrap_or(Path::new(""));
        let up = folder.components().take_while(|part| *part == Component::ParentDir).count();
        let above = (1..).map(move |levels| std::iter::repeat_n("..", up + levels).collect());
        folder.ancestors().map(Path::to_path_buf).chain(above.take(MOST_ABOVE))
    }

    fn where_imports_are(&self) -> &'static str {
        match self.folders.are_roots {
            true => "imports are looked for in the folders of `schema_roots`",
            false => "imports are looked for beside the topology file and beside each of its `schemas`",
        }
    }

    fn shown(&self) -> std::path::Display<'_> {
        self.file.display()
    }
}

fn write_import(name: String) -> String {
    format!("write `import \"{name}\";`")
}

/// Whether protobuf allows the path in an import. A name means the same file in every importer, so it cannot be
/// relative to one of them.
fn is_portable(name: &str) -> bool {
    !name.contains('\\') && name.split('/').all(|part| !matches!(part, "" | "." | ".."))
}

/// The imports at the top level of a file, as far as they can be read.
fn imports(text: &str) -> Vec<Import<'_>> {
    let mut imports = Vec::new();
    let mut depth = 0_usize;
    // The start of the current statement and the imported name, once it is known to be an import.
    let mut open: Option<(usize, Option<&str>)> = None;
    let mut is_start = true;
    for (at, lexeme) in Lexemes::of(text) {
        match lexeme {
            "{" => depth += 1,
            "}" => depth = depth.saturating_sub(1),
            "import" if is_start && depth == 0 => open = Some((at, None)),
            "public" | "weak" if matches!(open, Some((_, None))) => {}
            ";" => {
                if let Some((start, Some(name))) = open.take() {
                    imports.push(Import { name, at: start..at + 1 });
                }
            }
            _ => {
                open = match open {
                    Some((start, None)) if is_string(lexeme) => {
                        let name = lexeme[1..].strip_suffix(&lexeme[..1]).filter(|name| !name.is_empty());
                        name.map(|name| (start, Some(name)))
                    }
                    _ => None,
                };
            }
        }
        is_start = matches!(lexeme, ";" | "{" | "}");
    }
    imports
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn imports_are_seen_in_any_text() {
        let text = "syntax = \"proto3\";import \"a.proto\";\n/* import \"no.proto\"; */ import public 'b/c.proto' ;\n\
                    option x = \"import \\\"no.proto\\\";\";message A { string import = 1; import \"no.proto\"; }\n\
                    import weak \"d.proto\";import;import \"\";import \"open.proto\nimport \"no\" \"no.proto\";";
        let found = imports(text);
        assert_eq!(found.iter().map(|import| import.name).collect::<Vec<_>>(), ["a.proto", "b/c.proto", "d.proto"]);
        assert_eq!(&text[found[1].at.clone()], "import public 'b/c.proto' ;");
    }

    #[test]
    fn paths_of_imports_have_no_dots() {
        for (name, expected) in [("a.proto", true), ("a/b.proto", true), ("./a.proto", false), ("a/../b.proto", false)]
        {
            assert_eq!(is_portable(name), expected, "{name}");
        }
        for name in ["/a.proto", "a//b.proto", "a\\b.proto", "..", ""] {
            assert!(!is_portable(name), "{name}");
        }
    }
}
