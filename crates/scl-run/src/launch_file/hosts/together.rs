//! What can be said of all hosts together: each component on one of them, each address once, nothing open to a network.

use super::super::reader::{KeyPath, Reader};
use super::{Gateway, Host, HostEntry};
use scl_terminal::{Problem, quoted_list};
use serde_yaml::Value;

impl Reader<'_> {
    /// Reports a name that is neither in the topology nor, without one, in `components` of the file.
    pub(super) fn check_is_component(&mut self, name: &str, at: KeyPath<'_>, components: Option<&Value>) {
        let names = self.component_names(components);
        let source = if self.known.is_some() { "the topology" } else { "the launch file" };
        if !names.is_empty() {
            self.check_among(name, at, &names, source);
        }
    }

    /// Every component runs on exactly one host.
    pub(super) fn check_placement(&mut self, hosts: &[HostEntry], components: Option<&Value>) {
        let names = self.component_names(components);
        let placed = || hosts.iter().flat_map(|host| host.components.iter().map(move |name| (name, host)));
        for (index, (name, host)) in placed().enumerate() {
            let Some((_, first)) = placed().take(index).find(|(earlier, _)| *earlier == name) else { continue };
            let problem = Problem::new(if first.name == host.name {
                format!("component `{name}` is twice on host `{}`", host.name)
            } else {
                format!("component `{name}` is on two hosts, `{}` and `{}`", first.name, host.name)
            });
            let place = self.text.place(&["hosts", &host.name, "components"]);
            self.problems.push(problem.at(place).help("remove it from one of the lists"));
        }
        // A misspelt name, or an entry that could not be read, would be reported a second time here.
        let is_known = |name: &String| names.contains(name);
        if hosts.iter().any(|host| host.components.is_empty() || !host.components.iter().all(is_known)) {
            return;
        }
        let missing: Vec<String> = names.into_iter().filter(|name| !placed().any(|(it, _)| it == name)).collect();
        if !missing.is_empty() {
            let problem = Problem::new(match missing.as_slice() {
                [one] => format!("component `{one}` is on no host"),
                several => format!("the components {} are on no host", list(several)),
            });
            let place = self.text.place(&["hosts"]);
            self.problems.push(problem.at(place).help("add each to `components` of the host that runs it"));
        }
    }

    /// Every host can be reached, at an address of its own, by nobody but the others.
    pub(super) fn check_addresses(&mut self, hosts: &[HostEntry], gateway: Option<&Gateway>) {
        let Some(gateway) = gateway else {
            let problem = Problem::new("`gateway` is missing, which the hosts need").at(self.text.place(&["hosts"]));
            self.problems.push(problem.help("write `gateway: {port: 7447, certificates: ./keys}`"));
            return;
        };
        if !gateway.has_port && hosts.iter().any(|host| !host.has_port) {
            let problem = Problem::new("`gateway` has no `port`").at(self.text.place(&["gateway"]));
            self.problems.push(problem.help("write `gateway: {port: 7447, certificates: ./keys}`"));
        }
        let mut seen: Vec<Host> = Vec::new();
        for entry in hosts {
            let Some(address) = entry.address.clone() else { continue };
            let port = entry.port.or(gateway.port.filter(|_| !entry.has_port)).unwrap_or_default();
            let host = Host { name: entry.name.clone(), address, port, components: Vec::new() };
            let same = |known: &&Host| port != 0 && known.socket_address() == host.socket_address();
            if let Some(known) = seen.iter().find(same) {
                let message = format!(
                    "the hosts `{}` and `{}` have the same address, `{}`",
                    known.name,
                    host.name,
                    host.socket_address()
                );
                let place = self.text.place(&["hosts", &host.name, "address"]);
                let help = "on one machine, give each a `port` of its own";
                self.problems.push(Problem::new(message).at(place).help(help));
            }
            seen.push(host);
        }
        let is_open = !gateway.has_certificates && !gateway.insecure;
        if let Some(host) = seen.iter().find(|host| is_open && !host.is_loopback()) {
            let message = format!("host `{}` is not on loopback, and `gateway` has no `certificates`", host.name);
            let problem = Problem::new(message).at(self.text.place(&["hosts", &host.name, "address"]));
            let problem =
                problem.help("write `gateway: {port: 7447, certificates: ./keys}`, and run `scl gateway keys`");
            self.problems.push(problem.note("without certificates everybody on the network could listen and send"));
        }
    }

    fn component_names(&self, components: Option<&Value>) -> Vec<String> {
        match self.known {
            Some(known) => known.components.clone(),
            None => {
                let entries = components.and_then(Value::as_mapping).into_iter().flatten();
                entries.filter_map(|(name, _)| name.as_str()).map(str::to_owned).collect()
            }
        }
    }
}

fn list(names: &[String]) -> String {
    quoted_list(names)
}
