//! Where the topology file is: beside the invoking source file, in the package, or in the workspace.

use crate::arguments::Arguments;
use crate::{editor, extern_crates};
use scl_loader::{LookedIn, Request};
use scl_topology::diagnostic::Diagnostic;
use scl_topology::external::PATH_OF_ONE_MACHINE;
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

/// Where the macro is invoked, as plain values, so that tests need no compiler.
pub(crate) struct Surroundings {
    /// The invoking source file; `None` in tools that do not provide it.
    pub(crate) source_file: Option<PathBuf>,
    /// The folder of the package's Cargo.toml.
    pub(crate) package: Option<PathBuf>,
    /// The folder of the workspace's Cargo.toml.
    pub(crate) workspace: Option<PathBuf>,
    /// The compiler's working directory. Messages show paths relative to it.
    pub(crate) working_dir: PathBuf,
    /// The crates that the invoking code can name; `None` in tools that do not provide them.
    pub(crate) extern_crates: Option<BTreeSet<String>>,
    /// Whether the code is shown in an editor, and not compiled.
    pub(crate) for_editor: bool,
}

impl Surroundings {
    /// The surroundings of the running compiler.
    pub(crate) fn of_compiler(source_file: Option<PathBuf>) -> Self {
        let package = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
        let workspace = package.as_deref().and_then(workspace_root);
        let working_dir = std::env::current_dir().unwrap_or_default();
        let (extern_crates, for_editor) = (extern_crates::of_compiler(), editor::runs_macros());
        Self { source_file, package, workspace, working_dir, extern_crates, for_editor }
    }

    /// The paths that `path` may mean, in the order in which they are tried, without repetitions.
    fn candidates(&self, path: &str) -> Vec<LookedIn> {
        let beside = self.source_file.as_deref().and_then(Path::parent).map(|folder| self.working_dir.join(folder));
        // If the source file is unknown, `src` is its most likely folder.
        let likely = self.package.as_ref().filter(|_| beside.is_none()).map(|package| package.join("src"));
        let folders = [
            (beside, "next to this source file"),
            (self.package.clone(), "package root, CARGO_MANIFEST_DIR"),
            (likely, "the package's `src`"),
            (self.workspace.clone(), "workspace root"),
        ];
        let mut candidates: Vec<LookedIn> = Vec::new();
        for (folder, what) in folders {
            let Some(folder) = folder else { continue };
            let path = folder.join(path);
            if candidates.iter().all(|candidate| candidate.path != path) {
                candidates.push(LookedIn { shown_as: shown(&path, &self.working_dir), path, what: what.to_owned() });
            }
        }
        candidates
    }
}

/// Which file to load: the first candidate that exists, or the first candidate if none does.
pub(crate) fn locate(arguments: &Arguments, surroundings: &Surroundings) -> Request {
    let written = arguments.path.value();
    let candidates = surroundings.candidates(&written);
    let found = candidates.iter().find(|candidate| candidate.path.symlink_metadata().is_ok());
    let path = found.or(candidates.first()).map_or_else(|| PathBuf::from(&written), |it| it.path.clone());
    let shown_as = match found {
        Some(_) => shown(&path, &surroundings.working_dir),
        None => written,
    };
    let max_size = arguments.max_size.unwrap_or(Request::MAX_SIZE);
    let mut request = Request { shown_as, max_size, looked_in: candidates, ..Request::new(path) };
    request.crates.extend(surroundings.extern_crates.iter().flatten().cloned());
    request
}

/// `SCL0006`: a path that does not exist on other machines, or that a published package does not contain.
pub(crate) fn check_path(arguments: &Arguments, request: &Request, surroundings: &Surroundings) -> Option<Diagnostic> {
    let written = arguments.path.value();
    if Path::new(&written).is_absolute() {
        let name = request.path.file_name().unwrap_or_default().to_string_lossy();
        let problem = PATH_OF_ONE_MACHINE
            .without_place("the topology path is absolute; the crate will not build on another machine");
        return Some(problem.help(format!("write the path relative to this file or to Cargo.toml: \"{name}\"")));
    }
    let package = surroundings.package.as_deref()?;
    let has_dots = written.split('/').any(|part| part == "..");
    let is_outside = has_dots && !without_dots(&request.path).starts_with(without_dots(package));
    is_outside.then(|| {
        PATH_OF_ONE_MACHINE
            .without_place("the topology path is outside of the package; `cargo package` will not include the file")
            .help("keep the topology file inside the package, or do not publish the package")
    })
}

/// The path as messages show it: relative to the working directory if it is inside.
fn shown(path: &Path, working_dir: &Path) -> String {
    let path = without_dots(path);
    path.strip_prefix(without_dots(working_dir)).unwrap_or(&path).display().to_string()
}

/// Removes `.` and `a/..` without asking the file system.
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

/// The nearest ancestor whose Cargo.toml has a `[workspace]`. Cargo tells macros only the package.
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
            working_dir: "/w".into(),
            extern_crates: None,
            for_editor: false,
        }
    }

    fn paths(candidates: Vec<LookedIn>) -> Vec<String> {
        candidates.iter().map(|candidate| candidate.path.display().to_string()).collect()
    }

    #[test]
    fn candidates_are_in_order() {
        let beside = surroundings(Some("uav/src/main.rs")).candidates("t.yaml");
        assert_eq!(paths(beside), ["/w/uav/src/t.yaml", "/w/uav/t.yaml", "/w/t.yaml"]);
        let unknown = surroundings(None).candidates("t.yaml");
        assert_eq!(paths(unknown), ["/w/uav/t.yaml", "/w/uav/src/t.yaml", "/w/t.yaml"]);
        let absolute = surroundings(None).candidates("/etc/t.yaml");
        assert_eq!(paths(absolute), ["/etc/t.yaml"]);
    }

    #[test]
    fn paths_of_one_machine_cause_a_warning() {
        let cases = [
            ("t.yaml", None),
            ("../t.yaml", None),
            ("/w/t.yaml", Some("is absolute")),
            ("../../t.yaml", Some("outside")),
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
    fn messages_show_paths_relative_to_the_working_directory() {
        let cases =
            [("/w/uav/src/../t.yaml", "uav/t.yaml"), ("/w/./t.yaml", "t.yaml"), ("/else/t.yaml", "/else/t.yaml")];
        for (path, expected) in cases {
            assert_eq!(shown(Path::new(path), Path::new("/w")), expected);
        }
    }
}
