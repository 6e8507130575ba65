//! Which components run on this host: learned from events in the system's folder, without polling.

use super::Profile;
use super::folder_events::{FolderChange, FolderEvents};
use crate::runtime_dir::{ComponentLock, QUIET, SystemDir};
use std::collections::{BTreeSet, HashMap, VecDeque};
use std::error::Error;
use tokio::time::Instant;

/// Watches some components of a system on this host.
#[derive(Debug)]
pub struct Presence {
    dir: SystemDir,
    components: BTreeSet<String>,
    running: HashMap<String, Profile>,
    changes: VecDeque<Change>,
    events: Option<FolderEvents>,
    /// When files of other components were last removed; `None` once that is reported.
    removed: Option<Instant>,
    /// Whether it was logged that the folder cannot be watched.
    warned: bool,
}

/// A component has started or stopped.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Change {
    /// A process runs it, and has announced it.
    Started {
        /// The component.
        component: String,
        /// Its announcement, with its messages.
        profile: Box<Profile>,
    },
    /// It was closed, or its process has ended. A restart is reported as this and then [`Started`](Self::Started),
    /// however quick it was.
    Stopped {
        /// The component.
        component: String,
    },
    /// Files of components of other hosts were removed, perhaps because these have stopped.
    /// [Restore](super::Mirror::restore) every [`Mirror`](super::Mirror) that still exists.
    Removed,
}

impl Presence {
    /// Watches these components. Those that are already running are reported as started.
    pub fn new(dir: SystemDir, components: impl IntoIterator<Item = String>) -> Self {
        let components = components.into_iter().collect();
        let (running, changes) = (HashMap::new(), VecDeque::new());
        Self { dir, components, running, changes, events: None, removed: None, warned: false }
    }

    /// Waits for the next change.
    ///
    /// # Cancel safety
    /// No change is lost when the future is dropped.
    pub async fn next(&mut self) -> Change {
        loop {
            if let Some(change) = self.changes.pop_front() {
                return change;
            }
            let Some(events) = &self.events else {
                self.watch().await;
                continue;
            };
            let happened = match self.removed {
                // Wait until no more files are removed: a program that is deleting the folder must not find new files
                // in it.
                Some(at) => match tokio::time::timeout_at(at + QUIET, events.next()).await {
                    Ok(happened) => happened,
                    Err(_quiet) => {
                        self.removed = None;
                        self.changes.push_back(Change::Removed);
                        continue;
                    }
                },
                None => events.next().await,
            };
            match happened {
                FolderChange::Components(names) => {
                    names.keys().for_each(|name| self.look(name));
                    if names.iter().any(|(name, removed)| *removed && !self.components.contains(name)) {
                        self.removed = Some(Instant::now());
                    }
                }
                FolderChange::Unknown => {
                    self.events = None;
                    tokio::time::sleep(QUIET).await;
                }
            }
        }
    }

    /// Creates the folder again if it was removed, starts to watch it, and then checks every component.
    async fn watch(&mut self) {
        match self.dir.create_again().and_then(|()| FolderEvents::start(&self.dir)) {
            Ok(events) => {
                self.events = Some(events);
                // Check after starting to watch, so that no event is missed.
                let all: Vec<_> = self.components.iter().cloned().collect();
                all.iter().for_each(|name| self.look(name));
                self.changes.push_back(Change::Removed);
            }
            Err(error) => {
                if !std::mem::replace(&mut self.warned, true) {
                    let error = &error as &(dyn Error + 'static);
                    tracing::warn!(error, "cannot watch which components run; trying again");
                }
                tokio::time::sleep(QUIET).await;
            }
        }
    }

    fn look(&mut self, name: &str) {
        if !self.components.contains(name) {
            return;
        }
        let is_held = ComponentLock::holder(&self.dir, name).is_some();
        let profile = is_held.then(|| Profile::read(&self.dir, name)).flatten();
        // Skip mirrors of components that run on other hosts.
        let now = profile.filter(|profile| profile.announcement().host.is_none());
        if self.running.get(name) == now.as_ref() {
            return;
        }
        let component = name.to_owned();
        if self.running.remove(name).is_some() {
            self.changes.push_back(Change::Stopped { component: component.clone() });
        }
        if let Some(profile) = now {
            self.running.insert(component.clone(), profile.clone());
            self.changes.push_back(Change::Started { component, profile: Box::new(profile) });
        }
    }
}
