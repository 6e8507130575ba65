//! The components that are measured over each transport.

use scl::TransportKind;
use std::path::Path;

scl::topology!("engines.yaml");

/// The host of the side that measures, in benchmarks over gateways.
pub(crate) const NEAR: &str = "near";

/// The host of the worker.
pub(crate) const FAR: &str = "far";

/// Returns the options for the component of the variant `id`, whose first word names the transport. `host` matters only
/// over gateways.
pub(crate) fn options(id: &str, folder: &str, host: &str) -> scl::OpenOptions {
    let options = scl::OpenOptions::new();
    match id.split('-').next() {
        // The environment chooses the transport.
        Some("scl") => options.runtime_dir(folder).system(id),
        // Each host has its own runtime folder here; the other variants share one, so each is a separate system.
        Some("gateway") => options.runtime_dir(Path::new(folder).join("gateway").join(host)),
        Some("shm") => options.runtime_dir(folder).system(id).transport_kind(TransportKind::Shm),
        Some("tcp") => options.runtime_dir(folder).system(id).transport_kind(TransportKind::Tcp),
        _ => options.runtime_dir(folder).system(id).transport_kind(TransportKind::Ipc),
    }
}

/// Starts the gateways between both sides.
#[cfg(feature = "gateway")]
pub(crate) fn start_gateways(folder: &str) -> scl::Result<Vec<crate::worker::Worker>> {
    use crate::gateway::{self, Host};
    let host = |name, components: [&str; 2]| Host { name, components: components.map(str::to_owned).to_vec() };
    let hosts = [host(NEAR, ["client", "source"]), host(FAR, ["echo", "sink"])];
    gateway::start_gateways(&Path::new(folder).join("gateway"), include_str!("../engines.yaml"), &hosts)
}
