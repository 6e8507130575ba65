//! The service of one connection: its name and its settings.

use crate::error::ShmError;
use crate::limits::Limits;
use iceoryx2::node::Node;
use iceoryx2::prelude::Alignment;
use iceoryx2::service::ipc_threadsafe::Service as Engine;
use iceoryx2::service::port_factory::publish_subscribe::PortFactory;
use std::collections::hash_map::RandomState;
use std::fmt;
use std::hash::{BuildHasher, Hasher};

/// Enough for any type, and a line of most caches.
const ALIGNMENT: usize = 64;

pub(crate) type Port = PortFactory<Engine, [u8], ()>;

/// The name of the service of one connection. No other connection has it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ServiceName(String);

impl ServiceName {
    /// Length of a name, in letters.
    const LENGTH: usize = 32;

    /// A new name that cannot be guessed.
    pub fn unique() -> Self {
        let random = || RandomState::new().build_hasher().finish();
        Self(format!("{:016x}{:016x}", random(), u64::from(std::process::id()) ^ random().rotate_left(17)))
    }

    /// Parses what a peer has sent.
    pub fn parse(text: &str) -> Option<Self> {
        let is_ours = |byte: u8| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte);
        (text.len() == Self::LENGTH && text.bytes().all(is_ours)).then(|| Self(text.to_owned()))
    }

    /// Its text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for ServiceName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Creates the service; the receiving end does, because its queue decides on the settings.
pub(crate) fn create(node: &Node<Engine>, name: &ServiceName, limits: &Limits) -> Result<Port, ShmError> {
    let failed = |error: &dyn fmt::Debug| ShmError::engine("create the connection's service", error);
    let name = name.as_str().try_into().map_err(|error| failed(&error))?;
    let alignment = Alignment::new(ALIGNMENT).ok_or_else(|| failed(&ALIGNMENT))?;
    let settings = node
        .service_builder(&name)
        .publish_subscribe::<[u8]>()
        .payload_alignment(alignment)
        .max_publishers(1)
        .max_subscribers(1)
        .max_nodes(2)
        .enable_safe_overflow(false)
        .history_size(0)
        .subscriber_max_buffer_size(limits.in_flight())
        .subscriber_max_borrowed_samples(limits.kept() + 1);
    settings.create().map_err(|error| failed(&error))
}

/// Opens the service that the receiving end has created, and returns its limits: the longest message is not known.
pub(crate) fn open(node: &Node<Engine>, name: &ServiceName) -> Result<(Port, Limits), ShmError> {
    let failed = |error: &dyn fmt::Debug| ShmError::engine("open the connection's service", error);
    let name = name.as_str().try_into().map_err(|error| failed(&error))?;
    let service = node.service_builder(&name).publish_subscribe::<[u8]>().open().map_err(|error| failed(&error))?;
    let found = {
        use iceoryx2::service::port_factory::PortFactory as _;
        *service.static_config()
    };
    // What one queue decides, another must not: these numbers decide how much memory the sending end reserves.
    let kept = found.subscriber_max_borrowed_samples().saturating_sub(1);
    let limits = Limits::of_kept(kept);
    let wrong = |what| Err(ShmError::Settings { what });
    if found.has_safe_overflow() || found.history_size() != 0 {
        return wrong("an overflow or a history");
    }
    if found.max_publishers() != 1 || found.max_subscribers() != 1 {
        return wrong("room for more than one connection");
    }
    if limits.kept() != kept || limits.in_flight() != found.subscriber_max_buffer_size() {
        return wrong("an unexpected number of samples");
    }
    Ok((service, limits))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_parsed_or_refused() {
        let name = ServiceName::unique();
        assert_eq!(ServiceName::parse(name.as_str()), Some(name.clone()));
        assert_ne!(name, ServiceName::unique());
        for wrong in ["", "abc", &"g".repeat(32), &"A".repeat(32), &"a".repeat(33), "../../../../../../../../etc/pass"]
        {
            assert_eq!(ServiceName::parse(wrong), None, "{wrong}");
        }
    }
}
