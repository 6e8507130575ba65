//! The causes of an error, and an error as one text.

use std::error::Error;

/// Iterates over the cause of an error, the cause of that, and so on.
pub(crate) fn causes<'e>(error: &'e (dyn Error + 'e)) -> impl Iterator<Item = &'e (dyn Error + 'static)> {
    std::iter::successors(error.source(), |&cause| cause.source())
}

/// An error and its causes in one line, for languages whose errors have no causes of their own.
pub fn text_with_causes(error: &dyn Error) -> String {
    causes(error).fold(error.to_string(), |text, cause| format!("{text}: {cause}"))
}
