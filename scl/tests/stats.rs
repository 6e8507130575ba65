//! What tools read of components: their stats, announcements, schemas, and which of them run.
#![allow(clippy::unwrap_used)]

use crate::untyped::plan;
use bytes::Bytes;
use scl::runtime_dir::{
    Announcement, ComponentProcess, ComponentState, ComponentStats, GateFigures, RuntimeDir, RuntimeDirError, SystemDir,
};
use scl::untyped::Component;
use scl::{OpenOptions, TransportKind};
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::path::Path;
use std::time::{Duration, SystemTime};
use tempfile::TempDir;

const LONG: Duration = Duration::from_secs(300);

struct Stage {
    root: TempDir,
    options: OpenOptions,
}

impl Stage {
    fn new() -> Self {
        let root = tempfile::tempdir().unwrap();
        let options = OpenOptions::new().runtime_dir(root.path()).transport_kind(TransportKind::Ipc);
        Self { root, options }
    }

    fn runtime_dir(&self) -> RuntimeDir {
        RuntimeDir::existing(&|name| (name == "SCL_RUNTIME_DIR").then(|| self.root.path().into())).unwrap().unwrap()
    }

    fn dir(&self) -> SystemDir {
        self.runtime_dir().existing_system("untyped").unwrap().unwrap()
    }

    fn open(&self, component: &str) -> Component {
        Component::open_blocking_with(&plan(component), self.options.clone()).unwrap()
    }

    /// Waits until the stats of a component are as expected.
    #[track_caller]
    fn stats(&self, component: &str, expected: impl Fn(&ComponentStats) -> bool) -> ComponentStats {
        let (dir, started) = (self.dir(), SystemTime::now());
        loop {
            let found = ComponentStats::read(&dir, component);
            if let Some(found) = found.clone().filter(|found| found.written >= started && expected(found)) {
                return found;
            }
            assert!(started.elapsed().unwrap() < LONG, "{found:#?}");
            std::thread::park_timeout(Duration::from_millis(1));
        }
    }
}

fn gate<'s>(stats: &'s ComponentStats, component: &str, name: &str) -> &'s GateFigures {
    &stats.gates[plan(component).gates.iter().position(|gate| gate.name == name).unwrap()]
}

/// The promise: the stats say what each gate and connection did, at both ends.
#[test]
fn stats_are_what_the_gates_count() {
    let stage = Stage::new();
    let mut sensor = stage.open("sensor");
    let written = stage.stats("sensor", |_| true);
    assert!(!written.ready);
    assert_eq!((written.pid, written.period), (std::process::id(), Duration::from_millis(500)));
    assert_eq!(Some(written.started), Announcement::read(&stage.dir(), "sensor").map(|found| found.started));
    let mut controller = stage.open("controller");
    controller.ready_blocking(LONG).unwrap();
    sensor.ready_blocking(LONG).unwrap();

    let mut raw = (sensor.publisher("raw").unwrap(), controller.subscriber("raw").unwrap());
    let mut work = (sensor.pusher("work").unwrap(), controller.puller("work").unwrap());
    let mut calibrate = (controller.requester("calibrate").unwrap(), sensor.replier("calibrate").unwrap());
    for _ in 0..3 {
        raw.0.send_blocking(&Bytes::from_static(b"12345")).unwrap();
        raw.1.recv_blocking().unwrap();
        work.0.send_blocking(&Bytes::from_static(b"1")).unwrap();
        work.1.recv_blocking().unwrap();
    }
    std::thread::scope(|threads| {
        threads.spawn(|| calibrate.1.recv_blocking().unwrap().reply(&Bytes::from_static(b"yes")).unwrap());
        calibrate.0.call_blocking(&Bytes::from_static(b"?")).unwrap();
    });

    let found = stage.stats("sensor", |found| {
        let raw = gate(found, "sensor", "raw");
        found.ready && raw.connections[0].taken == 3 && gate(found, "sensor", "calibrate").received == 1
    });
    let raw = gate(&found, "sensor", "raw");
    // What waits for the optional logger counts, too.
    assert_eq!((raw.sent, raw.bytes, raw.peers, raw.tap_dropped), (3, 15, 1, 0));
    assert!(raw.connections[0].connected && !raw.connections[1].connected);
    assert_eq!((raw.connections[0].taken, raw.connections[0].waiting), (3, 0));
    assert_eq!(raw.waiting, raw.connections[1].waiting);
    assert!(raw.last_activity.unwrap() <= SystemTime::now() && raw.last_activity > Some(written.started));
    let calibrated = gate(&found, "sensor", "calibrate");
    assert_eq!((calibrated.received, calibrated.peers), (1, 1));
    assert_eq!((calibrated.connections[0].connected, calibrated.connections[0].taken), (true, 1));
    assert_eq!(gate(&found, "sensor", "measurements").last_activity, None);

    let found = stage.stats("controller", |found| gate(found, "controller", "calibrate").received == 1);
    assert!(found.ready);
    let raw = gate(&found, "controller", "raw");
    assert_eq!((raw.received, raw.bytes, raw.waiting, raw.connections[0].taken), (3, 15, 0, 3));
    assert_eq!(gate(&found, "controller", "work").received, 3);
    let called = gate(&found, "controller", "calibrate");
    assert_eq!((called.sent, called.peers, called.connections[0].taken, called.waiting), (1, 1, 1, 0));

    // A gate that was dropped keeps its counts and has no peers; a peer that has gone makes its component not ready.
    drop(work.0);
    let found = stage.stats("sensor", |found| gate(found, "sensor", "work").peers == 0);
    assert_eq!(gate(&found, "sensor", "work").sent, 3);
    drop((controller, raw, work.1, calibrate.0));
}

/// The promise: the file exists while the component does, is private, and comes back when the folder is removed.
#[test]
fn the_file_lives_as_long_as_the_component() {
    let stage = Stage::new();
    let sensor = stage.open("sensor");
    let path = stage.root.path().join("untyped/sensor.stats");
    assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o7777, 0o600);
    stage.stats("sensor", |_| true);
    fs::remove_file(&path).unwrap();
    wait_until(|| path.exists());
    stage.stats("sensor", |_| true);
    fs::remove_dir_all(stage.root.path().join("untyped")).unwrap();
    wait_until(|| path.exists());
    stage.stats("sensor", |_| true);
    // In place: the file stays the same one.
    let inode = fs::metadata(&path).unwrap().ino();
    stage.stats("sensor", |_| true);
    assert_eq!(fs::metadata(&path).unwrap().ino(), inode);
    sensor.close_blocking(LONG).unwrap();
    assert!(!path.exists());
    assert_eq!(ComponentStats::read(&stage.dir(), "sensor"), None);
}

/// The promise: a thread that is blocked in a call for long, and one that computes, are seen with what they did before.
#[test]
fn a_component_that_waits_or_computes_is_seen() {
    let stage = Stage::new();
    let (mut sensor, mut controller) = (stage.open("sensor"), stage.open("controller"));
    let mut received = controller.subscriber("raw").unwrap();
    let mut raw = sensor.publisher("raw").unwrap();
    std::thread::scope(|threads| {
        threads.spawn(|| while received.recv_blocking().unwrap() != "end" {});
        raw.send_blocking(&Bytes::from_static(b"1")).unwrap();
        // No call of this thread drives a runtime from here on.
        stage.stats("controller", |found| gate(found, "controller", "raw").received == 1);
        stage.stats("sensor", |found| gate(found, "sensor", "raw").connections[0].taken == 1);
        raw.send_blocking(&Bytes::from_static(b"end")).unwrap();
    });
}

/// The promise: whatever lies in the folder, reading it does no harm and returns nothing that was not written.
#[test]
fn garbage_is_no_stats() {
    let stage = Stage::new();
    let sensor = stage.open("sensor");
    stage.stats("sensor", |_| true);
    let whole = fs::read(stage.root.path().join("untyped/sensor.stats")).unwrap();
    let (dir, path) = (stage.dir(), stage.root.path().join("untyped/other.stats"));
    for length in 0..whole.len() {
        fs::write(&path, &whole[..length]).unwrap();
        assert_eq!(ComponentStats::read(&dir, "other"), None, "{length} bytes");
    }
    for at in 0..whole.len() {
        let mut wrong = whole.clone();
        wrong[at] ^= 0x80;
        fs::write(&path, &wrong).unwrap();
        // Times and counts may be any.
        let _any = ComponentStats::read(&dir, "other");
    }
    // Its two counters differ for good: a write that was never completed.
    let mut torn = whole.clone();
    torn[16] ^= 1;
    fs::write(&path, &torn).unwrap();
    assert_eq!(ComponentStats::read(&dir, "other"), None);
    fs::remove_file(&path).unwrap();
    symlink(stage.root.path().join("untyped/sensor.stats"), &path).unwrap();
    assert_eq!(ComponentStats::read(&dir, "other"), None, "through a link");
    fs::remove_file(&path).unwrap();
    fs::create_dir(&path).unwrap();
    assert_eq!(ComponentStats::read(&dir, "other"), None, "a folder");
    let huge = fs::File::create(stage.root.path().join("untyped/huge.stats")).unwrap();
    huge.set_len(1 << 40).unwrap();
    assert_eq!(ComponentStats::read(&dir, "huge"), None);
    assert_eq!(ComponentStats::read(&dir, "../untyped/sensor"), None);
    drop(sensor);
}

/// The promise: what is read is a whole write, never parts of two. The component writes as often as it can here.
#[test]
fn a_read_is_never_torn() {
    const READS: u32 = 20_000;
    let stage = Stage::new();
    let mut sensor = stage.open("sensor");
    let mut raw = sensor.publisher("raw").unwrap();
    let dir = stage.dir();
    // What a writer does, again and again without a pause, on a copy of the file.
    let mut block = fs::read(stage.root.path().join("untyped/sensor.stats")).unwrap();
    let path = stage.root.path().join("untyped/racer.stats");
    fs::write(&path, &block).unwrap();
    raw.send_blocking(&Bytes::new()).unwrap();
    let stop = std::sync::atomic::AtomicBool::new(false);
    let counts = std::thread::scope(|threads| {
        threads.spawn(|| {
            use std::os::unix::fs::FileExt;
            let file = fs::File::options().write(true).open(&path).unwrap();
            let (end, gates) = (block.len() - 8, 72);
            for number in 1_u64.. {
                // All counts of a gate are the number of the write.
                for at in (gates..gates + 96).step_by(8) {
                    block[at..at + 8].copy_from_slice(&number.to_le_bytes());
                }
                file.write_at(&number.to_le_bytes(), 16).unwrap();
                file.write_at(&block[24..end], 24).unwrap();
                file.write_at(&number.to_le_bytes(), end as u64).unwrap();
                if stop.load(std::sync::atomic::Ordering::Relaxed) {
                    return;
                }
            }
        });
        let mut counts = BTreeMap::new();
        for _ in 0..READS {
            if let Some(found) = ComponentStats::read(&dir, "racer") {
                let gate = &found.gates[0];
                assert!(gate.peers == gate.sent && gate.bytes == gate.sent, "{gate:?}");
                *counts.entry(gate.sent).or_insert(0) += 1;
            }
        }
        stop.store(true, std::sync::atomic::Ordering::Relaxed);
        counts
    });
    assert!(counts.len() > 10, "only {} writes were seen", counts.len());
}

/// The promise: looking creates nothing, and refuses what is not safe.
#[test]
fn looking_changes_nothing() {
    let root = tempfile::tempdir().unwrap();
    let env = |path: &Path| {
        let path = path.to_owned();
        move |name: &str| (name == "SCL_RUNTIME_DIR").then(|| path.clone().into())
    };
    let missing = root.path().join("missing");
    assert_eq!(RuntimeDir::existing(&env(&missing)).unwrap(), None);
    assert!(!missing.exists());
    symlink(root.path(), &missing).unwrap();
    assert!(matches!(RuntimeDir::existing(&env(&missing)), Err(RuntimeDirError::NotAFolder { .. })));

    let dir = RuntimeDir::existing(&env(root.path())).unwrap().unwrap();
    assert_eq!(dir.systems().unwrap(), Vec::<String>::new());
    assert!(dir.existing_system("rover").unwrap().is_none());
    assert!(!root.path().join("rover").exists());
    assert!(matches!(dir.existing_system("../rover"), Err(RuntimeDirError::BadName { .. })));
    for name in ["rover", "boat", ".hidden", "with space", "line\nbreak"] {
        fs::create_dir(root.path().join(name)).unwrap();
    }
    fs::write(root.path().join("file"), "").unwrap();
    symlink("/", root.path().join("link")).unwrap();
    assert_eq!(dir.systems().unwrap(), ["boat", "rover"]);
    fs::set_permissions(root.path().join("rover"), fs::Permissions::from_mode(0o755)).unwrap();
    assert!(matches!(dir.existing_system("rover"), Err(RuntimeDirError::OpenToOthers { .. })));
    fs::set_permissions(root.path().join("rover"), fs::Permissions::from_mode(0o700)).unwrap();

    let rover = dir.existing_system("rover").unwrap().unwrap();
    // An old temporary file, which opening the system for a component would remove.
    let stale = root.path().join("rover/.00000a");
    fs::File::create(&stale).unwrap().set_modified(SystemTime::UNIX_EPOCH).unwrap();
    for name in ["b.json", "a.lock", "b.lock", "c.json", "1111.schema", "x.stats", "a.out.aaaa", ".lock", "d e.json"] {
        fs::write(root.path().join("rover").join(name), "").unwrap();
    }
    symlink("a.lock", root.path().join("rover/link.lock")).unwrap();
    fs::create_dir(root.path().join("rover/folder.json")).unwrap();
    assert_eq!(rover.components().unwrap(), ["a", "b", "c"]);
    let states = ["a", "b", "unknown", "../a", "folder", "link"].map(|name| rover.state(name));
    assert_eq!(states.map(|state| state == ComponentState::Dead), [false, true, false, false, false, false]);
    assert!(states.iter().all(|state| matches!(state, ComponentState::Stopped | ComponentState::Dead)));
    assert!(stale.exists());
    assert_eq!(rover.schema("2222"), None);
    assert_eq!(rover.schema("../rover/1111"), None);
    assert_eq!(rover.schema("1111"), Some(Bytes::new()));
    fs::File::options()
        .write(true)
        .open(root.path().join("rover/1111.schema"))
        .unwrap()
        .set_len((16 << 20) + 1)
        .unwrap();
    assert_eq!(rover.schema("1111"), None);
    fs::remove_dir_all(root.path().join("rover")).unwrap();
    assert!(rover.components().is_err());
    assert_eq!(rover.state("a"), ComponentState::Stopped);
}

/// The promise: a running component is known, with the plan it was built from.
#[test]
fn a_running_component_shows_its_plan() {
    let stage = Stage::new();
    let sensor = stage.open("sensor");
    let dir = stage.dir();
    assert_eq!(stage.runtime_dir().systems().unwrap(), ["untyped"]);
    assert_eq!(dir.components().unwrap(), ["sensor"]);
    assert_eq!(dir.state("sensor"), ComponentState::Running(ComponentProcess::ThisProcess));
    assert_eq!(Announcement::read(&dir, "sensor").unwrap().plan, Some(plan("sensor")));
    // A plan of another version is left out, and so is none.
    let path = stage.root.path().join("untyped/sensor.json");
    let text = fs::read_to_string(&path).unwrap();
    for (from, to) in [("\"version\": 1\n", "\"version\": 99\n"), ("\"plan\"", "\"formerly\"")] {
        let changed = text.replace(from, to);
        assert_ne!(changed, text);
        fs::write(&path, changed).unwrap();
        let found = Announcement::read(&dir, "sensor").unwrap();
        assert_eq!((found.plan, found.endpoints.len()), (None, 8), "{from}");
    }
    drop(sensor);
    assert_eq!(dir.state("sensor"), ComponentState::Stopped);
}

/// The promise: a wrong setting is named when the component opens, and `off` means no file.
#[test]
fn stats_can_be_switched_off_for_a_process() {
    // The environment of this process cannot be changed safely; `tests/tests/stats.rs` sets it for others.
    let stage = Stage::new();
    let memory = scl::OpenOptions::new().transport(scl::transport::memory::Memory::new());
    drop(Component::open_blocking_with(&plan("sensor"), memory).unwrap());
    assert_eq!(fs::read_dir(stage.root.path()).unwrap().count(), 0);
}

fn wait_until(condition: impl Fn() -> bool) {
    let started = SystemTime::now();
    while !condition() {
        assert!(started.elapsed().unwrap() < LONG);
        std::thread::park_timeout(Duration::from_millis(1));
    }
}
