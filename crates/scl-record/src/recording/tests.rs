use super::*;
use crate::testing::{BEGINNING, Recorder, Sample, write_file};
use expect_test::expect;
use mcap::{WriteOptions, Writer};
use scl_plan::SystemPlan;
use std::collections::BTreeMap;
use std::io::Cursor;

const SAMPLES: [Sample<'_>; 4] = [
    ("/sensor/measurements", 0, "first"),
    ("/sensor/measurements", 10, "second"),
    ("/controller/commands/request", 15, "third"),
    ("/sensor/measurements", 20, "fourth"),
];

fn plan() -> SystemPlan {
    SystemPlan { system: "rover".to_owned(), components: Vec::new(), kinds: Vec::new() }
}

/// Two chunks, an attachment before and the totals behind them.
fn small_recording() -> Vec<u8> {
    let gates = BTreeMap::from([("sensor.measurements".to_owned(), GateTotals { recorded: 3, lost: 2, latched: 0 })]);
    let totals = Totals { system: "rover".to_owned(), gates };
    let recorder = Recorder::new().attach_plan(&plan()).messages(&SAMPLES[..2]).end_chunk();
    recorder.messages(&SAMPLES[2..]).end_chunk().totals(&totals).finish()
}

fn read_all(messages: &mut Messages) -> Result<Vec<String>, Problem> {
    let mut read = Vec::new();
    while let Some(message) = messages.read()? {
        let topic = &messages.channels()[message.channel].topic;
        let at = message.sent_ns / 1_000_000 - BEGINNING;
        read.push(format!("{topic} {at} {}", String::from_utf8_lossy(&message.payload)));
    }
    Ok(read)
}

fn read_file(path: &Path) -> Result<(Recording, Vec<String>), Problem> {
    let recording = Recording::open(&[path.to_owned()])?;
    let read = read_all(&mut recording.messages())?;
    Ok((recording, read))
}

fn expected() -> Vec<String> {
    SAMPLES.iter().map(|(topic, at, payload)| format!("{topic} {at} {payload}")).collect()
}

#[test]
fn a_recording_is_read_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_file(folder.path(), "flight.mcap", &small_recording());
    let (recording, read) = read_file(&path).unwrap();
    assert_eq!(read, expected());
    assert_eq!(recording.plan().unwrap(), Some(plan()));
    assert_eq!(recording.duration(), Duration::from_millis(20));
    assert_eq!(recording.notes(), ["the recorder lost 2 messages of `sensor.measurements`"]);
}

#[test]
fn a_file_cut_at_any_byte_gives_what_is_there() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, all) = (small_recording(), expected());
    let mut most = 0;
    for length in 0..whole.len() {
        let path = write_file(folder.path(), "cut.mcap", &whole[..length]);
        match read_file(&path) {
            Ok((recording, read)) => {
                assert!(all.starts_with(&read) && read.len() >= most, "{read:?} after {length} bytes");
                most = read.len();
                let notes = recording.notes().join("\n");
                // What follows the end of the data is an index, which is not read.
                let is_cut = notes.contains("in the middle of a record") || notes.contains("was not closed");
                assert!(is_cut || read == all && notes.contains("lost 2 messages"), "{notes} after {length} bytes");
            }
            Err(problem) => assert!(length == 0, "{problem} after {length} bytes"),
        }
    }
    assert_eq!(most, all.len());
}

#[test]
fn a_chunk_that_was_cut_off_gives_the_messages_before_the_cut() {
    let folder = tempfile::tempdir().unwrap();
    let whole = Recorder::with_compression(None).messages(&SAMPLES[..2]).end_chunk().finish();
    let second = whole.windows(6).position(|window| window == b"second").unwrap();
    let path = write_file(folder.path(), "cut.mcap", &whole[..second]);
    assert_eq!(read_file(&path).unwrap().1, expected()[..1]);
}

#[test]
fn a_damaged_byte_is_an_error_or_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, all) = (small_recording(), expected());
    let mut damaged = 0;
    for index in 0..whole.len() {
        let mut bytes = whole.clone();
        bytes[index] ^= 0x41;
        let path = write_file(folder.path(), "damaged.mcap", &bytes);
        match read_file(&path) {
            // Lengths of records may look as if the file was cut off, opcodes as if they were for other programs.
            Ok((_, read)) => assert!(read.iter().all(|message| all.contains(message)), "{read:?} at byte {index}"),
            Err(problem) => damaged += usize::from(problem.to_string().contains("is damaged")),
        }
    }
    assert!(damaged > 100, "{damaged}");
}

#[test]
fn a_chunk_with_a_wrong_checksum_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let options = WriteOptions::new().profile("scl").compression(None).disable_seeking(true);
    let mut writer: Writer<_> = options.create(Cursor::new(Vec::new())).unwrap();
    let metadata = ["kind", "codec", "contract", "peers"].map(|key| (key.to_owned(), "pub".to_owned()));
    let channel = writer.add_channel(0, "/a/b", "", &metadata.into()).unwrap();
    let header = mcap::records::MessageHeader { channel_id: channel, sequence: 0, log_time: 1, publish_time: 1 };
    writer.write_to_known_channel(&header, b"payload").unwrap();
    writer.finish().unwrap();
    let mut bytes = writer.into_inner().into_inner();
    let at = bytes.windows(7).position(|bytes| bytes == b"payload").unwrap();
    bytes[at] = b'P';
    let path = write_file(folder.path(), "damaged.mcap", &bytes);
    let problem = read_file(&path).unwrap_err().to_string();
    assert!(problem.contains("error: the recording is damaged: a chunk has a wrong checksum"), "{problem}");
    assert!(problem.contains("= help: `scl recover "), "{problem}");
}

#[test]
fn parts_are_read_in_order_whatever_the_order_of_the_arguments() {
    let folder = tempfile::tempdir().unwrap();
    for (name, samples) in [("flight_10.mcap", &SAMPLES[2..]), ("flight_9.mcap", &SAMPLES[..2])] {
        Recorder::new().messages(samples).write_to(folder.path(), name);
    }
    Recorder::new().messages(&SAMPLES).write_to(folder.path(), "flights.mcap");
    let arguments = [
        vec!["flight_10.mcap", "flight_9.mcap"],
        vec!["flight_*.mcap"],
        // The name that was given to `scl record --split`.
        vec!["flight.mcap"],
        vec!["flight"],
    ];
    for names in arguments {
        let names: Vec<_> = names.iter().map(|name| folder.path().join(name)).collect();
        let recording = Recording::open(&find_files(&names).unwrap()).unwrap();
        assert_eq!(read_all(&mut recording.messages()).unwrap(), expected(), "{names:?}");
        assert_eq!(recording.duration(), Duration::from_millis(20));
    }
}

#[test]
fn what_is_no_recording_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut problems = String::new();
    for (name, content) in [("empty", &b""[..]), ("text", b"speed,time\n1,2\n")] {
        let path = write_file(folder.path(), name, content);
        let problem = read_file(&path).unwrap_err().to_string();
        problems += &problem.replace(&folder.path().display().to_string(), "");
    }
    problems +=
        &read_file(folder.path()).unwrap_err().to_string().replace(&folder.path().display().to_string(), "/folder");
    problems += &find_files(&["no_such.mcap".into()]).unwrap_err().to_string();
    expect![[r#"
        error: the recording `/empty` is empty
          = help: the recorder was stopped before it wrote anything, or the disk was full
        error: `/text` is not a recording
          = help: recordings are MCAP files, written by `scl record`
        error: `/folder` is not a file
          = help: name a file written by `scl record`
        error: there is no file `no_such.mcap`
          = help: name a file written by `scl record`
    "#]]
    .assert_eq(&problems);
}

#[test]
fn copies_with_another_profile_or_compression_are_read() {
    let folder = tempfile::tempdir().unwrap();
    for profile in ["", "ros2"] {
        let path = Recorder::with_profile(profile).messages(&SAMPLES).write_to(folder.path(), "copy.mcap");
        assert_eq!(read_file(&path).unwrap().1, expected());
    }
    for compression in [None, Some(mcap::Compression::Lz4), Some(mcap::Compression::Zstd)] {
        let path = Recorder::with_compression(compression).messages(&SAMPLES).write_to(folder.path(), "copy.mcap");
        assert_eq!(read_file(&path).unwrap().1, expected());
    }
}

/// Topics of other programs, some of which look almost like ours, among those of SCL: before, between and after them,
/// with schemas of other encodings, and with the profile of another program.
#[test]
fn topics_of_other_programs_are_left_out_and_named() {
    let others = [("/tf", "cdr", "ros2msg"), ("/a/b", "json", "jsonschema"), ("/a/b/c", "flatbuffer", "")];
    let folder = tempfile::tempdir().unwrap();
    let mut recorder = Recorder::with_profile("ros2");
    for (at, sample) in SAMPLES.iter().enumerate() {
        for other in &others[..at.min(3)] {
            recorder = recorder.other_message(*other, b"\0\x01\0\0");
        }
        recorder = recorder.messages(&[*sample]).end_chunk();
    }
    let path = recorder.write_to(folder.path(), "mixed.mcap");
    let (recording, read) = read_file(&path).unwrap();
    assert_eq!(read, expected());
    let survey = recording.survey().unwrap();
    assert_eq!(survey.topics.values().map(|topic| topic.messages).collect::<Vec<_>>(), [1, 3]);
    expect![[r#"
        `/tf` was not recorded by SCL: it is not `/<component>/<gate>`; messages left out: 3
        `/a/b` was not recorded by SCL: its metadata has no `kind`, `codec`, `contract`, `peers`; messages left out: 2
        `/a/b/c` was not recorded by SCL: it is not `/<component>/<gate>`; messages left out: 1"#]]
    .assert_eq(&survey.notes().join("\n"));
}
