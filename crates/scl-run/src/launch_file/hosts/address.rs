//! `address`: where the gateway of a host listens, and where the others find it.

use super::super::reader::{Keys, Reader, wrong};
use super::super::rules::{HOSTS, MISSING, WRONG_VALUE};
use super::super::value::{shown, text};
use scl_topology::parse::Field;
use scl_topology::source::Span;
use std::net::{IpAddr, SocketAddr};

/// The longest DNS name.
const LONGEST: usize = 253;

impl Reader<'_> {
    pub(super) fn read_address(&mut self, host: Field<'_>, keys: &Keys<'_, '_>) -> Option<(String, Span)> {
        let Some(field) = keys.get("address") else {
            if !keys.may_have("address") {
                let problem = MISSING.at(format!("host `{}` has no `address`", host.key), host.key_span, "");
                self.report(problem.help("write `address: 192.0.2.10`, as the other hosts reach it"));
            }
            return None;
        };
        let text = text(field.value).unwrap_or_default();
        if let Some(meant) = with_port(text) {
            let message = format!("`address` is an address alone, not {}", shown(field.value));
            self.report(wrong(&WRONG_VALUE, message, field).help(format!("write `{meant}`")));
            return None;
        }
        if text.parse().is_ok_and(|address: IpAddr| address.is_unspecified()) {
            let problem = wrong(&HOSTS, format!("the other hosts cannot connect to `{text}`"), field);
            self.report(problem.help("write the address of one of the host's network interfaces"));
            return None;
        }
        if !is_address(text) {
            self.wrong_value(field);
            return None;
        }
        Some((text.to_owned(), field.value.span))
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

/// Returns the keys to write in place of an address with a port, such as `192.0.2.10:7447` or `tcp/192.0.2.10:7447`.
fn with_port(text: &str) -> Option<String> {
    let text = text.rsplit(['/', '@']).next()?;
    let parts = match text.parse::<SocketAddr>() {
        Ok(address) => (address.ip().to_string(), address.port()),
        Err(_) => {
            let (name, port) = text.split_once(':').filter(|(name, _)| is_dns_name(name))?;
            (name.to_owned(), port.parse().ok()?)
        }
    };
    Some(format!("address: {}, port: {}", parts.0, parts.1))
}

#[cfg(test)]
mod tests {
    use super::{is_address, with_port};

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
            ("192.0.2.10:7447", Some("address: 192.0.2.10, port: 7447")),
            ("[::1]:1", Some("address: ::1, port: 1")),
            ("tls/board.local:7447", Some("address: board.local, port: 7447")),
            ("::1", None),
            ("192.0.2.10", None),
            ("board:http", None),
        ] {
            assert_eq!(with_port(text).as_deref(), meant, "{text}");
        }
    }
}
