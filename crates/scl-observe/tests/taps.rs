//! Taps as one stream, also across starts, restarts and changes.

use crate::world::{TOPOLOGY, World};
use scl::bytes::Bytes;
use scl::tap::{ObservedKind, TapEvent};
use scl::{Pub, untyped::Component};
use scl_observe::{Taps, TapsEvent};
use std::collections::BTreeSet;
use std::time::Duration;
use tokio::time::timeout;

/// When to send once more.
const AGAIN: Duration = Duration::from_millis(50);

/// The next event other than a message.
async fn next_change(taps: &mut Taps) -> String {
    loop {
        if let Some(change) = shown(taps.next().await).filter(|it| !it.contains(": ")) {
            return change;
        }
    }
}

/// An event as text: `0 connected`, `started sensor.values`, `0: payload`.
fn shown(event: TapsEvent) -> Option<String> {
    Some(match event {
        TapsEvent::Started(gate) => format!("started {} {}", gate.name(), gate.payload),
        TapsEvent::Event { gate, event: TapEvent::Connected } => format!("{gate} connected"),
        TapsEvent::Event { gate, event: TapEvent::Disconnected } => format!("{gate} disconnected"),
        TapsEvent::Event { gate, event: TapEvent::Observed(seen) } => {
            format!("{gate}: {}", String::from_utf8_lossy(&seen.payload))
        }
    })
}

/// Sends until a message is seen, and returns at which gate. An observer that has just connected may miss some.
async fn seen_at(taps: &mut Taps, publisher: &mut Pub<Bytes>, text: &str) -> usize {
    loop {
        publisher.send(&Bytes::copy_from_slice(text.as_bytes())).await.unwrap();
        if let Ok(TapsEvent::Event { gate, event: TapEvent::Observed(seen) }) = timeout(AGAIN, taps.next()).await
            && seen.payload == text
        {
            return gate;
        }
    }
}

async fn values(world: &World, topology: &str) -> (Component, Pub<Bytes>) {
    let mut sensor = world.open_in("rover", topology, "sensor").await;
    let values = sensor.publisher("values").unwrap();
    (sensor, values)
}

#[tokio::test]
async fn several_gates_are_one_stream() {
    let world = World::new();
    let (mut sensor, mut publisher) = values(&world, TOPOLOGY).await;
    let mut controller = world.open("controller").await;
    let (mut ask, mut answer) = (sensor.requester("ask").unwrap(), controller.replier("answer").unwrap());
    let system = world.find(None).unwrap();
    let gates = ["sensor.values", "sensor.ask", "controller.values"].map(|name| system.gate(name).unwrap());
    let mut taps = Taps::open(&system, gates.to_vec());
    let mut connected = [next_change(&mut taps).await, next_change(&mut taps).await, next_change(&mut taps).await];
    connected.sort_unstable();
    assert_eq!(connected, ["0 connected", "1 connected", "2 connected"]);

    let mut seen = BTreeSet::new();
    while seen.len() < 2 {
        seen.insert(seen_at(&mut taps, &mut publisher, "one").await);
    }
    assert_eq!(seen, [0, 2].into(), "a subscriber is observed at its publisher");

    let _replies = tokio::spawn(async move {
        while let Ok(request) = answer.recv().await {
            request.reply(&"yes".into()).unwrap();
        }
    });
    let mut kinds = Vec::new();
    while kinds.len() < 2 {
        assert_eq!(ask.call(&"really?".into()).await.unwrap(), "yes");
        while let Ok(event) = timeout(AGAIN, taps.next()).await {
            if let TapsEvent::Event { gate: 1, event: TapEvent::Observed(seen) } = event {
                kinds.push((seen.kind, seen.payload));
            }
        }
    }
    assert_eq!(kinds, [(ObservedKind::Request, "really?".into()), (ObservedKind::Reply, "yes".into())]);
}

#[tokio::test]
async fn components_that_start_later_restart_or_change_are_followed() {
    let world = World::new();
    let _controller = world.open("controller").await;
    let system = world.find(None).unwrap();
    let mut taps = Taps::follow_all(&system, |gate| gate.gate == "values");

    let (sensor, mut publisher) = values(&world, TOPOLOGY).await;
    assert_eq!(next_change(&mut taps).await, "started sensor.values nav.Fix");
    assert_eq!(next_change(&mut taps).await, "0 connected");
    assert_eq!(seen_at(&mut taps, &mut publisher, "first").await, 0);

    drop((sensor, publisher));
    assert_eq!(next_change(&mut taps).await, "0 disconnected");
    let (sensor, mut publisher) = values(&world, TOPOLOGY).await;
    assert_eq!(next_change(&mut taps).await, "0 connected", "the same gate is not started twice");
    assert_eq!(seen_at(&mut taps, &mut publisher, "second").await, 0);

    drop((sensor, publisher));
    assert_eq!(next_change(&mut taps).await, "0 disconnected");
    let changed = TOPOLOGY.replace("nav.Fix", "nav.Position");
    let (_sensor, mut publisher) = values(&world, &changed).await;
    let mut changes = next_change(&mut taps).await;
    if changes == "0 connected" {
        // Its tap has the same name, so it may be connected to before the change is noticed.
        changes = next_change(&mut taps).await;
    }
    assert_eq!(changes, "started sensor.values nav.Position");
    assert_eq!(next_change(&mut taps).await, "1 connected");
    assert_eq!(seen_at(&mut taps, &mut publisher, "third").await, 1);
    assert_eq!(taps.gates().len(), 2);
}

#[tokio::test]
async fn a_removed_runtime_folder_ends_nothing() {
    let world = World::new();
    let (sensor, publisher) = values(&world, TOPOLOGY).await;
    let system = world.find(None).unwrap();
    let mut taps = Taps::follow_all(&system, |gate| gate.gate != "answer");
    assert_eq!(next_change(&mut taps).await, "started sensor.values nav.Fix");
    assert_eq!(next_change(&mut taps).await, "0 connected");
    drop((sensor, publisher));
    std::fs::remove_dir_all(world.runtime_dir()).unwrap();
    assert_eq!(next_change(&mut taps).await, "0 disconnected");
    let (_sensor, mut publisher) = values(&world, TOPOLOGY).await;
    let _controller = world.open("controller").await;
    let mut changes = [next_change(&mut taps).await, next_change(&mut taps).await, next_change(&mut taps).await];
    changes.sort_unstable();
    assert_eq!(changes, ["0 connected", "1 connected", "started controller.jobs nav.Job"]);
    assert_eq!(seen_at(&mut taps, &mut publisher, "again").await, 0);
}
