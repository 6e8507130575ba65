//! Scenarios: faults, and what must hold all the same.

use super::{errors, lines_of, of_components, plan, simulate, text};
use crate::system::System;
use scl::bytes::Bytes;
use scl::untyped::Component;
use scl_record::format::SIMULATION_START;
use std::thread;
use std::time::{Duration, SystemTime};

const TOPOLOGY: &str = "\
system: tank
components:
  - name: pump
    gates:
      - level: {pub: crate.Level, codec: json}
  - name: valve
    gates:
      - level: {sub: crate.Level, codec: json}
  - name: display
    gates:
      - level: {sub: crate.Level, codec: json}
connections:
  - [pump.level, valve.level]
  - [pump.level, display.level]
";

/// Names the program that a process is.
const PLAYS: &str = "SCL_TEST_SCENARIO_PLAYS";
const TICK: Duration = Duration::from_millis(100);

pub(super) fn system(test: &str, scenario: &str) -> System {
    let system = of_components(TOPOLOGY, test, PLAYS, &["pump", "valve", "display"]);
    system.write("rough.yaml", scenario);
    system
}

/// The time of the simulation, in seconds.
fn since_start() -> f64 {
    (SystemTime::UNIX_EPOCH.elapsed().unwrap() - SIMULATION_START).as_secs_f64()
}

/// Plays the component that the environment names, or returns false.
pub(super) fn play() -> bool {
    let Ok(name) = std::env::var(PLAYS) else { return false };
    let mut component = Component::open_blocking(&plan(&name)).unwrap();
    if name != "pump" {
        let mut level = component.subscriber("level").unwrap();
        while let Ok(message) = level.recv_blocking() {
            println!("{:.3} {}", since_start(), text(&message));
        }
        return true;
    }
    let mut gate = component.publisher("level").unwrap();
    // The defect: a pump that is started again begins with an empty tank.
    let mut level = 0.0;
    loop {
        thread::sleep(TICK);
        level += TICK.as_secs_f64();
        let error = since_start() - level;
        let message = format!("{{\"level\":{level:.1},\"error\":{error:.3}}}");
        if gate.send_blocking(&Bytes::from(message)).is_err() {
            return true;
        }
    }
}

#[test]
fn a_defect_that_a_fault_shows_is_found_and_shrunk_to_that_fault() {
    if play() {
        return;
    }
    let test = "simulate::scenarios::a_defect_that_a_fault_shows_is_found_and_shrunk_to_that_fault";
    let scenario = "\
until: 30s
takes: {valve: 1ms..3ms}
faults:
  - {every: 4s..20s, from: 5s, kill: any}
  - {at: 9s, pause: display, for: 2s}
expect:
  - {always: pump.level, where: 'error < 2'}
  - {eventually: pump.level, where: 'level > 1'}
";
    let system = system(test, scenario);
    let output = simulate(&system, &["--scenario", "rough.yaml", "--seeds", "1..8", "--jobs", "2"]);
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(1), "{out}{err}");
    // With the same seeds, the same happens in each release of SCL.
    let commands: Vec<&str> = out.lines().filter(|line| line.starts_with("seed ")).collect();
    assert!((1..8).contains(&commands.len()), "{out}{err}");
    assert!(err.ends_with(&format!("scl: 8 seeds, {} failed\n", commands.len())), "{err}");
    let kills = out.lines().filter(|line| line.ends_with("s: `pump` is killed")).count();
    assert_eq!(kills, commands.len(), "each is shrunk to one fault: {out}");

    // The command that it tells repeats it.
    let arguments: Vec<&str> = commands[0].split('`').nth(1).unwrap().split(' ').collect();
    let again = simulate(&system, &[&["--scenario", "rough.yaml"][..], &arguments].concat());
    let err = text(&again.stderr);
    assert_eq!(again.status.code(), Some(1), "{err}");
    assert!(err.contains("error: `pump.level` does not always meet its condition\n --> rough.yaml:7:5\n"), "{err}");
    assert!(err.contains("  = note: at "), "{err}");
    assert!(err.contains("`pump` is killed\n"), "{err}");
    assert!(err.contains("pump      killed by signal 9 (SIGKILL) after "), "{err}");
    let without = simulate(&system, &["--scenario", "rough.yaml", arguments[0], arguments[1], "--faults", "none"]);
    assert_eq!(without.status.code(), Some(0), "{}", text(&without.stderr));
}

#[test]
fn what_is_late_or_cut_arrives_later_and_in_order() {
    if play() {
        return;
    }
    let test = "simulate::scenarios::what_is_late_or_cut_arrives_later_and_in_order";
    let scenario = "\
until: 6s
delays: {pump.level: 20ms..80ms}
faults:
  - {at: 2s, cut: display, for: 1s}
  - {at: 4s, cut: pump.level, for: 500ms}
";
    let system = system(test, scenario);
    let output = simulate(&system, &["--scenario", "rough.yaml", "-o", "tank.mcap"]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let printed = text(&output.stdout);
    for (component, cuts) in [("valve", &[(4.0, 4.5)][..]), ("display", &[(2.0, 3.0), (4.0, 4.5)])] {
        let received: Vec<(f64, f64, f64)> = printed.lines().filter_map(|line| received(line, component)).collect();
        // Each arrives, in the order in which they were sent.
        let tenths = received.iter().map(|(_, level, _)| (level * 10.0).round() as usize);
        assert!(tenths.eq(1..=received.len()), "{printed}");
        assert!(received.len() >= 50, "{printed}");
        for (at, level, error) in received {
            let sent = level + error;
            let cut = cuts.iter().find(|(from, to)| (from - 0.08..*to).contains(&sent) && at >= *from);
            let expected = cut.map_or(sent + 0.019..sent + 0.081, |(_, to)| *to - 0.001..to + 0.081);
            assert!(expected.contains(&at), "{component} at {at}, sent at {sent}");
        }
    }
    let faults = ["the connections of `display` are cut for 1.000000 s", "of `pump.level` are cut for 0.500000 s"];
    faults.iter().for_each(|fault| assert!(text(&output.stderr).contains(fault), "{}", text(&output.stderr)));
    let again = simulate(&system, &["--scenario", "rough.yaml", "-o", "again.mcap"]);
    assert_eq!(lines_of(&text(&again.stdout), "display"), lines_of(&printed, "display"));
}

/// When a component has received a message, and the level and its error that it says.
fn received(line: &str, component: &str) -> Option<(f64, f64, f64)> {
    let (at, message) = line.strip_prefix(component)?.trim_start().strip_prefix("| ")?.split_once(' ')?;
    let at = at.parse().ok()?;
    let message: serde_json::Value = serde_json::from_str(message).unwrap();
    Some((at, message["level"].as_f64().unwrap(), message["error"].as_f64().unwrap()))
}

#[test]
fn what_does_not_happen_is_told() {
    if play() {
        return;
    }
    let test = "simulate::scenarios::what_does_not_happen_is_told";
    let scenario = "\
until: 5s
faults:
  - {at: 2s, pause: pump, for: 1s}
expect:
  - {eventually: pump.level, where: 'level > 1', by: 500ms}
  - {exit: pump, code: 0}
  - {always: pump.level, where: 'error < 0.5'}
";
    let system = system(test, scenario);
    let output = simulate(&system, &["--scenario", "rough.yaml"]);
    let err = errors(&output);
    assert_eq!(output.status.code(), Some(1), "{err}");
    assert!(err.contains("error: `pump.level` has not met its condition by 500ms\n --> rough.yaml:5:5\n"), "{err}");
    assert!(err.contains("error: `pump` has not ended with exit code 0\n --> rough.yaml:6:5\n"), "{err}");
    assert!(err.contains("  = note: it has not ended by itself\n"), "{err}");
    assert!(err.contains("error: `pump.level` does not always meet its condition\n --> rough.yaml:7:5\n"), "{err}");
    assert!(err.contains("scl: fault 1, at 2.000000 s: `pump` does not run for 1.000000 s\n"), "{err}");
}

#[test]
fn a_scenario_with_mistakes_starts_nothing() {
    let test = "simulate::scenarios::a_scenario_with_mistakes_starts_nothing";
    let system = system(test, "until: 5s\nfaults:\n  - {at: 1s, kill: pumb}\n  - {at: 1, kill: pump}\n");
    for (arguments, expected) in [
        (&["--scenario", "rough.yaml"][..], &["unknown component `pumb`", "rough.yaml:3:20", "rough.yaml:4:10"][..]),
        (&["--scenario", "missing.yaml"], &["cannot read the scenario: No such file"]),
        (&["--scenario", "rough.yaml", "--faults", "x"], &["expected numbers of faults such as `2,5`, or `none`"]),
        (&["--seeds", "5..1"], &["expected the first and the last seed, for example `1..500`"]),
        (&["--seeds", "1..2", "--seed", "7"], &["cannot be used with"]),
    ] {
        let output = simulate(&system, arguments);
        let err = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{err}");
        expected.iter().for_each(|expected| assert!(err.contains(expected), "{err}"));
        assert_eq!(text(&output.stdout), "");
    }
}
