//! Limits of this user: real-time priority, locked memory.

use super::{Examined, Finding};
use crate::process::has_bit;
use rustix::process::{Resource, Rlimit, getrlimit};
use scl_terminal::bytes_text;
use std::fs;

const PRIORITY: &str = "real-time priority";
const MEMORY: &str = "locked memory";

pub(super) fn check(_examined: &Examined<'_>) -> Vec<Finding> {
    vec![judge_priority(getrlimit(Resource::Rtprio), Kernel::read()), judge_memory(getrlimit(Resource::Memlock))]
}

/// What decides about real-time priority besides the limit.
#[derive(Debug, Clone, Copy)]
struct Kernel {
    /// Whether this process has `CAP_SYS_NICE`, to which the limit does not apply.
    may_exceed: bool,
    /// `kernel.sched_rt_runtime_us`: microseconds of each period for real-time programs, -1 for all; 0 forbids them.
    runtime: Option<i64>,
    /// The same for this process's control group, if the kernel divides real-time among groups.
    group_runtime: Option<i64>,
}

impl Kernel {
    fn read() -> Self {
        let number = |path: &str| fs::read_to_string(path).ok()?.trim().parse().ok();
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        let groups = fs::read_to_string("/proc/self/cgroup").unwrap_or_default();
        Self {
            may_exceed: has_bit(&status, "CapEff:", CAP_SYS_NICE),
            runtime: number("/proc/sys/kernel/sched_rt_runtime_us"),
            group_runtime: processor_group(&groups)
                .and_then(|group| number(&format!("/sys/fs/cgroup/cpu{group}/cpu.rt_runtime_us"))),
        }
    }
}

/// As in `capabilities(7)`.
const CAP_SYS_NICE: u32 = 23;

/// Finds the path of the cgroup (v1, controller `cpu`) in the text of `/proc/<pid>/cgroup`. cgroup v2 does not divide
/// real-time.
fn processor_group(groups: &str) -> Option<&str> {
    groups.lines().find_map(|line| {
        let (_, rest) = line.split_once(':')?;
        let (controllers, path) = rest.split_once(':')?;
        controllers.split(',').any(|controller| controller == "cpu").then_some(path)
    })
}

/// Judges whether real-time priorities are allowed, by the rules of `sched_setscheduler(2)`.
fn judge_priority(limit: Rlimit, kernel: Kernel) -> Finding {
    if kernel.runtime == Some(0) {
        return Finding::warning(PRIORITY, "the kernel gives real-time programs no time, so `SCL_SCHED` has no effect")
            .help("allow it with `sysctl kernel.sched_rt_runtime_us=950000`");
    }
    if kernel.group_runtime == Some(0) {
        let text = "this control group has no real-time budget, so `SCL_SCHED` has no effect in it";
        return Finding::warning(PRIORITY, text)
            .help("write a budget to `cpu.rt_runtime_us` of the group and those above it");
    }
    match limit.current {
        _ if kernel.may_exceed => Finding::ok(PRIORITY, "allowed up to 99 by `cap_sys_nice`"),
        Some(0) => Finding::note(PRIORITY, "not allowed, so `SCL_SCHED` has no effect without `cap_sys_nice`")
            .help("to allow it, add `<user> - rtprio 99` to /etc/security/limits.conf and log in again"),
        Some(highest) => Finding::ok(PRIORITY, format!("allowed up to {}", highest.min(99))),
        None => Finding::ok(PRIORITY, "allowed up to 99"),
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

    const KERNEL: Kernel = Kernel { may_exceed: false, runtime: Some(950_000), group_runtime: None };

    fn limit(current: Option<u64>) -> Rlimit {
        Rlimit { current, maximum: None }
    }

    #[test]
    fn limits_are_judged() {
        let cases = [
            (judge_priority(limit(Some(0)), KERNEL), Severity::Note),
            (judge_priority(limit(Some(80)), KERNEL), Severity::Ok),
            (judge_priority(limit(None), KERNEL), Severity::Ok),
            (judge_priority(limit(Some(0)), Kernel { may_exceed: true, ..KERNEL }), Severity::Ok),
            (judge_priority(limit(None), Kernel { may_exceed: true, runtime: Some(0), ..KERNEL }), Severity::Warning),
            (judge_priority(limit(None), Kernel { group_runtime: Some(0), ..KERNEL }), Severity::Warning),
            (judge_priority(limit(Some(0)), Kernel { runtime: Some(-1), ..KERNEL }), Severity::Note),
            (judge_memory(limit(Some(8 << 20))), Severity::Note),
            (judge_memory(limit(None)), Severity::Ok),
        ];
        for (finding, expected) in cases {
            assert_eq!(finding.severity, expected, "{finding:?}");
            assert_eq!(finding.help.is_some(), expected > Severity::Ok, "{finding:?}");
        }
    }

    #[test]
    fn what_the_kernel_says_is_read() {
        let status = "Name:\tscl\nCapPrm:\t0000000000000000\nCapEff:\t0000000000800000\n";
        assert!(has_bit(status, "CapEff:", CAP_SYS_NICE));
        assert!(!has_bit(status, "CapEff:", CAP_SYS_NICE + 1));
        assert!(!has_bit("Name:\tscl\n", "CapEff:", CAP_SYS_NICE));
        assert_eq!(processor_group("4:memory:/a\n3:cpu,cpuacct:/user/x\n0::/b\n"), Some("/user/x"));
        assert_eq!(processor_group("0::/b\n"), None);
    }
}
