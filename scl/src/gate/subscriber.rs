//! The `sub` gate.

super::receiving_gate::receiving_gate! {
    /// Receives messages from one or several publishers, in order of arrival.
    ///
    /// A publisher that starts later or restarts is found by itself.
    ///
    /// ```no_run
    /// scl::topology!("doc/rover.yaml");
    ///
    /// #[scl::main]
    /// async fn main(mut controller: Controller) -> scl::Result<()> {
    ///     loop {
    ///         println!("{} m/s", controller.sensor.recv().await?.speed);
    ///     }
    /// }
    /// ```
    Sub
}
