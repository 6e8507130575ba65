//! What worker processes do: one role per benchmark, selected by the first argument.

use crate::worker::{exit_when_input_closes, unknown_arguments};
use crate::{delay, fanout, fresh, one_way, restart, roundtrip};
use std::io::ErrorKind;

/// Runs a role with the arguments that follow its name.
type Role = fn(&[&str]) -> scl::Result<()>;

/// Runs the worker process that the arguments after [`WORKER_COMMAND`](crate::WORKER_COMMAND) select, until its
/// standard input is closed.
///
/// # Errors
///
/// The arguments are unknown, or the worker failed.
pub fn run_worker(arguments: &[String]) -> scl::Result<()> {
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let (role, rest): (Role, _) = match arguments.as_slice() {
        ["delay", rest @ ..] => (delay::run_source, rest),
        ["fanout", rest @ ..] => (fanout::run_subscriber, rest),
        ["fresh", rest @ ..] => (fresh::run_subscriber, rest),
        #[cfg(feature = "gateway")]
        ["gateway-growth", rest @ ..] => (crate::gateway_growth::run_far_host, rest),
        ["one-way", rest @ ..] => (one_way::run_receiver, rest),
        ["restart", rest @ ..] => (restart::run_restarted, rest),
        ["roundtrip", rest @ ..] => (roundtrip::run_echo, rest),
        _ => return Err(unknown_arguments(&arguments)),
    };
    exit_when_input_closes();
    role(rest).or_else(|error| if is_disconnect(&error) { Ok(()) } else { Err(error) })
}

/// Returns true if the peer has closed the connection: it is done, or reports its own failure.
fn is_disconnect(error: &scl::Error) -> bool {
    let kind = error.inner().downcast_ref().map(std::io::Error::kind);
    matches!(kind, Some(ErrorKind::UnexpectedEof | ErrorKind::BrokenPipe | ErrorKind::ConnectionReset))
}
