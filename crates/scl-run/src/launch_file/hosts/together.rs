//! Checks across all hosts: each component is on one host, each address is used once, and no gateway is open to a
//! network.

use super::super::reader::Reader;
use super::super::rules::{HOSTS, MISSING};
use super::{GATEWAY_EXAMPLE, Gateway, Host, HostEntry};
use scl_terminal::quoted_list;
use scl_topology::source::Span;

impl Reader<'_> {
    /// Reports a name that is not a component of the topology or, without a topology, of the launch file.
    pub(super) fn check_is_component(&mut self, name: &str, at: Span, started: &[String]) {
        let source = if self.known.is_some() { "the topology" } else { "the launch file" };
        let names = self.component_names(started).to_vec();
        if !names.is_empty() {
            self.check_among(name, at, &names, source);
        }
    }

    /// Checks that every component runs on exactly one host.
    pub(super) fn check_placement(&mut self, hosts: &[HostEntry], started: &[String], place: Span) {
        let placed =
            || hosts.iter().flat_map(|host| host.components.iter().map(move |(name, place)| (name, *place, host)));
        for (index, (name, place, host)) in placed().enumerate() {
            let Some((_, earlier, first)) = placed().take(index).find(|(earlier, ..)| *earlier == name) else {
                continue;
            };
            let message = if first.name == host.name {
                format!("component `{name}` is twice on host `{}`", host.name)
            } else {
                format!("component `{name}` is on two hosts, `{}` and `{}`", first.name, host.name)
            };
            let problem = HOSTS.at(message, place, "").label(earlier, "first here");
            self.report(problem.help("remove it from one of the lists"));
        }
        let names = self.component_names(started);
        // A misspelt name or an unreadable entry would be reported a second time here.
        let is_known = |(name, _): &(String, Span)| names.contains(name);
        if hosts.iter().any(|host| host.components.is_empty() || !host.components.iter().all(is_known)) {
            return;
        }
        let missing: Vec<&String> = names.iter().filter(|name| !placed().any(|(it, ..)| it == *name)).collect();
        if !missing.is_empty() {
            let message = match missing.as_slice() {
                [one] => format!("component `{one}` is on no host"),
                several => format!("the components {} are on no host", quoted_list(several)),
            };
            let help = "add each to `components` of the host that runs it";
            self.report(HOSTS.at(message, place, "").help(help));
        }
    }

    /// Checks that there is a `gateway`, that every host has a port, that no two hosts have the same address, and that
    /// addresses other than loopback are not used without certificates unless `insecure` allows it.
    pub(super) fn check_addresses(&mut self, hosts: &[HostEntry], gateway: Option<&Gateway>, place: Span) {
        let Some(gateway) = gateway else {
            let problem = MISSING.at("`gateway` is missing, but `hosts` needs it", place, "");
            return self.report(problem.help(GATEWAY_EXAMPLE));
        };
        if !gateway.has_port && hosts.iter().any(|host| !host.has_port) {
            self.report(MISSING.at("`gateway` has no `port`", gateway.place, "").help(GATEWAY_EXAMPLE));
        }
        let mut seen: Vec<(Host, Span)> = Vec::new();
        for entry in hosts {
            let Some((address, place)) = entry.address.clone() else { continue };
            let port = entry.port.or(gateway.port.filter(|_| !entry.has_port)).unwrap_or_default();
            let host = Host { name: entry.name.clone(), address, port, components: Vec::new() };
            let same = |(known, _): &&(Host, Span)| port != 0 && known.socket_address() == host.socket_address();
            if let Some((known, first)) = seen.iter().find(same) {
                let address = host.socket_address();
                let message =
                    format!("the hosts `{}` and `{}` have the same address, `{address}`", known.name, host.name);
                let problem = HOSTS.at(message, place, "").label(*first, "first here");
                self.report(problem.help("on one machine, give each its own `port`"));
            }
            seen.push((host, place));
        }
        let is_open = !gateway.has_certificates && !gateway.insecure;
        if let Some((host, place)) = seen.iter().find(|(host, _)| is_open && !host.is_loopback()) {
            let message = format!("host `{}` is not on loopback, and `gateway` has no `certificates`", host.name);
            let problem = HOSTS.at(message, *place, "").help(format!("{GATEWAY_EXAMPLE}, and run `scl gateway keys`"));
            self.report(problem.note("without certificates everybody on the network could listen and send"));
        }
    }

    fn component_names<'n>(&'n self, started: &'n [String]) -> &'n [String] {
        self.known.map_or(started, |known| &known.components)
    }
}
