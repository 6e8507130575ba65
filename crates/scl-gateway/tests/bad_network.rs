//! A network that loses, delays and reorders, and one that is slower than what is sent.

use crate::accounts::{CONNECTIONS, READINGS};
use crate::cable::Shape;
use crate::control_loop::Reference;
use crate::fleet::Fleet;
use crate::long::short_or_long;
use std::thread::sleep;
use std::time::Duration;

/// 100 ms there and back. The jitter reorders.
const FAR: Shape = Shape { loss: 0.0, delay: 45.0, jitter: 10.0, rate: 0.0 };

#[test]
fn one_percent_of_loss_over_a_long_way() {
    check(Shape { loss: 0.01, ..FAR });
}

#[test]
fn ten_percent_of_loss_over_a_long_way() {
    check(Shape { loss: 0.1, ..FAR });
}

/// Less than a tenth of what is sent.
#[test]
fn a_network_slower_than_the_data() {
    let mut fleet = check(Shape { rate: 250e3, ..Shape::PERFECT });
    let account = fleet.account(READINGS);
    assert!(account.dropped > 0, "the network kept up: {account:?}");
}

fn check(shape: Shape) -> Fleet {
    let mut fleet = Fleet::start();
    fleet.send_all();
    fleet.player("sink").answer_to_next("lossless");
    let reference = Reference::start(&mut fleet);
    fleet.network.cable.shape(0, shape);
    sleep(Duration::from_secs(short_or_long(5, 30)));
    let answer = fleet.player("source").counts("question", "call 3 10000");
    println!("{shape:?}: {answer:?}");
    assert_eq!(answer.get("wrong"), 0);
    let _longest_call = reference.compare(&mut fleet, &format!("{shape:?}"));
    for connection in CONNECTIONS {
        println!("{shape:?}, {connection:?}: {:?}", fleet.account(connection));
    }
    let (_, lost) = fleet.network.cable.counts(0);
    assert!(lost > 0, "the network was not bad enough");
    fleet.network.cable.shape(0, Shape::PERFECT);
    fleet.stop_all();
    fleet.exact_accounts();
    fleet.still_works();
    fleet
}
