//! Limits for the decoding of one message. Payloads may come from anybody who can write to a socket or a file.

use std::cell::Cell;

/// Maximum nesting depth of lists, maps and messages, which is that of the codec `protobuf`.
pub(crate) const MAX_DEPTH: usize = 100;

/// Maximum number of values in one message. A value takes about 100 bytes while it is decoded, its text a byte or more,
/// so a message takes less than half a gigabyte.
pub(crate) const MAX_VALUES: usize = 1 << 22;

/// Counts the values of one message.
#[derive(Debug)]
pub(crate) struct Budget(Cell<usize>);

/// The message has more values than [`MAX_VALUES`], or is deeper than [`MAX_DEPTH`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Exceeded {
    #[error("it has more than {MAX_VALUES} values")]
    Values,
    #[error("it is nested deeper than {MAX_DEPTH} levels")]
    Depth,
}

impl Budget {
    pub(crate) fn new() -> Self {
        Self(Cell::new(MAX_VALUES))
    }

    /// Takes a number of values from the budget.
    pub(crate) fn take(&self, count: usize) -> Result<(), Exceeded> {
        self.0.set(self.0.get().checked_sub(count).ok_or(Exceeded::Values)?);
        Ok(())
    }
}
