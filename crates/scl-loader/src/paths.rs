//! Paths of files as a topology file names them.

use std::path::{Component, Path, PathBuf};

/// The path without `.`.
pub(crate) fn plain(path: &Path) -> PathBuf {
    path.components().filter(|part| *part != Component::CurDir).collect()
}

/// Whether a path leads out of the folder at which it starts.
pub(crate) fn leaves_its_folder(path: &Path) -> bool {
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
