//! The same system without a gateway: what the others are compared with, and a test of what tests them.

use crate::accounts::{CONTROL, LOSSLESS};
use crate::fleet::Fleet;

pub(crate) fn check() {
    let mut fleet = Fleet::on_one_host();
    fleet.still_works();
    fleet.send_all();
    fleet.player("sink").wait_for("lossless", "report", |counts| counts.get("count") >= 300);
    println!("control loop: {}", fleet.player("source").ask("control", "pace"));
    fleet.stop_all();
    fleet.exact_accounts();

    // A queue of one yields the newest, of many only what fits, and nothing is lost where a sender waits.
    for gate in ["control", "readings", "newest_kept", "lossless"] {
        assert_eq!(fleet.player("sink").ask(gate, "hold"), "holds");
    }
    for gate in ["control", "lossless"] {
        fleet.player("source").ask(gate, "send 200 0 100");
    }
    fleet.player("source").wait_for("control", "left", |counts| counts.get("left") == 0);
    for gate in ["control", "readings", "newest_kept", "lossless"] {
        fleet.player("sink").ask(gate, "release");
    }
    let newest = fleet.exact_account(CONTROL).published;
    assert_eq!(fleet.player("sink").counts("control", "report").get("newest"), newest);
    fleet.player("source").wait_for("lossless", "left", |counts| counts.get("left") == 0);
    assert_eq!(fleet.exact_account(LOSSLESS).dropped, 0);
}

#[test]
fn a_component_that_was_killed_is_found_again() {
    let mut fleet = Fleet::on_one_host();
    fleet.still_works();
    fleet.send_all();
    fleet.player("sink").answer_to_next("lossless");
    fleet.kill("sink");
    fleet.play("sink");
    fleet.player("sink").answer_to_next("lossless");
    fleet.stop_all();
    for connection in crate::accounts::CONNECTIONS {
        // Of the new `sink`, which has got less than the two together.
        let account = fleet.account(connection);
        assert!(account.received <= account.published - account.dropped, "{connection:?}: {account:?}");
    }
    fleet.still_works();
}
