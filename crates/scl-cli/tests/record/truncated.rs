//! A small recording, cut at every byte: `recover` keeps what is there, and never fails on what is not.

use super::recorder::{messages, summary};
use super::source::Source;
use scl_record::recover::recover;
use std::fs;

#[test]
fn a_recording_cut_at_every_byte_is_recovered() {
    let mut source = Source::start_with(1);
    // The topology would be an attachment, with many more bytes.
    fs::remove_file(source.rover.path("topology.yaml")).unwrap();
    let recorder = source.record(&["g0"], &["--system", "rover"]);
    source.send_numbers(5);
    recorder.stop();
    let bytes = fs::read(source.rover.path("flight.mcap")).unwrap();
    let whole = messages(&source.rover.path("flight.mcap"));

    let cut = source.rover.path("cut.mcap");
    let mut last = 0;
    for length in 0..bytes.len() {
        fs::write(&cut, &bytes[..length]).unwrap();
        let recovered = match recover(&cut, None) {
            Ok(recovered) => recovered,
            Err(problem) => {
                let expected = match length {
                    0 => "is empty",
                    1..8 => "is not an MCAP file: it is too short",
                    _ => "no message can be recovered",
                };
                assert_eq!(last, 0, "{length} bytes: {problem}");
                assert!(problem.to_string().contains(expected), "{length} bytes: {problem}");
                assert_eq!(fs::read(&cut).unwrap().len(), length);
                continue;
            }
        };
        assert!(!recovered.was_complete, "{length} bytes");
        fs::remove_file(recovered.kept.unwrap()).unwrap();
        let kept = messages(&cut);
        assert_eq!(kept[..], whole[..kept.len()], "{length} bytes");
        assert_eq!(recovered.messages, kept.len() as u64, "{length} bytes");
        assert_eq!(summary(&cut).stats.unwrap().message_count, kept.len() as u64, "{length} bytes");
        assert!(last <= kept.len(), "{length} bytes");
        last = kept.len();
    }
    assert_eq!(last, whole.len());
    assert_eq!(fs::read_dir(source.rover.path("")).unwrap().flatten().filter(is_temporary).count(), 0);
}

#[test]
fn damaged_chunks_are_left_out() {
    let mut source = Source::start();
    let recorder = source.record(&["g0"], &[]);
    source.send_numbers(1000);
    recorder.stop();
    let file = source.rover.path("flight.mcap");
    let bytes = fs::read(&file).unwrap();
    let whole = messages(&file).len();
    for position in (8..bytes.len()).step_by(97) {
        let mut damaged = bytes.clone();
        damaged[position] ^= 0x55;
        fs::write(&file, &damaged).unwrap();
        match recover(&file, None) {
            Ok(recovered) => {
                assert!(recovered.messages <= whole as u64);
                // Damage in the index, or in the end of the file.
                if let Some(kept) = recovered.kept {
                    summary(&file);
                    fs::remove_file(kept).unwrap();
                }
            }
            Err(_) => assert_eq!(fs::read(&file).unwrap(), damaged),
        }
    }
}

fn is_temporary(entry: &fs::DirEntry) -> bool {
    entry.file_name().to_string_lossy().starts_with('.')
}
