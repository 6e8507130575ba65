//! Untyped components: every call of their gates on every transport, typed peers, and what errors say.
#![allow(clippy::unwrap_used)]

mod asynchronous;
mod blocking;
mod changes;
mod counterpart;
mod ending_calls;
mod ending_race;
mod errors;
mod foreign_texts;
mod in_flight;
mod readiness;
mod specs;
mod timeouts;
mod typed_peers;
mod undecodable;

use bytes::Bytes;
use scl::plan::{Plan, SystemPlan};
use scl::transport::memory::Memory;
use scl::{OpenOptions, TransportKind};
use std::path::Path;
use std::time::Duration;

scl::topology!("untyped.yaml");

type Values = Vec<f64>;

/// Far longer than anything takes.
const LONG: Duration = Duration::from_secs(300);

/// The plans of a topology file in this folder or in `doc/`, with locations as in generated code.
pub(crate) fn system_plan(file: &str) -> SystemPlan {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = if file.starts_with("doc/") { package.join(file) } else { package.join("tests").join(file) };
    let loaded = scl_loader::load(&scl_loader::Request { shown_as: file.to_owned(), ..scl_loader::Request::new(path) });
    loaded.system_plan().unwrap_or_else(|| panic!("{file}: {:?}", loaded.diagnostics))
}

pub(crate) fn plan(component: &str) -> Plan {
    system_plan("untyped.yaml").component(component).unwrap().clone()
}

/// Runs a test in memory, on Unix sockets and on TCP. All its components are to be opened with the same options.
fn on_each_transport(test: impl Fn(OpenOptions)) {
    test(OpenOptions::new().transport(Memory::new()));
    for kind in [TransportKind::Ipc, TransportKind::Tcp] {
        let folder = tempfile::tempdir().unwrap();
        test(OpenOptions::new().runtime_dir(folder.path()).transport_kind(kind));
    }
}

/// The same for async code.
pub(crate) fn on_each_transport_async<F: Future<Output = ()>>(test: impl Fn(OpenOptions) -> F) {
    on_each_transport(|options| {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(test(options));
    });
}

fn bytes(text: &str) -> Bytes {
    Bytes::copy_from_slice(text.as_bytes())
}
