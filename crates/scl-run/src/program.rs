//! The programs of a run, and the commands that build them.

use super::command_line::shell_text;
use super::placement::Placement;
use super::terminal::StandardInput;
use scl_plan::SET_VARIABLE;
use scl_terminal::{Problem, quoted_list};
use std::ffi::{OsStr, OsString};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

/// The longest variable that Linux passes to a program, `NAME=value` with its end, in bytes.
const LONGEST_VARIABLE: usize = 128 << 10;

/// A program to start.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Program {
    /// The program and its arguments.
    pub(crate) command: Vec<OsString>,
    /// Variables added to our own environment.
    pub(crate) environment: Vec<(String, String)>,
    /// Its working folder.
    pub(crate) folder: PathBuf,
    /// Its processors, priority and limit of descriptors.
    pub(crate) placement: Placement,
    /// Where its standard input comes from.
    pub(crate) input: StandardInput,
}

/// A build command, and the components whose programs it makes; all of them if none is named.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Build {
    pub(crate) components: Vec<String>,
    pub(crate) program: Program,
    /// For a cargo build that makes programs of components: for each component, the options that choose its program,
    /// such as `--bin sensor`.
    pub(crate) cargo_choices: Option<Vec<Vec<String>>>,
}

impl Build {
    /// The name shown before its output.
    pub(crate) fn label(&self) -> &str {
        self.components.first().map_or("build", String::as_str)
    }

    /// The components whose programs it makes, for messages.
    pub(crate) fn owner(&self) -> String {
        match self.components.as_slice() {
            [] => "all components".to_owned(),
            [one] => format!("component `{one}`"),
            several => format!("the components {}", quoted_list(several)),
        }
    }

    /// The command as it stands in the launch file.
    pub(crate) fn shown_command(&self) -> String {
        let words = self.command();
        let words_text = || words.iter().map(|word| word.display().to_string()).collect::<Vec<_>>().join(" ");
        shell_text(&words).map_or_else(words_text, |text| text.display().to_string())
    }

    /// The command for all its components.
    pub(crate) fn command(&self) -> Vec<OsString> {
        let choices = self.cargo_choices.iter().flatten().flatten().map(OsString::from);
        self.program.command.iter().cloned().chain(choices).collect()
    }

    /// Returns the build for these components alone, or `None` if it makes none of their programs.
    pub(crate) fn only_for(&self, components: &[String]) -> Option<Build> {
        if self.components.is_empty() {
            return Some(self.clone());
        }
        let is_chosen = |index: &usize| components.contains(&self.components[*index]);
        let chosen: Vec<usize> = (0..self.components.len()).filter(is_chosen).collect();
        let choices = |all: &Vec<Vec<String>>| chosen.iter().filter_map(|index| all.get(*index).cloned()).collect();
        (!chosen.is_empty()).then(|| Build {
            components: chosen.iter().map(|index| self.components[*index].clone()).collect(),
            program: self.program.clone(),
            cargo_choices: self.cargo_choices.as_ref().map(choices),
        })
    }

    /// Checks that the folder and the executable exist.
    pub(crate) fn check(&self) -> Result<(), Problem> {
        self.program.check("build command", &self.owner())
    }

    /// As [`check`](Self::check), but only what no other build can change.
    pub(crate) fn check_installed(&self) -> Result<(), Problem> {
        self.program.check_installed("build command", &self.owner())
    }
}

impl Program {
    /// Creates a program without variables, with the default placement and an empty standard input.
    pub(crate) fn new(command: Vec<OsString>, folder: PathBuf) -> Self {
        let (environment, placement, input) = (Vec::new(), Placement::default(), StandardInput::Empty);
        Self { command, environment, folder, placement, input }
    }

    /// Checks that it can be started; `what` and `owner` name it in the problem.
    pub(crate) fn check(&self, what: &str, owner: &str) -> Result<(), Problem> {
        let folder = &self.folder;
        if !folder.is_dir() {
            return Err(Problem::new(format!("the folder of {owner} does not exist: `{}`", folder.display())));
        }
        self.check_installed(what, owner)?;
        let Some(path) = self.command.first().filter(|name| is_path(name)).and_then(|_| self.file()) else {
            return Ok(());
        };
        match () {
            () if is_executable(&path) => Ok(()),
            () if path.is_file() => {
                let message = format!("the {what} of {owner} is not executable: `{}`", path.display());
                Err(Problem::new(message).help(format!("make it so: `chmod +x {}`", path.display())))
            }
            () => Err(Problem::new(format!("the {what} of {owner} does not exist: `{}`", path.display()))),
        }
    }

    /// The file of the program, if it is given as a path or is installed.
    pub(crate) fn file(&self) -> Option<PathBuf> {
        let name = self.command.first()?;
        // Drops the `./` that a path in a launch file usually starts with.
        if is_path(name) { Some(self.folder.join(name).components().collect()) } else { self.find_installed(name) }
    }

    /// The absolute path of a program in the search path.
    pub(crate) fn find_installed(&self, name: &OsStr) -> Option<PathBuf> {
        let own = self.environment.iter().rev().find(|(key, _)| key == "PATH").map(|(_, value)| value.into());
        let path: OsString = own.or_else(|| std::env::var_os("PATH")).unwrap_or_default();
        let mut files = std::env::split_paths(&path).map(|folder| self.folder.join(folder).join(name));
        files.find(|file| is_executable(file))
    }

    /// As [`check`](Self::check), but only what no build can change: its variables, and whether a program without a
    /// path is installed.
    pub(crate) fn check_installed(&self, what: &str, owner: &str) -> Result<(), Problem> {
        self.check_variables(owner)?;
        let Some(name) = self.command.first().filter(|name| !is_path(name)) else { return Ok(()) };
        if self.find_installed(name).is_some() {
            return Ok(());
        }
        let name = name.display();
        Err(Problem::new(format!("the {what} `{name}` of {owner} is not in the search path"))
            .help(format!("install it, or write its path: `./{name}` is looked up in the component's folder")))
    }

    /// A variable that is too long would end in an error of the operating system that names none.
    fn check_variables(&self, owner: &str) -> Result<(), Problem> {
        let length = |(name, value): &(String, String)| name.len() + "=".len() + value.len() + "\0".len();
        let Some(variable) = self.environment.iter().find(|variable| length(variable) > LONGEST_VARIABLE) else {
            return Ok(());
        };
        let (name, length) = (&variable.0, length(variable));
        let problem = Problem::new(format!("the variable `{name}` of {owner} has {length} bytes"))
            .note(format!("the operating system passes at most {LONGEST_VARIABLE} to a program"));
        Err(match name == SET_VARIABLE {
            true => problem.help("it has the values of the parameters: put long ones into a file, and give its path"),
            false => problem.help("put the value into a file, and give its path"),
        })
    }
}

fn is_path(name: &OsStr) -> bool {
    name.as_encoded_bytes().contains(&b'/')
}

pub(crate) fn is_executable(path: &Path) -> bool {
    path.metadata().is_ok_and(|it| it.is_file() && it.permissions().mode() & 0o111 != 0)
}
