//! Logs the messages of iceoryx2 at level `debug`.

use iceoryx2::prelude::{LogLevel, set_log_level, set_logger};
use std::fmt::Arguments;
use std::sync::Once;

/// Logs everything at level `debug`: iceoryx2 warns about much that is expected here, such as a peer that was killed.
/// SCL itself reports what matters to users.
struct Debugging;

impl iceoryx2_log_types::Log for Debugging {
    fn log(&self, level: LogLevel, origin: Arguments<'_>, message: Arguments<'_>) {
        tracing::debug!(target: "scl::iceoryx2", ?level, %origin, "{message}");
    }
}

/// Installs the logger once. Messages are not even formatted unless the program logs at level `debug`.
pub(crate) fn direct() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        set_logger(&Debugging);
        let wanted = tracing::enabled!(target: "scl::iceoryx2", tracing::Level::DEBUG);
        set_log_level(if wanted { LogLevel::Debug } else { LogLevel::Fatal });
    });
}
