//! What the gates of a running system hold is what `scl plan --memory` says.
#![allow(clippy::unwrap_used)]

use scl::bytes::Bytes;
use scl::plan::GateOptions;
use scl::{OpenOptions, TransportKind, TrySendError};
use std::path::Path;
use std::time::{Duration, Instant};

scl::topology!("held_memory.yaml");

/// A limit that no passing test reaches.
const LONG: Duration = Duration::from_secs(300);

/// After this many turns of all tasks in which no message was accepted, no more will be.
const TURNS: u32 = 1000;

/// Sends the longest messages to a gate whose program receives none, until no more is accepted.
macro_rules! fill {
    ($source:ident, $gate:ident) => {{
        let (planned, longest) = planned(stringify!($gate));
        let message = Bytes::from(vec![b'x'; longest as usize]);
        let (mut held, mut turns, started) = (0, 0, Instant::now());
        // More than half of the bound is reached, or it would say little.
        while turns < TURNS || held * 2 <= planned {
            match $source.$gate.try_send(&message) {
                Ok(()) => (held, turns) = (held + longest, 0),
                Err(TrySendError::Full { .. }) => turns += 1,
                Err(error) => panic!("{error}"),
            }
            assert!(held <= planned, "`{}` holds {held} bytes, more than {planned}", stringify!($gate));
            assert!(started.elapsed() < LONG, "`{}` holds {held} of {planned} bytes", stringify!($gate));
            tokio::task::yield_now().await;
        }
    }};
}

#[tokio::test]
async fn a_connection_that_is_full_holds_what_is_planned() {
    for kind in [TransportKind::Ipc, TransportKind::Tcp] {
        let folder = tempfile::tempdir().unwrap();
        let options = OpenOptions::new().runtime_dir(folder.path()).transport_kind(kind);
        let mut source = Source::open_with(options.clone()).await.unwrap();
        let _sink = Sink::open_with(options).await.unwrap();
        fill!(source, long_jobs);
        fill!(source, short_jobs);
        fill!(source, long_readings);
        fill!(source, short_readings);
    }
}

/// The most that the two gates of this name may hold together, and the longest message.
fn planned(gate: &str) -> (u64, u64) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/held_memory.yaml");
    let loaded = scl_loader::load(&scl_loader::Request::new(path));
    let topology = loaded.topology.unwrap();
    let gates = topology.components().flat_map(|(_, component)| component.gates());
    let both: Vec<_> = gates.copied().filter(|id| topology.gate(*id).name() == gate).collect();
    let longest = both.iter().map(|id| topology.memory_of(*id).longest).min().unwrap();
    assert!(longest < GateOptions::DEFAULT.max_size);
    (both.iter().map(|id| topology.memory_of(*id).total()).sum(), longest)
}
