//! What is logged: from which level on, and the warnings that must not wait.

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
}
