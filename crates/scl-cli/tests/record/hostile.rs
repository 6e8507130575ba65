//! Recordings with lengths that nothing in the file backs: no command reserves memory for them, and none replaces a
//! file by less than it had.

use crate::system::System;
use mcap::Compression;
use mcap::records::op;
use scl_plan::SystemPlan;
use scl_record::format::Totals;
use scl_record::testing::{Recorder, Sample};
use std::collections::BTreeMap;
use std::fs;
use std::process::Command;

const SAMPLES: [Sample<'_>; 2] = [("/sensor/measurements", 0, "first"), ("/sensor/measurements", 10, "second")];

/// `scl` with at most a gibibyte of address space, of which its program takes a part.
fn limited(system: &System, arguments: &[&str]) -> (Option<i32>, String) {
    let scl = system.scl(&[]);
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -v 1048576; exec \"$0\" \"$@\""]).arg(scl.get_program()).args(arguments);
    let output = command.current_dir(system.path("")).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

/// The content of a record with this opcode, by its position after the magic bytes.
fn records(bytes: &[u8]) -> impl Iterator<Item = (u8, std::ops::Range<usize>)> {
    let mut at = 8;
    std::iter::from_fn(move || {
        let length: [u8; 8] = bytes.get(at + 1..at + 9)?.try_into().unwrap();
        let content = at + 9..at + 9 + usize::try_from(u64::from_le_bytes(length)).unwrap();
        let record = (bytes[at], content.clone());
        at = content.end;
        Some(record)
    })
}

/// Where lengths stand in the content of records.
const LENGTHS: [(u8, usize); 6] =
    [(op::HEADER, 0), (op::ATTACHMENT, 16), (op::CHUNK, 16), (op::CHUNK, 28), (op::CHUNK, 35), (op::METADATA, 0)];

#[test]
fn announced_lengths_reserve_no_memory() {
    let system = System::of_files(&[]);
    let plan = SystemPlan { system: "rover".to_owned(), components: Vec::new(), kinds: Vec::new() };
    let totals = Totals { system: "rover".to_owned(), gates: BTreeMap::new() };
    let sound = |compression| {
        let recorder = Recorder::with_compression(Some(compression)).attach_plan(&plan);
        recorder.messages(&SAMPLES).end_chunk().totals(&totals).finish()
    };
    let recordings = [sound(Compression::Lz4), sound(Compression::Zstd)];
    for (sound, (opcode, offset)) in recordings.iter().flat_map(|sound| LENGTHS.map(|length| (sound, length))) {
        let _removed = fs::remove_file(system.path(&format!("{opcode}_{offset}.mcap")));
        let content = records(sound).find(|(found, _)| *found == opcode).unwrap().1;
        let mut damaged = sound.clone();
        damaged[content.start + offset..][..4].copy_from_slice(&0xffff_fff0_u32.to_le_bytes());
        fs::write(system.path("damaged.mcap"), &damaged).unwrap();
        let output = format!("{opcode}_{offset}.mcap");
        for arguments in [&["recover", "damaged.mcap", "-o", &output][..], &["compare", "damaged.mcap", "damaged.mcap"]]
        {
            let (code, error) = limited(&system, arguments);
            assert!(matches!(code, Some(0 | 2)), "{opcode} {offset} {arguments:?}: {code:?} {error}");
        }
    }
}

#[test]
fn a_file_is_not_replaced_by_an_empty_recording() {
    let system = System::of_files(&[]);
    let sound = Recorder::new().messages(&SAMPLES).end_chunk().finish();
    let chunk = records(&sound).find(|(opcode, _)| *opcode == op::CHUNK).unwrap().1;
    for length in [8, 20, chunk.start - 9, chunk.start] {
        fs::write(system.path("stub.mcap"), &sound[..length]).unwrap();
        let output = system.scl(&["recover", "stub.mcap"]).output().unwrap();
        let error = "error: no message can be recovered from `stub.mcap`\n  = note: the file was not changed\n";
        assert_eq!(String::from_utf8_lossy(&output.stderr), error, "{length}");
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
        assert_eq!(fs::read(system.path("stub.mcap")).unwrap(), sound[..length]);
        assert_eq!(fs::read_dir(system.path("")).unwrap().count(), 1);
    }
}

#[test]
fn a_closed_file_is_not_replaced_by_less() {
    let system = System::of_files(&[]);
    let text = "x".repeat(1000);
    let many: Vec<Sample<'_>> = (0..20).map(|at| ("/sensor/measurements", at, &*text)).collect();
    let recorder = Recorder::new().messages(&SAMPLES).end_chunk();
    let recorder = many.iter().fold(recorder, |recorder, sample| recorder.messages(&[*sample]).end_chunk());
    let mut damaged = recorder.finish();
    // An opcode that does not exist, after the first chunk.
    let second = records(&damaged).filter(|(opcode, _)| *opcode == op::CHUNK).nth(1).unwrap().1;
    damaged[second.start - 9] = 0;
    fs::write(system.path("flight.mcap"), &damaged).unwrap();
    let output = system.scl(&["recover", "flight.mcap"]).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    let help = "= help: `scl recover flight.mcap -o FILE` writes the 2 messages that can be read\n";
    assert!(error.contains(help), "{error}");
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(fs::read(system.path("flight.mcap")).unwrap(), damaged);
    let output = system.scl(&["recover", "flight.mcap", "-o", "whole.mcap"]).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.starts_with("whole.mcap: recovered 2 messages, "), "{output:?}");
    assert!(text.ends_with("B were incomplete or damaged\n"), "{output:?}");
}
