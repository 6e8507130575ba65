//! Stop requests.

use crate::border;
use scl::host;

/// Returns true if the program was asked to stop, by SIGTERM or SIGINT.
///
/// A stop request ends all calls that wait, and makes later ones fail, with SCL_STOPPED, so that a program that returns
/// from `main` after any error stops by itself. If it still runs after the time given by SCL_STOP_WITHIN (default 3s),
/// or when a second signal arrives, half a second after the first or later, it is ended with exit code 128 + the number
/// of the signal.
#[unsafe(no_mangle)]
pub extern "C" fn scl_stop_requested() -> bool {
    border::value(|| Ok(host::is_stop_requested())).unwrap_or(false)
}

/// From now on the program handles stop requests itself: its gates keep working after the request, also those that
/// wait, and `scl_stop_requested` tells. It still has to end within SCL_STOP_WITHIN.
#[unsafe(no_mangle)]
pub extern "C" fn scl_handle_stop() {
    let _reported = border::value(|| {
        host::handle_stop();
        Ok(())
    });
}
