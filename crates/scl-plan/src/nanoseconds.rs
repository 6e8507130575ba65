//! Durations in JSON.

use serde::ser::{Serialize, Serializer};
use std::time::Duration;

/// `validate` rejects durations that do not fit: more than 584 years.
pub(crate) fn nanoseconds(duration: Duration) -> u64 {
    u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX)
}

/// Writes a duration that need not be declared.
pub(crate) fn of_interval<S: Serializer>(interval: &Option<Duration>, serializer: S) -> Result<S::Ok, S::Error> {
    interval.map(nanoseconds).serialize(serializer)
}
