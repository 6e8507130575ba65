//! File descriptors: how many a process may open, and what components have and need.

use super::{Examined, Finding};
use rustix::process::{Resource, Rlimit, getrlimit};
use scl_plan::{GateKind, Plan};
use scl_terminal::escape;
use std::fs;

const CHECK: &str = "file descriptors";

/// Limits below this are reported: a component has a handful of descriptors, and some for each connection.
const USUAL: u64 = 1024;

/// Descriptors of a component without gates: standard streams, timers, files in the runtime folder and its watch.
const COMPONENT: u64 = 15;
/// Descriptors of a listening end: its socket, the file of its name, and one in reserve.
const LISTENER: u64 = 3;
/// Descriptors of a connection.
const CONNECTION: u64 = 1;

pub(super) fn check(examined: &Examined<'_>) -> Vec<Finding> {
    let own = getrlimit(Resource::Nofile);
    let mut findings = vec![judge_limit(own)];
    for (system, components) in &examined.systems {
        for component in components {
            let name = format!("`{}` of system `{}`", escape(&component.name), escape(system.name()));
            let process = component.process_id().filter(|_| component.is_running());
            let open = process.and_then(open_in);
            // A component that is not running would get the limit of this shell.
            let limit = process.map_or(own.current, limit_of);
            let needed = component.plan().map(needed_by);
            findings.extend(limit.and_then(|limit| judge_use(&name, open, needed, limit)));
        }
    }
    findings
}

fn judge_limit(limit: Rlimit) -> Finding {
    match limit.current {
        Some(current) if current < USUAL => {
            Finding::warning(CHECK, format!("a process may open {current}, which is few for many connections"))
                .help("raise it with `ulimit -n`")
        }
        Some(current) => Finding::ok(CHECK, format!("a process may open {current}")),
        None => Finding::ok(CHECK, "not limited"),
    }
}

/// The number of open descriptors of a process.
fn open_in(pid: u32) -> Option<u64> {
    Some(fs::read_dir(format!("/proc/{pid}/fd")).ok()?.count() as u64)
}

/// How many descriptors a process may open; `None` if that is not known or not limited.
fn limit_of(pid: u32) -> Option<u64> {
    let limits = fs::read_to_string(format!("/proc/{pid}/limits")).ok()?;
    let limit = limits.lines().find_map(|line| line.strip_prefix("Max open files"))?;
    limit.split_whitespace().next()?.parse().ok()
}

/// How many descriptors a component needs for its gates when all its peers are connected; its program may open more.
fn needed_by(plan: &Plan) -> u64 {
    let gates = plan.gates.iter().map(|gate| {
        let connections = gate.connections.len() as u64;
        let ends = match gate.kind {
            // One listener per connection, and one for the tap.
            GateKind::Pub => LISTENER * connections + LISTENER,
            GateKind::Pull | GateKind::Rep => LISTENER + LISTENER,
            GateKind::Sub | GateKind::Push | GateKind::Req => 0,
        };
        ends + CONNECTION * connections
    });
    COMPONENT + gates.sum::<u64>()
}

fn judge_use(component: &str, open: Option<u64>, needed: Option<u64>, limit: u64) -> Option<Finding> {
    if let Some(needed) = needed.filter(|needed| *needed > limit) {
        let text = format!("{component} needs {needed} when all its peers are connected, but may open only {limit}");
        return Some(
            Finding::warning(CHECK, text)
                .help("raise the limit before it starts: `descriptors` in the launch file, `ulimit -n`, or `LimitNOFILE=` in a unit of systemd"),
        );
    }
    let open = open.filter(|open| open.saturating_mul(10) > limit.saturating_mul(8))?;
    Some(
        Finding::warning(CHECK, format!("{component} has {open} open, of at most {limit}"))
            .help("raise its limit with `ulimit -n`, or find what it opens and never closes"),
    )
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
        for (current, expected) in [(Some(256), Severity::Warning), (Some(1024), Severity::Ok), (None, Severity::Ok)] {
            let finding = judge_limit(limit(current));
            assert_eq!(finding.severity, expected, "{finding:?}");
            assert_eq!(finding.help.is_some(), expected > Severity::Ok, "{finding:?}");
        }
        let own = std::process::id();
        assert!((1..=limit_of(own).unwrap()).contains(&open_in(own).unwrap()));
    }

    #[test]
    fn what_is_open_and_what_is_needed_is_judged() {
        for (open, needed, expected) in [
            (Some(80), Some(100), None),
            (Some(81), Some(100), Some("`x` has 81 open, of at most 100")),
            (Some(81), None, Some("`x` has 81 open, of at most 100")),
            (Some(20), Some(101), Some("`x` needs 101 when all its peers are connected, but may open only 100")),
            (None, Some(101), Some("`x` needs 101 when all its peers are connected, but may open only 100")),
            (None, None, None),
        ] {
            let finding = judge_use("`x`", open, needed, 100);
            assert_eq!(finding.as_ref().map(|finding| finding.message.as_str()), expected);
            assert!(finding.is_none_or(|finding| finding.help.is_some()));
        }
    }
}
