//! `address`: where the gateway of a host listens, and where the others find it.

use super::super::keys;
use super::super::reader::{Keys, Reader, wrong};
use super::super::rules::{HOSTS, MISSING, WRONG_VALUE};
use super::super::value::{shown, text};
use super::super::words::flow_word;
use scl_topology::diagnostic::Edit;
use scl_topology::parse::Field;
use scl_topology::source::Span;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};

/// The longest DNS name.
const LONGEST: usize = 253;

impl Reader<'_> {
    pub(super) fn read_address(&mut self, host: Field<'_>, fields: &Keys<'_, '_>) -> Option<(String, Span)> {
        let Some(field) = fields.get("address") else {
            if !fields.may_have("address") {
                let problem = MISSING.at(format!("host `{}` has no `address`", host.key), host.key_span, "");
                self.report(problem.help("it is the IP address or the DNS name by which the other hosts reach it"));
            }
            return None;
        };
        let text = text(field.value).unwrap_or_default();
        if let Some((address, port)) = parts(text) {
            let message = format!("`address` is an address alone, not {}", shown(field.value));
            let problem = wrong(&WRONG_VALUE, message, field);
            let entry = format!("address: {}", flow_word(&address));
            let port = port.filter(|_| fields.get("port").is_none()).map(|port| port.to_string());
            let problem = match (port, self.port_of_gateway()) {
                (Some(port), of_all) if of_all != Some(port.as_str()) => {
                    let both = format!("{entry}{}port: {port}", self.separator_of_entries(field));
                    let text = format!("write `{entry}` and `port: {port}`");
                    let edit = self.replace_entry(field, both);
                    match (edit, of_all) {
                        (None, _) => problem,
                        (Some(edit), None) => problem.propose(text, [edit]),
                        (Some(edit), Some(other)) => self
                            .other_entry(problem, field, entry)
                            .suggest(format!("{text}, in place of port {other} of `gateway`"), [edit]),
                    }
                }
                _ => self.whole(problem, field, entry),
            };
            self.report(problem);
            return None;
        }
        if text.parse().is_ok_and(|address: IpAddr| address.is_unspecified()) {
            let problem = wrong(&HOSTS, format!("the other hosts cannot connect to `{text}`"), field);
            self.report(problem.help("write the address of one of the host's network interfaces"));
            return None;
        }
        if !is_address(text) {
            let form = keys::form_of("address").description();
            let problem = wrong(&WRONG_VALUE, format!("`address` is {form}, not {}", shown(field.value)), field);
            let problem = self.with_template(problem, field.value);
            let numbers = ipv4(text).map(|address| address.to_string());
            let has_zeros = text.split(|letter: char| !letter.is_ascii_digit()).any(has_leading_zero);
            let meant = numbers.clone().unwrap_or_else(|| text.replace('_', "-"));
            let problem = match numbers.filter(|_| !has_zeros) {
                Some(address) => self.whole(problem, field, format!("address: {address}")),
                None if is_address(&meant) && !text.is_empty() => {
                    problem.suggest(format!("write `address: {meant}`"), [Edit::new(field.value.span, meant)])
                }
                None => problem,
            };
            self.report(problem);
            return None;
        }
        Some((text.to_owned(), field.value.span))
    }

    /// The port of the hosts without one of their own, as written.
    fn port_of_gateway(&self) -> Option<&str> {
        let mut keys = self.top_value("gateway")?.entries()?.iter();
        keys.find(|(key, _)| key.text() == Some("port"))?.1.text()
    }
}

fn is_address(text: &str) -> bool {
    text.parse::<IpAddr>().is_ok() || is_dns_name(text)
}

/// Whether this is a DNS name. Names whose last label is a number are rejected: they are mistyped IPv4 addresses.
fn is_dns_name(text: &str) -> bool {
    let is_label = |label: &str| {
        let is_allowed = |letter: char| letter.is_ascii_alphanumeric() || letter == '-';
        (1..=63).contains(&label.len())
            && label.chars().all(is_allowed)
            && !label.starts_with('-')
            && !label.ends_with('-')
    };
    let last = text.rsplit('.').next().unwrap_or_default();
    text.len() <= LONGEST && text.split('.').all(is_label) && !last.chars().all(|letter| letter.is_ascii_digit())
}

/// The IPv4 address whose numbers are separated by something else than one dot each, or have zeros before them.
fn ipv4(text: &str) -> Option<Ipv4Addr> {
    let numbers = text.split(['.', ',', ';', ' ', '…']).filter(|number| !number.is_empty());
    let numbers: Vec<u8> = numbers.map(|number| number.parse().ok()).collect::<Option<_>>()?;
    Some(Ipv4Addr::from(<[u8; 4]>::try_from(numbers).ok()?))
}

/// Whether no reader knows if a number is a decimal one: `010` is ten or eight.
fn has_leading_zero(number: &str) -> bool {
    number.len() > 1 && number.starts_with('0')
}

/// Returns the address in a text like `192.0.2.10:7447`, `tcp://192.0.2.10:7447`, `pi@board.local` or `192.0.2.10/24`,
/// and its port. `None` if the text is an address alone, or has none.
fn parts(text: &str) -> Option<(String, Option<u16>)> {
    let behind_scheme = text.split_once("://").map_or(text, |(_, rest)| rest);
    let behind_scheme = ["tcp/", "udp/", "tls/", "tcp:", "udp:"]
        .iter()
        .find_map(|scheme| behind_scheme.strip_prefix(scheme))
        .unwrap_or(behind_scheme);
    let host = behind_scheme.rsplit('@').next()?.split('/').next()?;
    if let Ok(address) = host.parse::<SocketAddr>() {
        return Some((address.ip().to_string(), Some(address.port())));
    }
    let bare = host.trim_matches(['[', ']']);
    if is_address(bare) {
        return (bare != text).then(|| (bare.to_owned(), None));
    }
    let (name, port) = host.split_once(':').filter(|(name, _)| is_dns_name(name))?;
    Some((name.to_owned(), Some(port.parse().ok()?)))
}

#[cfg(test)]
mod tests {
    use super::{is_address, parts};

    #[test]
    fn addresses_are_those_of_ip_and_dns() {
        for good in ["192.0.2.10", "::1", "2001:db8::10", "localhost", "board", "board-2.lab.example"] {
            assert!(is_address(good), "{good}");
        }
        let long = ["a".repeat(63).as_str(); 4].join(".");
        for bad in ["", "192.0.2", "192.0.2.256", "a b", "a_b", "-a", "a-", "a..b", "[::1]", "a:1", "12", &long] {
            assert!(!is_address(bad), "{bad}");
        }
    }

    #[test]
    fn ports_are_told_apart() {
        for (text, meant) in [
            ("192.0.2.10:7447", Some(("192.0.2.10", Some(7447)))),
            ("[::1]:1", Some(("::1", Some(1)))),
            ("[::1]", Some(("::1", None))),
            ("tls/board.local:7447", Some(("board.local", Some(7447)))),
            ("tcp://board:1", Some(("board", Some(1)))),
            ("pi@board", Some(("board", None))),
            ("192.0.2.10/24", Some(("192.0.2.10", None))),
            ("::1", None),
            ("192.0.2.10", None),
            ("board:http", None),
        ] {
            let found = parts(text);
            assert_eq!(found.as_ref().map(|(address, port)| (address.as_str(), *port)), meant, "{text}");
        }
    }
}
