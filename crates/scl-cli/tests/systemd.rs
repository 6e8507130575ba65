//! The unit file of `docs/launch.md`, as systemd itself reads it.

use scl_needs::needs;
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

#[needs("systemd-analyze")]
#[test]
fn systemd_accepts_the_unit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rover-sensor.service");
    std::fs::write(&path, unit().replace("/opt/rover/bin/sensor", "/bin/true")).unwrap();
    let verified = Command::new("systemd-analyze").arg("verify").arg(&path).output().unwrap();
    // It succeeds in spite of unknown keys and only warns of them. What it says about units of the machine does not
    // count.
    let err = String::from_utf8_lossy(&verified.stderr);
    let complaints: Vec<&str> = err.lines().filter(|line| line.contains("rover-sensor")).collect();
    assert!(complaints.is_empty(), "{err}");
}
