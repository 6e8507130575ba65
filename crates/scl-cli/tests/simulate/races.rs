//! A program with a race, which shows only when messages of different gates take different times: some seeds find it.

use super::{of_components, plan, simulate, text};
use scl::bytes::Bytes;
use scl::untyped::Component;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

const TOPOLOGY: &str = "\
system: car
components:
  - name: planner
    gates:
      - limit: pub
      - speed: pub
  - name: drive
    gates:
      - limit: sub
      - speed: sub
      - report: {pub: crate.Report, codec: json, unconnected: ok}
connections:
  - [planner.limit, drive.limit]
  - [planner.speed, drive.speed]
";
const PLAYS: &str = "SCL_TEST_RACE_PLAYS";

/// Plays the component that the environment names, or returns false.
fn play() -> bool {
    let Ok(name) = std::env::var(PLAYS) else { return false };
    let mut component = Component::open_blocking(&plan(&name)).unwrap();
    let number = |bytes: Bytes| text(&bytes).parse::<u64>().unwrap();
    if name == "planner" {
        let (mut limit, mut speed) = (component.publisher("limit").unwrap(), component.publisher("speed").unwrap());
        for value in 1_u64.. {
            thread::sleep(Duration::from_millis(100));
            let value = Bytes::from(value.to_string());
            if limit.send_blocking(&value).is_err() || speed.send_blocking(&value).is_err() {
                break;
            }
        }
        return true;
    }
    let allowed = Arc::new(AtomicU64::new(0));
    let (mut limit, newest) = (component.subscriber("limit").unwrap(), Arc::clone(&allowed));
    thread::spawn(move || {
        while let Ok(value) = limit.recv_blocking() {
            newest.store(number(value), Ordering::Relaxed);
        }
    });
    let (mut speed, mut report) = (component.subscriber("speed").unwrap(), component.publisher("report").unwrap());
    while let Ok(value) = speed.recv_blocking() {
        // The defect: a limit was sent before each speed, but need not have arrived before it.
        let is_allowed = number(value) <= allowed.load(Ordering::Relaxed);
        if report.send_blocking(&Bytes::from(format!("{{\"allowed\":{is_allowed}}}"))).is_err() {
            break;
        }
    }
    true
}

#[test]
fn a_race_between_two_gates_is_found_and_repeated() {
    if play() {
        return;
    }
    let test = "simulate::races::a_race_between_two_gates_is_found_and_repeated";
    let system = of_components(TOPOLOGY, test, PLAYS, &["planner", "drive"]);
    let scenario = "until: 3s\ndelays: {planner.speed: 5ms}\nexpect: [{always: drive.report, where: allowed}]\n";
    system.write("calm.yaml", scenario);
    let calm = simulate(&system, &["--scenario", "calm.yaml", "--seeds", "1..4"]);
    assert_eq!(calm.status.code(), Some(0), "{}", text(&calm.stdout));
    let scenario = "\
until: 3s
delays: {planner.limit: 0ms..2ms, planner.speed: 1700us..4ms}
faults: [{every: 1s..2s, pause: planner, for: 10ms}]
expect: [{always: drive.report, where: allowed}]
";
    system.write("rough.yaml", scenario);
    let rough = simulate(&system, &["--scenario", "rough.yaml", "--seeds", "1..12"]);
    let out = text(&rough.stdout);
    assert_eq!(rough.status.code(), Some(1), "{out}{}", text(&rough.stderr));
    // With the same seeds, the same happens in each release of SCL.
    let found: Vec<&str> = out.lines().filter(|line| line.starts_with("seed ")).collect();
    assert!((1..12).contains(&found.len()), "{out}");
    // It needs no fault, unless that has changed which messages are late.
    let command = found.iter().find(|line| line.contains("--faults none")).unwrap_or_else(|| panic!("{out}"));
    let arguments: Vec<&str> = command.split('`').nth(1).unwrap().split(' ').collect();
    let run = || simulate(&system, &[&["--scenario", "rough.yaml"][..], &arguments].concat());
    let [first, second] = [run(), run()].map(|output| {
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
        text(&output.stderr).lines().filter(|line| line.contains("= note: at ")).map(str::to_owned).collect::<Vec<_>>()
    });
    assert_eq!(first, second);
    assert!(first[0].contains("it was {\"allowed\":false}"), "{first:?}");
}
