//! What happens when the files of a running component are removed.

use super::*;
use crate::runtime_dir::{RuntimeDir, Seen, bind_ipc};
use crate::spec::Schema;
use crate::transport_choice::TransportChoice;
use std::fs;
use std::future::poll_fn;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use tempfile::TempDir;
use tokio::task::{JoinHandle, yield_now};

static SENSOR: ComponentSpec = ComponentSpec {
    system: "rover",
    name: "sensor",
    declared_at: "rover.yaml:3:4",
    parameters: &[],
    gates: &[],
    schema: Some(Schema { hash: "1111", descriptors: b"descriptors" }),
};

fn registered(dir: SystemDir, stats_period: Option<Duration>) -> Registration {
    let announcement = Announcement::of(&SENSOR, &TransportChoice::default());
    Registration::announcing(&SENSOR, dir, announcement, stats_period).unwrap()
}

struct Stage {
    root: TempDir,
    registration: Registration,
    keeping: JoinHandle<()>,
    seen: Seen,
}

impl Stage {
    async fn new() -> Self {
        let root = tempfile::tempdir().unwrap();
        let registration = registered(system(root.path()), Some(Duration::from_millis(500)));
        let keeping = tokio::spawn(registration.keep());
        // It is watching when it waits for the first time.
        yield_now().await;
        Self { root, registration, keeping, seen: Seen::default() }
    }

    fn folder(&self) -> PathBuf {
        self.root.path().join("run/rover")
    }

    async fn restored(&mut self) {
        let dir = self.registration.dir().clone();
        poll_fn(|cx| dir.poll_restored(&mut self.seen, cx)).await;
    }

    fn assert_in_place(&self, what: &str) {
        let dir = self.registration.dir();
        assert_eq!(ComponentLock::holder(dir, "sensor"), Some(ComponentProcess::ThisProcess), "{what}");
        assert!(ComponentLock::take(dir, "sensor").is_err(), "{what}");
        assert_eq!(Announcement::read(dir, "sensor").map(|found| found.pid), Some(std::process::id()), "{what}");
        assert_eq!(fs::read(self.folder().join("1111.schema")).unwrap(), b"descriptors", "{what}");
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o7777;
        let folder = self.folder();
        assert_eq!((mode(&folder), mode(folder.parent().unwrap())), (0o700, 0o700), "{what}");
    }
}

fn system(root: &Path) -> SystemDir {
    let variable = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| root.join("run").into());
    RuntimeDir::locate(&variable).unwrap().system("rover").unwrap()
}

#[tokio::test]
async fn files_and_folders_that_are_removed_are_created_again() {
    type Removal = fn(&Path, &Path);
    let removals: [(&str, Removal); 8] = [
        ("the folder", |folder, _| fs::remove_dir_all(folder).unwrap()),
        ("the runtime folder", |folder, _| fs::remove_dir_all(folder.parent().unwrap()).unwrap()),
        ("the folder, renamed", |folder, old| fs::rename(folder, old).unwrap()),
        ("the runtime folder, renamed", |folder, old| fs::rename(folder.parent().unwrap(), old).unwrap()),
        ("the lock", |folder, _| fs::remove_file(folder.join("sensor.lock")).unwrap()),
        ("the lock, replaced", |folder, old| {
            fs::write(old, "").unwrap();
            fs::rename(old, folder.join("sensor.lock")).unwrap();
        }),
        ("the announcement", |folder, _| fs::remove_file(folder.join("sensor.json")).unwrap()),
        ("the messages", |folder, _| fs::remove_file(folder.join("1111.schema")).unwrap()),
    ];
    let mut stage = Stage::new().await;
    stage.assert_in_place("nothing");
    for (what, remove) in removals {
        // Twice, so that the new files are seen to be watched too.
        for round in 0..2 {
            remove(&stage.folder(), &stage.root.path().join(format!("{what} {round}")));
            stage.restored().await;
            stage.assert_in_place(what);
            yield_now().await;
        }
    }
    assert!(!stage.keeping.is_finished());
}

#[tokio::test]
async fn what_is_removed_before_it_is_watched_is_created_again() {
    let root = tempfile::tempdir().unwrap();
    let registration = registered(system(root.path()), Some(Duration::from_millis(500)));
    fs::remove_dir_all(root.path().join("run")).unwrap();
    let keeping = tokio::spawn(registration.keep());
    let mut stage = Stage { root, registration, keeping, seen: Seen::default() };
    stage.restored().await;
    stage.assert_in_place("all");
}

#[tokio::test]
async fn owners_of_sockets_are_told_of_their_removal() {
    let mut stage = Stage::new().await;
    let dir = stage.registration.dir().clone();
    let bound = bind_ipc(&dir, "sensor.measurements.aaaa").unwrap();
    fs::remove_file(bound.guard.path()).unwrap();
    stage.restored().await;
    assert!(!bound.guard.is_ours());
}

#[tokio::test]
async fn a_component_that_another_process_runs_by_then_is_left_to_it() {
    let stage = Stage::new().await;
    fs::remove_dir_all(stage.root.path().join("run")).unwrap();
    let dir = system(stage.root.path());
    // Within one process, but to the lock that makes no difference.
    let other = ComponentLock::take(&dir, "sensor").unwrap();
    stage.keeping.await.unwrap();
    assert!(other.is_in_place());
    assert_eq!(Announcement::read(&dir, "sensor"), None);
    drop(stage.registration);
    assert!(ComponentLock::take(&dir, "sensor").is_err(), "the other one still holds it");
}

#[tokio::test]
async fn a_closed_component_leaves_its_name_at_once_and_is_not_restored() {
    let stage = Stage::new().await;
    let dir = stage.registration.dir().clone();
    drop(stage.registration);
    assert_eq!(ComponentLock::holder(&dir, "sensor"), None);
    assert_eq!(Announcement::read(&dir, "sensor"), None);
    let other = ComponentLock::take(&dir, "sensor").unwrap();
    fs::remove_dir_all(dir.folder()).unwrap();
    stage.keeping.await.unwrap();
    assert!(!dir.folder().exists());
    drop(other);
}

#[tokio::test]
async fn a_component_closed_while_its_files_are_restored_leaves_its_name_too() {
    let stage = Stage::new().await;
    let dir = stage.registration.dir().clone();
    // As the task holds it while it restores them.
    let files = stage.registration.files.clone();
    drop(stage.registration);
    assert_eq!(ComponentLock::holder(&dir, "sensor"), None);
    assert!(!files.restore().unwrap() && Announcement::read(&dir, "sensor").is_none());
}

#[tokio::test]
async fn what_a_killed_process_left_behind_is_removed() {
    let root = tempfile::tempdir().unwrap();
    let dir = system(root.path());
    let old = dir.folder().join("sensor.measurements.old.tcp");
    fs::write(&old, "127.0.0.1:80").unwrap();
    let _registration = registered(dir, None);
    assert!(!old.exists());
}

#[tokio::test]
async fn a_forked_child_removes_and_restores_nothing() {
    let root = tempfile::tempdir().unwrap();
    let dir = system(root.path());
    let mut registration = registered(dir.clone(), None);
    Arc::get_mut(&mut registration.files).unwrap().process = ProcessMark::inherited();
    let keeping = tokio::spawn(registration.keep());
    yield_now().await;
    fs::remove_file(dir.folder().join("1111.schema")).unwrap();
    keeping.await.unwrap();
    assert!(!dir.folder().join("1111.schema").exists());
    // As if another thread had been restoring the files while the process forked.
    let files = registration.files.clone();
    let _held = lock(&files.held);
    drop(registration);
}
