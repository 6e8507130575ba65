//! Both sides with all their gates busy at once, until the next command.

use super::{Sink, Source, message};
use scl_tests::{Commands, say, say_error};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::time::Duration;

/// The values of a source, so that receivers can tell one source from its successor.
const VALUES: u64 = 1 << 32;

/// Sends rising values through every gate, in messages that carry this many bytes besides. `values` of the source with
/// a number have been used.
pub(super) async fn send(source: &mut Source, commands: &mut Commands, number: u64, values: &mut u64, padding: u64) {
    let next = Cell::new(number * VALUES + *values);
    let message = || message(next.replace(next.get() + 1), padding);
    let Source { readings, lossless, jobs, question, .. } = source;
    let publish = async {
        loop {
            readings.send(&message()).await?;
            // More would only be dropped.
            tokio::time::sleep(Duration::from_micros(100)).await;
        }
    };
    let publish_lossless = async {
        loop {
            lossless.send(&message()).await?;
        }
    };
    let push = async {
        loop {
            jobs.send(&message()).await?;
        }
    };
    let call = async {
        loop {
            let asked = message();
            // Fails when the replier ends.
            if let Ok(answer) = question.call(&asked).await {
                assert_eq!(answer.value, asked.value * 2, "the answer to another request");
            }
        }
    };
    let ended: Result<(), scl::Error> = tokio::select! {
        () = commands.arrived() => Ok(()),
        ended = publish => ended,
        ended = publish_lossless => ended,
        ended = push => ended,
        () = call => Ok(()),
    };
    *values = next.get() % VALUES;
    if let Err(error) = ended {
        say_error(error);
    }
}

/// Receives through every gate, and says how many messages no longer wait in each: received, or dropped by its queue.
pub(super) async fn receive(sink: &mut Sink, commands: &mut Commands) -> scl::Result<()> {
    let Sink { readings, newest, lossless, jobs, answer, .. } = sink;
    let (mut reading, mut value, mut whole, mut job) = Default::default();
    loop {
        tokio::select! {
            () = commands.arrived() => break,
            received = readings.recv() => Received::count(&mut reading, received?.value),
            received = newest.recv() => Received::count(&mut value, received?.value),
            received = lossless.recv() => Received::count(&mut whole, received?.value),
            received = jobs.recv() => Received::count(&mut job, received?.value),
            request = answer.recv() => {
                let request = request?;
                let doubled = message(request.value * 2, 0);
                // Fails when the requester has ended.
                let _unanswered = request.reply(&doubled);
            }
        }
    }
    // From here to the end of the program, no task of a gate has a turn in which its queue could drop one message more.
    let taken = [
        reading.messages + dropped(&readings.stats()),
        value.messages + dropped(&newest.stats()),
        whole.messages + dropped(&lossless.stats()),
        job.messages + dropped(&jobs.stats()),
    ];
    say(taken.map(|number| number.to_string()).join(" "));
    Ok(())
}

fn dropped(stats: &scl::GateStats) -> u64 {
    stats.dropped_oldest + stats.dropped_newest + stats.replaced
}

/// What a gate has received.
#[derive(Default)]
struct Received {
    messages: u64,
    /// The last value of each source. A successor's messages may overtake those of a source that was killed.
    last: BTreeMap<u64, u64>,
}

impl Received {
    /// Each source sends rising values.
    fn count(&mut self, value: u64) {
        let before = self.last.insert(value / VALUES, value);
        assert!(before < Some(value), "{value} after {before:?}");
        self.messages += 1;
    }
}
