//! The `pull` gate.

super::receiving_gate::receiving_gate! {
    /// Receives messages from any number of `push` gates, in order of arrival.
    ///
    /// ```no_run
    /// scl::topology!("doc/rover.yaml");
    ///
    /// #[scl::main]
    /// fn main(mut recorder: Recorder) -> scl::Result<()> {
    ///     loop {
    ///         println!("{} m/s", recorder.log.recv_blocking()?.speed);
    ///     }
    /// }
    /// ```
    Pull
}
