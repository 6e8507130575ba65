//! The sockets of a run, in the folder of its system: one for notices of programs, one for requests.
//!
//! A run also works without them, except for the features that need them, so that a launch file of other programs runs
//! anywhere.

use super::component::Component;
use super::control::ControlSocket;
use super::event::Event;
use super::notify::{NotifySocket, RUNTIME_DIR};
use super::output::Output;
use super::own_file::remove_stale;
use super::plan::RunPlan;
use scl::runtime_dir::{RuntimeDir, RuntimeDirError};
use scl_terminal::{Problem, print_err};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Weak};
use std::thread;
use std::time::Duration;

/// Interval at which to check that the sockets still exist.
const LOOK: Duration = Duration::from_secs(1);

/// The socket for notices, and the folder for the socket for requests.
#[derive(Debug)]
pub(crate) struct Sockets {
    pub(crate) notify: Arc<NotifySocket>,
    folders: Folders,
    named_after: Option<PathBuf>,
}

/// The runtime folder, and the system whose folder in it has the sockets.
#[derive(Debug, Clone)]
struct Folders {
    runtime: PathBuf,
    system: Option<String>,
}

impl Sockets {
    /// Finds the folder and opens the socket for notices. If that fails, prints a note and returns `None`.
    ///
    /// # Errors
    ///
    /// If that fails and a component has `ready_within` or `alive_within`.
    pub(crate) fn open(plan: &RunPlan, events: &Sender<Event>) -> Result<Option<Self>, Vec<Problem>> {
        let needs_notices =
            |component: &Component| component.policy.ready_within.is_some() || component.policy.alive_within.is_some();
        match Self::try_open(plan, events) {
            Ok(sockets) => Ok(Some(sockets)),
            Err(error) if plan.programs().any(needs_notices) => {
                let problem = Problem::new(format!("cannot listen for `ready_within` and `alive_within`: {error}"));
                Err(vec![problem.help("set `SCL_RUNTIME_DIR` to a folder of yours with a short path")])
            }
            Err(error) => {
                print_err(&format!("note: `scl stop` and `scl restart` cannot reach this run: {error}\n"));
                Ok(None)
            }
        }
    }

    fn try_open(plan: &RunPlan, events: &Sender<Event>) -> Result<Self, String> {
        let runtime_dir = RuntimeDir::locate(&|name| std::env::var_os(name)).map_err(|error| error.to_string())?;
        let folders = Folders { runtime: runtime_dir.path().to_owned(), system: plan.system.clone() };
        let folder = folders.create().map_err(|error| error.to_string())?;
        remove_stale(&folder);
        let notify = NotifySocket::open(&folder, &folders.runtime, events.clone());
        let notify = notify.map_err(|error| format!("cannot bind a socket in `{}`: {error}", folder.display()))?;
        Ok(Self { notify: Arc::new(notify), folders, named_after: plan.named_after.clone() })
    }

    /// Opens the socket for requests. Returns `None` without a system, because clients could not find the socket, or if
    /// it cannot be bound, which is printed as a note.
    pub(crate) fn open_control(&self, events: &Sender<Event>) -> Option<Arc<ControlSocket>> {
        let events = events.clone();
        let receive = move |request| {
            // If the supervisor has finished, the request is dropped, which closes the connection.
            let _ = events.send(Event::Requested(request));
        };
        let folder = self.folders.runtime.join(self.folders.system.as_ref()?);
        match ControlSocket::open(&folder, self.named_after.clone(), receive) {
            Ok(socket) => Some(Arc::new(socket)),
            Err(error) => {
                print_err(&format!("note: `scl stop` and `scl restart` cannot reach this run: {error}\n"));
                None
            }
        }
    }

    /// Starts a thread that binds the sockets again when they were removed with their folder, as `/run/user/UID` is at
    /// a logout. Programs that are started later, and other commands, find them in the folder with which the system was
    /// started.
    pub(crate) fn keep(&self, control: Option<&Arc<ControlSocket>>, output: &Arc<Output>) {
        let (notify, control) = (Arc::downgrade(&self.notify), control.map(Arc::downgrade));
        let (folders, output) = (self.folders.clone(), Arc::clone(output));
        thread::spawn(move || {
            let mut is_known = false;
            loop {
                thread::sleep(LOOK);
                let Some(notify) = notify.upgrade() else { return };
                let control = control.as_ref().and_then(Weak::upgrade).filter(|control| control.file.is_gone());
                if !notify.file.is_gone() && control.is_none() {
                    is_known = false;
                    continue;
                }
                let restored = folders.restore(&notify, control.as_deref());
                if let Err(error) = restored.map_err(|error| error.to_string())
                    && !std::mem::replace(&mut is_known, true)
                {
                    output.announce(&removed(&folders.runtime, &error));
                }
            }
        });
    }
}

impl Folders {
    /// Creates the folders that do not exist, and returns the folder for the sockets.
    fn create(&self) -> Result<PathBuf, RuntimeDirError> {
        let runtime_dir = RuntimeDir::locate(&|name| (name == RUNTIME_DIR).then(|| self.runtime.clone().into()))?;
        match &self.system {
            Some(system) => Ok(runtime_dir.system(system)?.folder().to_owned()),
            None => Ok(self.runtime.clone()),
        }
    }

    fn restore(&self, notify: &NotifySocket, control: Option<&ControlSocket>) -> Result<(), Box<dyn Error>> {
        self.create()?;
        if notify.file.is_gone() {
            notify.restore()?;
        }
        Ok(control.map_or(Ok(()), ControlSocket::restore)?)
    }
}

/// The report on a runtime folder that was removed and cannot be created.
fn removed(folder: &Path, error: &str) -> String {
    let reason = error.lines().next().unwrap_or_default();
    format!(
        "the runtime folder `{}` was removed, as at a logout, so no component can be started and no command reaches this run: \
         {reason}; to keep it, run `loginctl enable-linger`, or start the system with another `SCL_RUNTIME_DIR`",
        folder.display()
    )
}
