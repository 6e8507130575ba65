//! Which transport each connection uses: one for all, and exceptions by gate.

use crate::spec::{ComponentSpec, ConnectionSpec, GateSpec};
use crate::transport_kind::TransportKind;
use scl_text::gate_name::split;
use scl_text::list::either;
use std::str::FromStr;
use std::sync::LazyLock;

/// The transports of a system's connections, as in `SCL_TRANSPORT`: one for all, then exceptions by gate.
///
/// The listening end of a connection (`pub`, `pull`, `rep`) decides; the connecting end finds it. An exception names a
/// gate at either end. Of several that apply, the last one counts. When a component is opened, exceptions for gates of
/// other components matter only if those gates are its peers.
///
/// ```
/// let all: scl::TransportChoice = "shm".parse()?;
/// let some: scl::TransportChoice = "ipc,camera.frames=shm,logger.frames=tcp".parse()?;
/// let options = scl::OpenOptions::new().transports(some);
/// # Ok::<(), scl::TransportChoiceError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct TransportChoice {
    pub(crate) default: TransportKind,
    /// The exceptions, by `component.gate`, in order.
    pub(crate) of_gates: Vec<(String, TransportKind)>,
}

/// A text is not a [`TransportChoice`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{part}` is not understood; expected {}", TransportChoice::expected())]
pub struct TransportChoiceError {
    /// The part of the text that is wrong.
    part: String,
}

impl FromStr for TransportChoice {
    type Err = TransportChoiceError;

    /// Parses `ipc`, or `ipc,camera.frames=shm`, or exceptions alone.
    fn from_str(text: &str) -> Result<Self, TransportChoiceError> {
        let mut choice = Self::default();
        for (index, part) in text.split(',').map(str::trim).enumerate() {
            let wrong = || TransportChoiceError { part: part.to_owned() };
            match part.split_once('=') {
                None if index == 0 => choice.default = TransportKind::of(part).ok_or_else(wrong)?,
                None => return Err(wrong()),
                Some((gate, word)) => {
                    let gate = Some(gate.trim()).filter(|gate| is_gate(gate)).ok_or_else(wrong)?;
                    choice.of_gates.push((gate.to_owned(), TransportKind::of(word.trim()).ok_or_else(wrong)?));
                }
            }
        }
        Ok(choice)
    }
}

impl TransportChoice {
    /// Returns the values of `SCL_TRANSPORT`, for messages.
    pub(crate) fn expected() -> &'static str {
        static EXPECTED: LazyLock<String> = LazyLock::new(|| {
            format!("{}, or with exceptions like `ipc,camera.frames=shm`", either(&TransportKind::WORDS))
        });
        &EXPECTED
    }

    /// Returns the transport of all connections without an exception.
    pub fn default_kind(&self) -> TransportKind {
        self.default
    }

    /// Returns the transport of an end of a gate: of one connection, of all connections of a gate that listens once for
    /// all of its peers, or, without connections, of its tap, where only tools connect.
    pub(crate) fn of(&self, spec: &ComponentSpec, gate: &GateSpec, connections: &[ConnectionSpec]) -> TransportKind {
        let applies = |component: &str, name: &str| {
            (component, name) == (spec.name, gate.name)
                || connections.iter().any(|peer| (component, name) == (peer.peer_component, peer.peer_gate))
        };
        let found = self.entries().filter(|(component, gate, _)| applies(component, gate)).last();
        found.map_or(self.default, |(.., kind)| kind)
    }

    /// Returns the first exception that names a gate which this component does not have.
    pub(crate) fn unknown_gate(&self, spec: &ComponentSpec) -> Option<(&str, TransportKind)> {
        let has = |name: &str| spec.gates.iter().any(|gate| gate.name == name);
        let mut own = self.entries().filter(|(component, ..)| *component == spec.name);
        own.find(|(_, gate, _)| !has(gate)).map(|(_, gate, kind)| (gate, kind))
    }

    fn entries(&self) -> impl Iterator<Item = (&str, &str, TransportKind)> {
        self.of_gates.iter().filter_map(|(name, kind)| {
            let (component, gate) = split(name)?;
            Some((component, gate, *kind))
        })
    }
}

fn is_gate(name: &str) -> bool {
    let is_word = |word: &str| !word.is_empty() && !word.contains(char::is_whitespace);
    name.contains('.') && name.split('.').all(is_word)
}

#[cfg(test)]
mod tests;
