//! The program of each component of the small system.

use super::messages::message;
use super::{COMPONENTS, PLAYS, Rover};
use scl::plan::{GatePlan, Payload, SystemPlan};
use scl::untyped::{Component, Gate};
use std::io::Read;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

/// The test that plays a component if it is asked to.
pub(super) const TEST: &str = "rover::player::components_start_and_stop";

/// What a component prints when it sends, which is when all its peers are connected, unless it is [`ALONE`].
pub(super) const READY: &str = "component is ready";

/// Set for a component that shall not wait for its peers.
pub(super) const ALONE: &str = "SCL_TEST_ALONE";

/// The plan of the system, as text: the file may have been replaced before the component reads it.
pub(super) const PLAN: &str = "SCL_TEST_PLAN";

/// 50 Hz.
const PERIOD: Duration = Duration::from_millis(20);

/// How long a call may take.
const CALL: Duration = Duration::from_secs(1);

#[test]
fn components_start_and_stop() {
    if let Ok(component) = std::env::var(PLAYS) {
        return play(&component);
    }
    let mut rover = Rover::start();
    for component in COMPONENTS {
        rover.stop(component);
    }
    let left = std::fs::read_dir(rover.runtime_dir().join("rover")).unwrap();
    let mut left = left.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect::<Vec<_>>();
    left.retain(|name| !name.ends_with(".lock") && !name.ends_with(".schema"));
    assert_eq!(left, [""; 0]);
}

/// Plays a component until standard input ends.
fn play(name: &str) {
    let plan = SystemPlan::from_json(&std::env::var(PLAN).unwrap()).unwrap();
    let plan = plan.component(name).unwrap();
    let mut component = Component::open_blocking(plan).unwrap();
    let (closer, stop) = (component.closer(), Arc::new(AtomicBool::new(false)));
    if std::env::var_os(ALONE).is_none() {
        component.ready_blocking(Duration::from_secs(300)).unwrap();
    }
    let play = |gate: &GatePlan| {
        let (opened, payload, stop) = (component.gate(&gate.name).unwrap(), gate.payload.clone(), Arc::clone(&stop));
        thread::spawn(move || play_gate(opened, &payload, &stop))
    };
    let threads: Vec<_> = plan.gates.iter().map(play).collect();
    println!("{READY}");
    std::io::stdin().read_to_end(&mut Vec::new()).unwrap();
    stop.store(true, Ordering::Relaxed);
    closer.end_calls();
    threads.into_iter().for_each(|thread| thread.join().unwrap());
}

/// Uses a gate until calls are ended. What does not reach a peer, which may have ended, does not matter.
fn play_gate(gate: Gate, payload: &Payload, stop: &AtomicBool) {
    let types: Vec<&str> = payload.types().collect();
    let (sent, replied) = (types.first().copied().unwrap_or_default(), types.get(1).copied().unwrap_or_default());
    match gate {
        Gate::Pub(mut gate) => repeat(stop, |number| drop(gate.send_timeout(&message(sent, number), PERIOD))),
        Gate::Push(mut gate) => repeat(stop, |number| drop(gate.send_timeout(&message(sent, number), PERIOD))),
        Gate::Req(mut gate) => repeat(stop, |number| drop(gate.call_timeout(&message(sent, number), CALL))),
        Gate::Sub(mut gate) => while gate.recv_blocking().is_ok() {},
        Gate::Pull(mut gate) => while gate.recv_blocking().is_ok() {},
        Gate::Rep(mut gate) => {
            while let Ok(request) = gate.recv_blocking() {
                let _ = request.reply(&message(replied, 1));
            }
        }
        _ => unreachable!("there are six kinds of gate"),
    }
}

fn repeat(stop: &AtomicBool, mut send: impl FnMut(u64)) {
    for number in (0..).take_while(|_| !stop.load(Ordering::Relaxed)) {
        send(number);
        thread::sleep(PERIOD);
    }
}
