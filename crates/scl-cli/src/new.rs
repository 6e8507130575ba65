//! `scl new`: creates a project.

use clap::{Args, ValueEnum};
use scl_new::{Project, Source, create};
use scl_terminal::{Problem, print_err, print_out};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Create a project: a folder with programs that talk, tests, and a README that explains the next steps.
///
/// Asks nothing and needs no network.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl new rover                      a sensor, a controller and a display
  scl new rover --template minimal   two programs, one connection
  scl new rover --template drive     four wheels that run one program, a log for everyone
  scl new rover --git https://host/scl.git
                                     with the SCL in this repository, for others to build
  scl new rover --path ../scl        with the SCL in this folder

Exit code: 0 created, 2 nothing was created.")]
pub(crate) struct NewArguments {
    /// Name of the project: its folder, system and cargo package.
    #[arg(value_name = "NAME")]
    name: String,
    /// Which files to begin with.
    #[arg(long, value_enum, default_value_t = Template::Control)]
    template: Template,
    /// A git repository with SCL [default: that of the checkout that this `scl` was built from, if others can reach
    /// it].
    #[arg(long, value_name = "URL", conflicts_with = "path")]
    git: Option<String>,
    /// The commit or tag of `--git` [default: the commit that this `scl` was built from].
    #[arg(long, value_name = "REVISION", requires = "git")]
    rev: Option<String>,
    /// The folder of SCL's repository on this machine [default, if there is no repository: where this `scl` was built,
    /// else the package registry].
    #[arg(long, value_name = "FOLDER")]
    path: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Template {
    /// Two programs and one connection, without async
    Minimal,
    /// A sensor, a controller and a display, with commands, a launch file and tests
    Control,
    /// Four wheels of one kind, a chassis and a logger: what larger systems are made of
    Drive,
}

/// The body of `scl new`.
pub(crate) fn new(arguments: &NewArguments) -> Result<ExitCode, Problem> {
    let name = &arguments.name;
    let scl = match (&arguments.git, &arguments.path) {
        (Some(url), _) => Source::Git { url: url.clone(), revision: arguments.rev.clone() },
        (None, Some(path)) => Source::Folder(path.clone()),
        (None, None) => Source::OfThisProgram,
    };
    let template = match arguments.template {
        Template::Minimal => scl_new::Template::Minimal,
        Template::Control => scl_new::Template::Control,
        Template::Drive => scl_new::Template::Drive,
    };
    let project = Project { name: name.clone(), template, scl };
    let created = create(Path::new("."), &project)?;
    let count = created.files.len();
    print_err(&format!("created `{name}` with {count} files; it uses SCL from {}\n", created.scl));
    if let Some(note) = created.note {
        print_err(&format!("note: {note}\n"));
    }
    print_out(&format!("cd {name} && scl run\n"));
    Ok(ExitCode::SUCCESS)
}
