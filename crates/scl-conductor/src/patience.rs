//! Programs that run for long without waiting.

use crate::participant::Participant;
use scl_terminal::Problem;
use std::fs;
use std::time::Duration;

/// Returns true if a person looks at the program with a debugger, or has stopped it.
pub(crate) fn is_debugged(pid: Option<u32>) -> bool {
    let status = pid.and_then(|pid| fs::read_to_string(format!("/proc/{pid}/status")).ok()).unwrap_or_default();
    let value = |name: &str| status.lines().find_map(|line| line.strip_prefix(name)).map_or("", str::trim);
    value("State:").starts_with(['t', 'T']) || !matches!(value("TracerPid:"), "" | "0")
}

pub(crate) fn never_waits(participant: &Participant, now: Duration, patience: Duration) -> Problem {
    let (name, patience) = (participant.shown(), patience.as_secs_f64());
    if participant.pid.is_none() {
        let text = format!("{name} does not take part in the simulation {patience:.0} s after its start");
        return Problem::new(text).help(
            "a program that removes `LD_PRELOAD` cannot take part; name the program itself, not a script that starts \
             it",
        );
    }
    let now = now.as_secs_f64();
    Problem::new(format!("{name} has been running for {patience:.0} s without waiting, at {now:.6} s")).help(
        "it computes forever, waits for something outside the simulation, or has become a program that does not \
             take part; `--patience` gives it more time",
    )
}
