//! Real-time priority, CPU affinity and locked memory, as set in the environment of a program.
//!
//! Without the privileges, the program logs a warning and continues, so one launch file works on the vehicle and on a
//! desktop.

use crate::environment::{self, Variables};
use crate::error::OpenError;
use rustix::mm::MlockAllFlags;
use rustix::process::Resource;
use rustix::thread::{CapabilitySet, CpuSet};
use thread_priority::{
    RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
    set_thread_priority_and_policy, thread_native_id,
};

/// The real-time settings of the environment.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Settings {
    /// `SCL_SCHED=fifo:80`: the priority, 1 to 99.
    fifo: Option<u8>,
    /// `SCL_CPU=1`: the processor, counted from 0.
    cpu: Option<usize>,
}

impl Settings {
    /// Reads `SCL_SCHED` and `SCL_CPU`.
    ///
    /// # Errors
    /// [`OpenError::Environment`] for a value that is not understood.
    pub(crate) fn read(variables: Variables<'_>) -> Result<Self, OpenError> {
        let fifo =
            |value: &str| value.strip_prefix("fifo:")?.parse().ok().filter(|priority| (1..=99).contains(priority));
        let cpu = |value: &str| value.parse().ok().filter(|cpu| *cpu < CpuSet::MAX_CPU);
        Ok(Self {
            fifo: environment::read(variables, "SCL_SCHED", "`fifo:1` to `fifo:99`", fifo)?,
            cpu: environment::read(variables, "SCL_CPU", "the number of a processor, counted from 0", cpu)?,
        })
    }

    /// Applies the settings to the calling thread and to those that it starts from now on. If any is set, locks the
    /// memory of the program as well. Logs a warning for each step that the operating system refuses.
    pub(crate) fn apply(&self) {
        if let Some(cpu) = self.cpu {
            pin(cpu);
        }
        if let Some(priority) = self.fifo {
            schedule(priority);
        }
        if *self != Self::default() {
            lock_memory();
        }
    }
}

fn pin(cpu: usize) {
    let mut one = CpuSet::new();
    one.set(cpu);
    if let Err(error) = rustix::thread::sched_setaffinity(None, &one) {
        tracing::warn!("`SCL_CPU={cpu}` has no effect: {error}; `nproc --all` shows how many processors there are");
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
            "`SCL_SCHED=fifo:{priority}` has no effect: {error}; the program needs the capability `cap_sys_nice`, \
             or its user a limit `rtprio` of {priority} or more"
        );
    }
}

/// Locks all memory of the program, present and future, each page on its first use.
fn lock_memory() {
    let limited = rustix::process::getrlimit(Resource::Memlock).current.is_some();
    let capable = rustix::thread::capabilities(None).is_ok_and(|sets| sets.effective.contains(CapabilitySet::IPC_LOCK));
    // With RLIMIT_MEMLOCK set, MCL_FUTURE would make later allocations fail and abort the program.
    let locked = if limited && !capable {
        Err("its size is limited".to_owned())
    } else {
        // Lock pages on first use, so that reserved but unused memory stays cheap.
        let flags = MlockAllFlags::CURRENT | MlockAllFlags::FUTURE | MlockAllFlags::ONFAULT;
        rustix::mm::mlockall(flags).map_err(|error| error.to_string())
    };
    if let Err(error) = locked {
        tracing::warn!(
            "memory cannot be locked: {error}; the program needs the capability `cap_ipc_lock`, or its user an \
             unlimited `memlock`"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::refused;

    #[test]
    fn settings_are_read_or_refused() {
        let not_sched = |value: &str| Err(format!("SCL_SCHED={value}, not `fifo:1` to `fifo:99`"));
        let not_cpu = |value: &str| Err(format!("SCL_CPU={value}, not the number of a processor, counted from 0"));
        let cases = [
            ("", "", Ok((None, None))),
            ("fifo:80", "", Ok((Some(80), None))),
            ("fifo:1", "3", Ok((Some(1), Some(3)))),
            ("", "0", Ok((None, Some(0)))),
            ("fifo:0", "", not_sched("fifo:0")),
            ("fifo:100", "", not_sched("fifo:100")),
            ("rr:5", "", not_sched("rr:5")),
            ("", "-1", not_cpu("-1")),
            ("", "99999999", not_cpu("99999999")),
        ];
        for (sched, cpu, expected) in cases {
            let variables = |name: &str| match name {
                "SCL_SCHED" => Some(sched.into()),
                "SCL_CPU" => Some(cpu.into()),
                _ => None,
            };
            let read = refused(Settings::read(&variables)).map(|settings| (settings.fifo, settings.cpu));
            assert_eq!(read, expected, "{sched} {cpu}");
        }
    }
}
