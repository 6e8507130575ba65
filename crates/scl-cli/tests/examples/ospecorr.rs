//! `examples/ospecorr` on a band with primary users, in simulated and in real time, checked by what is true of the
//! simulated band.
//!
//! The tests leave recordings and figures in `target/examples/ospecorr`.

mod checks;
mod recording;
mod session;
mod simulated;

use crate::radio::ospecorr::Truth;
use crate::{built, lock_machine};
use checks::{Outage, SLOT_US, silences};
use recording::Recording;
use serde_json::{Value, json};
use session::Session;

/// A primary user is to be alone on its channel after this many slots.
const SLOTS_TO_SILENCE: u64 = 5;

/// Part of the time.
const SERVED: f64 = 0.9;

/// Judged by what happens, not by how fast, so it also holds on a busy machine.
#[test]
fn a_short_run_moves_the_radio() {
    let _machine = lock_machine();
    let mut session = Session::start("short");
    session.run_until(10.0);
    let (recording, log) = session.end();
    assert!(!silences(&recording.truth).is_empty(), "no primary user came to the radio's channel\n{log}");
    let is_beside = |it: &Truth| !it.primary_channels.is_empty() && !it.primary_channels.contains(&it.channel);
    assert!(recording.truth.iter().any(|it| it.transmitting && is_beside(it)), "the radio has not moved\n{log}");
}

#[test]
fn the_radio_leaves_its_channel_to_primary_users_and_the_application_is_served() {
    let _machine = lock_machine();
    let mut session = Session::start("moves");
    session.run_until(26.0);
    let (recording, log) = session.end();
    check("moves", &recording, &[], &log);
    assert!(!log.contains("restarting"), "{log}");
}

/// Checks a recording, and writes its figures.
#[track_caller]
fn check(name: &str, recording: &Recording, outages: &[Outage], log: &str) {
    let silences = silences(&recording.truth);
    // A restart takes as long as the program needs to start; what happens meanwhile is stated, but not limited.
    let (excluded, counted): (Vec<_>, Vec<_>) =
        silences.iter().partition(|it| outages.iter().any(|outage| outage.disturbs(it.arrival_us)));
    let slots: Vec<u64> = counted.iter().map(|it| it.slots()).collect();
    assert!(slots.len() >= 3, "the radio had to move only {} times\n{log}", slots.len());
    let longest = *slots.iter().max().unwrap();
    assert!(longest <= SLOTS_TO_SILENCE, "silent after {slots:?} slots\n{log}");

    let share = recording.share_of_service(outages);
    assert!(share >= SERVED, "served for {:.1} % of the time\n{log}", share * 100.0);

    let mut sorted = slots.clone();
    sorted.sort_unstable();
    let median_ms = sorted[sorted.len() / 2] * SLOT_US / 1000;
    let collided = recording.truth.last().unwrap().lost;
    println!(
        "{name}: slots until silence {slots:?}, median {median_ms} ms; not counted: {} beside outages",
        excluded.len()
    );
    println!("{name}: served for {:.1} % of the time, {collided} frames collided", share * 100.0);
    for outage in outages {
        println!("{name}: {outage}");
    }
    let figures = json!({
        "slots_to_silence": slots,
        "slot_ms": SLOT_US / 1000,
        "median_ms_to_silence": median_ms,
        "slots_to_silence_beside_outages": excluded.iter().map(|it| it.slots()).collect::<Vec<_>>(),
        "share_of_service": share,
        "collided_frames": collided,
        "outages": outages.iter().map(Outage::to_json).collect::<Vec<Value>>(),
    });
    let text = serde_json::to_string_pretty(&figures).unwrap() + "\n";
    std::fs::write(built("ospecorr").join(name).with_extension("json"), text).unwrap();
}
