//! The environment variable with values of parameters.

use crate::environment::{self, Variables};
use crate::error::OpenError;
use scl_plan::{Assignment, SET_VARIABLE, assignments};

/// Reads the environment variable.
///
/// # Errors
/// [`OpenError::Environment`] if it is not understood.
pub(crate) fn read(variables: Variables<'_>) -> Result<Vec<Assignment>, OpenError> {
    let expected = "values like `controller.gain=2,controller.name=\"a, b\"`";
    let given = environment::read(variables, SET_VARIABLE, expected, |text| assignments(text).ok())?;
    Ok(given.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::refused;
    use std::ffi::OsString;

    #[test]
    fn a_variable_that_is_not_understood_is_refused() {
        let told = refused(read(&|_| Some(OsString::from("gain=2"))).map(drop));
        assert!(told.is_err_and(|told| told.starts_with("SCL_SET=gain=2, not values like")));
    }
}
