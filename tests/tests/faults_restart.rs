//! Many restarts of each side, every order of starting, and two programs for one component.

use scl_tests::{Place, Process};

const PEER: &str = env!("CARGO_BIN_EXE_peer");
const LISTING1: &str = env!("CARGO_BIN_EXE_listing1");
const RESTARTS: u64 = 100;

fn open(place: &Place, component: &str) -> Process {
    let mut process = place.start(PEER, &[component]);
    process.says("open");
    process
}

fn exchange(source: &mut Process, sink: &mut Process, round: u64) {
    let (from, to) = (round * 10, round * 10 + 10);
    source.does(&format!("publish {from} {to}"), "published");
    sink.tell(&format!("receive_up_to {}", to - 1));
    let received = sink.line();
    assert!(received.ends_with(&format!("..{to}")), "{received}");
    source.does(&format!("push {from} {to}"), "pushed");
    sink.does("pull 10", &format!("{from}..{to}"));
    sink.tell("serve 1");
    source.does(&format!("call {round}"), &(2 * round).to_string());
    sink.says("served");
}

#[test]
fn the_connecting_and_listening_sides_survive_restarts_of_the_sink() {
    let place = Place::new("ipc");
    let mut source = open(&place, "source");
    for round in 0..RESTARTS {
        let mut sink = open(&place, "sink");
        exchange(&mut source, &mut sink, round);
        sink.kill();
        // What is sent before the source has seen that is on its way to the dead one, and lost with it.
        source.does("alone", "alone");
    }
    let mut sink = open(&place, "sink");
    exchange(&mut source, &mut sink, RESTARTS);
}

#[test]
fn the_connecting_and_listening_sides_survive_restarts_of_the_source() {
    let place = Place::new("ipc");
    let mut sink = open(&place, "sink");
    let mut descriptors = Vec::new();
    for round in 0..RESTARTS {
        let mut source = open(&place, "source");
        exchange(&mut source, &mut sink, round);
        descriptors.push(sink.descriptors());
        source.kill();
    }
    let (first, last) = (descriptors[1], descriptors[descriptors.len() - 1]);
    assert!(last <= first + 8, "descriptors are left open by each restart: {descriptors:?}");
}

#[test]
fn four_programs_talk_whatever_starts_first() {
    let names = ["sensor", "actuator", "controller", "user_interface"];
    for order in orders() {
        let place = Place::new("ipc");
        let mut started: Vec<(usize, Process)> =
            order.iter().map(|&index| (index, place.start(LISTING1, &[names[index]]))).collect();
        started.sort_by_key(|(index, _)| *index);
        started[0].1.says("sent");
        started[1].1.says("set to b\"measured\"");
        started[3].1.says("status b\"done\", event b\"faster\"");
    }
}

/// All 24 orders of four.
fn orders() -> Vec<[usize; 4]> {
    let all = (0..256).map(|code| [code / 64, code / 16 % 4, code / 4 % 4, code % 4]);
    let orders: Vec<[usize; 4]> = all.filter(|order| (0..4).all(|index| order.contains(&index))).collect();
    assert_eq!(orders.len(), 24);
    orders
}

#[test]
fn of_two_programs_for_one_component_exactly_one_plays_it() {
    for _ in 0..10 {
        let place = Place::new("ipc");
        let mut both = [place.start(PEER, &["sink"]), place.start(PEER, &["sink"])];
        let said = both.each_mut().map(Process::line);
        let won: Vec<bool> = said.iter().map(|line| line == "open").collect();
        assert_eq!(won.iter().filter(|&&won| won).count(), 1, "{said:?}");
        let (winner, loser) = if won[0] { (0, 1) } else { (1, 0) };
        assert!(said[loser].contains("component `sink` cannot be opened"), "{said:?}");
        let number = both[winner].id().to_string();
        assert!(said[loser].contains(&number), "the loser names the winner {number}: {said:?}");
    }
}
