//! The log that `#[scl::main]` writes to standard error.

use crate::environment::{self, Variables};
use crate::error::OpenError;
use crate::sync::on_living_thread;
use tracing::level_filters::LevelFilter;

/// Reads `SCL_LOG`: the most detailed level that is logged.
///
/// # Errors
/// [`OpenError::Environment`] if the value is not a level.
pub(crate) fn level(variables: Variables<'_>) -> Result<LevelFilter, OpenError> {
    let expected = "`error`, `warn`, `info`, `debug`, `trace` or `off`";
    // Rejects numbers and other spellings, which `LevelFilter` would parse as well.
    let parse = |word: &str| word.parse().ok().filter(|level: &LevelFilter| level.to_string() == word);
    Ok(environment::read(variables, "SCL_LOG", expected, parse)?.unwrap_or(LevelFilter::WARN))
}

/// Logs a warning about the end of a component, on another thread if the calling thread is ending: there, a log that
/// uses a destroyed thread-local value would panic.
pub(crate) fn warn(text: &str) {
    on_living_thread(|| tracing::warn!("{text}"));
}

/// Does nothing: without the feature `logging`, the program chooses what happens to its log.
#[cfg(not(feature = "logging"))]
pub(crate) fn start(_level: LevelFilter) {}

/// Writes the log to standard error, unless the program has already set up a log of its own.
#[cfg(feature = "logging")]
pub(crate) fn start(level: LevelFilter) {
    use std::io::IsTerminal;
    let colour = use_colour(std::io::stderr().is_terminal(), &environment::of_process);
    let log = tracing_subscriber::fmt().with_writer(std::io::stderr).with_max_level(level).with_ansi(colour);
    let _already_set = log.with_target(false).without_time().try_init();
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
    use crate::environment::refused;

    #[test]
    fn a_level_is_read_or_refused() {
        let cases = [
            ("", Ok(LevelFilter::WARN)),
            ("off", Ok(LevelFilter::OFF)),
            ("error", Ok(LevelFilter::ERROR)),
            ("warn", Ok(LevelFilter::WARN)),
            ("info", Ok(LevelFilter::INFO)),
            ("debug", Ok(LevelFilter::DEBUG)),
            ("trace", Ok(LevelFilter::TRACE)),
            ("loud", Err("SCL_LOG=loud, not `error`, `warn`, `info`, `debug`, `trace` or `off`")),
            ("3", Err("SCL_LOG=3, not `error`, `warn`, `info`, `debug`, `trace` or `off`")),
        ];
        for (value, expected) in cases {
            let variables = |name: &str| (name == "SCL_LOG").then(|| value.into());
            assert_eq!(refused(level(&variables)), expected.map_err(str::to_owned));
        }
    }

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
