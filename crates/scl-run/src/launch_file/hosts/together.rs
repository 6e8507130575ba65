//! Checks across all hosts: each component is on one host, each address is used once, and no gateway is open to a
//! network.

use super::super::reader::Reader;
use super::super::rules::{HOSTS, MISSING};
use super::{GATEWAYS, Gateway, Host, HostEntry};
use scl_terminal::quoted_list;
use scl_topology::diagnostic::{Diagnostic, Edit, removal};
use scl_topology::parse::Field;
use scl_topology::source::Span;
use scl_topology::yaml::Node;

impl Reader<'_> {
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
            let ways = [(earlier, &first.name), (place, &host.name)];
            let problem = ways.into_iter().fold(problem, |problem, (at, of)| match removal(self.source, at) {
                Some(removed) => problem.suggest(format!("remove it from `{of}`"), [removed]),
                None => problem,
            });
            self.report(problem);
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
            let names = missing.iter().map(|name| name.as_str()).collect::<Vec<_>>().join(", ");
            let problem = HOSTS.at(message, place, "");
            let problem = hosts.iter().take(3).fold(problem, |problem, host| {
                let last = host.components.last().map(|(_, at)| *at);
                // In a list of lines, each name needs a line of its own.
                let Some(at) = last.filter(|at| self.is_in_brackets(*at)) else { return problem };
                let edit = Edit::new(Span { start: at.end, ..at }, format!(", {names}"));
                problem.suggest(format!("add `{names}` to `components` of host `{}`", host.name), [edit])
            });
            self.report(problem.otherwise("each component is in `components` of one host"));
        }
    }

    /// Checks that there is a `gateway`, that every host has a port, that no two hosts have the same address, and that
    /// addresses other than loopback are not used without certificates unless `insecure` allows it.
    pub(super) fn check_addresses(
        &mut self,
        hosts: &[HostEntry],
        gateway: Option<(&Gateway, Field<'_>)>,
        field: Field<'_>,
    ) {
        let Some((gateway, written)) = gateway else {
            let problem = MISSING.at("`gateway` is missing, but `hosts` needs it", field.key_span, "");
            let problem = GATEWAYS.iter().fold(problem, |problem, (entry, what)| {
                let entry = format!("gateway: {{{entry}}}");
                match self.root.and_then(|root| self.add_behind(root, field, &entry)) {
                    Some(edit) => problem.suggest(format!("{what}: `{entry}`"), [edit]),
                    None => problem,
                }
            });
            return self.report(problem.otherwise("it has the keys `port`, and `certificates` or `insecure`"));
        };
        if !gateway.has_port && hosts.iter().any(|host| !host.has_port) {
            let problem = MISSING.at("`gateway` has no `port`", gateway.place, "");
            let problem = self.with_key(problem, written, "port: 7447", "");
            self.report(problem.otherwise("it has the port of the hosts without one of their own"));
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
        // Certificates in the entry of a host were reported.
        let has_own = |(key, _): &(Node, Node)| matches!(key.text(), Some("certificates" | "insecure"));
        let in_hosts =
            field.value.entries().unwrap_or_default().iter().filter_map(|(_, host)| host.entries()).flatten();
        let is_open = !gateway.has_certificates && !gateway.insecure && !in_hosts.into_iter().any(has_own);
        if let Some((host, place)) = seen.iter().find(|(host, _)| is_open && !host.is_loopback()) {
            let message = format!("host `{}` is not on loopback, and `gateway` has no `certificates`", host.name);
            let problem = HOSTS.at(message, *place, "");
            let problem = self.with_key(problem, written, "certificates: ./keys", GATEWAYS[1].1);
            let problem = self.with_key(problem, written, "insecure: true", GATEWAYS[2].1);
            self.report(problem.note("without certificates everybody on the network could listen and send"));
        }
    }

    /// Proposes one more key of `gateway`.
    fn with_key(&self, problem: Diagnostic, gateway: Field<'_>, entry: &str, what: &str) -> Diagnostic {
        let edit = match gateway.value.entries() {
            Some([]) => self.replace_entry(gateway, format!("gateway: {{{entry}}}")),
            _ => self.add_entry(gateway.value, entry),
        };
        let text = if what.is_empty() { String::new() } else { format!("{what}: ") };
        match edit {
            Some(edit) => problem.suggest(format!("{text}add `{entry}` to `gateway`"), [edit]),
            None => problem,
        }
    }

    fn component_names<'n>(&'n self, started: &'n [String]) -> &'n [String] {
        self.known.map_or(started, |known| &known.components)
    }
}
