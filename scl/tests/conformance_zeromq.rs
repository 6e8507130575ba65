//! The ZeroMQ transport keeps every guarantee, over Unix sockets, over TCP, and with shared memory.
#![allow(clippy::unwrap_used)]

use scl::runtime_dir::RuntimeDir;
use scl::transport::zeromq::{TransportKind, ZeroMq};
use tempfile::TempDir;

mod ipc {
    scl::transport_conformance!(super::fresh(super::TransportKind::Ipc));
}

mod tcp {
    scl::transport_conformance!(super::fresh(super::TransportKind::Tcp));
}

#[cfg(feature = "shm")]
mod shm {
    scl::transport_conformance!(lends; super::fresh(super::TransportKind::Shm));
}

fn fresh(kind: TransportKind) -> (ZeroMq, TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let runtime_dir = RuntimeDir::locate(&|name| (name == "SCL_RUNTIME_DIR").then(|| folder.path().into()));
    (ZeroMq::new(runtime_dir.unwrap().system("rover").unwrap(), kind), folder)
}
