//! Lets the network library read and write its connections on one thread.
//!
//! Its TLS connections (zenoh 1.10) are used by one task that reads and one that writes, without a lock between them,
//! though both change the state of TLS. On two threads that is a data race: under load, healthy connections end with
//! "handshake not complete" several times in a second. The library takes its threads from an environment variable
//! alone, which a running program cannot set safely. So this program starts itself again, as the same process.

use scl_terminal::Problem;
use std::os::unix::process::CommandExt;
use std::process::Command;

const VARIABLE: &str = "ZENOH_RUNTIME";
const VALUE: &str = "(rx: (handover: tx), tx: (worker_threads: 1))";

/// Returns if the variable is set, as it is after the program has started itself again.
///
/// # Errors
///
/// The program cannot start itself.
pub(crate) fn ensure() -> Result<(), Problem> {
    if std::env::var_os(VARIABLE).is_some_and(|value| value == VALUE) {
        return Ok(());
    }
    // Not the file's path: a newer version may have replaced it in the meantime.
    let mut command = Command::new("/proc/self/exe");
    command.args(std::env::args_os().skip(1)).env(VARIABLE, VALUE);
    if let Some(name) = std::env::args_os().next() {
        command.arg0(name);
    }
    Err(Problem::new(format!("cannot start the gateway with one thread for its connections: {}", command.exec())))
}
