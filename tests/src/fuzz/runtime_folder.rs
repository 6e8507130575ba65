//! A runtime folder in which anything may lie.

use super::litter;
use arbitrary::{Result, Unstructured};
use scl::runtime_dir::internals::{Address, ComponentLock, bind_ipc, bind_tcp, check_peer, explain_missing, find};
use scl::runtime_dir::{Announcement, ComponentStats, RuntimeDir, RuntimeDirError, SystemDir};
use scl::{Component, OpenOptions};
use std::collections::BTreeMap;
use std::fs::{self, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

scl::topology!("topologies/six_kinds.yaml", only = [sink]);

/// Names that are used in the folder, or nearly.
const NAMES: [&str; 9] = [
    "sink.lock",
    "sink.json",
    "sink.stats",
    "sink.jobs.00000000",
    "sink.answer.1a2b3c4d",
    "source.json",
    ".00000a",
    "sink",
    "six",
];

/// Fills a runtime folder as the bytes say, and does there what a component does. Each step succeeds or says what is in
/// its way, and nothing outside of the folder is touched.
///
/// # Panics
/// If that does not hold.
pub fn runtime_folder(data: &[u8]) {
    let scene = Scene::new();
    let bytes = &mut Unstructured::new(data);
    // What could not be read of the bytes just does not lie there.
    let _litter = scene.fill(bytes);
    let before = scene.outside();
    let by_session = bytes.arbitrary().unwrap_or(false);
    scene.use_files(by_session);
    scene.open();
    assert_eq!(scene.outside(), before, "something outside of the runtime folder was touched");
    scene.allow_removal();
}

struct Scene {
    root: TempDir,
    runtime_dir: PathBuf,
    system: PathBuf,
}

impl Scene {
    fn new() -> Self {
        let root = TempDir::with_prefix("scl").expect("a folder");
        let runtime_dir = root.path().join("session/scl");
        fs::create_dir_all(root.path().join("session")).expect("a folder");
        fs::create_dir_all(root.path().join("canary/folder")).expect("a folder");
        fs::write(root.path().join("canary/file"), "untouched").expect("a file");
        Self { system: runtime_dir.join("six"), runtime_dir, root }
    }

    fn fill(&self, bytes: &mut Unstructured<'_>) -> Result<()> {
        let canary = self.root.path().join("canary");
        let targets = ["", "file", "folder", "missing"].map(|name| canary.join(name));
        let targets =
            [&targets[..], &["six", "sink.lock", "/dev/null", "../../../canary/new"].map(PathBuf::from)].concat();
        for folder in [&self.runtime_dir, &self.system] {
            match bytes.int_in_range(0..=15)? {
                0 => litter::put(bytes, folder, &targets)?,
                1 => {}
                _ => make_private(folder),
            }
            // Behind a link everything would be put elsewhere.
            if !is_folder(folder) {
                return Ok(());
            }
        }
        let endpoints = endpoints();
        let real: Vec<&str> = endpoints.iter().copied().chain(NAMES).collect();
        for _ in 0..bytes.int_in_range(0..=10)? {
            let path = self.system.join(litter::name(bytes, &real)?);
            litter::put(bytes, &path, &targets)?;
        }
        Ok(())
    }

    /// All that is done with files, step by step.
    fn use_files(&self, by_session: bool) {
        let variable = |name: &str| match name {
            "SCL_RUNTIME_DIR" if !by_session => Some(self.runtime_dir.clone().into()),
            "XDG_RUNTIME_DIR" => Some(self.root.path().join("session").into()),
            _ => None,
        };
        if let Some(Some(dir)) = self.told(RuntimeDir::existing(&variable)) {
            for system in dir.systems().unwrap_or_default() {
                if let Some(Some(dir)) = self.told(dir.existing_system(&system)) {
                    let components = dir.components().unwrap_or_default();
                    assert!(components.iter().all(|name| !name.contains('/')));
                    let _any: Vec<_> = components.iter().map(|name| dir.state(name)).collect();
                }
            }
        }
        let located = RuntimeDir::locate(&variable).and_then(|dir| dir.system("six"));
        let Some(dir) = self.told(located) else { return };
        self.look_around(&dir);
        if let Some(lock) = self.told(ComponentLock::take(&dir, "sink")) {
            let again = ComponentLock::take(&dir, "sink").expect_err("the lock is taken");
            assert!(matches!(again, RuntimeDirError::AlreadyRunning { .. }), "{again}");
            self.told(lock.clear_leftovers());
        }
        for endpoint in endpoints() {
            let bound = self.told(bind_ipc(&dir, endpoint));
            assert!(bound.is_none() || matches!(find(&dir, endpoint), Some(Address::Ipc(_) | Address::Tcp(_))));
            self.told(bind_tcp(&dir, endpoint));
        }
        self.told(Announcement::of_this_process("sink").publish(&dir));
        self.look_around(&dir);
    }

    /// What others do who look for the component. An address leads nowhere but to a socket in the folder, or to a port.
    fn look_around(&self, dir: &SystemDir) {
        let names = fs::read_dir(dir.folder()).into_iter().flatten().flatten();
        let names = names.filter_map(|entry| entry.file_name().into_string().ok());
        for name in names.chain(endpoints().into_iter().map(str::to_owned)) {
            if let Some(Address::Ipc(path)) = find(dir, &name) {
                assert_eq!(path.parent(), Some(dir.folder()));
            }
            let component = name.split('.').next().unwrap_or_default();
            let _any = (Announcement::read(dir, component), ComponentLock::holder(dir, component));
            let _any = (ComponentStats::read(dir, component), dir.state(component), dir.schema(component));
        }
        for (gate, link) in
            Sink::SPEC.gates.iter().flat_map(|gate| gate.connections.iter().map(move |link| (gate, link)))
        {
            let _peer = ComponentLock::take(dir, link.peer_component);
            let _any = check_peer(dir, Sink::SPEC, gate, link);
            assert!(!explain_missing(dir, Sink::SPEC, gate, link).is_empty());
        }
    }

    /// The whole component: it opens and is announced, or says what is in its way.
    fn open(&self) {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
        let options =
            OpenOptions::new().runtime_dir(&self.runtime_dir).system("six").transport_kind(scl::TransportKind::Ipc);
        let opened = runtime.block_on(Sink::open_with(options));
        let announced = self.system.join("sink.json");
        match opened {
            Ok(sink) => {
                assert!(fs::symlink_metadata(&announced).is_ok_and(|seen| seen.is_file()));
                drop(sink);
                assert!(!announced.exists());
            }
            // With its sources, one of which is about the folder.
            Err(error) => self.check_told(&format!("{:?}", scl::Error::from(error))),
        }
    }

    fn told<T>(&self, result: std::result::Result<T, RuntimeDirError>) -> Option<T> {
        result.map_err(|error| self.check_told(&error.to_string())).ok()
    }

    fn check_told(&self, text: &str) {
        let names_the_path = text.contains(&*self.runtime_dir.to_string_lossy());
        assert!(names_the_path && text.contains("\nhelp: "), "{text}");
    }

    /// All that lies beside the runtime folder.
    fn outside(&self) -> BTreeMap<PathBuf, (u32, i64, Vec<u8>)> {
        let mut seen = BTreeMap::new();
        let mut folders = vec![self.root.path().to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).expect("a folder").flatten() {
                let (path, state) = (entry.path(), entry.metadata().expect("it is there"));
                if path == self.runtime_dir {
                    continue;
                }
                let is_folder = state.is_dir();
                let content = if is_folder { Vec::new() } else { fs::read(&path).expect("a file") };
                // The folder that holds the runtime folder changes with it.
                let changed = if path.ends_with("session") { 0 } else { state.mtime_nsec() };
                seen.insert(path.clone(), (state.mode(), changed, content));
                folders.extend(is_folder.then_some(path));
            }
        }
        seen
    }

    /// Takes back what keeps a temporary folder from being removed.
    fn allow_removal(&self) {
        for folder in [&self.runtime_dir, &self.system] {
            if is_folder(folder) {
                make_private(folder);
            }
        }
        for entry in fs::read_dir(&self.system).into_iter().flatten().flatten() {
            if is_folder(&entry.path()) {
                make_private(&entry.path());
            }
        }
    }
}

/// Where the sink's gates meet others.
fn endpoints() -> Vec<&'static str> {
    let links = Sink::SPEC.gates.iter().flat_map(|gate| gate.connections.iter().map(|link| link.endpoint));
    let own = Sink::SPEC.gates.iter().map(|gate| gate.endpoint).filter(|endpoint| !endpoint.is_empty());
    links.chain(own).collect()
}

/// A folder of mode 0700, new or as it is.
fn make_private(folder: &Path) {
    let _it_is_there = fs::create_dir(folder);
    let _refused = fs::set_permissions(folder, Permissions::from_mode(0o700));
}

fn is_folder(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|seen| seen.is_dir())
}
