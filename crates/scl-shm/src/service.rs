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

/// Alignment of payloads: enough for any type, and a cache line on most processors.
const ALIGNMENT: usize = 64;

pub(crate) type Port = PortFactory<Engine, [u8], ()>;

/// The name of the service of one connection: a number, written as 32 hexadecimal digits. No other connection has it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ServiceName(pub u128);

impl ServiceName {
    /// A new name that cannot be guessed.
    pub fn unique() -> Self {
        let random = || u128::from(RandomState::new().build_hasher().finish());
        Self(random() << 64 | (random() ^ u128::from(std::process::id())))
    }
}

impl fmt::Display for ServiceName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

/// Creates the service. The receiving end does this, because its queue determines the settings.
pub(crate) fn create(node: &Node<Engine>, name: ServiceName, limits: &Limits) -> Result<Port, ShmError> {
    let failed = |error: &dyn fmt::Debug| ShmError::engine("create the connection's service", error);
    let name = name.to_string().as_str().try_into().map_err(|error| failed(&error))?;
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

/// Opens the service that the receiving end has created. Also returns its limits, except for the longest message, which
/// is not known.
pub(crate) fn open(node: &Node<Engine>, name: ServiceName) -> Result<(Port, Limits), ShmError> {
    let failed = |error: &dyn fmt::Debug| ShmError::engine("open the connection's service", error);
    let name = name.to_string().as_str().try_into().map_err(|error| failed(&error))?;
    let service = node.service_builder(&name).publish_subscribe::<[u8]>().open().map_err(|error| failed(&error))?;
    let found = {
        use iceoryx2::service::port_factory::PortFactory as _;
        *service.static_config()
    };
    // All these numbers must follow from the same queue, because they determine how much memory the sending end
    // reserves.
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
