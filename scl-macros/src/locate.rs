//! Where the topology file is: beside the calling source file, in the package, in the workspace.

use crate::arguments::Arguments;
use scl_loader::{LookedIn, Request};
use scl_topology::diagnostic::Diagnostic;
use std::path::{Component, Path, PathBuf};

/// Where the macro is called, as plain values, so that tests need no compiler.
pub(crate) struct Surroundings {
    /// The file with the call; `None` under tools that do not tell.
    pub(crate) source_file: Option<PathBuf>,
    /// The folder of the package's Cargo.toml.
    pub(crate) package: Option<PathBuf>,
    /// The folder of the workspace's Cargo.toml.
    pub(crate) workspace: Option<PathBuf>,
    /// The compiler's working folder, to which messages are relative.
    pub(crate) working: PathBuf,
}

impl Surroundings {
    /// Those of the running compiler.
    pub(crate) fn of_compiler(source_file: Option<PathBuf>) -> Self {
        let package = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
        let workspace = package.as_deref().and_then(workspace_root);
        Self { source_file, package, workspace, working: std::env::current_dir().unwrap_or_default() }
    }

    /// The places in which a path is looked for, in order, each once.
    fn places(&self, path: &str) -> Vec<LookedIn> {
        let beside = self.source_file.as_deref().and_then(Path::parent).map(|folder| self.working.join(folder));
        // Where the source file is unknown, its most likely folder stands in.
        let likely = self.package.as_ref().filter(|_| beside.is_none()).map(|package| package.join("src"));
        let folders = [
            (beside, "next to this source file"),
            (self.package.clone(), "package root, CARGO_MANIFEST_DIR"),
            (likely, "the package's `src`"),
            (self.workspace.clone(), "workspace root"),
        ];
        let mut places: Vec<LookedIn> = Vec::new();
        for (folder, what) in folders {
            let Some(folder) = folder else { continue };
            let path = folder.join(path);
            if places.iter().all(|place| place.path != path) {
                places.push(LookedIn { shown_as: shown(&path, &self.working), path, what: what.to_owned() });
            }
        }
        places
    }
}

/// Which file to load: the first that exists, or the first place if none does.
pub(crate) fn locate(arguments: &Arguments, surroundings: &Surroundings) -> Request {
    let written = arguments.path.value();
    let places = surroundings.places(&written);
    let found = places.iter().find(|place| place.path.symlink_metadata().is_ok());
    let path = found.or(places.first()).map_or_else(|| PathBuf::from(&written), |place| place.path.clone());
    let shown_as = match found {
        Some(_) => shown(&path, &surroundings.working),
        None => written,
    };
    let max_size = arguments.max_size.unwrap_or(Request::MAX_SIZE);
    Request { path, shown_as, max_size, looked_in: places }
}

/// `SCL0006`: a path that other machines do not have, or that a published package does not carry.
pub(crate) fn check_path(arguments: &Arguments, request: &Request, surroundings: &Surroundings) -> Option<Diagnostic> {
    let written = arguments.path.value();
    if Path::new(&written).is_absolute() {
        let name = request.path.file_name().unwrap_or_default().to_string_lossy();
        let problem = Diagnostic::fileless(
            "SCL0006",
            "the topology path is absolute; the crate will not build on another machine",
        );
        return Some(problem.help(format!("write the path relative to this file or to Cargo.toml: \"{name}\"")));
    }
    let package = surroundings.package.as_deref()?;
    let leaves =
        written.split('/').any(|part| part == "..") && !without_dots(&request.path).starts_with(without_dots(package));
    leaves.then(|| {
        Diagnostic::fileless("SCL0006", "the topology path leaves the package; `cargo package` will not carry the file")
            .help("keep the topology file inside the package, or do not publish the package")
    })
}

/// The path as messages name it: relative to the working folder if it lies inside.
fn shown(path: &Path, working: &Path) -> String {
    let path = without_dots(path);
    path.strip_prefix(without_dots(working)).unwrap_or(&path).display().to_string()
}

/// Takes `.` and `a/..` out without asking the file system.
pub(crate) fn without_dots(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(out.components().next_back(), Some(Component::Normal(_))) => {
                out.pop();
            }
            other => out.push(other),
        }
    }
    out
}

/// The nearest folder upwards whose Cargo.toml has a `[workspace]`. Cargo tells a macro only the package.
fn workspace_root(package: &Path) -> Option<PathBuf> {
    let is_root = |folder: &&Path| {
        let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
        manifest.lines().any(|line| line.trim_start().starts_with("[workspace"))
    };
    package.ancestors().find(is_root).map(Path::to_path_buf)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surroundings(source_file: Option<&str>) -> Surroundings {
        Surroundings {
            source_file: source_file.map(PathBuf::from),
            package: Some("/w/uav".into()),
            workspace: Some("/w".into()),
            working: "/w".into(),
        }
    }

    fn paths(places: Vec<LookedIn>) -> Vec<String> {
        places.iter().map(|place| place.path.display().to_string()).collect()
    }

    #[test]
    fn places_are_looked_at_in_order() {
        let beside = surroundings(Some("uav/src/main.rs")).places("t.yaml");
        assert_eq!(paths(beside), ["/w/uav/src/t.yaml", "/w/uav/t.yaml", "/w/t.yaml"]);
        let unknown = surroundings(None).places("t.yaml");
        assert_eq!(paths(unknown), ["/w/uav/t.yaml", "/w/uav/src/t.yaml", "/w/t.yaml"]);
        let absolute = surroundings(None).places("/etc/t.yaml");
        assert_eq!(paths(absolute), ["/etc/t.yaml"]);
    }

    #[test]
    fn paths_of_one_machine_are_warned_of() {
        let cases = [
            ("t.yaml", None),
            ("../t.yaml", None),
            ("/w/t.yaml", Some("is absolute")),
            ("../../t.yaml", Some("leaves")),
        ];
        for (written, warning) in cases {
            let surroundings = surroundings(Some("uav/src/main.rs"));
            let tokens = format!("scl, {written:?}").parse().unwrap();
            let Ok(arguments) = Arguments::parse(tokens) else { panic!("refused {written}") };
            let request = locate(&arguments, &surroundings);
            let found = check_path(&arguments, &request, &surroundings).map(|problem| problem.message);
            assert_eq!(found.is_some(), warning.is_some(), "{written}");
            assert!(found.unwrap_or_default().contains(warning.unwrap_or_default()), "{written}");
        }
    }

    #[test]
    fn messages_name_the_file_relative_to_the_working_folder() {
        let cases =
            [("/w/uav/src/../t.yaml", "uav/t.yaml"), ("/w/./t.yaml", "t.yaml"), ("/else/t.yaml", "/else/t.yaml")];
        for (path, expected) in cases {
            assert_eq!(shown(Path::new(path), Path::new("/w")), expected);
        }
    }
}
