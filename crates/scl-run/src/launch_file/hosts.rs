//! `hosts` and `gateway`: which components run where, and how the hosts reach each other.

mod address;
mod together;

use super::super::deployment::{Deployment, Host};
use super::keys;
use super::reader::{Keys, Reader, wrong};
use super::rules::{CONTRADICTION, MISSING, WRONG_NAME, WRONG_VALUE};
use super::value::{flag, number, path, placed_texts};
use scl_topology::parse::Field;
use scl_topology::source::Span;
use scl_topology::yaml::Node;
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

const EXAMPLE: &str = "write `hosts: {board: {address: 192.0.2.10, components: [sensor]}}`";
const GATEWAY_EXAMPLE: &str = "write `gateway: {port: 7447, certificates: ./keys}`";

impl Reader<'_> {
    /// Reads `hosts` and `gateway`; `None` without hosts. The folder of the certificates is as written.
    pub(super) fn read_deployment(&mut self, top: &Keys<'_, '_>) -> Option<Deployment> {
        let gateway = top.get("gateway").map(|field| self.read_gateway(field));
        let Some(field) = top.get("hosts") else {
            if let Some(gateway) = gateway.filter(|_| !top.may_have("hosts")) {
                let message = "`gateway` has no effect without `hosts`";
                self.report(CONTRADICTION.at(message, gateway.place, "").help(EXAMPLE));
            }
            return None;
        };
        let entries = self.entries(field, "`hosts` is a mapping from names to entries", EXAMPLE)?;
        if entries.is_empty() {
            self.report(wrong(&MISSING, "`hosts` is empty", field).help(EXAMPLE));
        }
        let started = top.names_of("components");
        let fields = self.names(entries, "`hosts`").list;
        let count = fields.len();
        let hosts: Vec<HostEntry> = fields.into_iter().filter_map(|host| self.read_host(host, &started)).collect();
        if hosts.len() == count {
            self.check_placement(&hosts, &started, field.key_span);
        }
        self.check_addresses(&hosts, gateway.as_ref(), field.key_span);
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
        let entries = self.entries(field, "`gateway` is a mapping", GATEWAY_EXAMPLE);
        let keys = entries.map(|entries| self.keys(entries, keys::GATEWAY, "`gateway`"));
        let keys = keys.as_ref();
        // If `gateway` is not a mapping, that was reported already; do not report missing keys as well.
        let may_have = |key| keys.is_none_or(|keys| keys.may_have(key));
        Gateway {
            place: field.key_span,
            port: keys.and_then(|keys| self.read_setting(keys, "port", port)),
            has_port: may_have("port"),
            certificates: keys.and_then(|keys| self.read_setting(keys, "certificates", path)),
            has_certificates: may_have("certificates"),
            insecure: keys.and_then(|keys| self.read_setting(keys, "insecure", flag)).unwrap_or_default(),
        }
    }

    fn read_host(&mut self, field: Field<'_>, started: &[String]) -> Option<HostEntry> {
        self.check_host_name(field)?;
        let name = field.key;
        let help = format!("write `{name}: {{address: 192.0.2.10, components: [sensor]}}`");
        let entries = self.entries(field, &format!("the entry of host `{name}` is a mapping"), &help)?;
        let keys = self.keys(entries, keys::HOST, &format!("host `{name}`"));
        Some(HostEntry {
            name: name.to_owned(),
            address: self.read_address(field, &keys),
            port: self.read_setting(&keys, "port", port),
            has_port: keys.get("port").is_some(),
            components: self.read_names(field, &keys, started),
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
        self.report(WRONG_NAME.at(format!("`{name}` cannot be the name of a host"), field.key_span, "").note(note));
        None
    }

    fn read_names(&mut self, host: Field<'_>, keys: &Keys<'_, '_>, started: &[String]) -> Vec<(String, Span)> {
        let field = keys.get("components");
        let names = field.and_then(|field| placed_texts(field.value)).filter(|names| !names.is_empty());
        let Some(names) = names else {
            let message = format!("host `{}` has no list of `components`", host.key);
            let problem = match field {
                Some(field) => Some(wrong(&WRONG_VALUE, message, field)),
                None if keys.may_have("components") => None,
                None => Some(MISSING.at(message, host.key_span, "")),
            };
            problem
                .into_iter()
                .for_each(|problem| self.report(problem.help("write `components: [sensor, controller]`")));
            return Vec::new();
        };
        names.iter().for_each(|(name, place)| self.check_is_component(name, *place, started));
        names
    }
}

fn port(value: &Node) -> Option<u16> {
    number(value).and_then(|number| u16::try_from(number).ok()).filter(|port| *port != 0)
}
