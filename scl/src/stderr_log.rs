//! The log that `#[scl::main]` writes to standard error.

#[cfg(any(feature = "logging", test))]
use crate::environment::{self, Variables};
use std::time::Duration;
use tracing::level_filters::LevelFilter;

/// Does nothing: without the feature `logging`, the program chooses what happens to its log.
#[cfg(not(feature = "logging"))]
pub(crate) fn start(_level: LevelFilter) {}

/// Does nothing: see [`start`].
#[cfg(not(feature = "logging"))]
pub(crate) fn end_events(_timeout: Duration) {}

/// Waits for the events that are on their way to a gate, but not longer than `timeout`, and drops the gate.
#[cfg(feature = "logging")]
pub(crate) fn end_events(timeout: Duration) {
    if !crate::events::end(timeout) {
        tracing::warn!("some events were not sent: the program has ended");
    }
}

/// Writes the log to standard error, unless the program has already set up a log of its own.
#[cfg(feature = "logging")]
pub(crate) fn start(level: LevelFilter) {
    use std::io::IsTerminal;
    use tracing_subscriber::prelude::*;
    let colour = use_colour(std::io::stderr().is_terminal(), &environment::of_process);
    let log = tracing_subscriber::fmt::layer().with_writer(std::io::stderr).with_ansi(colour);
    let log = log.with_target(false).without_time().with_filter(level);
    let _already_set = tracing_subscriber::registry().with(log).with(crate::events::layer()).try_init();
}

/// Returns true if the log is written in colour: only on terminals unless `CLICOLOR` or `CLICOLOR_FORCE` says otherwise
/// (<https://bixense.com/clicolors>), and never if `NO_COLOR` is set (<https://no-color.org>).
#[cfg(any(feature = "logging", test))]
fn use_colour(terminal: bool, variables: Variables<'_>) -> bool {
    let is_set = |name| variables(name).is_some_and(|value| !value.is_empty());
    let is_zero = |name| variables(name).is_some_and(|value| value == "0");
    let forced = is_set("CLICOLOR_FORCE") && !is_zero("CLICOLOR_FORCE");
    let wanted = terminal && !is_zero("CLICOLOR") && variables("TERM").is_none_or(|value| value != "dumb");
    !is_set("NO_COLOR") && (forced || wanted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colour_is_for_terminals_unless_the_environment_says_otherwise() {
        type Case<'a> = (bool, &'a [(&'a str, &'a str)], bool);
        let cases: [Case<'_>; 10] = [
            (true, &[], true),
            (false, &[], false),
            (true, &[("NO_COLOR", "")], true),
            (true, &[("NO_COLOR", "1")], false),
            (true, &[("CLICOLOR", "0")], false),
            (true, &[("CLICOLOR", "1")], true),
            (false, &[("CLICOLOR", "1")], false),
            (true, &[("TERM", "dumb")], false),
            (false, &[("CLICOLOR_FORCE", "1"), ("TERM", "dumb")], true),
            (false, &[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")], false),
        ];
        for (terminal, set, expected) in cases {
            let variables = |name: &str| set.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).into());
            assert_eq!(use_colour(terminal, &variables), expected, "{terminal} {set:?}");
        }
    }
}
