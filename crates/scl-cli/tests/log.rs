//! `scl log`: what components printed, read without `scl run`.

use crate::system::{FOREVER, SpawnGuarded, Started, System};
use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

/// A system called `rover`, whose components run these commands in a shell.
fn system(components: &[(&str, &str)]) -> System {
    let entries = components.iter().map(|(name, command)| format!("  {name}:\n    command: {command:?}\n"));
    let gates = components.iter().map(|(name, _)| format!("  - {{name: {name}}}\n"));
    System::of_files(&[
        ("launch.yaml", &format!("components:\n{}", entries.collect::<String>())),
        ("topology.yaml", &format!("system: rover\ncomponents:\n{}", gates.collect::<String>())),
    ])
}

fn log(system: &System, arguments: &[&str]) -> Command {
    let mut command = system.scl(&[&["log"], arguments].concat());
    command.env_remove("SCL_SYSTEM");
    command
}

/// Runs a system to its end.
fn run(system: &System) {
    let mut command = system.scl(&["run"]);
    let output = command.env_remove("SCL_SYSTEM").env("SCL_RUNTIME_DIR", system.path("run")).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

fn start(system: &System) -> Started {
    system.start_with(&[], |command| {
        command.env_remove("SCL_SYSTEM").env("SCL_RUNTIME_DIR", system.path("run"));
    })
}

fn entries(system: &System, arguments: &[&str]) -> Vec<Value> {
    let output = log(system, &[arguments, &["--format", "json"]].concat()).output().unwrap();
    assert_eq!((output.status.code(), &*output.stderr), (Some(0), &b""[..]));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(!text.contains(|c: char| c != '\n' && c.is_control()), "{text}");
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn texts(system: &System, arguments: &[&str]) -> Vec<String> {
    entries(system, arguments).iter().map(|entry| entry["text"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn both_streams_are_kept_with_their_times_and_processes() {
    let system = system(&[("sensor", "echo one; echo ill >&2; printf 'two\\033[31m \\377'"), ("other", "echo no")]);
    run(&system);
    let entries = entries(&system, &["sensor"]);
    assert_eq!(entries.len(), 3);
    let of = |stream: &str| texts(&system, &["sensor", "--stream", stream]);
    assert_eq!(
        (of("stdout"), of("stderr")),
        (vec!["one".to_owned(), "two\u{1b}[31m \\xff".to_owned()], vec!["ill".to_owned()])
    );
    assert!(entries.iter().all(|entry| entry["component"] == "sensor" && entry["run"] == 1));
    assert_eq!(entries.iter().filter(|entry| entry["escaped"] == true).count(), 1);
    run(&system);
    assert_eq!(texts(&system, &["sensor", "--stream", "stderr", "-n", "1", "--since", "1h"]), ["ill"]);
    let text = String::from_utf8(log(&system, &["sensor", "--stream", "stderr"]).output().unwrap().stdout).unwrap();
    let shown: Vec<&str> = text.lines().map(|line| line.split_once('Z').map_or(line, |(_, rest)| rest)).collect();
    assert_eq!(shown, [" stderr ill", "-- process 2 --", " stderr ill"]);
    assert!(texts(&system, &["sensor", "--since", "0s"]).is_empty());
}

#[test]
fn a_line_of_100_megabytes_is_cut() {
    let command = format!("head -c 100000000 /dev/zero | tr '\\0' x; echo; echo end; {FOREVER}");
    let system = system(&[("sensor", &command)]);
    let mut running = start(&system);
    running.wait_for("sensor | end");
    running.signal("-INT");
    let _ = running.finish();
    let entries = entries(&system, &["sensor"]);
    let length: u64 = entries.iter().map(|it| it["text"].as_str().unwrap().len() as u64).sum();
    let cut: u64 = entries.iter().map(|it| it["cut_bytes"].as_u64().unwrap_or(0)).sum();
    assert_eq!(length + cut, 100_000_000 + 3, "every byte is kept or counted");
    assert!(length < 1_000_000);
    assert_eq!(entries.last().unwrap()["text"], "end");
}

#[test]
fn a_log_is_followed_while_the_component_runs_and_after() {
    let system = system(&[("sensor", &format!("echo one; until [ -e go ]; do sleep 0.01; done; echo two; {FOREVER}"))]);
    let mut running = start(&system);
    running.wait_for("sensor | one");
    let mut follow = log(&system, &["sensor", "-f"]).stdout(Stdio::piped()).spawn_guarded();
    let mut lines = BufReader::new(follow.stdout.take().unwrap()).lines().map(Result::unwrap);
    assert!(lines.next().unwrap().ends_with("Z stdout one"));
    system.write("go", "");
    assert!(lines.next().unwrap().ends_with("Z stdout two"));
    running.signal("-INT");
    let _ = running.finish();
    // It waits on: the component may be started again.
    let again = start(&system);
    assert_eq!(lines.next().unwrap(), "-- process 2 --");
    again.signal("-INT");
    let _ = again.finish();
    // It ends with its reader, although there is nothing to print.
    drop(lines);
    assert!(follow.wait().unwrap().success());
}

#[test]
fn logs_that_cannot_be_written_keep_nothing_from_running() {
    let system = system(&[("sensor", "echo one")]);
    system.write("state/scl", "a file where the folder should be");
    let mut command = system.scl(&["run"]);
    let output = command.env_remove("SCL_SYSTEM").env("SCL_RUNTIME_DIR", system.path("run")).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), &*output.stdout), (Some(0), &b"sensor | one\n"[..]), "{error}");
    assert!(error.starts_with("scl: cannot write `") && error.contains("; its output is not logged\n"), "{error}");
}

#[test]
fn logs_that_do_not_exist_are_errors_with_suggestions() {
    let system = system(&[("sensor", "echo one"), ("logger", "echo two")]);
    run(&system);
    let error = |arguments: &[&str]| {
        let output = log(&system, arguments).output().unwrap();
        assert_eq!((output.status.code(), &*output.stdout), (Some(2), &b""[..]));
        String::from_utf8(output.stderr).unwrap()
    };
    let unknown = error(&["sensr"]);
    assert!(unknown.starts_with("error: there is no log of component `sensr` of system `rover`\n"), "{unknown}");
    assert!(unknown.contains("  = help: did you mean `sensor`?\n"), "{unknown}");
    assert!(unknown.ends_with("  = note: logs: `logger`, `sensor`\n"), "{unknown}");
    assert!(error(&["sensor", "--system", "other"]).contains("of system `other`"));
    assert!(error(&["sensor", "--system", "../x"]).contains("there are no logs of system `../x`"));
}
