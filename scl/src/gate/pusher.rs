//! The `push` gate.

super::sending_gate::sending_gate! {
    /// Hands messages to the `pull` gate that this gate is connected to.
    ///
    /// With several pullers (`share: true`) each message goes to one of them, to the next in turn that can take it.
    ///
    /// ```no_run
    /// scl::topology!("doc/rover.yaml");
    ///
    /// #[scl::main]
    /// async fn main(mut sensor: Sensor) -> scl::Result<()> {
    ///     sensor.log.send(&rover::Measurement { speed: 1.0 }).await?;
    ///     Ok(())
    /// }
    /// ```
    Push to "a puller"
}
