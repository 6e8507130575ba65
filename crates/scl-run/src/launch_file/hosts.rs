//! `hosts` and `gateway`: which components run where, and how the hosts reach each other.

mod address;
mod together;

use super::super::deployment::{Deployment, Host};
use super::keys;
use super::likely::likely;
use super::reader::{Keys, Reader, wrong};
use super::rules::{CONTRADICTION, MISSING, WRONG_NAME, WRONG_VALUE};
use super::value::{flag, path, placed_texts, port as port_of, texts};
use super::words::flow_list;
use scl_topology::diagnostic::{Diagnostic, Edit};
use scl_topology::parse::Field;
use scl_topology::source::Span;
use scl_topology::yaml::Node;
use std::collections::HashSet;
use std::path::PathBuf;

/// The longest name of a host: a label of DNS.
const LONGEST_NAME: usize = 63;

/// `gateway` as written.
#[derive(Debug)]
struct Gateway {
    /// The place of the key.
    place: Span,
    port: Option<u16>,
    /// Whether `gateway` has a `port`, right or wrong.
    has_port: bool,
    certificates: Option<String>,
    has_certificates: bool,
    insecure: bool,
}

/// An entry of `hosts` as written.
#[derive(Debug)]
struct HostEntry {
    name: String,
    /// With its place.
    address: Option<(String, Span)>,
    port: Option<u16>,
    /// Whether the entry has a `port`, right or wrong.
    has_port: bool,
    /// With their places.
    components: Vec<(String, Span)>,
}

/// Maximum number of hosts for which a missing list is proposed: each looks at all others.
const MOST_HOSTS: usize = 64;

const ALLOWED: &str = "each host has an entry with its `address` and its `components`";

/// What `gateway` may be, the usual one first; the port is the one that gateways use by convention.
const GATEWAYS: [(&str, &str); 3] = [
    ("port: 7447", "with all hosts on this machine"),
    ("port: 7447, certificates: ./keys", "with certificates, which `scl gateway keys` makes"),
    ("port: 7447, insecure: true", "without certificates, so that everybody on the network can listen and send"),
];

impl Reader<'_> {
    /// Reads `hosts` and `gateway`; `None` without hosts. The folder of the certificates is as written.
    pub(super) fn read_deployment(&mut self, top: &Keys<'_, '_>) -> Option<Deployment> {
        let gateway = top.section("gateway").map(|field| self.read_gateway(field));
        let Some(field) = top.section("hosts") else {
            if let Some(gateway) =
                gateway.filter(|_| !top.may_have("hosts") && !self.missing_sections.contains(&"hosts"))
            {
                let message = "`gateway` has no effect without `hosts`";
                let problem = CONTRADICTION.at(message, gateway.place, "");
                let edit = top.get("gateway").and_then(|field| self.remove_entry(field));
                let problem = match edit {
                    Some(edit) => problem.suggest("remove `gateway`", [edit]),
                    None => problem,
                };
                self.report(problem.note("`hosts` says which components run on which host"));
            }
            return None;
        };
        let message = "`hosts` is a mapping from names to entries";
        let entries =
            self.entries(field, message, |reader, problem| reader.as_mapping(problem, field).otherwise(ALLOWED))?;
        if entries.is_empty() {
            self.report(wrong(&MISSING, "`hosts` is empty", field).help(ALLOWED));
        }
        let started = top.names_of("components");
        let entries = self.without_outdented(entries, keys::HOST);
        let fields = self.names(&entries, "`hosts`").list;
        let count = fields.len();
        let hosts: Vec<HostEntry> = fields.into_iter().filter_map(|host| self.read_host(host)).collect();
        if hosts.len() == count {
            self.check_placement(&hosts, &started, field.key_span);
        }
        self.check_addresses(&hosts, gateway.as_ref().zip(top.section("gateway")), field);
        let port = gateway.as_ref().and_then(|gateway| gateway.port);
        let host = |entry: HostEntry| Host {
            name: entry.name,
            address: entry.address.map(|(address, _)| address).unwrap_or_default(),
            port: entry.port.or(port).unwrap_or_default(),
            components: entry.components.into_iter().map(|(name, _)| name).collect(),
        };
        Some(Deployment {
            hosts: hosts.into_iter().map(host).collect(),
            insecure: gateway.as_ref().is_some_and(|gateway| gateway.insecure),
            certificates: gateway.and_then(|gateway| gateway.certificates).map(PathBuf::from),
        })
    }

    fn read_gateway(&mut self, field: Field<'_>) -> Gateway {
        let entries = self.entries(field, "`gateway` is a mapping", |reader, problem| {
            let port = likely("port", field.value).values.into_iter().next();
            let port = port.or_else(|| port_of(field.value).map(|port| port.to_string()));
            let problem = GATEWAYS.iter().fold(problem, |problem, (entry, what)| {
                let entry = port.as_ref().map(|port| entry.replace("7447", port));
                let edit = entry.and_then(|entry| {
                    let entry = format!("gateway: {{{entry}}}");
                    Some((reader.replace_entry(field, entry.clone())?, entry))
                });
                match edit {
                    Some((edit, entry)) => problem.suggest(format!("{what}: `{entry}`"), [edit]),
                    None => problem,
                }
            });
            problem.otherwise("it has the keys `port`, and `certificates` or `insecure`")
        });
        let keys = entries.map(|entries| self.keys(entries, keys::GATEWAY, "`gateway`"));
        let keys = keys.as_ref();
        // If `gateway` is not a mapping, that was reported already; do not report missing keys as well.
        let may_have = |key| keys.is_none_or(|keys| keys.may_have(key));
        Gateway {
            place: field.key_span,
            port: keys.and_then(|keys| self.read_setting(keys, "port", port_of)),
            has_port: may_have("port"),
            certificates: keys.and_then(|keys| self.read_setting(keys, "certificates", path)),
            has_certificates: may_have("certificates"),
            // A wrong value is reported, and no missing certificates beside it.
            insecure: keys.is_some_and(|keys| {
                self.read_setting(keys, "insecure", flag).unwrap_or_else(|| keys.get("insecure").is_some())
            }),
        }
    }

    fn read_host(&mut self, field: Field<'_>) -> Option<HostEntry> {
        self.check_host_name(field)?;
        let name = field.key;
        let message = format!("the entry of host `{name}` is a mapping");
        let entries = self.entries(field, &message, |reader, problem| {
            reader.as_one_mapping(problem, field).otherwise("it has an `address` and a list of `components`")
        })?;
        let keys = self.keys(entries, keys::HOST, &format!("host `{name}`"));
        Some(HostEntry {
            name: name.to_owned(),
            address: self.read_address(field, &keys),
            port: self.read_setting(&keys, "port", port_of),
            has_port: keys.get("port").is_some(),
            components: self.read_names(field, &keys),
        })
    }

    /// Checks that a name can be that of a host: certificates, keys of the network library and names of folders contain
    /// it.
    fn check_host_name(&mut self, field: Field<'_>) -> Option<()> {
        let name = field.key;
        let is_allowed = |letter: char| letter.is_ascii_alphanumeric() || "_-".contains(letter);
        let starts_well = name.starts_with(|letter: char| letter.is_ascii_alphanumeric());
        let note = match name {
            Deployment::AUTHORITY => "this is the folder of the authority that signs the certificates".to_owned(),
            _ if starts_well && name.len() <= LONGEST_NAME && name.chars().all(is_allowed) => return Some(()),
            _ => format!(
                "a host name has up to {LONGEST_NAME} letters, digits, `_` and `-`, and starts with a letter or digit"
            ),
        };
        let problem = WRONG_NAME.at(format!("`{name}` cannot be the name of a host"), field.key_span, "").note(note);
        let allowed: String = name.chars().map(|letter| if is_allowed(letter) { letter } else { '-' }).collect();
        let allowed = allowed.trim_matches(['-', '_']);
        let is_other = name != Deployment::AUTHORITY && !allowed.is_empty() && allowed.len() <= LONGEST_NAME;
        self.report(match is_other {
            true => problem.suggest(format!("write `{allowed}`"), [Edit::new(field.key_span, allowed)]),
            false => problem,
        });
        None
    }

    fn read_names(&mut self, host: Field<'_>, keys: &Keys<'_, '_>) -> Vec<(String, Span)> {
        let field = keys.get("components");
        let names = field.and_then(|field| placed_texts(field.value)).filter(|names| !names.is_empty());
        let Some(names) = names else {
            let message = format!("host `{}` has no list of `components`", host.key);
            let problem = match field {
                Some(field) => Some(wrong(&WRONG_VALUE, message, field)),
                None if keys.may_have("components") || self.is_named_by_component(host.key) => None,
                None => Some(MISSING.at(message, host.key_span, "")),
            };
            if let Some(problem) = problem {
                let problem = self.listed(problem, host, field);
                self.report(problem.otherwise("it lists the components that run there"));
            }
            return Vec::new();
        };
        names.iter().for_each(|(name, place)| self.check_component(name, *place));
        names
    }

    /// Proposes the list of a host: the words that stand there, or what is on no other host.
    fn listed(&self, problem: Diagnostic, host: Field<'_>, list: Option<Field<'_>>) -> Diagnostic {
        if let Some((field, text)) = list.and_then(|field| Some((field, field.value.text()?))) {
            let words: Vec<&str> = text.split([',', ' ']).filter(|word| !word.is_empty()).collect();
            return self.whole(problem, field, format!("components: {}", flow_list(&words)));
        }
        let names = |node: Option<&Node>| -> Vec<String> {
            let entries = node.and_then(Node::entries).unwrap_or_default();
            entries.iter().filter_map(|(key, _)| key.text()).map(str::to_owned).collect()
        };
        let started = names(self.top_value("components"));
        let all = self.known.map_or(&started, |known| &known.components);
        let hosts = self.top_value("hosts").and_then(Node::entries).unwrap_or_default();
        if hosts.len() > MOST_HOSTS {
            return problem;
        }
        let lists = hosts.iter().filter_map(|(_, host)| host.entries()).flatten();
        let lists = lists.filter(|(key, _)| key.text() == Some("components"));
        let placed: HashSet<String> = lists.filter_map(|(_, list)| texts(list)).flatten().collect();
        let left: Vec<&String> = all.iter().filter(|name| !placed.contains(*name)).collect();
        if left.is_empty() || left.len() > 8 {
            return problem;
        }
        let entry = format!("components: {}", flow_list(&left));
        let edit = match list {
            Some(field) => self.replace_entry(field, entry.clone()),
            None => self.add_entry(host.value, &entry),
        };
        match edit {
            Some(edit) => problem.suggest(format!("what is on no other host: `{entry}`"), [edit]),
            None => problem,
        }
    }
}
