//! What every command does if its output cannot be written: a full disk is an error, a reader that has gone is not.

use crate::rover::Rover;
use crate::system::SpawnGuarded;
use scl_tests::wait_for;
use std::collections::BTreeSet;
use std::fs::OpenOptions;
use std::process::{Command, Output, Stdio};

/// Each command with arguments with which it prints something, and its exit code then. They run beside [`Rover`], in
/// order.
const COMMANDS: &[(&[&str], i32)] = &[
    (&["bw", "sensor.measurements", "--once"], 0),
    (&["call", "controller.commands", "--template"], 0),
    (&["check", "--format", "sarif", "topology.yaml"], 0),
    (&["completions", "bash"], 0),
    (&["delay", "sensor.measurements", "--once"], 0),
    (&["diff", "topology.yaml", "other.yaml"], 1),
    (&["doctor", "--format", "json"], 0),
    (&["echo", "sensor.measurements", "-n", "3"], 0),
    (&["echo", "sensor.measurements", "-n", "3", "--format", "json"], 0),
    (&["echo", "sensor.measurements", "-n", "3", "--format", "csv"], 0),
    (&["expand"], 0),
    (&["explain"], 0),
    (&["explain", "queue"], 0),
    (&["generate", "--for", "zmq"], 0),
    (&["generate", "--for", "python", "-o", "generated"], 0),
    (&["get"], 0),
    (&["graph"], 0),
    (&["graph", "--format", "svg"], 0),
    (&["hz", "sensor.measurements", "--once"], 0),
    (&["hz", "sensor.measurements", "--for", "2s", "--format", "json"], 0),
    (&["info", "sensor"], 0),
    (&["list", "-v"], 0),
    (&["list", "--format", "json"], 0),
    (&["plan"], 0),
    (&["plan", "--memory"], 0),
    (&["record", "sensor.measurements", "--for", "1s", "-o", "flight.mcap", "--overwrite"], 0),
    (&["recover", "flight.mcap"], 0),
    (&["compare", "flight.mcap", "flight.mcap"], 0),
    (&["schema"], 0),
    (&["top", "--once", "--period", "100ms"], 0),
    #[cfg(feature = "watch")]
    (&["metrics"], 0),
    #[cfg(feature = "watch")]
    (&["metrics", "--dashboard"], 0),
    #[cfg(feature = "watch")]
    (&["watch"], 0),
    #[cfg(feature = "watch")]
    (&["watch", "--svg"], 0),
    (&["--help"], 0),
    (&["echo", "--help"], 0),
    (&["--version"], 0),
    #[cfg(feature = "run")]
    (&["log", "sensor"], 0),
    #[cfg(feature = "run")]
    (&["log", "sensor", "-f"], 0),
    #[cfg(feature = "bench")]
    (&["bench", "--quick", "codecs"], 0),
];

/// Commands that are tried elsewhere, or print nothing to standard output.
const OTHERS: [&str; 12] =
    ["bridge", "deploy", "gateway", "help", "new", "pub", "replay", "restart", "run", "set", "simulate", "stop"];

const FULL: &str = "error: cannot write to standard output: No space left on device (os error 28)\n";

fn rover() -> Rover {
    let rover = Rover::start();
    let other = crate::rover::TOPOLOGY.replace("queue: 1", "queue: 2");
    rover.write("other.yaml", &other);
    let line = "{\"time\":\"2026-11-22T00:05:09.250Z\",\"component\":\"sensor\",\"stream\":\"stdout\",\"run\":1,\"text\":\"x\"}\n";
    std::fs::create_dir_all(rover.path("state/scl/rover")).unwrap();
    rover.write("state/scl/rover/sensor.log", line);
    rover
}

fn with_output(mut command: Command, output: impl Into<Stdio>) -> (Option<i32>, String) {
    let Output { status, stderr, .. } =
        command.stdout(output).stderr(Stdio::piped()).spawn_guarded().wait_with_output();
    (status.code(), String::from_utf8(stderr).unwrap())
}

fn full_disk() -> Stdio {
    OpenOptions::new().write(true).open("/dev/full").unwrap().into()
}

/// A pipe that nobody reads.
fn closed_pipe() -> Stdio {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    writer.into()
}

#[test]
fn a_full_disk_is_an_error_of_every_command() {
    let rover = rover();
    for (arguments, _) in COMMANDS {
        let (code, error) = with_output(rover.scl(arguments), full_disk());
        assert!(error.ends_with(FULL), "{arguments:?}: {error}");
        assert_eq!(error.matches(FULL).count(), 1, "{arguments:?}: {error}");
        assert_eq!(code, Some(2), "{arguments:?}");
    }
}

#[test]
fn a_reader_that_has_gone_is_no_error_of_any_command() {
    let rover = rover();
    for (arguments, expected) in COMMANDS {
        // Senders that get no processor are measured again: exit code 1 says that no message was seen.
        let (code, error) = wait_for(&arguments.join(" "), || {
            let output = with_output(rover.scl(arguments), closed_pipe());
            (*expected != 0 || output.0 != Some(1)).then_some(output)
        });
        let is_quiet = !["error", "panic", "roken pipe"].iter().any(|word| error.contains(word));
        assert!(is_quiet, "{arguments:?}: {error}");
        assert_eq!(code, Some(*expected), "{arguments:?}: {error}");
    }
}

/// A new command must be tried above, or be known to print nothing.
#[test]
fn every_command_is_tried() {
    let help = Rover::stopped().text(&["--help"]);
    let commands = help.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    let listed: BTreeSet<&str> = commands
        .lines()
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    let tried: BTreeSet<&str> = COMMANDS.iter().map(|(arguments, _)| arguments[0]).chain(OTHERS).collect();
    let untried: Vec<_> = listed.difference(&tried).collect();
    assert!(listed.len() > 20 && untried.is_empty(), "{untried:?}");
}

#[cfg(feature = "new")]
#[test]
fn a_new_project_is_made_although_its_output_is_lost() {
    let rover = Rover::stopped();
    let (code, error) = with_output(rover.scl(&["new", "probe"]), full_disk());
    assert!(error.ends_with(FULL), "{error}");
    assert_eq!(code, Some(2));
    assert!(rover.path("probe").is_dir());
}

#[cfg(feature = "run")]
mod of_a_run {
    use super::{FULL, full_disk, with_output};
    use crate::system::{FOREVER, System};

    #[test]
    fn a_system_whose_output_is_lost_is_stopped() {
        let system = System::of(&[("sensor", &format!("echo ready; {FOREVER}"))]);
        let (code, error) = with_output(system.scl(&["run"]), full_disk());
        assert!(error.ends_with(FULL), "{error}");
        assert_eq!(code, Some(2));
    }

    #[test]
    fn what_was_stopped_is_lost_on_a_full_disk() {
        let system = System::of(&[("sensor", &format!("echo ready; {FOREVER}"))]);
        system.write("topology.yaml", "system: rover\ncomponents:\n  - name: sensor\n");
        let mut started = system.start(&[]);
        started.wait_for("sensor | ready");
        for arguments in [&["restart", "sensor"][..], &["stop"]] {
            let (code, error) = with_output(system.scl(arguments), full_disk());
            assert_eq!((code, &*error), (Some(2), FULL), "{arguments:?}");
        }
        started.finish();
    }
}
