//! Checks the message sizes that a benchmark is asked for.

use std::ops::RangeInclusive;

/// Rejects a size outside `range` before any process is started.
pub(crate) fn check_message_sizes(sizes: &[usize], range: RangeInclusive<usize>) -> scl::Result<()> {
    let Some(rejected) = sizes.iter().find(|size| !range.contains(size)) else { return Ok(()) };
    let (min, max) = range.into_inner();
    Err(scl::Error::message(format!("a message has {min} to {max} bytes, not {rejected}")))
}
