//! Limits of this user: file descriptors, real-time priority, locked memory.

use super::{Examined, Finding};
use rustix::process::{Resource, Rlimit, getrlimit};
use scl_terminal::bytes_text;
use std::fs;

const DESCRIPTORS: &str = "file descriptors";
const PRIORITY: &str = "real-time priority";
const MEMORY: &str = "locked memory";

/// A component has a handful of descriptors, and some for each connection.
const USUAL_DESCRIPTORS: u64 = 1024;

pub(super) fn check(examined: &Examined<'_>) -> Vec<Finding> {
    let mut findings = vec![judge_descriptors(getrlimit(Resource::Nofile))];
    for (system, component, pid) in examined.running() {
        let name = format!("`{}` of system `{}`", component.name, system.name());
        findings.extend(pid.and_then(descriptors_of).and_then(|(open, limit)| judge_use(&name, open, limit)));
    }
    findings.push(judge_priority(getrlimit(Resource::Rtprio)));
    findings.push(judge_memory(getrlimit(Resource::Memlock)));
    findings
}

fn judge_descriptors(limit: Rlimit) -> Finding {
    match limit.current {
        Some(current) if current < USUAL_DESCRIPTORS => {
            Finding::warning(DESCRIPTORS, format!("a process may open {current}, which is few for many connections"))
                .help("raise it with `ulimit -n`")
        }
        Some(current) => Finding::ok(DESCRIPTORS, format!("a process may open {current}")),
        None => Finding::ok(DESCRIPTORS, "not limited"),
    }
}

/// The number of open descriptors of a process, and its limit.
fn descriptors_of(pid: u32) -> Option<(u64, u64)> {
    let open = fs::read_dir(format!("/proc/{pid}/fd")).ok()?.count() as u64;
    let limits = fs::read_to_string(format!("/proc/{pid}/limits")).ok()?;
    let limit = limits.lines().find_map(|line| line.strip_prefix("Max open files"))?;
    Some((open, limit.split_whitespace().next()?.parse().ok()?))
}

fn judge_use(component: &str, open: u64, limit: u64) -> Option<Finding> {
    (open.saturating_mul(10) > limit.saturating_mul(8)).then(|| {
        Finding::warning(DESCRIPTORS, format!("{component} has {open} open, of at most {limit}"))
            .help("raise its limit with `ulimit -n`, or find what it opens and never closes")
    })
}

fn judge_priority(limit: Rlimit) -> Finding {
    match limit.current {
        Some(0) => Finding::note(PRIORITY, "not allowed, so `SCL_SCHED` has no effect without `cap_sys_nice`")
            .help("to allow it, add `<user> - rtprio 99` to /etc/security/limits.conf and log in again"),
        Some(highest) => Finding::ok(PRIORITY, format!("allowed up to {highest}")),
        None => Finding::ok(PRIORITY, "not limited"),
    }
}

fn judge_memory(limit: Rlimit) -> Finding {
    match limit.current {
        Some(bytes) => {
            let text = format!("limited to {}, so real-time components do not lock theirs", bytes_text(bytes as f64));
            Finding::note(MEMORY, format!("{text} without `cap_ipc_lock`"))
                .help("to allow it, add `<user> - memlock unlimited` to /etc/security/limits.conf and log in again")
        }
        None => Finding::ok(MEMORY, "not limited"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::Severity;
    use super::*;

    fn limit(current: Option<u64>) -> Rlimit {
        Rlimit { current, maximum: None }
    }

    #[test]
    fn limits_are_judged() {
        let cases = [
            (judge_descriptors(limit(Some(256))), Severity::Warning),
            (judge_descriptors(limit(Some(1024))), Severity::Ok),
            (judge_descriptors(limit(None)), Severity::Ok),
            (judge_priority(limit(Some(0))), Severity::Note),
            (judge_priority(limit(Some(80))), Severity::Ok),
            (judge_memory(limit(Some(8 << 20))), Severity::Note),
            (judge_memory(limit(None)), Severity::Ok),
        ];
        for (finding, expected) in cases {
            assert_eq!(finding.severity, expected, "{finding:?}");
            assert_eq!(finding.help.is_some(), expected > Severity::Ok, "{finding:?}");
        }
        assert_eq!(judge_use("`x`", 80, 100), None);
        assert_eq!(judge_use("`x`", 81, 100).unwrap().severity, Severity::Warning);
        let (open, limit) = descriptors_of(std::process::id()).unwrap();
        assert!(0 < open && open <= limit);
    }
}
