//! Components that asked for a real-time priority, and whether they have it.

use super::{Examined, Finding};
use crate::process::stat_field;
use std::fs;

const CHECK: &str = "scheduling";

/// `SCHED_FIFO` in /proc/<pid>/stat, as in `sched(7)`.
const FIFO: u64 = 1;

pub(super) fn check(examined: &Examined<'_>) -> Vec<Finding> {
    let running = examined.running();
    let findings = running.filter_map(|(system, component, pid)| {
        let wanted = wanted_priority(&fs::read(format!("/proc/{}/environ", pid?)).ok()?)?;
        let stat = fs::read_to_string(format!("/proc/{}/stat", pid?)).ok()?;
        Some(judge(&format!("`{}` of system `{}`", component.name, system.name()), wanted, scheduling(&stat)?))
    });
    findings.collect()
}

/// The priority that `SCL_SCHED=fifo:<priority>` of an environment asks for.
fn wanted_priority(environment: &[u8]) -> Option<u64> {
    let mut entries = environment.split(|byte| *byte == 0);
    let value = entries.find_map(|entry| entry.strip_prefix(b"SCL_SCHED="))?;
    str::from_utf8(value).ok()?.strip_prefix("fifo:")?.parse().ok()
}

/// Real-time priority and policy of a process's first thread.
fn scheduling(stat: &str) -> Option<(u64, u64)> {
    Some((stat_field(stat, 40)?, stat_field(stat, 41)?))
}

fn judge(component: &str, wanted: u64, (priority, policy): (u64, u64)) -> Finding {
    if policy == FIFO && priority == wanted {
        return Finding::ok(CHECK, format!("{component} runs at real-time priority {priority}"));
    }
    let text = format!("{component} asked for real-time priority {wanted} and does not have it");
    Finding::warning(CHECK, text)
        .help(format!("its program needs `cap_sys_nice`, or its user `rtprio {wanted}` in /etc/security/limits.conf"))
}

#[cfg(test)]
mod tests {
    use super::super::Severity;
    use super::*;

    #[test]
    fn the_wanted_priority_is_that_of_the_environment() {
        for (environment, expected) in [
            (&b"A=1\0SCL_SCHED=fifo:80\0B=2"[..], Some(80)),
            (b"SCL_SCHED=\0", None),
            (b"XSCL_SCHED=fifo:80", None),
            (b"", None),
        ] {
            assert_eq!(wanted_priority(environment), expected);
        }
    }

    #[test]
    fn a_priority_that_was_refused_is_a_warning() {
        assert_eq!(judge("`x`", 80, (80, 1)).severity, Severity::Ok);
        assert_eq!(judge("`x`", 80, (0, 0)).severity, Severity::Warning);
        assert_eq!(judge("`x`", 80, (70, 1)).severity, Severity::Warning);
        let own = fs::read_to_string("/proc/self/stat").unwrap();
        assert!(scheduling(&own).is_some());
    }
}
