//! Any error, for functions that report several kinds.

use super::BlockingError;
use crate::causes::causes;
use std::fmt;

/// The result of a program's main function: any error, with its causes.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Any error, with its causes; `?` converts every error type into it.
///
/// It does not implement `std::error::Error` itself, because that would rule out the conversion from every error type.
pub struct Error(Box<dyn std::error::Error + Send + Sync>);

impl Error {
    /// Creates an error from a text.
    pub fn message(text: impl Into<String>) -> Self {
        Self(text.into().into())
    }

    pub(crate) fn from_box(error: Box<dyn std::error::Error + Send + Sync>) -> Self {
        Self(error)
    }

    /// Copies the texts of an error that may not be sent to other threads, and those of its causes.
    pub(crate) fn copy_of(error: &(dyn std::error::Error + 'static)) -> Self {
        match error.downcast_ref::<BlockingError>() {
            Some(own) => Self(Box::new(*own)),
            None => Self(Box::new(Copied::of(error))),
        }
    }

    /// Returns the error inside.
    pub fn inner(&self) -> &(dyn std::error::Error + Send + Sync + 'static) {
        &*self.0
    }

    /// Returns true if it reports that a stop was requested, which is not a failure.
    pub fn is_stop(&self) -> bool {
        let is_stop =
            |error: &(dyn std::error::Error + 'static)| matches!(error.downcast_ref(), Some(BlockingError::Stopped));
        is_stop(&*self.0) || causes(&*self.0).any(is_stop)
    }
}

/// The text of an error, and its cause.
#[derive(Debug, thiserror::Error)]
#[error("{text}")]
struct Copied {
    text: String,
    source: Option<Box<dyn std::error::Error + Send + Sync>>,
}

impl Copied {
    fn of(error: &(dyn std::error::Error + 'static)) -> Self {
        Self { text: error.to_string(), source: error.source().map(|source| Error::copy_of(source).0) }
    }
}

impl From<Error> for Box<dyn std::error::Error + Send + Sync> {
    fn from(error: Error) -> Self {
        error.0
    }
}

impl From<Error> for Box<dyn std::error::Error> {
    fn from(error: Error) -> Self {
        error.0
    }
}

impl<E: std::error::Error + Send + Sync + 'static> From<E> for Error {
    fn from(error: E) -> Self {
        Self(Box::new(error))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}

/// The error and its causes, one per line.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)?;
        causes(&*self.0).try_for_each(|cause| write!(f, "\n  caused by: {cause}"))
    }
}
