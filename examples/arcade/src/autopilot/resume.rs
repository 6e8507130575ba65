//! What survives a crash: a file with two copies of the autopilot's state.
//!
//! A program that is killed while it writes one copy leaves the other; sequence number and checksum tell which copy is
//! the newest complete one. The operating system keeps what was written even if the program is killed.

use std::fs::{File, OpenOptions};
use std::io;
use std::os::unix::fs::{FileExt, OpenOptionsExt};
use std::path::Path;

/// Identifies the format of the file. It changes with the meaning of the numbers, so that a file of another version is
/// not read.
const FORMAT: u64 = u64::from_le_bytes(*b"ARCADE-1");
/// Size of the header: format, sequence number, checksum.
const HEADER: usize = 3 * 8;

/// The file and the sequence number of its newest copy.
#[derive(Debug)]
pub struct StateFile {
    file: File,
    sequence: u64,
}

impl StateFile {
    /// Opens or creates the file. Returns the newest complete copy if it has `count` numbers.
    ///
    /// # Errors
    /// Errors of the operating system.
    pub fn open(path: &Path, count: usize) -> io::Result<(Self, Option<Vec<f64>>)> {
        let mut options = OpenOptions::new();
        let file = options.read(true).write(true).create(true).truncate(false).mode(0o600).open(path)?;
        let newest = (0..2).filter_map(|parity| read(&file, parity, count)).max_by_key(|(sequence, _)| *sequence);
        let sequence = newest.as_ref().map_or(0, |(sequence, _)| *sequence);
        Ok((Self { file, sequence }, newest.map(|(_, numbers)| numbers)))
    }

    /// Replaces the older copy.
    ///
    /// # Errors
    /// Errors of the operating system, for example a full disk. The newer copy is then still complete.
    pub fn store(&mut self, numbers: &[f64]) -> io::Result<()> {
        let sequence = self.sequence + 1;
        let copy = encode(sequence, numbers);
        self.file.write_all_at(&copy, offset(sequence, copy.len()))?;
        self.sequence = sequence;
        Ok(())
    }
}

fn offset(sequence: u64, length: usize) -> u64 {
    sequence % 2 * length as u64
}

fn read(file: &File, parity: u64, count: usize) -> Option<(u64, Vec<f64>)> {
    let mut copy = vec![0; HEADER + count * 8];
    let offset = offset(parity, copy.len());
    file.read_exact_at(&mut copy, offset).ok()?;
    decode(&copy).filter(|(sequence, _)| sequence % 2 == parity)
}

fn encode(sequence: u64, numbers: &[f64]) -> Vec<u8> {
    let mut words = vec![FORMAT, sequence, 0];
    words.extend(numbers.iter().map(|number| number.to_bits()));
    words[2] = checksum(&words);
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

fn decode(copy: &[u8]) -> Option<(u64, Vec<f64>)> {
    let mut words: Vec<u64> =
        copy.chunks_exact(8).map(|word| word.try_into().map(u64::from_le_bytes)).collect::<Result<_, _>>().ok()?;
    let found = std::mem::replace(words.get_mut(2)?, 0);
    let complete = words[0] == FORMAT && found == checksum(&words);
    complete.then(|| (words[1], words[3..].iter().map(|word| f64::from_bits(*word)).collect()))
}

/// FNV-1a (Fowler, Noll, Vo) over words: it has to detect torn copies, not attacks.
fn checksum(words: &[u64]) -> u64 {
    words.iter().fold(0xcbf2_9ce4_8422_2325, |sum, word| (sum ^ word).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    const COUNT: usize = 5;

    fn numbers(first: f64) -> Vec<f64> {
        vec![first, -0.0, 1e300, 5e-324, 3.0]
    }

    /// A file with two copies, of which the second is the newest, and what is read after `damage`.
    fn read_after(damage: impl Fn(&mut Vec<u8>)) -> Option<Vec<f64>> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state");
        let (mut file, none) = StateFile::open(&path, COUNT).expect("opened");
        assert_eq!(none, None);
        file.store(&numbers(1.0)).expect("stored");
        file.store(&numbers(2.0)).expect("stored");
        let mut bytes = fs::read(&path).expect("read");
        damage(&mut bytes);
        fs::write(&path, bytes).expect("written");
        StateFile::open(&path, COUNT).expect("opened").1
    }

    #[test]
    fn the_newest_copy_is_read() {
        assert_eq!(read_after(|_| {}), Some(numbers(2.0)));
    }

    #[test]
    fn a_torn_copy_leaves_the_one_before() {
        // Sequence number 2 is the first copy in the file, 1 the second.
        assert_eq!(read_after(|bytes| bytes[HEADER + 3] ^= 1), Some(numbers(1.0)));
        assert_eq!(read_after(|bytes| bytes[8] = 4), Some(numbers(1.0)));
    }

    #[test]
    fn garbage_is_not_a_state() {
        assert_eq!(read_after(|bytes| bytes.fill(7)), None);
        assert_eq!(read_after(|bytes| bytes.truncate(10)), None);
        assert_eq!(read_after(|bytes| bytes.clear()), None);
    }

    #[test]
    fn a_state_of_another_size_is_not_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state");
        let (mut file, _) = StateFile::open(&path, COUNT).expect("opened");
        file.store(&numbers(1.0)).expect("stored");
        assert_eq!(StateFile::open(&path, COUNT + 1).expect("opened").1, None);
    }

    #[test]
    fn numbering_goes_on_after_a_restart() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state");
        for round in 1..=5 {
            let (mut file, last) = StateFile::open(&path, COUNT).expect("opened");
            assert_eq!(last.map(|numbers| numbers[0]), (round > 1).then(|| f64::from(round - 1)));
            file.store(&numbers(f64::from(round))).expect("stored");
        }
    }
}
