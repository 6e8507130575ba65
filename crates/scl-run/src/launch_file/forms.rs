//! Texts that have a form of their own: times, limits and priorities.

use super::super::policy::{RestartDelay, RestartLimit};
use scl_terminal::parse_duration;
use std::time::Duration;

pub(super) fn any_duration(text: &str) -> Option<Duration> {
    parse_duration(text.trim()).ok()
}

/// Parses a time limit, which must not be zero.
pub(super) fn limit(text: &str) -> Option<Duration> {
    any_duration(text).filter(|time| !time.is_zero())
}

pub(super) fn restart_delay(text: &str) -> Option<RestartDelay> {
    let (first, longest) = text.split_once("..").unwrap_or((text, text));
    let (first, longest) = (any_duration(first)?, any_duration(longest)?);
    (first <= longest).then_some(RestartDelay { first, longest })
}

pub(super) fn restart_limit(text: &str) -> Option<RestartLimit> {
    let (count, within) = text.split_once(" in ")?;
    Some(RestartLimit { count: count.trim().parse().ok()?, within: limit(within)? })
}

pub(super) fn priority(text: &str) -> Option<u8> {
    text.strip_prefix("fifo:")?.parse().ok().filter(|priority| (1..=99).contains(priority))
}
