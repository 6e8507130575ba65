//! Hosts that share this machine. Each has a runtime folder and a gateway; the gateways are connected over loopback
//! without encryption.

use crate::worker::Worker;
use crate::zenoh_peer::free_port;
use std::env;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The program that runs a gateway; it is a separate package.
const PROGRAM: &str = "scl-gateway";

/// A host: its name, and the components that run there.
pub(crate) struct Host<'a> {
    pub(crate) name: &'a str,
    pub(crate) components: Vec<String>,
}

/// Writes the files of a system into `folder` and starts the gateway of each host.
pub(crate) fn start_gateways(folder: &Path, topology: &str, hosts: &[Host<'_>]) -> scl::Result<Vec<Worker>> {
    fs::create_dir_all(folder)?;
    fs::write(folder.join("topology.yaml"), topology)?;
    fs::write(folder.join("launch.yaml"), launch_file(hosts)?)?;
    let program = find_program()?;
    let mut gateways = Vec::new();
    for host in hosts {
        let runtime_dir = runtime_dir(folder, host.name);
        fs::create_dir_all(&runtime_dir)?;
        let mut command = Command::new(&program);
        command.args(["run", "--topology", "topology.yaml", "--launch", "launch.yaml", "--host", host.name]);
        command.current_dir(folder).env("SCL_RUNTIME_DIR", &runtime_dir).env_remove("SCL_SYSTEM");
        // The gateways are ended one after another; hide the warnings of those that are still running.
        command.env("SCL_LOG", "error");
        gateways.push(Worker::spawn(command)?);
    }
    Ok(gateways)
}

/// The runtime folder of a host.
pub(crate) fn runtime_dir(folder: &Path, host: &str) -> PathBuf {
    folder.join(host)
}

/// Finds `scl-gateway` beside this program, or in `PATH`.
fn find_program() -> scl::Result<PathBuf> {
    let beside = env::current_exe()?.with_file_name(PROGRAM);
    let path = env::var_os("PATH").unwrap_or_default();
    let found = std::iter::once(beside).chain(env::split_paths(&path).map(|folder| folder.join(PROGRAM)));
    found.into_iter().find(|file| file.is_file()).ok_or_else(|| {
        scl::Error::message(format!(
            "`{PROGRAM}` is neither beside `scl` nor in `PATH`; build it with `cargo build --release -p {PROGRAM}`"
        ))
    })
}

/// Returns the text of a launch file. `scl run` never starts its components, so their commands do nothing.
fn launch_file(hosts: &[Host<'_>]) -> scl::Result<String> {
    let mut text = "topology: topology.yaml\nhosts:\n".to_owned();
    for Host { name, components } in hosts {
        let (port, components) = (free_port()?, components.join(", "));
        writeln!(text, "  {name}: {{address: 127.0.0.1, port: {port}, components: [{components}]}}")?;
    }
    // The key `gateway` is required although each host sets its own port. Loopback needs no certificates.
    text.push_str("gateway: {}\ncomponents:\n");
    for component in hosts.iter().flat_map(|host| &host.components) {
        writeln!(text, "  {component}: {{command: ['true']}}")?;
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_launch_file_has_every_host_and_component() {
        let host =
            |name, components: &[&str]| Host { name, components: components.iter().map(|&c| c.into()).collect() };
        let text = launch_file(&[host("left", &["a", "b"]), host("right", &["c"])]).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[2].starts_with("  left: {address: 127.0.0.1, port: "), "{text}");
        assert!(lines[2].ends_with(", components: [a, b]}"), "{text}");
        assert_eq!(
            lines[4..],
            [
                "gateway: {}",
                "components:",
                "  a: {command: ['true']}",
                "  b: {command: ['true']}",
                "  c: {command: ['true']}"
            ]
        );
    }
}
