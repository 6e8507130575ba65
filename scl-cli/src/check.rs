//! `scl check`: says about topology files what the macro would say.

use crate::print::{print_err, print_out};
use anstream::{AutoStream, ColorChoice};
use clap::{Args, ValueEnum};
use scl_loader::{Loaded, Request, load};
use scl_topology::diagnostic::{Diagnostic, Severity, render, render_styled, to_json};
use scl_topology::topology::Topology;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Exit code: a file could not be read at all.
const COULD_NOT_RUN: u8 = 2;

/// Checks topology files, with the words of the macro.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl check                        topology.yaml in the working folder
  scl check a.yaml b.yaml --lints  two files, and what is off by default
  scl check --format json          for programs: one object a line

Text goes to standard error, JSON to standard output.
Exit code: 0 clean or only warnings, 1 errors, 2 a file could not be read.")]
pub(crate) struct CheckArguments {
    /// The topology files.
    #[arg(value_name = "FILE", default_value = "topology.yaml")]
    files: Vec<PathBuf>,
    /// How to say it.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Show the lints that are off by default, too.
    #[arg(long)]
    lints: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Like the compiler, with excerpts of the file.
    Text,
    /// One JSON object a line.
    Json,
}

/// The body of `scl check`: the worst of all files is the exit code.
pub(crate) fn check(arguments: &CheckArguments) -> ExitCode {
    let codes = arguments.files.iter().map(|file| check_file(file, arguments));
    ExitCode::from(codes.max().unwrap_or_default())
}

fn check_file(path: &Path, arguments: &CheckArguments) -> u8 {
    let loaded = load_file(path);
    let is_shown = |it: &&Diagnostic| arguments.lints || it.severity != Severity::Lint;
    let shown: Vec<&Diagnostic> = loaded.diagnostics.iter().filter(is_shown).collect();
    match arguments.format {
        Format::Text => {
            show_diagnostics(&loaded, &shown);
            print_err(&closing_line(path, loaded.topology.as_ref(), &shown));
        }
        Format::Json => shown.iter().for_each(|it| print_out(&format!("{}\n", to_json(it, &loaded.sources)))),
    }
    match &loaded {
        Loaded { file: None, .. } => COULD_NOT_RUN,
        Loaded { topology: None, .. } => 1,
        _ => 0,
    }
}

/// Reads and checks a file, which messages call as the user did.
pub(crate) fn load_file(path: &Path) -> Loaded {
    load(&Request::new(path))
}

/// Shows diagnostics on standard error, each followed by an empty line.
pub(crate) fn show_diagnostics(loaded: &Loaded, shown: &[&Diagnostic]) {
    let plain = matches!(AutoStream::choice(&std::io::stderr()), ColorChoice::Never);
    let render = if plain { render } else { render_styled };
    shown.iter().for_each(|it| print_err(&format!("{}\n\n", render(it, &loaded.sources))));
}

/// Shows the errors alone, for the commands that cannot go on with them.
pub(crate) fn show_errors(loaded: &Loaded) {
    let errors: Vec<&Diagnostic> = loaded.diagnostics.iter().filter(|it| it.severity == Severity::Error).collect();
    show_diagnostics(loaded, &errors);
}

/// `topology.yaml: 4 components, 8 gates, 4 connections` or `topology.yaml: 2 errors, 1 warning`.
fn closing_line(path: &Path, topology: Option<&Topology>, shown: &[&Diagnostic]) -> String {
    let number_of = |severity| shown.iter().filter(|it| it.severity == severity).count();
    let problems = [
        counted(number_of(Severity::Error), "error"),
        counted(number_of(Severity::Warning), "warning"),
        counted(number_of(Severity::Lint), "lint"),
    ];
    let problems = problems.into_iter().filter(|it| !it.starts_with("0 ")).collect::<Vec<_>>().join(", ");
    let words = match topology.map(size_of) {
        Some(size) if problems.is_empty() => size,
        Some(size) => format!("{size}; {problems}"),
        None => problems,
    };
    format!("{}: {words}\n", path.display())
}

fn size_of(topology: &Topology) -> String {
    let gates = topology.components().map(|(_, component)| component.gates().len()).sum();
    let components = counted(topology.components().len(), "component");
    format!("{components}, {}, {}", counted(gates, "gate"), counted(topology.connections().len(), "connection"))
}

fn counted(number: usize, noun: &str) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} {noun}{ending}")
}
