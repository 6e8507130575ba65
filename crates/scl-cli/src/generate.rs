//! `scl generate`: code and configuration for other languages.

use crate::exit::COULD_NOT_DO;
use crate::load::{MaxSize, load_file, show_diagnostics, show_problems};
use clap::{Args, ValueEnum};
use scl_generate::{File, Format, Outcome, OutputError, System, Target, is_current, write};
use scl_terminal::{Problem, print_err, print_out};
use scl_topology::diagnostic::Severity;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Generate code for C, C++ and Python from a topology, or list its sockets for programs with a ZeroMQ library.
///
/// A file is written only if its content changes, and replaced as a whole: a build system rebuilds nothing without
/// need, and any number of programs may generate into one folder at once.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl generate --for c                              rover_scl.h and rover_scl.c of ./topology.yaml
  scl generate --for python rover.yaml -o src       src/rover_scl.py
  scl generate --for cpp --testable -o gen          also rover::Sensor::test(), for unit tests
  scl generate --for zmq | jq '.components'         endpoints, socket types, message types
  scl generate --for cpp -o gen --check             fails if gen/rover.scl.hpp is not up to date

Exit code: 0 generated, 1 the topology has errors or (--check) a file is not up to date, 2 a file could not be read or
written.")]
pub(crate) struct GenerateArguments {
    /// What to generate.
    #[arg(long = "for", value_name = "WHAT")]
    target: Language,
    /// The topology file; `-` is standard input.
    #[arg(default_value = "topology.yaml")]
    file: PathBuf,
    /// The folder for the files, created if need be [default: the current folder; for `zmq`, standard output].
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// How `zmq` is written [default: json].
    #[arg(long, value_name = "FORMAT")]
    format: Option<TextFormat>,
    /// Generate only this component, or this kind with all of its components; may be repeated.
    #[arg(long = "component", value_name = "NAME")]
    components: Vec<String>,
    /// For unit tests, also generate `test()` of each component, which opens it together with the other ends of its
    /// gates.
    #[arg(long)]
    testable: bool,
    /// Write nothing; fail if a file is not up to date.
    #[arg(long)]
    check: bool,
    /// Also write what the first generated file depends on, the topology and its schemas, as Make and Ninja read it.
    #[arg(long, value_name = "FILE", conflicts_with = "check")]
    depfile: Option<PathBuf>,
    #[command(flatten)]
    max_size: MaxSize,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub(crate) enum Language {
    /// The sockets of the system, for programs with only a ZeroMQ library.
    Zmq,
    /// A header and a source.
    C,
    /// A header.
    Cpp,
    /// A typed module.
    Python,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum TextFormat {
    Json,
    Yaml,
}

/// The body of `scl generate`.
pub(crate) fn generate(arguments: &GenerateArguments) -> Result<ExitCode, Problem> {
    if let Some(text) = arguments.contradiction() {
        return Err(Problem::new(text));
    }
    let loaded = load_file(&arguments.file, arguments.max_size);
    show_problems(&loaded, Severity::Warning);
    let Some(mut system) = System::of(&loaded) else {
        return Ok(ExitCode::from(if loaded.file.is_some() { 1 } else { COULD_NOT_DO }));
    };
    if !arguments.components.is_empty()
        && let Err(unknown) = system.select(&arguments.components)
    {
        unknown.iter().for_each(|error| print_err(&format!("error: {error}\n")));
        return Ok(ExitCode::FAILURE);
    }
    if arguments.testable {
        system.make_testable();
    }
    let files = match scl_generate::generate(&system, arguments.target()) {
        Ok(files) => files,
        Err(clashes) => {
            show_diagnostics(&loaded, &clashes);
            return Ok(ExitCode::FAILURE);
        }
    };
    let folder = arguments.output.as_deref().unwrap_or(Path::new(""));
    if arguments.check {
        return Ok(check_files(folder, &files));
    }
    if arguments.is_printed() {
        files.iter().for_each(|file| print_out(&file.text));
        return Ok(ExitCode::SUCCESS);
    }
    let failed = |error: OutputError| {
        let cause = error.source().map(|cause| format!(": {cause}")).unwrap_or_default();
        Problem::new(format!("{error}{cause}"))
    };
    write_files(folder, &files).map_err(failed)?;
    if let Some(path) = &arguments.depfile {
        write_depfile(path, &depfile(&loaded.files_read, folder, &files)).map_err(failed)?;
    }
    Ok(ExitCode::SUCCESS)
}

impl GenerateArguments {
    fn is_printed(&self) -> bool {
        self.output.is_none() && self.target == Language::Zmq && !self.check
    }

    /// Returns an error message if the arguments do not go together.
    fn contradiction(&self) -> Option<&'static str> {
        match self {
            Self { target, format: Some(_), .. } if *target != Language::Zmq => {
                Some("`--format` is for `--for zmq` only")
            }
            Self { target: Language::Zmq, testable: true, .. } => {
                Some("`--testable` does not go with `--for zmq`, which generates no code")
            }
            Self { depfile: Some(_), .. } if self.is_printed() => Some("`--depfile` needs a folder: add `-o DIR`"),
            _ => None,
        }
    }

    fn target(&self) -> Target {
        match (self.target, self.format) {
            (Language::Zmq, Some(TextFormat::Yaml)) => Target::Zmq(Format::Yaml),
            (language, _) => language.target(),
        }
    }
}

impl Language {
    pub(crate) fn target(self) -> Target {
        match self {
            Language::Zmq => Target::Zmq(Format::Json),
            Language::C => Target::C,
            Language::Cpp => Target::Cpp,
            Language::Python => Target::Python,
        }
    }
}

fn check_files(folder: &Path, files: &[File]) -> ExitCode {
    let old: Vec<_> = files.iter().filter(|file| !is_current(folder, file)).collect();
    for file in &old {
        print_err(&format!("error: `{}` is not up to date\n", folder.join(&file.name).display()));
    }
    if old.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn write_files(folder: &Path, files: &[File]) -> Result<(), OutputError> {
    for file in files {
        let path = folder.join(&file.name);
        match write(folder, file)? {
            Outcome::Written => print_out(&format!("wrote {}\n", path.display())),
            Outcome::Unchanged => print_out(&format!("{} is up to date\n", path.display())),
        }
    }
    Ok(())
}

/// A rule for Make: the first generated file depends on what was read.
fn depfile(read: &[PathBuf], folder: &Path, files: &[File]) -> String {
    let escaped = |path: &Path| path.display().to_string().replace(' ', "\\ ").replace('#', "\\#").replace('$', "$$");
    let target = files.first().map(|file| escaped(&folder.join(&file.name))).unwrap_or_default();
    let read: String = read.iter().map(|path| format!(" {}", escaped(path))).collect();
    format!("{target}:{read}\n")
}

fn write_depfile(path: &Path, text: &str) -> Result<(), OutputError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    write(folder, &File { name, text: text.to_owned() }).map(drop)
}
