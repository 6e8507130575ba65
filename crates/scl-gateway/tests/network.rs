//! Hosts and the cable between them.

use crate::cable::Cable;
use crate::host::Host;
use crate::namespace::Namespace;

/// Some hosts, each connected with a hub. The first has the address 10.77.0.1.
pub(crate) struct Network {
    // Dropped in this order: programs before the network under them.
    pub(crate) hosts: Vec<Host>,
    pub(crate) cable: Cable,
    _hub: Namespace,
}

impl Network {
    pub(crate) fn new(hosts: &[&str]) -> Self {
        Self::with_clocks(hosts, &[])
    }

    /// Hosts whose clocks since their start are this many seconds ahead.
    pub(crate) fn with_clocks(hosts: &[&str], ahead: &[u32]) -> Self {
        let hub = Namespace::new();
        let host = |(index, name): (usize, &&str)| {
            let namespace = hub.beside(ahead.get(index).copied().unwrap_or(0));
            connect(&hub, &namespace, index);
            Host::new(name, address(index), namespace)
        };
        let hosts: Vec<_> = hosts.iter().enumerate().map(host).collect();
        let cable = Cable::start(&hub, hosts.len());
        Self { hosts, cable, _hub: hub }
    }

    pub(crate) fn host(&self, name: &str) -> &Host {
        self.hosts.iter().find(|host| host.name == name).unwrap()
    }
}

pub(crate) fn address(host: usize) -> String {
    format!("10.77.0.{}", host + 1)
}

/// Lays a cable between the hub and a host.
fn connect(hub: &Namespace, host: &Namespace, index: usize) {
    hub.run(&format!("ip link add port{index} type veth peer name net netns {}", host.id()));
    // One segment to a frame: the hub's frames are as long as those of a real network.
    hub.run(&format!("ip link set port{index} up"));
    host.run("ip link set net gso_max_segs 1");
    host.run(&format!("ip address add {}/24 dev net", address(index)));
    host.run("ip link set net up");
    host.run("ip link set lo up");
}
