//! A runtime folder, and components in it.

use scl::OpenOptions;
use scl::plan::SystemPlan;
use scl::untyped::Component;
use scl_loader::{Request, load_bytes};
use scl_observe::System;
use scl_terminal::Problem;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Two components with gates of all kinds, and one that only subscribes.
pub(crate) const TOPOLOGY: &str = "\
system: rover
codec: json
components:
  - name: sensor
    gates:
      - values: {pub: nav.Fix}
      - jobs: {push: nav.Job}
      - ask: {req: nav.Ask -> nav.Answer}
  - name: controller
    gates:
      - values: {sub: nav.Fix}
      - jobs: {pull: nav.Job}
      - answer: {rep: nav.Ask -> nav.Answer}
  - name: display
    gates:
      - values: {sub: nav.Fix}
connections:
  - [sensor.values, controller.values]
  - [sensor.values, display.values]
  - [sensor.jobs, controller.jobs]
  - [sensor.ask, controller.answer]
";

pub(crate) struct World {
    root: tempfile::TempDir,
}

impl World {
    pub(crate) fn new() -> Self {
        Self { root: tempfile::tempdir().unwrap() }
    }

    pub(crate) fn runtime_dir(&self) -> PathBuf {
        self.root.path().join("run")
    }

    /// The working folder of the tools.
    pub(crate) fn folder(&self) -> &Path {
        self.root.path()
    }

    /// Opens a component of the usual topology.
    pub(crate) async fn open(&self, component: &str) -> Component {
        self.open_in("rover", TOPOLOGY, component).await
    }

    /// Opens a component of a topology in a system.
    pub(crate) async fn open_in(&self, system: &str, topology: &str, component: &str) -> Component {
        let options = OpenOptions::new().runtime_dir(self.runtime_dir()).system(system);
        Component::open_with(plan(topology).component(component).unwrap(), options).await.unwrap()
    }

    pub(crate) fn find(&self, name: Option<&str>) -> Result<System, Problem> {
        self.find_with(name, None)
    }

    /// Finds a system; `variable` is the value of `SCL_SYSTEM`.
    pub(crate) fn find_with(&self, name: Option<&str>, variable: Option<&str>) -> Result<System, Problem> {
        let variables = |asked: &str| match asked {
            "SCL_RUNTIME_DIR" => Some(self.runtime_dir().into_os_string()),
            "SCL_SYSTEM" => variable.map(OsString::from),
            _ => None,
        };
        System::find_with(name, &variables, self.folder())
    }

    /// The text of a problem, with the folder of the test as `FOLDER`.
    pub(crate) fn text(&self, problem: &Problem) -> String {
        problem.to_string().replace(self.folder().to_str().unwrap(), "FOLDER")
    }
}

pub(crate) fn plan(topology: &str) -> SystemPlan {
    load_bytes(&Request::new("topology.yaml"), topology.as_bytes().to_vec()).system_plan().unwrap()
}
