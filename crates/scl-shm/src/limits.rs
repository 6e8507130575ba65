//! How much memory a connection needs, and whether there is enough.

/// Where the operating system keeps shared memory.
pub(crate) const FOLDER: &str = "/dev/shm";
/// Maximum number of unacknowledged samples.
const IN_FLIGHT: usize = 64;
/// How many views a program may hold, besides those in its gate's queue, before it receives copies.
const VIEWS: usize = 8;
/// The longest queue whose samples all stay in shared memory. The engine's files grow with it.
const QUEUE: usize = 512;
/// Memory that is always left free: for the files of connections, and for what other programs allocate between the
/// check of the free memory and a write.
const SPARE: u64 = 2 << 20;
const PAGE: u64 = 4096;
/// Maximum number of bytes that the engine puts before the payload of a sample.
pub(crate) const HEADERS: usize = 256;

/// The limits of one connection, which follow from the receiving gate's queue and from its longest message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// The receiving gate's queue, in messages.
    pub queue: usize,
    /// The longest message, in bytes.
    pub longest: usize,
}

impl Limits {
    /// The limits of a receiving end that keeps `kept` samples. Its longest message is not known.
    pub(crate) fn of_kept(kept: usize) -> Self {
        Self { queue: kept.saturating_sub(VIEWS), longest: 0 }
    }

    /// Maximum number of unacknowledged samples: the queue, from 1 to 64.
    pub fn in_flight(&self) -> usize {
        self.queue.clamp(1, IN_FLIGHT)
    }

    /// Maximum number of samples that the receiving end keeps: its queue and 8 views. Any more are copied.
    pub fn kept(&self) -> usize {
        self.queue.clamp(1, QUEUE) + VIEWS
    }

    /// Maximum number of samples that are lent at the same time: as many as may wait behind those in flight, one that
    /// is being filled, and briefly one more, into which a message is copied.
    pub fn loans(&self) -> usize {
        self.in_flight() + 2
    }

    /// Number of samples for which there is room.
    pub fn samples(&self) -> usize {
        // The receiving port holds one more sample than it keeps, until that one is copied.
        self.in_flight() + self.kept() + 1 + self.loans()
    }

    /// The memory in bytes that the connection takes if all samples are in use and have the maximum length.
    pub fn needed(&self) -> u64 {
        let sample = (self.longest as u64).saturating_add(HEADERS as u64).div_ceil(PAGE).saturating_mul(PAGE);
        sample.saturating_mul(self.samples() as u64)
    }

    /// Checks whether as much memory is free as the connection may need.
    ///
    /// # Errors
    /// [`TooLittle`], with both sizes.
    pub fn check(&self) -> Result<(), TooLittle> {
        require(self.needed())
    }
}

/// Too little shared memory is free.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{needed} bytes of shared memory are needed, and {} has {available}", FOLDER)]
pub struct TooLittle {
    /// How much is needed, in bytes.
    pub needed: u64,
    /// How much is free, in bytes.
    pub available: u64,
}

/// How much shared memory is free, in bytes: `u64::MAX` if that is not limited or not known.
pub fn available() -> u64 {
    match rustix::fs::statvfs(FOLDER) {
        Ok(found) if found.f_blocks > 0 => found.f_bavail.saturating_mul(found.f_frsize),
        // A file system without a limit reports zero blocks.
        _ => u64::MAX,
    }
}

/// Checks that this many bytes are free, in addition to [`SPARE`].
pub(crate) fn require(bytes: u64) -> Result<(), TooLittle> {
    let (needed, available) = (bytes.saturating_add(SPARE), available());
    if needed <= available { Ok(()) } else { Err(TooLittle { needed, available }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_follow_the_queue() {
        let of = |queue| {
            let limits = Limits { queue, longest: 4 << 20 };
            (limits.in_flight(), limits.kept(), limits.loans(), limits.samples())
        };
        assert_eq!(of(0), (1, 9, 3, 14));
        assert_eq!(of(1), (1, 9, 3, 14));
        assert_eq!(of(100), (64, 108, 66, 239));
        assert_eq!(of(usize::MAX), (64, 520, 66, 651));
    }

    #[test]
    fn what_is_needed_is_compared_with_what_is_free() {
        let limits = Limits { queue: 1, longest: 4 << 20 };
        assert_eq!(limits.needed(), 14 * ((4 << 20) + 4096));
        let error = Limits { queue: 1, longest: usize::MAX }.check().unwrap_err();
        assert_eq!(error.needed, u64::MAX);
        assert_eq!(
            error.to_string(),
            format!("{} bytes of shared memory are needed, and /dev/shm has {}", u64::MAX, error.available)
        );
    }
}
