//! Names on the network.
//!
//! No wildcard matches a chunk that begins with `@`, so the keys that belong to one route do not interfere with each
//! other.

/// Which end of a route.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Side {
    Sender,
    Receiver,
}

impl Side {
    pub(super) fn word(self) -> &'static str {
        match self {
            Side::Sender => "sender",
            Side::Receiver => "receiver",
        }
    }
}

/// Liveliness token of an open end of the route `key`.
pub(super) fn end_token(key: &str, side: Side, instance: &str, id: u64) -> String {
    format!("{key}/{}/{instance}/{id:x}", side.word())
}

/// Key on which the replies of a route of requests are sent.
pub(super) fn replies(key: &str) -> String {
    format!("{key}/@replies")
}

/// Key on which a stream's acknowledgements are sent.
pub(super) fn acknowledgements(key: &str) -> String {
    format!("{key}/@ack")
}

/// A route's key without its contract.
pub(super) fn without_contract(key: &str) -> &str {
    key.rsplit_once('/').map_or(key, |(prefix, _)| prefix)
}

/// Liveliness token of a gateway.
pub(super) fn host_token(system: &str, host: &str, instance: &str) -> String {
    format!("scl/{system}/@host/{host}/{instance}")
}

/// Liveliness token of a running component, and the key at which its announcement is queried.
pub(super) fn component(system: &str, component: &str, host: &str, instance: &str, id: u64) -> String {
    format!("scl/{system}/@component/{component}/{host}/{instance}/{id:x}")
}

/// Liveliness token by which the gateway of `by` tells another one that it is refused.
pub(super) fn refused(system: &str, host: &str, instance: &str, by: &str) -> String {
    format!("scl/{system}/@refused/{host}/{instance}/{by}")
}

/// Key on which one host sends marks to another. The other one echoes them on the key of `echo`.
pub(super) fn mark(system: &str, from: &str, to: &str) -> String {
    format!("scl/{system}/@mark/{from}/{to}")
}

pub(super) fn echo(system: &str, from: &str, to: &str) -> String {
    format!("scl/{system}/@echo/{from}/{to}")
}

/// Keys to subscribe to for all tokens: routes, gateways of any system, components, refusals.
pub(super) fn tokens(system: &str, host: &str) -> [String; 4] {
    [
        format!("scl/{system}/**"),
        "scl/*/@host/*/*".to_owned(),
        format!("scl/{system}/@component/*/*/*/*"),
        format!("scl/{system}/@refused/{host}/*/*"),
    ]
}

/// A token that another gateway declared.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Token<'a> {
    End { key: &'a str, side: Side, instance: &'a str, id: u64 },
    Host { system: &'a str, host: &'a str, instance: &'a str },
    Component { component: &'a str, host: &'a str, instance: &'a str },
    Refused { instance: &'a str, by: &'a str },
}

impl<'a> Token<'a> {
    pub(super) fn parse(token: &'a str) -> Option<Token<'a>> {
        let chunks: Vec<&str> = token.split('/').collect();
        Some(match chunks[..] {
            ["scl", system, "@host", host, instance] => Token::Host { system, host, instance },
            ["scl", _, "@component", component, host, instance, _] => Token::Component { component, host, instance },
            ["scl", _, "@refused", _, instance, by] => Token::Refused { instance, by },
            ["scl", _, _, _, _, _, _, side, instance, id] => {
                let side = [Side::Sender, Side::Receiver].into_iter().find(|known| known.word() == side)?;
                let length = token.len() - side.word().len() - instance.len() - id.len() - 3;
                Token::End { key: &token[..length], side, instance, id: u64::from_str_radix(id, 16).ok()? }
            }
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_are_read_as_they_are_written() {
        let key = "scl/vehicle/imu/pose/filter/pose/0123abcd";
        let token = end_token(key, Side::Receiver, "12-ff", 0xbeef);
        let end = Token::End { key, side: Side::Receiver, instance: "12-ff", id: 0xbeef };
        assert_eq!(Token::parse(&token), Some(end));
        assert_eq!(without_contract(key), "scl/vehicle/imu/pose/filter/pose");
        let host = Token::Host { system: "vehicle", host: "board", instance: "12-ff" };
        assert_eq!(Token::parse(&host_token("vehicle", "board", "12-ff")), Some(host));
        let component_token = Token::Component { component: "imu", host: "board", instance: "12-ff" };
        assert_eq!(Token::parse(&component("vehicle", "imu", "board", "12-ff", 7)), Some(component_token));
        let refusal = Token::Refused { instance: "12-ff", by: "ground" };
        assert_eq!(Token::parse(&refused("vehicle", "board", "12-ff", "ground")), Some(refusal));
    }

    #[test]
    fn anything_else_is_no_token() {
        let key = "scl/vehicle/imu/pose/filter/pose/0123abcd";
        for token in ["", "scl", key, &format!("{key}/middle/1/2"), &format!("{key}/sender/1/xyz"), "scl/a/@host/b"] {
            assert_eq!(Token::parse(token), None, "{token}");
        }
    }
}
