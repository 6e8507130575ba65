//! Two hosts: each with a runtime folder and a gateway.

use crate::wire::proxy::{Proxy, Weather};
use scl::OpenOptions;
use scl::plan::{Plan, SystemPlan};
use scl::runtime_dir::{ComponentState, RuntimeDir, SystemDir};
use scl::untyped::Component;
use scl_gateway::deployment::{Deployment, Host as HostPlan};
use scl_gateway::local::Gateway;
use scl_gateway::route::routes;
use scl_gateway::wire::{Peer, Wire, WireOptions};
use std::collections::BTreeMap;
use std::future::poll_fn;
use std::path::Path;
use std::task::Poll;
use std::time::Duration;
use tempfile::TempDir;

/// Far longer than anything takes.
pub(super) const LONG: Duration = Duration::from_secs(300);

pub(super) struct Host {
    pub(super) name: String,
    folder: TempDir,
    /// Dropped before the folder is removed.
    pub(super) gateway: Option<Gateway>,
}

/// `board` runs `sensor` and `camera`, `ground` runs `controller` and `assistant`.
pub(super) struct Hosts {
    pub(super) board: Host,
    pub(super) ground: Host,
    deployment: Deployment,
    /// Between the two gateways, if there is one: `board` connects to `ground`.
    proxy: Option<Proxy>,
}

impl Hosts {
    /// Both with their gateways, between which a proxy is.
    pub(super) async fn with_proxy() -> Self {
        let mut hosts = Self::new();
        let ground = hosts.deployment.host("ground").unwrap().socket_address();
        hosts.proxy = Some(Proxy::to(&ground).await);
        hosts.start_gateway("ground").await;
        hosts.start_gateway("board").await;
        hosts
    }

    pub(super) fn set_weather(&self, weather: Weather) {
        self.proxy.as_ref().unwrap().set(weather);
    }

    /// Both with their gateways.
    pub(super) async fn start() -> Self {
        let mut hosts = Self::new();
        hosts.start_gateway("ground").await;
        hosts.start_gateway("board").await;
        hosts
    }

    /// Without gateways.
    pub(super) fn new() -> Self {
        let host = |name: &str, components: [&str; 2]| HostPlan {
            name: name.to_owned(),
            address: "127.0.0.1".to_owned(),
            port: scl_tests::free_address().port(),
            components: components.map(str::to_owned).to_vec(),
        };
        let hosts = vec![host("board", ["sensor", "camera"]), host("ground", ["controller", "assistant"])];
        let deployment = Deployment { hosts, certificates: None, insecure: false };
        let folder = || TempDir::with_prefix("scl").unwrap();
        let host = |name: &str| Host { name: name.to_owned(), folder: folder(), gateway: None };
        Self { board: host("board"), ground: host("ground"), deployment, proxy: None }
    }

    pub(super) async fn start_gateway(&mut self, name: &str) {
        let components: BTreeMap<String, String> = self
            .deployment
            .hosts
            .iter()
            .flat_map(|host| host.components.iter().map(|component| (component.clone(), host.name.clone())))
            .collect();
        let routes = routes(&system(), &self.deployment, name);
        let peers = self.deployment.hosts.iter().filter(|host| host.name != name);
        let proxy = self.proxy.as_ref().map(|proxy| proxy.address.clone());
        let peer = |host: &HostPlan| Peer {
            host: host.name.clone(),
            address: proxy.clone().filter(|_| host.name == "ground").or_else(|| Some(host.socket_address())),
        };
        let peers = peers.map(peer);
        let wire = Wire::open(WireOptions {
            system: "local".to_owned(),
            host: name.to_owned(),
            listen: self.deployment.host(name).map(HostPlan::socket_address),
            peers: peers.collect(),
            tls: None,
            insecure: false,
            routes,
            components,
        });
        let wire = wire.await.unwrap();
        let host = self.host_mut(name);
        host.gateway = Some(Gateway::start(host.dir(), scl::TransportKind::Ipc, wire));
    }

    pub(super) async fn stop_gateway(&mut self, name: &str) {
        self.host_mut(name).gateway.take().unwrap().close().await;
    }

    fn host_mut(&mut self, name: &str) -> &mut Host {
        if name == self.board.name { &mut self.board } else { &mut self.ground }
    }

    /// Messages carried and given up on the routes whose keys contain `part`, by both gateways.
    pub(super) fn figures(&self, part: &str) -> [(u64, u64, u64); 2] {
        [&self.board, &self.ground].map(|host| {
            let figures = host.gateway.as_ref().map(Gateway::figures).unwrap_or_default();
            let figures = figures.iter().filter(|(key, _)| key.contains(part));
            figures.fold((0, 0, 0), |(carried, given_up, held), (_, counts)| {
                (carried + counts.carried(), given_up + counts.given_up(), held + counts.held())
            })
        })
    }
}

impl Host {
    pub(super) async fn open(&self, component: &str) -> Component {
        self.open_plan(&plan(component)).await
    }

    /// What tools say of a component on this host.
    pub(super) fn state_of(&self, component: &str) -> ComponentState {
        self.dir().state(component)
    }

    fn dir(&self) -> SystemDir {
        let variable = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| self.folder.path().into());
        RuntimeDir::locate(&variable).unwrap().system("local").unwrap()
    }

    pub(super) async fn open_plan(&self, plan: &Plan) -> Component {
        Component::open_with(plan, OpenOptions::new().runtime_dir(self.folder.path())).await.unwrap()
    }
}

pub(super) fn plan(component: &str) -> Plan {
    system().component(component).unwrap().clone()
}

fn system() -> SystemPlan {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/local/two_hosts.yaml");
    let loaded = scl_loader::load(&scl_loader::Request::new(path));
    let problems = || loaded.diagnostics.iter().map(|problem| problem.message.clone()).collect::<Vec<_>>();
    loaded.system_plan().unwrap_or_else(|| panic!("{:?}", problems()))
}

/// Waits until something is true. It is looked at in every turn of the runtime.
pub(super) async fn until(what: &str, mut condition: impl FnMut() -> bool) {
    let looking = poll_fn(|cx| {
        cx.waker().wake_by_ref();
        if condition() { Poll::Ready(()) } else { Poll::Pending }
    });
    assert!(tokio::time::timeout(LONG, looking).await.is_ok(), "{what}");
}

pub(super) fn numbered(number: u32) -> bytes::Bytes {
    bytes::Bytes::copy_from_slice(&number.to_be_bytes())
}

pub(super) fn number(message: &[u8]) -> u32 {
    u32::from_be_bytes(message.try_into().unwrap())
}
