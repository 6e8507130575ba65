//! The log that `#[scl::main]` writes to standard error.

use crate::environment::{self, Variables};
use crate::error::OpenError;

/// The most detailed messages that are logged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Level {
    Off,
    Error,
    #[default]
    Warn,
    Info,
    Debug,
    Trace,
}

impl Level {
    /// Reads `SCL_LOG`.
    ///
    /// # Errors
    /// [`OpenError::Environment`] if the value is not a level.
    pub(crate) fn read(variables: Variables<'_>) -> Result<Self, OpenError> {
        let expected = "`error`, `warn`, `info`, `debug`, `trace` or `off`";
        let level = environment::read(variables, "SCL_LOG", expected, |word| match word {
            "off" => Some(Self::Off),
            "error" => Some(Self::Error),
            "warn" => Some(Self::Warn),
            "info" => Some(Self::Info),
            "debug" => Some(Self::Debug),
            "trace" => Some(Self::Trace),
            _ => None,
        })?;
        Ok(level.unwrap_or_default())
    }
}

/// Without the feature `logging` the program chooses what happens to its log.
#[cfg(not(feature = "logging"))]
pub(crate) fn start(_level: Level) {}

/// Writes the log to standard error, unless the program has already set up a log of its own.
#[cfg(feature = "logging")]
pub(crate) fn start(level: Level) {
    use std::io::IsTerminal;
    use tracing_subscriber::filter::LevelFilter;
    let filter = match level {
        Level::Off => LevelFilter::OFF,
        Level::Error => LevelFilter::ERROR,
        Level::Warn => LevelFilter::WARN,
        Level::Info => LevelFilter::INFO,
        Level::Debug => LevelFilter::DEBUG,
        Level::Trace => LevelFilter::TRACE,
    };
    let colour = use_colour(std::io::stderr().is_terminal(), &environment::of_process);
    let log = tracing_subscriber::fmt().with_writer(std::io::stderr).with_max_level(filter).with_ansi(colour);
    let _already_set = log.with_target(false).without_time().try_init();
}

/// Colour only on terminals, and never if `NO_COLOR` is set (<https://no-color.org>).
#[cfg(any(feature = "logging", test))]
fn use_colour(terminal: bool, variables: Variables<'_>) -> bool {
    terminal && variables("NO_COLOR").is_none_or(|value| value.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::refused;

    #[test]
    fn a_level_is_read_or_refused() {
        let cases = [
            ("", Ok(Level::Warn)),
            ("off", Ok(Level::Off)),
            ("error", Ok(Level::Error)),
            ("warn", Ok(Level::Warn)),
            ("info", Ok(Level::Info)),
            ("debug", Ok(Level::Debug)),
            ("trace", Ok(Level::Trace)),
            ("loud", Err("SCL_LOG=loud, not `error`, `warn`, `info`, `debug`, `trace` or `off`")),
            ("3", Err("SCL_LOG=3, not `error`, `warn`, `info`, `debug`, `trace` or `off`")),
        ];
        for (value, expected) in cases {
            let variables = |name: &str| (name == "SCL_LOG").then(|| value.into());
            assert_eq!(refused(Level::read(&variables)), expected.map_err(str::to_owned));
        }
    }

    #[test]
    fn colour_is_for_terminals_without_no_color() {
        let cases = [(true, None, true), (true, Some(""), true), (true, Some("1"), false), (false, None, false)];
        for (terminal, no_color, expected) in cases {
            let variables = |name: &str| no_color.filter(|_| name == "NO_COLOR").map(Into::into);
            assert_eq!(use_colour(terminal, &variables), expected, "{terminal} {no_color:?}");
        }
    }
}
