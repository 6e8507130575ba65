//! The components of a run, and the programs that run them.

use super::cargo::Target;
use super::policy::Policy;
use super::program::Program;
use scl_terminal::Problem;
use std::path::PathBuf;

/// A component and the program that runs it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Component {
    pub(crate) name: String,
    pub(crate) program: Program,
    pub(crate) policy: Policy,
    /// The file that its program plays, from the program's folder.
    pub(crate) recording: Option<PathBuf>,
    /// What cargo makes the program of it; until then the command begins with cargo.
    pub(crate) made_by_cargo: Option<MadeByCargo>,
    /// Where the launch file has its entry.
    pub(crate) entry: Option<String>,
}

/// A program that a build of cargo makes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct MadeByCargo {
    /// The number of the build.
    pub(crate) build: usize,
    pub(crate) target: Target,
}

impl Component {
    /// Checks that the folder and the executable exist.
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

    fn shown(&self) -> String {
        format!("component `{}`", self.name)
    }
}
