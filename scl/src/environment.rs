//! Reading environment variables.

use crate::error::OpenError;
use std::ffi::OsString;
use std::time::Duration;

/// The shortest duration that a variable accepts.
const SHORTEST: Duration = Duration::from_micros(1);

/// The longest duration that a variable accepts: a day.
const LONGEST: Duration = Duration::from_secs(86_400);

/// Looks up a variable by name: in this process, in chosen options, or in a test's table.
pub(crate) type Variables<'a> = &'a dyn Fn(&str) -> Option<OsString>;

/// The variables of this process.
pub(crate) fn of_process(variable: &str) -> Option<OsString> {
    std::env::var_os(variable)
}

/// Reads a variable. An empty value counts as unset. `expected` describes the valid values in the error text, as in
/// "expected `a` or `b`".
///
/// # Errors
/// [`OpenError::Environment`] if the value is not UTF-8 or `parse` returns `None`.
pub(crate) fn read<T>(
    variables: Variables<'_>,
    variable: &'static str,
    expected: &'static str,
    parse: impl FnOnce(&str) -> Option<T>,
) -> Result<Option<T>, OpenError> {
    let Some(value) = variables(variable).filter(|value| !value.is_empty()) else { return Ok(None) };
    match value.to_str().and_then(parse) {
        Some(parsed) => Ok(Some(parsed)),
        None => Err(OpenError::Environment { variable, value: value.to_string_lossy().into_owned(), expected }),
    }
}

/// A duration as in a topology file, from 1 us to a day.
pub(crate) fn duration(text: &str) -> Option<Duration> {
    scl_text::duration::parse(text).ok().filter(|duration| (SHORTEST..=LONGEST).contains(duration))
}

/// For tests: a value that was read, or the refused variable with its value.
#[cfg(test)]
pub(crate) fn refused<T>(read: Result<T, OpenError>) -> Result<T, String> {
    read.map_err(|error| match error {
        OpenError::Environment { variable, value, expected } => format!("{variable}={value}, not {expected}"),
        other => panic!("{other}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::ffi::OsStringExt;

    #[test]
    fn a_value_is_parsed_or_refused() {
        let cases = [
            (None, Ok(None)),
            (Some(&b""[..]), Ok(None)),
            (Some(b"7"), Ok(Some(7_u8))),
            (Some(b"seven"), Err("SCL_X=seven, not a number")),
            (Some(b" 7"), Err("SCL_X= 7, not a number")),
            (Some(b"7\xff"), Err("SCL_X=7\u{fffd}, not a number")),
        ];
        for (value, expected) in cases {
            let variables =
                |name: &str| value.filter(|_| name == "SCL_X").map(|value| OsString::from_vec(value.to_vec()));
            let found = refused(read(&variables, "SCL_X", "a number", |text| text.parse().ok()));
            assert_eq!(found, expected.map_err(str::to_owned));
        }
    }
}
