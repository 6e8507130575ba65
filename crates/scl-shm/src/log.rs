//! What iceoryx2 logs, at the level of debugging.

use iceoryx2::prelude::{LogLevel, set_log_level, set_logger};
use std::fmt::Arguments;
use std::sync::Once;

/// iceoryx2 warns of much that is expected here, such as a peer that was killed. What matters to users, SCL says
/// itself.
struct Debugging;

impl iceoryx2_log_types::Log for Debugging {
    fn log(&self, level: LogLevel, origin: Arguments<'_>, message: Arguments<'_>) {
        tracing::debug!(target: "scl::iceoryx2", ?level, %origin, "{message}");
    }
}

/// Directs the log once. Its messages are not even formatted unless the program logs at the level of debugging.
pub(crate) fn direct() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        set_logger(&Debugging);
        let wanted = tracing::enabled!(target: "scl::iceoryx2", tracing::Level::DEBUG);
        set_log_level(if wanted { LogLevel::Debug } else { LogLevel::Fatal });
    });
}
