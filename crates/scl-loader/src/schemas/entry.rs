//! What can be wrong with an entry of `schemas:` before its file is read.

use scl_topology::diagnostic::Diagnostic;
use scl_topology::external::{SCHEMA_ELSEWHERE, SCHEMA_TWICE};
use scl_topology::source::{Span, Spanned};
use std::collections::HashMap;
use std::path::{Component, Path, PathBuf};

/// The files that earlier entries lead to.
#[derive(Default)]
pub(super) struct Named(HashMap<PathBuf, (String, Span)>);

impl Named {
    /// `SCL0416`: an earlier entry leads to the same file.
    pub(super) fn twice(&mut self, schema: &Spanned<String>, folder: &Path) -> Option<Diagnostic> {
        // A file that does not exist is reported elsewhere, under each name.
        let path = folder.join(&schema.value).canonicalize().ok()?;
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
    let message = if path.is_absolute() {
        "the schema path is absolute; the file will not be found on another machine"
    } else if leaves_its_folder(path) {
        "the schema path leaves the folder of the topology file; it will not be found if only that folder is copied"
    } else {
        return None;
    };
    let found = SCHEMA_ELSEWHERE.at(message, schema.span, "");
    Some(found.help("keep the schema beside the topology file, or in a folder below it"))
}

fn leaves_its_folder(path: &Path) -> bool {
    let mut depth = 0_i32;
    path.components().any(|part| {
        depth += match part {
            Component::ParentDir => -1,
            Component::Normal(_) => 1,
            _ => 0,
        };
        depth < 0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_that_leave_the_folder_are_found() {
        for (path, leaves) in [
            ("a.proto", false),
            ("./a.proto", false),
            ("proto/../a.proto", false),
            ("../a.proto", true),
            ("proto/../../proto/a.proto", true),
        ] {
            assert_eq!(leaves_its_folder(Path::new(path)), leaves, "{path}");
        }
    }
}
