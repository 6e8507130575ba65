//! `scl run --host` on both hosts of `examples/hosts`, as its README has it, on ports and with certificates of their
//! own.

use rustix::process::Signal;
use scl_tests::Process;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The programs of the quick start and `scl`, which the workspace has built beside the gateway.
fn program(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_BIN_EXE_scl-gateway")).with_file_name(name);
    assert!(path.is_file(), "`{}` is missing; run `cargo build -p scl-cli -p quickstart` first", path.display());
    path
}

/// A copy of the example.
struct Example {
    folder: tempfile::TempDir,
}

impl Example {
    fn copied() -> Self {
        let repository = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
        let text = std::fs::read_to_string(repository.join("examples/hosts/launch.yaml")).unwrap();
        let quickstart = repository.join("examples/quickstart");
        let ports = [(); 2].map(|()| scl_tests::free_address().port().to_string());
        let mut text = text.replace("../quickstart", quickstart.to_str().unwrap());
        text = text.replace("7447", &ports[0]).replace("7448", &ports[1]).replace("../../target/examples/hosts/", "");
        text = text.replace("build: &quickstart cargo build -p quickstart, ", "").replace("build: *quickstart, ", "");
        for name in ["sensor", "controller", "actuator", "user_interface"] {
            let command = format!("cargo, run, --quiet, -p, quickstart, --bin, {name}");
            assert!(text.contains(&command), "{text}");
            text = text.replace(&command, program(name).to_str().unwrap());
        }
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("launch.yaml"), text).unwrap();
        Self { folder }
    }

    fn scl(&self, host: &str, arguments: &[&str]) -> Command {
        let mut command = Command::new(program("scl"));
        command.args(arguments).current_dir(self.folder.path()).stdin(Stdio::null());
        command.env("SCL_RUNTIME_DIR", self.folder.path().join(host));
        command.env("XDG_STATE_HOME", self.folder.path().join("state"));
        command
    }

    fn run(&self, host: &str) -> Process {
        Process::spawn(self.scl(host, &["run", "--host", host]))
    }
}

/// Stops `scl run` in order.
fn stop(run: Process) {
    run.signal(Signal::TERM);
    let exit = run.wait_for_exit();
    assert_eq!(exit.code(), 0, "{exit:?}");
}

#[test]
fn the_quick_start_runs_on_two_hosts() {
    let example = Example::copied();
    let keys = example.scl("board", &["gateway", "keys"]).output().unwrap();
    assert!(keys.status.success(), "{}", String::from_utf8_lossy(&keys.stderr));
    let (mut board, mut ground) = (example.run("board"), example.run("ground"));
    // A request, its reply, and a message back.
    ground.expect_containing("user_interface | asked for 0.5 m/s: accepted");
    ground.expect_containing("user_interface | event: target is now 0.5 m/s");
    stop(ground);
    board.expect_containing("sensor     | speed ");
    let mut ground = example.run("ground");
    ground.expect_containing("user_interface | asked for ");
    ground.expect_containing("user_interface | event: ");
    stop(ground);
    stop(board);
}

/// The example as it is in the repository can be used.
#[test]
fn the_launch_file_of_the_example_is_valid() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let system = scl_gateway::deployment::System::load(&repository.join("examples/hosts"), None).unwrap();
    let hosts: Vec<&str> = system.deployment.hosts.iter().map(|host| host.name.as_str()).collect();
    assert_eq!(hosts, ["board", "ground"]);
}
