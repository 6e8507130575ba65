//! The node of this process in the folder of a system: one, however many components the process has.

use crate::error::ShmError;
use crate::folder::Folder;
use crate::limits;
use crate::unfinished;
use iceoryx2::node::{Node, NodeBuilder};
use iceoryx2::prelude::SignalHandlingMode;
use iceoryx2::service::ipc_threadsafe::Service as Engine;
use scl_fork::ProcessMark;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, PoisonError, Weak};
use std::time::Duration;

#[cfg(test)]
use crate::service::{Port, ServiceName};

#[cfg(test)]
type Builder = iceoryx2::service::builder::publish_subscribe::Builder<[u8], (), Engine>;

/// How long the cleanup after killed programs may wait for another program that is cleaning up.
const CLEANING: Duration = Duration::from_secs(1);

/// Shared memory among the programs of a system.
#[derive(Debug)]
pub struct SharedMemory {
    /// `None` only while it is dropped.
    node: Option<Mutex<Node<Engine>>>,
    folder: Folder,
    process: ProcessMark,
}

/// The nodes of this process, and those that it has inherited from the process that it was forked from. Two nodes of
/// one process in one folder would each take the other's files for those of a stranger.
static NODES: LazyLock<Mutex<HashMap<PathBuf, Weak<SharedMemory>>>> = LazyLock::new(Mutex::default);

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl SharedMemory {
    /// Opens shared memory in the folder of a system, and removes what killed programs have left there.
    ///
    /// # Errors
    /// [`ShmError`] if its files cannot be created or belong to another user.
    pub fn open(system: &Path) -> Result<Arc<Self>, ShmError> {
        crate::log::direct();
        let mut nodes = lock(&NODES);
        nodes.retain(|_, node| node.strong_count() > 0);
        if let Some(memory) = nodes.get(system).and_then(Weak::upgrade).filter(|memory| memory.process.is_own()) {
            return Ok(memory);
        }
        let memory = Arc::new(Self::create(system)?);
        nodes.insert(system.to_owned(), Arc::downgrade(&memory));
        Ok(memory)
    }

    fn create(system: &Path) -> Result<Self, ShmError> {
        let folder = Folder::create(system)?;
        // Two concurrent cleanups can end one of the processes: https://github.com/eclipse-iceoryx/iceoryx2/issues/1880
        let _locked = folder.lock()?;
        folder.check_owners()?;
        limits::require(0)?;
        // Damaged files left by killed programs would keep the engine from starting.
        folder.remove_if_unused();
        let config = folder.config()?;
        let node = unfinished::removing(&folder, || {
            let node = NodeBuilder::new()
                .config(&config)
                .signal_handling_mode(SignalHandlingMode::Disabled)
                .create::<Engine>()
                .map_err(|error| ShmError::engine("create a node", error))?;
            folder.close_to_others();
            node.blocking_cleanup_dead_nodes(CLEANING);
            Ok(node)
        })?;
        Ok(Self { node: Some(Mutex::new(node)), folder, process: ProcessMark::new() })
    }

    /// A service that no end of SCL would create.
    #[cfg(test)]
    pub(crate) fn foreign_service(&self, name: ServiceName, settings: impl Fn(Builder) -> Builder) -> Port {
        let builder = self.node().service_builder(&name.to_string().as_str().try_into().unwrap());
        settings(builder.publish_subscribe::<[u8]>()).create().unwrap()
    }

    /// Locks the node.
    pub(crate) fn node(&self) -> MutexGuard<'_, Node<Engine>> {
        // `Some` until this value is dropped.
        lock(self.node.as_ref().unwrap_or_else(|| unreachable!("the node is taken by `drop` only")))
    }
}

impl Drop for SharedMemory {
    fn drop(&mut self) {
        if !self.process.is_own() {
            return std::mem::forget(self.node.take());
        }
        let nodes = lock(&NODES);
        let is_open_again = nodes.iter().any(|(system, node)| node.strong_count() > 0 && self.folder.is_of(system));
        // Other programs wait for the lock before they open the system, so no file in use is removed.
        let locked = self.folder.lock();
        self.node = None;
        // Without the folder, the files that are left cannot be found.
        if (locked.is_ok() || self.folder.is_gone()) && !is_open_again {
            self.folder.remove_if_unused();
        }
    }
}
