//! The `pub` gate.

super::sending_gate::sending_gate! {
    /// Sends messages to every subscriber of this gate.
    ///
    /// Each subscriber has a connection and a queue of its own: a slow or stopped one does not concern the others, and one
    /// that is not there yet gets what waits for it (up to its `queue`) when it first appears.
    Pub to "every subscriber"
}
