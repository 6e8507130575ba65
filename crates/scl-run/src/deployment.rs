//! Which host runs which components, and how the hosts reach each other: `hosts` and `gateway` of a launch file.

use scl_terminal::{Problem, quoted_list};
use std::net::IpAddr;
use std::path::PathBuf;

/// The hosts of a system, and what their gateways need.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Deployment {
    /// In file order.
    pub hosts: Vec<Host>,
    /// The folder with the certificates. Without one, the gateways do not encrypt, and all hosts are on loopback unless
    /// `insecure` is set.
    pub certificates: Option<PathBuf>,
    /// Whether addresses other than loopback are accepted without certificates.
    pub insecure: bool,
}

/// A host: where its gateway listens, and the components that run there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Host {
    /// Its name in the launch file.
    pub name: String,
    /// An IP address or a DNS name.
    pub address: String,
    /// The TCP port of its gateway.
    pub port: u16,
    /// In file order.
    pub components: Vec<String>,
}

impl Deployment {
    /// The folder of the authority that signs the certificates, beside those of the hosts. No host has this name.
    pub const AUTHORITY: &str = "authority";

    /// The name of the gateway's program in the output and in `scl restart`. No component has this name.
    pub const GATEWAY: &str = "gateway";

    /// The host with this name.
    pub fn host(&self, name: &str) -> Option<&Host> {
        self.hosts.iter().find(|host| host.name == name)
    }

    /// Returns the problem that no host has this name. It lists the existing hosts.
    pub fn unknown_host(&self, name: &str) -> Problem {
        let names = || self.hosts.iter().map(|host| host.name.as_str());
        let problem = Problem::new(format!("unknown host `{name}`"));
        let problem = problem.did_you_mean(name, names());
        problem.note(format!("the launch file has the hosts {}", quoted_list(names())))
    }

    /// The host that runs a component.
    pub fn host_of(&self, component: &str) -> Option<&Host> {
        self.hosts.iter().find(|host| host.components.iter().any(|it| it == component))
    }
}

impl Host {
    /// Where the gateway listens: `192.0.2.10:7447`, `[::1]:7447` or `board.local:7447`.
    pub fn socket_address(&self) -> String {
        match self.address.parse() {
            Ok(IpAddr::V6(address)) => format!("[{address}]:{}", self.port),
            _ => format!("{}:{}", self.address, self.port),
        }
    }

    /// Returns true if only programs on the same machine can reach the address.
    pub fn is_loopback(&self) -> bool {
        match self.address.parse::<IpAddr>() {
            Ok(address) => address.is_loopback(),
            Err(_) => self.address == "localhost",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Host;

    #[test]
    fn addresses_become_those_of_sockets() {
        for (address, expected, is_loopback) in [
            ("192.0.2.10", "192.0.2.10:7447", false),
            ("127.0.0.2", "127.0.0.2:7447", true),
            ("::1", "[::1]:7447", true),
            ("2001:DB8::10", "[2001:db8::10]:7447", false),
            ("localhost", "localhost:7447", true),
            ("board.local", "board.local:7447", false),
        ] {
            let host = Host { name: String::new(), address: address.to_owned(), port: 7447, components: Vec::new() };
            assert_eq!((host.socket_address().as_str(), host.is_loopback()), (expected, is_loopback), "{address}");
        }
    }
}
