//! The options of opening a component.

use crate::environment::{self, Variables};
use crate::error::OpenError;
use crate::medium::Medium;
use crate::transport::Transport;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;

/// Options for opening a component. Unset options come from the environment.
///
/// | option | environment | default |
/// |---|---|---|
/// | [`runtime_dir`](Self::runtime_dir) | `SCL_RUNTIME_DIR` | `$XDG_RUNTIME_DIR/scl`, or `scl-<uid>` in the folder for temporary files |
/// | [`system`](Self::system) | `SCL_SYSTEM` | `system` in the topology file |
/// | [`medium`](Self::medium) | `SCL_TRANSPORT=ipc`, `tcp` or `shm` | `ipc` |
/// | [`transport`](Self::transport) | | ZeroMQ, in the runtime folder |
///
/// ```
/// let options = scl::OpenOptions::new().system("rover-2").medium(scl::Medium::Tcp);
/// ```
#[derive(Clone, Default)]
#[must_use = "options do nothing until they are passed to `open_with` or `open_blocking_with`"]
pub struct OpenOptions {
    runtime_dir: Option<PathBuf>,
    system: Option<String>,
    medium: Option<Medium>,
    transport: Option<Arc<dyn Transport>>,
    is_test: bool,
}

impl OpenOptions {
    /// Options that all come from the environment.
    pub fn new() -> Self {
        Self::default()
    }

    /// The folder in which gates meet. Only components with the same folder find each other.
    pub fn runtime_dir(mut self, folder: impl Into<PathBuf>) -> Self {
        self.runtime_dir = Some(folder.into());
        self
    }

    /// The name of the system, so that one topology can run several times side by side.
    pub fn system(mut self, name: impl Into<String>) -> Self {
        self.system = Some(name.into());
        self
    }

    /// What the component's listening gates listen on.
    pub fn medium(mut self, medium: Medium) -> Self {
        self.medium = Some(medium);
        self
    }

    /// A transport of your own, or `scl::transport::memory::Memory` for gates within this process.
    ///
    /// The component then uses no runtime folder: it reads and writes no files, the other options have no effect, and
    /// only the transport can keep the component from being opened twice.
    pub fn transport(mut self, transport: impl Transport) -> Self {
        self.transport = Some(Arc::new(transport));
        self
    }

    /// For `test()`: on this transport, a component is alone with its counterpart, which plays all peers of a gate at
    /// the endpoint of its first connection. The other connections are left out, and what nobody receives is no warning.
    #[cfg(feature = "memory")]
    #[doc(hidden)]
    pub fn of_test(transport: crate::transport::memory::Memory) -> Self {
        Self { is_test: true, ..Self::new().transport(transport) }
    }

    pub(crate) fn is_test(&self) -> bool {
        self.is_test
    }

    pub(crate) fn chosen_transport(&self) -> Option<Arc<dyn Transport>> {
        self.transport.clone()
    }

    /// Looks up an environment variable; the chosen runtime folder replaces `SCL_RUNTIME_DIR`.
    pub(crate) fn variable(&self, name: &str) -> Option<OsString> {
        match (name, &self.runtime_dir) {
            ("SCL_RUNTIME_DIR", Some(folder)) => Some(folder.into()),
            _ => environment::of_process(name),
        }
    }

    /// The name of the system: the chosen one, or `SCL_SYSTEM`, or the topology's.
    ///
    /// # Errors
    /// [`OpenError::Environment`] if `SCL_SYSTEM` is not UTF-8.
    pub(crate) fn system_name(&self, topology: &str) -> Result<String, OpenError> {
        self.system_name_from(&environment::of_process, topology)
    }

    /// The medium: the chosen one, or `SCL_TRANSPORT`, or Unix sockets.
    ///
    /// # Errors
    /// [`OpenError::Environment`] if `SCL_TRANSPORT` is not a medium.
    pub(crate) fn chosen_medium(&self) -> Result<Medium, OpenError> {
        self.medium_from(&environment::of_process)
    }

    /// Checks the variables that take the place of unset options.
    ///
    /// # Errors
    /// [`OpenError::Environment`] if one of them would be refused.
    pub(crate) fn check(variables: Variables<'_>) -> Result<(), OpenError> {
        Self::new()
            .system_name_from(variables, "")
            .map(drop)
            .and_then(|()| Self::new().medium_from(variables).map(drop))
    }

    fn system_name_from(&self, variables: Variables<'_>, topology: &str) -> Result<String, OpenError> {
        if let Some(name) = self.system.as_ref().filter(|name| !name.is_empty()) {
            return Ok(name.clone());
        }
        let name = environment::read(variables, "SCL_SYSTEM", "a name in UTF-8", |name| Some(name.to_owned()))?;
        Ok(name.unwrap_or_else(|| topology.to_owned()))
    }

    fn medium_from(&self, variables: Variables<'_>) -> Result<Medium, OpenError> {
        if let Some(medium) = self.medium {
            return Ok(medium);
        }
        let medium = environment::read(variables, "SCL_TRANSPORT", Medium::EXPECTED, Medium::parse)?;
        Ok(medium.unwrap_or_default())
    }
}

impl std::fmt::Debug for OpenOptions {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("OpenOptions")
            .field("runtime_dir", &self.runtime_dir)
            .field("system", &self.system)
            .field("medium", &self.medium)
            .field("transport", &self.transport.as_ref().map(|_| "chosen"))
            .finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::refused;
    use std::os::unix::ffi::OsStringExt;

    type Case<'a, T> = (OpenOptions, &'a [u8], Result<T, &'a str>);

    fn table(name: &'static str, value: &[u8]) -> impl Fn(&str) -> Option<OsString> {
        let value = OsString::from_vec(value.to_vec());
        move |asked| (asked == name).then(|| value.clone())
    }

    #[test]
    fn the_system_is_chosen_or_read_or_the_topology_s() {
        let chosen = || OpenOptions::new().system("chosen");
        let cases: [Case<'_, &str>; 6] = [
            (OpenOptions::new(), b"", Ok("rover")),
            (OpenOptions::new(), b"read", Ok("read")),
            (chosen(), b"read", Ok("chosen")),
            (chosen(), b"\xff", Ok("chosen")),
            (OpenOptions::new().system(""), b"read", Ok("read")),
            (OpenOptions::new(), b"read\xff", Err("SCL_SYSTEM=read\u{fffd}, not a name in UTF-8")),
        ];
        for (options, value, expected) in cases {
            let found = refused(options.system_name_from(&table("SCL_SYSTEM", value), "rover"));
            assert_eq!(found, expected.map(str::to_owned).map_err(str::to_owned), "{options:?} {value:?}");
        }
    }

    #[test]
    fn the_medium_is_chosen_or_read_or_ipc() {
        let chosen = |medium| OpenOptions::new().medium(medium);
        let cases: [Case<'_, Medium>; 8] = [
            (OpenOptions::new(), b"", Ok(Medium::Ipc)),
            (OpenOptions::new(), b"ipc", Ok(Medium::Ipc)),
            (OpenOptions::new(), b"tcp", Ok(Medium::Tcp)),
            (OpenOptions::new(), b"shm", Ok(Medium::Shm)),
            (chosen(Medium::Ipc), b"tcp", Ok(Medium::Ipc)),
            (chosen(Medium::Tcp), b"nonsense", Ok(Medium::Tcp)),
            (OpenOptions::new(), b"udp", Err("SCL_TRANSPORT=udp, not `ipc`, `tcp` or `shm`")),
            (OpenOptions::new(), b"tcp\xff", Err("SCL_TRANSPORT=tcp\u{fffd}, not `ipc`, `tcp` or `shm`")),
        ];
        for (options, value, expected) in cases {
            let found = refused(options.medium_from(&table("SCL_TRANSPORT", value)));
            assert_eq!(found, expected.map_err(str::to_owned), "{options:?} {value:?}");
        }
    }

    #[test]
    fn a_chosen_folder_replaces_the_variable() {
        let options = OpenOptions::new().runtime_dir("/chosen");
        assert_eq!(options.variable("SCL_RUNTIME_DIR"), Some("/chosen".into()));
        assert_eq!(options.variable("PATH"), std::env::var_os("PATH"));
    }
}
