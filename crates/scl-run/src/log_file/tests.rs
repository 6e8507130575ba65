//! Logs on disk: what is written is read, also across rotation, restarts and torn lines.

use super::*;

fn folder(root: &Path) -> LogFolder {
    LogFolder::of("rover", &|name| (name == "XDG_STATE_HOME").then(|| root.into())).unwrap()
}

fn entries(reader: &mut LogReader) -> Vec<LogEntry> {
    std::iter::from_fn(|| reader.next_entry().unwrap()).collect()
}

fn texts(reader: &mut LogReader) -> Vec<String> {
    entries(reader).into_iter().map(|entry| entry.text).collect()
}

#[test]
fn lines_are_read_as_they_were_written() {
    let root = tempfile::tempdir().unwrap();
    let folder = folder(root.path());
    let log = LogFile::open(&folder, "sensor").unwrap();
    log.write(LogStream::Stdout, 1, b"speed 1.5 \"m/s\"\t\x1b[31m").unwrap();
    log.write(LogStream::Stderr, 1, b"C:\\x \xff\xfe end").unwrap();
    log.write(LogStream::Stdout, 2, &[b"x".repeat(LONGEST_TEXT - 1), "äöü".into()].concat()).unwrap();
    let read = entries(&mut LogReader::new(&folder, "sensor"));
    assert_eq!(read[0].text, "speed 1.5 \"m/s\"\t\u{1b}[31m");
    assert_eq!((read[0].stream, read[0].run, read[0].escaped, read[0].cut_bytes), (LogStream::Stdout, 1, false, 0));
    assert_eq!((&*read[1].text, read[1].stream, read[1].escaped), ("C:\\\\x \\xff\\xfe end", LogStream::Stderr, true));
    assert_eq!((read[2].text.len(), read[2].run, read[2].cut_bytes), (LONGEST_TEXT - 1, 2, 6));
    assert!(!read[2].escaped, "no character is cut in two");

    let text = fs::read_to_string(folder.path.join("sensor.log")).unwrap();
    let first: serde_json::Value = serde_json::from_str(text.lines().next().unwrap()).unwrap();
    let keys: Vec<&str> = first.as_object().unwrap().keys().map(String::as_str).collect();
    assert_eq!(keys, ["component", "run", "stream", "text", "time"]);

    drop(log);
    let log = LogFile::open(&folder, "sensor").unwrap();
    log.write(LogStream::Stdout, log.begin(LogStream::Stdout), b"again").unwrap();
    assert_eq!(entries(&mut LogReader::new(&folder, "sensor")).last().unwrap().run, 3, "runs are counted on");
}

#[test]
fn old_files_are_dropped_and_a_reader_follows_the_others() {
    let root = tempfile::tempdir().unwrap();
    let folder = folder(root.path());
    let log = LogFile::open(&folder, "sensor").unwrap();
    let mut follower = LogReader::new(&folder, "sensor");
    let padding = "x".repeat(50_000);
    let mut seen = Vec::new();
    for number in 0..500 {
        log.write(LogStream::Stdout, 1, format!("{number} {padding}").as_bytes()).unwrap();
        if number % 70 == 0 {
            seen.extend(texts(&mut follower));
        }
    }
    seen.extend(texts(&mut follower));
    let number = |text: &String| text.split(' ').next().unwrap().parse::<u32>().unwrap();
    assert!(seen.iter().map(number).eq(0..500), "the follower misses nothing");

    let kept: Vec<u32> = texts(&mut LogReader::new(&folder, "sensor")).iter().map(number).collect();
    assert!(kept.len() < 400 && kept.len() > 200 && kept.iter().copied().eq(kept[0]..500), "{}", kept.len());
    assert_eq!(folder.components(), ["sensor"]);
    let files: Vec<u64> = folder.files_of("sensor").iter().map(|file| fs::metadata(file).unwrap().len()).collect();
    assert!(files.len() == 4 && files.iter().all(|length| *length <= LONGEST_FILE), "{files:?}");
}

#[test]
fn torn_and_foreign_lines_are_passed_over() {
    let root = tempfile::tempdir().unwrap();
    let folder = folder(root.path());
    let log = LogFile::open(&folder, "sensor").unwrap();
    log.write(LogStream::Stdout, 1, b"one").unwrap();
    drop(log);
    let mut file = OpenOptions::new().append(true).open(folder.path.join("sensor.log")).unwrap();
    file.write_all(b"nonsense\n\xff\n{\"time\":\"2026").unwrap();
    let log = LogFile::open(&folder, "sensor").unwrap();
    log.write(LogStream::Stdout, 1, b"two").unwrap();
    assert_eq!(texts(&mut LogReader::new(&folder, "sensor")), ["one", "two"]);
}

#[test]
fn a_full_disk_is_reported_once_and_lines_are_tried_again() {
    let root = tempfile::tempdir().unwrap();
    let folder = folder(root.path());
    let log = LogFile::open(&folder, "sensor").unwrap();
    log.write(LogStream::Stdout, 1, b"before").unwrap();
    // Every write to this device fails as on a full disk.
    log.state.lock().unwrap().file = Some(OpenOptions::new().write(true).open("/dev/full").unwrap());
    let error = log.write(LogStream::Stdout, 1, b"lost").unwrap_err();
    assert!(error.starts_with("cannot write the log of `sensor`: No space left on device"), "{error}");
    log.write(LogStream::Stdout, 1, b"lost, too").unwrap();
    log.state.lock().unwrap().file = None;
    log.write(LogStream::Stdout, 1, b"after").unwrap();
    assert_eq!(texts(&mut LogReader::new(&folder, "sensor")), ["before", "after"]);
}

#[test]
fn folders_are_private_and_names_stay_inside() {
    use std::os::unix::fs::PermissionsExt;
    let root = tempfile::tempdir().unwrap();
    let log = LogFile::open(&folder(root.path()), "sensor").unwrap();
    for (path, mode) in [("scl/rover", 0o700), ("scl/rover/sensor.log", 0o600)] {
        assert_eq!(fs::metadata(root.path().join(path)).unwrap().permissions().mode() & 0o777, mode, "{path}");
    }
    drop(log);
    let env = |name: &str| (name == "HOME").then(|| root.path().into());
    assert_eq!(LogFolder::of("rover", &env).unwrap().path, root.path().join(".local/state/scl/rover"));
    assert_eq!(LogFolder::of("../rover", &env), None);
    assert_eq!(LogFolder::of("rover", &|_| None), None);
    assert_eq!(LogFolder::of("rover", &|name| (name == "XDG_STATE_HOME").then(|| "relative".into())), None);
    assert!(LogFile::open(&folder(root.path()), "a/b").is_err());
}
