//! The `pub` gate.

super::sending_gate::sending_gate! {
    /// Sends messages to every subscriber of this gate.
    ///
    /// Each subscriber has a connection and a queue of its own: a slow or stopped one does not concern the others, and one
    /// that is not there yet gets what waits for it (up to its `queue`) when it first appears.
    ///
    /// ```no_run
    /// scl::topology!("doc/rover.yaml");
    ///
    /// #[scl::main]
    /// async fn main(mut sensor: Sensor) -> scl::Result<()> {
    ///     let mut tick = scl::time::interval(std::time::Duration::from_millis(1))?;
    ///     loop {
    ///         tick.tick().await;
    ///         sensor.measurements.send(&rover::Measurement { speed: 1.0 }).await?;
    ///     }
    /// }
    /// ```
    Pub to "every subscriber"
}
