//! Paths of files as a topology file names them.

use std::path::{Component, Path, PathBuf};

/// The path without `.`.
pub(crate) fn plain(path: &Path) -> PathBuf {
    path.components().filter(|part| *part != Component::CurDir).collect()
}

/// Whether a path leads out of the folder at which it starts.
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

/// Says why the file at a path, which starts at the folder of the topology file, does not exist on other machines.
pub(crate) fn works_here_only(path: &Path) -> Option<&'static str> {
    if path.is_absolute() {
        Some("is absolute; the file will not be found on another machine")
    } else if leaves_its_folder(path) {
        Some("leaves the folder of the topology file; it will not be found if only that folder is copied")
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::leaves_its_folder;
    use std::path::Path;

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
