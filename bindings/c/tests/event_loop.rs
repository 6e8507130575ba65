//! A C program with an event loop.

use crate::programs::{expect_success, on_each_build};
use rustix::process::Signal;

/// The promise: `scl_fd` is readable when there is something to do, and at a stop request.
#[test]
fn epoll_reports_messages_requests_and_stop_requests() {
    on_each_build(|program| {
        let mut c = program.start("event_loop", &[]);
        c.expect("waiting");
        let mut peer = program.peer();
        let (mut values, mut work) = (peer.publisher("values").unwrap(), peer.pusher("work").unwrap());
        let mut answer = peer.requester("answer").unwrap();
        for round in 0..3 {
            values.send_blocking(&round.to_string().into()).unwrap();
            c.expect(&format!("value {round}"));
            work.send_blocking(&round.to_string().into()).unwrap();
            c.expect(&format!("job {round}"));
            assert_eq!(answer.call_blocking(&round.to_string().into()).unwrap(), round.to_string());
            c.expect(&format!("request {round}"));
        }
        c.signal(Signal::TERM);
        c.expect("stopped");
        expect_success(c);
    });
}
