use super::*;
use crate::testing::{Recorder, Sample, write_file};
use mcap::Compression;

const COMPRESSIONS: [Option<Compression>; 3] = [None, Some(Compression::Lz4), Some(Compression::Zstd)];
const SAMPLES: [Sample<'_>; 3] =
    [("/sensor/measurements", 0, "first"), ("/sensor/measurements", 10, "second"), ("/sensor/log", 20, "third")];

/// A recording of two chunks with two messages and one.
fn recording(compression: Option<Compression>) -> Vec<u8> {
    let recorder = Recorder::with_compression(compression).messages(&SAMPLES[..2]).end_chunk();
    recorder.messages(&SAMPLES[2..]).end_chunk().finish()
}

fn payloads(path: &Path) -> Vec<String> {
    let mut messages = crate::recording::Recording::open(&[path.to_owned()]).unwrap().messages();
    let read = std::iter::from_fn(|| messages.read().unwrap());
    read.map(|message| String::from_utf8(message.payload.to_vec()).unwrap()).collect()
}

fn find(bytes: &[u8], part: &[u8]) -> usize {
    bytes.windows(part.len()).position(|window| window == part).unwrap()
}

fn files(folder: &Path) -> usize {
    fs::read_dir(folder).unwrap().count()
}

#[test]
fn a_complete_file_of_any_compression_is_left_as_it_is() {
    for compression in COMPRESSIONS {
        let folder = tempfile::tempdir().unwrap();
        let whole = recording(compression);
        let path = write_file(folder.path(), "flight.mcap", &whole);
        let recovered = recover(&path, None).unwrap();
        assert_eq!((recovered.messages, recovered.dropped, recovered.was_complete), (3, 0, true), "{compression:?}");
        assert_eq!((fs::read(&path).unwrap(), files(folder.path())), (whole, 1), "{compression:?}");
        assert_eq!(payloads(&path), ["first", "second", "third"], "{compression:?}");
    }
}

#[test]
fn a_file_that_was_cut_off_stays_beside_the_complete_one() {
    for compression in COMPRESSIONS {
        let folder = tempfile::tempdir().unwrap();
        let whole = recording(compression);
        let cut = &whole[..whole.len() - 40];
        let path = write_file(folder.path(), "flight.mcap", cut);
        let recovered = recover(&path, None).unwrap();
        let kept = folder.path().join("flight.mcap.bak");
        assert_eq!((recovered.messages, recovered.kept.as_deref()), (3, Some(&*kept)), "{compression:?}");
        assert_eq!(fs::read(&kept).unwrap(), cut);
        assert_eq!(payloads(&path), ["first", "second", "third"], "{compression:?}");

        // The name is taken: nothing is overwritten.
        fs::write(&path, cut).unwrap();
        let problem = recover(&path, None).unwrap_err().to_string();
        assert!(problem.starts_with("error: cannot keep the damaged file as `"), "{problem}");
        assert_eq!((fs::read(&path).unwrap(), files(folder.path())), (cut.to_vec(), 2));
    }
}

#[test]
fn chunks_of_an_unknown_compression_are_not_thrown_away() {
    let folder = tempfile::tempdir().unwrap();
    let mut bytes = recording(Some(Compression::Zstd));
    let first = find(&bytes, b"zstd");
    let second = first + 4 + find(&bytes[first + 4..], b"zstd");
    bytes[second..second + 4].copy_from_slice(b"brot");
    for output in [None, Some(folder.path().join("whole.mcap"))] {
        // One chunk is readable, the other one is not.
        let path = write_file(folder.path(), "flight.mcap", &bytes);
        let recovered = recover(&path, output.as_deref());
        match output {
            Some(output) => {
                let Recovered { messages, dropped, was_complete, .. } = recovered.unwrap();
                assert!(dropped > 0 && !was_complete && messages == 2);
                assert_eq!(payloads(&output), ["first", "second"]);
            }
            None => {
                let problem = recovered.unwrap_err().to_string();
                assert!(problem.contains("chunks are compressed with `brot`; scl reads lz4 and zstd"), "{problem}");
                assert!(problem.contains("-o FILE` writes the 2 messages that can be read"), "{problem}");
            }
        }
        assert_eq!(fs::read(&path).unwrap(), bytes);
    }
    bytes[first..first + 4].copy_from_slice(b"brot");
    let path = write_file(folder.path(), "flight.mcap", &bytes);
    for output in [None, Some(&*folder.path().join("none.mcap"))] {
        let problem = recover(&path, output).unwrap_err().to_string();
        assert!(problem.contains("no message can be recovered"), "{problem}");
        assert!(problem.contains("compressed with `brot`"), "{problem}");
        assert_eq!((fs::read(&path).unwrap(), files(folder.path())), (bytes.clone(), 2));
    }
}

#[test]
fn a_closed_file_with_damage_is_never_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let whole = recording(None);
    // A wrong checksum, a length behind the end of the file, an opcode that does not exist, no such channel.
    let second = find(&whole, b"third");
    let chunk = whole[..second].iter().rposition(|byte| *byte == mcap::records::op::CHUNK).unwrap();
    for (at, byte) in [(second, b'T'), (chunk + 6, 0xff), (chunk, 0), (second - 22, 9)] {
        let mut damaged = whole.clone();
        damaged[at] = byte;
        let path = write_file(folder.path(), "flight.mcap", &damaged);
        let problem = recover(&path, None).unwrap_err().to_string();
        assert!(problem.contains("was closed properly, but"), "{at}: {problem}");
        assert_eq!((fs::read(&path).unwrap(), files(folder.path())), (damaged, 1), "{at}");
        let output = folder.path().join("whole.mcap");
        assert_eq!(recover(&path, Some(&output)).unwrap().messages, 2, "{at}");
        assert_eq!(payloads(&output), ["first", "second"], "{at}");
        fs::remove_file(output).unwrap();
    }
}

#[test]
fn records_of_other_programs_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let whole = Recorder::new().messages(&SAMPLES).private_record(0x93, b"of another program").finish();
    let path = write_file(folder.path(), "flight.mcap", &whole[..whole.len() - 1]);
    recover(&path, None).unwrap();
    find(&fs::read(&path).unwrap(), b"of another program");
}
