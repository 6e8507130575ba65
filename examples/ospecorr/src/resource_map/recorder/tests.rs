//! The recorder with real files, and with everything that may be wrong with them.

use std::fs::{self, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::sync::{Arc, Mutex};

use rusqlite::Connection;
use tempfile::TempDir;

use super::*;

const SECOND: i64 = 1_000_000;

/// A recorder, its folder, and what it has reported.
struct Bench {
    folder: TempDir,
    recorder: Recorder,
    lines: Arc<Mutex<Vec<String>>>,
}

impl Bench {
    fn new() -> Self {
        Self::with_max_bytes(100 << 20)
    }

    fn with_max_bytes(max_bytes: u64) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let lines = Arc::default();
        let recorder = recorder(folder.path().join("map.sqlite"), max_bytes, &lines);
        Self { folder, recorder, lines }
    }

    /// As after a restart of the program.
    fn restart(&mut self) {
        self.recorder = recorder(self.path(), 100 << 20, &self.lines);
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("map.sqlite")
    }

    /// Adds a block for each second, and writes each.
    fn record(&mut self, seconds: std::ops::Range<i64>) {
        for second in seconds {
            self.recorder.add(second * SECOND, block());
            self.recorder.flush(second * SECOND).unwrap();
        }
    }

    /// The number of blocks in the last `seconds` before a time.
    fn count(&self, seconds: f64, now: i64) -> Result<u32, String> {
        let statistics = self.recorder.answer(seconds, now * SECOND);
        if statistics.error.is_empty() {
            Ok(statistics.channels.first().map_or(0, |it| it.observations))
        } else {
            Err(statistics.error)
        }
    }

    /// What was reported since the last call, without the folder.
    fn reported(&self) -> Vec<String> {
        let folder = format!("{}/", self.folder.path().display());
        self.lines.lock().unwrap().drain(..).map(|line| line.replace(&folder, "")).collect()
    }

    fn refused(&mut self) -> String {
        let folder = format!("{}/", self.folder.path().display());
        self.recorder.flush(0).unwrap_err().to_string().replace(&folder, "")
    }
}

fn recorder(path: PathBuf, max_bytes: u64, lines: &Arc<Mutex<Vec<String>>>) -> Recorder {
    let lines = Arc::clone(lines);
    Recorder::new(Settings { path, max_bytes }, move |line| lines.lock().unwrap().push(line))
}

/// Two channels, the second of which is occupied.
fn block() -> Vec<Channel> {
    let channel = |power_db, occupied| Channel { power_db, occupied, threshold_db: 3.0 };
    vec![channel(0.0, false), channel(10.0, true)]
}

/// Overwrites bytes from an offset on.
fn damage(path: &Path, offset: u64, length: usize) {
    let mut file = OpenOptions::new().write(true).open(path).unwrap();
    file.seek(SeekFrom::Start(offset)).unwrap();
    file.write_all(&vec![0xA5; length]).unwrap();
}

const HELP: &str = "choose another file with --database, or move this one away";

#[test]
fn observations_survive_a_restart() {
    let mut bench = Bench::new();
    bench.record(100..110);
    bench.restart();
    bench.record(110..111);
    let statistics = bench.recorder.answer(60.0, 111 * SECOND);
    let described: Vec<_> =
        statistics.channels.iter().map(|it| (it.observations, it.occupied, it.mean_power_db.round())).collect();
    assert_eq!(described, [(11, 0.0, 0.0), (11, 1.0, 10.0)]);
    assert_eq!(bench.reported(), Vec::<String>::new());
}

#[test]
fn a_query_looks_back_as_far_as_it_says_also_at_what_is_not_written_yet() {
    let mut bench = Bench::new();
    bench.record(100..110);
    bench.recorder.add(110 * SECOND, block());
    assert_eq!(bench.count(5.0, 110), Ok(6));
    assert_eq!(bench.count(3600.0, 110), Ok(11));
    assert_eq!(bench.count(5.0, 1000), Ok(0));
}

#[test]
fn a_query_for_a_nonsensical_time_is_refused() {
    let mut bench = Bench::new();
    bench.record(100..101);
    for (seconds, told) in [
        (0.0, "0"),
        (-1.0, "-1"),
        (f64::NAN, "NaN"),
        (f64::INFINITY, "inf"),
        (f64::NEG_INFINITY, "-inf"),
        (3600.5, "3600.5"),
    ] {
        assert_eq!(bench.count(seconds, 101), Err(format!("seconds must be above 0 and at most 3600, not {told}")));
    }
}

#[test]
fn what_is_older_than_an_hour_is_removed() {
    let mut bench = Bench::new();
    bench.record(100..110);
    bench.record(3705..3706);
    let database = Connection::open(bench.path()).unwrap();
    let times: Vec<i64> = database
        .prepare("SELECT DISTINCT time_us / 1000000 FROM observation ORDER BY 1")
        .unwrap()
        .query_map([], |row| row.get(0))
        .unwrap()
        .map(Result::unwrap)
        .collect();
    assert_eq!(times, [105, 106, 107, 108, 109, 3705]);
}

#[test]
fn powers_that_are_no_numbers_are_left_out() {
    let mut bench = Bench::new();
    let channel = |power_db| Channel { power_db, occupied: false, threshold_db: 3.0 };
    bench.recorder.add(SECOND, [f64::NAN, f64::NEG_INFINITY, 1.0].map(channel).into());
    bench.recorder.flush(SECOND).unwrap();
    let counts: Vec<_> = bench.recorder.answer(1.0, SECOND).channels.iter().map(|it| it.observations).collect();
    assert_eq!(counts, [0, 0, 1]);
    assert_eq!(bench.reported(), Vec::<String>::new());
}

#[test]
fn a_clock_that_is_set_back_replaces_no_observation() {
    let mut bench = Bench::new();
    for time in [100, 99, 100] {
        bench.recorder.add(time * SECOND, block());
        bench.recorder.flush(time * SECOND).unwrap();
    }
    assert_eq!(bench.count(0.5, 100), Ok(3));
}

#[test]
fn while_another_process_writes_observations_wait_and_queries_are_answered() {
    let mut bench = Bench::new();
    bench.record(100..110);
    let other = Connection::open(bench.path()).unwrap();
    other.execute_batch("BEGIN IMMEDIATE").unwrap();
    bench.record(110..115);
    assert_eq!(
        bench.reported(),
        ["the database `map.sqlite` cannot be written: database is locked; keeping up to 3000 blocks in memory"]
    );
    assert_eq!(bench.count(60.0, 115), Ok(15));

    other.execute_batch("COMMIT").unwrap();
    bench.record(115..116);
    assert_eq!(bench.reported(), ["the database `map.sqlite` can be written again; 0 blocks were lost"]);
    bench.restart();
    bench.record(116..117);
    assert_eq!(bench.count(60.0, 116), Ok(17));
}

#[test]
fn what_waits_in_memory_is_bounded() {
    let mut bench = Bench::new();
    bench.record(100..101);
    let other = Connection::open(bench.path()).unwrap();
    other.execute_batch("BEGIN IMMEDIATE").unwrap();
    for step in 0..MOST_HELD as i64 + 7 {
        bench.recorder.add(200 * SECOND + step, block());
    }
    bench.recorder.flush(201 * SECOND).unwrap();
    other.execute_batch("COMMIT").unwrap();
    bench.recorder.flush(201 * SECOND).unwrap();
    assert_eq!(bench.reported()[1], "the database `map.sqlite` can be written again; 7 blocks were lost");
    assert_eq!(bench.count(2.0, 201), Ok(MOST_HELD as u32));
}

#[test]
fn a_database_that_is_locked_at_the_start_is_opened_later() {
    let mut bench = Bench::new();
    bench.record(100..101);
    bench.restart();
    let other = Connection::open(bench.path()).unwrap();
    other.execute_batch("PRAGMA locking_mode = EXCLUSIVE; BEGIN EXCLUSIVE").unwrap();
    bench.record(101..105);
    assert_eq!(bench.count(60.0, 105), Err("the database is not open yet".to_owned()));
    assert_eq!(bench.reported().len(), 1);

    drop(other);
    bench.record(105..106);
    assert_eq!(bench.count(60.0, 105), Ok(6));
}

#[test]
fn in_a_full_database_the_oldest_observations_make_room() {
    let mut bench = Bench::with_max_bytes(64 << 10);
    bench.record(0..1);
    let reserve = bench.folder.path().join("map.sqlite-reserve");
    assert_eq!(fs::metadata(&reserve).unwrap().len(), RESERVE_BYTES as u64);
    bench.record(1..3000);
    assert!(!reserve.exists(), "removing observations from a full disk needs its room");
    assert_eq!(
        bench.reported(),
        ["the database `map.sqlite` is full; from now on the oldest observations make room for new ones"]
    );
    assert_eq!(bench.count(100.0, 2999), Ok(101), "the newest are all there");
    let kept = bench.count(3600.0, 2999).unwrap();
    assert!((400..2999).contains(&kept), "{kept}");
    assert!(fs::metadata(bench.path()).unwrap().len() <= 64 << 10);
}

#[test]
fn a_corrupt_file_is_moved_aside() {
    // Its header, or the root of its table: the first is no database any more, the second is one with nonsense in it.
    for (offset, length) in [(0, 100), (4096, 200), (0, 1 << 16)] {
        let mut bench = Bench::new();
        bench.record(0..1000);
        bench.recorder.database = None;
        damage(&bench.path(), offset, length);
        let damaged = fs::read(bench.path()).unwrap();
        bench.restart();
        bench.record(1000..1001);
        let [line] = bench.reported().try_into().unwrap();
        assert!(line.starts_with("the database `map.sqlite` is corrupt ("), "{line}");
        assert!(line.ends_with("map.sqlite.corrupt-1`, and a new one begins"), "{line}");
        assert_eq!(fs::read(bench.folder.path().join("map.sqlite.corrupt-1")).unwrap(), damaged);
        assert_eq!(bench.count(3600.0, 1000), Ok(1));
    }
}

#[test]
fn a_file_that_becomes_corrupt_is_moved_aside_and_nothing_new_is_lost() {
    let mut bench = Bench::new();
    bench.record(0..1000);
    // What is in the log is not read from the file.
    Connection::open(bench.path()).unwrap().execute_batch("PRAGMA wal_checkpoint(TRUNCATE)").unwrap();
    fs::write(bench.folder.path().join("map.sqlite.corrupt-1"), "of another day").unwrap();
    damage(&bench.path(), 4096, 1 << 14);
    // Cached pages hide the damage from the connection that is open until another one writes.
    Connection::open(bench.path()).unwrap().execute_batch("PRAGMA user_version = 1").unwrap();
    bench.record(1000..1003);
    let [line] = bench.reported().try_into().unwrap();
    assert!(line.ends_with("map.sqlite.corrupt-2`, and a new one begins"), "{line}");
    assert_eq!(bench.count(3600.0, 1003), Ok(3));
}

#[test]
fn a_text_file_is_moved_aside() {
    let mut bench = Bench::new();
    fs::write(bench.path(), "channel 3 looked free to me\n".repeat(100)).unwrap();
    bench.record(0..1);
    assert_eq!(
        bench.reported(),
        ["the database `map.sqlite` is corrupt (file is not a database); it was moved to `map.sqlite.corrupt-1`, \
          and a new one begins"]
    );
    assert_eq!(bench.count(1.0, 0), Ok(1));
}

#[test]
fn the_database_of_another_program_is_refused() {
    for tables in [
        "CREATE TABLE bookmark (url TEXT)",
        "CREATE TABLE observation (text TEXT); PRAGMA user_version = 1",
        "PRAGMA application_id = 7",
    ] {
        let mut bench = Bench::new();
        Connection::open(bench.path()).unwrap().execute_batch(tables).unwrap();
        let before = fs::read(bench.path()).unwrap();
        assert_eq!(
            bench.refused(),
            format!("cannot use the database `map.sqlite`: it belongs to another program\n  = help: {HELP}")
        );
        assert_eq!(fs::read(bench.path()).unwrap(), before);
    }
}

#[test]
fn a_newer_database_is_refused() {
    let mut bench = Bench::new();
    bench.record(0..10);
    bench.restart();
    Connection::open(bench.path()).unwrap().execute_batch("PRAGMA user_version = 2").unwrap();
    let expected = "it has schema version 2, this program knows version 1";
    assert_eq!(bench.refused(), format!("cannot use the database `map.sqlite`: {expected}\n  = help: {HELP}"));
}

#[test]
fn a_path_that_cannot_be_a_database_is_refused() {
    let mut bench = Bench::new();
    fs::create_dir(bench.path()).unwrap();
    assert!(bench.refused().contains("unable to open database file"));

    let path = bench.folder.path().join("missing/map.sqlite");
    bench.recorder = recorder(path, 1 << 20, &bench.lines);
    assert!(bench.refused().contains("unable to open database file"));
}
