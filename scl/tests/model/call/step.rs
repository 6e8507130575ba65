//! The steps that a case consists of. A step that needs an end that is not there does nothing.

use super::layout::REQUESTERS;
use crate::trial::list;
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
    /// Takes so many requests, ending early when there is none.
    Take(usize),
    /// Answers one of the requests that were taken, maybe late, maybe when its replier is gone.
    Answer(usize),
    /// Drops one of them, which is then never answered.
    Neglect(usize),
    RequesterAppears(usize),
    RequesterVanishes(usize),
    Ask(usize),
    GiveUp(usize),
    /// Asks and gives up so many times.
    Badger(usize, usize),
    /// The call of the requester that is in a hurry runs out of time, unless something else ends it.
    TimeRunsOut,
    /// Whoever is woken goes on.
    TasksRun,
}

/// What half of the cases begin with, so that the other steps meet ends that are connected.
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
    let place = || 0..REQUESTERS;
    prop_oneof![
        4 => Just(Step::ReplierAppears),
        2 => Just(Step::ReplierVanishes),
        5 => (1..4_usize).prop_map(Step::Take),
        6 => (0..4_usize).prop_map(Step::Answer),
        1 => (0..4_usize).prop_map(Step::Neglect),
        4 => place().prop_map(Step::RequesterAppears),
        1 => place().prop_map(Step::RequesterVanishes),
        8 => place().prop_map(Step::Ask),
        2 => place().prop_map(Step::GiveUp),
        1 => (place(), prop_oneof![1..4_usize, 60..80_usize]).prop_map(|(place, times)| Step::Badger(place, times)),
        1 => Just(Step::TimeRunsOut),
        9 => Just(Step::TasksRun),
    ]
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        list(f, &self.steps)
    }
}
