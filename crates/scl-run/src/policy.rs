//! How a component is treated when it fails, hangs or has to stop.

use scl_text::words;
use std::time::Duration;

/// The settings of a component, with a value for each.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Policy {
    pub(crate) restart: Restart,
    pub(crate) delay: RestartDelay,
    pub(crate) limit: RestartLimit,
    /// Whether its failure stops the other components.
    pub(crate) essential: bool,
    /// How long it may take to stop before it is killed.
    pub(crate) stop_within: Duration,
    /// How long it may take to say that it is ready.
    pub(crate) ready_within: Option<Duration>,
    /// The longest time between two signs of life, once it is ready.
    pub(crate) alive_within: Option<Duration>,
}

words! {
    /// When a component is started again.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
    pub(crate) enum Restart {
        /// It is not started again.
        #[default]
        Never = "never",
        /// After a signal, a missed limit or a failed start, but not after an exit code.
        OnAbnormal = "on_abnormal",
        /// After a failure.
        OnFailure = "on_failure",
        /// Also after it has ended successfully.
        Always = "always",
    }
}

/// The time between an end and the next start. It doubles with each restart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct RestartDelay {
    pub(crate) first: Duration,
    pub(crate) longest: Duration,
}

/// How many restarts are allowed within any period of a given length.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct RestartLimit {
    pub(crate) count: usize,
    pub(crate) within: Duration,
}

impl Default for Policy {
    fn default() -> Self {
        Self {
            restart: Restart::default(),
            delay: RestartDelay { first: Duration::from_millis(100), longest: Duration::from_secs(5) },
            limit: RestartLimit { count: 5, within: Duration::from_secs(60) },
            essential: true,
            stop_within: Duration::from_secs(5),
            ready_within: None,
            alive_within: None,
        }
    }
}
