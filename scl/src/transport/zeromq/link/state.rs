//! How far the end of a connection has come.

/// ```text
/// Open ── FINISH read ──▶ Finishing ── FINISHED written ──▶ Finished
///   └───────────┬─────────────┴─────────────┬──────────────────┘
///               └── read or write failed ───┴──▶ Broken
/// ```
///
/// Messages are sent in `Open` only. A link that is `Broken` is driven once more, which fails, and dropped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum State {
    Open,
    /// The peer wants nothing more over this connection.
    Finishing,
    /// The peer has been told that nothing follows.
    Finished,
    Broken,
}
