//! `scl new`: creates a project.

use clap::{Args, ValueEnum};
use scl_new::{Project, create};
use scl_terminal::{print_err, print_out};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Exit code: nothing was created.
const COULD_NOT_RUN: u8 = 2;

/// Create a project: a folder with programs that talk, tests, and a README that explains the next steps.
///
/// Asks nothing and needs no network.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl new rover                      a sensor, a controller and a display
  scl new rover --template minimal   two programs, one connection
  scl new rover --path ../scl        with the SCL in this folder

Exit code: 0 created, 2 nothing was created.")]
pub(crate) struct NewArguments {
    /// Name of the project: its folder, system and cargo package.
    #[arg(value_name = "NAME")]
    name: String,
    /// Which files to begin with.
    #[arg(long, value_enum, default_value_t = Template::Control)]
    template: Template,
    /// The folder of SCL's repository [default: where this `scl` was built, else the package registry].
    #[arg(long, value_name = "FOLDER")]
    path: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Template {
    /// Two programs and one connection, without async
    Minimal,
    /// A sensor, a controller and a display, with commands, a launch file and tests
    Control,
}

impl From<Template> for scl_new::Template {
    fn from(template: Template) -> Self {
        match template {
            Template::Minimal => Self::Minimal,
            Template::Control => Self::Control,
        }
    }
}

/// The body of `scl new`.
pub(crate) fn new(arguments: &NewArguments) -> ExitCode {
    let name = &arguments.name;
    let project = Project { name: name.clone(), template: arguments.template.into(), scl: arguments.path.clone() };
    match create(Path::new("."), &project) {
        Ok(created) => {
            print_err(&format!(
                "created `{name}` with {} files; it uses SCL from {}\n",
                created.files.len(),
                created.scl
            ));
            if created.from_registry {
                print_err("note: if the registry does not have it, use `--path` with a clone of SCL's repository\n");
            }
            print_out(&format!("cd {name} && scl run\n"));
            ExitCode::SUCCESS
        }
        Err(problem) => {
            print_err(&problem.to_string());
            ExitCode::from(COULD_NOT_RUN)
        }
    }
}
