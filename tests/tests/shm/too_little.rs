//! Too little shared memory: refused before the first message, with sizes, and never a SIGBUS.
//!
//! The small `/dev/shm` is mounted in a mount namespace of the programs, which needs root.

use super::stage::{IMAGE, Stage, share};
use crate::programs::IMAGES;
use scl_needs::needs;
use scl_tests::{Process, System};
use std::process::Command;

/// What always stays free.
const SPARE: usize = 2 << 20;

/// A namespace with a `/dev/shm` of its own, which lives as long as the program that made it.
struct SmallMemory {
    maker: Process,
}

impl SmallMemory {
    fn mount(mebibytes: u32) -> Self {
        let script = format!("mount -t tmpfs -o size={mebibytes}m small /dev/shm && echo mounted && read -r _end");
        let mut command = Command::new("unshare");
        command.args(["--mount", "sh", "-c", &script]);
        let mut maker = Process::spawn(command);
        maker.expect("mounted");
        Self { maker }
    }

    fn start(&self, system: &System, program: &str, arguments: &[&str]) -> Process {
        let namespace = format!("--mount=/proc/{}/ns/mnt", self.maker.id());
        system.start("nsenter", &[&[namespace.as_str(), program], arguments].concat())
    }

    fn run(&self, script: &str) {
        let namespace = format!("--mount=/proc/{}/ns/mnt", self.maker.id());
        let output = Command::new("nsenter").args([&namespace, "sh", "-c", script]).output().expect("nsenter");
        assert!(output.status.success(), "{script}: {output:?}");
    }
}

#[needs("the right to mount")]
#[test]
fn a_camera_is_refused_with_sizes() {
    let memory = SmallMemory::mount(32);
    let stage = Stage::new();
    let mut camera = memory.start(&stage.system, IMAGES, &["camera"]);
    let error = camera.next_line();
    assert!(error.starts_with("error: gate `camera.frames` cannot be opened"), "{error}");
    // 4 on their way, 12 kept, 1 to be copied, 6 lent; 4 MiB and a page for each.
    let needed = 23 * (IMAGE + 4096) + SPARE;
    let sizes = format!("{needed} bytes of shared memory are needed, and /dev/shm has 33");
    assert!(error.contains(&sizes), "{error}");
    assert!(error.contains("`max_size`") && error.contains("`queue`"), "{error}");
}

/// Memory that others take later: messages go through the socket, and nobody is killed by SIGBUS.
#[needs("the right to mount")]
#[test]
fn memory_that_runs_out_later_costs_speed_only() {
    let memory = SmallMemory::mount(256);
    let stage = Stage::new();
    let mut camera = memory.start(&stage.system, IMAGES, &["camera"]);
    camera.expect("open");
    let mut viewer = memory.start(&stage.system, IMAGES, &["viewer"]);
    viewer.expect("open");
    share(&mut camera);
    memory.run("head -c 1G /dev/zero > /dev/shm/others 2> /dev/null; test -s /dev/shm/others");
    for number in 0..8 {
        camera.ask(&format!("send {number} {} {IMAGE}", number + 1), "sent");
        viewer.tell("keep 1");
        viewer.next_line();
    }
    viewer.ask("kept", "0..8");
    viewer.ask("release", "released");
    memory.run("rm /dev/shm/others");
    share(&mut camera);
    stage.assert_good(&mut camera, &mut viewer, 10);
    let exits = [camera, viewer].map(Process::wait_for_exit);
    assert!(exits.iter().all(|exit| exit.status.success()), "{exits:?}");
}
