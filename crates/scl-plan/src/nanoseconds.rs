//! Durations in JSON.

use scl_text::duration::nanoseconds;
use serde::ser::{Serialize, Serializer};
use std::time::Duration;

/// Writes a duration that need not be declared. `validate` rejects those that do not fit.
pub(crate) fn of_interval<S: Serializer>(interval: &Option<Duration>, serializer: S) -> Result<S::Ok, S::Error> {
    interval.map(nanoseconds).serialize(serializer)
}
