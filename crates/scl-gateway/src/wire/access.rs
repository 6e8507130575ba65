//! Access control: what each host may do, derived from the routes. Everything else is denied.
//!
//! A host is identified by the common name of its certificate. The same table serves both directions: what arrives from
//! a host is checked here, and what a host may not receive does not leave this host. Both are needed, because a host
//! that has just connected is sent everything until its declarations are known.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::keys;
use super::options::WireOptions;
use crate::route::{Pattern, Route};

/// The section `access_control` of the configuration. Without certificates hosts cannot be told apart, and only
/// loopback addresses are accepted, so there is nothing to check.
pub(super) fn access_control(options: &WireOptions) -> Value {
    if options.tls.is_none() {
        return json!({ "enabled": false, "default_permission": "allow" });
    }
    let (mut rules, mut subjects, mut policies) = (Vec::new(), Vec::new(), Vec::new());
    for peer in &options.peers {
        let mut names = Vec::new();
        let flows = [
            ("ingress", permissions(options, &peer.host, &options.host)),
            ("egress", permissions(options, &options.host, &peer.host)),
        ];
        for (flow, permissions) in flows {
            for (message, keys) in permissions {
                let name = format!("{} {flow} {message}", peer.host);
                rules.push(json!({
                    "id": name, "permission": "allow", "flows": [flow], "messages": [message], "key_exprs": keys,
                }));
                names.push(name);
            }
        }
        subjects.push(json!({ "id": peer.host, "cert_common_names": [peer.host], "link_protocols": ["tls"] }));
        policies.push(json!({ "id": peer.host, "rules": names, "subjects": [peer.host] }));
    }
    json!({
        "enabled": true, "default_permission": "deny",
        "rules": rules, "subjects": subjects, "policies": policies,
    })
}

/// Returns what `from` may do at `to`: for each kind of message, the keys.
fn permissions(options: &WireOptions, from: &str, to: &str) -> BTreeMap<&'static str, Vec<String>> {
    let system = &options.system;
    let mut permissions = Permissions::default();
    permissions.stream_keys(keys::mark(system, from, to), keys::mark(system, to, from));
    permissions.stream_keys(keys::echo(system, from, to), keys::echo(system, to, from));
    for route in &options.routes {
        let is_sender = (&*route.from.host, &*route.to.host) == (from, to);
        if is_sender || (&*route.from.host, &*route.to.host) == (to, from) {
            permissions.route(route, is_sender);
        }
    }
    // Allow tokens of any system, so that a gateway of another system can be detected and named.
    permissions.add("liveliness_token", format!("scl/*/@host/{from}/*"));
    // Allow any component, so that a host that claims another host's component can be detected and named.
    permissions.add("liveliness_token", format!("scl/{system}/@component/*/{from}/*/*"));
    permissions.add("declare_queryable", format!("scl/{system}/@component/*/{from}/*/*"));
    permissions.add("reply", format!("scl/{system}/@component/*/{from}/*/*"));
    permissions.add("query", format!("scl/{system}/@component/*/{to}/*/*"));
    permissions.add("liveliness_token", format!("scl/{system}/@refused/{to}/*/{from}"));
    for key in keys::tokens(system, from) {
        permissions.add("declare_liveliness_subscriber", key.clone());
        permissions.add("liveliness_query", key);
    }
    permissions.0
}

#[derive(Default)]
struct Permissions(BTreeMap<&'static str, Vec<String>>);

impl Permissions {
    fn add(&mut self, message: &'static str, key: String) {
        self.0.entry(message).or_default().push(key);
    }

    /// Allows sending on one key and subscribing to another.
    fn stream_keys(&mut self, sends: String, listens: String) {
        self.add("put", sends);
        self.add("declare_subscriber", listens);
    }

    fn route(&mut self, route: &Route, is_sender: bool) {
        let key = route.key.clone();
        let side = if is_sender { keys::Side::Sender } else { keys::Side::Receiver };
        // Allow any contract, so that a program that must be rebuilt is reported instead of being invisible.
        let token = format!("{}/*/{}/*/*", keys::without_contract(&key), side.word());
        self.add("liveliness_token", token);
        let mut streams = vec![(key.clone(), is_sender)];
        if route.pattern == Pattern::Requests {
            streams.push((keys::replies(&key), !is_sender));
        }
        for (key, sends) in streams {
            let acknowledgements = keys::acknowledgements(&key);
            match sends {
                true => self.stream_keys(key, acknowledgements),
                false => self.stream_keys(acknowledgements, key),
            }
        }
    }
}

#[cfg(test)]
mod tests;
