//! The number of allocations per message in each role, in the steady state.
//!
//! This process plays one role, a worker plays the opposite one, so that the allocations of this process are those of
//! one role. Everything in this process is counted, including the threads of SCL and of the runtime.

mod components;
mod near;
mod peer;
mod reading;

pub(crate) use peer::run_peer;

use crate::report::{Column, Report, Row, Table};
use crate::runtime::start_runtime;
use crate::scratch::ScratchFolder;
use near::Near;

/// Enough to fill all queues, so that no buffer grows afterwards.
const WARM_UP: usize = 5_000;

/// Returns how often this process has allocated memory so far; from a counting allocator of the calling program.
pub type AllocationCounter = fn() -> u64;

/// What this process does: its name between the processes, and in the report.
struct Role {
    id: &'static str,
    name: &'static str,
}

const ROLES: [Role; 8] = [
    Role { id: "publish", name: "SCL pub" },
    Role { id: "subscribe", name: "SCL sub" },
    Role { id: "push", name: "SCL push" },
    Role { id: "pull", name: "SCL pull" },
    Role { id: "request", name: "SCL req" },
    Role { id: "reply", name: "SCL rep" },
    Role { id: "publish-and-subscribe", name: "SCL pub and sub, in turn" },
    Role { id: "unix", name: "Unix socket, round trip" },
];

/// Counts the allocations of this process per 1000 messages of 20 bytes, for all roles.
///
/// # Errors
///
/// The folder for temporary files cannot be used, a process cannot be started, or a connection fails.
pub fn measure_allocations(messages: usize, counter: AllocationCounter) -> scl::Result<Report> {
    let title =
        format!("allocations per 1000 messages of {} bytes ({messages} counted)", size_of::<reading::Reading>());
    let mut table = Table::new(title, &[Column::plain("async"), Column::plain("blocking")]);
    for role in &ROLES {
        let allocations = [false, true].map(|is_blocking| count_allocations(role, is_blocking, messages, counter));
        let [in_async, in_blocking] = allocations;
        let values = [in_async?, in_blocking?].map(|allocations| allocations as f64 * 1000.0 / messages as f64);
        table.add(Row::new(role.name, values.to_vec()));
    }
    let mut report = Report::new("allocations");
    report.add(table);
    Ok(report)
}

fn count_allocations(role: &Role, is_blocking: bool, messages: usize, counter: AllocationCounter) -> scl::Result<u64> {
    let folder = ScratchFolder::new()?;
    let runtime = start_runtime()?;
    let mut near = Near::open(&runtime, role.id, is_blocking, folder.path())?;
    near.exchange(&runtime, WARM_UP)?;
    let before = counter();
    near.exchange(&runtime, messages)?;
    Ok(counter() - before)
}
