//! Accounts: what the sending component counts, what arrives, and what the gateways count.

use super::hosts::{Hosts, LONG, number, numbered, until};

#[tokio::test]
async fn accounts_are_exact_while_the_subscriber_starts_again_and_again() {
    let hosts = Hosts::start().await;
    let mut sensor = hosts.board.open("sensor").await;
    let mut samples = sensor.publisher("samples").unwrap();
    let (mut sent, mut arrived) = (0, Vec::new());
    for run in 0..5 {
        let mut controller = hosts.ground.open("controller").await;
        let mut received = controller.subscriber("samples").unwrap();
        sensor.ready(LONG).await.unwrap();
        let goal = arrived.len() + 50 + run;
        while arrived.len() < goal {
            let message = numbered(sent);
            tokio::select! {
                result = samples.send(&message) => {
                    result.unwrap();
                    sent += 1;
                }
                message = received.recv() => arrived.push(number(&message.unwrap())),
            }
        }
        // With messages on their way.
        drop((received, controller));
        until("the controller is gone", || !samples.is_connected()).await;
    }
    let mut controller = hosts.ground.open("controller").await;
    let mut received = controller.subscriber("samples").unwrap();
    sensor.ready(LONG).await.unwrap();
    // What a gateway has taken while the controller was away counts as taken, and is in the gateway until it is
    // carried.
    let is_settled = || samples.peer_stats()[0].waiting == 0 && hosts.figures("samples").iter().all(|host| host.2 == 0);
    while !is_settled() {
        tokio::select! {
            message = received.recv() => arrived.push(number(&message.unwrap())),
            () = until("everything is accounted for", is_settled) => {}
        }
    }
    assert!(arrived.is_sorted() && arrived.windows(2).all(|pair| pair[0] != pair[1]), "in order, each at most once");
    let stats = samples.peer_stats().remove(0);
    assert_eq!((stats.published, stats.waiting), (u64::from(sent), 0));
    assert_eq!((stats.dropped_oldest, stats.dropped_newest), (0, 0));
    assert_eq!((stats.taken, stats.lost), (u64::from(sent), 0), "the gateway takes all that is on its way to it");
    let [board, ground] = hosts.figures("samples");
    // What the gateway took from the sensor, it has carried or given up.
    assert_eq!(board.0 + board.1, stats.taken, "board: {board:?}, {stats:?}");
    assert_eq!((board.2, ground.2), (0, 0), "nothing is held");
    // Of what was given up, some may have arrived; of what was carried, the controller's queue lost some with it.
    let missing = sent as usize - arrived.len();
    let explained = board.1 + 5 * 4;
    assert!(missing as u64 <= explained, "{missing} are missing, {explained} may be");
}
