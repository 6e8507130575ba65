//! `scl check`: reports what the macro would report about topology files, and what `scl run` would report about launch
//! files.

mod checked;
mod deny;
mod fix;
mod refusals;
mod report;
mod source;
mod watch;

use crate::exit::COULD_NOT_DO;
#[cfg(feature = "generate")]
use crate::generate::Language;
use crate::load::{MaxSize, STDIN};
use checked::{Checked, check_file};
use clap::{Args, ValueEnum};
use deny::{Deny, parse_deny};
use scl_terminal::print_err;
use std::path::PathBuf;
use std::process::ExitCode;

/// Check topology files, with the same messages as the macro, and launch files.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl check                         topology.yaml in the working folder
  scl check a.yaml b.yaml --lints   two files, with the lints that are off by default
  scl check launch.yaml             a launch file, with the names of its topology
  scl check --deny warnings         for continuous integration: exit code 1 if there are warnings
  scl check --for cpp --for python  also names that C++ or Python cannot tell apart
  scl check --deny SCL0402          untyped connections are errors here
  scl check --fix --dry-run         what would be fixed, as a diff
  scl check --fix                   apply the certain fixes, and report what is left
  scl check --watch                 again whenever the file, or a schema that it names, changes
  scl check --format json           for programs: one object per line
  scl check --format sarif > s.json for code hosts
  generate | scl check -            standard input

A file is a launch file if its name starts or ends with `launch`, as in `sim.launch.yaml`.
Of a file with more than 1000 problems the first ones are shown, errors before warnings.
Text goes to standard error, everything else to standard output.
Exit code: 0 clean or only warnings, 1 errors, 2 a file could not be read.")]
pub(crate) struct CheckArguments {
    /// The topology and launch files; `-` is a topology from standard input.
    #[arg(value_name = "FILE", default_value = "topology.yaml")]
    files: Vec<PathBuf>,
    /// The output format.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Show the lints that are off by default, too.
    #[arg(long)]
    lints: bool,
    /// Treat all warnings (`warnings`), or those with this code, as errors; may be repeated.
    #[arg(long, value_name = "warnings|CODE", value_parser = parse_deny)]
    deny: Vec<Deny>,
    /// Check again whenever a file changes, until Ctrl-C; then the exit code is that of the last check.
    #[arg(long)]
    watch: bool,
    /// Apply every certain fix, then check what is left. With `-`, print the fixed text.
    #[arg(long, conflicts_with = "watch")]
    fix: bool,
    /// Print the fixes as a unified diff, change no file, and check it as it is.
    #[arg(long, requires = "fix")]
    dry_run: bool,
    /// Also report names that `scl generate` would refuse for this language; may be repeated.
    #[cfg(feature = "generate")]
    #[arg(long = "for", value_name = "LANGUAGE")]
    languages: Vec<Language>,
    #[command(flatten)]
    max_size: MaxSize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Like the compiler, with excerpts of the file.
    Text,
    /// One JSON object per line.
    Json,
    /// SARIF 2.1.0, one log for all files.
    Sarif,
    /// As `cargo check --message-format=json`, for rust-analyzer's `check.overrideCommand`.
    Cargo,
}

/// The body of `scl check`. The exit code is the worst of those of all files.
pub(crate) fn check(arguments: &CheckArguments) -> ExitCode {
    let from_stdin = arguments.files.iter().filter(|file| file.as_os_str() == STDIN).count();
    let prints_text = arguments.fix && (arguments.dry_run || from_stdin > 0);
    let refusal = match from_stdin {
        _ if prints_text && arguments.format != Format::Text => {
            Some(("the fixed text and the problems cannot both go to standard output", "leave `--format` out"))
        }
        0 => None,
        1 if arguments.watch => Some(("standard input cannot be watched", "name a file instead of `-`")),
        1 => None,
        _ => Some(("standard input can be read only once", "name a file instead of `-`")),
    };
    if let Some((refusal, help)) = refusal {
        print_err(&format!("error: {refusal}\n  = help: {help}\n"));
        return ExitCode::from(COULD_NOT_DO);
    }
    if arguments.watch {
        return watch::watch(arguments);
    }
    let checked = check_files(arguments);
    report::report(&checked, arguments.format);
    ExitCode::from(worst_code(&checked))
}

fn check_files(arguments: &CheckArguments) -> Vec<Checked> {
    arguments.files.iter().map(|file| check_file(file, arguments)).collect()
}

fn worst_code(checked: &[Checked]) -> u8 {
    checked.iter().map(Checked::code).max().unwrap_or_default()
}
