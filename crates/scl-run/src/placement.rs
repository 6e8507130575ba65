//! The processors, the priority and the limit of descriptors of a program, set by `scl __start` before it becomes the
//! program, so that they apply from its first moment, to all of its threads, and to programs in any language.
//!
//! If the operating system refuses a setting, that is only a warning, so that one launch file works on the vehicle and
//! on a desktop.

use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use rustix::thread::CpuSet;
use scl_terminal::print_err;
use thread_priority::{
    RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
    set_thread_priority_and_policy, thread_native_id,
};

/// Where and with which priority a program runs.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Placement {
    /// The processors that it may use, counted from 0; all if empty.
    pub cpu: Vec<usize>,
    /// Its priority in `SCHED_FIFO`, 1 to 99; an ordinary program if `None`.
    pub fifo: Option<u8>,
    /// How many file descriptors it may open; as many as `scl run` if `None`.
    pub descriptors: Option<u64>,
}

impl Placement {
    /// The options of `scl __start` for it.
    pub(crate) fn arguments(&self) -> Vec<String> {
        let cpu = self.cpu.iter().flat_map(|cpu| ["--cpu".to_owned(), cpu.to_string()]);
        let fifo = self.fifo.iter().flat_map(|fifo| ["--fifo".to_owned(), fifo.to_string()]);
        let descriptors = self.descriptors.iter().flat_map(|most| ["--descriptors".to_owned(), most.to_string()]);
        cpu.chain(fifo).chain(descriptors).collect()
    }

    /// Applies the placement to the calling thread, which becomes the program. Returns a variable for the program:
    /// `SCL_SCHED` makes an SCL program lock its memory, too. It is not set without the privileges, because the program
    /// would only warn a second time.
    pub(crate) fn apply(&self) -> Option<(&'static str, String)> {
        if !self.cpu.is_empty() {
            self.pin();
        }
        self.descriptors.iter().for_each(|most| limit_descriptors(*most));
        let fifo = self.fifo?;
        match schedule(fifo) {
            Ok(()) => Some(("SCL_SCHED", format!("fifo:{fifo}"))),
            Err(error) => {
                print_err(&format!(
                    "scl: `priority: fifo:{fifo}` has no effect: {error}; it needs the capability `cap_sys_nice`, or a \
                     limit `rtprio` of {fifo} or more\n"
                ));
                None
            }
        }
    }

    fn pin(&self) {
        let mut set = CpuSet::new();
        self.cpu.iter().filter(|cpu| **cpu < CpuSet::MAX_CPU).for_each(|cpu| set.set(*cpu));
        if let Err(error) = rustix::thread::sched_setaffinity(None, &set) {
            let cpu = &self.cpu;
            print_err(&format!(
                "scl: `cpu: {cpu:?}` has no effect: {error}; `nproc --all` shows how many processors there are\n"
            ));
        }
    }
}

/// Sets the limit of descriptors. It is raised only on request: a program that calls `select` with a descriptor above
/// 1023 overwrites its own memory.
fn limit_descriptors(most: u64) {
    let hard = getrlimit(Resource::Nofile).maximum;
    let current = hard.map_or(most, |hard| most.min(hard));
    let error = setrlimit(Resource::Nofile, Rlimit { current: Some(current), maximum: hard }).err();
    let why = match error {
        Some(error) => error.to_string(),
        None if current < most => format!("the hard limit is {current}; `LimitNOFILE=` in a unit raises it"),
        None => return,
    };
    print_err(&format!("scl: `descriptors: {most}` was not fully applied: {why}\n"));
}

fn schedule(priority: u8) -> Result<(), String> {
    let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    let value = ThreadPriority::Crossplatform(ThreadPriorityValue::try_from(priority)?);
    set_thread_priority_and_policy(thread_native_id(), value, policy).map_err(|error| error.to_string())
}
