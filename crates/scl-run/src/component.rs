//! The components of a run, and the programs that run them.

use super::cargo::Target;
use super::kept_values::KeptValues;
use super::linkage::is_static;
use super::policy::Policy;
use super::program::Program;
use scl_terminal::Problem;
use std::path::PathBuf;

/// A component and the program that runs it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Component {
    pub(crate) name: String,
    /// Its kind, where the topology says one.
    pub(crate) kind: Option<String>,
    pub(crate) program: Program,
    pub(crate) policy: Policy,
    /// The recording that its program plays, relative to the program's folder.
    pub(crate) recording: Option<PathBuf>,
    /// The cargo build that makes its program, if any. Until the build is done, the command names cargo in place of the
    /// program.
    pub(crate) made_by_cargo: Option<MadeByCargo>,
    /// The place of its entry in the launch file.
    pub(crate) entry: Option<String>,
    /// What is kept when its program is started again.
    pub(crate) kept: KeptValues,
}

/// A program that a build of cargo makes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct MadeByCargo {
    /// The index of the build in the plan.
    pub(crate) build: usize,
    pub(crate) target: Target,
}

impl Component {
    /// Checks that the folder, the executable and the recording exist.
    pub(crate) fn check(&self) -> Result<(), Problem> {
        self.program.check("program", &self.shown())?;
        let Some(recording) = self.recording.as_ref().map(|path| self.program.folder.join(path)) else { return Ok(()) };
        if recording.is_file() {
            return Ok(());
        }
        Err(Problem::new(format!("the recording of {} does not exist: `{}`", self.shown(), recording.display())))
    }

    /// As [`check`](Self::check), but only what no build can change: whether a program without a path is installed.
    pub(crate) fn check_installed(&self) -> Result<(), Problem> {
        self.program.check_installed("program", &self.shown())
    }

    /// Checks that it can take part in a simulation, as far as its file shows.
    pub(crate) fn check_linkage(&self) -> Result<(), Problem> {
        if !self.program.file().is_some_and(|file| is_static(&file)) {
            return Ok(());
        }
        let problem =
            Problem::new(format!("{} is linked statically, so it cannot take part in a simulation", self.shown()));
        Err(problem
            .help("link it with the C library of the system: without `-static`, and for a target without `musl`"))
    }

    fn shown(&self) -> String {
        format!("component `{}`", self.name)
    }
}
