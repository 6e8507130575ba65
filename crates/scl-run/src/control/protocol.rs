//! Requests and responses of the control socket, one line of JSON each.

use super::super::plan::COMPONENT;
use super::super::program::Build;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The version of the protocol. A `scl run` answers requests of its own version only.
pub const VERSION: u32 = 1;

/// What a client asks for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    /// [`VERSION`].
    pub version: u32,
    /// What to do.
    pub command: Command,
    /// The components; all if empty.
    #[serde(default)]
    pub components: Vec<String>,
}

/// What a `scl run` can do for a client.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Command {
    /// Report the states of the components.
    List,
    /// Report the builds that make the programs of components.
    Builds,
    /// Stop components. The response comes when they have ended. Without names the run ends too.
    Stop,
    /// Stop components and start them again. The response comes when they run, or are ready if they have
    /// `ready_within`.
    Restart,
}

/// What a `scl run` answers.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Response {
    /// [`VERSION`].
    pub version: u32,
    /// Why nothing was done.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// The components that were asked for.
    #[serde(default)]
    pub components: Vec<ComponentReport>,
    /// The topology file that the system is named after; `None` if the system has a name of its own. A system that is
    /// named after another file may have the same name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub named_after: Option<PathBuf>,
    /// The builds of the components, in the order in which to run them; only for [`Command::Builds`].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub builds: Vec<BuildCommand>,
}

/// A build as `scl run` runs it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct BuildCommand {
    /// The components whose programs it makes, for messages.
    pub owner: String,
    /// The command as one text, for messages.
    pub shown: String,
    /// The command and its arguments.
    pub command: Vec<String>,
    /// Its working folder.
    pub folder: PathBuf,
    /// All its variables: those of `scl run` and of the launch file.
    pub environment: BTreeMap<String, String>,
}

/// The state of a component after the request.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ComponentReport {
    /// The component.
    pub component: String,
    /// `starting`, `running`, `ready`, `waiting` (for its restart), `stopping`, `stopped` (on request), `ended`
    /// (successfully) or `failed`.
    pub state: String,
    /// Whether the request was fulfilled.
    pub done: bool,
    /// The id of its process, while it has one.
    pub pid: Option<i32>,
    /// Number of restarts because of its policy.
    pub restarts: usize,
    /// How its last process ended, or why it failed.
    pub detail: Option<String>,
}

impl BuildCommand {
    /// Describes a build, with the environment of this process.
    pub(crate) fn of(build: &Build) -> Self {
        // JSON cannot represent variables that are not UTF-8. Builds do not inherit the component that this process
        // runs as.
        let own = std::env::vars_os()
            .filter(|(name, _)| name != COMPONENT)
            .filter_map(|(name, value)| Some((name.into_string().ok()?, value.into_string().ok()?)));
        Self {
            owner: build.owner(),
            shown: build.shown_command(),
            command: build.command().iter().map(|word| word.to_string_lossy().into_owned()).collect(),
            folder: build.program.folder.clone(),
            environment: own.chain(build.program.environment.iter().cloned()).collect(),
        }
    }
}

impl Request {
    /// Creates a request of this version; it is about all components if `components` is empty.
    pub fn new(command: Command, components: Vec<String>) -> Self {
        Self { version: VERSION, command, components }
    }

    /// Parses a line.
    ///
    /// # Errors
    ///
    /// If the line is not a request of this version, with a text for the client.
    pub fn parse(line: &str) -> Result<Self, String> {
        let request: Self = serde_json::from_str(line).map_err(|error| format!("not a request: {error}"))?;
        match request.version {
            VERSION => Ok(request),
            version => Err(format!("version {version} of the protocol, not {VERSION}")),
        }
    }
}

impl Response {
    /// A response about components.
    pub fn of(components: Vec<ComponentReport>) -> Self {
        Self { version: VERSION, error: None, components, named_after: None, builds: Vec::new() }
    }

    /// A response to a request that was not fulfilled.
    pub fn error(text: impl Into<String>) -> Self {
        Self { error: Some(text.into()), ..Self::of(Vec::new()) }
    }
}
