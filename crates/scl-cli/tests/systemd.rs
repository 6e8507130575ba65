//! The unit file of `docs/launch.md`, as systemd itself reads it where it is installed.

use std::process::Command;

/// The keys that matter for readiness and the watchdog, and what `scl run` calls them.
const LIMITS: [(&str, &str); 3] =
    [("TimeoutStartSec", "ready_within"), ("WatchdogSec", "alive_within"), ("TimeoutStopSec", "stop_within")];

fn unit() -> &'static str {
    let page = include_str!("../../../docs/launch.md");
    page.split("```ini\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap()
}

#[test]
fn the_unit_has_the_limits_of_the_launch_file() {
    let unit = unit();
    assert!(unit.contains("\nType=notify\n"));
    for (key, name) in LIMITS {
        assert!(unit.lines().any(|line| line.starts_with(&format!("{key}="))), "{name}");
    }
}

#[test]
fn systemd_accepts_the_unit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rover-sensor.service");
    std::fs::write(&path, unit().replace("/opt/rover/bin/sensor", "/bin/true")).unwrap();
    let Ok(verified) = Command::new("systemd-analyze").arg("verify").arg(&path).output() else {
        // Without it, the form of the lines is what can be checked.
        println!("systemd-analyze is not installed: only the form of the unit was checked");
        for line in unit().lines().filter(|line| !line.is_empty()) {
            let is_section = line.starts_with('[') && line.ends_with(']');
            assert!(is_section || line.split_once('=').is_some_and(|(key, _)| key.chars().all(char::is_alphanumeric)));
        }
        return;
    };
    // It succeeds in spite of unknown keys and only warns of them. What it says about units of the machine does not count.
    let err = String::from_utf8_lossy(&verified.stderr);
    let complaints: Vec<&str> = err.lines().filter(|line| line.contains("rover-sensor")).collect();
    assert!(complaints.is_empty(), "{err}");
}
