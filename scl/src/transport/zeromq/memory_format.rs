//! Which ends can share memory.

/// What two ends must have in common to share memory: the engine and its files' layout, and the user. `None` without
/// the feature `shm`.
#[cfg(feature = "shm")]
pub(super) fn memory_format() -> Option<String> {
    Some(format!("{},{}", scl_shm::FORMAT, rustix::process::geteuid().as_raw()))
}

#[cfg(not(feature = "shm"))]
pub(super) fn memory_format() -> Option<String> {
    None
}
