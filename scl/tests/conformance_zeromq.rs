//! The ZeroMQ transport keeps every guarantee, over Unix sockets and over TCP, on the runtime that SCL's programs use. On
//! one of several threads the library's `pull` and `rep` ends may block those for ever: see `docs/zeromq.md`.
#![allow(clippy::unwrap_used)]

use scl::place::RuntimeDir;
use scl::transport::zeromq::{Medium, ZeroMq};
use tempfile::TempDir;

mod ipc {
    scl::transport_conformance!(one_thread super::fresh(super::Medium::Ipc));
}

mod tcp {
    scl::transport_conformance!(one_thread super::fresh(super::Medium::Tcp));
}

fn fresh(medium: Medium) -> (ZeroMq, TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let runtime_dir = RuntimeDir::locate(&|name| (name == "SCL_RUNTIME_DIR").then(|| folder.path().into()));
    (ZeroMq::new(runtime_dir.unwrap().system("rover").unwrap(), medium), folder)
}

#[test]
fn ends_that_several_threads_may_hang_on_are_refused_there() {
    use scl::transport::{Transport, TransportError};
    let (transport, _folder) = fresh(Medium::Ipc);
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().unwrap();
    let _inside = runtime.enter();
    let refused = [transport.pull("a.b.c").map(drop), transport.reply("a.b.c").map(drop)];
    for refused in refused {
        let error = refused.unwrap_err();
        assert!(matches!(error, TransportError::SeveralThreads { .. }) && error.to_string().contains("current_thread"));
    }
    let opened = [
        transport.publish("a.b.c").map(drop),
        transport.subscribe("a.b.c").map(drop),
        transport.push("a.b.c").map(drop),
        transport.request("a.b.c").map(drop),
    ];
    assert!(opened.iter().all(Result::is_ok), "{opened:?}");
}
