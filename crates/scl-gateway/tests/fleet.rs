//! The system of these tests on its hosts: `source` and its neighbours on `board`, `sink` on `ground`.

use crate::files::{Files, launch};
use crate::gateway::Gateway;
use crate::network::Network;
use crate::player::Player;
use scl::runtime_dir::{ComponentState, RuntimeDir};
use scl_tests::wait_until;
use std::collections::HashMap;
use std::path::PathBuf;

const TOPOLOGY: &str = include_str!("two_hosts.yaml");

/// What runs on the host `board`.
pub(crate) const BOARD: &[&str] = &["source", "local_control", "helper"];
/// What runs on the host `ground`.
pub(crate) const GROUND: &[&str] = &["sink"];

/// A system on its hosts. Components that are not the test's matter are called `source` and `sink`.
pub(crate) struct Fleet {
    // Dropped in this order: programs before the network under them.
    players: HashMap<String, Player>,
    gateways: HashMap<String, Gateway>,
    pub(crate) network: Network,
    pub(crate) files: Files,
}

impl Fleet {
    /// All components on one host.
    pub(crate) fn on_one_host() -> Self {
        let mut fleet = Self::on(Network::new(&["board"]));
        fleet.play("source");
        fleet.play("sink");
        fleet
    }

    /// Everything runs, on two hosts, and is connected.
    pub(crate) fn start() -> Self {
        Self::start_on(Network::new(&["board", "ground"]))
    }

    /// Everything runs on the first two hosts of a network, and is connected.
    pub(crate) fn start_on(network: Network) -> Self {
        let mut fleet = Self::on(network);
        fleet.start_gateway("board");
        fleet.start_gateway("ground");
        fleet.play("source");
        fleet.play("sink");
        fleet.player("source").ready();
        fleet.player("sink").ready();
        fleet
    }

    /// Nothing runs yet. There are certificates for the first two hosts.
    pub(crate) fn on(network: Network) -> Self {
        let files = Files::of(TOPOLOGY);
        if let [board, ground, ..] = &network.hosts[..] {
            files.write("launch.yaml", &launch(&[(board, BOARD), (ground, GROUND)]));
            files.make_keys(&[]);
        }
        Self { players: HashMap::new(), gateways: HashMap::new(), network, files }
    }

    /// Starts the gateway of a host.
    pub(crate) fn start_gateway(&mut self, host: &str) {
        let on = self.network.host(host);
        let (topology, launch, log) = (self.files.topology(), self.files.launch(), self.log_file(host));
        let gateway = Gateway::start(on, host, &topology, &launch, &log);
        self.gateways.insert(host.to_owned(), gateway);
    }

    #[track_caller]
    pub(crate) fn gateway(&mut self, host: &str) -> &mut Gateway {
        self.gateways.get_mut(host).unwrap_or_else(|| panic!("no gateway runs on `{host}`"))
    }

    /// Kills the gateway of a host (SIGKILL).
    pub(crate) fn kill_gateway(&mut self, host: &str) {
        self.gateways.remove(host).unwrap().kill();
    }

    /// Stops the gateway of a host in order.
    pub(crate) fn stop_gateway(&mut self, host: &str) -> std::process::ExitStatus {
        self.gateways.remove(host).unwrap().stop()
    }

    /// Waits until a gateway has ended by itself; its exit status and its log.
    pub(crate) fn wait_for_gateway(&mut self, host: &str) -> (std::process::ExitStatus, String) {
        let gateway = self.gateways.remove(host).unwrap();
        let status = gateway.wait_for_exit();
        (status, std::fs::read_to_string(self.log_file(host)).unwrap())
    }

    pub(crate) fn forget_log(&mut self, host: &str) {
        std::fs::remove_file(self.log_file(host)).unwrap();
    }

    fn log_file(&self, host: &str) -> PathBuf {
        self.files.path(&format!("{host}.log"))
    }

    /// Starts a component on its host, or on the only one.
    pub(crate) fn play(&mut self, component: &str) -> &mut Player {
        let host = usize::from(GROUND.contains(&component));
        let host = &self.network.hosts[host.min(self.network.hosts.len() - 1)];
        let player = host.play(component, &self.files.plan());
        self.players.insert(component.to_owned(), player);
        self.player(component)
    }

    /// Waits until the gateway of a host shows a component of another one there.
    pub(crate) fn wait_until_shown(&self, component: &str, host: &str) {
        let file = self.network.host(host).runtime_dir().join(format!("fleet/{component}.json"));
        wait_until(&format!("`{component}` is shown on `{host}`"), || file.exists());
    }

    /// What tools say of a component on a host.
    pub(crate) fn state_of(&self, component: &str, host: &str) -> ComponentState {
        let folder = self.network.host(host).runtime_dir();
        let dir = RuntimeDir::locate(&|name| (name == "SCL_RUNTIME_DIR").then(|| folder.clone().into())).unwrap();
        dir.system("fleet").unwrap().state(component)
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

impl Drop for Fleet {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            return;
        }
        for host in ["board", "ground"] {
            let log = std::fs::read_to_string(self.log_file(host)).unwrap_or_default();
            let from = log.lines().count().saturating_sub(40);
            println!("the gateway of `{host}` logged last:");
            log.lines().skip(from).for_each(|line| println!("    {line}"));
        }
    }
}
