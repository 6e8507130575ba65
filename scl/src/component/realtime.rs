//! Real-time priority, a processor of its own, memory that stays: what a program asks for through its environment.
//!
//! A program that may not have them says so and goes on, so that the same launch file serves the vehicle and the desk.

use crate::error::OpenError;
use rustix::mm::MlockAllFlags;
use rustix::process::Resource;
use rustix::thread::{CapabilitySet, CpuSet};
use thread_priority::{
    RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
    set_thread_priority_and_policy, thread_native_id,
};

/// What the environment asks for.
#[derive(Debug, Default, PartialEq, Eq)]
struct Wishes {
    /// `SCL_SCHED=fifo:80`: the priority, 1 to 99.
    fifo: Option<u8>,
    /// `SCL_CPU=1`: the processor, counted from 0.
    cpu: Option<usize>,
}

/// Honours `SCL_SCHED` and `SCL_CPU` for the calling thread and those that it starts; with either, the program's memory
/// is locked.
///
/// # Errors
/// [`OpenError::Environment`] for a value that says nothing. What the system refuses is only warned of.
pub(super) fn honour_environment() -> Result<(), OpenError> {
    let wishes = Wishes::read(&|name| std::env::var_os(name).map(|value| value.to_string_lossy().into_owned()))?;
    if let Some(cpu) = wishes.cpu {
        pin(cpu);
    }
    if let Some(priority) = wishes.fifo {
        schedule(priority);
    }
    if wishes != Wishes::default() {
        lock_memory();
    }
    Ok(())
}

impl Wishes {
    fn read(variable: &dyn Fn(&'static str) -> Option<String>) -> Result<Self, OpenError> {
        let wish = |name| variable(name).filter(|value| !value.is_empty());
        let fifo =
            |value: &str| value.strip_prefix("fifo:")?.parse().ok().filter(|priority| (1..=99).contains(priority));
        let cpu = |value: &str| value.parse().ok().filter(|cpu| *cpu < CpuSet::MAX_CPU);
        Ok(Self {
            fifo: understood("SCL_SCHED", wish("SCL_SCHED"), fifo, "`fifo:1` to `fifo:99`")?,
            cpu: understood("SCL_CPU", wish("SCL_CPU"), cpu, "the number of a processor, counted from 0")?,
        })
    }
}

fn understood<T>(
    variable: &'static str,
    value: Option<String>,
    parse: impl Fn(&str) -> Option<T>,
    expected: &'static str,
) -> Result<Option<T>, OpenError> {
    let Some(value) = value else { return Ok(None) };
    match parse(&value) {
        Some(parsed) => Ok(Some(parsed)),
        None => Err(OpenError::Environment { variable, value, expected }),
    }
}

fn pin(cpu: usize) {
    let mut one = CpuSet::new();
    one.set(cpu);
    if let Err(error) = rustix::thread::sched_setaffinity(None, &one) {
        tracing::warn!("`SCL_CPU={cpu}` has no effect: {error}; `nproc --all` tells how many processors there are");
    }
}

fn schedule(priority: u8) {
    let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    let set = ThreadPriorityValue::try_from(priority).and_then(|value| {
        let value = ThreadPriority::Crossplatform(value);
        set_thread_priority_and_policy(thread_native_id(), value, policy).map_err(|error| error.to_string())
    });
    if let Err(error) = set {
        tracing::warn!(
            "`SCL_SCHED=fifo:{priority}` has no effect: {error}; the program needs the capability `cap_sys_nice`, or \
             its user a limit `rtprio` of {priority} or more"
        );
    }
}

/// Locks what the program has and will have, as soon as it is used.
fn lock_memory() {
    // With a limit, locking what is still to come would make a later allocation fail, and end the program.
    let limited = rustix::process::getrlimit(Resource::Memlock).current.is_some();
    let capable = rustix::thread::capabilities(None).is_ok_and(|sets| sets.effective.contains(CapabilitySet::IPC_LOCK));
    let locked = if limited && !capable {
        Err("its size is limited".to_owned())
    } else {
        // On first use: a peer that announces 8 GiB makes the library ask for them, and they shall cost nothing.
        let flags = MlockAllFlags::CURRENT | MlockAllFlags::FUTURE | MlockAllFlags::ONFAULT;
        rustix::mm::mlockall(flags).map_err(|error| error.to_string())
    };
    if let Err(error) = locked {
        tracing::warn!(
            "the memory cannot be locked: {error}; the program needs the capability `cap_ipc_lock`, or its user an \
             unlimited `memlock`"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_environment_is_read() {
        let cases = [
            ("", "", Ok((None, None))),
            ("fifo:80", "", Ok((Some(80), None))),
            ("fifo:1", "3", Ok((Some(1), Some(3)))),
            ("", "0", Ok((None, Some(0)))),
            ("fifo:0", "", Err("`SCL_SCHED=fifo:0` is not understood; write one of: `fifo:1` to `fifo:99`")),
            ("fifo:100", "", Err("`SCL_SCHED=fifo:100` is not understood; write one of: `fifo:1` to `fifo:99`")),
            ("rr:5", "", Err("`SCL_SCHED=rr:5` is not understood; write one of: `fifo:1` to `fifo:99`")),
            ("", "-1", Err("`SCL_CPU=-1` is not understood; write one of: the number of a processor, counted from 0")),
            (
                "",
                "99999999",
                Err("`SCL_CPU=99999999` is not understood; write one of: the number of a processor, counted from 0"),
            ),
        ];
        for (sched, cpu, expected) in cases {
            let variable = |name: &'static str| Some(if name == "SCL_SCHED" { sched } else { cpu }.to_owned());
            let read = Wishes::read(&variable).map(|wishes| (wishes.fifo, wishes.cpu));
            assert_eq!(read.map_err(|error| error.to_string()), expected.map_err(str::to_owned), "{sched} {cpu}");
        }
    }
}
