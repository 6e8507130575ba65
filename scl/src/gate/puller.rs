//! The `pull` gate.

super::receiving_gate::receiving_gate! {
    /// Receives messages from any number of `push` gates, in order of arrival.
    Pull
}
