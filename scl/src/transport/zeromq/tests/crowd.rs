//! More peers than an end accepts.

use super::stage::{Stage, endpoint};
use crate::transport::zeromq::TransportKind;
use crate::transport::zeromq::acceptor::{Acceptor, MOST_CONNECTIONS};
use crate::transport::zeromq::zmtp::{SclReady, SocketType};
use std::fmt::{Debug, Write};
use std::future::poll_fn;
use std::sync::{Arc, Mutex};
use std::task::Poll;
use tokio::io::AsyncReadExt;
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Level, Metadata, Subscriber};

/// Keeps the fields of warnings.
#[derive(Clone, Default)]
struct Warnings(Arc<Mutex<Vec<String>>>);

impl Subscriber for Warnings {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        *metadata.level() <= Level::WARN
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn event(&self, event: &Event<'_>) {
        let mut fields = Fields(String::new());
        event.record(&mut fields);
        self.0.lock().unwrap().push(fields.0);
    }

    fn enter(&self, _: &Id) {}

    fn exit(&self, _: &Id) {}
}

struct Fields(String);

impl Visit for Fields {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        write!(self.0, "{}={value:?} ", field.name()).unwrap();
    }
}

/// Peers beyond the limit see their connections closed, and the log says why, once and not for each of them.
#[tokio::test]
async fn connections_beyond_the_limit_are_closed_and_logged_once() {
    let stage = Stage::new(TransportKind::Ipc);
    let dir = Arc::new(stage.dir.clone());
    let (kind, scl) = (TransportKind::Ipc, SclReady::default());
    let mut acceptor = Acceptor::open(&dir, kind, &endpoint(), SocketType::Pull, scl).unwrap();
    let warnings = Warnings::default();
    let _capturing = tracing::subscriber::set_default(warnings.clone());
    let mut greeting = Vec::new();
    for open in [MOST_CONNECTIONS - 1, MOST_CONNECTIONS, MOST_CONNECTIONS] {
        let mut peer = stage.connect_silently().await;
        poll_fn(|cx| {
            let _session = acceptor.poll_session(cx, open);
            Poll::Ready(())
        })
        .await;
        greeting.push(peer.read(&mut [0; 1]).await.unwrap());
    }
    assert_eq!(greeting, [1, 0, 0]);
    let warnings = warnings.0.lock().unwrap();
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    assert!(warning.contains("error=1024 peers are connected, the maximum for one gate"), "{warning}");
}
