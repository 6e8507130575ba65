//! A registry of the user's beside a transport of the user's: who runs, who may connect, and what is awaited.
#![allow(clippy::unwrap_used)]

use bytes::Bytes;
use scl::OpenOptions;
use scl::registry::{Neighbour, Registered, Registry, RegistryError};
use scl::spec::{ComponentSpec, ConnectionSpec, GateSpec};
use scl::transport::PeerCheck;
use scl::transport::memory::Memory;
use scl::untyped::Component;
use std::collections::HashMap;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Components by name, as if some ran in other processes.
#[derive(Clone, Default)]
struct Table {
    running: Arc<Mutex<HashMap<String, Neighbour>>>,
    refused: Arc<Mutex<Option<String>>>,
}

struct Entry {
    table: Table,
    component: &'static str,
}

impl Registry for Table {
    fn register(&self, component: &'static ComponentSpec) -> Result<Box<dyn Registered>, RegistryError> {
        let mut running = self.running.lock().unwrap();
        if running.contains_key(component.name) {
            return Err(RegistryError::Taken { component: component.name, by: "process 4711".to_owned() });
        }
        running.insert(component.name.to_owned(), Neighbour::ThisProcess);
        Ok(Box::new(Entry { table: self.clone(), component: component.name }))
    }
}

impl Registered for Entry {
    fn neighbour(&self, component: &str) -> Option<Neighbour> {
        self.table.running.lock().unwrap().get(component).copied()
    }

    fn peer_check(&self, gate: &'static GateSpec, connection: &'static ConnectionSpec) -> Option<PeerCheck> {
        let refused = Arc::clone(&self.table.refused);
        let names =
            format!("`{}.{}` and `{}.{}`", self.component, gate.name, connection.peer_component, connection.peer_gate);
        Some(Arc::new(move || match &*refused.lock().unwrap() {
            Some(reason) => Err(format!("{names} do not connect: {reason}")),
            None => Ok(()),
        }))
    }
}

impl Drop for Entry {
    fn drop(&mut self) {
        self.table.running.lock().unwrap().remove(self.component);
    }
}

struct Stage {
    table: Table,
    options: OpenOptions,
}

impl Stage {
    fn new() -> Self {
        let table = Table::default();
        let options = OpenOptions::new().transport(Memory::new()).registry(table.clone());
        Self { table, options }
    }

    async fn open(&self, component: &str) -> Result<Component, scl::OpenError> {
        Component::open_with(&crate::untyped::plan(component), self.options.clone()).await
    }

    fn run_elsewhere(&self, component: &str) {
        self.table.running.lock().unwrap().insert(component.to_owned(), Neighbour::OtherProcess);
    }
}

#[tokio::test]
async fn a_name_is_taken_once_and_freed_when_the_component_is_gone() {
    let stage = Stage::new();
    let mut controller = stage.open("controller").await.unwrap();
    let gate = controller.subscriber("raw").unwrap();
    let error = format!("{:?}", scl::Error::from(stage.open("controller").await.map(drop).unwrap_err()));
    assert_eq!(
        error,
        "component `controller` cannot be opened\n  caused by: component `controller` is already running as process 4711; \
         stop it first"
    );
    drop(controller);
    assert!(stage.open("controller").await.is_err(), "a gate of it is still there");
    drop(gate);
    stage.open("controller").await.unwrap();
    assert!(stage.table.running.lock().unwrap().is_empty());
}

#[tokio::test(start_paused = true)]
async fn missing_peers_are_explained_by_the_registry() {
    let stage = Stage::new();
    let sensor = stage.open("sensor").await.unwrap();
    let missing = sensor.ready(Duration::from_secs(1)).await.unwrap_err().to_string();
    assert!(missing.contains("`controller.sensor` is not running"), "{missing}");
    stage.run_elsewhere("controller");
    let missing = sensor.ready(Duration::from_secs(1)).await.unwrap_err().to_string();
    assert!(missing.contains("`controller.sensor` is not connected"), "{missing}");
}

#[tokio::test(start_paused = true)]
async fn the_registry_decides_who_connects() {
    let stage = Stage::new();
    *stage.table.refused.lock().unwrap() = Some("not today".to_owned());
    let _sensor = stage.open("sensor").await.unwrap();
    let controller = stage.open("controller").await.unwrap();
    let missing = controller.ready(Duration::from_secs(1)).await.unwrap_err().to_string();
    assert!(missing.contains("`controller.raw` and `sensor.raw` do not connect: not today"), "{missing}");
}

#[tokio::test(start_paused = true)]
async fn closing_waits_for_peers_that_run_elsewhere() {
    let stage = Stage::new();
    for (elsewhere, awaited) in [(false, Duration::ZERO), (true, Duration::from_secs(7))] {
        let mut sensor = stage.open("sensor").await.unwrap();
        let mut raw = sensor.publisher("raw").unwrap();
        if elsewhere {
            stage.run_elsewhere("controller");
        }
        raw.send(&Bytes::from_static(b"waits")).await.unwrap();
        let started = tokio::time::Instant::now();
        let closed = sensor.close(Duration::from_secs(7)).await;
        assert_eq!((closed.is_err(), started.elapsed()), (elsewhere, awaited));
        drop(raw);
    }
}
