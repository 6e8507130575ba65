//! The program of each component, from a launch file or a cargo package.

use super::problem::Problem;
use std::ffi::{OsStr, OsString};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

/// The program that plays one component.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Program {
    /// The component's name.
    pub(crate) component: String,
    /// The program and its arguments.
    pub(crate) command: Vec<OsString>,
    /// Variables added to our own environment.
    pub(crate) environment: Vec<(String, String)>,
    /// Its working folder.
    pub(crate) folder: PathBuf,
}

/// Checks, before any program is started, that every folder and every executable exists.
pub(crate) fn check_programs(programs: &[Program]) -> Vec<Problem> {
    programs.iter().filter_map(|program| check_folder(program).or_else(|| check_executable(program))).collect()
}

fn check_folder(program: &Program) -> Option<Problem> {
    let Program { component, folder, .. } = program;
    let message = || format!("the folder of component `{component}` does not exist: `{}`", folder.display());
    (!folder.is_dir()).then(|| Problem::new(message()))
}

fn check_executable(program: &Program) -> Option<Problem> {
    let component = &program.component;
    let name = program.command.first()?;
    if name.as_encoded_bytes().contains(&b'/') {
        // Without the `./` that a path in a launch file usually starts with.
        let path: PathBuf = program.folder.join(name).components().collect();
        return match () {
            () if is_executable(&path) => None,
            () if path.is_file() => Some(
                Problem::new(format!("the program of component `{component}` is not executable: `{}`", path.display()))
                    .help(format!("make it so: `chmod +x {}`", path.display())),
            ),
            () => Some(Problem::new(format!(
                "the program of component `{component}` does not exist: `{}`",
                path.display()
            ))),
        };
    }
    let found = search_path(program).iter().any(|folder| is_executable(&program.folder.join(folder).join(name)));
    (!found).then(|| {
        let name = name.display();
        Problem::new(format!("the program `{name}` of component `{component}` is not in the search path"))
            .help(format!("install it, or write its path: `./{name}` is looked up in the component's folder"))
    })
}

fn search_path(program: &Program) -> Vec<PathBuf> {
    let own = program.environment.iter().rev().find(|(key, _)| key == "PATH").map(|(_, value)| OsString::from(value));
    let path = own.or_else(|| std::env::var_os("PATH")).unwrap_or_default();
    std::env::split_paths(OsStr::new(&path)).collect()
}

fn is_executable(path: &Path) -> bool {
    path.metadata().is_ok_and(|it| it.is_file() && it.permissions().mode() & 0o111 != 0)
}
