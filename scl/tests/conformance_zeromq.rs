//! The ZeroMQ transport keeps every guarantee, over Unix sockets, over TCP, and with shared memory.
#![allow(clippy::unwrap_used)]

use scl::runtime_dir::RuntimeDir;
use scl::transport::zeromq::{Medium, ZeroMq};
use tempfile::TempDir;

mod ipc {
    scl::transport_conformance!(super::fresh(super::Medium::Ipc));
}

mod tcp {
    scl::transport_conformance!(super::fresh(super::Medium::Tcp));
}

#[cfg(feature = "iceoryx2")]
mod shm {
    scl::transport_conformance!(lends; super::fresh(super::Medium::Shm));
}

fn fresh(medium: Medium) -> (ZeroMq, TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let runtime_dir = RuntimeDir::locate(&|name| (name == "SCL_RUNTIME_DIR").then(|| folder.path().into()));
    (ZeroMq::new(runtime_dir.unwrap().system("rover").unwrap(), medium), folder)
}
