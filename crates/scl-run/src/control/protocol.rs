//! Requests and responses of the control socket, one line of JSON each.

use serde::{Deserialize, Serialize};

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
    /// Say how the components are.
    List,
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
}

/// How a component is, after the request.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ComponentReport {
    /// The component.
    pub component: String,
    /// `starting`, `running`, `ready`, `waiting` (for its restart), `stopping`, `stopped` (on request), `ended` (in
    /// order) or `failed`.
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

impl Request {
    /// Reads a line.
    ///
    /// # Errors
    ///
    /// A text for the client.
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
        Self { version: VERSION, error: None, components }
    }

    /// A response to a request that was not fulfilled.
    pub fn error(text: impl Into<String>) -> Self {
        Self { version: VERSION, error: Some(text.into()), components: Vec::new() }
    }

    /// The line, without its end.
    pub fn to_json(&self) -> String {
        // Strings and numbers can always be written.
        serde_json::to_string(self).unwrap_or_default()
    }
}
