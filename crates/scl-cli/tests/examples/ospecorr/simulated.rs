//! The radio in simulated time.

use super::check;
use super::checks::Outage;
use super::recording::Recording;
use crate::lock_machine;
use crate::simulated::simulate;

/// The parts of Figure 7, each with the time at which it is killed, in seconds. Primary users come at 4 s, 8 s and so
/// on, so the radio is on its new channel by then.
const KILLS: [(f64, &str); 5] = [
    (9.5, "signal_detector"),
    (13.5, "link_optimizer"),
    (17.5, "resource_map"),
    (21.5, "radio"),
    (25.5, "application"),
];

#[test]
fn every_part_is_killed_once_and_the_radio_goes_on() {
    let _machine = lock_machine();
    let faults: String = KILLS.iter().map(|(at, part)| format!("  - {{at: {at}s, kill: {part}}}\n")).collect();
    let run = simulate("ospecorr", "kills", &["--profile", "visits"], &format!("until: 34s\nfaults:\n{faults}"));
    assert_eq!(run.code, Some(0), "{}", run.log);
    for (_, component) in KILLS {
        let line = format!("`{component}` was restarted once; last reason: killed by signal 9 (SIGKILL)");
        assert!(run.log.contains(&line), "{component}\n{}", run.log);
    }
    let recording = Recording::read(&run.file);
    let outages = KILLS.map(|(at, component)| Outage::of(&recording, component, recording.band_us(at)));
    check("kills", &recording, &outages, &run.log);
}

#[test]
fn the_same_cuts_and_delays_give_the_same_recording() {
    let _machine = lock_machine();
    let scenario = "\
until: 12s
delays: {signal_detector.occupancy: 1ms..15ms, radio.*: 1ms}
takes: {link_optimizer: 0ms..2ms}
faults:
  - {every: 2s..4s, cut: any, except: [spectrum], for: 50ms..900ms}
  - {every: 3s..6s, kill: any, except: [spectrum]}
";
    let recordings = ["rough", "rough-again"].map(|name| {
        let run = simulate("ospecorr", name, &["--profile", "visits", "--seed", "3"], scenario);
        assert!(run.log.contains("are cut for"), "{}", run.log);
        std::fs::read(run.file).unwrap()
    });
    assert!(recordings[0] == recordings[1], "the recordings differ");
}
