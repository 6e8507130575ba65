//! The registration of a running component in the runtime folder.

use crate::registry::{EndCheck, Neighbour, Registered};
use crate::runtime_dir::{
    Announcement, ComponentLock, ComponentProcess, ComponentStats, FolderWatch, OwnedPath, QUIET, RuntimeDirError,
    StatsFile, SystemDir, ValuesFile, check_peer, explain_missing, publish_schema,
};
use crate::spec::{ComponentSpec, ConnectionSpec, GateSpec};
use crate::sync::lock;
use crate::transport::PeerCheck;
use scl_fork::ProcessMark;
use std::error::Error;
use std::pin::Pin;
use std::sync::{Arc, Mutex, Weak};
use std::time::Duration;

/// The registration of this process as the one that runs a component. Dropped after everything that the component has
/// bound, because then another process may run it.
#[derive(Debug)]
pub(crate) struct Registration {
    files: Arc<Files>,
}

/// The component's files in the folder of its system.
#[derive(Debug)]
struct Files {
    dir: SystemDir,
    spec: &'static ComponentSpec,
    announcement: Announcement,
    /// The stats of a component that has done nothing yet; `None` if it writes no stats.
    initial_stats: Option<ComponentStats>,
    /// `None` once the component is closed.
    held: Mutex<Option<Held>>,
    process: ProcessMark,
}

/// Dropped in this order: the lock is released last.
#[derive(Debug)]
struct Held {
    announcement: OwnedPath,
    /// `None` if the component writes no stats, or the file could not be created.
    stats: Option<StatsFile>,
    /// `None` if the component has no parameters, or the file could not be created.
    values: Option<ValuesFile>,
    lock: ComponentLock,
}

impl Registration {
    /// Takes the component's lock, removes what a killed process left behind, and publishes the messages and the
    /// announcement, which names the component. The gates are opened after that. The component writes its stats with
    /// the given period, if any.
    pub(crate) fn announcing(
        spec: &'static ComponentSpec,
        dir: SystemDir,
        announcement: Announcement,
        stats_period: Option<Duration>,
    ) -> Result<Self, RuntimeDirError> {
        let lock = ComponentLock::take(&dir, spec.name)?;
        lock.clear_leftovers()?;
        // Publish the messages before the announcement, whose readers look for them.
        publish_messages(&dir, spec)?;
        let initial_stats =
            stats_period.map(|period| ComponentStats::initial(spec, announcement.pid, announcement.started, period));
        let stats = initial_stats.as_ref().and_then(|stats| create_stats(&dir, spec, stats));
        let held = Held { announcement: announcement.publish(&dir)?, stats, values: None, lock };
        let (held, process) = (Mutex::new(Some(held)), ProcessMark::new());
        Ok(Self { files: Arc::new(Files { dir, spec, announcement, initial_stats, held, process }) })
    }

    /// The folder of the system.
    #[cfg(test)]
    pub(crate) fn dir(&self) -> &SystemDir {
        &self.files.dir
    }

    /// Creates the component's files again if they were removed, for a process that watches the folder by itself.
    /// Returns true if something was missing.
    #[cfg(feature = "zeromq")]
    pub(crate) fn restore_if_removed(&self) -> Result<bool, RuntimeDirError> {
        if self.files.are_in_place() { Ok(false) } else { self.files.restore() }
    }

    /// Creates the file with the values of the parameters, given by name, and returns the writer for later ones.
    pub(crate) fn write_values(&self, values: &[(&'static str, String)]) -> ValuesWriter {
        let Files { dir, spec, held, .. } = &*self.files;
        if let Some(held) = lock(held).as_mut() {
            let created = ValuesFile::create(dir, spec.name, values);
            held.values = created.inspect_err(|error| log_missing(spec, "values of its parameters", error)).ok();
        }
        ValuesWriter(Arc::downgrade(&self.files))
    }

    /// Returns the figures of a component that has done nothing yet, and the writer for later ones, or `None` if it
    /// writes no stats.
    pub(crate) fn stats(&self) -> Option<(ComponentStats, StatsWriter)> {
        Some((self.files.initial_stats.clone()?, StatsWriter(Arc::downgrade(&self.files))))
    }
}

impl Registered for Registration {
    fn neighbour(&self, component: &str) -> Option<Neighbour> {
        ComponentLock::holder(&self.files.dir, component).map(|holder| match holder {
            ComponentProcess::ThisProcess => Neighbour::ThisProcess,
            _ => Neighbour::OtherProcess,
        })
    }

    fn peer_check(&self, gate: &'static GateSpec, connection: &'static ConnectionSpec) -> Option<PeerCheck> {
        let (dir, spec) = (self.files.dir.clone(), self.files.spec);
        Some(Arc::new(move || check_peer(&dir, spec, gate, connection)))
    }

    fn end_check(&self, peer: &'static str) -> Option<EndCheck> {
        let dir = self.files.dir.clone();
        // A crashed or killed process leaves its announcement behind. One that closes removes it before it releases its
        // lock.
        Some(Arc::new(move || !dir.has_announcement(peer)))
    }

    fn explain_missing(&self, gate: &GateSpec, connection: &ConnectionSpec) -> String {
        explain_missing(&self.files.dir, self.files.spec, gate, connection)
    }

    /// If the folder or files in it are removed, creates them again and reports that through
    /// [`SystemDir::poll_restored`].
    ///
    /// Returns if the files cannot be watched, or if they cannot be created again because another process has taken the
    /// component's lock in the meantime.
    fn keep(&self) -> Pin<Box<dyn Future<Output = ()> + Send>> {
        Box::pin(keep(Arc::downgrade(&self.files)))
    }
}

/// Writes the component's stats, as long as it is open.
pub(crate) struct StatsWriter(Weak<Files>);

impl StatsWriter {
    pub(crate) fn write(&self, stats: &ComponentStats) {
        if let Some(files) = self.0.upgrade()
            && let Some(file) = lock(&files.held).as_mut().and_then(|held| held.stats.as_mut())
        {
            file.write(stats);
        }
    }
}

/// Writes the values of a component's parameters, as long as it is open.
pub(crate) struct ValuesWriter(Weak<Files>);

impl ValuesWriter {
    pub(crate) fn write(&self, values: &[(&'static str, String)]) {
        if let Some(files) = self.0.upgrade()
            && let Some(file) = lock(&files.held).as_mut().and_then(|held| held.values.as_mut())
        {
            file.write(values);
        }
    }
}

impl Drop for Registration {
    fn drop(&mut self) {
        // The task in `keep` may be restoring the files at this moment, so dropping the reference is not enough. In a
        // forked child, the mutex may be locked by a thread that does not exist there.
        if self.files.process.is_own() {
            *lock(&self.files.held) = None;
        }
    }
}

impl Files {
    fn watch(&self) -> Result<FolderWatch, RuntimeDirError> {
        FolderWatch::start(&self.dir, self.spec.name, self.spec.schema.map(|schema| schema.hash))
    }

    fn are_in_place(&self) -> bool {
        let held = lock(&self.held);
        held.as_ref().is_none_or(|held| {
            let stats = held.stats.as_ref().is_none_or(StatsFile::is_in_place);
            let values = held.values.as_ref().is_none_or(ValuesFile::is_in_place);
            held.lock.is_in_place() && held.announcement.is_ours() && stats && values
        })
    }

    /// Creates missing files again. Returns true if the lock's file or the announcement was missing. Wakes the owners
    /// of sockets, which restore those themselves.
    fn restore(&self) -> Result<bool, RuntimeDirError> {
        let mut held = lock(&self.held);
        let Some(held) = held.as_mut() else { return Ok(false) };
        self.dir.create_again()?;
        let (locked, announced) = (held.lock.is_in_place(), held.announcement.is_ours());
        if !locked {
            held.lock = ComponentLock::take(&self.dir, self.spec.name)?;
        }
        publish_messages(&self.dir, self.spec)?;
        if !announced {
            held.announcement = self.announcement.publish(&self.dir)?;
        }
        if let Some(Err(error)) = held.stats.as_mut().map(|stats| stats.restore(&self.dir)) {
            log_missing(self.spec, "stats", &error);
            held.stats = None;
        }
        if let Some(Err(error)) = held.values.as_mut().map(|values| values.restore(&self.dir)) {
            log_missing(self.spec, "values of its parameters", &error);
            held.values = None;
        }
        self.dir.mark_restored();
        Ok(!locked || !announced)
    }
}

/// Creates the stats file, or logs why it cannot be created: only tools need it, so the component runs without it.
fn create_stats(dir: &SystemDir, spec: &ComponentSpec, stats: &ComponentStats) -> Option<StatsFile> {
    StatsFile::create(dir, spec.name, stats).inspect_err(|error| log_missing(spec, "stats", error)).ok()
}

fn log_missing(spec: &ComponentSpec, what: &str, error: &RuntimeDirError) {
    tracing::debug!(error = error as &(dyn Error + 'static), "component `{}` writes no {what}", spec.name);
}

fn publish_messages(dir: &SystemDir, spec: &ComponentSpec) -> Result<(), RuntimeDirError> {
    spec.schema.as_ref().map_or(Ok(()), |schema| publish_schema(dir, schema))
}

async fn keep(files: Weak<Files>) {
    loop {
        let Some(current) = files.upgrade() else { return };
        // Start watching before checking, so that no removal is missed.
        let watch = current.watch();
        let in_place = current.are_in_place();
        // Hold no reference while waiting, so that the component can be closed.
        drop(current);
        match watch {
            Ok(watch) if in_place => match watch.removal().await {
                Ok(()) => {}
                Err(error) => return tracing::debug!(%error, "cannot watch the runtime folder any longer"),
            },
            Err(error) if in_place => {
                let error = &error as &(dyn Error + 'static);
                return tracing::debug!(error, "the runtime folder is not restored if it is removed");
            }
            _ => tokio::time::sleep(QUIET).await,
        }
        let Some(current) = files.upgrade().filter(|files| files.process.is_own()) else { return };
        let component = current.spec.name;
        match current.restore() {
            Ok(true) => tracing::info!("created the files of component `{component}` again; they had been removed"),
            Ok(false) => {}
            Err(error) => {
                let error = &error as &(dyn Error + 'static);
                return tracing::error!(
                    error,
                    "peers that restart will not find component `{component}`: its files in the runtime folder were \
                     removed and cannot be created again"
                );
            }
        }
    }
}

#[cfg(test)]
mod tests;
