//! Programs that know nothing of shared memory beside others on the same gate: they get the same messages.

use super::stage::{IMAGE, QUEUE, Stage, share};
use crate::programs::IMAGES;
use scl_tests::{Compile, Process, RawPeer, System, wait_until};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const ENDPOINT: &str = "camera.frames--viewer.frames.";

/// Plain ZeroMQ beside the viewer, on the same connection.
#[test]
fn plain_subscribers_get_the_frames_through_the_socket() {
    let stage = Stage::new();
    let (mut camera, mut viewer) = stage.camera_and_viewer();
    let address = stage.system.address("images", ENDPOINT);
    let mut raw = RawPeer::join(&address, "SUB");
    raw.send(&scl_tests::zmtp::subscribe(b"")).expect("subscribed");
    reaches(&mut camera, 2);
    for number in 0..8 {
        let length = if number % 2 == 0 { IMAGE } else { 100 };
        camera.tell(&format!("lend {number} {} {length}", number + 1));
        camera.next_line();
        let shared = u64::from(length == IMAGE);
        viewer.tell(&format!("receive_up_to {number}"));
        viewer.expect_containing(&format!("..{}, {shared} shared", number + 1));
        let frame = next(&mut raw);
        assert_eq!((frame.len(), &frame[..8]), (length, &(number as u64).to_le_bytes()[..]), "{number}");
    }
    stage.end([camera, viewer]);
}

/// A program in C whose library was built without shared memory.
#[test]
fn a_program_built_without_shared_memory_is_served_as_before() {
    let stage = Stage::new();
    let plain = Plain::build();
    let mut camera = stage.open("camera");
    // What the listening end reads counts, so that the same launch file serves both.
    let mut viewer = plain.start(&stage.system, "viewer", "ipc,camera.frames=shm");
    viewer.expect("open");
    reaches(&mut camera, 1);
    for number in 0..8 {
        camera.tell(&format!("lend {number} {} {IMAGE}", number + 1));
        camera.next_line();
        viewer.expect_containing(&format!("{number} {IMAGE}"));
    }
    // The next one can.
    viewer.kill();
    let mut viewer = stage.open("viewer");
    share(&mut camera);
    stage.assert_good(&mut camera, &mut viewer, 10);
    stage.end([camera, viewer]);
}

/// The promise: who would have to offer shared memory and cannot, says what to do.
#[test]
fn a_program_built_without_shared_memory_cannot_offer_it() {
    let system = System::new();
    let plain = Plain::build();
    for choice in ["shm", "ipc,camera.frames=shm", "ipc,viewer.frames=shm"] {
        let mut camera = plain.start(&system, "camera", choice);
        let error = camera.next_line();
        let expected = "component `camera` cannot use the transport `shm`: enable the feature `shm` of the crate `scl`, or \
                        choose the transport `ipc`";
        assert!(error.contains(expected), "{choice}: {error}");
    }
    let mut camera = plain.start(&system, "camera", "ipc,other.frames=shm");
    camera.expect("open");
}

/// The number of the frames that are sent until everybody has subscribed.
const EARLY: u64 = 1000;

/// Sends short frames until one reaches so many programs.
#[track_caller]
fn reaches(camera: &mut Process, programs: u64) {
    wait_until("all programs have subscribed", || {
        camera.tell(&format!("reach {EARLY}"));
        camera.next_line() == programs.to_string()
    });
}

/// The next frame after those.
#[track_caller]
fn next(raw: &mut RawPeer) -> Vec<u8> {
    loop {
        let frame = raw.message().expect("a message").remove(0);
        if frame[..8] != EARLY.to_le_bytes() {
            return frame;
        }
    }
}

/// `images.c`, and the plan that it opens.
struct Plain {
    _folder: TempDir,
    program: PathBuf,
    plan: PathBuf,
}

impl Plain {
    fn build() -> Self {
        let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
        let folder = TempDir::with_prefix("scl").expect("a folder");
        let (program, plan) = (folder.path().join("images"), folder.path().join("plan.json"));
        Compile::c(tests.join("tests/shm/images.c")).without_shm().program(&program);
        let loaded = scl_loader::load(&scl_loader::Request::new(tests.join("topologies/images.yaml")));
        std::fs::write(&plan, loaded.system_plan().expect("a sound topology").to_json()).expect("the plan");
        Self { _folder: folder, program, plan }
    }

    fn start(&self, system: &System, component: &str, transport: &str) -> Process {
        let text = |path: &Path| path.to_str().expect("a path in UTF-8").to_owned();
        system.start_with(&text(&self.program), &[&text(&self.plan), component], &[("SCL_TRANSPORT", transport)])
    }
}

/// The feature changes nothing for programs that do not use it.
#[test]
fn a_queue_of_frames_for_a_late_plain_program_is_sent_inline() {
    let stage = Stage::new();
    let mut camera = stage.system.start(IMAGES, &["camera"]);
    camera.expect("open");
    camera.ask(&format!("send 0 {QUEUE} {IMAGE}"), "sent");
    let plain = Plain::build();
    let mut viewer = plain.start(&stage.system, "viewer", "ipc");
    viewer.expect("open");
    for number in 0..QUEUE {
        viewer.expect(&format!("{number} {IMAGE}"));
    }
}
