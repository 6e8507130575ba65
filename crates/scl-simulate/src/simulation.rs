//! Simulations in tests.

use crate::error::SimulationError;
use crate::simulated::Simulated;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// A simulation of a system: what `scl simulate` does, with what it is told.
///
/// Relative paths are relative to the working folder, which `cargo test` makes the folder of the package. `scl` must be
/// in `PATH`, or given with [`command`](Self::command). A simulation takes as long as the work of its programs, and is
/// the same each time; it can run beside others.
///
/// ```no_run
/// use scl_simulate::Simulation;
/// use std::time::Duration;
/// # #[derive(Clone, PartialEq, prost::Message)]
/// # struct World { #[prost(bool, tag = "6")] on_ground: bool }
///
/// let flight = Simulation::of("examples/arcade").scenario("examples/arcade/rough_day.yaml").seed(7).run()?;
/// let (time, world) = flight.last::<World>("simulator.world")?;
/// assert!(world.on_ground && time > Duration::from_secs(75), "{time:?} {world:?}");
/// # Ok::<(), scl_simulate::SimulationError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
#[must_use = "it runs with `run`"]
pub struct Simulation {
    command: PathBuf,
    arguments: Vec<OsString>,
}

impl Simulation {
    /// A simulation of the system in this folder, or of this launch file.
    pub fn of(folder: impl AsRef<Path>) -> Self {
        Self { command: "scl".into(), arguments: vec!["simulate".into(), folder.as_ref().into()] }
    }

    /// Ends it after this time of the simulation, to the microsecond; otherwise, it ends when the programs have, or
    /// when the scenario says.
    pub fn until(self, time: Duration) -> Self {
        self.option("--until", format!("{}us", time.as_micros()))
    }

    /// Takes all random numbers from this seed. Default: 0.
    pub fn seed(self, seed: u64) -> Self {
        self.option("--seed", seed.to_string())
    }

    /// Lets happen what a scenario says. If something that it expects does not happen, [`run`](Self::run) fails.
    pub fn scenario(self, file: impl AsRef<Path>) -> Self {
        self.option("--scenario", file.as_ref())
    }

    /// Uses the programs of this profile of the launch file; of several, the last one wins.
    pub fn profile(self, name: &str) -> Self {
        self.option("--profile", name)
    }

    /// Gives a parameter a value: `.set("controller.gain", 2.5)`.
    pub fn set(self, parameter: &str, value: impl std::fmt::Display) -> Self {
        self.option("--set", format!("{parameter}={value}"))
    }

    /// Adds an argument of `scl simulate`, for what has no method here.
    pub fn argument(mut self, argument: impl Into<OsString>) -> Self {
        self.arguments.push(argument.into());
        self
    }

    /// Uses this `scl`, instead of the one in `PATH`.
    pub fn command(self, scl: impl Into<PathBuf>) -> Self {
        Self { command: scl.into(), ..self }
    }

    /// Simulates, up to the end, and returns what was recorded.
    ///
    /// # Errors
    ///
    /// [`SimulationError::NoCommand`] if `scl` cannot be started, and [`SimulationError::Failed`], with all that was
    /// printed, if its exit code is not 0: a component has failed, or something expected did not happen.
    pub fn run(&self) -> Result<Simulated, SimulationError> {
        let folder = tempfile::tempdir().map_err(SimulationError::NoFolder)?;
        let recording = folder.path().join("simulation.mcap");
        let mut command = Command::new(&self.command);
        command.args(&self.arguments).arg("--output").arg(&recording);
        let output =
            command.output().map_err(|error| SimulationError::NoCommand { command: self.command.clone(), error })?;
        let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
        if !output.status.success() {
            return Err(SimulationError::Failed { status: output.status, output: out + &err });
        }
        Simulated::read(folder, recording, out, err)
    }

    fn option(self, name: &str, value: impl Into<OsString>) -> Self {
        self.argument(name).argument(value)
    }
}
