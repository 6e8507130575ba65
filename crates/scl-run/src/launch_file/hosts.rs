//! `hosts` and `gateway`: which components run where, and how the hosts reach each other.

mod address;
mod together;

use super::super::deployment::{Deployment, Host};
use super::keys;
use super::reader::{KeyPath, Reader, joined, likely_key, shown};
use scl_terminal::Problem;
use serde_yaml::{Mapping, Value};
use std::path::PathBuf;

/// The longest name of a host: a label of DNS.
const LONGEST_NAME: usize = 63;

/// `gateway` as written.
#[derive(Debug, Default)]
struct Gateway {
    port: Option<u16>,
    /// Whether there is one, right or wrong.
    has_port: bool,
    certificates: Option<String>,
    has_certificates: bool,
    insecure: bool,
}

/// An entry of `hosts` as written.
#[derive(Debug)]
struct HostEntry {
    name: String,
    address: Option<String>,
    port: Option<u16>,
    /// Whether a `port` is there, right or wrong.
    has_port: bool,
    components: Vec<String>,
}

impl Reader<'_> {
    /// Reads both keys of the file; `None` without hosts. The folder of the certificates is as written.
    pub(super) fn read_deployment(&mut self, top: &Mapping) -> Option<Deployment> {
        let gateway = top.get("gateway").map(|value| self.read_gateway(value));
        let Some(hosts) = top.get("hosts") else {
            if gateway.is_some() {
                let problem = Problem::new("`gateway` has no effect without `hosts`");
                let problem = problem.at(self.text.place(&["gateway"]));
                self.problems.push(problem.help("write `hosts: {board: {address: 192.0.2.10, components: [sensor]}}`"));
            }
            return None;
        };
        let Some(entries) = hosts.as_mapping().filter(|entries| !entries.is_empty()) else {
            let problem =
                Problem::new(format!("`hosts` is a mapping from names to entries, not {}", shown_hosts(hosts)));
            let problem = problem.at(self.text.place(&["hosts"]));
            self.problems.push(problem.help("write `hosts: {board: {address: 192.0.2.10, components: [sensor]}}`"));
            return None;
        };
        let hosts: Vec<HostEntry> =
            entries.iter().filter_map(|(name, entry)| self.read_host(name, entry, top.get("components"))).collect();
        if hosts.len() == entries.len() {
            self.check_placement(&hosts, top.get("components"));
        }
        self.check_addresses(&hosts, gateway.as_ref());
        let gateway = gateway.unwrap_or_default();
        let host = |entry: HostEntry| Host {
            name: entry.name,
            address: entry.address.unwrap_or_default(),
            port: entry.port.or(gateway.port).unwrap_or_default(),
            components: entry.components,
        };
        Some(Deployment {
            hosts: hosts.into_iter().map(host).collect(),
            certificates: gateway.certificates.map(PathBuf::from),
            insecure: gateway.insecure,
        })
    }

    fn read_gateway(&mut self, value: &Value) -> Gateway {
        let Some(keys) = value.as_mapping() else {
            let problem = Problem::new(format!("`gateway` is a mapping, not {}", shown(value)));
            let problem = problem.at(self.text.place(&["gateway"]));
            self.problems.push(problem.help("write `gateway: {port: 7447, certificates: ./keys}`"));
            // What is missing in it has been said.
            return Gateway { has_port: true, has_certificates: true, ..Gateway::default() };
        };
        let at = ["gateway"];
        self.check_keys(keys, &at, keys::GATEWAY, "in `gateway`");
        Gateway {
            port: self.read_setting(keys, &at, "port", port),
            has_port: means_to_have(keys, "port"),
            certificates: self.read_path(keys.get("certificates"), &joined(&at, "certificates")),
            has_certificates: means_to_have(keys, "certificates"),
            insecure: self.read_setting(keys, &at, "insecure", Value::as_bool).unwrap_or_default(),
        }
    }

    fn read_host(&mut self, name: &Value, entry: &Value, components: Option<&Value>) -> Option<HostEntry> {
        let name = self.read_host_name(name)?;
        let at = joined(&["hosts"], name);
        let Some(keys) = entry.as_mapping() else {
            let problem = Problem::new(format!("the entry of host `{name}` is not a mapping")).at(self.text.place(&at));
            let help = format!("write `{name}: {{address: 192.0.2.10, components: [sensor]}}`");
            self.problems.push(problem.help(help));
            return None;
        };
        self.check_keys(keys, &at, keys::HOST, &format!("in host `{name}`"));
        Some(HostEntry {
            name: name.to_owned(),
            address: self.read_address(name, keys, &at),
            port: self.read_setting(keys, &at, "port", port),
            has_port: keys.contains_key("port"),
            components: self.read_names(name, keys, &at, components),
        })
    }

    /// The name stands in certificates, keys of the network library and names of folders.
    fn read_host_name<'n>(&mut self, name: &'n Value) -> Option<&'n str> {
        let is_plain = |name: &&str| {
            let starts_well = name.starts_with(|letter: char| letter.is_ascii_alphanumeric());
            let is_allowed = |letter: char| letter.is_ascii_alphanumeric() || "_-".contains(letter);
            starts_well && name.len() <= LONGEST_NAME && name.chars().all(is_allowed)
        };
        let Some(plain) = name.as_str().filter(is_plain) else {
            let path: Vec<&str> = ["hosts"].into_iter().chain(name.as_str()).collect();
            let problem = Problem::new(format!("{} cannot be the name of a host", shown(name)));
            let rule =
                format!("it has up to {LONGEST_NAME} letters, digits, `_` and `-`, and starts with a letter or digit");
            self.problems.push(problem.at(self.text.place(&path)).note(rule));
            return None;
        };
        if plain == Deployment::AUTHORITY {
            let problem = Problem::new(format!("no host can be called `{plain}`"));
            let problem = problem.at(self.text.place(&["hosts", plain]));
            self.problems.push(problem.note("this is the folder of the authority that signs the certificates"));
            return None;
        }
        Some(plain)
    }

    fn read_names(&mut self, host: &str, keys: &Mapping, at: KeyPath<'_>, components: Option<&Value>) -> Vec<String> {
        let value = keys.get("components");
        let names = value.and_then(Value::as_sequence).filter(|names| !names.is_empty());
        let Some(names) = names.and_then(|names| names.iter().map(Value::as_str).collect::<Option<Vec<&str>>>()) else {
            let means_it = |key: &str| likely_key(key, keys::HOST) == Some("components");
            if value.is_some() || !keys.keys().filter_map(Value::as_str).any(means_it) {
                let place =
                    if value.is_some() { self.text.place(&joined(at, "components")) } else { self.text.place(at) };
                let problem = Problem::new(format!("host `{host}` has no list of `components`")).at(place);
                self.problems.push(problem.help("write `components: [sensor, controller]`"));
            }
            return Vec::new();
        };
        let at = joined(at, "components");
        names.iter().for_each(|name| self.check_is_component(name, &at, components));
        names.into_iter().map(str::to_owned).collect()
    }
}

/// Whether `gateway` has this key, maybe misspelt, which has been reported.
fn means_to_have(keys: &Mapping, key: &str) -> bool {
    let mut words = keys.keys().filter_map(Value::as_str);
    words.any(|word| word == key || likely_key(word, keys::GATEWAY) == Some(key))
}

fn port(value: &Value) -> Option<u16> {
    value.as_u64().and_then(|number| u16::try_from(number).ok()).filter(|port| *port != 0)
}

fn shown_hosts(value: &Value) -> String {
    match value {
        Value::Mapping(_) => "an empty one".to_owned(),
        other => shown(other),
    }
}
