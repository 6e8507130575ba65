//! The `push` gate.

super::sending_gate::sending_gate! {
    /// Hands messages to the `pull` gate that this gate is connected to.
    ///
    /// With several pullers (`share: true`) each message goes to one of them, to the next in turn that can take it.
    Push to "a puller"
}
