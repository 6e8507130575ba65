//! Detects that a component's files in the folder of its system, or the folder itself, were removed, and that files of
//! other components have arrived there.

use super::error::RuntimeDirError;
use super::{Inotify, SystemDir};
use rustix::fs::inotify::{Event, ReadFlags, WatchFlags};
use scl_text::gate_name::in_file_name;
use std::ffi::{CStr, OsString};
use std::io;
use std::os::unix::ffi::OsStrExt;
use std::time::Duration;
use tokio::time::{Instant, timeout};

/// How long to wait after the last removal before anything is created again: removing a folder takes several steps and
/// fails if files appear in it in the meantime.
pub(crate) const QUIET: Duration = Duration::from_millis(100);

/// Events of arriving files: components rename their files into the folder, plain ZeroMQ programs create their sockets
/// there.
const ARRIVED: WatchFlags = WatchFlags::MOVED_TO.union(WatchFlags::CREATE);

/// Maximum time to wait for quiet.
const LONGEST_UNREST: Duration = Duration::from_secs(2);

/// Watches the files of one component with inotify.
///
/// The task is woken only when something in the folder is removed or arrives there, not when a file is written.
#[derive(Debug)]
pub(crate) struct FolderWatch {
    inotify: Inotify,
    arrivals: Arrivals,
    runtime_folder: i32,
    /// The name of the system's folder.
    system: OsString,
    /// Prefix of the names of the component's files: `sensor.`.
    prefix: String,
    schema: Option<String>,
}

impl FolderWatch {
    /// Starts watching. Must be called inside a tokio runtime.
    ///
    /// # Errors
    /// A folder or the component's lock file does not exist, or the limits for inotify are reached.
    pub(crate) fn start(dir: &SystemDir, component: &str, schema: Option<&str>) -> Result<Self, RuntimeDirError> {
        let lock_file = dir.file_of(component, ".lock")?;
        let start = || {
            let inotify = Inotify::new()?;
            let removed = WatchFlags::DELETE | WatchFlags::DELETE_SELF | WatchFlags::MOVE_SELF;
            let runtime_folder = inotify.watch(dir.runtime_folder(), removed)?;
            inotify.watch(dir.folder(), removed | ARRIVED)?;
            // Replacing a file changes the link count of the old one, which is reported as `ATTRIB`.
            inotify.watch(&lock_file, WatchFlags::ATTRIB | WatchFlags::MOVE_SELF)?;
            Ok((inotify, runtime_folder))
        };
        let failed = |error: io::Error| RuntimeDirError::io("watch", dir.folder(), error);
        let (inotify, runtime_folder) = start().map_err(failed)?;
        Ok(Self {
            inotify,
            arrivals: Arrivals::begin(dir),
            runtime_folder,
            system: dir.folder().file_name().unwrap_or_default().to_owned(),
            prefix: format!("{}.", in_file_name(component)),
            schema: schema.map(|hash| format!("{hash}.schema")),
        })
    }

    /// Returns when the folder, the runtime folder or a file of the component was removed or moved, and no file has
    /// been removed for a while.
    pub(crate) async fn removal(&self) -> io::Result<()> {
        while !self.next_events().await? {}
        let deadline = Instant::now() + LONGEST_UNREST;
        while Instant::now() < deadline && matches!(timeout(QUIET, self.next_events()).await, Ok(Ok(_))) {}
        Ok(())
    }

    /// Waits for removals, and reports arrivals while it waits. Returns true if at least one removal is about this
    /// component.
    async fn next_events(&self) -> io::Result<bool> {
        loop {
            let (mut arrived, mut removed, mut concerned) = (false, false, false);
            let handle = |event: &Event<'_>| {
                let is_arrival = event.events().intersects(ReadFlags::MOVED_TO | ReadFlags::CREATE);
                arrived |= is_arrival && !is_temporary(event);
                removed |= !is_arrival;
                concerned |= !is_arrival && self.is_about_component(event);
            };
            self.inotify.read(handle).await?;
            if arrived {
                self.arrivals.0.mark_arrived();
            }
            if removed {
                return Ok(concerned);
            }
        }
    }

    fn is_about_component(&self, event: &Event<'_>) -> bool {
        if !event.events().contains(ReadFlags::DELETE) {
            return true;
        }
        let name = event.file_name().map_or(&[][..], CStr::to_bytes);
        if event.wd() == self.runtime_folder {
            // The removal of another system's folder only shows that files are still being removed.
            return name == self.system.as_bytes();
        }
        name.starts_with(self.prefix.as_bytes()) || self.schema.as_ref().is_some_and(|file| name == file.as_bytes())
    }
}

/// Returns true if an event is about a temporary file, which will be renamed.
fn is_temporary(event: &Event<'_>) -> bool {
    event.file_name().is_some_and(|name| name.to_bytes().starts_with(b"."))
}

/// Counts as a watch that reports arrivals in the folder, until it is dropped.
#[derive(Debug)]
struct Arrivals(SystemDir);

impl Arrivals {
    fn begin(dir: &SystemDir) -> Self {
        dir.count_watch(true);
        Self(dir.clone())
    }
}

impl Drop for Arrivals {
    fn drop(&mut self) {
        self.0.count_watch(false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runtime_dir::{ComponentLock, RuntimeDir};
    use std::fs;

    #[tokio::test]
    async fn only_removals_of_the_components_own_files_concern_it() {
        let root = tempfile::tempdir().unwrap();
        let variable = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| root.path().into());
        let runtime_dir = RuntimeDir::locate(&variable).unwrap();
        let [dir, other] = ["rover", "other"].map(|system| runtime_dir.system(system).unwrap());
        let _lock = ComponentLock::take(&dir, "sensor").unwrap();
        let watch = FolderWatch::start(&dir, "sensor", Some("1111")).unwrap();
        let cases = [
            ("sensor2.a.aaaa", false),
            ("controller.a.aaaa", false),
            ("2222.schema", false),
            (".00000a", false),
            ("sensor.a.aaaa", true),
            ("sensor.json", true),
            ("1111.schema", true),
            ("sensor.lock", true),
        ];
        for (name, concerned) in cases {
            let path = dir.folder().join(name);
            // Creating and replacing files causes no removals.
            for _ in 0..2 {
                fs::write(dir.folder().join("new"), "").unwrap();
                fs::rename(dir.folder().join("new"), &path).unwrap();
            }
            if name != "sensor.lock" {
                let not_removed = |event: &Event<'_>| assert!(!event.events().contains(ReadFlags::DELETE), "{name}");
                watch.inotify.read_now(not_removed).unwrap();
            }
            fs::remove_file(&path).unwrap();
            assert_eq!(watch.next_events().await.unwrap(), concerned, "{name}");
        }
        fs::remove_dir(other.folder()).unwrap();
        assert!(!watch.next_events().await.unwrap());
        fs::remove_dir(dir.folder()).unwrap();
        let removed = Instant::now();
        watch.removal().await.unwrap();
        assert!(removed.elapsed() >= QUIET);
    }
}
