//! Memory and processor time of a process, read from `/proc`.

use std::fs;

/// The resident memory of a process, in KiB.
pub(crate) fn resident_kib(process: u32) -> scl::Result<u64> {
    field(&fs::read_to_string(format!("/proc/{process}/status"))?, "VmRSS")
}

/// The processor time of all threads of a process so far, in milliseconds.
pub(crate) fn processor_ms(process: u32) -> scl::Result<f64> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat"))?;
    let ticks = ticks(&stat).ok_or_else(|| scl::Error::message("the status of a process has no processor time"))?;
    Ok(ticks as f64 * 1e3 / rustix::param::clock_ticks_per_second() as f64)
}

/// Returns the clock ticks in user mode and in the kernel: the sum of fields 14 and 15 of `stat`. Field 2 is the
/// program's name in parentheses, which may contain anything.
fn ticks(stat: &str) -> Option<u64> {
    let (_, fields) = stat.rsplit_once(')')?;
    let mut fields = fields.split_ascii_whitespace().skip(11).map(str::parse::<u64>);
    Some(fields.next()?.ok()? + fields.next()?.ok()?)
}

/// The number in a line `name:  number unit`.
fn field(status: &str, name: &str) -> scl::Result<u64> {
    let value = status.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(':'));
    let number = value.and_then(|value| value.split_ascii_whitespace().next());
    let missing = || scl::Error::message(format!("the status of a process has no field `{name}`"));
    Ok(number.ok_or_else(missing)?.parse()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_found_by_their_full_name() {
        let status = "VmRSS:\t    5120 kB\nvoluntary_ctxt_switches:\t7\nnonvoluntary_ctxt_switches:\t3\n";
        for (name, expected) in [("VmRSS", 5120), ("nonvoluntary_ctxt_switches", 3)] {
            assert_eq!(field(status, name).unwrap(), expected);
        }
        assert_eq!(field(status, "VmHWM").unwrap_err().to_string(), "the status of a process has no field `VmHWM`");
    }

    #[test]
    fn processor_time_is_found_behind_any_name() {
        let stat = "7 (a ) b) S 1 7 7 0 -1 4194560 1 0 0 0 12 30 0 0 20 0 1 0 3 0";
        assert_eq!(ticks(stat), Some(42));
        assert_eq!(ticks("7 (a) S 1"), None);
    }

    #[test]
    fn this_process_has_a_footprint() {
        assert!(resident_kib(std::process::id()).unwrap() > 0);
        assert!(processor_ms(std::process::id()).unwrap() >= 0.0);
    }
}
