//! What a component takes from its environment when it is opened.

use crate::error::OpenError;
use crate::transport::Transport;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;

/// Choices for opening a component; what is not chosen comes from the environment.
///
/// | choice | environment | else |
/// |---|---|---|
/// | [`runtime_dir`](Self::runtime_dir) | `SCL_RUNTIME_DIR` | `$XDG_RUNTIME_DIR/scl`, or `scl-<uid>` among the temporary files |
/// | [`system`](Self::system) | `SCL_SYSTEM` | the topology's name |
/// | [`tcp`](Self::tcp) | `SCL_TRANSPORT=tcp` or `ipc` | `ipc` |
/// | [`transport`](Self::transport) | | ZeroMQ, in the runtime folder |
#[derive(Clone, Default)]
pub struct OpenOptions {
    runtime_dir: Option<PathBuf>,
    system: Option<String>,
    tcp: Option<bool>,
    transport: Option<Arc<dyn Transport>>,
}

impl OpenOptions {
    /// The environment's choices.
    pub fn new() -> Self {
        Self::default()
    }

    /// The folder in which gates meet. Components find each other only in the same folder.
    pub fn runtime_dir(mut self, folder: impl Into<PathBuf>) -> Self {
        self.runtime_dir = Some(folder.into());
        self
    }

    /// The name of the system, so that one topology can run several times side by side.
    pub fn system(mut self, name: impl Into<String>) -> Self {
        self.system = Some(name.into());
        self
    }

    /// Whether this component listens on TCP at 127.0.0.1 instead of on Unix sockets. Peers find either by themselves.
    pub fn tcp(mut self, tcp: bool) -> Self {
        self.tcp = Some(tcp);
        self
    }

    /// A transport of one's own, or `scl::transport::memory::Memory` for ends in this process.
    ///
    /// The component then takes no place in the runtime folder: it reads and writes no file there, the other choices
    /// do not matter, and nothing but the transport keeps the component from being opened twice.
    pub fn transport(mut self, transport: impl Transport) -> Self {
        self.transport = Some(Arc::new(transport));
        self
    }

    pub(super) fn chosen_transport(&self) -> Option<Arc<dyn Transport>> {
        self.transport.clone()
    }

    /// The environment as this component sees it.
    pub(crate) fn variable(&self, name: &str) -> Option<OsString> {
        match (name, &self.runtime_dir) {
            ("SCL_RUNTIME_DIR", Some(folder)) => Some(folder.into()),
            _ => std::env::var_os(name),
        }
    }

    pub(crate) fn system_name(&self, topology: &str) -> String {
        let chosen = self.system.clone().or_else(|| std::env::var("SCL_SYSTEM").ok());
        chosen.filter(|name| !name.is_empty()).unwrap_or_else(|| topology.to_owned())
    }

    pub(crate) fn uses_tcp(&self) -> Result<bool, OpenError> {
        if let Some(tcp) = self.tcp {
            return Ok(tcp);
        }
        match std::env::var_os("SCL_TRANSPORT") {
            None => Ok(false),
            Some(word) if word == "ipc" || word.is_empty() => Ok(false),
            Some(word) if word == "tcp" => Ok(true),
            Some(other) => Err(OpenError::Environment {
                variable: "SCL_TRANSPORT",
                value: other.to_string_lossy().into_owned(),
                expected: "`ipc`, `tcp`",
            }),
        }
    }
}

impl std::fmt::Debug for OpenOptions {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("OpenOptions")
            .field("runtime_dir", &self.runtime_dir)
            .field("system", &self.system)
            .field("tcp", &self.tcp)
            .field("transport", &self.transport.as_ref().map(|_| "chosen"))
            .finish()
    }
}
