//! Turns panics of schema compilers and code generators into errors.

use std::panic::{AssertUnwindSafe, catch_unwind};

/// Note for a problem that only a bug can cause.
pub const BUG: &str = "this is a bug in SCL; please report it with the topology and its schemas";

/// Runs `work`, which may panic on input that it does not support, and catches the panic: inside the macro, it would
/// hide every other problem of the file.
///
/// # Errors
/// The text of the panic.
pub fn no_panic<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        text.or(panic.downcast_ref::<&str>().copied()).unwrap_or("it panicked").to_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::no_panic;

    #[test]
    fn a_panic_is_an_error_with_its_text() {
        assert_eq!(no_panic(|| 1), Ok(1));
        let name = "Auto";
        assert_eq!(no_panic::<()>(|| panic!("overlapping: {name}")), Err("overlapping: Auto".to_owned()));
        assert_eq!(no_panic::<()>(|| panic!("plain")), Err("plain".to_owned()));
        assert_eq!(no_panic::<()>(|| std::panic::panic_any(1)), Err("it panicked".to_owned()));
    }
}
