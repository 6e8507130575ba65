//! Failures: a status and a text, which the thread keeps.

use crate::status::*;
use crate::texts;
use scl::host::text_with_causes;
use scl::runtime_dir::RuntimeDirError;
use scl::untyped::{GateError, WaitError};
use scl::{
    BlockingError, CallError, NotFlushed, NotReady, OpenError, RecvError, RecvTimeoutError, ReplyError, SendError,
    SendTimeoutError, TrySendError,
};
use std::borrow::Cow;
use std::error::Error;
use std::ffi::{CStr, CString, c_char};

/// Why a call did not do what it was asked to do.
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
        // Only a name given by the program could contain one.
        bytes.retain(|byte| *byte != 0);
        Self { status, text: CString::new(bytes).map_or(Cow::Borrowed(c""), Cow::Owned) }
    }

    /// A failure that is a usual result, so it costs no memory.
    pub(crate) const fn usual(status: scl_status, text: &'static CStr) -> Self {
        Self { status, text: Cow::Borrowed(text) }
    }

    pub(crate) fn argument(text: impl Into<String>) -> Self {
        Self::new(SCL_ARGUMENT, text)
    }

    /// An error with its causes.
    pub(crate) fn of(status: scl_status, error: &(dyn Error + 'static)) -> Self {
        Self::new(status, text_with_causes(error))
    }

    /// Keeps the text for `scl_error` and returns the status.
    pub(crate) fn report(self) -> scl_status {
        texts::keep(self.text);
        self.status
    }
}

fn blocking(error: &BlockingError) -> scl_status {
    match error {
        BlockingError::Stopped => SCL_STOPPED,
        BlockingError::Forked => SCL_FORKED,
        BlockingError::Closed => SCL_CLOSED,
        _ => SCL_FAILED,
    }
}

impl From<GateError> for Failure {
    fn from(error: GateError) -> Self {
        let status = match error {
            GateError::Unknown { .. } => SCL_NAME,
            GateError::Kind { .. } => SCL_KIND,
            _ => SCL_FAILED,
        };
        Self::of(status, &error)
    }
}

fn opening(error: &OpenError) -> scl_status {
    match error {
        OpenError::RuntimeDir { source: RuntimeDirError::AlreadyRunning { .. }, .. } => SCL_TAKEN,
        OpenError::RuntimeDir { .. } => SCL_FOLDER,
        OpenError::Plan { .. } | OpenError::TooManyPlans { .. } => SCL_PLAN,
        OpenError::Environment { .. }
        | OpenError::NoSuchGate { .. }
        | OpenError::NoSharedMemory { .. }
        | OpenError::Unexpected { .. } => SCL_ENVIRONMENT,
        OpenError::Gate { .. } | OpenError::Timer { .. } | OpenError::Runtime { .. } => SCL_SYSTEM,
        _ => SCL_FAILED,
    }
}

impl From<OpenError> for Failure {
    fn from(error: OpenError) -> Self {
        Self::of(opening(&error), &error)
    }
}

/// The statuses of errors that are not the end of the component.
macro_rules! statuses {
    ($($error:ident { $($variant:ident => $status:ident),+ })+) => { $(
        impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                let status = match &error {
                    $($error::$variant { .. } => $status,)+
                    $error::Blocking { source, .. } => blocking(source),
                    _ => SCL_FAILED,
                };
                Self::of(status, &error)
            }
        }
    )+ };
}

statuses! {
    SendError { Encode => SCL_ENCODE, TooLong => SCL_TOO_LONG }
    RecvError { Decode => SCL_DECODE }
    CallError {
        Encode => SCL_ENCODE,
        TooLong => SCL_TOO_LONG,
        Timeout => SCL_TIMEOUT,
        PeerLost => SCL_PEER_LOST,
        Refused => SCL_REFUSED,
        Decode => SCL_DECODE
    }
    ReplyError { Encode => SCL_ENCODE, TooLong => SCL_TOO_LONG, RequesterGone => SCL_REQUESTER_GONE }
}

impl From<TrySendError> for Failure {
    fn from(error: TrySendError) -> Self {
        match error {
            TrySendError::Send(error) => error.into(),
            full => Self::of(SCL_FULL, &full),
        }
    }
}

impl From<SendTimeoutError> for Failure {
    fn from(error: SendTimeoutError) -> Self {
        match error {
            SendTimeoutError::Send(error) => error.into(),
            timeout => Self::of(SCL_TIMEOUT, &timeout),
        }
    }
}

impl From<RecvTimeoutError> for Failure {
    fn from(error: RecvTimeoutError) -> Self {
        match error {
            RecvTimeoutError::Recv(error) => error.into(),
            timeout => Self::of(SCL_TIMEOUT, &timeout),
        }
    }
}

impl From<WaitError> for Failure {
    fn from(error: WaitError) -> Self {
        let status = match &error {
            WaitError::Recv(RecvError::Blocking { source, .. }) | WaitError::Blocking { source, .. } => {
                blocking(source)
            }
            WaitError::Timeout { .. } => SCL_TIMEOUT,
            _ => SCL_FAILED,
        };
        Self::of(status, &error)
    }
}

/// Errors of calls that wait for the whole component.
impl From<scl::Error> for Failure {
    fn from(error: scl::Error) -> Self {
        let error = error.inner();
        let status = if let Some(source) = error.downcast_ref() {
            blocking(source)
        } else if let Some(error) = error.downcast_ref() {
            opening(error)
        } else if error.is::<NotReady>() {
            SCL_TIMEOUT
        } else if error.is::<NotFlushed>() {
            SCL_NOT_FLUSHED
        } else if error.is::<std::io::Error>() {
            SCL_SYSTEM
        } else {
            SCL_FAILED
        };
        Self::of(status, error)
    }
}
