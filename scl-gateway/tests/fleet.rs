//! The system of these tests on its hosts: `source` and its neighbours on `board`, `sink` on `ground`.

use crate::host::Host;
use crate::network::Network;
use crate::player::Player;
use scl_tests::Process;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const TOPOLOGY: &str = include_str!("two_hosts.yaml");

/// Where the components run.
pub(crate) const HOSTS: [(&str, &[&str]); 2] =
    [("board", &["source", "local_control", "helper"]), ("ground", &["sink"])];

/// A system on its hosts. Components that are not the test's matter are called `source` and `sink`.
pub(crate) struct Fleet {
    // Dropped in this order: programs before the network under them.
    players: HashMap<String, Player>,
    gateways: HashMap<String, Process>,
    pub(crate) network: Network,
    pub(crate) files: Files,
}

/// The files of a system, which all hosts have.
pub(crate) struct Files {
    folder: TempDir,
}

impl Fleet {
    /// All components on one host.
    pub(crate) fn on_one_host() -> Self {
        let mut fleet = Self::on(Network::new(&["board"]));
        fleet.play("source");
        fleet.play("sink");
        fleet
    }

    /// Nothing runs yet.
    pub(crate) fn on(network: Network) -> Self {
        let files = Files::of(TOPOLOGY);
        Self { players: HashMap::new(), gateways: HashMap::new(), network, files }
    }

    /// Starts a component on its host, or on the only one.
    pub(crate) fn play(&mut self, component: &str) -> &mut Player {
        let host = HOSTS.iter().position(|(_, components)| components.contains(&component)).unwrap();
        let host = &self.network.hosts[host.min(self.network.hosts.len() - 1)];
        let player = host.play(component, &self.files.plan());
        self.players.insert(component.to_owned(), player);
        self.player(component)
    }

    #[track_caller]
    pub(crate) fn player(&mut self, component: &str) -> &mut Player {
        self.players.get_mut(component).unwrap_or_else(|| panic!("`{component}` does not run"))
    }

    /// Kills a component, which leaves its files behind.
    pub(crate) fn kill(&mut self, component: &str) {
        self.players.remove(component).unwrap().kill();
    }
}

impl Files {
    /// A topology, and the plans made of it.
    pub(crate) fn of(topology: &str) -> Self {
        let files = Self { folder: tempfile::tempdir().unwrap() };
        std::fs::write(files.topology(), topology).unwrap();
        let loaded = scl_loader::load(&scl_loader::Request::new(files.topology()));
        let plan = loaded.system_plan().unwrap_or_else(|| panic!("{:?}", loaded.diagnostics));
        std::fs::write(files.plan(), plan.to_json()).unwrap();
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

    /// Writes a file.
    pub(crate) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }
}

/// A launch file for these hosts.
pub(crate) fn launch(hosts: &[Host], certificates: &Path) -> String {
    let mut text = "hosts:\n".to_owned();
    for (host, (_, components)) in hosts.iter().zip(HOSTS) {
        text += &format!("  {}: {{address: {}, components: {components:?}}}\n", host.name, host.address);
    }
    text + &format!("gateway: {{port: 7447, certificates: {}}}\n", certificates.display())
}
