//! What a main function may return.

use crate::error::Error;
use std::error::Error as StdError;
use std::marker::PhantomData;
use std::ops::Deref;

/// Nothing, or a result with an error that `?` converts into [`Error`].
pub trait Outcome {
    #[doc(hidden)]
    fn into_result(self) -> Result<(), Error>;
}

impl Outcome for () {
    fn into_result(self) -> Result<(), Error> {
        Ok(())
    }
}

impl<E: Into<Error>> Outcome for Result<(), E> {
    fn into_result(self) -> Result<(), Error> {
        self.map_err(Into::into)
    }
}

/// Chooses the conversion for the value that `main` returned.
///
/// No single trait covers `scl::Error`, every error type, `anyhow::Error` and `Box<dyn Error>`: the implementations
/// would overlap. Here each conversion is a method of a separate type, and the compiler takes the first whose bounds
/// hold, because the types dereference to each other.
pub struct Returned<R>(Boxable<R>);

/// Errors that convert into a boxed error, such as `anyhow::Error`, `Box<dyn Error + Send + Sync>` and `String`.
pub struct Boxable<R>(AnyOther<R>);

/// Everything else: `Box<dyn Error>`. For any other type, the compiler says what `main` may return.
pub struct AnyOther<R>(PhantomData<R>);

impl<R> Returned<R> {
    /// Creates a value whose `convert` fits the type of the argument.
    pub fn of(_: &R) -> Self {
        Self(Boxable(AnyOther(PhantomData)))
    }
}

impl<R: Outcome> Returned<R> {
    /// Converts the value that `main` returned.
    pub fn convert(&self, returned: R) -> Result<(), Error> {
        returned.into_result()
    }
}

impl<E: Into<Box<dyn StdError + Send + Sync>>> Boxable<Result<(), E>> {
    /// Converts the value that `main` returned.
    pub fn convert(&self, returned: Result<(), E>) -> Result<(), Error> {
        returned.map_err(|error| Error::from_box(error.into()))
    }
}

impl<R> AnyOther<R> {
    /// Converts the value that `main` returned.
    pub fn convert(&self, returned: R) -> Result<(), Error>
    where
        R: MainResult,
    {
        returned.into_result()
    }
}

impl<R> Deref for Returned<R> {
    type Target = Boxable<R>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<R> Deref for Boxable<R> {
    type Target = AnyOther<R>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

/// Results whose errors have to be copied, because they may not be sent to other threads.
#[diagnostic::on_unimplemented(
    message = "`main` cannot return `{Self}`",
    label = "write `scl::Result<()>`",
    note = "`main` may also return nothing, or a `Result` whose error is a type that implements `std::error::Error`, \
            `Box<dyn Error>` or `anyhow::Error`"
)]
pub trait MainResult {
    #[doc(hidden)]
    fn into_result(self) -> Result<(), Error>;
}

#[diagnostic::do_not_recommend]
impl MainResult for Result<(), Box<dyn StdError>> {
    fn into_result(self) -> Result<(), Error> {
        self.map_err(|error| Error::copy_of(&*error))
    }
}

#[diagnostic::do_not_recommend]
impl MainResult for Result<(), Box<dyn StdError + Send>> {
    fn into_result(self) -> Result<(), Error> {
        self.map_err(|error| Error::copy_of(&*error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::{BlockingError, GateName, RecvError};

    fn stopped() -> RecvError {
        RecvError::Blocking { gate: GateName::new("a", "b"), source: BlockingError::Stopped }
    }

    macro_rules! told {
        ($returned:expr) => {{
            let returned = $returned;
            let result = Returned::of(&returned).convert(returned);
            result.map_err(|error| (format!("{error:?}"), error.is_stop()))
        }};
    }

    #[test]
    fn every_usual_result_is_accepted() {
        let text = "gate `a.b` did not receive\n  caused by: stop requested".to_owned();
        let expected = Err((text, true));
        assert_eq!(told!(()), Ok(()));
        assert_eq!(told!(Err::<(), Error>(stopped().into())), expected);
        assert_eq!(told!(Err::<(), RecvError>(stopped())), expected);
        assert_eq!(told!(Err::<(), Box<dyn StdError + Send + Sync>>(stopped().into())), expected);
        assert_eq!(told!(Err::<(), Box<dyn StdError + Send>>(Box::new(stopped()))), expected);
        assert_eq!(told!(Err::<(), Box<dyn StdError>>(stopped().into())), expected);
        assert_eq!(told!(Err::<(), String>("no hardware".into())), Err(("no hardware".into(), false)));
        assert_eq!(told!(Err::<(), &str>("no hardware")), Err(("no hardware".into(), false)));
    }

    #[test]
    fn an_error_of_scl_can_be_boxed() {
        let boxed: Box<dyn StdError + Send + Sync> = Error::from(stopped()).into();
        assert_eq!(boxed.to_string(), "gate `a.b` did not receive");
        let boxed: Box<dyn StdError> = Error::from(stopped()).into();
        assert_eq!(boxed.source().map(ToString::to_string).as_deref(), Some("stop requested"));
    }
}
