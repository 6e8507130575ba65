//! Real-time priority, a processor of its own and locked memory, requested through the environment of `#[scl::main]`.

use crate::programs::STEADY;
use scl_tests::{Process, System};

const REQUESTED: [(&str, &str); 2] = [("SCL_SCHED", "fifo:80"), ("SCL_CPU", "0")];
/// Bits of `CapEff` in `/proc/PID/status`.
const CAP_IPC_LOCK: u64 = 14;
const CAP_SYS_NICE: u64 = 23;

/// Which of the two outcomes is asserted depends on the privileges of the test.
#[test]
fn a_privileged_program_gets_real_time_priority() {
    let mut steady = System::new().start_with(STEADY, &[], &REQUESTED);
    steady.expect("open");
    assert_eq!(steady.status("Cpus_allowed_list"), "0");
    if has_capability(&steady, CAP_SYS_NICE) {
        assert_eq!((&*steady.scheduling_policy(), &*steady.realtime_priority()), ("1", "80"));
    } else {
        assert_eq!(steady.scheduling_policy(), "0");
    }
    let locked = steady.status("VmLck") != "0 kB";
    assert!(locked || !has_capability(&steady, CAP_IPC_LOCK), "{}", steady.status("VmLck"));
}

#[test]
fn a_program_without_privileges_warns_and_continues() {
    let limits = "ulimit -r 0; ulimit -l 64";
    let drop_privileges = "setpriv --bounding-set=-all --inh-caps=-all --ambient-caps=-all";
    let script = format!("{limits}; exec {drop_privileges} {STEADY}");
    let mut steady = System::new().start_with("bash", &["-c", &script], &REQUESTED);
    steady.expect("open");
    let priority = steady.expect_log("SCL_SCHED=fifo:80");
    assert!(priority.contains("cap_sys_nice"), "{priority}");
    let memory = steady.expect_log("memory");
    assert!(memory.contains("cap_ipc_lock"), "{memory}");
    assert_eq!(steady.scheduling_policy(), "0");
}

#[test]
fn a_request_that_makes_no_sense_is_an_error() {
    let exit = System::new().start_with(STEADY, &[], &[("SCL_SCHED", "fast")]).wait_for_exit();
    assert_eq!(exit.code(), 1, "{exit:?}");
    assert!(exit.text().contains("`SCL_SCHED=fast`") && exit.text().contains("`fifo:1`"), "{exit:?}");
}

fn has_capability(process: &Process, capability: u64) -> bool {
    let effective = u64::from_str_radix(&process.status("CapEff"), 16).expect("a number");
    effective >> capability & 1 == 1
}
