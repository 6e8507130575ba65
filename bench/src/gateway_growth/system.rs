//! A system with a number of connections between one host and some others.
//!
//! The first connection carries requests and replies, so that a round trip takes one connection. All others carry
//! published messages from the near host to the far hosts in turn.

use crate::gateway::Host;
use scl::plan::SystemPlan;
use std::fmt::Write;
use std::path::Path;

/// The host whose gateway is observed.
pub(super) const NEAR: &str = "near";

/// Components of the near host, among which its gates are divided.
const NEAR_COMPONENTS: usize = 10;

/// The gate of the first connection.
pub(super) const REQUEST: &str = "request";

/// The component of the near host that sends the requests.
pub(super) const ASKING: &str = "near0";

/// The topology file of a system with `connections` connections between the near host and `far_hosts` others.
pub(super) fn topology(connections: usize, far_hosts: usize) -> scl::Result<String> {
    let codec = "codec: \"scl::codec::Opaque\"";
    let mut text = "system: growth\ncomponents:\n".to_owned();
    let published = || 1..connections;
    for near in near_components(connections) {
        writeln!(text, "  - name: near{near}\n    gates:")?;
        if near == 0 {
            writeln!(text, "      - {REQUEST}: {{req: scl.bytes.Bytes -> scl.bytes.Bytes, {codec}, timeout: 10s}}")?;
        }
        for number in published().filter(|number| number % NEAR_COMPONENTS == near) {
            writeln!(text, "      - out{number}: {{pub: scl.bytes.Bytes, {codec}}}")?;
        }
    }
    for far in used_far_hosts(connections, far_hosts) {
        writeln!(text, "  - name: far{far}\n    gates:")?;
        if far == 0 {
            writeln!(text, "      - {REQUEST}: {{rep: scl.bytes.Bytes -> scl.bytes.Bytes, {codec}}}")?;
        }
        for number in published().filter(|number| number % far_hosts == far) {
            writeln!(text, "      - in{number}: {{sub: scl.bytes.Bytes, {codec}}}")?;
        }
    }
    writeln!(text, "connections:\n  - [near0.{REQUEST}, far0.{REQUEST}]")?;
    for number in published() {
        writeln!(text, "  - [near{}.out{number}, far{}.in{number}]", number % NEAR_COMPONENTS, number % far_hosts)?;
    }
    Ok(text)
}

/// The hosts and their components.
pub(super) fn hosts(connections: usize, far_names: &[String]) -> Vec<Host<'_>> {
    let near = near_components(connections).map(|near| format!("near{near}")).collect();
    let far = |(far, name)| Host { name, components: vec![format!("far{far}")] };
    let far_hosts = used_far_hosts(connections, far_names.len()).zip(far_names.iter().map(String::as_str)).map(far);
    std::iter::once(Host { name: NEAR, components: near }).chain(far_hosts).collect()
}

/// The plans of the topology file in `folder`.
pub(super) fn plan(folder: &Path) -> scl::Result<SystemPlan> {
    let loaded = scl_loader::load(&scl_loader::Request::new(folder.join("topology.yaml")));
    let rejected = || scl::Error::message(format!("the topology is rejected: {:?}", loaded.diagnostics));
    loaded.system_plan().ok_or_else(rejected)
}

/// Returns the numbers of the near host's components, leaving out those without a gate.
fn near_components(connections: usize) -> impl Iterator<Item = usize> {
    0..connections.min(NEAR_COMPONENTS)
}

/// Returns the numbers of the far hosts, leaving out those without a connection.
fn used_far_hosts(connections: usize, far_hosts: usize) -> impl Iterator<Item = usize> {
    0..connections.min(far_hosts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn systems_have_the_connections_and_no_errors() {
        for (connections, far_hosts) in [(1, 1), (1, 3), (2, 1), (12, 3), (500, 2)] {
            let folder = tempfile::tempdir().unwrap();
            std::fs::write(folder.path().join("topology.yaml"), topology(connections, far_hosts).unwrap()).unwrap();
            let plan = plan(folder.path()).unwrap();
            let sources = plan.components.iter().flat_map(|it| &it.gates).filter(|gate| gate.kind.is_source());
            assert_eq!(sources.map(|gate| gate.connections.len()).sum::<usize>(), connections);
            let names: Vec<String> = (0..far_hosts).map(|far| format!("far{far}")).collect();
            let hosts = hosts(connections, &names);
            let placed: Vec<&String> = hosts.iter().flat_map(|host| &host.components).collect();
            let planned: Vec<&String> = plan.components.iter().map(|it| &it.component).collect();
            assert_eq!(placed, planned, "{connections} over {far_hosts}");
        }
    }
}
