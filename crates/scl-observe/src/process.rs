//! What the operating system says about a process.

use rustix::param::{clock_ticks_per_second, page_size};
use std::fs;
use std::time::Duration;

/// Processor time and memory of a process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ProcessFigures {
    /// Processor time of all its threads so far.
    pub processor_time: Duration,
    /// Resident memory in bytes.
    pub memory: u64,
}

impl ProcessFigures {
    /// Reads the figures of a process; `None` if it is not visible here.
    pub(crate) fn read(pid: u32) -> Option<Self> {
        let stat = fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
        Self::parse(&stat, clock_ticks_per_second(), page_size() as u64)
    }

    /// Parses `stat`, which `proc_pid_stat(5)` describes.
    fn parse(stat: &str, ticks_per_second: u64, page_size: u64) -> Option<Self> {
        let field = |number| stat_field(stat, number);
        let ticks = field(14)?.saturating_add(field(15)?);
        let processor_time = Duration::from_secs_f64(ticks as f64 / ticks_per_second.max(1) as f64);
        Some(Self { processor_time, memory: field(24)?.saturating_mul(page_size) })
    }
}

/// A field of `stat` by its number, from the third one on.
pub(crate) fn stat_field(stat: &str, number: usize) -> Option<u64> {
    // The second field, the name in parentheses, may contain anything.
    stat.rsplit_once(')')?.1.split_whitespace().nth(number - 3)?.parse().ok()
}

/// Whether a bit of a mask in the text of `/proc/<pid>/status` is set; `key` names the mask: `CapEff:`.
pub(crate) fn has_bit(status: &str, key: &str, bit: u32) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix(key));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask >> bit & 1 == 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_found_behind_any_name() {
        let stat = "42 (a) b (1 2)) S 1 42 42 0 -1 4194560 100 0 0 0 150 50 0 0 20 0 3 0 1000 5000000 25 1844";
        let expected = ProcessFigures { processor_time: Duration::from_secs(2), memory: 25 * 4096 };
        assert_eq!(ProcessFigures::parse(stat, 100, 4096), Some(expected));
        assert_eq!(ProcessFigures::parse("42 (a) S 1", 100, 4096), None);
        assert_eq!(ProcessFigures::parse("", 100, 4096), None);
    }

    #[test]
    fn this_process_can_be_read() {
        let figures = ProcessFigures::read(std::process::id()).unwrap();
        assert!(figures.memory > 100_000, "{figures:?}");
        assert_eq!(ProcessFigures::read(u32::MAX), None);
    }
}
