//! Which lengths of messages can be measured.

use std::ops::RangeInclusive;

/// Refuses lengths outside a range, before any process is started for them.
pub(crate) fn check_lengths(lengths: &[usize], range: RangeInclusive<usize>) -> scl::Result<()> {
    let Some(refused) = lengths.iter().find(|bytes| !range.contains(bytes)) else { return Ok(()) };
    let (least, most) = range.into_inner();
    Err(scl::Error::message(format!("a message has from {least} to {most} bytes, not {refused}")))
}
