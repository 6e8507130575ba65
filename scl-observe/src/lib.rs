//! What runs in a system: components, gates, figures, and the messages at their taps.
#![cfg_attr(test, allow(clippy::unwrap_used))]
