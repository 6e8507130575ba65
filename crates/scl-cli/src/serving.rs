//! What the commands that serve something over HTTP share.

use scl_observe::StopSignals;
use scl_terminal::{Problem, output_is_closed, print_out};
use std::fmt::Display;
use std::io;
use std::process::ExitCode;

/// A server could not listen at an address; `help` says how to choose another.
pub(crate) fn cannot_listen(address: impl Display, help: &str) -> impl FnOnce(io::Error) -> Problem {
    move |error| Problem::new(format!("cannot listen at {address}: {error}")).help(help)
}

/// Prints where it can be found, and serves until Ctrl-C or SIGTERM.
pub(crate) async fn serve_until_stopped(
    url: &str,
    serving: impl Future<Output = ()>,
    stop: &mut StopSignals,
) -> ExitCode {
    print_out(&format!("{url}\n"));
    if !output_is_closed() {
        tokio::select! {
            () = serving => {}
            () = stop.received() => {}
        }
    }
    ExitCode::SUCCESS
}
