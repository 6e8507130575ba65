//! Why a test has no simulation to look at.

use scl::codec::DecodeError;
use scl_terminal::Problem;
use scl_text::list::listed;
use std::io;
use std::path::PathBuf;
use std::process::ExitStatus;
use std::time::Duration;

/// Why a simulation could not be run, has failed, or has no such messages.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// `scl` could not be started.
    #[error("cannot start `{}`: {error}; install it, or name it with `Simulation::command`", command.display())]
    NoCommand {
        /// How it was called.
        command: PathBuf,
        /// What the operating system says.
        error: io::Error,
    },
    /// There is no folder for the recording.
    #[error("cannot create a folder for the recording: {0}")]
    NoFolder(io::Error),
    /// A component has failed, or something expected did not happen.
    #[error("the simulation has failed with {status}:\n{output}")]
    Failed {
        /// How `scl simulate` has ended.
        status: ExitStatus,
        /// All that was printed.
        output: String,
    },
    /// The recording cannot be read.
    #[error("{0}")]
    Recording(String),
    /// A gate has no message in the recording.
    #[error("gate `{gate}` has no message; those that have some: {}", listed(others))]
    NoMessage {
        /// The gate.
        gate: String,
        /// The gates that have messages, in the order of their names.
        others: Vec<String>,
    },
    /// The messages of a gate have another codec than the test reads.
    #[error("the messages of `{gate}` have the codec `{recorded}`, not `{codec}`")]
    OtherCodec {
        /// The gate.
        gate: String,
        /// The codec that the test reads.
        codec: &'static str,
        /// The codec in the recording.
        recorded: String,
    },
    /// A message is not of the type that the test reads.
    #[error("the message of `{gate}` at {:.6} s cannot be read: {error}", at.as_secs_f64())]
    Undecodable {
        /// The gate.
        gate: String,
        /// When it was sent, since the start.
        at: Duration,
        /// Why.
        error: DecodeError,
    },
}

impl SimulationError {
    pub(crate) fn recording(problem: Problem) -> Self {
        Self::Recording(problem.to_string())
    }
}
