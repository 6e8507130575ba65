//! Makes the network library read and write its connections on one thread.
//!
//! In zenoh 1.10, one task reads from a TLS connection and another one writes to it, without a lock, though both change
//! the TLS state. On two threads that is a data race: under load, healthy connections break with "handshake not
//! complete" several times per second. The library's threads can only be configured through an environment variable,
//! which a running program cannot set safely. So this program executes itself again, as the same process.

use scl_terminal::Problem;
use std::os::unix::process::CommandExt;
use std::process::Command;

const VARIABLE: &str = "ZENOH_RUNTIME";
const VALUE: &str = "(rx: (handover: tx), tx: (worker_threads: 1))";

/// Returns if the environment variable is set; otherwise sets it and executes the program again.
///
/// # Errors
///
/// The program cannot execute itself again.
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
