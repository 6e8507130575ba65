//! The sockets of a run, in the folder of its system: one for what programs say about themselves, one for requests.
//!
//! A run without them works, except for what needs them, so that a launch file of other programs runs anywhere.

use super::component::Component;
use super::control::ControlSocket;
use super::event::Event;
use super::notify::NotifySocket;
use super::own_file::remove_stale;
use super::plan::RunPlan;
use scl::runtime_dir::RuntimeDir;
use scl_terminal::{Problem, print_err};
use std::path::PathBuf;
use std::sync::mpsc::Sender;

/// The socket for notices, and where the one for requests belongs.
#[derive(Debug)]
pub(crate) struct Sockets {
    notify: Option<NotifySocket>,
    system_folder: Option<PathBuf>,
    named_after: Option<PathBuf>,
}

impl Sockets {
    /// Finds the folder and opens the socket for notices. Without one, the user is told, or it is an error if a component
    /// has to say that it is ready or alive.
    ///
    /// # Errors
    ///
    /// One problem.
    pub(crate) fn open(plan: &RunPlan, events: &Sender<Event>) -> Result<Self, Vec<Problem>> {
        let needs_notices =
            |component: &Component| component.policy.ready_within.is_some() || component.policy.alive_within.is_some();
        match Self::try_open(plan, events) {
            Ok(sockets) => Ok(sockets),
            Err(error) if plan.programs().any(needs_notices) => {
                let problem = Problem::new(format!("cannot listen for `ready_within` and `alive_within`: {error}"));
                Err(vec![problem.help("set `SCL_RUNTIME_DIR` to a folder of yours with a short path")])
            }
            Err(error) => {
                print_err(&format!("note: `scl stop` and `scl restart` cannot reach this run: {error}\n"));
                Ok(Self { notify: None, system_folder: None, named_after: None })
            }
        }
    }

    fn try_open(plan: &RunPlan, events: &Sender<Event>) -> Result<Self, String> {
        let runtime_dir = RuntimeDir::locate(&|name| std::env::var_os(name)).map_err(|error| error.to_string())?;
        let system = plan.system.as_ref().map(|name| runtime_dir.system(name));
        let system = system.transpose().map_err(|error| error.to_string())?;
        let system_folder = system.map(|system| system.folder().to_owned());
        let folder = system_folder.as_deref().unwrap_or(runtime_dir.path());
        remove_stale(folder);
        let notify = NotifySocket::open(folder, events.clone());
        let notify = notify.map_err(|error| format!("cannot bind a socket in `{}`: {error}", folder.display()))?;
        Ok(Self { notify: Some(notify), system_folder, named_after: plan.named_after.clone() })
    }

    pub(crate) fn notify(&self) -> Option<&NotifySocket> {
        self.notify.as_ref()
    }

    /// Opens the socket for requests. Without a system, nobody could find it.
    pub(crate) fn open_control(&self, events: &Sender<Event>) -> Option<ControlSocket> {
        let events = events.clone();
        let receive = move |asked| {
            // After the supervisor has finished, the client sees the end of the connection.
            let _ = events.send(Event::Asked(asked));
        };
        match ControlSocket::open(self.system_folder.as_ref()?, self.named_after.clone(), receive) {
            Ok(socket) => Some(socket),
            Err(error) => {
                print_err(&format!("note: `scl stop` and `scl restart` cannot reach this run: {error}\n"));
                None
            }
        }
    }
}
