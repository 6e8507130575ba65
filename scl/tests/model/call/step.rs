//! The steps of a case. A step that needs an end that is not there does nothing.

use super::layout::REQUESTERS;
use crate::model::runner::list;
use proptest::prelude::{Just, Strategy, any, prop_oneof};
use std::fmt;

#[derive(Debug)]
pub(super) struct Case {
    pub(super) steps: Vec<Step>,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Step {
    ReplierAppears,
    ReplierVanishes,
    /// Takes this number of requests, or fewer if there are no more.
    Take(usize),
    /// Answers one of the requests that were taken, perhaps late, perhaps after its replier has vanished.
    Answer(usize),
    /// Drops one of them without an answer.
    Neglect(usize),
    RequesterAppears(usize),
    RequesterVanishes(usize),
    Ask(usize),
    GiveUp(usize),
    /// Asks and gives up this number of times.
    AskAndGiveUp(usize, usize),
    /// The call of the impatient requester times out, unless something else ends it.
    TimeRunsOut,
    /// The gates' tasks run, and calls that were woken continue.
    TasksRun,
}

/// Half of the cases begin with these, so that their other steps find connected ends.
const CONNECTED: &[Step] = &[
    Step::ReplierAppears,
    Step::RequesterAppears(0),
    Step::RequesterAppears(1),
    Step::RequesterAppears(2),
    Step::TasksRun,
];

pub(super) fn cases() -> impl Strategy<Value = Case> {
    (any::<bool>(), proptest::collection::vec(steps(), 1..50)).prop_map(|(connected, steps)| {
        let before = if connected { CONNECTED } else { &[] };
        Case { steps: [before, &steps[..]].concat() }
    })
}

fn steps() -> impl Strategy<Value = Step> {
    let requester = || 0..REQUESTERS;
    prop_oneof![
        4 => Just(Step::ReplierAppears),
        2 => Just(Step::ReplierVanishes),
        5 => (1..4_usize).prop_map(Step::Take),
        6 => (0..4_usize).prop_map(Step::Answer),
        1 => (0..4_usize).prop_map(Step::Neglect),
        4 => requester().prop_map(Step::RequesterAppears),
        1 => requester().prop_map(Step::RequesterVanishes),
        8 => requester().prop_map(Step::Ask),
        2 => requester().prop_map(Step::GiveUp),
        1 => (requester(), prop_oneof![1..4_usize, 60..80_usize])
            .prop_map(|(requester, times)| Step::AskAndGiveUp(requester, times)),
        1 => Just(Step::TimeRunsOut),
        9 => Just(Step::TasksRun),
    ]
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        list(f, &self.steps)
    }
}
