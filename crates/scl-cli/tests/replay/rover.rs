//! Recordings of a rover, and its components beside `scl replay`.

use super::*;

/// A folder with recordings, and the runtime folder of the components beside them.
pub(super) struct Rover {
    pub(super) system: System,
    pub(super) plan: SystemPlan,
}

impl Rover {
    pub(super) fn new() -> Self {
        let system = System::of_files(&[]);
        std::fs::create_dir(system.path("run")).unwrap();
        let mut rover =
            Self { system, plan: SystemPlan { system: String::new(), components: Vec::new(), kinds: Vec::new() } };
        rover.plan = rover.plan_of(ROVER);
        rover
    }

    pub(super) fn plan_of(&self, topology: &str) -> SystemPlan {
        self.system.write("loaded.yaml", topology);
        load(&Request::new(self.system.path("loaded.yaml"))).system_plan().unwrap()
    }

    pub(super) fn recorder(&self) -> Recorder {
        Recorder::new().of_plan(&self.plan).attach_plan(&self.plan)
    }

    pub(super) fn record(&self, name: &str, samples: &[Sample<'_>]) -> PathBuf {
        self.recorder().messages(samples).write_to(&self.system.path(""), name)
    }

    /// A component that this process runs.
    pub(super) fn open(&self, component: &str) -> Component {
        self.open_planned(&self.plan, component)
    }

    pub(super) fn open_planned(&self, plan: &SystemPlan, component: &str) -> Component {
        let options = OpenOptions::new().runtime_dir(self.system.path("run"));
        Component::open_blocking_with(plan.component(component).unwrap(), options).unwrap()
    }

    pub(super) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = self.system.scl(&[&["replay"], arguments].concat());
        command.env("SCL_RUNTIME_DIR", self.system.path("run")).env_remove("SCL_SYSTEM");
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    pub(super) fn start(&self, arguments: &[&str]) -> ChildGuard {
        self.command(arguments).spawn_guarded()
    }

    pub(super) fn replay_json(&self, arguments: &[&str]) -> serde_json::Value {
        let output: Output = self.command(&[arguments, &["--format", "json"]].concat()).output().unwrap();
        assert!(output.status.success(), "{arguments:?}: {output:?}");
        serde_json::from_slice(&output.stdout).unwrap()
    }

    /// What a replay says that cannot take place.
    pub(super) fn fails(&self, arguments: &[&str]) -> String {
        let output = self.command(arguments).output().unwrap();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}: {output:?}");
        text(&output.stderr)
    }
}

pub(super) fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}
