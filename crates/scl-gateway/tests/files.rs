//! The files of a system, which all its hosts have.

use crate::host::Host;
use std::path::PathBuf;
use std::process::{Command, Output};
use tempfile::TempDir;

/// A folder with topology, plans, launch file and certificates.
pub(crate) struct Files {
    folder: TempDir,
}

impl Files {
    /// A topology, and the plans made of it.
    pub(crate) fn of(topology: &str) -> Self {
        let files = Self { folder: tempfile::tempdir().unwrap() };
        files.write("topology.yaml", topology);
        let loaded = scl_loader::load(&scl_loader::Request::new(files.topology()));
        let plan = loaded.system_plan().unwrap_or_else(|| panic!("{:?}", loaded.diagnostics));
        files.write("plan.json", &plan.to_json());
        files
    }

    pub(crate) fn topology(&self) -> PathBuf {
        self.path("topology.yaml")
    }

    pub(crate) fn plan(&self) -> PathBuf {
        self.path("plan.json")
    }

    pub(crate) fn launch(&self) -> PathBuf {
        self.path("launch.yaml")
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    /// Makes the certificates of the launch file with `scl-gateway keys`, in another environment.
    #[track_caller]
    pub(crate) fn make_keys(&self, environment: &[(String, String)]) {
        let output = self.keys(environment);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }

    fn keys(&self, environment: &[(String, String)]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_scl-gateway"));
        command.arg("keys").arg("--launch").arg(self.launch());
        command.envs(environment.iter().map(|(name, value)| (name, value))).output().unwrap()
    }
}

/// A launch file that says what runs on which host. Certificates are in the folder `keys` beside it.
pub(crate) fn launch(hosts: &[(&Host, &[&str])]) -> String {
    let host = |(host, components): &(&Host, &[&str])| {
        format!("  {}: {{address: {}, components: [{}]}}\n", host.name, host.address, components.join(", "))
    };
    let programs = hosts.iter().flat_map(|(_, components)| components.iter());
    // The test starts the programs itself.
    let programs: String = programs.map(|component| format!("  {component}: {{command: /bin/true}}\n")).collect();
    let hosts: String = hosts.iter().map(host).collect();
    format!("components:\n{programs}hosts:\n{hosts}gateway: {{port: 7447, certificates: ./keys}}\n")
}
