//! How a program is linked.

use std::fs::File;
use std::io::Read;
use std::path::Path;

/// More than the headers of programs take, in bytes.
const HEADERS: u64 = 4096;
/// The type of the program header that names the loader (ELF's `PT_INTERP`).
const LOADER: u64 = 3;

/// Returns true if a file is a program of 64 bits that is linked statically: no loader gives it any library.
pub(crate) fn is_static(program: &Path) -> bool {
    let mut start = Vec::new();
    let read = File::open(program).and_then(|file| file.take(HEADERS).read_to_end(&mut start));
    read.is_ok() && loader(&start) == Some(false)
}

/// Whether the headers of a program name a loader; `None` if they are not such headers.
fn loader(start: &[u8]) -> Option<bool> {
    let number = |at: usize, length: usize| {
        let bytes = start.get(at..at.checked_add(length)?)?;
        Some(bytes.iter().rev().fold(0_u64, |number, byte| number << 8 | u64::from(*byte)))
    };
    // 64 bits, and the lowest byte first.
    start.starts_with(b"\x7fELF\x02\x01").then_some(())?;
    let (first, size, count) = (number(32, 8)?, number(54, 2)?, number(56, 2)?);
    let headers = (0..count).map(|index| number(usize::try_from(first + index * size).ok()?, 4));
    let kinds: Option<Vec<u64>> = headers.collect();
    Some(kinds?.contains(&LOADER))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_programs_without_a_loader_are_static() {
        assert!(!is_static(&std::env::current_exe().unwrap()));
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            path
        };
        // One header, of a part to load.
        let mut program = b"\x7fELF\x02\x01".to_vec();
        program.resize(64 + 56, 0);
        (program[32], program[54], program[56], program[64]) = (64, 56, 1, 1);
        assert!(is_static(&file("static", &program)));
        program[64] = 3;
        assert!(!is_static(&file("dynamic", &program)));
        for other in [&b"#!/bin/sh\n"[..], b"", b"\x7fELF\x02\x01", &program[..70]] {
            assert!(!is_static(&file("other", other)), "{other:?}");
        }
        assert!(!is_static(&folder.path().join("missing")));
    }
}
