//! `scl x` for a program `scl-x` beside `scl` or in `PATH`: the user's, or a part of SCL that is installed separately.

use crate::exit::COULD_NOT_DO;
use clap::Command as CommandLine;
use scl_terminal::{Problem, closest_name, escape, print_err};
use std::env;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Replaces this process with the program `scl-x`; `words` are `x` and its arguments. Returns only if that fails.
pub(crate) fn run_external(words: &[OsString], command_line: &CommandLine) -> ExitCode {
    let Some((name, arguments)) = words.split_first() else { return ExitCode::from(COULD_NOT_DO) };
    let problem = match find(name) {
        Found::Program(program) => {
            let mut command = Command::new(&program);
            // `SCL` lets the program call the same `scl` that started it.
            command.args(arguments).envs(env::current_exe().ok().map(|scl| ("SCL", scl)));
            cannot_run(&program, &command.exec())
        }
        Found::NotExecutable(file) => Problem::new(format!("`{}` is not executable", file.display()))
            .help(format!("run `chmod +x '{}'`", file.display())),
        Found::Nothing => unknown(&name.to_string_lossy(), command_line),
    };
    print_err(&problem.to_string());
    ExitCode::from(COULD_NOT_DO)
}

/// Commands of SCL that this program does not contain, and how to get them.
const PARTS: &[(&str, &str)] = &[
    #[cfg(not(feature = "bench"))]
    ("bench", "build `scl` with it, in the repository of SCL: `cargo build --release -p scl-cli --features bench`"),
    ("foxglove", "install it: `cargo install scl-foxglove`; in the repository of SCL: `cargo build -p scl-foxglove`"),
    ("gateway", "install it: `cargo install scl-gateway`; in the repository of SCL: `cargo build -p scl-gateway`"),
];

enum Found {
    Program(PathBuf),
    NotExecutable(PathBuf),
    Nothing,
}

fn find(name: &OsStr) -> Found {
    let mut file = OsString::from("scl-");
    file.push(name);
    // Reject names with a slash: they would escape the folders in PATH.
    if Path::new(&file).components().count() != 1 {
        return Found::Nothing;
    }
    // Search next to this executable first, where programs of the same version are installed.
    let own = env::current_exe().ok().and_then(|scl| Some(scl.parent()?.to_owned()));
    let path = env::var_os("PATH").unwrap_or_default();
    let folders = env::split_paths(&path).filter(|folder| !folder.as_os_str().is_empty());
    let files: Vec<PathBuf> =
        own.into_iter().chain(folders).map(|folder| folder.join(&file)).filter(|file| file.is_file()).collect();
    match files.iter().find(|file| is_executable(file)) {
        Some(program) => Found::Program(program.clone()),
        None => files.into_iter().next().map_or(Found::Nothing, Found::NotExecutable),
    }
}

fn is_executable(file: &Path) -> bool {
    fs::metadata(file).is_ok_and(|found| found.permissions().mode() & 0o111 != 0)
}

fn cannot_run(program: &Path, error: &std::io::Error) -> Problem {
    Problem::new(format!("cannot run `{}`: {error}", program.display()))
        .help("check that it is a program for this machine, or a script whose first line names an interpreter")
}

fn unknown(name: &str, command_line: &CommandLine) -> Problem {
    let part = PARTS.iter().find(|(part, _)| *part == name);
    let visible = command_line.get_subcommands().filter(|command| !command.is_hide_set());
    let names = visible.map(CommandLine::get_name).chain(PARTS.iter().map(|(part, _)| *part));
    let problem = Problem::new(format!("there is no command `{}`", escape(name)));
    let problem = match (part, closest_name(name, names)) {
        (Some((_, help)), _) => problem.help(*help),
        (None, Some(close)) => problem.help(format!("did you mean `scl {close}`?")),
        (None, None) => problem.help("`scl --help` lists the commands"),
    };
    problem.note(format!("there is no program `scl-{}` beside `scl` or in PATH either", escape(name)))
}
