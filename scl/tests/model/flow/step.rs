//! The steps of a case. A step that needs an end that is not there does nothing.

use super::layout::{LAYOUTS, layout};
use crate::model::runner::list;
use proptest::prelude::{Strategy, any, prop_oneof};
use proptest::sample::select;
use std::fmt;

/// A layout, and what happens to it.
#[derive(Debug)]
pub(super) struct Case {
    pub(super) layout: usize,
    pub(super) steps: Vec<Step>,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Step {
    SenderAppears,
    SenderVanishes,
    /// It is flushed before, as a program that ends does.
    SenderFinishes,
    /// Sends this number of messages. One that would have to wait is cancelled and ends the step, which then waits for
    /// room.
    Send(usize),
    TrySend(usize),
    /// Waits to be woken when there is room.
    WaitForRoom,
    ReaderAppears(usize),
    ReaderVanishes(usize),
    /// Receives this number of messages. If there is none, the step ends, and the call waits.
    Recv(usize, usize),
    /// Receives this number of messages, or fewer if there are no more.
    TryRecv(usize, usize),
    Latest(usize),
    /// The gates' tasks run. Until then, gates only know of what their own calls have seen.
    TasksRun,
}

pub(super) fn cases(longest: usize) -> impl Strategy<Value = Case> {
    let steps = proptest::collection::vec(steps(), 1..longest);
    (0..LAYOUTS, any::<bool>(), steps).prop_map(|(layout, connected, steps)| {
        let before = if connected { CONNECTED } else { &[] };
        Case { layout, steps: [before, &steps[..]].concat() }
    })
}

/// Half of the cases begin with these, so that their other steps find connected ends.
const CONNECTED: &[Step] =
    &[Step::SenderAppears, Step::ReaderAppears(0), Step::ReaderAppears(1), Step::ReaderAppears(2), Step::TasksRun];

fn steps() -> impl Strategy<Value = Step> {
    let reader = || select(&[0, 1, 2][..]);
    prop_oneof![
        4 => any::<()>().prop_map(|()| Step::SenderAppears),
        1 => any::<()>().prop_map(|()| Step::SenderVanishes),
        1 => any::<()>().prop_map(|()| Step::SenderFinishes),
        6 => amounts().prop_map(Step::Send),
        3 => amounts().prop_map(Step::TrySend),
        3 => any::<()>().prop_map(|()| Step::WaitForRoom),
        5 => reader().prop_map(Step::ReaderAppears),
        2 => reader().prop_map(Step::ReaderVanishes),
        4 => (reader(), amounts()).prop_map(|(reader, count)| Step::Recv(reader, count)),
        3 => (reader(), amounts()).prop_map(|(reader, count)| Step::TryRecv(reader, count)),
        1 => reader().prop_map(Step::Latest),
        9 => any::<()>().prop_map(|()| Step::TasksRun),
    ]
}

/// A few; about as many as the memory transport holds; more than that and the longest queue hold together.
fn amounts() -> impl Strategy<Value = usize> {
    prop_oneof![6 => 1..6_usize, 1 => 60..70_usize, 1 => 150..200_usize]
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let layout = layout(self.layout);
        writeln!(f, "a `{:?}` gate with backpressure: {}", layout.kind, layout.backpressure)?;
        for (declared, reader) in layout.readers().iter().zip(0..) {
            writeln!(f, "reader {reader}: {declared:?}")?;
        }
        list(f, &self.steps)
    }
}
