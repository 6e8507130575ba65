//! The options of opening a component.

use crate::environment::{self, Variables};
use crate::error::OpenError;
use crate::registry::Registry;
use crate::set_variable;
use crate::transport::Transport;
use crate::transport_choice::TransportChoice;
use crate::transport_kind::TransportKind;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;

/// Options for opening a component. Unset options come from the environment.
///
/// | option | environment | default |
/// |---|---|---|
/// | [`runtime_dir`](Self::runtime_dir) | `SCL_RUNTIME_DIR` | `$XDG_RUNTIME_DIR/scl`, or `scl-<uid>` in the folder for temporary files |
/// | [`system`](Self::system) | `SCL_SYSTEM` | `system` in the topology file |
/// | [`transport_kind`](Self::transport_kind), [`transports`](Self::transports) | `SCL_TRANSPORT=ipc`, `tcp` or `shm`, or `ipc,camera.frames=shm` | `ipc` |
/// | [`transport_of`](Self::transport_of) | added to `SCL_TRANSPORT` | |
/// | [`set`](Self::set) | added to `SCL_SET` | the defaults in the topology file |
/// | [`transport`](Self::transport), [`registry`](Self::registry) | | ZeroMQ, in the runtime folder |
///
/// ```
/// let options = scl::OpenOptions::new().system("rover-2").transport_of("camera.frames", scl::TransportKind::Shm);
/// ```
#[derive(Clone, Default)]
#[must_use = "options do nothing until they are passed to `open_with` or `open_blocking_with`"]
pub struct OpenOptions {
    runtime_dir: Option<PathBuf>,
    system: Option<String>,
    transport_kind: Option<TransportKind>,
    /// Gates as `component.gate`, in order.
    transport_of: Vec<(String, TransportKind)>,
    pub(crate) transport: Option<Arc<dyn Transport>>,
    pub(crate) registry: Option<Arc<dyn Registry>>,
    /// Values of parameters, by `component.parameter`.
    pub(crate) set: Vec<(String, String)>,
    pub(crate) is_test: bool,
    /// Whether the component is opened in place of its program.
    pub(crate) stands_in: bool,
}

impl OpenOptions {
    /// Returns options that all come from the environment.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the folder in which gates meet. Only components with the same folder find each other.
    pub fn runtime_dir(mut self, folder: impl Into<PathBuf>) -> Self {
        self.runtime_dir = Some(folder.into());
        self
    }

    /// Sets the name of the system, so that one topology can run several times side by side.
    pub fn system(mut self, name: impl Into<String>) -> Self {
        self.system = Some(name.into());
        self
    }

    /// Sets what the component's listening gates listen on. `SCL_TRANSPORT` then has no effect.
    pub fn transport_kind(mut self, transport_kind: TransportKind) -> Self {
        self.transport_kind = Some(transport_kind);
        self
    }

    /// Sets the transport of the connections of one gate, named as `component.gate`: a gate of this component or of a
    /// peer. If several settings apply to a connection, the last one counts. The listening end of the connection
    /// decides.
    ///
    /// Opening fails if this component has no gate of this name.
    pub fn transport_of(mut self, gate: impl Into<String>, transport_kind: TransportKind) -> Self {
        self.transport_of.push((gate.into(), transport_kind));
        self
    }

    /// Sets what [`transport_kind`](Self::transport_kind) and [`transport_of`](Self::transport_of) set, from a text
    /// like the value of `SCL_TRANSPORT`, which then has no effect.
    pub fn transports(mut self, choice: TransportChoice) -> Self {
        self.transport_kind = Some(choice.default_kind());
        self.transport_of.extend(choice.of_gates);
        self
    }

    /// Sets the value of a parameter, named as `component.parameter`, as a text like in the topology file: `10ms`. It
    /// counts more than one in `SCL_SET`. Those of other components have no effect.
    ///
    /// Opening fails if the component has no such parameter, or if it cannot have this value.
    pub fn set(mut self, parameter: impl Into<String>, value: impl Into<String>) -> Self {
        self.set.push((parameter.into(), value.into()));
        self
    }

    /// Uses a transport of your own, or `scl::transport::memory::Memory` for gates within this process.
    ///
    /// The component then uses no runtime folder: it reads and writes no files, the options of the runtime folder have
    /// no effect, and only the transport or a [`registry`](Self::registry) can keep the component from being opened
    /// twice.
    ///
    /// Opening fails if its gates need more than [the transport guarantees](Transport::guarantees).
    pub fn transport(mut self, transport: impl Transport) -> Self {
        self.transport = Some(Arc::new(transport));
        self
    }

    /// Uses a registry of your own, beside a [`transport`](Self::transport) of your own: it keeps the component from
    /// being opened twice, and knows which peers run. Without such a transport it has no effect, because the runtime
    /// folder is a registry.
    pub fn registry(mut self, registry: impl Registry) -> Self {
        self.registry = Some(Arc::new(registry));
        self
    }

    /// Returns the options of a tool that takes the place of a component's program: nothing reads its parameters, so
    /// they need no values.
    #[doc(hidden)]
    pub fn stands_in(self) -> Self {
        Self { stands_in: true, ..self }
    }

    /// Returns the options for a unit test: on this transport, a component is alone with its counterpart, which takes
    /// the place of all peers of a gate, at the endpoint of its first connection. The other connections are left out,
    /// and messages that are not received cause no warning.
    #[cfg(feature = "memory")]
    #[doc(hidden)]
    pub fn for_test(self, transport: crate::transport::memory::Memory) -> Self {
        Self { is_test: true, set: self.set, ..Self::new().transport(transport) }
    }

    /// Looks up an environment variable; the chosen runtime folder replaces `SCL_RUNTIME_DIR`.
    pub(crate) fn variable(&self, name: &str) -> Option<OsString> {
        match (name, &self.runtime_dir) {
            ("SCL_RUNTIME_DIR", Some(folder)) => Some(folder.into()),
            _ => environment::of_process(name),
        }
    }

    /// Checks the variables that take the place of unset options.
    ///
    /// # Errors
    /// [`OpenError::Environment`] if one of them would be refused.
    pub(crate) fn check(variables: Variables<'_>) -> Result<(), OpenError> {
        Self::new().system_name(variables, "")?;
        set_variable::read(variables)?;
        Self::new().transport_choice(variables).map(drop)
    }

    /// Returns the name of the system: the chosen one, or `SCL_SYSTEM`, or the topology's.
    ///
    /// # Errors
    /// [`OpenError::Environment`] if `SCL_SYSTEM` is not UTF-8.
    pub(crate) fn system_name(&self, variables: Variables<'_>, topology: &str) -> Result<String, OpenError> {
        if let Some(name) = self.system.as_ref().filter(|name| !name.is_empty()) {
            return Ok(name.clone());
        }
        let name = environment::read(variables, "SCL_SYSTEM", "a name in UTF-8", |name| Some(name.to_owned()))?;
        Ok(name.unwrap_or_else(|| topology.to_owned()))
    }

    /// Returns the transports: the chosen default, or `SCL_TRANSPORT`, or Unix sockets; then those chosen for single
    /// gates.
    ///
    /// # Errors
    /// [`OpenError::Environment`] if `SCL_TRANSPORT` is not understood.
    pub(crate) fn transport_choice(&self, variables: Variables<'_>) -> Result<TransportChoice, OpenError> {
        let parse = |text: &str| text.parse().ok();
        let mut choice = match self.transport_kind {
            Some(default) => TransportChoice { default, ..TransportChoice::default() },
            None => {
                environment::read(variables, "SCL_TRANSPORT", TransportChoice::expected(), parse)?.unwrap_or_default()
            }
        };
        choice.of_gates.extend(self.transport_of.iter().cloned());
        Ok(choice)
    }
}

impl std::fmt::Debug for OpenOptions {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("OpenOptions")
            .field("runtime_dir", &self.runtime_dir)
            .field("system", &self.system)
            .field("transport_kind", &self.transport_kind)
            .field("transport_of", &self.transport_of)
            .field("set", &self.set)
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
            let found = refused(options.system_name(&table("SCL_SYSTEM", value), "rover"));
            assert_eq!(found, expected.map(str::to_owned).map_err(str::to_owned), "{options:?} {value:?}");
        }
    }

    #[test]
    fn the_media_are_chosen_or_read_or_ipc() {
        let chosen = |transport_kind| OpenOptions::new().transport_kind(transport_kind);
        let some = || OpenOptions::new().transport_of("a.b", TransportKind::Shm);
        let cases: [Case<'_, &str>; 12] = [
            (OpenOptions::new(), b"", Ok("ipc")),
            (OpenOptions::new(), b"ipc", Ok("ipc")),
            (OpenOptions::new(), b"tcp", Ok("tcp")),
            (OpenOptions::new(), b"shm", Ok("shm")),
            (OpenOptions::new(), b"tcp,x.y=shm", Ok("tcp,x.y=shm")),
            (some(), b"tcp,x.y=shm", Ok("tcp,x.y=shm,a.b=shm")),
            (some().transports("tcp,c.d=ipc".parse().unwrap()), b"shm,x.y=shm", Ok("tcp,a.b=shm,c.d=ipc")),
            (chosen(TransportKind::Ipc), b"tcp,x.y=shm", Ok("ipc")),
            (chosen(TransportKind::Tcp), b"nonsense", Ok("tcp")),
            (OpenOptions::new(), b"udp", Err("SCL_TRANSPORT=udp")),
            (OpenOptions::new(), b"tcp\xff", Err("SCL_TRANSPORT=tcp\u{fffd}")),
            (some(), b"ipc,x=shm", Err("SCL_TRANSPORT=ipc,x=shm")),
        ];
        for (options, value, expected) in cases {
            let found = refused(options.transport_choice(&table("SCL_TRANSPORT", value)));
            let expected = match expected {
                Ok(text) => Ok(text.parse().unwrap()),
                Err(value) => Err(format!("{value}, not {}", TransportChoice::expected())),
            };
            assert_eq!(found, expected, "{options:?} {value:?}");
        }
    }

    #[test]
    fn a_chosen_folder_replaces_the_variable() {
        let options = OpenOptions::new().runtime_dir("/chosen");
        assert_eq!(options.variable("SCL_RUNTIME_DIR"), Some("/chosen".into()));
        assert_eq!(options.variable("PATH"), std::env::var_os("PATH"));
    }
}
