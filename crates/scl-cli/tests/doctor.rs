//! What `scl doctor` finds.

use crate::rover::Rover;
use crate::system::kill;
use serde_json::Value;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::Command;

/// Findings as `severity check: message`.
fn findings(rover: &Rover, arguments: &[&str], code: i32, variables: &[(&str, &str)]) -> Vec<String> {
    let mut command = rover.scl(&[&["doctor", "--format", "json"], arguments].concat());
    let output = command.envs(variables.iter().copied()).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let json: Value = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
    assert_eq!(output.status.code(), Some(code), "{json:#}");
    let findings = json["findings"].as_array().unwrap();
    let word = |finding: &Value, key: &str| finding[key].as_str().unwrap_or_default().to_owned();
    findings
        .iter()
        .map(|it| format!("{} {}: {}", word(it, "severity"), word(it, "check"), word(it, "message")))
        .collect()
}

#[track_caller]
fn has(findings: &[String], expected: &str) {
    assert!(findings.iter().any(|finding| finding.contains(expected)), "no `{expected}` in {findings:#?}");
}

#[test]
fn a_sound_system_has_no_errors() {
    let rover = Rover::start();
    // That all are ready is in their figures within a second.
    let sound = "ok components: 4 running in 1 system".to_owned();
    let findings =
        std::iter::repeat_with(|| findings(&rover, &[], 0, &[])).find(|found| found.contains(&sound)).unwrap();
    has(&findings, "ok runtime folder: ");
    has(&findings, "ok contracts: all running programs were built for the same connections");
    assert!(findings.iter().all(|finding| !finding.starts_with("error")), "{findings:#?}");
}

#[test]
fn text_says_what_to_do_and_how_many_there_are() {
    let rover = Rover::stopped();
    let mut command = rover.scl(&["doctor"]);
    let output = command.env("SCL_LOG", "loud").env("SCL_SYSTM", "rover").output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.starts_with("error    environment: `SCL_LOG=loud` is not understood"), "{text}");
    assert!(text.contains("warning  environment: this shell sets `SCL_SYSTM`, which nothing reads\n"), "{text}");
    assert!(text.contains("= help: did you mean `SCL_SYSTEM`?\n"), "{text}");
    assert!(text.contains("\n1 error, "), "{text}");
}

#[test]
fn it_works_without_a_runtime_folder_and_creates_none() {
    let rover = Rover::stopped();
    let findings = findings(&rover, &[], 0, &[]);
    has(&findings, "note runtime folder: it does not exist yet; the first component creates it");
    has(&findings, "note components: none is running");
    assert!(!rover.runtime_dir().exists());
}

#[test]
fn a_folder_that_others_may_write_to_is_an_error() {
    let rover = Rover::stopped();
    fs::create_dir(rover.runtime_dir()).unwrap();
    fs::set_permissions(rover.runtime_dir(), fs::Permissions::from_mode(0o777)).unwrap();
    has(&findings(&rover, &[], 1, &[]), "error runtime folder: ");
}

#[test]
fn killed_and_hanging_components_are_found() {
    let mut rover = Rover::start();
    rover.kill("sensor");
    has(&findings(&rover, &[], 0, &[]), "warning components: `sensor` of system `rover` was killed or has crashed");
    let pid = rover.process_id("logger");
    kill("-STOP", pid);
    // Its figures are old after two seconds.
    let hangs =
        |line: &String| line.contains(&format!("error components: `logger` of system `rover` hangs (process {pid})"));
    while !hang_findings(&rover).iter().any(hangs) {}
    kill("-CONT", pid);
}

/// The findings, whatever the exit code is.
fn hang_findings(rover: &Rover) -> Vec<String> {
    let output = rover.scl(&["doctor"]).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

#[test]
fn programs_of_different_topologies_are_found() {
    let mut rover = Rover::stopped();
    rover.play_unready(&["sensor", "logger"]);
    // A controller that was built with another type.
    let other =
        crate::rover::TOPOLOGY.replace("sensor: {sub: rover.Measurement, queue: 1}", "sensor: {sub: rover.Setpoint}");
    let other = other.replace("measurements: {pub: rover.Measurement}", "measurements: {pub: rover.Setpoint}");
    assert_ne!(other, crate::rover::TOPOLOGY);
    rover.write("topology.yaml", &other);
    let plan = rover.text(&["plan"]);
    rover.write("plan.json", &plan);
    rover.play_unready(&["controller"]);
    let text = loop {
        let output = rover.scl(&["doctor"]).output().unwrap();
        if output.status.code() == Some(1) {
            break String::from_utf8(output.stdout).unwrap();
        }
    };
    assert!(
        text.contains("error    contracts: `controller.sensor` of system `rover` does not connect: `sensor`"),
        "{text}"
    );
    assert!(text.contains("`rover.Measurement`") && text.contains("`rover.Setpoint`"), "{text}");
}

#[test]
fn a_component_that_needs_more_descriptors_than_it_may_open_is_found() {
    let mut rover = Rover::start();
    // One that does not run would have the limit of this shell.
    rover.kill("controller");
    for (limit, is_enough) in [(31, false), (32, true)] {
        let script = format!("ulimit -n {limit}; exec \"$0\" doctor");
        let mut limited = Command::new("sh");
        limited.args(["-c", &script]).arg(rover.scl(&[]).get_program());
        let output = limited.env("SCL_RUNTIME_DIR", rover.runtime_dir()).output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        let needs = "`controller` of system `rover` needs 32 when all its peers are connected, but may open only 31\n";
        assert_eq!(text.contains(needs), !is_enough, "{text}");
    }
}

#[test]
fn misspelt_variables_of_running_components_and_refused_priorities_are_found() {
    let rover = Rover::start_with(&["sensor", "controller", "logger", "user_interface"], |command| {
        command.env("SCL_SCHDE", "fifo:80").env("SCL_SCHED", "fifo:80");
    });
    let findings = findings(&rover, &[], 0, &[]);
    has(&findings, "warning environment: component `sensor` sets `SCL_SCHDE`, which nothing reads");
    // The players of these tests do not apply it.
    has(
        &findings,
        "warning scheduling: `sensor` of system `rover` asked for real-time priority 80 and does not have it",
    );
}

#[test]
fn a_system_that_does_not_exist_is_not_examined() {
    let rover = Rover::start();
    let error = rover.error(&["doctor", "--system", "rovr"], 2);
    assert!(error.starts_with("error: there is no system `rovr`\n  = help: did you mean `rover`?"), "{error}");
}
