//! Failures: a status and a text, which is kept as the error of the thread.

use crate::status::*;
use crate::texts;
use scl::host::{ErrorKind, text_with_causes};
use scl::runtime_dir::RuntimeDirError;
use scl::untyped::GateError;
use scl::{BlockingError, OpenError};
use std::borrow::Cow;
use std::error::Error;
use std::ffi::{CStr, CString, c_char};

/// Why a call failed.
#[derive(Debug)]
pub(crate) struct Failure {
    pub(crate) status: scl_status,
    text: Cow<'static, CStr>,
}

/// Returns the text of this thread's last error: what went wrong, where, and what to do.
///
/// The text is empty before the first error, and never NULL. It stays as it is until 16 more calls of this thread have
/// failed or the thread ends; then another text may replace it, but its memory is never freed. Calls that succeed leave
/// it alone.
#[unsafe(no_mangle)]
pub extern "C" fn scl_error() -> *const c_char {
    texts::last()
}

impl Failure {
    pub(crate) fn new(status: scl_status, text: impl Into<String>) -> Self {
        let mut bytes = text.into().into_bytes();
        // Remove NUL bytes, which only a name given by the program could contain.
        bytes.retain(|byte| *byte != 0);
        Self { status, text: CString::new(bytes).map_or(Cow::Borrowed(c""), Cow::Owned) }
    }

    /// Makes a failure that is a usual result; its text is static, so nothing is allocated.
    pub(crate) const fn usual(status: scl_status, text: &'static CStr) -> Self {
        Self { status, text: Cow::Borrowed(text) }
    }

    pub(crate) fn argument(text: impl Into<String>) -> Self {
        Self::new(SCL_ARGUMENT, text)
    }

    /// Makes a failure whose text is an error with its causes.
    pub(crate) fn of(status: scl_status, error: &(dyn Error + 'static)) -> Self {
        Self::new(status, text_with_causes(error))
    }

    /// Makes a failure from an error of `scl`, with the matching status.
    pub(crate) fn of_any(error: &(dyn Error + 'static)) -> Self {
        let status = match ErrorKind::of(error) {
            ErrorKind::Blocking(BlockingError::Stopped) => SCL_STOPPED,
            ErrorKind::Blocking(BlockingError::Forked) => SCL_FORKED,
            ErrorKind::Blocking(BlockingError::Closed) => SCL_CLOSED,
            ErrorKind::Open(error) => opening(error),
            ErrorKind::NotReady | ErrorKind::SendTimeout | ErrorKind::Timeout => SCL_TIMEOUT,
            ErrorKind::NotFlushed => SCL_NOT_FLUSHED,
            ErrorKind::Encode => SCL_ENCODE,
            ErrorKind::TooLong => SCL_TOO_LONG,
            ErrorKind::Full => SCL_FULL,
            ErrorKind::Decode => SCL_DECODE,
            ErrorKind::PeerLost => SCL_PEER_LOST,
            ErrorKind::Refused => SCL_REFUSED,
            ErrorKind::RequesterGone => SCL_REQUESTER_GONE,
            _ => match error.downcast_ref() {
                Some(GateError::Unknown { .. }) => SCL_NAME,
                Some(GateError::Kind { .. }) => SCL_KIND,
                _ if error.is::<std::io::Error>() => SCL_SYSTEM,
                _ => SCL_FAILED,
            },
        };
        Self::of(status, error)
    }

    /// Keeps the text for `scl_error` and returns the status.
    pub(crate) fn report(self) -> scl_status {
        texts::keep(self.text);
        self.status
    }
}

fn opening(error: &OpenError) -> scl_status {
    match error {
        OpenError::RuntimeDir { source: RuntimeDirError::AlreadyRunning { .. }, .. } => SCL_TAKEN,
        OpenError::RuntimeDir { .. } => SCL_FOLDER,
        OpenError::Plan { .. } | OpenError::TooManyPlans { .. } => SCL_PLAN,
        OpenError::Environment { .. }
        | OpenError::NoSuchGate { .. }
        | OpenError::NoSuchParameter { .. }
        | OpenError::NoValue { .. }
        | OpenError::Set { .. }
        | OpenError::TransportOff { .. }
        | OpenError::Unexpected { .. }
        | OpenError::WhichComponent { .. }
        | OpenError::WrongValue { .. } => SCL_ENVIRONMENT,
        OpenError::UnknownComponent(_) => SCL_NAME,
        OpenError::Gate { .. } | OpenError::Timer { .. } | OpenError::Runtime { .. } => SCL_SYSTEM,
        _ => SCL_FAILED,
    }
}

impl<E: Error + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::of_any(&error)
    }
}
