//! The `sub` gate.

super::receiving_gate::receiving_gate! {
    /// Receives messages from one or several publishers, in order of arrival.
    ///
    /// A publisher that starts later or restarts is found by itself.
    Sub
}
