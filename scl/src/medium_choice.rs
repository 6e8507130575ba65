//! Which medium each connection uses: one for all, and exceptions by gate.

use crate::error::OpenError;
use crate::medium::Medium;
use crate::spec::{ComponentSpec, GateSpec, LinkSpec};
use std::str::FromStr;

/// The media of a system's connections, as in `SCL_TRANSPORT`: one for all, then exceptions by gate.
///
/// The listening end of a connection decides (`pub`, `pull`, `rep`), the connecting end finds it. An exception names a
/// gate at either end. Of several that apply, the last one counts. Exceptions for gates of other components than the
/// one being opened are left to those, unless they are its peers.
///
/// ```
/// let all: scl::MediumChoice = "shm".parse()?;
/// let some: scl::MediumChoice = "ipc,camera.frames=shm,logger.frames=tcp".parse()?;
/// let options = scl::OpenOptions::new().media(some);
/// # Ok::<(), scl::MediumError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct MediumChoice {
    pub(crate) default: Medium,
    /// `component.gate`, in order.
    pub(crate) of_gates: Vec<(String, Medium)>,
}

/// A text is not a [`MediumChoice`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{part}` is not understood; expected {}", MediumChoice::EXPECTED)]
pub struct MediumError {
    /// The part of the text that is wrong.
    part: String,
}

impl FromStr for MediumChoice {
    type Err = MediumError;

    /// Parses `ipc`, or `ipc,camera.frames=shm`, or exceptions alone.
    fn from_str(text: &str) -> Result<Self, MediumError> {
        let mut choice = Self::default();
        for (index, part) in text.split(',').map(str::trim).enumerate() {
            let wrong = || MediumError { part: part.to_owned() };
            match part.split_once('=') {
                None if index == 0 => choice.default = Medium::parse(part).ok_or_else(wrong)?,
                None => return Err(wrong()),
                Some((gate, word)) => {
                    let gate = Some(gate.trim()).filter(|gate| is_gate(gate)).ok_or_else(wrong)?;
                    choice.of_gates.push((gate.to_owned(), Medium::parse(word.trim()).ok_or_else(wrong)?));
                }
            }
        }
        Ok(choice)
    }
}

impl MediumChoice {
    /// The values of `SCL_TRANSPORT`, for messages.
    pub(crate) const EXPECTED: &str = "`ipc`, `tcp` or `shm`, or with exceptions like `ipc,camera.frames=shm`";

    /// The medium of all connections without an exception.
    pub fn default_medium(&self) -> Medium {
        self.default
    }

    /// The medium of one connection.
    pub(crate) fn of_link(&self, spec: &ComponentSpec, gate: &GateSpec, link: &LinkSpec) -> Medium {
        self.last(|component, name| {
            (component, name) == (spec.name, gate.name) || (component, name) == (link.peer_component, link.peer_gate)
        })
    }

    /// The medium of a gate that listens once for all of its peers.
    pub(crate) fn of_gate(&self, spec: &ComponentSpec, gate: &GateSpec) -> Medium {
        self.last(|component, name| {
            let is_peer = |link: &LinkSpec| (component, name) == (link.peer_component, link.peer_gate);
            (component, name) == (spec.name, gate.name) || gate.links.iter().any(is_peer)
        })
    }

    /// The medium of a gate's tap, where only tools connect.
    pub(crate) fn of_tap(&self, spec: &ComponentSpec, gate: &GateSpec) -> Medium {
        self.last(|component, name| (component, name) == (spec.name, gate.name))
    }

    /// Refuses exceptions for gates that a component does not have.
    ///
    /// # Errors
    /// [`OpenError::NoSuchGate`] for the first one.
    pub(crate) fn check(&self, spec: &ComponentSpec) -> Result<(), OpenError> {
        let names = || spec.gates.iter().map(|gate| gate.name);
        let mut own = self.entries().filter(|(component, ..)| *component == spec.name);
        match own.find(|(_, gate, _)| !names().any(|name| name == *gate)) {
            None => Ok(()),
            Some((_, gate, medium)) => Err(OpenError::NoSuchGate {
                component: spec.name,
                gate: gate.to_owned(),
                medium: medium.word(),
                nearest: scl_plan::nearest(gate, names()).map(str::to_owned),
            }),
        }
    }

    fn last(&self, applies: impl Fn(&str, &str) -> bool) -> Medium {
        let found = self.entries().filter(|(component, gate, _)| applies(component, gate)).last();
        found.map_or(self.default, |(.., medium)| medium)
    }

    fn entries(&self) -> impl Iterator<Item = (&str, &str, Medium)> {
        self.of_gates.iter().filter_map(|(name, medium)| {
            let (component, gate) = name.split_once('.')?;
            Some((component, gate, *medium))
        })
    }
}

fn is_gate(name: &str) -> bool {
    name.split_once('.').is_some_and(|(component, gate)| {
        !component.is_empty() && !gate.is_empty() && !gate.contains('.') && !name.contains(char::is_whitespace)
    })
}

#[cfg(test)]
mod tests;
