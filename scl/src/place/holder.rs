//! Who holds a lock: asked of the operating system, and read from the file itself where that does not tell.

use std::{
    fs,
    io::{self, Read},
    os::unix::fs::MetadataExt,
};

use rustix::{
    fs::{major, minor},
    io::Errno,
    process::Pid,
};

use super::error::Holder;

/// Finds who has locked a file.
///
/// The operating system knows its holder from the first moment on. What the file says may be too old, because a holder
/// writes its number only after it has got the lock; but it helps where a file system goes by another device number in
/// the table of locks than in its files (Btrfs), and in a container that does not see the holder.
pub(super) fn find_holder(file: &mut fs::File) -> Holder {
    let listed = fs::read_to_string("/proc/locks").and_then(|table| Ok(listed_holder(&table, &file_id(file)?)));
    match listed {
        Ok(Some(pid)) => living(pid),
        Ok(None) | Err(_) => living_writer(file),
    }
}

/// A file as the table of locks names it: `fe:00:6078490`, the device in hexadecimal.
fn file_id(file: &fs::File) -> io::Result<String> {
    let file = file.metadata()?;
    Ok(format!("{:02x}:{:02x}:{}", major(file.dev()), minor(file.dev()), file.ino()))
}

/// Finds a file's holder in lines of `1: FLOCK  ADVISORY  WRITE 17033 fe:00:6078490 0 EOF`; one that only waits has an
/// arrow before `FLOCK`.
fn listed_holder(table: &str, file_id: &str) -> Option<Pid> {
    table.lines().find_map(|line| {
        let mut columns = line.split_ascii_whitespace().skip(1);
        let is_held = columns.next() == Some("FLOCK");
        let pid = columns.nth(2)?;
        (is_held && columns.next() == Some(file_id)).then(|| parse_pid(pid))?
    })
}

/// Who wrote its number into the file. It may have been killed half way through.
fn living_writer(file: &mut fs::File) -> Holder {
    let mut text = String::new();
    let read = file.take(32).read_to_string(&mut text);
    read.ok().and_then(|_| parse_pid(&text)).map_or(Holder::Unknown, living)
}

fn parse_pid(text: &str) -> Option<Pid> {
    text.trim().parse::<i32>().ok().filter(|number| *number > 0).and_then(Pid::from_raw)
}

/// The holder of a number, unless that process is gone: then the lock has passed to another.
fn living(pid: Pid) -> Holder {
    match pid {
        pid if pid == rustix::process::getpid() => Holder::ThisProcess,
        pid if rustix::process::test_kill_process(pid) == Err(Errno::SRCH) => Holder::Unknown,
        pid => Holder::Process(pid.as_raw_nonzero().get().cast_unsigned()),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use rustix::fs::FlockOperation;

    #[test]
    fn the_holder_is_read_from_whatever_the_file_says() {
        let own = std::process::id().to_string();
        let cases: [(&[u8], Holder); 8] = [
            (own.as_bytes(), Holder::ThisProcess),
            (b"1\n", Holder::Process(1)),
            (b"", Holder::Unknown),
            (b"no number", Holder::Unknown),
            (b"\xff\xfe", Holder::Unknown),
            (b"-1", Holder::Unknown),
            (b"2147483647", Holder::Unknown),
            (b"99999999999999999999999999999999999999999", Holder::Unknown),
        ];
        for (text, expected) in cases {
            assert_eq!(find_holder(&mut file_with(text)), expected, "{:?}", String::from_utf8_lossy(text));
        }
    }

    #[test]
    fn the_holder_is_known_before_it_has_written_its_number_over_another_one() {
        for text in [&b""[..], b"1\n", b"no number"] {
            let mut file = file_with(text);
            rustix::fs::flock(&file, FlockOperation::NonBlockingLockExclusive).unwrap();
            assert_eq!(find_holder(&mut file), Holder::ThisProcess, "{:?}", String::from_utf8_lossy(text));
        }
    }

    #[test]
    fn only_the_holder_of_this_very_file_is_found_in_the_table() {
        let table = "\
            1: POSIX  ADVISORY  WRITE 11 fe:00:500 0 EOF\n\
            2: FLOCK  ADVISORY  WRITE 12 fe:00:50 0 EOF\n\
            3: FLOCK  ADVISORY  WRITE 13 fe:00:501 0 EOF\n\
            3: -> FLOCK  ADVISORY  WRITE 14 fe:00:500 0 EOF\n\
            4: FLOCK\n\
            \n\
            5: FLOCK  ADVISORY  WRITE 15 fe:00:500 0 EOF\n";
        let cases = [("fe:00:500", Some(15)), ("fe:00:50", Some(12)), ("fe:01:500", None)];
        for (file_id, expected) in cases {
            assert_eq!(listed_holder(table, file_id).map(|pid| pid.as_raw_nonzero().get()), expected, "{file_id}");
        }
    }

    fn file_with(text: &[u8]) -> fs::File {
        let file = tempfile::NamedTempFile::new().unwrap();
        fs::write(file.path(), text).unwrap();
        file.into_file()
    }
}
