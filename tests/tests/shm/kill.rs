//! SIGKILL at any moment: nothing stays in shared memory, nothing hangs, the accounts add up, and a good client works.
//!
//! `SCL_TEST_KILLS` is the number of kills, which these tests share; 500 by default.

use super::stage::{Account, IMAGE, QUEUE, Stage, UNKNOWN, share};
use scl_tests::Process;
use scl_tests::fuzz::Generator;
use std::thread::park_timeout;
use std::time::Duration;

/// Of each of the four tests with kills at random moments, in the suite.
const KILLS: usize = 125;
/// Long enough for some messages in each queue, short enough for many rounds.
const LENGTH: usize = 256 << 10;

#[test]
fn a_viewer_is_killed_at_any_moment() {
    let stage = Stage::new();
    let mut camera = stage.open("camera");
    camera.tell(&format!("stream {LENGTH}"));
    let mut moments = Moments::new(1);
    for _ in 0..kills() {
        moments.kill(stage.start("viewer", "stream"));
    }
    camera.expect("flows");
    camera.ask("viewer gone", "viewer");
    let account = Account::of(&mut camera, "frames");
    assert!(account.published > 0 && account.waiting <= QUEUE, "{account:?}");
    let mut viewer = stage.open("viewer");
    share(&mut camera);
    // What waited comes first, and is not in the way.
    stage.assert_good_after(&mut camera, &mut viewer, 1 << 40);
    stage.end([camera, viewer]);
}

#[test]
fn a_camera_is_killed_at_any_moment() {
    let stage = Stage::new();
    let mut viewer = stage.open("viewer");
    viewer.tell("stream");
    let mut moments = Moments::new(2);
    for _ in 0..kills() {
        moments.kill(stage.start("camera", &format!("stream {LENGTH}")));
    }
    // The last one certainly sends something.
    let mut camera = stage.open("camera");
    share(&mut camera);
    camera.ask(&format!("send 0 1 {LENGTH}"), "sent");
    viewer.expect("flows");
    viewer.ask("ready", "ready");
    stage.assert_good_after(&mut camera, &mut viewer, 1 << 40);
    Account::assert_all_taken(&mut camera, "frames", 1 + QUEUE);
    stage.end([camera, viewer]);
}

#[test]
fn a_worker_is_killed_at_any_moment() {
    let stage = Stage::new();
    let mut camera = stage.open("camera");
    camera.tell(&format!("push_stream {LENGTH}"));
    let mut moments = Moments::new(3);
    for _ in 0..kills() {
        moments.kill(stage.start("worker", "stream"));
    }
    let mut worker = stage.open("worker");
    worker.tell("stream");
    worker.expect("flows");
    camera.expect("flows");
    let account = Account::of(&mut camera, "jobs");
    assert_eq!(account.dropped, 0, "{account:?}");
    assert!(account.lost <= UNKNOWN * kills() as u64, "{account:?}");
    stage.end([camera, worker]);
}

#[test]
fn a_camera_that_pushes_is_killed_at_any_moment() {
    let stage = Stage::new();
    let mut worker = stage.open("worker");
    worker.tell("stream");
    let mut moments = Moments::new(4);
    for _ in 0..kills() {
        moments.kill(stage.start("camera", &format!("push_stream {LENGTH}")));
    }
    let mut camera = stage.open("camera");
    camera.ask("worker", "worker");
    camera.tell(&format!("push 0 20 {LENGTH}"));
    camera.expect("pushed");
    worker.expect("flows");
    Account::assert_all_taken(&mut camera, "jobs", 20);
    stage.end([camera, worker]);
}

#[test]
fn a_program_that_is_killed_with_a_loan_or_views_leaves_nothing() {
    let stage = Stage::new();
    let (mut camera, mut viewer) = stage.camera_and_viewer();
    for round in 0..3 {
        camera.ask(&format!("hold {IMAGE}"), "holds 1");
        camera.kill();
        camera = stage.open("camera");
        share(&mut camera);
        stage.assert_good(&mut camera, &mut viewer, round * 10);

        camera.ask(&format!("lend 0 {QUEUE} {IMAGE}"), "4 shared");
        viewer.ask("keep 2", "2 of 2 shared");
        viewer.kill();
        camera.ask("viewer gone", "viewer");
        let account = Account::of(&mut camera, "frames");
        assert_eq!(account.published, 2 * QUEUE, "{account:?}");
        viewer = stage.open("viewer");
        share(&mut camera);
        stage.assert_good_after(&mut camera, &mut viewer, 1000);
    }
    stage.end([camera, viewer]);
}

/// Nobody is left to clean up: the next program does.
#[test]
fn what_two_killed_programs_leave_is_removed_by_the_next() {
    let stage = Stage::new();
    for _ in 0..3 {
        let (mut camera, mut viewer) = stage.camera_and_viewer();
        camera.ask(&format!("lend 0 {QUEUE} {IMAGE}"), "4 shared");
        viewer.ask("keep 2", "2 of 2 shared");
        camera.kill();
        viewer.kill();
        assert!(!stage.system.shared_files("images").is_empty(), "nothing is left, so nothing is tested");
    }
    let (mut camera, mut viewer) = stage.camera_and_viewer();
    stage.assert_good(&mut camera, &mut viewer, 0);
    stage.end([camera, viewer]);
}

/// Kills programs at moments from before they are open to well after messages flow.
struct Moments(Generator);

impl Moments {
    fn new(seed: u64) -> Self {
        Self(Generator::new(seed))
    }

    fn kill(&mut self, mut program: Process) {
        // Half of the kills come while messages flow, the others from the start on.
        if self.0.below(2) == 0 {
            program.expect_containing("flows");
        }
        park_timeout(Duration::from_micros(self.0.below(20_000) as u64));
        program.kill();
    }
}

fn kills() -> usize {
    let Ok(all) = std::env::var("SCL_TEST_KILLS") else { return KILLS };
    let all: usize = all.parse().expect("SCL_TEST_KILLS is a number");
    println!("{} kills of {all}", all.div_ceil(4));
    all.div_ceil(4)
}
