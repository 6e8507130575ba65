//! Real-time priority, a processor of its own and locked memory, as the environment of `#[scl::main]` asks for them.

use scl_tests::{Place, Process};

const STEADY: &str = env!("CARGO_BIN_EXE_steady");
const WISHES: [(&str, &str); 2] = [("SCL_SCHED", "fifo:80"), ("SCL_CPU", "0")];
/// Bits of `CapEff` in `/proc/PID/status`.
const CAP_IPC_LOCK: u64 = 14;
const CAP_SYS_NICE: u64 = 23;

/// What the test may do itself decides which of the two it can see; each is asserted.
#[test]
fn a_program_that_may_have_real_time_priority_has_it() {
    let place = Place::new("ipc");
    let mut steady = place.start_with(STEADY, &[], &WISHES);
    steady.says_sometime("open");
    assert_eq!(steady.status("Cpus_allowed_list"), "0");
    if may(&steady, CAP_SYS_NICE) {
        assert_eq!((steady.policy().as_str(), steady.priority().as_str()), ("1", "80"));
    } else {
        assert_eq!(steady.policy(), "0");
    }
    let locked = steady.status("VmLck") != "0 kB";
    assert!(locked || !may(&steady, CAP_IPC_LOCK), "{}", steady.status("VmLck"));
}

#[test]
fn a_program_that_may_not_warns_and_goes_on() {
    let place = Place::new("ipc");
    let limits = "ulimit -r 0; ulimit -l 64";
    let drop_rights = "setpriv --bounding-set=-all --inh-caps=-all --ambient-caps=-all";
    let script = format!("{limits}; exec {drop_rights} {STEADY}");
    let mut steady = place.start_with("bash", &["-c", &script], &WISHES);
    // Warnings and output are two streams, so their order is open.
    let mut said = [steady.line(), steady.line(), steady.line()];
    said.sort_by_key(|line| (line != "open", line.contains("memory")));
    let [open, priority, memory] = said;
    assert_eq!(open, "open");
    assert!(priority.contains("`SCL_SCHED=fifo:80` has no effect") && priority.contains("cap_sys_nice"), "{priority}");
    assert!(memory.contains("cannot be locked") && memory.contains("cap_ipc_lock"), "{memory}");
    assert_eq!(steady.policy(), "0");
}

#[test]
fn a_wish_that_says_nothing_is_an_error() {
    let place = Place::new("ipc");
    let (status, said) = place.start_with(STEADY, &[], &[("SCL_SCHED", "fast")]).ends();
    assert!(!status.success());
    assert_eq!(said, ["error: `SCL_SCHED=fast` is not understood; write one of: `fifo:1` to `fifo:99`"]);
}

fn may(process: &Process, capability: u64) -> bool {
    let effective = u64::from_str_radix(&process.status("CapEff"), 16).expect("a number");
    effective >> capability & 1 == 1
}
